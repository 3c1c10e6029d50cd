//! A constant force or torque on a body: a leak, venting, an offset; fixed in the body or in the world.

use super::*;
use parameter::{ANY, choice, zero};
use sim::{Axes, Load};
use unit::{N, N_M};

/// In which axes a vector stays the same.
const FRAMES: [&str; 2] = ["body", "world"];

/// At the centre of mass.
pub static CONSTANT_FORCE: EffectDef = EffectDef {
    name: "constant-force",
    meaning: "A constant force on a body.",
    words: "a constant force",
    places: &[PlaceKind::Body],
    parameters: &[zero("vector", ANY, N, "force").vector(), choice("frame", &FRAMES, "axes in which it is constant")],
    equation: "vector at the centre of mass of the rigid body, constant in the axes of the body or of the world.",
    source: "None needed; law in `crates/sim/src/parts/effect/body/load.rs`.",
    build: Build::Load(|entry| Load::ConstantForce { vector: entry.vector("vector"), axes: axes(entry) }),
    identify: Identify {
        candidates: Candidates::Body(force),
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

/// A couple.
pub static CONSTANT_TORQUE: EffectDef = EffectDef {
    name: "constant-torque",
    meaning: "A constant torque on a body.",
    words: "a constant torque",
    places: &[PlaceKind::Body],
    parameters: &[
        zero("vector", ANY, N_M, "torque").vector().with_inertia(1.0),
        choice("frame", &FRAMES, "axes in which it is constant"),
    ],
    equation: "The couple vector, constant in the axes of the body or of the world.",
    source: "None needed; law in `crates/sim/src/parts/effect/body/load.rs`.",
    build: Build::Load(|entry| Load::ConstantTorque { vector: entry.vector("vector"), axes: axes(entry) }),
    identify: Identify {
        candidates: Candidates::Body(torque),
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

fn axes(entry: &Entry<'_>) -> Axes {
    if entry.word("frame") == FRAMES[1] { Axes::World } else { Axes::Body }
}

/// On what slides under its own weight a force is a tilt.
fn force(body: &BodyFact, survey: &Survey<'_>) -> Vec<Candidate> {
    let is_free = body.shifts().contains(&true) && !(body.is_base && survey.rests(body));
    if is_free { in_each_frame(body, body.shifts(), body.mass * 1e-5) } else { Vec::new() }
}

fn torque(body: &BodyFact, _: &Survey<'_>) -> Vec<Candidate> {
    let is_free = body.twists().contains(&true);
    if is_free { in_each_frame(body, body.twists(), 1e-6) } else { Vec::new() }
}

fn in_each_frame(body: &BodyFact, mask: [bool; 3], step: f64) -> Vec<Candidate> {
    let columns = Along::each((0..3).filter(|k| mask[*k]), step);
    let of = |frame: &str| {
        let vector = Coordinate::vector(["vector[0]", "vector[1]", "vector[2]"], [0.0; 3]);
        Candidate::new(body.place(), vector).screened(&columns).with_word("frame", frame).asked_last(!body.is_base)
    };
    FRAMES.map(of).into()
}
