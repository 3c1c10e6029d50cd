//! Commands that act later.

use super::*;
use parameter::{AT_LEAST_ZERO, zero};
use sim::LineLaw;
use unit::S;

/// A dead time.
pub static ACTUATOR_DELAY: EffectDef = EffectDef {
    name: "actuator-delay",
    meaning: "Commands act later.",
    words: "a delay of the command",
    places: &[PlaceKind::Joint, PlaceKind::Actuator],
    parameters: &[zero("delay", AT_LEAST_ZERO, S, "time from a command to its action")],
    equation: "acting command(t) = command(t − delay); the first command acts until its successor's delayed instant.",
    source: "Held commands, solved exactly; law in `crates/sim/src/parts/effect/line.rs`.",
    build: Build::Command(|entry| LineLaw::Delay(entry.number("delay"))),
    identify: Identify {
        candidates: Candidates::Actuator(candidates),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: None,
        start: Start::Proportional,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::Nothing,
};

/// Delays by which it is screened, s: where commands are held for longer than that, each moves another part of what they do.
const LATE: [f64; 2] = [4e-3, 1.2e-2];

fn candidates(actuator: &ActuatorFact) -> Vec<Candidate> {
    let coordinates = vec![Coordinate::level("delay", 0.0).within([0.0, 0.5])];
    let candidate = Candidate::new(actuator.place.clone(), coordinates);
    let mut late = LATE.iter().fold(candidate, |all, late| all.screened_at("", &[vec![*late]]));
    late.is_expensive = actuator.largest_command == 0.0;
    vec![late]
}
