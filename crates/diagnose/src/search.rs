//! The search: from the nominal model forward, one effect at a time, and back.
//!
//! A set of effects stands at two lengths: in some windows, which are convex enough to begin from, and over whole runs, which have the power
//! and are what is judged. One round: screen all hypotheses beside the converged set, in the windows and, where the whole runs follow
//! at all, over these; refit the most promising in the windows and take the best of them to the whole runs; keep the one with the lowest
//! Bayesian information criterion (Schwarz 1978), cost + k ln N; then try to take out each member. It ends when the cost is what noise
//! alone would leave, or nothing promising is left.

use crate::choice::{brought_by, by_criterion, is_enough, put_corrections_first, take_further};
use crate::error::DiagnoseError;
use crate::fit::{CAUTIOUS, EffectSet, Effort, Fit, UNDAMPED, fit};
use crate::hypothesis::{Hypothesis, Tier};
use crate::linear::{Segment, Stage};
use crate::lost;
use crate::pace;
use crate::parsimony::{prune, simplify};
use crate::plant::{Built, Plant};
use crate::replay::Pace;
use crate::screen::{Score, Shown, screen};
use crate::standing::{Standing, criterion, told};
use crate::start::count_memory;
use crate::stretches::STEEP;
use crate::together::{Ensemble, screen_together};
use crate::work::Until;

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
    /// Share of the excess that it promises, or has brought where it was refitted.
    pub share: f64,
    /// Fall of the cost after the refit; `None` where none was made.
    pub fall: Option<f64>,
    /// Numbers it fits.
    pub parameters: usize,
    /// Fall of the criterion; positive is better.
    pub gain: Option<f64>,
    /// Fall of the criterion by all that was kept with it, where that was more than one.
    pub together: Option<f64>,
    /// Whether it was kept.
    pub kept: bool,
    /// Coordinates after the refit.
    pub found: Vec<f64>,
    /// How well the data show it.
    pub shown: Shown,
}

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
pub(crate) const LOOK: Effort = Effort { iterations: 6, share: 2e-3, floor: 0.05, reuse: true, damping: CAUTIOUS };
/// Until it has converged as far as the next round needs it; all samples fit the last set to the end.
pub(crate) const WHOLE: Effort = Effort { iterations: 10, share: 1e-3, floor: 0.02, reuse: true, damping: CAUTIOUS };
/// As far as it goes, where more physics would be looked for in what is left.
const END: Effort = Effort { iterations: 12, share: 1e-3, floor: 0.02, reuse: false, damping: UNDAMPED };
/// Promise relative to the best below which a hypothesis is not refitted.
const PROMISING: f64 = 0.15;

/// What could act beside a fitted set.
pub type Candidates<'a> = dyn Fn(&Stage<'_>, &Fit) -> Result<Vec<Hypothesis>, DiagnoseError> + 'a;

/// Root mean square over whole runs up to which a screen over them says something.
const LINEAR: f64 = 60.0;
/// Share of the remaining excess that an effect must take away: of what few effects leave out together, the largest part is no small one.
const WORTHWHILE: f64 = 0.2;
/// Share of the excess that an effect must promise for a refit, where promises are linear.
const UNPROMISING: f64 = 0.08;
/// Difference, as a share of what the best of them has brought, below which refits are not told apart before they have converged.
pub(crate) const TIE: f64 = 0.01;
/// Promise relative to what another refit has brought below which none is made.
const RIVAL: f64 = 0.9;
/// The same relative to the largest promise, where no refit leaves nothing.
const EQUAL: f64 = 0.7;
/// Share of the excess that cheap hypotheses promise where those that are dear to screen need not be.
const SUFFICIENT: f64 = 0.5;
/// Share of the excess that a set must leave for further screens in a round.
pub(crate) const UNEXPLAINED: f64 = 0.05;
/// Hypotheses of a screen that a watcher hears of.
const TOLD: usize = 8;
/// Hypotheses, best first, that are screened over whole runs after windows.
const SCREENED: usize = 30;
/// Share of the excess that a refit may leave where other refits are only made of what promises as much.
const NEXT_TO_NOTHING: f64 = 0.01;

