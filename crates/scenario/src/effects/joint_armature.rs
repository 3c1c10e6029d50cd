//! More inertia of a drive's rotor, reflected to its joint.

use super::*;
use parameter::{ANY, zero};
use unit::REFLECTED;

/// Added to what the actuator's description reflects.
pub static JOINT_ARMATURE: EffectDef = EffectDef {
    name: "joint-armature",
    meaning: "More reflected rotor inertia.",
    words: "the reflected inertia of the rotor",
    places: &[PlaceKind::Joint],
    parameters: &[zero("i_rotor", ANY, REFLECTED, "added to the joint's reflected inertia; negative takes away")],
    equation: "The joint's entry of the mass matrix grows by i_rotor: the rotor's own inertia times the square of the gear ratio. \
               A gear that yields takes all of it to its motor side.",
    source: "Featherstone 2008, on geared drives; in the build.",
    build: Build::Rotor(add),
    identify: Identify {
        candidates: Candidates::Joint(|joint, _| {
            let coordinates = vec![Coordinate::free("i_rotor", 0.0)];
            vec![Candidate::new(joint.place(), coordinates).screened(&[Along::new(0, 1e-5)])]
        }),
        tier: Tier::Nominal,
        tolerance: None,
        penalty: None,
        nested: None,
        start: Start::Mean,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::Nothing,
};

fn add(entry: &Entry<'_>, joint: &mut multibody::Joint, faults: &mut Faults<'_>) {
    let sum = joint.armature + entry.number("i_rotor");
    if sum < 0.0 {
        let has = joint.armature;
        let reason = format!("takes more than the joint has ({has} kg·m² or kg are reflected there)");
        faults.add(&entry.key("i_rotor"), reason);
    }
    joint.armature = sum;
}
