//! Laws against their equals, once all others stand beside them.
//!
//! An equal is a law that did as much alone at the same place, or that promised as much at any place: a heavier arm, a rotor and a load swing alike, and
//! which of them took its place first hangs on what was not known then.
//! What a law was chosen for over another one at its place may have been what a further effect does, which nobody knew of then: a command that is late by a
//! dead time and one that lags differ by little, and a payload beside them tips the scales. At the end each is fitted in the other's place.

use super::kin::are_kin;
use super::search::{FAR, GLANCE, LOOK, Tried, criterion, remainder, to_the_end};
use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::hypothesis::Hypothesis;
use crate::identify::fit::{Fitted, Problem};
use crate::place::same_place;
use crate::screen::Score;
use crate::work::Until;

/// A fit with members as what was tried at their places beside fewer, where that is better by the criterion now; and the sets that were held against it.
pub(super) fn exchanged(
    problem: &Problem<'_>,
    mut now: Fitted,
    (tried, shown): (&[Tried], &[(Hypothesis, Score)]),
    many: usize,
) -> Result<(Fitted, Vec<(EffectSet, f64)>), DiagnoseError> {
    let all: Vec<Hypothesis> = now.set.findings().map(|(h, _)| h.clone()).collect();
    let mut stood = Vec::new();
    for member in &all {
        // One alone was held against what was tried at its place as it is.
        let here = if all.len() > 1 { equals(member, &now.set, tried) } else { Vec::new() };
        let elsewhere = promised(member, &now.set, shown);
        let overlooked =
            if remainder(problem, &now)?.is_noise() { Vec::new() } else { untried(member, &now.set, (tried, shown)) };
        let mut titles = Vec::new();
        let mut candidates: Vec<_> = here.into_iter().chain(elsewhere).chain(overlooked).collect();
        candidates.retain(|(h, _)| {
            !titles.contains(&h.title()) && {
                titles.push(h.title());
                true
            }
        });
        let mut better: Option<Fitted> = None;
        for (equal, x) in &candidates {
            if problem.stage.work.is_spent(Until::Prune) {
                break;
            }
            let Some(look) = in_its_place(problem, &now, (member, many), (equal, x)) else { continue };
            let own = criterion(&look, many);
            let costs = own - criterion(&now, many);
            problem.stage.work.watch.step(&format!("  {} in the place of its equal costs {costs:.1}", equal.title()));
            stood.push((look.set.clone(), own));
            if own < better.as_ref().map_or(criterion(&now, many), |b| criterion(b, many)) {
                better = Some(look);
            }
        }
        if let Some(better) = better {
            stood.push((now.set.clone(), criterion(&now, many)));
            now = to_the_end(problem, better);
        }
    }
    Ok((now, stood))
}

/// A fit with one law in the place of several at one body or joint, where that is better by the criterion: a load is a mass, a centre and an inertia, and these came one
/// after the other.
pub(super) fn united(
    problem: &Problem<'_>,
    mut now: Fitted,
    (tried, shown): (&[Tried], &[(Hypothesis, Score)]),
    many: usize,
) -> Fitted {
    let places: Vec<String> = now.set.findings().map(|(h, _)| h.place.clone()).collect();
    let is_crowded = |(k, place): &(usize, &String)| places[..*k].iter().any(|other| same_place(other, place));
    for (_, place) in places.iter().enumerate().filter(is_crowded) {
        let is_here = |h: &Hypothesis| !h.is_tolerated() && same_place(&h.place, place);
        let own: Vec<usize> = (0..now.set.members.len()).rev().filter(|m| is_here(&now.set.members[*m].0)).collect();
        let others = own.iter().fold(now.set.clone(), |set, m| set.without(*m));
        let candidates = of_a_place((tried, shown), |h| is_here(h) && !now.set.titles().contains(&h.title()));
        let mut better: Option<Fitted> = None;
        for (one, start) in candidates.iter().take(UNTRIED) {
            if problem.stage.work.is_spent(Until::Prune) {
                break;
            }
            // It has a long way to go, for it was found beside less.
            let Ok(glance) = problem.fit(&now, others.with(one, start), LOOK) else { continue };
            let Ok(look) = problem.fit(&glance, glance.set.clone(), LOOK) else { continue };
            let is_near = criterion(&look, many) - criterion(&now, many) < FAR;
            let look = if is_near { to_the_end(problem, look) } else { look };
            let costs = criterion(&look, many) - criterion(&now, many);
            let said = format!("  {} in the place of {} others at {place} costs {costs:.1}", one.title(), own.len());
            problem.stage.work.watch.step(&said);
            if costs < better.as_ref().map_or(0.0, |b| criterion(b, many) - criterion(&now, many)) {
                better = Some(look);
            }
        }
        now = better.unwrap_or(now);
    }
    now
}

