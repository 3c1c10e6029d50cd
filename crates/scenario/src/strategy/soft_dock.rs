//! Soft capture → at rest → retraction.
//!
//! Memory: `[time since which it is captured and at rest, or NaN; 1 once the retraction has begun]`.

use crate::build::{ActuatorTable, Faults};
use crate::outcome::calc_base_motion;
use crate::spec::SoftDock;
use sim::{ActuatorKind, Command, Controller, Known, MechanismStatus, Model, World};

/// Steps between two decisions: nothing here is faster than a latch.
const PERIOD: u64 = 10;

/// Opens the retracting latch's way when the soft capture has come to rest.
#[derive(Clone, Debug)]
pub(super) struct SoftDocking {
    visitor: usize,
    host: usize,
    capture: Vec<usize>,
    retraction: Vec<usize>,
    rest: (f64, f64),
    settle: f64,
}

pub(super) fn build(
    spec: &SoftDock,
    model: &Model,
    table: &ActuatorTable,
    faults: &mut Faults<'_>,
) -> Option<SoftDocking> {
    let retraction: Vec<usize> = table.find(&spec.retraction).collect();
    if retraction.is_empty() {
        let valid = model.actuators.iter().map(|a| a.name.as_str());
        faults.unknown("strategy.retraction", "actuator", &spec.retraction, valid);
        return None;
    }
    if retraction.iter().any(|a| !matches!(model.actuators[*a].kind, ActuatorKind::LatchRelease { .. })) {
        let reason = format!("\"{}\" opens no latch; name an actuator of kind latch-release", spec.retraction);
        faults.add("strategy.retraction", reason);
    }
    // The file's check has seen to it that these names stand in it.
    let index = |name: &String| model.mechanisms.iter().position(|m| m.name == *name);
    Some(SoftDocking {
        visitor: model.vehicle(&spec.visitor)?,
        host: model.vehicle(&spec.host)?,
        capture: spec.capture.iter().filter_map(index).collect(),
        retraction,
        rest: (spec.rest_m_per_s, spec.rest_deg_per_s.to_radians()),
        settle: spec.settle_s,
    })
}

impl SoftDocking {
    fn is_at_rest(&self, world: &World) -> bool {
        let holds = |m: &usize| world.state().mechanisms[*m].status == MechanismStatus::Engaged;
        let (speed, rate) = calc_base_motion(world, self.visitor, self.host);
        self.capture.iter().all(holds) && speed < self.rest.0 && rate < self.rest.1
    }
}

impl Controller for SoftDocking {
    fn period_steps(&self) -> u64 {
        PERIOD
    }

    fn command(&self, known: &Known<'_>, memory: &mut Vec<f64>, commands: &mut [Command]) {
        memory.resize(2, f64::NAN);
        let time = known.world.state().time;
        if !known.is_ready || !self.is_at_rest(known.world) {
            memory[0] = f64::NAN;
        } else if memory[0].is_nan() {
            memory[0] = time;
        }
        // Not a number compares as false: not at rest yet.
        if time - memory[0] >= self.settle {
            memory[1] = 1.0;
        }
        let keep_open = if memory[1] == 1.0 { 0.0 } else { 1.0 };
        self.retraction.iter().for_each(|a| commands[*a].effort = keep_open);
    }
}
