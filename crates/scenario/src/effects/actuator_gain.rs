//! What an actuator delivers over what it is commanded.

use super::*;
use parameter::{ANY, zero};
use sim::LineLaw;
use unit::NONE;

/// A factor.
pub static ACTUATOR_GAIN: EffectDef = EffectDef {
    name: "actuator-gain",
    meaning: "Delivered effort over commanded effort.",
    words: "a wrong actuator gain",
    places: &[PlaceKind::Joint, PlaceKind::Actuator],
    parameters: &[zero("gain", ANY, NONE, "delivered over commanded").neutral_at(1.0)],
    equation: "delivered = gain × commanded, after the actuator's own limit; gains of several entries multiply.",
    source: "Held commands, solved exactly; law in `crates/sim/src/parts/effect/line.rs`.",
    build: Build::Command(|entry| LineLaw::Gain(entry.number("gain"))),
    identify: Identify {
        candidates: Candidates::Actuator(|actuator| {
            let coordinates = vec![Coordinate::free("gain", 1.0)];
            vec![Candidate::new(actuator.place.clone(), coordinates).screened(&[Along::new(0, 1e-4)])]
        }),
        tier: Tier::Exotic,
        tolerance: Some(|tolerance, _| vec![tolerance.gain]),
        penalty: None,
        nested: None,
        start: Start::Mean,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::DataSheet,
};
