//! A viewer that watches a run as it goes.

use crate::run::Arguments;
use softdock::record::{RecorderPlan, Scene};
use softdock::scenario::Mission;
use softdock::scenario::outcome::Outcome;

#[cfg(feature = "rerun")]
pub(crate) use softdock::record::rerun_sink::LiveRerun as Viewer;

/// Opens what the arguments ask for.
#[cfg(feature = "rerun")]
pub(crate) fn open(
    arguments: &Arguments,
    plan: &RecorderPlan,
    mission: &Mission,
    scene: &Scene,
) -> anyhow::Result<Option<Viewer>> {
    let channels = plan.calc_channels(mission.world.model());
    Ok(match &arguments.live {
        Some(url) => Some(Viewer::connect(url, plan.meta.clone(), channels, scene.clone())?),
        None if arguments.spawn => Some(Viewer::spawn(plan.meta.clone(), channels, scene.clone())?),
        None => None,
    })
}

/// Sends the events and the summary.
#[cfg(feature = "rerun")]
pub(crate) fn finish(viewer: Option<Viewer>, outcome: &Outcome, summary: &str) -> anyhow::Result<()> {
    if let Some(mut viewer) = viewer {
        outcome.events.iter().for_each(|event| viewer.push_event(event.clone()));
        viewer.finish(summary)?;
    }
    Ok(())
}

/// Without the feature there is no viewer.
#[cfg(not(feature = "rerun"))]
#[derive(Debug)]
pub(crate) enum Viewer {}

#[cfg(not(feature = "rerun"))]
impl softdock::record::SampleSink for Viewer {
    fn push(&mut self, _: &softdock::record::Sample<'_>) -> Result<(), softdock::record::RecordError> {
        match *self {}
    }
}

/// Without the feature nothing opens.
#[cfg(not(feature = "rerun"))]
pub(crate) fn open(_: &Arguments, _: &RecorderPlan, _: &Mission, _: &Scene) -> anyhow::Result<Option<Viewer>> {
    Ok(None)
}

/// Without the feature nothing ends.
#[cfg(not(feature = "rerun"))]
pub(crate) fn finish(_: Option<Viewer>, _: &Outcome, _: &str) -> anyhow::Result<()> {
    Ok(())
}
