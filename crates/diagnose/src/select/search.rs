//! The search: linear sets, the best of them fitted in full simulation, until nothing is worth its price.

use super::detail::{enriched, relaxed, simpler};
use super::dull::open;
use super::exchange::{exchanged, united};
use super::gamma_quantile_over_mean;
use super::kin::alone_of_their_kind;
use super::left::{Left, is_as_quiet, quieting};
use super::lines::{lines, say};
use super::orders::give_orders;
use super::pool::{Pool, price};
use super::regression::{Regression, Spoken};
use super::rounds::{Bounds, PROMISING, fit_sets};
use super::scale::Scale;
use super::sets::{Ground, Grown};
use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::facts::Facts;
use crate::fit::{first_sizes, vary};
use crate::hypothesis::Hypothesis;
use crate::identify::fit::{Fitted, Problem, Reach, ridge_of};
use crate::identify::marginal::{Chain, Spread, estimate, score};
use crate::screen::Score;
use crate::standing::told;
use crate::work::Until;
use std::collections::BTreeSet;

/// What a search has found.
#[derive(Clone, Debug)]
pub struct Found {
    /// The nominal model along the runs, nominal numbers free within their tolerances.
    pub nominal: Fitted,
    /// The best set.
    pub best: Fitted,
    /// Criterion of both.
    pub criteria: [f64; 2],
    /// All that was fitted in full simulation, in order.
    pub tried: Vec<Tried>,
    /// Sets with another law in the place of one of the best set's, and their criterion.
    pub equals: Vec<(EffectSet, f64)>,
    /// What the first linear model said of every hypothesis.
    pub shown: Vec<(Hypothesis, Score)>,
    /// What the nominal model leaves beyond noise, −2 log likelihood.
    pub left: f64,
}

/// A set that was fitted in full simulation.
#[derive(Clone, Debug)]
pub struct Tried {
    /// Round, from 0.
    pub round: usize,
    /// The set.
    pub set: EffectSet,
    /// Titles of what it adds.
    pub added: Vec<String>,
    /// −2 log likelihood before and after, and criterion.
    pub scores: [f64; 2],
    /// Criterion before and after.
    pub criteria: [f64; 2],
    /// What the linear model had promised.
    pub promised: f64,
    /// Share of the nominal model's missing force that it takes away.
    pub taken: f64,
}

/// Effects at most, and how many the linear model may add at once.
const MOST: usize = 6;
pub(super) const AT_ONCE: usize = 3;
/// Share of what the unknown forces do that one more effect has to take; and where less than a hundredth of that is left, which may be what the found
/// laws are off by themselves.
pub(super) const FURTHER: [f64; 2] = [0.2, 0.75];
const SMALL: f64 = 0.01;
/// Share of what the unknown forces do (their power) that may be what steps and difference quotients make of the laws that were found.
const OWN: f64 = 1e-5;
/// Part of what a set has to gain which its promise has to be: promises of laws that hold and slip are short of what these bring.
const HOPE: f64 = 0.25;
/// Share of such a remainder (rise of −2 log likelihood) that something has to take to be more than that.
const NEARLY: f64 = 0.9;
/// Share of what the unknown forces do below which nothing is left to add.
pub const NEXT_TO_NOTHING: f64 = 1e-3;
/// Iterations of a first fit, and to the end.
pub(super) const LOOK: Reach = Reach { iterations: 6, reuse: true };
pub(super) const GLANCE: Reach = Reach { iterations: 3, reuse: true };
pub(super) const END: Reach = Reach { iterations: 6, reuse: false };
/// Most times that a fit is followed anew to its end, and fall of −2 log likelihood that is worth another time.
const ENDS: usize = 5;
const WORTH: f64 = 3.0;
/// Nominal numbers off by no more than is usual from which on they are taken for small errors of all of them.
const SEVERAL: usize = 3;
/// Criterion by which a set is far from what it was.
pub(super) const FAR: f64 = 1000.0;

/// Criterion of a fit.
pub fn criterion(fit: &Fitted, many: usize) -> f64 {
    fit.score + fit.set.members.iter().map(|(h, _)| price(h, fit.count, many)).sum::<f64>()
}