/// Adds and removes effects until nothing significant is left or nothing helps.
///
/// `stage` is left at the pace at which the last set was fitted: what an effect brings may need finer steps than the nominal model does.
pub fn search(
    stage: &mut Stage<'_>,
    plant: &Plant,
    mut now: Standing,
    hypotheses: &Candidates<'_>,
    limits: &Limits,
) -> Result<(Standing, Vec<Attempt>), DiagnoseError> {
    let (mut attempts, mut known) = (Vec::new(), Vec::new());
    let mut round = 0;
    if now.whole.rms() < lost::NEAR && refine(stage, &now) {
        now = now.refit(stage, plant, now.judge().set.clone(), WHOLE)?;
    }
    let is_open = |now: &Standing| now.judge().is_significant() && now.judge().set.findings().count() < limits.effects;
    while is_open(&now) && !stage.work.is_spent(Until::Search) {
        let all = hypotheses(stage, &now.windows)?;
        known.extend(all.iter().cloned());
        let open = all.into_iter().filter_map(|h| still_open(h, &now.judge().set));
        let (dear, cheap): (Vec<Hypothesis>, Vec<Hypothesis>) = open.partition(|h| h.is_dear);
        let (best, mut tried) = refit_best(stage, plant, &now, (cheap, &dear), (limits, round))?;
        attempts.append(&mut tried);
        let is_worthwhile = |b: &Standing| {
            let (before, after) = (now.judge(), b.judge());
            let is_clear = before.cost - after.cost > (WORTHWHILE * before.excess()).max(before.least());
            b.is_better(&now) && (is_clear || !b.is_comparable(&now))
        };
        let Some(best) = best.filter(is_worthwhile) else { break };
        let is_old = |h: &Hypothesis| now.judge().set.findings().any(|(m, _)| m.title() == h.title());
        let members = best.judge().set.findings().map(|(h, _)| h);
        let added: Vec<String> = members.filter(|h| !is_old(h)).map(Hypothesis::title).collect();
        let together = (added.len() > 1).then(|| criterion(now.judge()) - criterion(best.judge()));
        for attempt in attempts.iter_mut().filter(|t| t.round == round) {
            attempt.kept = added.contains(&format!("{} at {}", attempt.name, attempt.place));
            attempt.together = together.filter(|_| attempt.kept);
        }
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
        let grown = titles(&now);
        now = simplify(stage, plant, now.weighted(stage), (&known, brought))?;
        grown.iter().zip(titles(&now)).for_each(|(grown, plain)| hand_over(&mut attempts, grown, &plain));
        round += 1;
    }
    if attempts.is_empty() {
        attempts = only_screened(stage, plant, &now.windows, hypotheses)?;
    }
    Ok((prune(stage, plant, now)?, attempts))
}

/// A near standing fitted until it has converged, each time by new derivatives, in steps that suit that: what an unfinished fit leaves, in a narrow
/// valley, is no sign of other physics.
fn to_the_end(stage: &mut Stage<'_>, plant: &Plant, now: Standing) -> Result<Standing, DiagnoseError> {
    let judged = now.judge();
    if judged.converged || !judged.is_significant() || judged.rms() > lost::NEAR {
        return Ok(now);
    }
    let set = judged.set.clone();
    stage.pace = pace::refine(stage, &judged.built, &judged.segments, pace::tolerance_of(judged.count)).pace;
    let tried = now.refit_here(stage, plant, set, END)?;
    stage.work.watch.step(&format!("to the end: {}", errors(&tried)));
    Ok(if tried.is_better(&now) { tried } else { now })
}

/// A hypothesis that may act beside a set: none of its members, and of the numbers that have a tolerance one that stands at its end.
fn still_open(h: Hypothesis, set: &EffectSet) -> Option<Hypothesis> {
    match set.members.iter().find(|(m, _)| m.title() == h.title()) {
        None => Some(h),
        Some((m, x)) if m.is_tolerated() && m.is_at_bound(x) => Some(h.screened_beside(x)),
        Some(_) => None,
    }
}

