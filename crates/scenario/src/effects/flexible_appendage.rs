//! A lightly damped mode of bending: a solar array, a boom.

use super::slosh::modes;
use super::*;
use parameter::{ANY, AT_LEAST_ZERO, POSITIVE, shape, zero};
use sim::{Appendage, BodyLaw};
use spatial::Vec3;
use std::f64::consts::TAU;
use unit::{HZ, NONE, ROOT_KG_M};

/// One mode.
pub static FLEXIBLE_APPENDAGE: EffectDef = EffectDef {
    name: "flexible-appendage",
    meaning: "A lightly damped mode of bending.",
    words: "vibration of a flexible appendage",
    places: &[PlaceKind::Body],
    parameters: &[
        shape("frequency", POSITIVE, HZ, "Ω/2π, with the body held"),
        shape("damping", AT_LEAST_ZERO, NONE, "ζ: damping ratio").optional(),
        zero("coupling", ANY, ROOT_KG_M, "δ: modal coupling to the body's rotation, link axes")
            .vector()
            .with_inertia(0.5),
    ],
    equation: "η̈ + 2 ζ Ω η̇ + Ω² η = −δ·ω̇ and δ η̈ in the balance of torques; angular momentum I ω + δ η̇. The body's nominal inertia I holds the mode locked. \
               Several modes are several entries.",
    source: "Hybrid coordinates, Likins 1970; law in `crates/sim/src/parts/effect/body/appendage.rs`.",
    build: Build::Part(PartBuild {
        size: "coupling",
        take_out: |entry, own, _| own.without_mode(&entry.vector("coupling")),
        law: |entry, _| {
            let rate = TAU * entry.number("frequency");
            let (damping, coupling) = (entry.number("damping"), entry.vector("coupling"));
            BodyLaw::Appendage(Appendage { rate, damping, coupling })
        },
    }),
    identify: Identify {
        candidates: Candidates::Body(candidates),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: None,
        start: Start::Dyad,
        minima: Minima::Several,
        concerns: Concerns::Motion,
    },
    shown: Shown::UpToSign { vector: "coupling" },
    corrects: Corrects::Nothing,
};

fn candidates(body: &BodyFact, survey: &Survey<'_>) -> Vec<Candidate> {
    if !body.can_turn() {
        return Vec::new();
    }
    let mut coordinates =
        vec![Coordinate::log("frequency", 0.1, [5e-3, 20.0]), Coordinate::log("damping", 0.01, [1e-4, 1.0])];
    coordinates.extend(Coordinate::vector(["coupling[0]", "coupling[1]", "coupling[2]"], [0.0; 3]));
    let still: Vec<usize> = (0..3).filter(|k| !body.turns()[*k]).collect();
    let axes = dyad_axes().into_iter().filter(|axis| still.iter().all(|k| axis[*k] == 0.0)).collect::<Vec<Vec3>>();
    let held = still.iter().map(|k| 2 + k).collect();
    let mut mode = Candidate::new(body.place(), coordinates).holding(held).expensive();
    let neutral = mode.neutral();
    // A hundredth of the inertia.
    let size = (0.01 * body.inertia.trace() / 3.0).sqrt();
    for f in modes(survey) {
        let point = |axis: &Vec3| {
            let mut x = neutral.clone();
            x[0] = f.ln();
            (0..3).for_each(|k| x[2 + k] = size * axis[k]);
            x
        };
        mode = mode.screened_at(&format!("f = {f:.3} Hz"), &axes.iter().map(point).collect::<Vec<_>>());
    }
    vec![mode]
}