/// Laws that are wanted, each as it was last found, else as it was promised.
fn of_a_place(
    (tried, shown): (&[Tried], &[(Hypothesis, Score)]),
    is_wanted: impl Fn(&Hypothesis) -> bool,
) -> Vec<(Hypothesis, Vec<f64>)> {
    let found = tried.iter().rev().flat_map(|t| t.set.findings()).map(|(h, x)| (h, x));
    let mut all: Vec<(Hypothesis, Vec<f64>)> = Vec::new();
    for (h, x) in found.chain(shown.iter().map(|(h, score)| (h, &score.start))).filter(|(h, _)| is_wanted(h)) {
        if all.iter().all(|(known, _)| known.title() != h.title()) {
            all.push((h.clone(), x.clone()));
        }
    }
    all
}

/// A fit with another law in a member's place; none where that is out of the question.
fn in_its_place(
    problem: &Problem<'_>,
    now: &Fitted,
    (member, many): (&Hypothesis, usize),
    (equal, x): (&Hypothesis, &[f64]),
) -> Option<Fitted> {
    let at = now.set.members.iter().position(|m| m.0.title() == member.title())?;
    let glance = problem.fit(now, now.set.without(at).with(equal, x), GLANCE).ok()?;
    if criterion(&glance, many) - criterion(now, many) > FAR {
        return None;
    }
    problem.fit(&glance, glance.set.clone(), LOOK).ok()
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

/// What promises most at the place of a member and was not fitted there alone: where more than noise is left, a promise that fell short may have been a
/// column's fault.
fn untried(
    member: &Hypothesis,
    set: &EffectSet,
    (tried, shown): (&[Tried], &[(Hypothesis, Score)]),
) -> Vec<(Hypothesis, Vec<f64>)> {
    let is_tried = |h: &Hypothesis| tried.iter().any(|t| t.added == [h.title()]);
    let mut all: Vec<(Hypothesis, Vec<f64>)> = Vec::new();
    for (h, score) in shown.iter().filter(|(h, s)| same_place(&h.place, &member.place) && s.score > 0.0 && !is_tried(h))
    {
        let mut known = set.members.iter().map(|m| &m.0).filter(|m| m.title() != member.title());
        let is_new = h.title() != member.title() && all.iter().all(|(a, _)| a.title() != h.title());
        if is_new && !known.any(|k| k.title() == h.title() || are_kin(h, k)) {
            all.push((h.clone(), score.start.clone()));
        }
    }
    all.truncate(UNTRIED);
    all
}

/// How many of them are fitted.
const UNTRIED: usize = 2;

/// What was tried alone at the place of a member and did as much as any there, as it was last found; without what is in the set.
fn equals(member: &Hypothesis, set: &EffectSet, tried: &[Tried]) -> Vec<(Hypothesis, Vec<f64>)> {
    let mut all: Vec<(Hypothesis, Vec<f64>)> = Vec::new();
    let is_here = |t: &&Tried| {
        t.added.len() == 1
            && t.set.findings().any(|(h, _)| same_place(&h.place, &member.place) && t.added[0] == h.title())
    };
    let gain = |t: &Tried| t.criteria[0] - t.criteria[1];
    let best = |round: usize| tried.iter().filter(is_here).filter(|t| t.round == round).map(gain).fold(0.0, f64::max);
    for one in tried.iter().rev().filter(is_here).filter(|t| gain(t) > 0.0 && gain(t) >= EQUAL * best(t.round)) {
        for (h, x) in
            one.set.findings().filter(|(h, _)| same_place(&h.place, &member.place) && one.added.contains(&h.title()))
        {
            let is_known =
                set.members.iter().map(|m| &m.0).chain(all.iter().map(|a| &a.0)).any(|k| k.title() == h.title());
            if !is_known {
                all.push((h.clone(), x.clone()));
            }
        }
    }
    all
}