/// Name and place of every member.
fn titles(standing: &Standing) -> Vec<(String, String)> {
    standing.judge().set.findings().map(|(h, _)| (h.name.to_owned(), h.place.clone())).collect()
}

/// What a law has brought belongs to the plainer one that has taken its place.
fn hand_over(attempts: &mut Vec<Attempt>, grown: &(String, String), plain: &(String, String)) {
    let is_grown = |a: &&mut Attempt| a.kept && (&a.name, &a.place) == (&grown.0, &grown.1);
    let Some(old) = attempts.iter_mut().find(is_grown).filter(|_| grown != plain) else { return };
    let new = Attempt { name: plain.0.clone(), place: plain.1.clone(), ..old.clone() };
    (old.kept, old.gain) = (false, None);
    attempts.retain(|a| (a.round, &a.name, &a.place) != (new.round, &plain.0, &plain.1));
    attempts.push(new);
}

/// Where nothing is amiss: what would have shown.
fn only_screened(
    stage: &Stage<'_>,
    plant: &Plant,
    here: &Fit,
    hypotheses: &Candidates<'_>,
) -> Result<Vec<Attempt>, DiagnoseError> {
    let mut all = hypotheses(stage, here)?;
    all.retain(|h| !h.is_dear);
    let scores = screen_aloud(stage, plant, here, &all)?;
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
    let found = pace::choose(stage, built, segments, now.step).pace;
    let step = found.step.min(now.step);
    Pace { step, free: found.free.min(now.free).max(step), midpoint: found.midpoint && now.midpoint }
}

pub(crate) fn errors(now: &Standing) -> String {
    format!("error {:.3} in windows, {:.3} over whole runs", now.windows.rms(), now.whole.rms())
}

/// Refits the most promising hypotheses; the best of them, and what came of each.
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
    let limits = &Limits { ends: if now.rungs.is_empty() { 1 } else { limits.ends }, ..*limits };
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
        let mut scores = screen_aloud(stage, plant, here, &all)?;
        let mut leaves_dear = (is_window || has_begun) && !dear.is_empty();
        // What is dear to screen is screened only where the rest leaves something.
        let promised = scores.first().map_or(0.0, |s| s.score);
        if leaves_dear && promised < SUFFICIENT * here.excess() {
            leaves_dear = false;
            let further = screen_aloud(stage, plant, here, dear)?;
            scores.extend(further.into_iter().map(|s| Score { hypothesis: s.hypothesis + all.len(), ..s }));
            scores.sort_by(|a, b| b.score.total_cmp(&a.score));
            all.extend(dear.iter().cloned());
        }
        // In windows that had to be shortened a promise says little of what a refit brings.
        let least = if is_steep && is_window { 0.0 } else { UNPROMISING * here.excess() };
        let mut ready = refit_promising(stage, plant, here, (&all, &scores, least), (limits, round), &mut attempts)?;
        // Nor is it left out where what promised enough does not bring it.
        let left = here.excess() - brought_by(here, &ready);
        let may_go_on = !stage.work.is_spent(Until::Search);
        if leaves_dear && left > UNEXPLAINED * here.excess() && may_go_on {
            let scores = screen_aloud(stage, plant, here, dear)?;
            let further = refit_promising(stage, plant, here, (dear, &scores, least), (limits, round), &mut attempts)?;
            ready.extend(further);
            ready.sort_by(by_criterion);
            all.extend(dear.iter().cloned());
        }
        if here.excess() - brought_by(here, &ready) > UNEXPLAINED * here.excess() && may_go_on {
            let most = limits.effects - here.set.findings().count();
            let sets = screen_together(stage, plant, here, (&all, &scores, most))?;
            ready.extend(refit_together(stage, plant, here, (&all, &sets), &mut attempts));
            ready.sort_by(by_criterion);
        }
        put_corrections_first(here, &mut ready);
        // Over whole runs only what the windows did not rule out is screened.
        let order: Vec<(String, String)> =
            attempts.iter().take(SCREENED).map(|a| (a.name.clone(), a.place.clone())).collect();
        all.retain(|h| has_begun || order.iter().any(|(name, place)| h.name == name && h.place == *place));
        best = take_further(stage, plant, now, (is_window, ready), (best, &mut attempts))?;
    }
    Ok((best, attempts))
}

