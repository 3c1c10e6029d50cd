//! The search: from the nominal model forward, one effect at a time, and back.
//!
//! A set of effects stands at two lengths: in some windows, which are convex enough to begin from, and over whole runs, which have the power
//! and are what is judged. One round: screen all hypotheses beside the converged set, in the windows and, where the whole runs follow
//! at all, over these; refit the most promising in the windows and take the best of them to the whole runs; keep the one with the lowest
//! Bayesian information criterion (Schwarz 1978), cost + k ln N; then try to take out each member. It ends when the cost is what noise
//! alone would leave, or nothing promising is left.

use crate::attempt::Attempt;
use crate::choice::{brought_by, by_criterion, is_enough, put_corrections_first, take_further};
use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::fit::{Effort, Fit, UNDAMPED, fit};
use crate::hypothesis::Hypothesis;
use crate::linear::{Segment, Stage};
use crate::lost;
use crate::pace;
use crate::parsimony::{Replaced, prune, simplify};
use crate::plant::{Built, Plant};
use crate::refits::{Refit, Refits, scores_of_interest};
use crate::replay::Pace;
use crate::screen::Score;
use crate::standing::{Standing, criterion, raw_rms, told};
use crate::stretches::STEEP;
use crate::work::Until;

/// How hard to search.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Most effects.
    pub effects: usize,
    /// Hypotheses refitted in each round.
    pub refits: usize,
    /// Ends of a refit of one hypothesis from which longer windows are tried.
    pub ends: usize,
}

/// Refits of a first look, and of a kept set.
pub(crate) const LOOK: Effort = Effort { share: 2e-3, floor: 0.05, ..Effort::NUMBERS };
/// Until it has converged as far as the next round needs it; all samples fit the last set to the end.
pub(crate) const WHOLE: Effort = Effort { iterations: 10, floor: 0.02, ..Effort::NUMBERS };
/// As far as it goes, where more physics would be looked for in what is left.
pub(crate) const END: Effort = Effort { iterations: 12, floor: 0.02, damping: UNDAMPED, ..Effort::STARTS };

/// Difference by halved steps, units of noise, beyond which a fit that has not converged goes on in finer ones.
const ROUGH: f64 = 0.03;

/// What could act beside a fitted set.
pub type Candidates<'a> = dyn Fn(&Stage<'_>, &Fit) -> Result<Vec<Hypothesis>, DiagnoseError> + 'a;

/// Root mean square over whole runs up to which a screen over them says something.
const LINEAR: f64 = 60.0;
/// Share of the remaining excess that an effect must take away: of what few effects leave out together, the largest part is no small one.
const WORTHWHILE: f64 = 0.2;
/// The same where what is left is no more than laws are off themselves: half of its root mean square.
const MOST_OF_THE_REST: f64 = 0.75;
/// Share of the mismatch up to which what is left may be what the laws that were found are off by: a tenth of what they do. A law of a library is
/// a part's own to some hundredths at best, and what it is off by comes again at every stroke, so that any effect of as many numbers helps there.
const OF_THE_LAWS: f64 = 0.01;
/// Share of the excess that an effect must promise for a refit, where promises are linear.
const UNPROMISING: f64 = 0.08;
/// Difference, as a share of what the best of them has brought, below which refits are not told apart before they have converged.
pub(crate) const TIE: f64 = 0.01;
/// Share of the excess that cheap hypotheses promise where those that are dear to screen need not be.
const SUFFICIENT: f64 = 0.5;
/// Share of the excess that a set must leave for further screens in a round.
pub(crate) const UNEXPLAINED: f64 = 0.05;
/// Hypotheses, best first, that are screened over whole runs after windows.
const SCREENED: usize = 30;

