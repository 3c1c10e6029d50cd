//! A bound of what an actuator delivers.

use super::*;
use parameter::{AT_LEAST_ZERO, zero};
use sim::LineLaw;
use unit::EFFORT;

/// A limit.
pub static ACTUATOR_SATURATION: EffectDef = EffectDef {
    name: "actuator-saturation",
    meaning: "A bound of the output.",
    words: "saturation of the actuator",
    places: &[PlaceKind::Joint, PlaceKind::Actuator],
    parameters: &[zero("limit", AT_LEAST_ZERO, EFFORT, "largest output, either way").neutral_at(f64::INFINITY)],
    equation: "output = what would be delivered, within ±limit; the smallest limit of several entries holds.",
    source: "Held commands, solved exactly; law in `crates/sim/src/parts/effect/line.rs`.",
    build: Build::Command(|entry| LineLaw::Saturation(entry.number("limit"))),
    identify: Identify {
        candidates: Candidates::Actuator(candidates),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: None,
        start: Start::Mean,
        minima: Minima::Several,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::Nothing,
};

/// Where commands are only on and off a limit is a gain.
fn candidates(actuator: &ActuatorFact) -> Vec<Candidate> {
    let largest = actuator.largest_command;
    if largest <= 0.0 {
        return Vec::new();
    }
    let coordinates = vec![Coordinate::log("limit", 0.8 * largest, [1e-3 * largest, largest])];
    let at = |share: f64| vec![vec![(share * largest).ln()]];
    let limited = Candidate::new(actuator.place.clone(), coordinates)
        .screened_at("limit 0.9 of the largest command", &at(0.9))
        .screened_at("limit 0.7 of the largest command", &at(0.7))
        .screened_at("limit 0.4 of the largest command", &at(0.4))
        .screened_at("limit 0.15 of the largest command", &at(0.15));
    vec![limited]
}