/// Searches for what a nominal model leaves out, from that or from a set that is `begun` with; `hypotheses` of a model, and the nominal numbers that may stand
/// for what is left. And the problem at whose clock the best set stands.
pub fn search<'a>(
    problem: &Problem<'a>,
    (nominal, begun): (Fitted, Option<Fitted>),
    hypotheses: &Hypotheses<'_>,
    numbers: Option<EffectSet>,
) -> Result<(Found, Problem<'a>), DiagnoseError> {
    let nominal = at_rest(problem, nominal)?;
    let first = hypotheses(&nominal)?;
    // What a nominal model leaves that is far from what the runs did is no measure of what is left beside another one.
    let (many, all) = (first.len(), problem.power(begun.as_ref().unwrap_or(&nominal)));
    let best = nominal.clone();
    let (tried, equals, shown) = (Vec::new(), Vec::new(), Vec::new());
    let found = Found { nominal, best, criteria: [f64::NAN; 2], tried, equals, shown, left: 0.0 };
    let (known, refused) = (first.clone(), Vec::new());
    let ways = Vec::new();
    let mut search = Search { problem, hypotheses, many, all, numbers, known, refused, ways, smaller: None, found };
    let mut now = match begun {
        Some(begun) => search.forward(begun, 1, None)?,
        None => search.forward(search.found.nominal.clone(), 0, None)?,
    };
    // Where the first step was one of several effects at once that lead nowhere, one with fewer of them may be the way.
    if let Some(smaller) = search.smaller.take().filter(|_| !problem.stage.work.is_spent(Until::Search))
        && !remainder(problem, &now)?.is_noise()
    {
        problem.stage.work.watch.step(&format!("on from {}", names(&smaller.set)));
        let other = search.forward(smaller, 1, Some(criterion(&now, many)))?;
        if criterion(&other, many) < criterion(&now, many) {
            now = other;
        }
    }
    let Search { mut found, mut known, .. } = search;
    // A joint that yields by now is no more one that may begin to, and yet that is what a joint with play becomes.
    known.extend(first);
    let (heard, now) = heard(problem, now, all)?;
    let problem = &heard;
    let before = now.score;
    // Where noise alone is left, nothing tells of what laws hold in reserve.
    let free = match remainder(problem, &now)?.is_noise() {
        true => now,
        false => enriched(problem, relaxed(problem, now, many), &known, many),
    };
    let free = if free.score < before { to_the_end(problem, free) } else { free };
    let plain = simplified(problem, free, &known, (many, all))?;
    let plain = united(problem, plain, (&found.tried, &found.shown), many);
    let titles = plain.set.titles();
    (found.best, found.equals) = exchanged(problem, plain, (&found.tried, &found.shown), many)?;
    if found.best.set.titles() != titles {
        found.best = simplified(problem, found.best, &known, (many, all))?;
    }
    found.criteria = [&found.nominal, &found.best].map(|fit| criterion(fit, many));
    Ok((found, heard))
}

/// A fit that leaves next to nothing and yet more than noise at the clock of what it is: there it may be noise.
fn heard<'a>(problem: &Problem<'a>, now: Fitted, all: f64) -> Result<(Problem<'a>, Fitted), DiagnoseError> {
    if problem.power(&now) > NEXT_TO_NOTHING * all || remainder(problem, &now)?.is_noise() {
        return Ok((problem.clone(), now));
    }
    let heard = problem.clone().heard_by(&now.set)?;
    let now = heard.reheard(problem, &now)?.map_or(now, |anew| to_the_end(&heard, anew));
    Ok((heard, now))
}

/// What could act beside a fit.
pub type Hypotheses<'a> = dyn Fn(&Fitted) -> Result<Vec<Hypothesis>, DiagnoseError> + 'a;

/// A search on its way.
struct Search<'a> {
    problem: &'a Problem<'a>,
    hypotheses: &'a Hypotheses<'a>,
    /// Hypotheses beside the nominal model, and what the unknown forces there do.
    many: usize,
    all: f64,
    /// Nominal numbers that were not freed yet.
    numbers: Option<EffectSet>,
    /// Hypotheses of the last round, and titles of what is asked no more.
    known: Vec<Hypothesis>,
    refused: Vec<String>,
    /// Titles of what was taken, round by round of all ways.
    ways: Vec<BTreeSet<String>>,
    /// The best of those with fewer effects than what the first round took.
    smaller: Option<Fitted>,
    found: Found,
}

