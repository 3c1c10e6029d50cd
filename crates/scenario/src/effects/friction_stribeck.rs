//! Friction of a contact that is higher at rest than in motion.

use super::contact::{LEVELS, TWO_LEVELS, bristle};
use super::friction_coefficient::FRICTION_COEFFICIENT;
use super::*;
use parameter::{AT_LEAST_ZERO, POSITIVE, nominal, shape};
use sim::PairLaw;
use unit::{M_PER_S, NONE};

/// A level that falls with speed.
pub static FRICTION_STRIBECK: EffectDef = EffectDef {
    name: "friction-stribeck",
    meaning: "Friction that is higher at rest than in motion.",
    words: "friction that is higher at breakaway than in sliding (Stribeck)",
    places: &[PlaceKind::Contact],
    parameters: &[
        nominal("mu_s", AT_LEAST_ZERO, NONE, "level at rest"),
        nominal("mu_d", AT_LEAST_ZERO, NONE, "level in fast sliding").kept(),
        shape("v_s", POSITIVE, M_PER_S, "slip speed over which the level falls"),
    ],
    equation: "μ = mu_d + (mu_s − mu_d) exp(−(v/v_s)²), v: slip speed.",
    source: "Stribeck, as in Armstrong-Hélouvry, Dupont and Canudas de Wit 1994; law in `crates/friction/src/bristle.rs`.",
    build: Build::Pair(|entry, law, _| set(entry, law)),
    identify: Identify {
        candidates: Candidates::Contact(candidates),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: Some(|_, x| {
            // A level that falls at no speed that occurs is the static one, and one that falls at once the kinetic one.
            [x[0] + x[1], x[1]].map(|mu| Alternative::here(&FRICTION_COEFFICIENT, vec![mu])).to_vec()
        }),
        start: Start::Mean,
        minima: Minima::Several,
        concerns: Concerns::Motion,
    },
    shown: Shown::FallingLevel { sliding: "mu_d", rest: "mu_s", speed: "v_s" },
    corrects: Corrects::Nothing,
};

fn set(entry: &Entry<'_>, law: &mut PairLaw) -> Result<(), String> {
    let law = bristle(law)?;
    if law.dwell_time > 0.0 {
        return Err(TWO_LEVELS.to_owned());
    }
    let number = |name: &str| entry.number(name);
    (law.mu_static, law.mu_kinetic, law.stribeck_speed) = (number("mu_s"), number("mu_d"), number("v_s"));
    Ok(())
}

fn candidates(contact: &ContactFact) -> Vec<Candidate> {
    let Some([mu, _, _]) = contact.bristle else { return Vec::new() };
    let coordinates = vec![
        Coordinate::level("mu_s", 0.0).within([0.0, LEVELS[1]]),
        Coordinate::level("mu_d", mu).within(LEVELS),
        Coordinate::log("v_s", 5e-3, [1e-5, 1.0]),
    ];
    let falling = Candidate::new(contact.place(), coordinates).encoded(Encoding::Excess { of: 0, over: 1 });
    vec![falling.screened_on(2, &log_grid(5e-4, 0.064, 1.0), &Along::each(0..2, 1e-5))]
}
