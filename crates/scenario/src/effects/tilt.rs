//! A constant acceleration of everything: a table that is out of level.

use super::*;
use parameter::{ANY, zero};
use unit::M_PER_S2;

/// Added to the field.
pub static TILT: EffectDef = EffectDef {
    name: "tilt",
    meaning: "A constant acceleration of everything.",
    words: "a constant acceleration (a tilted table)",
    places: &[PlaceKind::World],
    parameters: &[zero("vector", ANY, M_PER_S2, "added acceleration, W axes").vector()],
    equation: "a = vector on every mass, beside gravity: of a table tilted by small angles (α, β) about x and y, g (β, −α, 0).",
    source: "None needed; law in `crates/sim/src/forces/effects.rs`.",
    build: Build::Acceleration(|entry| entry.vector("vector")),
    identify: Identify {
        candidates: Candidates::World(candidates),
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

/// Along the axes on which something moves; not along gravity, of which a tilt takes a second order.
fn candidates(survey: &Survey<'_>) -> Vec<Candidate> {
    let bases = || survey.bodies.iter().filter(|b| b.is_base);
    let moves = |k: usize| bases().any(|b| b.slides()[k]) || !survey.joints.is_empty();
    let strength = survey.gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
    let falls = |k: usize| survey.gravity[k].abs() > ALONG * strength;
    let (shown, held): (Vec<usize>, Vec<usize>) = (0..3).partition(|k| moves(*k) && !falls(*k));
    if shown.is_empty() {
        return Vec::new();
    }
    let vector = Coordinate::vector(["vector[0]", "vector[1]", "vector[2]"], [0.0; 3]);
    vec![Candidate::new("world".to_owned(), vector).screened(&Along::each(shown, 1e-6)).holding(held)]
}

/// Share of gravity from which on it falls along an axis.
const ALONG: f64 = 0.9;
