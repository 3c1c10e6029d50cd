//! A set of effects as it stands: in windows, in longer ones, and over whole runs.
//!
//! Windows are convex enough to begin from, whole runs have the power and are what is judged. Where the nominal model does not follow windows of
//! the length in which predictions are judged, shorter ones come first, and a set that follows these climbs to longer ones (continuation
//! over the length, as in multiple shooting: Bock and Plitt 1984).

use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::fit::{Effort, Fit, fit};
use crate::hypothesis::Hypothesis;
use crate::linear::{Segment, Stage};
use crate::lost::{self, FEW, NEAR, POOR_WINDOW};
use crate::plant::{Built, Plant};
use crate::stretches::STEEP;
use nalgebra::DMatrix;
use rayon::prelude::*;
use std::sync::Arc;

/// Schwarz's criterion, with what is held against some members beforehand.
pub fn criterion(fit: &Fit) -> f64 {
    let burden: f64 = fit.set.members.iter().map(|(h, _)| h.burden()).sum();
    let free = fit.set.slots().iter().filter(|(m, _)| !fit.set.members[*m].0.is_tolerated()).count();
    fit.cost + fit.set.prior_cost() + free as f64 * (fit.count as f64).ln() + burden
}

/// A set of effects, fitted at both lengths.
#[derive(Clone, Debug)]
pub struct Standing {
    /// In some windows.
    pub windows: Fit,
    /// Over whole runs.
    pub whole: Fit,
    /// Segments of the lengths between, shortest first; none where windows lead to whole runs at once.
    pub rungs: Vec<Vec<Segment>>,
    /// Root mean square up to which whole runs follow far enough to be judged by; zero where they never do.
    pub reach: f64,
}

impl Standing {
    /// One set at both lengths.
    pub fn new(stage: &Stage<'_>, windows: Fit, whole: Fit, rungs: Vec<Vec<Segment>>) -> Self {
        let reach = match rungs.is_empty() {
            true => DIVERGED,
            // Where nothing restores what goes astray, windows judge.
            false if whole.rms() > DIVERGED => 0.0,
            false => STEEP,
        };
        Self { windows, whole, rungs, reach }.weighted(stage)
    }

    /// The same with weights: where windows are only there to begin from, or are far off yet, none of them counts for more than all that is in it.
    pub(crate) fn weighted(mut self, stage: &Stage<'_>) -> Self {
        for segment in &mut self.windows.segments {
            if segment.weight != 1.0 {
                (segment.columns, segment.weight) = (None, 1.0);
            }
        }
        let is_near = stage.cost(&self.windows.built, &self.windows.segments) < NEAR * NEAR * self.windows.count as f64;
        if self.follows() || !is_near && self.reach <= STEEP {
            weigh(stage, &self.windows.built, &mut self.windows.segments);
        }
        self.windows.cost = stage.cost(&self.windows.built, &self.windows.segments);
        (self.windows.count, self.windows.noise) = stage.noise(&self.windows.segments);
        self
    }

    /// The fit that judges: whole runs where these follow, else the windows.
    pub fn judge(&self) -> &Fit {
        if self.follows() { &self.whole } else { &self.windows }
    }

    /// Whether whole runs follow the model far enough to be judged by.
    pub fn follows(&self) -> bool {
        self.whole.rms() < self.reach
    }

    /// The same model as a set beside a scenario that has less of it.
    pub(crate) fn of_plant(&self, plant: &Plant, set: &EffectSet) -> Result<Self, DiagnoseError> {
        let built = plant.build(&set.effects())?;
        let of = |fit: &Fit| {
            let covariance = DMatrix::zeros(0, 0);
            Fit { set: set.clone(), built: built.clone(), covariance, converged: false, ..fit.clone() }
        };
        let [windows, whole] = [&self.windows, &self.whole].map(of);
        Ok(Self { windows, whole, ..self.clone() })
    }

