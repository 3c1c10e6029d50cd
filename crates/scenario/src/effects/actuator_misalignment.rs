//! A thruster whose axis is tilted.

use super::actuator_gain::ACTUATOR_GAIN;
use super::*;
use parameter::{ANY, zero};
use spatial::{Vec3, exp_rotation};
use unit::RAD;

/// Two angles.
pub static ACTUATOR_MISALIGNMENT: EffectDef = EffectDef {
    name: "actuator-misalignment",
    meaning: "A thrust axis that is tilted.",
    words: "a tilted thrust axis",
    places: &[PlaceKind::Actuator],
    parameters: &[
        zero("angle_y", ANY, RAD, "turn about the body's y").optional(),
        zero("angle_z", ANY, RAD, "turn about the body's z").optional(),
    ],
    equation: "The thrust axis, in the body's axes, turned by the rotation vector (0, angle_y, angle_z).",
    source: "Geometry; in the build.",
    build: Build::ThrustAxis(tilted),
    identify: Identify {
        candidates: Candidates::Actuator(candidates),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: Some(|_, x| {
            // Of a thrust that leaves the plane in which all moves its share in the plane is left.
            vec![Alternative::here(&ACTUATOR_GAIN, vec![x[0].hypot(x[1]).cos()])]
        }),
        start: Start::Mean,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::Nothing,
};

fn tilted(entry: &Entry<'_>, axis: &Vec3) -> Vec3 {
    let turn = Vec3::new(0.0, entry.number("angle_y"), entry.number("angle_z"));
    // A turn by nothing may still round.
    if turn == Vec3::zeros() { *axis } else { exp_rotation(&turn) * axis }
}

fn candidates(actuator: &ActuatorFact) -> Vec<Candidate> {
    if !actuator.is_thruster {
        return Vec::new();
    }
    let coordinates = vec![Coordinate::free("angle_y", 0.0), Coordinate::free("angle_z", 0.0)];
    vec![Candidate::new(actuator.place.clone(), coordinates).screened(&Along::each(0..2, 1e-4))]
}
