//! Joints at which nothing is missing, by the likelihood of the forces that are unknown there.

use super::left::quieting;
use super::search::bare;
use crate::error::DiagnoseError;
use crate::held::holds;
use crate::hypothesis::Hypothesis;
use crate::identify::fit::{Fitted, Problem};
use crate::identify::forces::Force;
use crate::identify::marginal::{Chain, Spread, score};
use std::collections::BTreeSet;

/// Rise of the likelihood without a joint's unknown force, as a share of the largest, below which nothing is missing there; and the largest one from which on
/// forces say anything (half a χ² exceeds it once in a thousand times).
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
        let mut own = problem.forces.iter().zip(&rises).filter(|(f, _)| f.place == *place);
        let rise = own.clone().map(|(_, rise)| *rise).reduce(f64::max);
        let is_still = rise.is_some_and(|r| r < DULL * largest) && !own.any(|(f, _)| reads_loud(now, problem, f));
        largest > SPEAKING && place.starts_with("joint:") && is_still
    };
    problem.forces.iter().map(|f| f.place.clone()).filter(is_dull).collect()
}

/// Whether a sensor of a force's joint reads with more noise than it has: a force that comes and goes faster than intervals do is taken for that.
fn reads_loud(now: &Fitted, problem: &Problem<'_>, force: &Force) -> bool {
    let readings = || problem.stage.tapes.iter().flat_map(|t| &t.readings);
    let reads = |channel: &String| {
        readings().any(|r| r.channel == *channel && force.joint().is_some() && r.quantity.motion_of() == force.joint())
    };
    let mut noises = problem.channels.iter().zip(&now.spread.noise);
    noises.any(|(channel, noise)| quieting(*noise, problem.stage.doubt).is_some() && reads(channel))
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
