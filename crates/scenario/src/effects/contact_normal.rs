//! Other numbers in the normal law of a contact: stiffness, damping, and a force that resists parting.

use super::contact::{DEAD_WEIGHT, set_stiffness};
use super::*;
use ::contact::NormalLaw;
use parameter::{AT_LEAST_ZERO, POSITIVE, nominal, zero};
use unit::{N, N_PER_M_EXP, NONE, S_PER_M};

const SOURCE: &str = "Hunt and Crossley 1975; law in `crates/contact/src/normal.rs`.";

/// k and n.
pub static CONTACT_STIFFNESS: EffectDef = EffectDef {
    name: "contact-stiffness",
    meaning: "Another stiffness of a contact.",
    words: "a wrong contact stiffness",
    places: &[PlaceKind::Contact],
    parameters: &[
        nominal("k", POSITIVE, N_PER_M_EXP, "stiffness; of a linear law N/m"),
        nominal("n", POSITIVE, NONE, "exponent; that of the nominal law where it is left out").optional().kept(),
    ],
    equation: "k δⁿ in the place of the nominal spring; δ: penetration.",
    source: SOURCE,
    build: Build::Pair(|entry, law, _| set_stiffness(&mut law.normal.law, entry.number("k"), entry.given("n"))),
    identify: Identify {
        candidates: Candidates::Contact(|contact| {
            let Some([k, n, _]) = contact.moving_normal() else { return Vec::new() };
            let coordinates =
                vec![Coordinate::log("k", k, [1e-3 * k, 1e3 * k]), Coordinate::free("n", n).within([1.0, 3.0])];
            let columns = [Along::new(0, 1e-4), Along::new(1, 1e-5)];
            let law = Encoding::PowerLaw { exponent: n };
            let stiffness = Candidate::new(contact.place(), coordinates).encoded(law);
            vec![match contact.is_linear {
                true => stiffness.screened(&columns[..1]).holding(vec![1]),
                false => stiffness.screened(&columns),
            }]
        }),
        tier: Tier::Nominal,
        tolerance: Some(|tolerance, _| {
            // The logarithm of the stiffness; the exponent is the law's.
            vec![tolerance.contact_stiffness, 0.0]
        }),
        penalty: None,
        nested: None,
        start: Start::Mean,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::ContactLaw,
};

/// d, or c of a linear law.
pub static CONTACT_DAMPING: EffectDef = EffectDef {
    name: "contact-damping",
    meaning: "Another damping of a contact.",
    words: "a wrong contact damping",
    places: &[PlaceKind::Contact],
    parameters: &[nominal("c", AT_LEAST_ZERO, S_PER_M, "dissipation d; of a linear law the damping in N s/m")],
    equation: "k δⁿ (1 + c δ̇) in the place of the nominal damper; k δ + c δ̇ of a linear law.",
    source: SOURCE,
    build: Build::Pair(|entry, law, _| set_damping(&mut law.normal.law, entry.number("c"))),
    identify: Identify {
        candidates: Candidates::Contact(|contact| {
            let Some([_, _, c]) = contact.moving_normal() else { return Vec::new() };
            let coordinates = vec![Coordinate::level("c", c)];
            vec![Candidate::new(contact.place(), coordinates).screened(&[Along::new(0, 1e-3 * c.max(0.1))])]
        }),
        tier: Tier::Nominal,
        tolerance: Some(|tolerance, c| c.iter().map(|c| tolerance.contact_damping * c.neutral.abs()).collect()),
        penalty: None,
        nested: None,
        start: Start::Mean,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::ContactLaw,
};

/// A pull-off force.
pub static ADHESION: EffectDef = EffectDef {
    name: "adhesion",
    meaning: "A force that resists parting.",
    words: "adhesion",
    places: &[PlaceKind::Contact],
    parameters: &[zero("force", AT_LEAST_ZERO, N, "pull-off force of each point, added to the nominal one")],
    equation: "fₙ − force while the surfaces overlap; friction goes with fₙ alone.",
    source: "A constant cohesive force; law in `crates/contact/src/normal.rs`.",
    build: Build::Pair(|entry, law, _| {
        law.normal.adhesion += entry.number("force");
        Ok(())
    }),
    identify: Identify {
        candidates: Candidates::Contact(|contact| match contact.moving_normal() {
            Some(_) => {
                let coordinates = vec![Coordinate::level("force", 0.0)];
                vec![Candidate::new(contact.place(), coordinates).screened(&[Along::new(0, 1e-3)])]
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

fn set_damping(law: &mut NormalLaw, c: f64) -> Result<(), String> {
    match law {
        NormalLaw::HuntCrossley { dissipation, .. } => *dissipation = c,
        NormalLaw::SpringDamper { damping, .. } => *damping = c,
        NormalLaw::Constant { .. } => return Err(DEAD_WEIGHT.to_owned()),
    }
    Ok(())
}