/// Screens, and says so.
fn screen_aloud(stage: &Stage<'_>, plant: &Plant, here: &Fit, all: &[Hypothesis]) -> Result<Vec<Score>, DiagnoseError> {
    let columns: usize = all.iter().flat_map(|h| &h.screens).map(|s| s.columns.len()).sum();
    let (count, error) = (all.len(), here.rms());
    stage.work.watch.step(&format!("screen {count} hypotheses in {columns} directions beside error {error:.3}"));
    screen(stage, plant, here, all)
}

/// Refits what a screen found most promising: index of the attempt and fit.
fn refit_promising(
    stage: &Stage<'_>,
    plant: &Plant,
    here: &Fit,
    (all, scores, least): (&[Hypothesis], &[Score], f64),
    (limits, round): (&Limits, usize),
    attempts: &mut Vec<Attempt>,
) -> Result<Vec<(usize, Fit)>, DiagnoseError> {
    let interesting = scores_of_interest(all, scores);
    let picked = pick((here, all), &interesting, (limits.refits, least));
    for score in interesting.iter().take(TOLD) {
        let h = &all[score.hypothesis];
        let (label, share) = (&h.screens[score.point].label, 100.0 * score.score / here.cost);
        stage.work.watch.step(&format!("  {} {label} promises {share:.1} % of the cost", h.title()));
    }
    let most = interesting.first().map_or(0.0, |s| s.score);
    let mut ready: Vec<(usize, Fit)> = Vec::new();
    for score in interesting {
        let h = &all[score.hypothesis];
        let known = attempts.iter().position(|a| a.name == h.name && a.place == h.place);
        let at = known.unwrap_or(attempts.len());
        if known.is_none() {
            attempts.push(Attempt::new(round, h, score, here));
        }
        // A promise is seldom exceeded: what promises less than another has brought already is left alone; where that one leaves something
        // too, promises are compared, which are rough.
        let is_open = ready.iter().all(|r| r.1.is_significant());
        let rival = (RIVAL * brought_by(here, &ready)).min(if is_open { EQUAL * most } else { f64::INFINITY });
        // Beside a refit that leaves next to nothing no valley is looked for either.
        let is_rest = ready.iter().any(|r| r.1.excess() < NEXT_TO_NOTHING * here.excess());
        let is_hopeless = score.score < rival && (!h.has_valleys() || is_rest);
        let is_spent = !ready.is_empty() && stage.work.is_spent(Until::Search);
        if !picked.iter().any(|p| std::ptr::eq(*p, score)) || is_hopeless || is_spent {
            continue;
        }
        let Some(start) = possible(stage, plant, here, h, &score.start) else { continue };
        let Ok(tried) = fit(stage, plant, here.set.with(h, &start), here.segments.clone(), LOOK) else { continue };
        let found = tried.set.members.last().map(|(h, x)| told(h, x)).unwrap_or_default();
        stage.work.watch.step(&format!("refit {} {found}: error {:.3} → {:.3}", h.title(), here.rms(), tried.rms()));
        if attempts[at].fall.is_none_or(|fall| here.cost - tried.cost > fall) {
            attempts[at].tell(here, &tried);
        }
        // A nominal number that runs to the end of what is possible stands for something else.
        let is_absurd = h.tier == Tier::Nominal && tried.set.members.last().is_some_and(|(h, x)| h.is_at_bound(x));
        if tried.cost < here.cost && !is_absurd {
            ready.push((at, tried));
        }
    }
    // Of several starts of one hypothesis the best ends count, and of laws that do alike the plainer, once they have come to their ends.
    ready.sort_by(by_criterion);
    let mut seen: Vec<usize> = Vec::new();
    ready.retain(|r| {
        seen.push(r.0);
        seen.iter().filter(|at| **at == r.0).count() <= limits.ends
    });
    let near = ready.first().map_or(0.0, |r| criterion(&r.1)) + TIE * brought_by(here, &ready);
    let is_tied = |r: &(usize, Fit)| criterion(&r.1) < near;
    if ready.iter().any(|r| r.0 != ready[0].0 && is_tied(r)) {
        for (at, tied) in ready.iter_mut().filter(|r| is_tied(r)) {
            *tied = fit(stage, plant, tied.set.clone(), tied.segments.clone(), WHOLE)?;
            let title = format!("{} at {}", attempts[*at].name, attempts[*at].place);
            stage.work.watch.step(&format!("to the end: {title}: error {:.4}", tied.rms()));
        }
        ready.sort_by(by_criterion);
    }
    Ok(ready)
}

