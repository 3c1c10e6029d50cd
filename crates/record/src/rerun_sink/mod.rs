//! Runs in Rerun: `.rrd` files that open on the right views, and streaming to a running viewer.
//!
//! | entity | holds |
//! | --- | --- |
//! | `/world/<vehicle>/<link>` | pose in W over time; below it the visual shapes, static |
//! | `/world/fixtures/…`, `/world/trails/…` | what stands still; paths of points, static |
//! | `/world/contacts/points` | contact points: teal sticks, orange slides |
//! | `/world/contacts/normal`, `friction` | forces on body B as arrows; friction has the colour of its point |
//! | `/signals/<plot>/<unit>/<channel>` | one scalar per channel, `f64`; small ones in a unit such as `1e-15` |
//! | `/events`, `/phase`, `/summary` | text log, phase lane, markdown |
//!
//! Timelines: `sim_time` (duration since the start of the simulated time) and `step`; there is no wall clock in a
//! file. The application is `softdock`, the recording identifier that of the run ([`crate::Meta::run_id`]), so that
//! the same run opened twice is one recording.
//!
//! Rerun's spatial types are single precision: poses are logged relative to an origin near the scene ([`Look`]), and
//! numbers to be computed with are in the signals. Arrow lengths are scaled; the factor is part of the [`Look`].

mod blueprint;
mod layout;
mod live;
mod look;
mod paths;
mod rows;
mod shapes;
mod units;

pub use live::{DEFAULT_VIEWER, LiveRerun};
pub use look::Look;

use crate::folder::write_file;
use crate::{Log, RecordError, Scene};
use rerun::{RecordingStream, RecordingStreamBuilder, RecordingStreamError};
use std::path::Path;

/// The application's name in the viewer.
pub const APPLICATION_ID: &str = "softdock";
/// Version of the viewer that fits the files.
pub const VIEWER_VERSION: &str = "0.36.3";

/// Writes a finished run as an `.rrd` with its blueprint; `summary` is markdown.
pub fn write_rrd(path: &Path, log: &Log, scene: &Scene, summary: &str) -> Result<(), RecordError> {
    write_file(path, &encode_rrd(log, scene, summary)?)
}

/// The bytes of an `.rrd`. They are complete, with footer; unlike those of the other sinks they differ from run to
/// run, since Rerun numbers its chunks by the clock.
pub fn encode_rrd(log: &Log, scene: &Scene, summary: &str) -> Result<Vec<u8>, RecordError> {
    let encode = || -> Result<Vec<u8>, Box<dyn std::error::Error>> {
        let log = &*units::readable(log);
        let (rec, storage) = builder(&log.meta.run_id()).memory()?;
        let look = Look::of_run(log, scene);
        // First, so that a viewer lays out its views before the data come.
        layout::send_blueprint(&rec, log, scene, &look)?;
        send_static(&rec, log, scene, &look)?;
        shapes::send_trails(&rec, log, scene, &look)?;
        rows::send_summary(&rec, summary, &look)?;
        rows::send_rows(&rec, log, scene, &look)?;
        Ok(storage.drain_as_bytes()?)
    };
    encode().map_err(|error| RecordError::Encode { what: "run.rrd", reason: error.to_string() })
}

/// A recording without wall clock, whatever the environment variables of Rerun say.
fn builder(run_id: &str) -> RecordingStreamBuilder {
    RecordingStreamBuilder::new(APPLICATION_ID).recording_id(run_id).enabled(true).send_properties(false)
}

fn send_static(rec: &RecordingStream, log: &Log, scene: &Scene, look: &Look) -> Result<(), RecordingStreamError> {
    rec.set_log_time_enabled(false);
    rec.send_recording_name(format!("{} · seed {}", log.meta.scenario, log.meta.seed))?;
    shapes::send_scene(rec, scene, look)?;
    rows::send_styles(rec, log)
}
