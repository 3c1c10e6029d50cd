//! Friction of a contact that depends on the direction of sliding.

use super::contact::{LEVELS, bristle};
use super::friction_coefficient::FRICTION_COEFFICIENT;
use super::*;
use friction::Bristle;
use parameter::{ANY, AT_LEAST_ZERO, nominal, shape};
use unit::{NONE, RAD};

/// An ellipse of levels.
pub static FRICTION_ANISOTROPY: EffectDef = EffectDef {
    name: "friction-anisotropy",
    meaning: "Friction that depends on direction.",
    words: "friction that depends on the direction of sliding",
    places: &[PlaceKind::Contact],
    parameters: &[
        nominal("mu_1", AT_LEAST_ZERO, NONE, "level along the direction; above zero"),
        nominal("mu_2", AT_LEAST_ZERO, NONE, "level across it"),
        shape("angle", ANY, RAD, "the direction in the contact plane"),
    ],
    equation: "1/μ(φ)² = cos²φ/mu_1² + sin²φ/mu_2², φ from the direction to the slip. The direction is the second-named part's axis (a docking shape) or its \
               link's x, laid into the plane and turned by angle about the outward normal.",
    source: "Zmitrowicz 1989; law in `crates/friction/src/ellipse.rs`.",
    build: Build::Pair(|entry, law, grain| {
        set_ellipse(bristle(law)?, entry.number("mu_1"), entry.number("mu_2"))?;
        law.grain = Some(Grain { angle: entry.number("angle"), ..grain });
        Ok(())
    }),
    identify: Identify {
        candidates: Candidates::Contact(candidates),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: Some(one_level),
        start: Start::Mean,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Ellipse { along: "mu_1", across: "mu_2", angle: "angle" },
    corrects: Corrects::Nothing,
};

fn set_ellipse(law: &mut Bristle, along: f64, across: f64) -> Result<(), String> {
    if along <= 0.0 {
        return Err("needs mu_1 above zero: turn the angle by 90 deg and exchange the levels".to_owned());
    }
    law.mu_static = if law.mu_static == law.mu_kinetic { along } else { law.mu_static * (along / law.mu_kinetic) };
    (law.mu_kinetic, law.across) = (along, across / along);
    Ok(())
}

/// What slides one way shows one point of the ellipse: the level there is anywhere between the two.
fn one_level(_: &str, x: &[f64]) -> Vec<Alternative> {
    let (level, half) = (x[0], x[1].hypot(x[2]));
    [level + half, level, level - half]
        .into_iter()
        .map(|mu| Alternative::here(&FRICTION_COEFFICIENT, vec![mu]))
        .collect()
}

/// Level and ellipse in the place of two levels and an angle, which has no value where the levels are one.
fn candidates(contact: &ContactFact) -> Vec<Candidate> {
    let Some([mu, _, _]) = contact.bristle else { return Vec::new() };
    let coordinates = vec![
        Coordinate::level("mu_1", mu).within(LEVELS),
        Coordinate::free("mu_2", 0.0),
        Coordinate::free("angle", 0.0),
    ];
    let ellipse = Candidate::new(contact.place(), coordinates).encoded(Encoding::Ellipse);
    vec![ellipse.screened(&Along::each(0..3, 1e-5))]
}
