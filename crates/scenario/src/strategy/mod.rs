//! Guidance and control: one file per strategy; file-side enum, step-side [`sim::Controller`], joined by one match.

mod free_floating;
mod gripper;
mod replay;
mod schedule;
mod soft_dock;
mod track_and_grasp;
mod trajectory;

pub use track_and_grasp::{Phase, phase_of};

use crate::build::{ActuatorTable, Faults};
use crate::spec::{Scenario, Strategy};
use sim::{Controller, Model, NoControl};
use std::sync::Arc;

/// The controller of a scenario; `None` where its names lead nowhere (the faults say where).
pub(crate) fn build(
    scenario: &Scenario,
    model: &Arc<Model>,
    table: &ActuatorTable,
    faults: &mut Faults<'_>,
) -> Option<Box<dyn Controller + Send + Sync>> {
    match &scenario.strategy {
        Strategy::None => Some(Box::new(NoControl)),
        Strategy::Schedule(spec) => Some(Box::new(schedule::build(spec, table, model, faults)?)),
        Strategy::Replay(spec) => Some(Box::new(replay::build(scenario, spec, table, model, faults)?)),
        Strategy::SoftDock(spec) => Some(Box::new(soft_dock::build(spec, model, table, faults)?)),
        Strategy::TrackAndGrasp(spec) => Some(Box::new(track_and_grasp::build(scenario, spec, model, table, faults)?)),
    }
}
