//! The scenario file, strategies, success criteria and metrics.
