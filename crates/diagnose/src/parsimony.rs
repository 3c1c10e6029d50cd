//! No more than the data ask for: members that can be taken out again, laws that have grown into plainer ones.
//!
//! A law that came first as the synonym of the right one has company that mends what it is not; one that is richer than the truth spends its
//! further numbers on what no law of the library takes away. Both go here, by the criterion of the search.

use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::fit::{Effort, Fit, fit};
use crate::hypothesis::{Alternative, Hypothesis};
use crate::linear::Stage;
use crate::plant::Plant;
use crate::search::{END, LOOK, TIE, WHOLE, errors};
use crate::select::search::takes_little;
use crate::standing::{Standing, criterion};
use crate::work::Until;

/// Fits of a set that may be far off.
const GLANCE: Effort = Effort { iterations: 2, share: 2e-2, floor: 0.1, ..Effort::NUMBERS };
/// Growth of the error by which a member that is taken out shows that it is needed.
const NECESSARY: f64 = 1.3;
/// The same by which a plainer law shows that it cannot do what another does.
const PLAINER: f64 = 2.0;
/// Cost, as a share of what noise leaves, by which it may predict worse and still be as good: a four-hundredth of the noise.
const AS_GOOD: f64 = 0.005;

/// Puts one member in the place of all where it does alone what they do together: a law that came first as the synonym of a later one has
/// others beside it that mend what it is not.
fn one_for_all(stage: &Stage<'_>, plant: &Plant, now: Standing) -> Result<Standing, DiagnoseError> {
    let set = &now.judge().set;
    let members: Vec<_> = set.findings().collect();
    for (h, x) in members.iter().rev().filter(|_| members.len() > 1) {
        if stage.work.is_spent(Until::Prune) {
            break;
        }
        let alone = set.tolerated().with(h, x);
        let near = fit(stage, plant, alone, now.judge().segments.clone(), LOOK)?;
        if near.rms() > NECESSARY * now.judge().rms() {
            continue;
        }
        let tried = now.refit(stage, plant, near.set, WHOLE)?;
        if !now.is_better(&tried) {
            stage.work.watch.step(&format!("{} alone does as much: {}", h.title(), errors(&tried)));
            return Ok(tried);
        }
    }
    Ok(now)
}

/// Takes out members whose loss the criterion welcomes.
pub(crate) fn prune(stage: &Stage<'_>, plant: &Plant, now: Standing) -> Result<Standing, DiagnoseError> {
    let mut now = one_for_all(stage, plant, now)?;
    let mut member = 0;
    let is_open = |now: &Standing, member| {
        now.judge().set.findings().count() > 1
            && member < now.judge().set.members.len()
            && !stage.work.is_spent(Until::Prune)
    };
    while is_open(&now, member) {
        if now.judge().set.members[member].0.is_tolerated() {
            member += 1;
            continue;
        }
        let less = now.judge().set.without(member);
        // What nothing near can do without stays.
        let near = fit(stage, plant, less.clone(), now.judge().segments.clone(), GLANCE)?;
        if near.rms() > NECESSARY * now.judge().rms() {
            member += 1;
            continue;
        }
        let tried = now.refit(stage, plant, less, LOOK)?;
        if !now.is_better(&tried) {
            let set = tried.judge().set.clone();
            now = tried.refit(stage, plant, set, WHOLE)?;
            member = 0;
        } else {
            member += 1;
        }
    }
    Ok(now)
}

/// Hypotheses and coordinates of what a member of a set becomes where some of its numbers do nothing, as far as they are known.
pub(crate) fn plainer((h, x): &(Hypothesis, Vec<f64>), known: &[Hypothesis]) -> Vec<(Hypothesis, Vec<f64>)> {
    let others = if h.is_tolerated() { Vec::new() } else { h.plainer(x) };
    let of = |other: Alternative| {
        let is_here = |p: &&Hypothesis| p.name == other.name && (p.place == h.place || other.is_at_contact);
        let plain = known.iter().find(is_here)?;
        // What a law has had to free its plainer form has free too.
        let free = plain.relaxed(&other.coordinates).filter(|_| h.reserve.is_empty());
        let plain = free.map_or_else(|| plain.clone(), |(free, _)| free);
        let held = [&plain.held[..], &other.held[..]].concat();
        Some((Hypothesis { held, ..plain }, other.coordinates))
    };
    others.into_iter().filter_map(of).collect()
}

