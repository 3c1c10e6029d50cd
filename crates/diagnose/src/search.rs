//! The search: from the nominal model forward, one effect at a time, and back.
//!
//! At one window length: screen all hypotheses beside the converged set; refit the most promising of them in full; keep the one with the lowest
//! Bayesian information criterion (Schwarz 1978), cost + k ln N; then try to take out each member. It ends when the cost is what noise alone
//! would leave, or nothing promising is left.

use crate::error::DiagnoseError;
use crate::fit::{EffectSet, Effort, Fit, fit};
use crate::hypothesis::{Hypothesis, Tier};
use crate::linear::Stage;
use crate::plant::Plant;
use crate::screen::{Score, screen};

/// What happened to one hypothesis in one round.
#[derive(Clone, Debug)]
pub struct Attempt {
    /// Round, from 0.
    pub round: usize,
    /// Name and place.
    pub name: String,
    /// Place.
    pub place: String,
    /// Promised fall of the cost.
    pub score: f64,
    /// Share of the excess that it promises.
    pub share: f64,
    /// Fall of the cost after the refit; `None` where none was made.
    pub fall: Option<f64>,
    /// Numbers it fits.
    pub parameters: usize,
    /// Fall of the criterion; positive is better.
    pub gain: Option<f64>,
    /// Whether it was kept.
    pub kept: bool,
    /// Coordinates after the refit.
    pub found: Vec<f64>,
}

/// How hard to search.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Most effects.
    pub effects: usize,
    /// Hypotheses refitted in each round.
    pub refits: usize,
    /// Excess in standard deviations below which nothing is left to explain.
    pub sigmas: f64,
}

/// Refits of a first look, and of a kept set.
const LOOK: Effort = Effort { iterations: 6, share: 2e-3, reuse: true };
/// Until it has converged.
const WHOLE: Effort = Effort { iterations: 12, share: 1e-5, reuse: false };
/// Promise relative to the best below which a hypothesis is not refitted.
const PROMISING: f64 = 0.15;

/// Promise relative to the best of a hypothesis that may rival one which explains everything.
const RIVAL: f64 = 0.9;

/// Schwarz's criterion.
pub fn criterion(fit: &Fit) -> f64 {
    fit.cost + fit.set.slots().len() as f64 * (fit.count as f64).ln()
}

/// Excess per scalar that data sheets' noise figures do not vouch for.
const LEAST: f64 = 0.02;

/// Whether the cost is more than noise leaves.
pub fn is_significant(fit: &Fit, limits: &Limits) -> bool {
    fit.excess() > (limits.sigmas * fit.spread()).max(LEAST * fit.count as f64)
}

/// Adds and removes effects until nothing significant is left or nothing helps.
pub fn search(
    stage: &Stage<'_>,
    plant: &Plant,
    mut now: Fit,
    hypotheses: &dyn Fn(&Fit) -> Vec<Hypothesis>,
    limits: &Limits,
) -> Result<(Fit, Vec<Attempt>), DiagnoseError> {
    let mut attempts = Vec::new();
    let mut round = 0;
    while is_significant(&now, limits) && now.set.members.len() < limits.effects {
        let is_active = |h: &Hypothesis| now.set.members.iter().any(|(m, _)| m.title() == h.title());
        let (dear, cheap): (Vec<Hypothesis>, Vec<Hypothesis>) =
            hypotheses(&now).into_iter().filter(|h| !is_active(h)).partition(|h| h.is_dear);
        stage.work.watch.step(&format!("screen {} hypotheses beside error {:.3}", cheap.len() + dear.len(), now.rms()));
        let scores = screen(stage, plant, &now, &cheap)?;
        let (mut best, mut tried) = refit_best(stage, plant, &now, (&cheap, &scores), (limits, round))?;
        // What is dear to screen is screened only where the rest leaves something.
        if best.as_ref().is_none_or(|b| is_significant(b, limits)) {
            let scores = screen(stage, plant, &now, &dear)?;
            let (other, mut more) = refit_best(stage, plant, &now, (&dear, &scores), (limits, round))?;
            tried.append(&mut more);
            if other.as_ref().is_some_and(|o| best.as_ref().is_none_or(|b| criterion(o) < criterion(b))) {
                best = other;
            }
        }
        let Some(best) = best.filter(|b| criterion(b) < criterion(&now)) else {
            attempts.append(&mut tried);
            break;
        };
        let added = best.set.members.last().map(|(h, _)| h.title()).unwrap_or_default();
        tried.iter_mut().for_each(|t| t.kept = format!("{} at {}", t.name, t.place) == added);
        attempts.append(&mut tried);
        now = fit(stage, plant, best.set, best.segments, WHOLE)?;
        stage.work.watch.step(&format!("kept {added}: error {:.3}", now.rms()));
        now = prune(stage, plant, now)?;
        round += 1;
    }
    Ok((now, attempts))
}