impl Search<'_> {
    /// Adds what is worth its price to a fit, round by round; `goal`: criterion to which another way has led already.
    fn forward(&mut self, mut now: Fitted, first: usize, mut goal: Option<f64>) -> Result<Fitted, DiagnoseError> {
        let Self { problem, many, all, .. } = *self;
        for round in first..MOST {
            let room = MOST.saturating_sub(now.set.findings().count());
            let bare = bare(problem, &now)?;
            if round > 0 {
                self.known = (self.hypotheses)(&now)?;
            }
            let mut candidates = open(self.known.clone(), &now, problem, &bare);
            candidates.retain(|h| !self.refused.contains(&h.title()));
            let cheapest = candidates.iter().map(|h| price(h, now.count, many)).fold(f64::INFINITY, f64::min);
            let left = left_of(problem, &now, &bare).rise;
            // What is so little may be the laws' own; what takes nearly all of it is not.
            let is_own = round > 0 && problem.power(&now) < OWN * all;
            // Only the first sets are held against what is known; what stands beside them later is another question.
            let least = goal.take().map_or(0.0, |goal| PROMISING * (criterion(&now, many) - goal).max(0.0));
            let bounds = Bounds { round, many, cheapest, all, is_own, least };
            // A nominal model that leaves nothing is still asked what these recordings can show.
            let is_done = round > 0 && left < cheapest;
            let is_settled = is_done || is_own;
            let next =
                if round > 0 { corrected(problem, &now, (&mut self.numbers, is_settled), bounds)? } else { None };
            if let Some(next) = next {
                now = next;
                continue;
            }
            if room == 0 || is_done || problem.stage.work.is_spent(Until::Search) {
                break;
            }
            let Some(best) = self.further(&mut now, (candidates, room), bounds)? else { break };
            let best = without_idle(problem, best, (many, all))?;
            let (alone, gone) = alone_of_their_kind(problem, best, many);
            now = alone;
            self.refused.extend(gone);
            problem.stage.work.watch.step(&format!("{}: −2 log L {:.1}", names(&now.set), now.score));
            let taken: BTreeSet<String> = now.set.titles().into_iter().collect();
            // Another way that leads to the same set goes on as the first did.
            if self.ways.contains(&taken) {
                break;
            }
            self.ways.push(taken);
        }
        Ok(now)
    }

    /// The best of the sets that a round fits beside a fit, where that takes its part.
    fn further(
        &mut self,
        now: &mut Fitted,
        (candidates, room): (Vec<Hypothesis>, usize),
        bounds: Bounds,
    ) -> Result<Option<Fitted>, DiagnoseError> {
        let (problem, round) = (self.problem, bounds.round);
        let (last, first): (Vec<Hypothesis>, Vec<Hypothesis>) = candidates.into_iter().partition(|h| h.is_last);
        let looked = look(problem, now, first.clone(), room.min(AT_ONCE))?;
        if round == 0 {
            (self.found.shown, self.found.left) = (shown(&looked.pool, &looked.grown), looked.grown.left);
        }
        let asked = if round > 0 && !bounds.is_own { HOPE * looked.asked(problem, now, self.all) } else { 0.0 };
        let bounds = Bounds { least: bounds.least.max(asked), ..bounds };
        let fitted = fit_sets(problem, now, &looked, bounds, &mut self.found.tried)?;
        let Some((best, smaller)) = self.with_the_last(now, (fitted, first, last), room, bounds)? else {
            return Ok(None);
        };
        if round == 0 {
            self.smaller = smaller;
        }
        // What takes little of what an accepted set leaves stands for something that is not in the library; what leaves noise alone has taken all.
        let left_by = |fit: &Fitted| Left { power: problem.power(fit), spread: fit.spread.clone() };
        let takes_enough = match bounds.is_own {
            true => remainder(problem, &best)?.rise <= (1.0 - NEARLY) * remainder(problem, now)?.rise,
            false => {
                let takes = || left_by(&best).takes_its_part_of(&left_by(now), self.all, problem.stage.doubt);
                round == 0 || takes() || remainder(problem, &best)?.is_noise()
            }
        };
        Ok(takes_enough.then_some(best))
    }

    /// The best of what a round has fitted, or of sets with what is asked last where that leaves much of the missing force.
    fn with_the_last(
        &mut self,
        now: &mut Fitted,
        (fitted, first, last): (Option<Round>, Vec<Hypothesis>, Vec<Hypothesis>),
        room: usize,
        bounds: Bounds,
    ) -> Result<Option<Round>, DiagnoseError> {
        let Self { problem, many, .. } = *self;
        let here = problem.power(now);
        let takes_most = fitted.as_ref().is_some_and(|(best, _)| problem.power(best) < MUCH * here);
        if last.is_empty() || takes_most || bounds.is_own || remainder(problem, now)?.is_noise() {
            return Ok(fitted);
        }
        problem.stage.work.watch.step("that explains too little: loads on links as well");
        let mut looked = look(problem, now, [first, last].concat(), room.min(AT_ONCE))?;
        if bounds.round == 0 {
            self.found.shown = shown(&looked.pool, &looked.grown);
        }
        looked.keep_the_last();
        let other = fit_sets(problem, now, &looked, bounds, &mut self.found.tried)?;
        let all = fitted.into_iter().chain(other);
        Ok(all.min_by(|a, b| criterion(&a.0, many).total_cmp(&criterion(&b.0, many))))
    }
}