    /// The same with another set, its parameters fitted at the length that judges.
    pub(crate) fn refit(
        &self,
        stage: &Stage<'_>,
        plant: &Plant,
        set: EffectSet,
        effort: Effort,
    ) -> Result<Self, DiagnoseError> {
        if self.follows() {
            let whole = fit_whole(stage, plant, (&self.whole, set), effort)?;
            if !whole.is_significant() {
                // Nobody looks at windows any more.
                let windows = Fit { set: whole.set.clone(), built: whole.built.clone(), ..self.windows.clone() };
                return Ok(Self { windows, whole, ..self.clone() });
            }
            let windows = fit(stage, plant, whole.set.frozen(), self.windows.segments.clone(), Effort::STARTS)?;
            let windows = Fit { set: whole.set.clone(), ..windows };
            return Ok(Self { windows, whole, ..self.clone() }.weighted(stage));
        }
        let windows = fit_in_turns(stage, plant, set, self.windows.segments.clone(), effort)?;
        self.climb(stage, plant, windows, effort)
    }

    /// The same, but no higher than it stands.
    pub(crate) fn refit_here(
        &self,
        stage: &Stage<'_>,
        plant: &Plant,
        set: EffectSet,
        effort: Effort,
    ) -> Result<Self, DiagnoseError> {
        if self.follows() || self.rungs.is_empty() {
            return self.refit(stage, plant, set, effort);
        }
        let windows = fit_in_turns(stage, plant, set, self.windows.segments.clone(), effort)?;
        let whole = self.left_far(&windows, self.whole.segments.clone());
        Ok(Self { windows, whole, ..self.clone() })
    }

    /// The standing of a set that was fitted in windows, in the longest windows that follow it, and over whole runs where these do.
    pub(crate) fn climbed(
        &self,
        stage: &Stage<'_>,
        plant: &Plant,
        mut windows: Fit,
        effort: Effort,
    ) -> Result<Self, DiagnoseError> {
        // What short windows can tell they tell before longer ones, in which there are more wrong valleys, are asked; where all are near
        // already, longer ones tell it better.
        if !self.rungs.is_empty() && lost::calc_share(stage, &windows) > 0.0 {
            windows = fit_in_turns(stage, plant, windows.set, windows.segments, effort)?;
        }
        self.climb(stage, plant, windows, effort)
    }

    fn climb(&self, stage: &Stage<'_>, plant: &Plant, mut windows: Fit, effort: Effort) -> Result<Self, DiagnoseError> {
        let mut rungs = self.rungs.clone();
        // What is not followed over short windows is not over longer ones.
        let is_followed = raw_rms(stage, &windows) <= FAIR || lost::calc_share(stage, &windows) <= FEW;
        while let Some(rung) = rungs.first().filter(|_| is_followed) {
            let begun = begun_as(rung, &windows.segments);
            let settled = settled(stage, plant, windows.set.frozen(), begun)?;
            let settled = Fit { set: windows.set.clone(), covariance: windows.covariance.clone(), ..settled };
            let tried = fit_robustly(stage, plant, settled, effort)?;
            let found = tried.set.members.iter().map(|(h, x)| told(h, x)).collect::<Vec<_>>().join("; ");
            stage.work.watch.step(&format!("  windows of {:.3} s: error {:.3}, {found}", length_of(rung), tried.rms()));
            if tried.rms() > STEEP && lost::calc_share(stage, &tried) > FEW {
                break;
            }
            windows = tried;
            rungs.remove(0);
        }
        let set = windows.set.clone();
        let segments = begun_as(&self.whole.segments, &windows.segments);
        // Where windows had to be shortened, whole runs are far off until the longest windows follow well.
        let is_far = !is_followed && !self.follows()
            || self.reach <= STEEP
                && (self.reach == 0.0 || !rungs.is_empty() || lost::calc_share(stage, &windows) > FEW);
        let whole = match is_far {
            true => self.left_far(&windows, segments),
            false => Fit { set: set.clone(), ..self.followed(stage, plant, set.frozen(), &segments)? },
        };
        let mut standing = Self { windows, whole, rungs, reach: self.reach };
        let is_fair = standing.windows.rms() <= FAIR || lost::calc_share(stage, &standing.windows) <= lost::FEW;
        if !standing.follows() && !is_far && is_fair {
            standing = standing.along_the_valley(stage, plant)?;
        }
        let set = standing.windows.set.clone();
        // They begin to follow: from now on they judge.
        if standing.follows() && standing.whole.is_significant() {
            standing.refit(stage, plant, set, effort)
        } else {
            Ok(standing)
        }
    }