/// Adds and removes effects until nothing significant is left or nothing helps.
///
/// It goes on from a standing and what was tried before that. `stage` is left at the pace at which the last set was fitted: what an effect brings may need finer steps than the nominal model does.
pub fn search(
    stage: &mut Stage<'_>,
    plant: &Plant,
    (mut now, mut attempts): (Standing, Vec<Attempt>),
    hypotheses: &Candidates<'_>,
    limits: &Limits,
) -> Result<(Standing, Vec<Attempt>), DiagnoseError> {
    let mut known: Vec<Hypothesis> = now.judge().set.findings().map(|(h, _)| h.clone()).collect();
    let mut round = attempts.iter().map(|a| a.round + 1).max().unwrap_or(0);
    let at_first = now.whole.clone();
    if now.whole.rms() < lost::NEAR && refine(stage, &now) {
        now = now.refit(stage, plant, now.judge().set.clone(), WHOLE)?;
    }
    let is_open = |now: &Standing| now.judge().is_significant() && now.judge().set.findings().count() < limits.effects;
    while is_open(&now) && !stage.work.is_spent(Until::Search) {
        let all = hypotheses(stage, &now.windows)?;
        known.extend(all.iter().cloned());
        let open = all.into_iter().filter_map(|h| now.judge().set.still_open(h));
        let (dear, cheap): (Vec<Hypothesis>, Vec<Hypothesis>) = open.partition(|h| h.is_dear);
        let (best, mut tried) = refit_best(stage, plant, &now, (cheap, &dear), (limits, round))?;
        attempts.append(&mut tried);
        let Some(best) = best else { break };
        if !is_worthwhile((stage, plant), &at_first, (&now, &best))? {
            break;
        }
        let is_old = |h: &Hypothesis| now.judge().set.has_finding(h);
        let members = best.judge().set.findings().map(|(h, _)| h);
        let added: Vec<String> = members.filter(|h| !is_old(h)).map(Hypothesis::title).collect();
        let together = (added.len() > 1).then(|| criterion(now.judge()) - criterion(best.judge()));
        attempts.iter_mut().filter(|t| t.round == round).for_each(|t| t.keep(&added, together));
        let added = added.join(", ");
        let set = best.judge().set.clone();
        let before = now;
        let is_finer = refine(stage, &best);
        // What is far from the data yet is not worth fitting to the end, nor what explains them: all samples fit that.
        let effort = if best.judge().rms() > lost::NEAR { LOOK } else { WHOLE };
        now = match is_finer || best.judge().is_significant() {
            true => best.refit_here(stage, plant, set, effort)?,
            false => best,
        };
        now = to_the_end(stage, plant, now)?;
        let found = now.judge().set.findings().map(|(h, x)| told(h, x)).collect::<Vec<_>>().join("; ");
        stage.work.watch.step(&format!("kept {added}: {}, {found}", errors(&now)));
        // A law that has grown into a plainer one has numbers that would follow what is still left.
        let brought = if before.is_comparable(&now) { before.judge().cost - now.judge().cost } else { f64::INFINITY };
        let replaced;
        (now, replaced) = simplify(stage, plant, now.weighted(stage), (&known, brought))?;
        replaced.iter().for_each(|change| hand_over(&mut attempts, change));
        round += 1;
    }
    if attempts.is_empty() {
        attempts = only_screened(stage, plant, &now.windows, (hypotheses, limits))?;
    }
    Ok((prune(stage, plant, now)?, attempts))
}

/// Share of the mismatch that a set leaves where it is judged, mean squares above noise; `whole`: whole runs of the nominal model.
fn calc_left(stage: &Stage<'_>, plant: &Plant, now: &Standing, whole: &Fit) -> Result<f64, DiagnoseError> {
    if !now.judge().set.has_findings() {
        return Ok(1.0);
    }
    let above_noise = |fit: &Fit| raw_rms(stage, fit).powi(2) - 1.0;
    let mismatch = if now.follows() {
        above_noise(whole)
    } else {
        let segments = now.windows.segments.iter().map(|s| Segment { weight: 1.0, columns: None, ..s.clone() });
        above_noise(&fit(stage, plant, EffectSet::default(), segments.collect(), Effort::STARTS)?)
    };
    let left = above_noise(now.judge()) / mismatch.max(f64::MIN_POSITIVE);
    stage.work.watch.step(&format!("left of the mismatch: {:.2} %", 100.0 * left));
    Ok(left)
}

