//! Channels, recordings and their sinks: Parquet, CSV, plots and Rerun.
//!
//! **run → [`Log`] → files.** An observer fills a [`Log`] at the logging rate; the sinks write it when the run is over:
//!
//! | file | by | for |
//! | --- | --- | --- |
//! | `signals.parquet` | [`write_parquet`] | numbers: every channel, `f64`, units in the header |
//! | `signals.csv` | [`write_csv`] | the same for spreadsheets |
//! | `signals.svg` | [`plot::plot_svg`] | eyes without a viewer |
//! | `run.rrd` | `rerun_sink::write_rrd` (feature `rerun`) | eyes with the Rerun viewer |
//! | `summary.json` | [`OutputFolder::finish`] | outcome, metrics; its presence says that the folder is whole |
//!
//! `read_parquet` and `read_csv` read runs of softdock back; [`RecordingSet::load`] reads what a rig recorded: a folder
//! with `recording.toml`, forgiving where a rig is and exact in what it says about it.

mod channel;
pub mod consistency;
mod csv_file;
mod error;
mod folder;
pub mod inspect;
mod log;
mod mechanisms;
mod mesh;
mod observe;
pub mod page;
mod parquet_file;
pub mod plot;
mod recording;
#[cfg(feature = "rerun")]
pub mod rerun_sink;
mod scene;

pub use channel::{Axes, Channel, ChannelSpec, Plot, Signals, axes_of};
pub use csv_file::{encode_csv, parse_csv, read_csv, write_csv};
pub use error::RecordError;
pub use folder::{OutputFolder, SUMMARY_FORMAT, write_file};
pub use log::{ContactSample, Event, EventKind, Log, Meta, Sample};
pub use mesh::{TriangleMesh, docking_of_geometry, triangulate};
pub use observe::{Function, Probe, Recorder, RecorderPlan, SampleSink, standard_channels};
pub use parquet_file::{SIGNALS_FORMAT, encode_parquet, read_parquet, write_parquet};
pub use recording::{
    ChannelName, Format, Quantity, RecordedRun, RecordingSet, Remark, Role, Series, Severity, median_step, units,
};
pub use scene::{Scene, SceneLink, SceneVehicle, Trail};
