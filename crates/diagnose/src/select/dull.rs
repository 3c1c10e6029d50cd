//! Joints at which nothing is missing, by the likelihood of the forces that are unknown there.

use super::search::bare;
use crate::error::DiagnoseError;
use crate::held::holds;
use crate::hypothesis::Hypothesis;
use crate::identify::fit::{Fitted, Problem};
use crate::identify::forces::Force;
use crate::identify::marginal::{Chain, Spread, score};
use std::collections::BTreeSet;

/// Rise of the likelihood without a joint's unknown force, as a share of the largest, below which nothing is missing there; and the largest one from which on
/// forces say anything (half a χ² exceeds it once in a thousand times): what is faster than intervals may have been taken for noise.
const DULL: f64 = 0.003;
const SPEAKING: f64 = 9.5;

/// Hypotheses that are not in a set yet, at joints where a force is missing.
pub(super) fn open(all: Vec<Hypothesis>, now: &Fitted, problem: &Problem<'_>, bare: &[Chain]) -> Vec<Hypothesis> {
    let dull = dull(now, problem, bare);
    let still_open = |h: Hypothesis| now.set.still_open(h);
    all.into_iter().filter(|h| !dull.contains(&h.place)).filter_map(still_open).collect()
}

/// Places of joints at which nothing is missing beside a fit, where more is somewhere else.
pub(super) fn dull_beside(now: &Fitted, problem: &Problem<'_>) -> Result<BTreeSet<String>, DiagnoseError> {
    if !tells_joints_apart(now, problem) {
        return Ok(BTreeSet::new());
    }
    Ok(dull(now, problem, &bare(problem, now)?))
}

fn dull(now: &Fitted, problem: &Problem<'_>, bare: &[Chain]) -> BTreeSet<String> {
    if !tells_joints_apart(now, problem) {
        return BTreeSet::new();
    }
    let at = |spread: &Spread| score(bare, spread);
    let here = at(&now.spread);
    let without = |j: usize| {
        let mut spread = now.spread.clone();
        spread.force[j] = 0.0;
        at(&spread) - here
    };
    let rises: Vec<f64> = (0..problem.forces.len()).map(without).collect();
    let largest = rises.iter().copied().fold(0.0, f64::max);
    let is_dull = |place: &String| {
        let own = problem.forces.iter().zip(&rises).filter(|(f, _)| f.place == *place);
        let rise = own.map(|(_, rise)| *rise).reduce(f64::max);
        largest > SPEAKING && place.starts_with("joint:") && rise.is_some_and(|r| r < DULL * largest)
    };
    problem.forces.iter().map(|f| f.place.clone()).filter(is_dull).collect()
}

/// Whether a joint's force is its own: what holds passes it on to where it is held, numbers that may be off by a tolerance take it on as far as they can, and
/// where a joint is not read (a wheel) its force and its base's are one.
fn tells_joints_apart(now: &Fitted, problem: &Problem<'_>) -> bool {
    !holds(&now.built) && problem.plant.scenario.tolerance.is_exact() && all_read(problem)
}

/// Whether some sensor reads every joint that a force may be missing at.
fn all_read(problem: &Problem<'_>) -> bool {
    let readings = || problem.stage.tapes.iter().flat_map(|t| &t.readings);
    problem.forces.iter().filter_map(Force::joint).all(|j| readings().any(|r| r.quantity.motion_of() == Some(j)))
}
