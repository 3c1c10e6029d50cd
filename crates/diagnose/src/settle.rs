//! Starts under a given model: each segment's own least squares, for itself.
//!
//!   (H_ss + λ diag H_ss) δx₀ = −Sᵀ r
//!
//! A segment whose events do not yet follow the model stays behind without holding up the others.

use crate::fit::Effort;
use crate::linear::{Segment, SegmentLinear, Stage, StartColumns, Steps, eliminate, finite};
use crate::plant::Built;
use crate::replay::{Span, starts_along};
use crate::start::{Start, freedoms};
use nalgebra::DVector;
use rayon::prelude::*;
use std::sync::Arc;

/// Rounds in which starts follow a changed model along old columns.
const SETTLINGS: usize = 2;
/// Promised share of the cost below which a start has settled.
const SETTLED: f64 = 1e-3;
/// Most dampings tried for one linearisation.
const DAMPINGS: usize = 6;
/// Smallest damping beside none.
const LEAST_DAMPING: f64 = 1e-5;
/// Share of what old columns promise that a step along them must bring for a further one.
const SERVES: f64 = 0.5;
/// Shares of a segment to which its start is fitted one after the other.
const GROWTH: [f64; 3] = [0.125, 0.25, 0.5];
/// Scalars for each free coordinate that a share has at least.
const ENOUGH: usize = 10;
/// Promised fall of a segment's cost below which its start has converged, variances of noise.
const NEXT_TO_NOTHING: f64 = 0.1;

/// A segment with its start at its best.
#[derive(Clone, Debug)]
pub struct Settled {
    /// The segment, with the columns of its last linearisation.
    pub segment: Segment,
    /// Squared norm of its residual.
    pub cost: f64,
    /// Coordinates of the start that the residual shows.
    pub shown: usize,
    /// Linearisations made.
    pub iterations: usize,
    /// Whether the last step promised next to nothing.
    pub converged: bool,
}