    /// The same where whole runs come nearest along the valley in which windows leave the numbers: what these hardly tell, such as how long
    /// something takes to build up, the order of events in whole runs tells.
    fn along_the_valley(self, stage: &Stage<'_>, plant: &Plant) -> Result<Self, DiagnoseError> {
        let (set, covariance) = (&self.windows.set, &self.windows.covariance);
        let slots = set.slots();
        if covariance.nrows() != slots.len() {
            return Ok(self);
        }
        let at = |k: usize, distance: f64| {
            let sigma = covariance[(k, k)].max(f64::MIN_POSITIVE).sqrt();
            let theta: Vec<f64> = covariance.column(k).iter().map(|c| distance * c / sigma).collect();
            let moved = set.moved(&slots, &theta);
            let built = plant.build(&moved.effects()).ok()?;
            let cost = stage.settle(&built, &self.whole.segments).1;
            cost.is_finite().then_some((cost, moved))
        };
        let mut best = (stage.settle(&self.windows.built, &self.whole.segments).1, set.clone());
        for k in 0..slots.len() {
            let mut reached = 0.0;
            for distance in DISTANCES.iter().flat_map(|d| [*d, -d]) {
                if let Some(found) = at(k, distance).filter(|f| f.0 < best.0) {
                    (best, reached) = (found, distance);
                }
            }
            for share in FINER {
                best = at(k, share * reached).filter(|f| f.0 < best.0).unwrap_or(best);
            }
        }
        let whole = follow(stage, plant, best.1.frozen(), &self.whole.segments)?;
        let whole = Fit { set: best.1.clone(), ..whole };
        stage.work.watch.step(&format!("  along the valley: {:.3} over whole runs", whole.rms()));
        if whole.rms() >= self.whole.rms() {
            return Ok(self);
        }
        // What a window tells is not given up for a whole run, least of all for one that is followed nowhere.
        let windows = fit(stage, plant, best.1.frozen(), self.windows.segments.clone(), Effort::STARTS)?;
        if windows.rms() > FAIR && lost::calc_share(stage, &windows) > FEW {
            return Ok(self);
        }
        let windows = Fit { set: best.1, covariance: self.windows.covariance.clone(), ..windows };
        Ok(Self { windows, whole, ..self })
    }

    /// Whole runs as far off as they were, of a set that was fitted in windows only.
    fn left_far(&self, windows: &Fit, segments: Vec<Segment>) -> Fit {
        Fit { segments, set: windows.set.clone(), built: windows.built.clone(), ..self.whole.clone() }
    }

    /// Whole runs of a set that most windows follow; where these had to be shortened, runs that stand in wrong valleys are begun anew.
    fn followed(
        &self,
        stage: &Stage<'_>,
        plant: &Plant,
        set: EffectSet,
        segments: &[Segment],
    ) -> Result<Fit, DiagnoseError> {
        let whole = match self.reach > STEEP {
            true => return follow(stage, plant, set, segments),
            false => settled(stage, plant, set, segments.to_vec())?,
        };
        if whole.rms() < NEAR {
            return Ok(whole);
        }
        let segments = stage.begun_anew(&whole.built, &whole.segments, (Effort::STARTS, lost::POOR_RUN));
        let whole = fit(stage, plant, whole.set, segments, Effort { iterations: 1, ..Effort::STARTS })?;
        Ok(lost::cut_off(stage, whole))
    }

    /// Whether this standing is better than another: whole runs that follow, longer windows that do, then the criterion.
    pub(crate) fn is_better(&self, other: &Self) -> bool {
        match (self.follows(), other.follows()) {
            (true, false) => true,
            (false, true) => false,
            (true, true) if self.is_shorter(other) || other.is_shorter(self) => other.is_shorter(self),
            (false, false) if self.rungs.len() != other.rungs.len() => self.rungs.len() < other.rungs.len(),
            _ => criterion(self.judge()) < criterion(other.judge()),
        }
    }

