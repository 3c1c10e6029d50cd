//! Nominal numbers that may be corrected within their tolerances.
//!
//! A member of a set like any effect, but no finding: its coordinates have a normal prior about the nominal value, end three standard deviations from
//! it, cost no slot and no term of the criterion. Beyond that a corrected number has to earn its place as a finding.

use super::hypotheses;
use crate::facts::Facts;
use crate::fit::EffectSet;
use crate::hypothesis::{Coordinate, Hypothesis};
use scenario::spec::Tolerance;

/// Standard deviations at which a number leaves its tolerance.
const LEAVES: f64 = 3.0;

/// The members that a scenario's tolerances make, at their nominal values.
pub fn within(facts: &Facts, tolerance: &Tolerance) -> EffectSet {
    let mut set = EffectSet::default();
    for h in hypotheses(facts) {
        if let Some(h) = tolerated(h, tolerance) {
            set = set.with(&h, &h.neutral());
        }
    }
    set
}

/// The hypothesis with the standard deviations of its coordinates; none where it is exact.
fn tolerated(mut h: Hypothesis, tolerance: &Tolerance) -> Option<Hypothesis> {
    let share = |share: f64, c: &Coordinate| share * c.neutral.abs();
    let trace = || h.coordinates.iter().take(3).map(|c| c.neutral).sum::<f64>() / 3.0;
    let sigma: Vec<f64> = match h.name {
        "body-mass" => h.coordinates.iter().map(|c| share(tolerance.mass, c)).collect(),
        "body-com" => vec![tolerance.com_m; 3],
        "body-inertia" => vec![tolerance.inertia * trace(); 6],
        "actuator-gain" => vec![tolerance.gain],
        // The logarithm of the stiffness; the exponent is the law's.
        "contact-stiffness" => vec![tolerance.contact_stiffness, 0.0],
        "contact-damping" => h.coordinates.iter().map(|c| share(tolerance.contact_damping, c)).collect(),
        "friction-coefficient" => h.coordinates.iter().map(|c| share(tolerance.friction, c)).collect(),
        "sensor-misalignment" => vec![tolerance.mount_deg.to_radians(); 3],
        "sensor-delay" => vec![tolerance.clock_s],
        _ => return None,
    };
    // All thrusters together have no number of their own.
    if sigma.iter().all(|s| *s <= 0.0) || h.place.ends_with('*') {
        return None;
    }
    for (k, (c, s)) in h.coordinates.iter_mut().zip(&sigma).enumerate() {
        if *s > 0.0 {
            c.bounds = [(c.neutral - LEAVES * s).max(c.bounds[0]), (c.neutral + LEAVES * s).min(c.bounds[1])];
        } else if !h.held.contains(&k) {
            h.held.push(k);
        }
    }
    h.tolerance = sigma;
    Some(h)
}
