//! Channels, recordings and their sinks: Parquet, CSV, Rerun.
