//! Another sliding level of a contact's friction.

use super::contact::LEVELS;
use super::*;
use friction::Friction;
use parameter::{AT_LEAST_ZERO, nominal};
use sim::PairLaw;
use unit::NONE;

/// μ.
pub static FRICTION_COEFFICIENT: EffectDef = EffectDef {
    name: "friction-coefficient",
    meaning: "Another sliding level of friction.",
    words: "a wrong friction coefficient",
    places: &[PlaceKind::Contact],
    parameters: &[nominal("mu", AT_LEAST_ZERO, NONE, "the true sliding level")],
    equation: "μ = mu in sliding; the level at rest goes with it where the nominal law has one level.",
    source: "Coulomb; law in `crates/friction/src/bristle.rs`.",
    build: Build::Pair(|entry, law, _| set_level(law, entry.number("mu"))),
    identify: Identify {
        candidates: Candidates::Contact(|contact| {
            let Some([mu, _, _]) = contact.bristle else { return Vec::new() };
            let coordinates = vec![Coordinate::level("mu", mu).within(LEVELS)];
            vec![Candidate::new(contact.place(), coordinates).screened(&[Along::new(0, 1e-5)])]
        }),
        tier: Tier::Nominal,
        tolerance: Some(|tolerance, c| c.iter().map(|c| tolerance.friction * c.neutral.abs()).collect()),
        penalty: None,
        nested: None,
        start: Start::Mean,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::ContactLaw,
};

/// The sliding level; the level at rest with it where they are one.
fn set_level(law: &mut PairLaw, mu: f64) -> Result<(), String> {
    let (at_rest, sliding) = match &mut law.friction {
        Some(Friction::Bristle(law)) => (&mut law.mu_static, &mut law.mu_kinetic),
        Some(Friction::Coulomb(law)) => (&mut law.mu_static, &mut law.mu_kinetic),
        Some(Friction::LuGre(law)) => (&mut law.mu_static, &mut law.mu_kinetic),
        None => return Err("meets a contact without friction; give it friction = { law = \"bristle\", … }".to_owned()),
    };
    if *at_rest == *sliding {
        *at_rest = mu;
    }
    *sliding = mu;
    Ok(())
}
