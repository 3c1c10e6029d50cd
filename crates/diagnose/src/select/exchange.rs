//! Laws against their equals, once all others stand beside them.
//!
//! An equal is a law that did as much alone at the same place, or that promised as much at any place: a heavier arm, a rotor and a load swing alike, and
//! which of them took its place first hangs on what was not known then.
//! What a law was chosen for over another one at its place may have been what a further effect does, which nobody knew of then: a command that is late by a
//! dead time and one that lags differ by little, and a payload beside them tips the scales. At the end each is fitted in the other's place.

use super::kin::are_kin;
use super::search::{FAR, GLANCE, LOOK, Tried, criterion, to_the_end};
use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::hypothesis::Hypothesis;
use crate::identify::fit::{Fitted, Problem};
use crate::screen::Score;
use crate::work::Until;

/// A fit with members as what was tried at their places beside fewer, where that is better by the criterion now.
pub(super) fn exchanged(
    problem: &Problem<'_>,
    mut now: Fitted,
    (tried, shown): (&[Tried], &[(Hypothesis, Score)]),
    many: usize,
) -> Result<Fitted, DiagnoseError> {
    let all: Vec<Hypothesis> = now.set.findings().map(|(h, _)| h.clone()).collect();
    for member in &all {
        // One alone was held against all others at its place as it is.
        let here = if all.len() > 1 { equals(member, &now.set, tried) } else { Vec::new() };
        let titles: Vec<String> = here.iter().map(|(h, _)| h.title()).collect();
        let elsewhere = promised(member, &now.set, shown).into_iter().filter(|(h, _)| !titles.contains(&h.title()));
        for (equal, x) in here.iter().cloned().chain(elsewhere) {
            if problem.stage.work.is_spent(Until::Prune) {
                return Ok(now);
            }
            let Some(at) = now.set.members.iter().position(|m| m.0.title() == member.title()) else { break };
            let Ok(glance) = problem.fit(&now, now.set.without(at).with(&equal, &x), GLANCE) else { continue };
            if criterion(&glance, many) - criterion(&now, many) > FAR {
                continue;
            }
            let Ok(look) = problem.fit(&glance, glance.set.clone(), LOOK) else { continue };
            let costs = criterion(&look, many) - criterion(&now, many);
            problem.stage.work.watch.step(&format!("  {} in the place of its equal costs {costs:.1}", equal.title()));
            if costs < 0.0 {
                now = to_the_end(problem, look);
            }
        }
    }
    Ok(now)
}

/// Share of the gain of the best law at a place from which on another one there is its equal.
const EQUAL: f64 = 0.9;

/// What promised as much as a member did alone, each from where the chain saw it; without what is in the set, and what is akin to others there.
fn promised(member: &Hypothesis, set: &EffectSet, shown: &[(Hypothesis, Score)]) -> Vec<(Hypothesis, Vec<f64>)> {
    let own = shown.iter().filter(|(h, _)| h.title() == member.title()).map(|(_, s)| s.score).fold(0.0, f64::max);
    let mut all: Vec<(Hypothesis, Vec<f64>)> = Vec::new();
    for (h, score) in shown.iter().filter(|(_, s)| own > 0.0 && s.score >= EQUAL * own) {
        let is_known = set.members.iter().map(|m| &m.0).chain(all.iter().map(|a| &a.0)).any(|k| k.title() == h.title());
        let mut others = set.members.iter().map(|m| &m.0).filter(|m| m.title() != member.title());
        if !is_known && !others.any(|other| are_kin(h, other)) {
            all.push((h.clone(), score.start.clone()));
        }
    }
    all.truncate(PROMISED);
    all
}

/// How many of them are fitted.
const PROMISED: usize = 3;

/// What was tried alone at the place of a member and did as much as any there, as it was last found; without what is in the set.
fn equals(member: &Hypothesis, set: &EffectSet, tried: &[Tried]) -> Vec<(Hypothesis, Vec<f64>)> {
    let mut all: Vec<(Hypothesis, Vec<f64>)> = Vec::new();
    let is_here = |t: &&Tried| {
        t.added.len() == 1 && t.set.findings().any(|(h, _)| h.place == member.place && t.added[0] == h.title())
    };
    let gain = |t: &Tried| t.criteria[0] - t.criteria[1];
    let best = |round: usize| tried.iter().filter(is_here).filter(|t| t.round == round).map(gain).fold(0.0, f64::max);
    for one in tried.iter().rev().filter(is_here).filter(|t| gain(t) > 0.0 && gain(t) >= EQUAL * best(t.round)) {
        for (h, x) in one.set.findings().filter(|(h, _)| h.place == member.place && one.added.contains(&h.title())) {
            let is_known =
                set.members.iter().map(|m| &m.0).chain(all.iter().map(|a| &a.0)).any(|k| k.title() == h.title());
            if !is_known {
                all.push((h.clone(), x.clone()));
            }
        }
    }
    all
}
