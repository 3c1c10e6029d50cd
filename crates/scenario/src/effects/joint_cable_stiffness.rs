//! The pull of a cable harness over a joint: a spring to a rest position.

use super::joint::SMALL;
use super::*;
use parameter::{ANY, AT_LEAST_ZERO, shape, zero};
use sim::JointLaw;
use unit::{PLACE, STIFFNESS};

/// −k (q − q_rest).
pub static JOINT_CABLE_STIFFNESS: EffectDef = EffectDef {
    name: "joint-cable-stiffness",
    meaning: "A spring to a rest position of the joint.",
    words: "the pull of a cable harness",
    places: &[PlaceKind::Joint],
    parameters: &[
        zero("k", AT_LEAST_ZERO, STIFFNESS, "stiffness"),
        shape("q_rest", ANY, PLACE, "position without pull").optional(),
    ],
    equation: "−k (q − q_rest).",
    source: "A harness taken as linear; law in `crates/sim/src/parts/effect/joint.rs`.",
    build: Build::Effort(|entry| JointLaw::Cable { stiffness: entry.number("k"), rest: entry.number("q_rest") }),
    identify: Identify {
        candidates: Candidates::Joint(|joint, _| {
            let coordinates = vec![Coordinate::level("k", 0.0), Coordinate::free("q_rest", 0.0)];
            let cable = Candidate::new(joint.place(), coordinates).encoded(Encoding::Rested);
            vec![cable.screened(&Along::each(0..2, SMALL))]
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
