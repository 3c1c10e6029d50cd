//! Refits of one round: what a screen promises is fitted in full simulation, one law at a time and sets of them.

use crate::attempt::Attempt;
use crate::choice::{brought_by, by_criterion};
use crate::error::DiagnoseError;
use crate::fit::{Effort, Fit, fit};
use crate::hypothesis::{Hypothesis, Tier};
use crate::linear::{Segment, Stage};
use crate::plant::Plant;
use crate::screen::{Score, screen};
use crate::search::{LOOK, Limits, TIE, WHOLE};
use crate::standing::{criterion, told};
use crate::start::count_memory;
use crate::together::{Ensemble, screen_together};
use crate::work::Until;

/// Promise relative to the best below which a hypothesis is not refitted.
const PROMISING: f64 = 0.15;
/// Promise relative to what another refit has brought below which none is made.
const RIVAL: f64 = 0.9;
/// The same relative to the largest promise, where no refit leaves nothing.
const EQUAL: f64 = 0.7;
/// Hypotheses of a screen that a watcher hears of.
const TOLD: usize = 8;
/// Share of the excess that a refit may leave where other refits are only made of what promises as much.
const NEXT_TO_NOTHING: f64 = 0.01;

/// A fit of a set with one or more effects added.
#[derive(Clone, Debug)]
pub(crate) struct Refit {
    /// Number of the attempt that it belongs to; of several effects that of the last.
    pub attempt: usize,
    /// What came of it.
    pub fit: Fit,
}

/// The refits of one round, beside a converged set at one length.
pub(crate) struct Refits<'a> {
    pub stage: &'a Stage<'a>,
    pub plant: &'a Plant,
    /// The set beside which effects are added.
    pub here: &'a Fit,
    pub limits: Limits,
    /// Number of the round.
    pub round: usize,
    /// What was tried so far in this round.
    pub attempts: &'a mut Vec<Attempt>,
}