/// What has gone from a set, and what stands in its place.
pub(crate) struct Replaced {
    pub gone: String,
    pub by: Hypothesis,
    /// Whether that was in the set before.
    pub was_there: bool,
}

/// Puts a plainer law in the place of one that has grown into it, and a likelier one in that of its equal; what was replaced.
pub(crate) fn simplify(
    stage: &Stage<'_>,
    plant: &Plant,
    mut now: Standing,
    (all, brought): (&[Hypothesis], f64),
) -> Result<(Standing, Vec<Replaced>), DiagnoseError> {
    let mut replaced = Vec::new();
    for grown in now.judge().set.titles() {
        let member = |now: &Standing| now.judge().set.titles().iter().position(|title| *title == grown);
        let Some(at) = member(&now) else { continue };
        for (plain, x) in plainer(&now.judge().set.members[at], all) {
            let Some(tried) = tried_instead(stage, plant, &now, (at, (&plain, &x), brought))? else { continue };
            stage.work.watch.step(&format!("{} is enough: {}", plain.title(), errors(&tried)));
            let was_there = now.judge().set.has_finding(&plain);
            replaced.push(Replaced { gone: grown.clone(), by: plain, was_there });
            now = tried;
            break;
        }
    }
    Ok((now, replaced))
}

/// A standing with another law in the place of a member, where that is as good; `brought`: what the last round's effects have taken from the cost.
fn tried_instead(
    stage: &Stage<'_>,
    plant: &Plant,
    now: &Standing,
    (member, (plain, x), brought): (usize, (&Hypothesis, &[f64]), f64),
) -> Result<Option<Standing>, DiagnoseError> {
    let set = now.judge().set.instead(member, plain, x);
    let is_far = |near: &Fit| near.rms() > PLAINER * now.judge().rms();
    let of = |set: &EffectSet, effort| fit(stage, plant, set.clone(), now.judge().segments.clone(), effort);
    let near = of(&set, GLANCE)?;
    let released = is_far(&near).then(|| set.released()).and_then(|ends| ends.into_iter().next());
    // What a plainer law cannot do without it may do with what it holds in reserve.
    let near = released.map_or(Ok(near), |free| of(&free, LOOK))?;
    if is_far(&near) {
        return Ok(None);
    }
    let mut tried = now.refit(stage, plant, near.set, LOOK)?;
    let costs = |tried: &Standing| criterion(tried.judge()) - criterion(now.judge());
    // What comes so near by a look is fitted as far as what it would replace.
    if (0.0..TIE * brought).contains(&costs(&tried)) && tried.is_comparable(now) && !tried.judge().converged {
        let set = tried.judge().set.clone();
        tried = tried.refit(stage, plant, set, END)?;
    }
    stage.work.watch.step(&format!("{} instead costs {:.1}", plain.title(), costs(&tried)));
    let is_as_good = costs(&tried) < (AS_GOOD * now.judge().noise).min(TIE * brought) || is_idle(now, &tried, brought);
    Ok((is_as_good && tried.is_comparable(now) || !now.is_better(&tried)).then_some(tried))
}

/// Whether a law does little more than its plainer kind, where both leave what is no noise: what a model leaves that is not in the library is none, and a
/// criterion that takes it for such is sure of anything (ĉ of Burnham and Anderson 2002, ch. 2.5).
fn is_idle(rich: &Standing, plain: &Standing, brought: f64) -> bool {
    let [rich, plain] = [rich, plain].map(Standing::judge);
    rich.is_significant() && takes_little(rich.excess(), plain.excess(), brought + rich.excess())
}