/// Whether a better standing takes enough of the excess away, or is judged by more; `whole`: whole runs of the nominal model.
fn is_worthwhile(
    (stage, plant): (&Stage<'_>, &Plant),
    whole: &Fit,
    (now, better): (&Standing, &Standing),
) -> Result<bool, DiagnoseError> {
    if !better.is_better(now) || !better.is_comparable(now) {
        return Ok(better.is_better(now));
    }
    let (before, after) = (now.judge(), better.judge());
    let taken = before.cost - after.cost;
    if taken <= (WORTHWHILE * before.excess()).max(before.least()) {
        return Ok(false);
    }
    Ok(taken > MOST_OF_THE_REST * before.excess() || calc_left(stage, plant, now, whole)? >= OF_THE_LAWS)
}

/// A near standing fitted until it has converged, each time by new derivatives, in steps that suit that: what an unfinished fit leaves, in a narrow
/// valley, is no sign of other physics.
fn to_the_end(stage: &mut Stage<'_>, plant: &Plant, now: Standing) -> Result<Standing, DiagnoseError> {
    let judged = now.judge();
    if judged.converged || !judged.is_significant() || judged.rms() > lost::NEAR {
        return Ok(now);
    }
    let set = judged.set.clone();
    stage.pace = pace::refine(stage, &judged.built, &judged.segments, ROUGH).pace;
    let tried = now.refit_here(stage, plant, set, END)?;
    stage.work.watch.step(&format!("to the end: {}", errors(&tried)));
    Ok(if tried.is_better(&now) { tried } else { now })
}

/// What a law has brought belongs to the plainer one that has taken its place.
fn hand_over(attempts: &mut Vec<Attempt>, Replaced { gone, by, was_there }: &Replaced) {
    let Some(old) = attempts.iter_mut().find(|a| a.kept && a.title() == *gone) else { return };
    let new = Attempt { name: by.name.to_owned(), place: by.place.clone(), ..old.clone() };
    (old.kept, old.gain) = (false, None);
    if *was_there {
        return;
    }
    attempts.retain(|a| a.round != new.round || a.title() != new.title());
    attempts.push(new);
}

/// Where nothing is amiss: what would have shown.
fn only_screened(
    stage: &Stage<'_>,
    plant: &Plant,
    here: &Fit,
    (hypotheses, limits): (&Candidates<'_>, &Limits),
) -> Result<Vec<Attempt>, DiagnoseError> {
    let mut all = hypotheses(stage, here)?;
    all.retain(|h| !h.is_dear);
    let mut attempts = Vec::new();
    let refits = Refits { stage, plant, here, limits: *limits, round: 0, attempts: &mut attempts };
    let scores = refits.screen(&all)?;
    let interesting = scores_of_interest(&all, &scores);
    Ok(interesting.into_iter().map(|s| Attempt::new(0, &all[s.hypothesis], s, here)).collect())
}

/// Takes finer steps where the found model needs them, over whole runs too where these are near and leave something that the steps may have
/// made; whether it does.
fn refine(stage: &mut Stage<'_>, standing: &Standing) -> bool {
    let before = stage.pace;
    let built = &standing.judge().built;
    stage.pace = no_coarser(stage, built, &standing.windows.segments);
    let mut worst = None;
    if standing.whole.rms() < lost::NEAR && standing.whole.is_significant() {
        let found = pace::refine(stage, built, &standing.whole.segments, pace::WHOLE_TOLERANCE);
        (stage.pace, worst) = (found.pace, Some(found.worst));
    }
    let is_finer = stage.pace != before;
    if is_finer {
        let moves = worst.map_or(String::new(), |w| format!(": halving moves whole runs by {w:.2e}"));
        let Pace { step, free, .. } = stage.pace;
        stage.work.watch.step(&format!("steps of {step:.3e} s, {free:.3e} s in free flight{moves}"));
    }
    is_finer
}

/// Steps that a model needs in some windows, or the present ones where these are finer.
pub(crate) fn no_coarser(stage: &Stage<'_>, built: &Built, segments: &[Segment]) -> Pace {
    let now = stage.pace;
    let found = pace::choose(stage, (built, &[]), segments, now.step).pace;
    let step = found.step.min(now.step);
    Pace { step, free: found.free.min(now.free).max(step), midpoint: found.midpoint && now.midpoint }
}

pub(crate) fn errors(now: &Standing) -> String {
    format!("error {:.3} in windows, {:.3} over whole runs", now.windows.rms(), now.whole.rms())
}

/// Refits the most promising hypotheses, in windows and over whole runs; the best of them, and what came of each.
fn refit_best(
    stage: &Stage<'_>,
    plant: &Plant,
    now: &Standing,
    (mut all, dear): (Vec<Hypothesis>, &[Hypothesis]),
    (limits, round): (&Limits, usize),
) -> Result<(Option<Standing>, Vec<Attempt>), DiagnoseError> {
    let mut attempts: Vec<Attempt> = Vec::new();
    let mut best: Option<Standing> = None;
    // What looks alike in short windows may not do so in longer ones.
    let limits = Limits { ends: if now.rungs.is_empty() { 1 } else { limits.ends }, ..*limits };
    // Windows that had to be shortened are only there to begin from: where whole runs are near, these tell more.
    let is_steep = now.reach <= STEEP;
    let has_begun = is_steep && now.follows() && now.whole.rms() < lost::NEAR;
    for is_window in [true, false] {
        if all.is_empty() {
            break;
        }
        if is_window && has_begun {
            continue;
        }
        let here = if is_window { &now.windows } else { &now.whole };
        // What is found in windows and explains whole runs needs no screen over these.
        let enough = best.as_ref().is_some_and(|b| is_enough(now, b));
        let is_far = here.rms() > LINEAR.min(now.reach);
        if !is_window && (enough || is_far) {
            break;
        }
        // In windows that had to be shortened a promise says little of what a refit brings.
        let least = if is_steep && is_window { 0.0 } else { UNPROMISING * here.excess() };
        let dear = if is_window || has_begun { dear } else { &[] };
        let mut refits = Refits { stage, plant, here, limits, round, attempts: &mut attempts };
        let ready = refit_at(&mut refits, (&mut all, dear), least)?;
        // Over whole runs only what the windows did not rule out is screened.
        let order: Vec<(String, String)> =
            attempts.iter().take(SCREENED).map(|a| (a.name.clone(), a.place.clone())).collect();
        all.retain(|h| has_begun || order.iter().any(|(name, place)| h.name == name && h.place == *place));
        best = take_further(stage, plant, now, (is_window, ready), (best, &mut attempts))?;
    }
    Ok((best, attempts))
}

/// Refits at one length, the first to go further first: of what is cheap to screen, of what is dear where that leaves something, and of sets where
/// both do. What is dear joins `all` once it was screened.
fn refit_at(
    refits: &mut Refits<'_>,
    (all, mut dear): (&mut Vec<Hypothesis>, &[Hypothesis]),
    least: f64,
) -> Result<Vec<Refit>, DiagnoseError> {
    let here = refits.here;
    let mut scores = refits.screen(all)?;
    let promised = scores.first().map_or(0.0, |s| s.score);
    if !dear.is_empty() && promised < SUFFICIENT * here.excess() {
        let further = refits.screen(dear)?;
        scores.extend(further.into_iter().map(|s| Score { hypothesis: s.hypothesis + all.len(), ..s }));
        scores.sort_by(|a, b| b.score.total_cmp(&a.score));
        all.extend(dear.iter().cloned());
        dear = &[];
    }
    let mut ready = refits.promising(all, &scores, least)?;
    let leaves_much = |ready: &[Refit]| here.excess() - brought_by(here, ready) > UNEXPLAINED * here.excess();
    let may_go_on = !refits.stage.work.is_spent(Until::Search);
    // What promised enough may not have brought it.
    if !dear.is_empty() && may_go_on && leaves_much(&ready) {
        let scores = refits.screen(dear)?;
        ready.extend(refits.promising(dear, &scores, least)?);
        ready.sort_by(by_criterion);
        all.extend(dear.iter().cloned());
    }
    if may_go_on && leaves_much(&ready) {
        ready.extend(refits.together(all, &scores)?);
        ready.sort_by(by_criterion);
    }
    put_corrections_first(here, &mut ready);
    Ok(ready)
}