impl Stage<'_> {
    /// Windows of runs that are followed as a whole begin where the whole run is then.
    pub fn along(&self, built: &Built, whole: &[Segment], windows: &mut [Segment]) {
        let of_run = |run: &Segment| {
            let own: Vec<usize> = (0..windows.len()).filter(|i| windows[*i].run == run.run).collect();
            let instants: Vec<f64> = own.iter().map(|i| windows[*i].span.from).collect();
            let starts =
                starts_along(built, &self.tapes[run.run], &run.start, self.pace, &instants).unwrap_or_default();
            own.into_iter().zip(starts).collect::<Vec<_>>()
        };
        let found: Vec<(usize, Start)> = whole.par_iter().flat_map(of_run).collect();
        for (i, start) in found {
            (windows[i].start, windows[i].columns) = (start, None);
        }
    }

    /// Fits every start, so many linearisations at most, until one promises less than a share of the segment's excess.
    pub fn fit_starts(&self, built: &Built, segments: &[Segment], effort: Effort) -> Vec<Settled> {
        // The first segment finds the steps of the difference quotients for all.
        let Some((first, others)) = segments.split_first() else { return Vec::new() };
        let first = self.fit_start(built, first, &Steps::default(), effort);
        let of = |s: &Segment| self.fit_start(built, s, &first.segment.steps, effort);
        let others: Vec<Settled> = others.par_iter().map(of).collect();
        std::iter::once(first).chain(others).collect()
    }

    /// One start; `steps`: those with which its difference quotients begin.
    fn fit_start(&self, built: &Built, segment: &Segment, steps: &Steps, effort: Effort) -> Settled {
        let (mut segment, mut r) = self.nearer(built, segment);
        // Steps that served another model may reach across an event by now.
        segment.steps.clone_from(steps);
        let all = freedoms(built, &segment.start);
        // What is as near as noise lets it be needs no derivatives.
        let noise = r.len() as f64 + (2.0 * r.len() as f64).sqrt();
        let cost = finite(r.norm_squared());
        let converged = effort.share >= Effort::JUDGED.share && cost < noise;
        let mut now = Settled { segment, cost, shown: 0, iterations: 0, converged };
        let mut damping = 0.0;
        // A start that was at its best may be so still: then old derivatives promise nothing.
        let known = now.segment.columns.as_ref().filter(|k| k.freedoms == all && k.is_of(r.len()));
        if effort.share >= Effort::JUDGED.share && effort.iterations > 0 && !now.converged && known.is_some() {
            self.descend(built, &mut now, &mut r, (&mut damping, effort));
        }
        while now.iterations < effort.iterations && !now.converged {
            let (coarse, base) = self.towards(built, &now.segment, &r);
            let sizes = now.segment.steps.of(&all);
            let (columns, used): (Vec<DVector<f64>>, Vec<f64>) =
                coarse.quotients(built, &now.segment, &base, (&all, &sizes)).into_iter().unzip();
            now.segment.steps = Steps::new(&all, &used);
            now.iterations += 1;
            now.shown = columns.iter().filter(|c| c.norm_squared() > 0.0).count();
            now.segment.columns = Some(Arc::new(StartColumns { freedoms: all.clone(), columns, within: Vec::new() }));
            if !self.descend(built, &mut now, &mut r, (&mut damping, effort)) {
                break;
            }
        }
        now
    }

    /// Steps along the columns of the last linearisation, as long as the cost falls as these promise (Shamanskii 1967); whether a new
    /// one may lead further.
    fn descend(
        &self,
        built: &Built,
        now: &mut Settled,
        r: &mut DVector<f64>,
        (damping, effort): (&mut f64, Effort),
    ) -> bool {
        let Some(known) = now.segment.columns.clone() else { return false };
        let columns: Vec<&DVector<f64>> = known.columns.iter().collect();
        for is_fresh in std::iter::once(true).chain(std::iter::repeat(false)) {
            let linear = eliminate(&columns, &[r], &known.freedoms);
            let noise = r.len() as f64;
            let enough = effort.share * (now.cost - noise).max(0.0);
            let enough = NEXT_TO_NOTHING.max(enough).max(effort.floor * (2.0 * noise).sqrt());
            let promised = now.cost - linear.reduced[(0, 0)];
            if promised.is_nan() || promised < enough {
                now.converged = true;
                return false;
            }
            let Some((moved, after, used)) = self.downhill(built, &now.segment, &linear, (now.cost, *damping)) else {
                return !is_fresh;
            };
            let gained = now.cost - finite(after.norm_squared());
            (now.segment, now.cost, *r, *damping) = (moved, now.cost - gained, after, used);
            if gained < SERVES * promised {
                now.converged = is_fresh && gained < enough;
                return true;
            }
        }
        true
    }

    /// Segments whose starts are begun anew from what their samples say, where that leads to a lower valley than they stand in: those whose
    /// mean square is `poor`.
    pub fn begun_anew(&self, built: &Built, segments: &[Segment], (effort, poor): (Effort, f64)) -> Vec<Segment> {
        let of = |segment: &Segment| {
            let now = finite(self.residuals(built, segment).norm_squared());
            if now < poor * segment.weight * self.count(segment) as f64 {
                return segment.clone();
            }
            let from = |start: &Start| self.fit_growing(built, segment, start, effort);
            let known = from(&segment.start);
            let is_poor = known.cost >= poor * segment.weight * self.count(segment) as f64;
            let guessed = is_poor.then(|| from(&segment.guess)).filter(|guessed| guessed.cost < known.cost);
            let other = guessed.unwrap_or(known);
            if other.cost < now { other.segment } else { segment.clone() }
        };
        segments.par_iter().map(of).collect()
    }

    /// A start fitted to the first part of a segment, then to longer and longer ones: what comes early is followed before what comes of it is
    /// looked at.
    fn fit_growing(&self, built: &Built, segment: &Segment, start: &Start, effort: Effort) -> Settled {
        let Span { from, to } = segment.span;
        let mut now = Segment { start: start.fitted_to(built), columns: None, ..segment.clone() };
        let freedoms = freedoms(built, &now.start).len();
        let mut steps = Steps::default();
        for share in GROWTH {
            now.span.to = from + share * (to - from);
            if self.count(&now) > ENOUGH * freedoms {
                let found = self.fit_start(built, &now, &steps, effort).segment;
                (now.start, steps) = (found.start, found.steps);
            }
        }
        now.span.to = to;
        self.fit_start(built, &now, &steps, effort)
    }

    /// The first step that lowers the cost: the full one, then more and more damped ones.
    fn downhill(
        &self,
        built: &Built,
        segment: &Segment,
        linear: &SegmentLinear,
        (cost, damping): (f64, f64),
    ) -> Option<(Segment, DVector<f64>, f64)> {
        let known = &segment.columns.as_ref()?.freedoms;
        let mut damping = if damping > LEAST_DAMPING { 0.1 * damping } else { 0.0 };
        for _ in 0..DAMPINGS {
            let step = if damping > 0.0 { linear.damped(damping).start_step(&[]) } else { linear.start_step(&[]) };
            let moved = Segment { start: segment.start.retract_within(built, known, &step), ..segment.clone() };
            let r = self.residuals(built, &moved);
            if r.norm_squared() < cost {
                return Some((moved, r, damping));
            }
            damping = (20.0 * damping).max(LEAST_DAMPING);
        }
        None
    }

    /// A segment from its last start or from what its samples say, whichever is nearer: a start that was fitted to a wrong model is
    /// wrong with it.
    fn nearer(&self, built: &Built, segment: &Segment) -> (Segment, DVector<f64>) {
        let from = |start: &Start| {
            let moved = Segment { start: start.fitted_to(built), ..segment.clone() };
            let r = self.residuals(built, &moved);
            (moved, r)
        };
        let (old, new) = (from(&segment.start), from(&segment.guess));
        if finite(new.1.norm_squared()) < finite(old.1.norm_squared()) { new } else { old }
    }

    /// Segments whose starts have followed a changed model as far as their old columns tell, and their cost.
    pub fn settle(&self, built: &Built, segments: &[Segment]) -> (Vec<Segment>, f64) {
        let of = |segment: &Segment| {
            let (now, r) = self.nearer(built, segment);
            self.settled(built, (now, r), segment.columns.as_ref())
        };
        let (segments, costs): (Vec<Segment>, Vec<f64>) = segments.par_iter().map(of).unzip();
        (segments, costs.iter().sum())
    }

    /// A segment whose start has gone where old columns lead it, and its cost.
    fn settled(
        &self,
        built: &Built,
        (mut now, mut r): (Segment, DVector<f64>),
        known: Option<&Arc<StartColumns>>,
    ) -> (Segment, f64) {
        let mut cost = finite(r.norm_squared());
        let Some(known) = known else { return (now, cost) };
        let columns: Vec<&DVector<f64>> = known.columns.iter().collect();
        for _ in 0..SETTLINGS {
            let linear = eliminate(&columns, &[&r], &known.freedoms);
            let promised = cost - linear.reduced[(0, 0)];
            if promised.is_nan() || promised < NEXT_TO_NOTHING.max(SETTLED * cost) {
                break;
            }
            now.columns = Some(Arc::clone(known));
            let Some((moved, after, _)) = self.downhill(built, &now, &linear, (cost, 0.0)) else { break };
            (now, cost, r) = (moved, finite(after.norm_squared()), after);
        }
        (now, cost)
    }

    /// Segments after a step of the parameters: each start goes where its linear model says, or stays where that is worse, and settles.
    pub fn follow(
        &self,
        built: &Built,
        segments: &[Segment],
        linear: &[SegmentLinear],
        theta: &[f64],
    ) -> (Vec<Segment>, f64) {
        let of = |(segment, linear): (&Segment, &SegmentLinear)| {
            let step = linear.start_step(theta);
            let mut best: Option<(Segment, DVector<f64>)> = None;
            for share in [1.0, 0.4, 0.0] {
                let by: Vec<f64> = step.iter().map(|d| d * share).collect();
                let start = segment.start.retract_within(built, &linear.freedoms, &by);
                let moved = Segment { start, ..segment.clone() };
                let r = self.residuals(built, &moved);
                let is_fair = finite(r.norm_squared()) <= linear.cost + NEXT_TO_NOTHING;
                if best.as_ref().is_none_or(|b| finite(r.norm_squared()) < finite(b.1.norm_squared())) {
                    best = Some((moved, r));
                }
                if is_fair {
                    break;
                }
            }
            match best {
                Some(best) => self.settled(built, best, linear.columns.as_ref()),
                None => (segment.clone(), f64::INFINITY),
            }
        };
        let (segments, costs): (Vec<Segment>, Vec<f64>) = segments.par_iter().zip(linear.par_iter()).map(of).unzip();
        (segments, costs.iter().sum())
    }
}