/// The best of a round's sets, and the best of those with fewer effects.
type Round = (Fitted, Option<Fitted>);

/// Share of the missing force that is much to leave.
const MUCH: f64 = 0.1;

/// A fit with many nominal numbers free within what is usual, where those of its findings that are no more than that may stand among them, or where they
/// take most of what is left: small errors of all numbers together look like no single effect. Tried as long as there are `numbers`.
fn corrected(
    problem: &Problem<'_>,
    now: &Fitted,
    (numbers, is_done): (&mut Option<EffectSet>, bool),
    Bounds { many, cheapest, all, .. }: Bounds,
) -> Result<Option<Fitted>, DiagnoseError> {
    let Some(free) = numbers.as_ref().filter(|n| !n.members.is_empty()) else { return Ok(None) };
    let of = |h: &Hypothesis| free.members.iter().find(|(m, _)| m.title() == h.title()).map(|(m, _)| m);
    let is_usual = |(h, x): &(Hypothesis, Vec<f64>)| of(h).is_some_and(|m| m.clamped(x) == *x);
    // One or two numbers that explain all by themselves are what was found; where it takes more of them all are off.
    let has_usual = now.set.findings().filter(|m| is_usual(m)).count() >= SEVERAL;
    let (here, is_left) = (problem.power(now), !is_done);
    if !(has_usual || is_left && here < SMALL * all) {
        return Ok(None);
    }
    let usual = (0..now.set.members.len()).rev().filter(|m| is_usual(&now.set.members[*m]));
    let mut set = usual.fold(now.set.clone(), |set, m| set.without(m));
    for (h, x) in &free.members {
        match now.set.members.iter().find(|m| m.0.title() == h.title()) {
            // What is off by more than is usual stays a finding.
            Some(found) if !is_usual(found) => (),
            found => set = set.with(h, found.map_or(x, |m| &m.1)),
        }
    }
    *numbers = None;
    let Ok(next) = problem.fit(now, set, LOOK) else { return Ok(None) };
    let (fall, power) = (criterion(now, many) - criterion(&next, many), problem.power(&next));
    let said =
        format!("  nominal numbers within what is usual: criterion {:.1}, left {:.2} %", -fall, 100.0 * power / here);
    problem.stage.work.watch.step(&said);
    let takes_most = fall >= cheapest && power <= (1.0 - FURTHER[1]) * here;
    if !(takes_most || has_usual && fall > 0.0) {
        return Ok(None);
    }
    Ok(Some(without_idle(problem, to_the_end(problem, next), (many, all))?))
}