/// Refits sets that promise more than any of their members: index of the attempt of the last one, and fit.
fn refit_together(
    stage: &Stage<'_>,
    plant: &Plant,
    here: &Fit,
    (all, sets): (&[Hypothesis], &[Ensemble]),
    attempts: &mut [Attempt],
) -> Vec<(usize, Fit)> {
    let mut ready = Vec::new();
    for ensemble in sets {
        let titles: Vec<String> = ensemble.members.iter().map(|(h, _)| all[*h].title()).collect();
        let promised = 100.0 * ensemble.score / here.cost;
        stage.work.watch.step(&format!("  {} together promise {promised:.1} % of the cost", titles.join(", ")));
        let Ok(tried) = fit(stage, plant, ensemble.beside(&here.set, all), here.segments.clone(), LOOK) else {
            continue;
        };
        let found = tried.set.findings().map(|(h, x)| told(h, x)).collect::<Vec<_>>().join("; ");
        stage.work.watch.step(&format!("refit together {found}: error {:.3} → {:.3}", here.rms(), tried.rms()));
        let at = |title: &String| attempts.iter().position(|a| format!("{} at {}", a.name, a.place) == *title);
        let places: Vec<Option<usize>> = titles.iter().map(at).collect();
        if tried.cost >= here.cost {
            continue;
        }
        let kept = (here.cost - tried.cost) / ensemble.score.max(f64::MIN_POSITIVE);
        for (place, part) in places.iter().zip(&ensemble.parts).filter_map(|(p, part)| p.map(|p| (p, part))) {
            attempts[place].tell_part(here, &tried, kept.min(1.0) * part);
        }
        if let Some(last) = places.last().copied().flatten() {
            ready.push((last, tried));
        }
    }
    ready
}

impl Attempt {
    /// What it brings beside others that were fitted with it.
    fn tell_part(&mut self, before: &Fit, after: &Fit, part: f64) {
        if self.fall.is_some_and(|fall| fall >= part) {
            return;
        }
        self.fall = Some(part);
        self.share = (part / before.excess().max(0.2 * before.noise)).clamp(0.0, 1.0);
        self.gain = Some(part - self.parameters as f64 * (before.count as f64).ln());
        let is_this = |m: &&(Hypothesis, Vec<f64>)| m.0.name == self.name && m.0.place == self.place;
        self.found = after.set.members.iter().find(is_this).map(|m| m.1.clone()).unwrap_or_default();
    }

    fn new(round: usize, h: &Hypothesis, score: &Score, beside: &Fit) -> Self {
        Self {
            round,
            name: h.name.to_owned(),
            place: h.place.clone(),
            score: score.score,
            share: score.score / beside.excess().max(0.2 * beside.noise),
            fall: None,
            parameters: score.rank,
            gain: None,
            together: None,
            kept: false,
            found: score.start.clone(),
            shown: score.shown.clone(),
        }
    }

    /// What came of it.
    pub(crate) fn tell(&mut self, before: &Fit, after: &Fit) {
        self.fall = Some(before.cost - after.cost);
        self.share = ((before.cost - after.cost) / before.excess().max(0.2 * before.noise)).clamp(0.0, 1.0);
        self.gain = Some(criterion(before) - criterion(after));
        self.found = after.set.members.last().map(|m| m.1.clone()).unwrap_or_default();
    }
}

