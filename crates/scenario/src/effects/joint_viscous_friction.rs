//! Friction of a joint that grows with its rate: −b q̇, with one level or one for each direction, and −b₂ |q̇| q̇.

use super::joint::each_screened;
use super::*;
use parameter::{AT_LEAST_ZERO, zero};
use sim::JointLaw;
use unit::{DAMPING, DRAG};

const SOURCE: &str = "Armstrong-Hélouvry, Dupont and Canudas de Wit 1994, the survey of friction models; \
                      law in `crates/sim/src/parts/effect/joint.rs`.";

/// −b q̇.
pub static JOINT_VISCOUS_FRICTION: EffectDef = EffectDef {
    name: "joint-viscous-friction",
    meaning: "Friction of a joint that grows with its rate.",
    words: "viscous friction",
    places: &[PlaceKind::Joint],
    parameters: &[zero("b", AT_LEAST_ZERO, DAMPING, "effort over rate")],
    equation: "−b q̇ on the link side of the joint.",
    source: SOURCE,
    build: Build::Effort(|entry| JointLaw::Viscous { damping: entry.number("b") }),
    identify: Identify {
        candidates: Candidates::Joint(|joint, _| each_screened(joint, &["b"])),
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

/// −b± q̇.
pub static JOINT_VISCOUS_ASYMMETRY: EffectDef = EffectDef {
    name: "joint-viscous-asymmetry",
    meaning: "Viscous friction of a joint that differs by direction.",
    words: "viscous friction that differs between the two directions",
    places: &[PlaceKind::Joint],
    parameters: &[
        zero("b_plus", AT_LEAST_ZERO, DAMPING, "effort over rate where q̇ ≥ 0"),
        zero("b_minus", AT_LEAST_ZERO, DAMPING, "effort over rate elsewhere"),
    ],
    equation: "−b_plus q̇ where q̇ ≥ 0, −b_minus q̇ elsewhere.",
    source: SOURCE,
    build: Build::Effort(|entry| JointLaw::ViscousBySide {
        plus: entry.number("b_plus"),
        minus: entry.number("b_minus"),
    }),
    identify: Identify {
        candidates: Candidates::Joint(|joint, _| each_screened(joint, &["b_plus", "b_minus"])),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: Some(|_, x| vec![Alternative::here(&JOINT_VISCOUS_FRICTION, vec![0.5 * (x[0] + x[1])])]),
        start: Start::Mean,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::Nothing,
};

/// −b₂ |q̇| q̇.
pub static JOINT_QUADRATIC_FRICTION: EffectDef = EffectDef {
    name: "joint-quadratic-friction",
    meaning: "Friction of a joint that grows with the square of its rate.",
    words: "friction that grows with the square of the rate",
    places: &[PlaceKind::Joint],
    parameters: &[zero("b_2", AT_LEAST_ZERO, DRAG, "effort over the square of the rate")],
    equation: "−b_2 |q̇| q̇.",
    source: "Turbulent drag, by dimension; law in `crates/sim/src/parts/effect/joint.rs`.",
    build: Build::Effort(|entry| JointLaw::Quadratic { drag: entry.number("b_2") }),
    identify: Identify {
        candidates: Candidates::Joint(|joint, _| each_screened(joint, &["b_2"])),
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
