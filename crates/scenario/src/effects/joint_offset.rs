//! A constant effort at a joint: what a drive adds to its command, a weight that is not in the model.

use super::joint::SMALL;
use super::*;
use parameter::{ANY, zero};
use sim::JointLaw;
use unit::EFFORT;

/// The same effort always.
pub static JOINT_OFFSET: EffectDef = EffectDef {
    name: "joint-offset",
    meaning: "A constant effort at a joint.",
    words: "a constant effort",
    places: &[PlaceKind::Joint],
    parameters: &[zero("effort", ANY, EFFORT, "effort in the joint's positive direction")],
    equation: "effort, always.",
    source: "None needed; law in `crates/sim/src/parts/effect/joint.rs`.",
    build: Build::Effort(|entry| JointLaw::Offset { effort: entry.number("effort") }),
    identify: Identify {
        candidates: Candidates::Joint(|joint, _| {
            let coordinates = vec![Coordinate::free("effort", 0.0)];
            vec![Candidate::new(joint.place(), coordinates).screened(&[Along::new(0, SMALL)])]
        }),
        tier: Tier::Exotic,
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
