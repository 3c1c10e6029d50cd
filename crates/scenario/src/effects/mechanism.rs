//! Struts, bushings, latches and welds that are stiffer or looser, better or worse damped than they were said to be.

use super::*;
use parameter::{AT_LEAST_ZERO, POSITIVE, zero};
use sim::MechanismKind;
use unit::NONE;

/// Factors at which one is screened as well as beside nominal.
const FAR: [f64; 4] = [0.1, 0.4, 2.5, 10.0];

/// Springs.
pub static MECHANISM_STIFFNESS: EffectDef = EffectDef {
    name: "mechanism-stiffness",
    meaning: "Springs of a mechanism over what they were said to be.",
    words: "a wrong stiffness",
    places: &[PlaceKind::Mechanism],
    parameters: &[zero("factor", POSITIVE, NONE, "true over nominal, of all its springs").neutral_at(1.0)],
    equation: "k → factor · k, of a strut along its line, of a bushing, a latch's hold or a weld along and about every axis; stops and preload stay.",
    source: "A linear law scaled; laws in `crates/sim/src/parts/mechanism`.",
    build: Build::Mechanism(|entry, kind| {
        let factor = entry.number("factor");
        if let MechanismKind::Strut(strut) = kind {
            strut.stiffness *= factor;
        }
        if let Some(hold) = kind.hold_mut() {
            hold.stiffness *= factor;
            hold.torsional_stiffness *= factor;
        }
    }),
    identify: Identify {
        candidates: Candidates::Mechanism(|m| if m.has_springs { at(m) } else { Vec::new() }),
        tier: Tier::Nominal,
        tolerance: None,
        penalty: None,
        nested: None,
        start: Start::Mean,
        minima: Minima::Several,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::DataSheet,
};

/// Dampers.
pub static MECHANISM_DAMPING: EffectDef = EffectDef {
    name: "mechanism-damping",
    meaning: "Dampers of a mechanism over what they were said to be.",
    words: "a wrong damping",
    places: &[PlaceKind::Mechanism],
    parameters: &[zero("factor", AT_LEAST_ZERO, NONE, "true over nominal, of all its dampers").neutral_at(1.0)],
    equation: "c → factor · c, of a strut along its line, of a bushing, a latch's hold or a weld along and about every axis; a stop's dissipation stays.",
    source: "A linear law scaled; laws in `crates/sim/src/parts/mechanism`.",
    build: Build::Mechanism(|entry, kind| {
        let factor = entry.number("factor");
        if let MechanismKind::Strut(strut) = kind {
            strut.damping *= factor;
        }
        if let Some(hold) = kind.hold_mut() {
            hold.damping *= factor;
            hold.torsional_damping *= factor;
        }
    }),
    identify: Identify {
        candidates: Candidates::Mechanism(|m| if m.has_dampers { at(m) } else { Vec::new() }),
        tier: Tier::Nominal,
        tolerance: None,
        penalty: None,
        nested: None,
        start: Start::Mean,
        minima: Minima::Several,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::DataSheet,
};

fn at(mechanism: &MechanismFact) -> Vec<Candidate> {
    let coordinates = vec![Coordinate::log("factor", 1.0, [1e-2, 1e2])];
    let beside = Candidate::new(mechanism.place(), coordinates).screened(&[Along::new(0, 1e-3)]);
    let screened =
        |candidate: Candidate, factor: &f64| candidate.screened_at(&format!("factor = {factor}"), &[vec![factor.ln()]]);
    vec![FAR.iter().fold(beside, screened)]
}
