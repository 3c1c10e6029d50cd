//! Another stiffness of a contact before it slides.

use super::contact::bristle;
use super::*;
use parameter::{AT_LEAST_ZERO, POSITIVE, nominal};
use unit::{N_PER_M, N_S_PER_M};

/// Factors of a stiffness at which it is screened as well: a bristle that is far too stiff slides at once, and does so at half its stiffness.
const FAR: [f64; 4] = [0.02, 0.1, 0.3, 5.0];

/// k and c of the bristle.
pub static FRICTION_BRISTLE_STIFFNESS: EffectDef = EffectDef {
    name: "friction-bristle-stiffness",
    meaning: "Another stiffness before sliding.",
    words: "a wrong pre-sliding stiffness",
    places: &[PlaceKind::Contact],
    parameters: &[
        nominal("k_b", POSITIVE, N_PER_M, "stiffness of a point's bristle"),
        nominal("c_b", AT_LEAST_ZERO, N_S_PER_M, "its damping; the nominal one where it is left out").optional().kept(),
    ],
    equation: "f = −(k_b s + c_b ṡ) below the bound μ fₙ; s: deflection of the bristle.",
    source: "Liang, Fillmore and Ma 2012, after Haessig and Friedland 1991; law in `crates/friction/src/bristle.rs`.",
    build: Build::Pair(|entry, law, _| {
        let law = bristle(law)?;
        law.stiffness = entry.number("k_b");
        law.damping = entry.given("c_b").unwrap_or(law.damping);
        Ok(())
    }),
    identify: Identify {
        candidates: Candidates::Contact(|contact| {
            let Some([_, k_b, c_b]) = contact.bristle else { return Vec::new() };
            let coordinates = vec![Coordinate::log("k_b", k_b, [1e-2 * k_b, 1e2 * k_b]), Coordinate::level("c_b", c_b)];
            let columns = [Along::new(0, 1e-3), Along::new(1, 1e-2 * c_b.max(1.0))];
            let beside = Candidate::new(contact.place(), coordinates).screened(&columns);
            let at = |candidate: Candidate, factor: &f64| {
                let k = factor * k_b;
                candidate.screened_at(&format!("k_b = {k:.2e}"), &[vec![k.ln(), c_b]])
            };
            vec![FAR.iter().fold(beside, at)]
        }),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: None,
        start: Start::Mean,
        minima: Minima::Several,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::ContactLaw,
};
