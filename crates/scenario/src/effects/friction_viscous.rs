//! Friction of a contact that grows with sliding speed.

use super::contact::bristle;
use super::*;
use parameter::{AT_LEAST_ZERO, zero};
use unit::N_S_PER_M;

/// −b v, outside the bound.
pub static FRICTION_VISCOUS: EffectDef = EffectDef {
    name: "friction-viscous",
    meaning: "Friction that grows with sliding speed.",
    words: "friction that grows with sliding speed",
    places: &[PlaceKind::Contact],
    parameters: &[zero("b", AT_LEAST_ZERO, N_S_PER_M, "force over slip speed of a point; added to the nominal one")],
    equation: "−b v beside the bristle and outside its bound; v: slip velocity.",
    source: "A lubricant's film; law in `crates/friction/src/bristle.rs`.",
    build: Build::Pair(|entry, law, _| {
        bristle(law)?.viscous += entry.number("b");
        Ok(())
    }),
    identify: Identify {
        candidates: Candidates::Contact(|contact| match contact.bristle {
            Some(_) => {
                let coordinates = vec![Coordinate::level("b", 0.0)];
                vec![Candidate::new(contact.place(), coordinates).screened(&[Along::new(0, 1e-2)])]
            }
            None => Vec::new(),
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
