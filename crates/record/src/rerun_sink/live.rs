//! Streaming a run to a viewer while it goes on.

use super::look::Look;
use super::{APPLICATION_ID, VIEWER_VERSION, builder, layout, rows, send_static};
use crate::{ChannelSpec, Event, Log, Meta, RecordError, Sample, Scene};
use rerun::RecordingStream;
use std::time::{Duration, Instant};

/// Where a viewer listens unless told otherwise.
pub const DEFAULT_VIEWER: &str = rerun::DEFAULT_CONNECT_URL;
/// Samples are sent in batches of this length of wall-clock time: smooth to watch, cheap to send.
const BATCH: Duration = Duration::from_millis(50);
/// How long a viewer may take to answer.
const PATIENCE: Duration = Duration::from_secs(5);

/// A run that is shown while it goes on. Sends what it is given; keeps nothing.
pub struct LiveRerun {
    rec: RecordingStream,
    scene: Scene,
    channels: Vec<ChannelSpec>,
    batch: Log,
    look: Option<Look>,
    peak_force: f64,
    sent: Instant,
}

impl crate::SampleSink for LiveRerun {
    fn push(&mut self, sample: &Sample<'_>) -> Result<(), RecordError> {
        LiveRerun::push(self, sample)
    }
}

impl LiveRerun {
    /// Streams to a viewer that is running at `url` ([`DEFAULT_VIEWER`]).
    pub fn connect(url: &str, meta: Meta, channels: Vec<ChannelSpec>, scene: Scene) -> Result<Self, RecordError> {
        let failed = |reason: String| RecordError::Viewer { url: url.into(), reason, version: VIEWER_VERSION };
        let rec = builder(&live_id(&meta)).connect_grpc_opts(url).map_err(|e| failed(e.to_string()))?;
        rec.flush_with_timeout(PATIENCE).map_err(|e| failed(e.to_string()))?;
        Ok(Self::new(rec, meta, channels, scene))
    }

    /// Opens a viewer (`rerun` on the search path) and streams to it.
    pub fn spawn(meta: Meta, channels: Vec<ChannelSpec>, scene: Scene) -> Result<Self, RecordError> {
        let options = rerun::SpawnOptions { wait_for_bind: true, hide_welcome_screen: true, ..Default::default() };
        let failed = |reason: String| RecordError::Viewer {
            url: options.connect_addr().to_string(),
            reason,
            version: VIEWER_VERSION,
        };
        let rec = builder(&live_id(&meta)).spawn_opts(&options).map_err(|e| failed(e.to_string()))?;
        rec.flush_with_timeout(PATIENCE).map_err(|e| failed(e.to_string()))?;
        Ok(Self::new(rec, meta, channels, scene))
    }

    fn new(rec: RecordingStream, meta: Meta, channels: Vec<ChannelSpec>, scene: Scene) -> Self {
        let batch = Log::new(meta, channels.clone(), scene.link_count());
        Self { rec, scene, channels, batch, look: None, peak_force: 100.0, sent: Instant::now() }
    }

    /// Arrow lengths follow this largest force, N (100 N unless set before the first sample).
    pub fn with_peak_force(mut self, force: f64) -> Self {
        self.peak_force = force;
        self
    }

    /// Shows an instant.
    pub fn push(&mut self, sample: &Sample<'_>) -> Result<(), RecordError> {
        self.batch.push(sample)?;
        if self.look.is_none() {
            self.open(sample)?;
        }
        if self.sent.elapsed() >= BATCH { self.send() } else { Ok(()) }
    }

    /// Shows an event.
    pub fn push_event(&mut self, event: Event) {
        self.batch.events.push(event);
    }

    /// Sends what is left and the summary (markdown), and waits until the viewer has it.
    pub fn finish(mut self, summary: &str) -> Result<(), RecordError> {
        self.send()?;
        if let Some(look) = &self.look {
            rows::send_summary(&self.rec, summary, look).map_err(lost)?;
        }
        self.rec.flush_with_timeout(PATIENCE).map_err(lost)
    }

    /// The first sample tells where the camera has to stand.
    fn open(&mut self, sample: &Sample<'_>) -> Result<(), RecordError> {
        let look = Look::at(sample.poses_w, &self.scene, self.peak_force);
        send_static(&self.rec, &self.batch, &self.scene, &look).map_err(lost)?;
        layout::send_live_blueprint(&self.rec, &self.batch, &self.scene, &look).map_err(lost)?;
        self.look = Some(look);
        Ok(())
    }

    fn send(&mut self) -> Result<(), RecordError> {
        if let Some(look) = &self.look {
            rows::send_rows(&self.rec, &self.batch, &self.scene, look).map_err(lost)?;
        }
        self.batch = Log::new(self.batch.meta.clone(), self.channels.clone(), self.scene.link_count());
        self.sent = Instant::now();
        Ok(())
    }
}

/// Shown again, a run is a recording of its own, or both would lie over each other in the viewer.
fn live_id(meta: &Meta) -> String {
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap_or_default();
    format!("{}-live-{:x}", meta.run_id(), now.as_millis())
}

fn lost(error: impl std::fmt::Display) -> RecordError {
    RecordError::Viewer {
        url: format!("the stream of {APPLICATION_ID}"),
        reason: error.to_string(),
        version: VIEWER_VERSION,
    }
}