    /// Whether clearly less of the runs is followed than by another.
    fn is_shorter(&self, other: &Self) -> bool {
        (self.whole.count as f64) < SHORTER * other.whole.count as f64
    }

    /// Whether what another standing is judged by is the same.
    pub(crate) fn is_comparable(&self, other: &Self) -> bool {
        self.follows() == other.follows() && (self.follows() || self.rungs.len() == other.rungs.len())
    }
}

/// Whole runs with their starts fitted, where these are near enough for that.
pub fn follow(stage: &Stage<'_>, plant: &Plant, set: EffectSet, segments: &[Segment]) -> Result<Fit, DiagnoseError> {
    follow_with(stage, plant, set, segments, Effort::STARTS)
}

/// The same with an effort of its own.
pub fn follow_with(
    stage: &Stage<'_>,
    plant: &Plant,
    set: EffectSet,
    segments: &[Segment],
    effort: Effort,
) -> Result<Fit, DiagnoseError> {
    let none = Effort { iterations: 0, ..effort };
    let first = fit(stage, plant, set, segments.to_vec(), none)?;
    if first.rms() > HOPELESS {
        return Ok(Fit { segments: segments.to_vec(), ..first });
    }
    fit(stage, plant, first.set, first.segments, effort)
}

/// Longer stretches that may begin as the longest window does with which they begin.
fn begun_as(longer: &[Segment], windows: &[Segment]) -> Vec<Segment> {
    let of = |stretch: &Segment| {
        let first = windows.iter().filter(|w| w.run == stretch.run && w.span.from == stretch.span.from);
        let longest = first.max_by(|a, b| a.span.to.total_cmp(&b.span.to));
        let guess = longest.map_or_else(|| Arc::clone(&stretch.guess), |w| Arc::new(w.start.clone()));
        Segment { guess, ..stretch.clone() }
    };
    longer.iter().map(of).collect()
}

/// Stretches of a set that shorter ones were fitted to: their starts, where these do not lead along all of them already.
fn settled(stage: &Stage<'_>, plant: &Plant, set: EffectSet, segments: Vec<Segment>) -> Result<Fit, DiagnoseError> {
    let first = fit(stage, plant, set, segments, Effort { iterations: 0, ..Effort::STARTS })?;
    if lost::calc_share(stage, &first) == 0.0 {
        return Ok(first);
    }
    follow(stage, plant, first.set, &first.segments)
}

/// Whole runs fitted; where a few of them stand in wrong valleys these do not drag the others along.
fn fit_whole(
    stage: &Stage<'_>,
    plant: &Plant,
    (whole, set): (&Fit, EffectSet),
    effort: Effort,
) -> Result<Fit, DiagnoseError> {
    let settled = fit(stage, plant, set.frozen(), whole.segments.clone(), Effort { iterations: 0, ..effort })?;
    let share = lost::calc_share(stage, &settled);
    if share > 0.0 && share <= lost::RUNS {
        return fit_robustly(stage, plant, Fit { set, ..settled }, effort);
    }
    fit_in_turns(stage, plant, set, whole.segments.clone(), effort)
}

/// A fit whose starts are begun anew as long as that finds lower valleys for some.
pub(crate) fn fit_in_turns(
    stage: &Stage<'_>,
    plant: &Plant,
    set: EffectSet,
    segments: Vec<Segment>,
    effort: Effort,
) -> Result<Fit, DiagnoseError> {
    let mut now = fit(stage, plant, set, segments, effort)?;
    for _ in 0..TURNS {
        let segments = stage.begun_anew(&now.built, &now.segments, (Effort::STARTS, POOR_WINDOW));
        let is_lower = stage.cost(&now.built, &segments) < LOWER * now.cost;
        if !is_lower {
            break;
        }
        let next = fit(stage, plant, now.set.clone(), segments, effort)?;
        stage.work.watch.step(&format!("  begun anew: error {:.3} → {:.3}", now.rms(), next.rms()));
        now = next;
    }
    Ok(now)
}