/// Share of what unknown forces do beside a set that one more effect has to take.
pub(super) fn further(beside: f64, all: f64) -> f64 {
    if beside < OWN * all {
        return 1.0;
    }
    FURTHER[usize::from(beside < SMALL * all)]
}

/// Whether a law takes less than its part of what its plainer kind leaves, of all that there was.
pub(crate) fn takes_little(rich: f64, plain: f64, all: f64) -> bool {
    rich > (1.0 - further(plain, all).min(FURTHER[1])) * plain
}

/// What a fit leaves beyond noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Remainder {
    /// Rise of −2 log likelihood where there are neither unknown forces nor more noise than is known.
    pub rise: f64,
    /// What noise alone exceeds with a probability of one in a hundred.
    pub bound: f64,
}

impl Remainder {
    /// Whether noise alone may leave as much.
    pub fn is_noise(&self) -> bool {
        self.rise <= self.bound
    }
}

/// Likelihood ratio of unknown forces and further noise.
///
/// Each of m variances at the edge of what it may be adds half a χ² of one degree (Self and Liang 1987): mean ½, variance 5/4 each; the bound is
/// that sum's 99 % point as of a gamma distribution (Wilson–Hilferty).
pub fn remainder(problem: &Problem<'_>, fit: &Fitted) -> Result<Remainder, DiagnoseError> {
    Ok(left_of(problem, fit, &bare(problem, fit)?))
}

/// A fit without the forces that are unknown there, where that is likelier: states that are led apart by a motion that is not stable take forces for it, and steps
/// along their spread end before there is none.
fn at_rest(problem: &Problem<'_>, fit: Fitted) -> Result<Fitted, DiagnoseError> {
    if remainder(problem, &fit)?.rise >= 0.0 {
        return Ok(fit);
    }
    let silent = problem.without_forces(fit.clone());
    Ok(silent.ok().filter(|silent| silent.score < fit.score).unwrap_or(fit))
}

/// The runs of a fit made linear where it stands, without numbers.
pub(super) fn bare(problem: &Problem<'_>, fit: &Fitted) -> Result<Vec<Chain>, DiagnoseError> {
    Ok(problem.linearise(&mut fit.clone(), &[], true)?.chains(&[]))
}

fn left_of(problem: &Problem<'_>, fit: &Fitted, bare: &[Chain]) -> Remainder {
    let at = |spread: &Spread| score(bare, spread);
    let stated = (1.0 + problem.stage.doubt).sqrt();
    let noise = fit.spread.noise.map(|x| x.min(stated));
    let silent = Spread { noise, ..Spread::steady(problem.forces.len(), problem.channels.len()) };
    let (mean, variance) = (0.5 * problem.variances() as f64, 1.25 * problem.variances() as f64);
    let bound = mean * gamma_quantile_over_mean(mean * mean / variance, ONE_IN_HUNDRED);
    Remainder { rise: at(&silent) - at(&fit.spread), bound }
}

/// Normal score that is exceeded once in a hundred times.
const ONE_IN_HUNDRED: f64 = 2.326;

/// What the information matrix says of every hypothesis, the most promising first.
fn shown(pool: &Pool, grown: &Grown) -> Vec<(Hypothesis, Score)> {
    grown.scores.iter().map(|s| (pool.hypotheses[s.hypothesis].clone(), s.clone())).collect()
}

/// What the first looks at all hypotheses beside a fit say.
pub(super) struct Looked {
    pub(super) pool: Pool,
    /// By the chain.
    pub(super) grown: Grown,
    /// By the missing force.
    pub(super) spoken: Vec<Spoken>,
    /// Intervals in which the readings say what a force is, of all forces.
    known: f64,
    /// Samples of each channel.
    samples: Vec<usize>,
}

impl Looked {
    /// Without sets of what was looked at before.
    fn keep_the_last(&mut self) {
        let Self { pool, grown, spoken, .. } = self;
        let has_last = |members: &[(usize, Vec<f64>)]| members.iter().any(|m| pool.of(m.0).is_last);
        grown.sets.retain(|set| has_last(&set.members));
        spoken.retain(|set| has_last(&set.members));
        grown.scores.retain(|score| pool.hypotheses[score.hypothesis].is_last);
    }

