//! Breakaway of a contact that grows with the time at rest.

use super::contact::{LEVELS, TWO_LEVELS, bristle};
use super::*;
use parameter::{AT_LEAST_ZERO, POSITIVE, nominal, shape};
use sim::PairLaw;
use unit::{NONE, S};

/// A level that returns at rest.
pub static FRICTION_DWELL_TIME: EffectDef = EffectDef {
    name: "friction-dwell-time",
    meaning: "Breakaway that grows with time at rest.",
    words: "breakaway friction that grows with time at rest",
    places: &[PlaceKind::Contact],
    parameters: &[
        nominal("mu_s_inf", AT_LEAST_ZERO, NONE, "level after a long rest"),
        shape("time_constant", POSITIVE, S, "time in which it grows").kept(),
    ],
    equation: "μ = mu + (mu_s_inf − mu) σ, σ̇ = (h − σ)/T with h = exp(−(v/1 mm/s)²), T = time_constant while σ rises and 2 ms while it falls.",
    source: "After Gonthier, McPhee, Lange and Piedbœuf 2004; law in `crates/friction/src/levels.rs`.",
    build: Build::Pair(|entry, law, _| set(entry, law)),
    identify: Identify {
        candidates: Candidates::Contact(candidates),
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

/// Slip speed over which rest is lost, m/s, and how fast that goes, s.
const LOSING_SPEED: f64 = 1e-3;
const LOSING_TIME: f64 = 2e-3;

fn set(entry: &Entry<'_>, law: &mut PairLaw) -> Result<(), String> {
    let law = bristle(law)?;
    if law.mu_static != law.mu_kinetic {
        return Err(TWO_LEVELS.to_owned());
    }
    (law.mu_static, law.dwell_time) = (entry.number("mu_s_inf"), entry.number("time_constant"));
    (law.stribeck_speed, law.fall_time) = (LOSING_SPEED, LOSING_TIME);
    Ok(())
}

/// Dwell times (s) and breakaway levels (in sliding ones) at which a contact that gains strength at rest is screened.
const DWELLS: [f64; 4] = [0.05, 0.2, 0.8, 3.2];
const STRONGER: [f64; 2] = [1.1, 1.3];

fn candidates(contact: &ContactFact) -> Vec<Candidate> {
    let Some([mu, _, _]) = contact.bristle else { return Vec::new() };
    let coordinates =
        vec![Coordinate::level("mu_s_inf", mu).within(LEVELS), Coordinate::log("time_constant", 0.3, [1e-3, 100.0])];
    // What slides in the nominal model has no rest that could make it stronger: it has to hold for that, so that only secants tell.
    let mut dwell = Candidate::new(contact.place(), coordinates);
    for time in DWELLS {
        for by in STRONGER {
            let label = format!("time_constant = {time:.2}, {by:.1} mu");
            dwell = dwell.screened_at(&label, &[vec![by * mu, time.ln()]]);
        }
    }
    vec![dwell]
}