/// Refits the most promising hypotheses; the best of them, and what came of each.
fn refit_best(
    stage: &Stage<'_>,
    plant: &Plant,
    now: &Fit,
    (all, scores): (&[Hypothesis], &[Score]),
    (limits, round): (&Limits, usize),
) -> Result<(Option<Fit>, Vec<Attempt>), DiagnoseError> {
    let interesting = scores_of_interest(all, scores);
    let picked = pick(now, all, &interesting, limits.refits);
    let mut best: Option<Fit> = None;
    let mut attempts = Vec::new();
    for score in interesting {
        let h = &all[score.hypothesis];
        let mut attempt = Attempt {
            round,
            name: h.name.to_owned(),
            place: h.place.clone(),
            score: score.score,
            share: score.score / now.excess().max(1.0),
            fall: None,
            parameters: score.rank,
            gain: None,
            kept: false,
            found: score.start.clone(),
        };
        // Where all is explained only what promised nearly as much can be a rival.
        let is_done = best.as_ref().is_some_and(|b| !is_significant(b, limits));
        let hopeless = is_done && score.score < RIVAL * attempts.first().map_or(0.0, |a: &Attempt| a.score);
        if !hopeless && picked.iter().any(|p| std::ptr::eq(*p, score)) {
            let Some(start) = possible(stage, plant, now, h, &score.start) else { continue };
            let Ok(tried) = fit(stage, plant, now.set.with(h, &start), now.segments.clone(), LOOK) else { continue };
            let said = format!("refit {}: error {:.3} → {:.3}", h.title(), now.rms(), tried.rms());
            stage.work.watch.step(&said);
            attempt.fall = Some(now.cost - tried.cost);
            attempt.gain = Some(criterion(now) - criterion(&tried));
            attempt.found = tried.set.members.last().map(|m| m.1.clone()).unwrap_or_default();
            attempt.parameters = tried.set.slots().len() - now.set.slots().len();
            if best.as_ref().is_none_or(|b| criterion(&tried) < criterion(b)) {
                best = Some(tried);
            }
        }
        attempts.push(attempt);
    }
    Ok((best, attempts))
}

/// Coordinates to begin a refit with: those that were promised, or nearer to neutral where these cannot be built or the starts
/// cannot follow them (a screen is linear, and may promise a part heavier than its body).
fn possible(stage: &Stage<'_>, plant: &Plant, now: &Fit, h: &Hypothesis, promised: &[f64]) -> Option<Vec<f64>> {
    let neutral = h.neutral();
    let mut best: Option<(f64, Vec<f64>)> = None;
    for share in (0..SHARES).map(|k| 0.5f64.powi(k)) {
        let x: Vec<f64> = promised.iter().zip(&neutral).map(|(x, n)| n + share * (x - n)).collect();
        let Ok(built) = plant.build(&now.set.with(h, &x).effects()) else { continue };
        let (_, cost) = stage.settle(&built, &now.segments);
        if best.as_ref().is_some_and(|b| cost >= b.0) {
            break;
        }
        best = Some((cost, x));
    }
    best.map(|b| b.1)
}

/// Halvings of a promise.
const SHARES: i32 = 5;

/// The best screen point of each hypothesis, best first.
fn scores_of_interest<'s>(all: &[Hypothesis], scores: &'s [Score]) -> Vec<&'s Score> {
    let mut seen: Vec<String> = Vec::new();
    let mut kept = Vec::new();
    for score in scores {
        let title = all[score.hypothesis].title();
        if !seen.contains(&title) {
            seen.push(title);
            kept.push(score);
        }
    }
    kept
}

/// The hypotheses worth a refit: the most promising, one of each, nominal numbers among them if they promise anything.
fn pick<'s>(now: &Fit, all: &[Hypothesis], interesting: &[&'s Score], most: usize) -> Vec<&'s Score> {
    let penalty = (now.count as f64).ln();
    let best = interesting.first().map_or(0.0, |s| s.score);
    let worth = |s: &&&Score| s.score > (PROMISING * best).max(penalty * s.rank as f64);
    let mut picked: Vec<&Score> = interesting.iter().filter(worth).take(most).copied().collect();
    let plain = interesting.iter().filter(worth).find(|s| all[s.hypothesis].tier == Tier::Nominal);
    if let Some(plain) = plain
        && !picked.iter().any(|p| std::ptr::eq(*p, *plain))
    {
        picked.push(plain);
    }
    picked
}

/// Takes out members whose loss the criterion welcomes.
fn prune(stage: &Stage<'_>, plant: &Plant, mut now: Fit) -> Result<Fit, DiagnoseError> {
    let mut member = 0;
    while now.set.members.len() > 1 && member < now.set.members.len() {
        let less: EffectSet = now.set.without(member);
        let tried = fit(stage, plant, less, now.segments.clone(), LOOK)?;
        if criterion(&tried) <= criterion(&now) {
            now = fit(stage, plant, tried.set, tried.segments, WHOLE)?;
            member = 0;
        } else {
            member += 1;
        }
    }
    Ok(now)
}