    /// The least that something gains, −2 log likelihood, which takes its part of what a fit leaves: where forces are known in n intervals a variance
    /// that is smaller by a share φ is a gain of −n ln(1 − φ); a channel that reads with more noise than its sensor has may be quieted as well.
    fn asked(&self, problem: &Problem<'_>, now: &Fitted, all: f64) -> f64 {
        let share = further(problem.power(now), all).min(FURTHER[1]);
        let quieted = self
            .samples
            .iter()
            .zip(&now.spread.noise)
            .filter_map(|(n, noise)| Some(*n as f64 * quieting(*noise, problem.stage.doubt)?));
        quieted.fold(-self.known * (-share).ln_1p(), f64::min)
    }
}

/// Takes all columns beside a fit and grows sets of them.
fn look(problem: &Problem<'_>, now: &mut Fitted, all: Vec<Hypothesis>, most: usize) -> Result<Looked, DiagnoseError> {
    let slots = now.set.slots();
    let active = vary(problem.plant, &now.set, &slots, &first_sizes(&now.set))?;
    let pool = Pool::new(problem.plant, &now.set, all)?;
    let watch = problem.stage.work.watch;
    watch.step(&format!("{} hypotheses, {} columns", pool.hypotheses.len(), pool.variations.len()));
    let variations: Vec<_> = active.iter().chain(&pool.variations).cloned().collect();
    let made = problem.linearise(now, &variations, true)?;
    watch.step("columns taken");
    let ridge = ridge_of(&now.set, slots.len());
    let chains = made.chains(&(0..slots.len()).collect::<Vec<_>>());
    let none = estimate(&chains, Some(&ridge), &now.spread, 2);
    let smoothed: Vec<_> = chains.iter().map(|chain| chain.smoothed(&none.spread, &none.theta)).collect();
    let scale = Scale::new(problem, now, &pool, &smoothed, &none.spread);
    let spoken =
        Regression::new((&pool, &scale), (&made.runs, slots.len()), (&smoothed, &none.spread.force)).grow(most);
    let (active, count) = (slots.len(), made.count);
    let ground = Ground { runs: &made.runs, ridge: &ridge, pool: &pool, scale: &scale, active, count };
    let mut grown = ground.grow(&none, most);
    let datum = now.datum;
    grown.sets.iter_mut().for_each(|s| (s.score, s.criterion) = (s.score - datum, s.criterion - datum));
    watch.step("sets grown");
    let mut samples = vec![0; now.spread.noise.len()];
    made.runs.iter().flat_map(|run| run.channels.iter().flatten()).for_each(|c| samples[*c as usize] += 1);
    Ok(Looked { known: scale.known(), samples, pool, grown, spoken })
}

/// A fit that is followed anew as long as that betters it: forces that pushed the runs beside other numbers hold these where they were.
pub(crate) fn to_the_end(problem: &Problem<'_>, mut now: Fitted) -> Fitted {
    for _ in 0..ENDS {
        let further =
            |from: &Fitted| problem.fit(from, now.set.clone(), END).ok().filter(|next| now.score - next.score > 0.0);
        // Forces that move what an interval reads by less than noise bear nothing.
        let cooler = || (problem.power(&now) > 1.0).then(|| cooled(&now));
        let Some(next) = further(&now).or_else(|| further(&cooler()?)) else { break };
        let fall = now.score - next.score;
        now = next;
        if fall < WORTH {
            break;
        }
    }
    now
}

/// A fit with forces that may do less: as long as they bear what wrong numbers leave undone, these move by a little of the way each time.
fn cooled(fit: &Fitted) -> Fitted {
    let mut cooled = fit.clone();
    cooled.spread.force *= COOLER;
    cooled
}

/// Share of the unknown forces' standard deviation.
const COOLER: f64 = 0.1;

