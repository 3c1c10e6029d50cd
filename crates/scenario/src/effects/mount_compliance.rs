//! An elastic mount behind a contact part.

use super::*;
use crate::build::{Tip, add_mount};
use parameter::{AT_LEAST_ZERO, POSITIVE, shape, zero};
use std::f64::consts::TAU;
use unit::{KG, N_PER_M, N_S_PER_M};

/// A tip on a spring.
pub static MOUNT_COMPLIANCE: EffectDef = EffectDef {
    name: "mount-compliance",
    meaning: "An elastic mount behind a contact part.",
    words: "an elastic mount behind the contact",
    places: &[PlaceKind::Body, PlaceKind::Contact],
    parameters: &[
        zero("k", POSITIVE, N_PER_M, "stiffness, the same in every direction").neutral_at(f64::INFINITY),
        zero("d", AT_LEAST_ZERO, N_S_PER_M, "damping").optional(),
        shape("m", POSITIVE, KG, "mass of the tip, taken out of the body; 0.8 kg where it is left out")
            .optional()
            .kept(),
    ],
    equation: "m ü = F_contact − k u − d u̇ and what the body's motion carries; u: displacement of the tip in the body's axes. The tip carries the \
               first-named part and does not turn against the body. A force sensor behind the mount reads k u + d u̇.",
    source: "A point on three springs; joints of the tree in `crates/scenario/src/build/effects/mount.rs`.",
    build: Build::Mount(|entry, parts, faults| {
        // At an infinite stiffness there is no mount.
        let tip = entry.given("m").unwrap_or(TIP_MASS);
        add_mount(entry, parts, Tip { mass: tip, stiffness: entry.number("k"), damping: entry.number("d") }, faults);
    }),
    identify: Identify {
        candidates: Candidates::Contact(candidates),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: None,
        start: Start::LogInverse,
        minima: Minima::Several,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::Nothing,
};

/// Mass of a tip of which nothing is said, kg: a probe's ball with a piece of its rod.
const TIP_MASS: f64 = 0.8;

/// Frequencies, Hz, at which the lighter body would swing on the mounts that are screened.
const FREQUENCIES: [f64; 4] = [1.5, 3.0, 6.0, 12.0];

fn candidates(contact: &ContactFact) -> Vec<Candidate> {
    if contact.moving_normal().is_none() {
        return Vec::new();
    }
    let mass = contact.mass;
    let m = TIP_MASS.min(0.02 * mass);
    let of = |f: f64| (TAU * f).powi(2) * mass;
    let [soft, stiff] = [of(FREQUENCIES[0]), of(FREQUENCIES[FREQUENCIES.len() - 1])];
    let usual = (soft * stiff).sqrt();
    let coordinates = vec![
        Coordinate::log("k", usual, [1e-2 * soft, 1e3 * stiff]),
        Coordinate::level("d", 0.05 * (usual * mass).sqrt()),
        Coordinate::log("m", m, [1e-4 * mass, 0.3 * mass]),
    ];
    let screened = |mount: Candidate, f: &f64| {
        let k = of(*f);
        let point = |ratio: f64| vec![k.ln(), ratio * (k * mass).sqrt(), m.ln()];
        mount.screened_at(&format!("k = {k:.2e}"), &[point(0.02), point(0.1)])
    };
    vec![FREQUENCIES.iter().fold(Candidate::new(contact.place(), coordinates), screened)]
}
