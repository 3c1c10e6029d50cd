//! What definitions of joint effects share: first steps, and levels that are screened one by one.

use super::candidate::{Along, Candidate, Coordinate};
use super::facts::JointFact;

/// Effort beside which a first step is small, N·m.
pub(super) const SMALL: f64 = 1e-3;

/// Levels of a joint, each with a column at zero.
pub(super) fn each_screened(joint: &JointFact, levels: &[&'static str]) -> Vec<Candidate> {
    let coordinates = levels.iter().map(|key| Coordinate::level(key, 0.0)).collect();
    vec![Candidate::new(joint.place(), coordinates).screened(&Along::each(0..levels.len(), SMALL))]
}
