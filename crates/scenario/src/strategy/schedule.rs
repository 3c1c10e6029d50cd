//! Commands as piecewise linear functions of time.

use crate::build::{ActuatorTable, Faults};
use crate::spec::Schedule;
use sim::{ActuatorKind, Command, Controller, Known, Model};

/// Plays courses of commands.
#[derive(Clone, Debug)]
pub(super) struct SchedulePlayer {
    courses: Vec<(usize, Target, crate::spec::Command)>,
}

/// Which part of a [`Command`] a value is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Target {
    Position,
    /// Of a drive without stiffness: a loop on the rate alone.
    Velocity,
    Effort,
}

impl Target {
    /// What a single value means to an actuator.
    pub(super) fn of(kind: &ActuatorKind) -> Self {
        match kind {
            ActuatorKind::JointDrive { stiffness, .. } if *stiffness > 0.0 => Self::Position,
            ActuatorKind::JointDrive { .. } => Self::Velocity,
            ActuatorKind::JointEffort { .. } | ActuatorKind::Thruster { .. } | ActuatorKind::LatchRelease { .. } => {
                Self::Effort
            }
        }
    }

    pub(super) fn write(self, value: f64, command: &mut Command) {
        match self {
            Self::Position => command.position = value,
            Self::Velocity => command.velocity = value,
            Self::Effort => command.effort = value,
        }
    }
}

pub(super) fn build(
    spec: &Schedule,
    table: &ActuatorTable,
    model: &Model,
    faults: &mut Faults<'_>,
) -> Option<SchedulePlayer> {
    let mut courses = Vec::new();
    for (i, course) in spec.commands.iter().enumerate() {
        let found: Vec<usize> = table.find(&course.actuator).collect();
        if found.is_empty() {
            let valid = model.actuators.iter().map(|a| a.name.as_str());
            faults.unknown(&format!("strategy.commands[{i}].actuator"), "actuator", &course.actuator, valid);
            return None;
        }
        courses.extend(found.into_iter().map(|a| (a, Target::of(&model.actuators[a].kind), course.clone())));
    }
    Some(SchedulePlayer { courses })
}

impl Controller for SchedulePlayer {
    fn command(&self, known: &Known<'_>, _: &mut Vec<f64>, commands: &mut [Command]) {
        for (actuator, target, course) in &self.courses {
            target.write(course.value_at(known.world.state().time), &mut commands[*actuator]);
        }
    }
}
