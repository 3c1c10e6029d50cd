//! Effects on actuators: gain, delay, lag, saturation, misalignment.

use super::places::actuators;
use super::{Entry, Parts};
use crate::build::faults::Faults;
use crate::effects::EffectName;
use sim::{ActuatorKind, Effect, EffectKind, LineEffect, LineLaw};
use spatial::{Vec3, exp_rotation};

/// Adds what stands between commands and outputs, and turns thrust axes.
pub(super) fn apply(entry: &Entry<'_>, parts: &mut Parts, faults: &mut Faults<'_>) {
    for actuator in actuators(entry, parts, faults) {
        let law = match entry.name {
            EffectName::ActuatorGain => LineLaw::Gain(entry.number("gain")),
            EffectName::ActuatorDelay => LineLaw::Delay(entry.number("delay")),
            EffectName::ActuatorLag => LineLaw::Lag(entry.number("time_constant")),
            EffectName::ActuatorSaturation => LineLaw::Saturation(entry.number("limit")),
            _ => {
                turn_thruster(entry, actuator, parts, faults);
                continue;
            }
        };
        parts.effects.push(Effect { name: entry.title(), kind: EffectKind::Line(LineEffect { actuator, law }) });
    }
}

/// Turns the thrust axis by the rotation vector (0, `angle_y`, `angle_z`) in the axes of the body.
fn turn_thruster(entry: &Entry<'_>, actuator: usize, parts: &mut Parts, faults: &mut Faults<'_>) {
    let turn = Vec3::new(0.0, entry.number("angle_y"), entry.number("angle_z"));
    match &mut parts.table.actuators[actuator].kind {
        // A turn by nothing may still round.
        ActuatorKind::Thruster { direction, .. } if turn != Vec3::zeros() => {
            *direction = exp_rotation(&turn) * *direction;
        }
        ActuatorKind::Thruster { .. } => {}
        _ => entry.fault(faults, "turns thrusters; name one"),
    }
}
