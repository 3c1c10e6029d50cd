//! What slows a free body down: drag along, damping about.

use super::*;
use parameter::{AT_LEAST_ZERO, zero};
use sim::Load;
use unit::{N_M_S_PER_RAD, N_S_PER_M, N_S2_PER_M2};

/// −c v.
pub static LINEAR_DRAG: EffectDef = EffectDef {
    name: "linear-drag",
    meaning: "Drag proportional to speed.",
    words: "drag in proportion to speed",
    places: &[PlaceKind::Body],
    parameters: &[zero("c", AT_LEAST_ZERO, N_S_PER_M, "force over speed")],
    equation: "−c v at the centre of mass, v its velocity in the world frame.",
    source: "Laminar drag; law in `crates/sim/src/parts/effect/body/load.rs`.",
    build: Build::Load(|entry| Load::LinearDrag { c: entry.number("c") }),
    identify: Identify {
        candidates: Candidates::Body(|body, survey| {
            // On what slides under its own weight it is viscous friction.
            if slides(body) && !survey.rests(body) { damped(body, 1e-4) } else { Vec::new() }
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

/// −c ‖v‖ v.
pub static QUADRATIC_DRAG: EffectDef = EffectDef {
    name: "quadratic-drag",
    meaning: "Drag proportional to the square of speed.",
    words: "drag with the square of speed",
    places: &[PlaceKind::Body],
    parameters: &[zero("c", AT_LEAST_ZERO, N_S2_PER_M2, "force over the square of speed")],
    equation: "−c ‖v‖ v at the centre of mass, v its velocity in the world frame.",
    source: "Turbulent drag; law in `crates/sim/src/parts/effect/body/load.rs`.",
    build: Build::Load(|entry| Load::QuadraticDrag { c: entry.number("c") }),
    identify: Identify {
        candidates: Candidates::Body(|body, _| if slides(body) { damped(body, 1e-4) } else { Vec::new() }),
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

/// −c ω.
pub static ANGULAR_DAMPING: EffectDef = EffectDef {
    name: "angular-damping",
    meaning: "A torque against angular velocity.",
    words: "damping of the rotation",
    places: &[PlaceKind::Body],
    parameters: &[zero("c", AT_LEAST_ZERO, N_M_S_PER_RAD, "torque over angular velocity").with_inertia(1.0)],
    equation: "−c ω, ω against the inertial frame: eddy currents, air.",
    source: "None needed; law in `crates/sim/src/parts/effect/body/load.rs`.",
    build: Build::Load(|entry| Load::AngularDamping { c: entry.number("c") }),
    identify: Identify {
        candidates: Candidates::Body(|body, _| if turns(body) { damped(body, 1e-5) } else { Vec::new() }),
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

fn slides(body: &BodyFact) -> bool {
    body.shifts().contains(&true)
}

fn turns(body: &BodyFact) -> bool {
    body.twists().contains(&true)
}

fn damped(body: &BodyFact, step: f64) -> Vec<Candidate> {
    let drag = Candidate::new(body.place(), vec![Coordinate::level("c", 0.0)]).screened(&[Along::new(0, step)]);
    vec![drag.asked_last(!body.is_base)]
}