/// Weights by which no segment counts for more than all that is in it: those that stand in wrong valleys do not drag the others along.
fn weigh(stage: &Stage<'_>, built: &Built, segments: &mut [Segment]) {
    let of = |segment: &mut Segment| {
        (segment.columns, segment.weight) = (None, 1.0);
        let r = stage.residuals(built, segment);
        segment.weight = (r.len() as f64 / r.norm_squared()).min(1.0);
    };
    segments.par_iter_mut().for_each(of);
}

/// A fit of segments of which some may stand in wrong valleys: weighed, and these begun anew, as long as that helps.
fn fit_robustly(stage: &Stage<'_>, plant: &Plant, mut now: Fit, effort: Effort) -> Result<Fit, DiagnoseError> {
    if lost::calc_share(stage, &now) == 0.0 {
        return if now.is_significant() { fit_in_turns(stage, plant, now.set, now.segments, effort) } else { Ok(now) };
    }
    let anew = |now: &Fit| {
        let mut segments = stage.begun_anew(&now.built, &now.segments, (Effort::STARTS, POOR_WINDOW));
        segments.iter_mut().for_each(|s| (s.columns, s.weight) = (None, 1.0));
        let cost = stage.cost(&now.built, &segments);
        (segments, cost)
    };
    let (mut segments, mut cost) = anew(&now);
    for _ in 0..ROBUST {
        weigh(stage, &now.built, &mut segments);
        now = fit(stage, plant, now.set, segments, effort)?;
        let before = cost;
        (segments, cost) = anew(&now);
        if cost > LOWER * before {
            break;
        }
    }
    // Those that still stand in wrong valleys would drag the others along.
    let near: Vec<bool> = segments.par_iter().map(|s| lost::is_near(stage, &now.built, s)).collect();
    let effort = if near.iter().all(|n| *n) { effort } else { Effort { iterations: 0, ..effort } };
    fit(stage, plant, now.set, segments, effort)
}

/// Root mean square in windows up to which these tell a valley.
const FAIR: f64 = 2.0;
/// Distances along a valley, standard errors of what windows tell, and shares of the best of them at which it is looked at again.
const DISTANCES: [f64; 6] = [1.0, 3.0, 10.0, 30.0, 100.0, 300.0];
const FINER: [f64; 6] = [0.4, 0.55, 0.75, 1.3, 1.7, 2.2];

/// Most times that starts are begun anew, and with weights.
const TURNS: usize = 4;
const ROBUST: usize = 2;
/// Share of the cost below which that must bring it to be worth another fit.
const LOWER: f64 = 0.95;

/// Root mean square of a fit whose segments count by what is in them.
pub(crate) fn raw_rms(stage: &Stage<'_>, fit: &Fit) -> f64 {
    let of = |s: &Segment| (stage.residuals(&fit.built, s).norm_squared() / s.weight, stage.count(s) as f64);
    let all: Vec<(f64, f64)> = fit.segments.par_iter().map(of).collect();
    let (cost, count) = all.iter().fold((0.0, 0.0), |sum, s| (sum.0 + s.0, sum.1 + s.1));
    (cost / f64::max(count, 1.0)).sqrt()
}

fn length_of(segments: &[Segment]) -> f64 {
    segments.first().map_or(0.0, |s| s.span.to - s.span.from)
}

/// Share of what another set follows below which a set follows less.
const SHORTER: f64 = 0.97;
/// Root mean square over whole runs from the starts of windows beyond which no start makes them follow.
const HOPELESS: f64 = 3000.0;
/// Root mean square over whole runs beyond which they do not follow the model at all, and windows judge.
const DIVERGED: f64 = 300.0;

/// Parameters in a line.
pub(crate) fn told(h: &Hypothesis, x: &[f64]) -> String {
    h.decode(x).iter().map(|(key, value)| format!("{key} {value:.4e}")).collect::<Vec<_>>().join(", ")
}
