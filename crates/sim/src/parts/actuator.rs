//! The actuators of a world.

use super::coordinate::CoordinatePoint;
use serde::{Deserialize, Serialize};
use spatial::Vec3;

/// An actuator of the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Actuator {
    /// Unique name.
    pub name: String,
    /// What it does with a command.
    pub kind: ActuatorKind,
}

/// What an actuator does with its [`Command`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ActuatorKind {
    /// Effort on one joint coordinate (a reaction wheel's motor too).
    JointEffort {
        /// Index into `v`.
        coordinate: usize,
        /// N·m or N.
        limit: f64,
    },
    /// Position and rate control of one joint coordinate; implicit in the default integrator.
    JointDrive {
        /// Index into `v`.
        coordinate: usize,
        /// N·m/rad or N/m.
        stiffness: f64,
        /// N·m·s/rad or N·s/m.
        damping: f64,
        /// N·m or N.
        limit: f64,
    },
    /// A force fixed in a body; `effort` of the command, clamped to 0 … max.
    Thruster {
        /// Global body.
        body: usize,
        /// Nozzle, body frame, m.
        position: Vec3,
        /// Force on the body, unit vector, body axes.
        direction: Vec3,
        /// N.
        max_force: f64,
    },
    /// Opens a latch while the command's `effort` is above ½.
    LatchRelease {
        /// Index into the model's mechanisms.
        mechanism: usize,
    },
}

/// What a controller asks of one actuator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Command {
    /// Reference position of a drive, rad or m.
    pub position: f64,
    /// Reference rate of a drive, rad/s or m/s.
    pub velocity: f64,
    /// Effort or feed-forward, N·m or N.
    pub effort: f64,
}

/// What an actuator gives for a command, and −∂/∂v'; a joint's with its motor at q and v.
pub(crate) fn nominal_effort(
    kind: &ActuatorKind,
    command: &Command,
    at: &CoordinatePoint,
    (q, v): (f64, f64),
) -> (f64, f64) {
    match *kind {
        ActuatorKind::JointEffort { limit, .. } => (command.effort.clamp(-limit, limit), 0.0),
        ActuatorKind::JointDrive { stiffness, damping, limit, .. } => {
            let asked = stiffness * (command.position - q) + damping * (command.velocity - v) + command.effort;
            if asked.abs() > limit {
                return (limit.copysign(asked), 0.0);
            }
            (asked, stiffness * at.beta + damping * at.theta)
        }
        ActuatorKind::Thruster { max_force, .. } => (command.effort.clamp(0.0, max_force), 0.0),
        ActuatorKind::LatchRelease { .. } => (0.0, 0.0),
    }
}