/// Coordinates to begin a refit with: those that were promised, or nearer to neutral where these cannot be built or the starts
/// cannot follow them (a screen is linear, and may promise a part heavier than its body).
fn possible(stage: &Stage<'_>, plant: &Plant, now: &Fit, h: &Hypothesis, promised: &[f64]) -> Option<Vec<f64>> {
    let neutral = h.neutral();
    let mut best: Option<(f64, Vec<f64>)> = None;
    for share in (0..SHARES).map(|k| 0.5f64.powi(k)) {
        let x: Vec<f64> = promised.iter().zip(&neutral).map(|(x, n)| n + share * (x - n)).collect();
        let Ok(built) = plant.build(&now.set.with(h, &x).effects()) else { continue };
        let cost = if count_memory(&built) > count_memory(&now.built) {
            // What remembers is moving already: its own starts are fitted before it is judged.
            let few: Vec<Segment> = now.segments.iter().step_by(FEW).cloned().collect();
            stage.fit_starts(&built, &few, BRIEF).iter().map(|s| s.cost).sum()
        } else {
            stage.settle(&built, &now.segments).1
        };
        if best.as_ref().is_some_and(|b| cost >= b.0) {
            break;
        }
        best = Some((cost, x));
    }
    best.map(|b| b.1)
}

/// One in so many segments tells how near what remembers may begin, and how far its starts are fitted for that.
const FEW: usize = 3;
const BRIEF: Effort = Effort { iterations: 2, share: 1e-2, floor: 0.0, reuse: false, damping: CAUTIOUS };
/// Halvings of a promise.
const SHARES: i32 = 5;

/// The best screen points of each hypothesis, best first: one of each, and a few where the cost has many valleys.
fn scores_of_interest<'s>(all: &[Hypothesis], scores: &'s [Score]) -> Vec<&'s Score> {
    let mut seen: Vec<usize> = vec![0; all.len()];
    let mut kept = Vec::new();
    for score in scores {
        let most = if all[score.hypothesis].has_valleys() { VALLEYS } else { 1 };
        if seen[score.hypothesis] < most {
            seen[score.hypothesis] += 1;
            kept.push(score);
        }
    }
    kept
}

/// Screen points from which a hypothesis with many valleys is refitted.
const VALLEYS: usize = 3;

/// Places at which one law is refitted, and the share of the best one's promise from which on.
const PLACES: usize = 3;
const ALIKE: f64 = 0.8;

/// The hypotheses worth a refit: the most promising, of each law the places that promise alike, nominal numbers among them if they promise anything.
fn pick<'s>(
    (now, all): (&Fit, &[Hypothesis]),
    interesting: &[&'s Score],
    (most, least): (usize, f64),
) -> Vec<&'s Score> {
    let penalty = (now.count as f64).ln();
    let best = interesting.first().map_or(0.0, |s| s.score);
    let worth = |s: &&&Score| s.score > (PROMISING * best).max(penalty * s.rank as f64).max(least);
    let mut picked: Vec<&Score> = Vec::new();
    for score in interesting.iter().filter(worth) {
        let same = || picked.iter().filter(|p| all[p.hypothesis].name == all[score.hypothesis].name);
        // The same law at another place is a rival where a screen, which is linear, does not tell them apart.
        let is_rival = same().count() < PLACES && same().all(|p| score.score > ALIKE * p.score);
        let is_new = same().all(|p| p.hypothesis != score.hypothesis) && is_rival;
        let is_valley = picked.iter().any(|p| p.hypothesis == score.hypothesis);
        if picked.len() < most && is_new || is_valley {
            picked.push(score);
        }
    }
    let plain = interesting.iter().filter(worth).find(|s| all[s.hypothesis].tier == Tier::Nominal);
    if let Some(plain) = plain
        && !picked.iter().any(|p| std::ptr::eq(*p, *plain))
    {
        picked.push(plain);
    }
    picked
}
