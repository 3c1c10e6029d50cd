//! The tidal torque of a body in orbit.

use super::*;
use parameter::{AT_LEAST_ZERO, zero};
use sim::Load;
use unit::RAD_PER_S;

/// 3 n² r̂ × (I r̂).
pub static GRAVITY_GRADIENT: EffectDef = EffectDef {
    name: "gravity-gradient",
    meaning: "The tidal torque in orbit.",
    words: "the gravity gradient's torque",
    places: &[PlaceKind::Body],
    parameters: &[zero("mean_motion", AT_LEAST_ZERO, RAD_PER_S, "n: mean motion of the orbit")],
    equation: "3 n² r̂ × (I r̂) with r̂ = (cos nt, sin nt, 0) in the world frame: x towards the zenith at t = 0, z along the orbit's normal. The torque alone.",
    source: "A small body on a circular orbit, Hughes 1986, section 8.1; law in `crates/sim/src/parts/effect/body/load.rs`.",
    build: Build::Load(|entry| Load::GravityGradient { mean_motion: entry.number("mean_motion") }),
    identify: Identify {
        candidates: Candidates::Body(candidates),
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

/// The torque goes with the square of the mean motion.
fn candidates(body: &BodyFact, _: &Survey<'_>) -> Vec<Candidate> {
    if !body.tumbles() {
        return Vec::new();
    }
    let tide = Candidate::new(body.place(), vec![Coordinate::level("mean_motion", 0.0)]).encoded(Encoding::Squared);
    vec![tide.screened(&[Along::new(0, 1e-7)])]
}
