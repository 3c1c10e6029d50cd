//! A first-order lag between command and output.

use super::*;
use parameter::{AT_LEAST_ZERO, zero};
use sim::LineLaw;
use unit::S;

/// A time constant.
pub static ACTUATOR_LAG: EffectDef = EffectDef {
    name: "actuator-lag",
    meaning: "A first-order lag between command and output.",
    words: "a lag of the actuator",
    places: &[PlaceKind::Joint, PlaceKind::Actuator],
    parameters: &[zero("time_constant", AT_LEAST_ZERO, S, "time in which the output makes 63 % of a change")],
    equation: "T ė = commanded − e with T = time_constant; e is delivered. A run begins with e settled on its first command.",
    source: "Held commands, solved exactly; law in `crates/sim/src/parts/effect/line.rs`.",
    build: Build::Command(|entry| LineLaw::Lag(entry.number("time_constant"))),
    identify: Identify {
        candidates: Candidates::Actuator(candidates),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: None,
        start: Start::LogProportional,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::Nothing,
};

/// Time constant by which it is screened, s.
const SLOW: f64 = 5e-3;

fn candidates(actuator: &ActuatorFact) -> Vec<Candidate> {
    let coordinates = vec![Coordinate::log("time_constant", SLOW, [1e-5, 2.0])];
    let mut slow = Candidate::new(actuator.place.clone(), coordinates).screened_at("", &[vec![SLOW.ln()]]);
    slow.is_expensive = actuator.largest_command == 0.0;
    vec![slow]
}
