//! The pull of a hose or tether: a spring and a damper from a body's origin to an anchor.

use super::drag::LINEAR_DRAG;
use super::friction_viscous::FRICTION_VISCOUS;
use super::*;
use parameter::{ANY, AT_LEAST_ZERO, shape, zero};
use sim::Load;
use unit::{M, N_PER_M, N_S_PER_M};

/// −k (x − a) − d ẋ.
pub static TETHER_STIFFNESS: EffectDef = EffectDef {
    name: "tether-stiffness",
    meaning: "A spring and damper to an anchor.",
    words: "the pull of a hose or tether",
    places: &[PlaceKind::Body],
    parameters: &[
        zero("k", AT_LEAST_ZERO, N_PER_M, "stiffness"),
        zero("d", AT_LEAST_ZERO, N_S_PER_M, "damping against the world").optional(),
        shape("anchor", ANY, M, "a: where it pulls to, W axes").vector(),
    ],
    equation: "−k (x − a) − d ẋ at the origin x of the link; its length at rest is zero.",
    source: "A hose taken as linear; law in `crates/sim/src/parts/effect/body/load.rs`.",
    build: Build::Load(|entry| Load::Tether {
        k: entry.number("k"),
        d: entry.number("d"),
        anchor: entry.vector("anchor"),
    }),
    identify: Identify {
        candidates: Candidates::Body(candidates),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: Some(|_, x| {
            // What slides under its own weight cannot tell drag from viscous friction.
            vec![Alternative::here(&LINEAR_DRAG, vec![x[4]]), Alternative::at_contact(&FRICTION_VISCOUS, vec![x[4]])]
        }),
        start: Start::Mean,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::Nothing,
};

fn candidates(body: &BodyFact, _: &Survey<'_>) -> Vec<Candidate> {
    let mask = body.shifts();
    if !mask.contains(&true) {
        return Vec::new();
    }
    let mut coordinates = vec![Coordinate::level("k", 0.0)];
    coordinates.extend(Coordinate::vector(["anchor[0]", "anchor[1]", "anchor[2]"], [0.0; 3]));
    coordinates.push(Coordinate::level("d", 0.0));
    let mut columns = vec![Along::new(0, 1e-3)];
    columns.extend(Along::each((0..3).filter(|k| mask[*k]).map(|k| 1 + k), 1e-4));
    columns.push(Along::new(4, 1e-3));
    let tether = Candidate::new(body.place(), coordinates).encoded(Encoding::Anchored).screened(&columns);
    vec![tether.holding((0..3).filter(|k| !mask[*k]).map(|k| 1 + k).collect()).asked_last(!body.is_base)]
}