/// A fit without members that are not worth their price.
fn without_idle(problem: &Problem<'_>, mut now: Fitted, (many, all): (usize, f64)) -> Result<Fitted, DiagnoseError> {
    // What leaves much more than they do is not idle, however little that is of all.
    let may_rise = |now: &Fitted| -> Result<f64, DiagnoseError> {
        let cheapest = now.set.findings().map(|(h, _)| price(h, now.count, many)).fold(f64::INFINITY, f64::min);
        Ok(remainder(problem, now)?.rise.max(cheapest) / (1.0 - NEARLY))
    };
    // Where nominal numbers are free there may be nothing beside them.
    let least = usize::from(!now.set.members.iter().any(|(h, _)| h.is_tolerated()));
    while now.set.findings().count() > least {
        let mut better = None;
        for m in (0..now.set.members.len()).rev().filter(|m| !now.set.members[*m].0.is_tolerated()) {
            let Ok(glance) = problem.fit(&now, now.set.without(m), GLANCE) else { continue };
            // What is worse by far after two steps does not come back.
            let leaves_own = |fit: &Fitted| {
                let is_own = problem.power(fit) < OWN * all && is_as_quiet(&fit.spread, &now.spread);
                is_own && matches!((remainder(problem, fit), may_rise(&now)), (Ok(left), Ok(most)) if left.rise <= most)
            };
            if criterion(&glance, many) - criterion(&now, many) > FAR && !leaves_own(&glance) {
                continue;
            }
            let Ok(less) = problem.fit(&glance, glance.set.clone(), LOOK) else { continue };
            if leaves_own(&less)
                || criterion(&less, many) < better.as_ref().map_or(criterion(&now, many), |b| criterion(b, many))
            {
                better = Some(less);
            }
        }
        let Some(less) = better else { break };
        now = to_the_end(problem, less);
    }
    Ok(now)
}

/// The same with laws as the plainer ones that they become, where these are as good by the criterion; and where much is left that no law has, of which
/// the richer one takes less than its part: what it gains there is not what it stands for.
fn simplified(
    problem: &Problem<'_>,
    mut now: Fitted,
    known: &[Hypothesis],
    (many, all): (usize, f64),
) -> Result<Fitted, DiagnoseError> {
    for member in now.set.members.clone() {
        for (plain, x) in simpler(&member, &now.set, known) {
            let Some(at) = now.set.members.iter().position(|m| m.0.title() == member.0.title()) else { continue };
            let Ok(glance) = problem.fit(&now, now.set.without(at).with(&plain, &x), GLANCE) else { continue };
            if criterion(&glance, many) - criterion(&now, many) > FAR {
                continue;
            }
            let tried = to_the_end(problem, glance);
            let costs = criterion(&tried, many) - criterion(&now, many);
            let [rich, poor] = [&now, &tried].map(|fit| problem.power(fit));
            let is_idle = || -> Result<bool, DiagnoseError> {
                let left = remainder(problem, &now)?;
                Ok(!left.is_noise() && takes_little(rich, poor, all))
            };
            let said = format!("  {} instead costs {costs:.1}, leaves {:.3} times as much", plain.title(), poor / rich);
            problem.stage.work.watch.step(&said);
            if costs < 0.0 || is_idle()? {
                now = tried;
                break;
            }
        }
    }
    Ok(now)
}

/// Members in a line.
pub(crate) fn names(set: &EffectSet) -> String {
    let found: Vec<String> = set.findings().map(|(h, x)| format!("{} ({})", h.title(), told(h, x))).collect();
    if found.is_empty() { "nothing".to_owned() } else { found.join("; ") }
}

/// Hypotheses about a model's own parts, and about what swings in what a fit of it leaves, over time and over the places of joints.
pub fn hypotheses_of(problem: &Problem<'_>, now: &Fitted, own: &Facts) -> Result<Vec<Hypothesis>, DiagnoseError> {
    let mut facts = Facts { lines: lines(problem, now)?, ..Facts::new(&now.built, problem.stage.tapes).of_parts(own) };
    give_orders(&mut facts, problem, now);
    let watch = problem.stage.work.watch;
    say(watch, "lines", &facts.lines, " Hz");
    for joint in &facts.joints {
        say(watch, &format!("orders over the place of {}", joint.name), &joint.orders, "");
    }
    Ok(crate::catalogue::hypotheses(&facts))
}