impl Refits<'_> {
    /// Screens, and says so.
    pub fn screen(&self, all: &[Hypothesis]) -> Result<Vec<Score>, DiagnoseError> {
        let columns: usize = all.iter().flat_map(|h| &h.screens).map(|s| s.columns.len()).sum();
        let (count, error) = (all.len(), self.here.rms());
        self.say(&format!("screen {count} hypotheses in {columns} directions beside error {error:.3}"));
        screen(self.stage, self.plant, self.here, all)
    }

    fn say(&self, what: &str) {
        self.stage.work.watch.step(what);
    }

    /// Refits what a screen found most promising, best first; `least`: a promise below it is none.
    pub fn promising(&mut self, all: &[Hypothesis], scores: &[Score], least: f64) -> Result<Vec<Refit>, DiagnoseError> {
        let interesting = scores_of_interest(all, scores);
        let picked = self.pick(all, &interesting, least);
        for score in interesting.iter().take(TOLD) {
            let h = &all[score.hypothesis];
            let (label, share) = (&h.screens[score.point].label, 100.0 * score.score / self.here.cost);
            self.say(&format!("  {} {label} promises {share:.1} % of the cost", h.title()));
        }
        let most = interesting.first().map_or(0.0, |s| s.score);
        let mut ready: Vec<Refit> = Vec::new();
        for score in interesting {
            let h = &all[score.hypothesis];
            let attempt = self.attempt_of(h, score);
            let is_picked = picked.iter().any(|p| std::ptr::eq(*p, score));
            let is_spent = !ready.is_empty() && self.stage.work.is_spent(Until::Search);
            if !is_picked || is_spent || self.is_hopeless(h, score, (&ready, most)) {
                continue;
            }
            if let Some(fit) = self.refit(h, score, attempt) {
                ready.push(Refit { attempt, fit });
            }
        }
        // Of several starts of one hypothesis the best ends count, and of laws that do alike the plainer, once they have come to their ends.
        ready.sort_by(by_criterion);
        let mut seen: Vec<usize> = Vec::new();
        ready.retain(|r| {
            seen.push(r.attempt);
            seen.iter().filter(|at| **at == r.attempt).count() <= self.limits.ends
        });
        self.settle_ties(&mut ready)?;
        Ok(ready)
    }

    /// Number of a hypothesis's attempt in this round; a new one where it has none yet.
    fn attempt_of(&mut self, h: &Hypothesis, score: &Score) -> usize {
        let known = self.attempts.iter().position(|a| a.name == h.name && a.place == h.place);
        known.unwrap_or_else(|| {
            self.attempts.push(Attempt::new(self.round, h, score, self.here));
            self.attempts.len() - 1
        })
    }

    /// Whether a promise is too small beside what other refits have brought; `most`: the largest promise.
    fn is_hopeless(&self, h: &Hypothesis, score: &Score, (ready, most): (&[Refit], f64)) -> bool {
        // A promise is seldom exceeded: what promises less than another has brought already is left alone; where that one leaves something
        // too, promises are compared, which are rough.
        let is_open = ready.iter().all(|r| r.fit.is_significant());
        let rival = (RIVAL * brought_by(self.here, ready)).min(if is_open { EQUAL * most } else { f64::INFINITY });
        // Beside a refit that leaves next to nothing no valley is looked for either.
        let is_rest = ready.iter().any(|r| r.fit.excess() < NEXT_TO_NOTHING * self.here.excess());
        score.score < rival && (!h.has_valleys() || is_rest)
    }

    /// One hypothesis in full simulation, from where a screen says; none where that leads nowhere.
    fn refit(&mut self, h: &Hypothesis, score: &Score, attempt: usize) -> Option<Fit> {
        let here = self.here;
        let start = self.possible(h, &score.start)?;
        let tried = fit(self.stage, self.plant, here.set.with(h, &start), here.segments.clone(), LOOK).ok()?;
        let found = tried.set.members.last().map(|(h, x)| told(h, x)).unwrap_or_default();
        self.say(&format!("refit {} {found}: error {:.3} → {:.3}", h.title(), here.rms(), tried.rms()));
        if self.attempts[attempt].fall.is_none_or(|fall| here.cost - tried.cost > fall) {
            self.attempts[attempt].tell(here, &tried);
        }
        // A nominal number that runs to the end of what is possible stands for something else.
        let is_absurd = h.tier == Tier::Nominal && tried.set.members.last().is_some_and(|(h, x)| h.is_at_bound(x));
        (tried.cost < here.cost && !is_absurd).then_some(tried)
    }

    /// Refits that do alike, fitted until they have converged: only then are they told apart.
    fn settle_ties(&self, ready: &mut [Refit]) -> Result<(), DiagnoseError> {
        let near = ready.first().map_or(0.0, |r| criterion(&r.fit)) + TIE * brought_by(self.here, ready);
        let is_tied = |r: &Refit| criterion(&r.fit) < near;
        if !ready.iter().any(|r| r.attempt != ready[0].attempt && is_tied(r)) {
            return Ok(());
        }
        for tied in ready.iter_mut().filter(|r| is_tied(r)) {
            tied.fit = fit(self.stage, self.plant, tied.fit.set.clone(), tied.fit.segments.clone(), WHOLE)?;
            let title = self.attempts[tied.attempt].title();
            self.say(&format!("to the end: {title}: error {:.4}", tied.fit.rms()));
        }
        ready.sort_by(by_criterion);
        Ok(())
    }

    /// Refits sets of effects that promise more together than any of them alone, as many as may still be added.
    pub fn together(&mut self, all: &[Hypothesis], scores: &[Score]) -> Result<Vec<Refit>, DiagnoseError> {
        let most = self.limits.effects - self.here.set.findings().count();
        let sets = screen_together(self.stage, self.plant, self.here, (all, scores, most))?;
        Ok(sets.iter().filter_map(|ensemble| self.refit_set(all, ensemble)).collect())
    }

    fn refit_set(&mut self, all: &[Hypothesis], ensemble: &Ensemble) -> Option<Refit> {
        let here = self.here;
        let titles: Vec<String> = ensemble.members.iter().map(|(h, _)| all[*h].title()).collect();
        let promised = 100.0 * ensemble.score / here.cost;
        self.say(&format!("  {} together promise {promised:.1} % of the cost", titles.join(", ")));
        let set = ensemble.beside(&here.set, all);
        let tried = fit(self.stage, self.plant, set, here.segments.clone(), LOOK).ok()?;
        let found = tried.set.findings().map(|(h, x)| told(h, x)).collect::<Vec<_>>().join("; ");
        self.say(&format!("refit together {found}: error {:.3} → {:.3}", here.rms(), tried.rms()));
        if tried.cost >= here.cost {
            return None;
        }
        let at = |title: &String| self.attempts.iter().position(|a| a.title() == *title);
        let places: Vec<Option<usize>> = titles.iter().map(at).collect();
        let kept = (here.cost - tried.cost) / ensemble.score.max(f64::MIN_POSITIVE);
        for (place, part) in places.iter().zip(&ensemble.parts).filter_map(|(p, part)| p.map(|p| (p, part))) {
            self.attempts[place].tell_part(here, &tried, kept.min(1.0) * part);
        }
        places.last().copied().flatten().map(|attempt| Refit { attempt, fit: tried })
    }

    /// Coordinates to begin a refit with: those that were promised, or nearer to neutral where these cannot be built or the starts
    /// cannot follow them (a screen is linear, and may promise a part heavier than its body).
    fn possible(&self, h: &Hypothesis, promised: &[f64]) -> Option<Vec<f64>> {
        let Self { stage, plant, here: now, .. } = self;
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

    /// The hypotheses worth a refit: the most promising, of each law the places that promise alike, nominal numbers among them if they promise anything.
    fn pick<'s>(&self, all: &[Hypothesis], interesting: &[&'s Score], least: f64) -> Vec<&'s Score> {
        let (now, most) = (self.here, self.limits.refits);
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
}

/// One in so many segments tells how near what remembers may begin, and how far its starts are fitted for that.
const FEW: usize = 3;
const BRIEF: Effort = Effort { iterations: 2, share: 1e-2, ..Effort::STARTS };
/// Halvings of a promise.
const SHARES: i32 = 5;

/// The best screen points of each hypothesis, best first: one of each, and a few where the cost has many valleys.
pub(crate) fn scores_of_interest<'s>(all: &[Hypothesis], scores: &'s [Score]) -> Vec<&'s Score> {
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
