//! Effects on actuators: what happens to a command on its way, and where a thruster pushes.

use super::places::actuators;
use super::{Entry, Parts};
use crate::build::faults::Faults;
use sim::{ActuatorKind, Effect, EffectKind, LineEffect, LineLaw};
use spatial::Vec3;

/// Adds what stands between commands and outputs.
pub(super) fn add(entry: &Entry<'_>, of: fn(&Entry<'_>) -> LineLaw, parts: &mut Parts, faults: &mut Faults<'_>) {
    for actuator in actuators(entry, parts, faults) {
        let kind = EffectKind::Line(LineEffect { actuator, law: of(entry) });
        parts.effects.push(Effect { name: entry.title(), kind });
    }
}

/// Turns thrust axes.
pub(super) fn turn_thrusters(
    entry: &Entry<'_>,
    turned: fn(&Entry<'_>, &Vec3) -> Vec3,
    parts: &mut Parts,
    faults: &mut Faults<'_>,
) {
    for actuator in actuators(entry, parts, faults) {
        match &mut parts.table.actuators[actuator].kind {
            ActuatorKind::Thruster { direction, .. } => *direction = turned(entry, direction),
            ActuatorKind::JointEffort { .. } | ActuatorKind::JointDrive { .. } | ActuatorKind::LatchRelease { .. } => {
                entry.fault(faults, "turns thrusters; name one")
            }
        }
    }
}
