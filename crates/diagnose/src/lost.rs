//! Runs that a model follows up to an instant only: something happened on the rig that it does not have (a bump, a part that caught an edge).
//!
//! Where most runs are followed to the end, the others are judged as far as they are followed, and that is said; where most are lost, it is
//! the model that is wrong.
//!
//! And runs that a model could follow and does not: a touch on one side of an edge or on the other makes two runs of starts that no sensor tells
//! apart, and a descent from one of them does not cross the edge. Starts are drawn from all that the part before it leaves possible.

use crate::fit::{Effort, Fit};
use crate::linear::{Segment, Stage, finite};
use crate::plant::Built;
use crate::start::Start;
use nalgebra::DMatrix;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

/// Mean square from which on the start of a run is suspected to stand in a wrong valley.
pub(crate) const POOR_RUN: f64 = 1.15;
/// The same of a window.
pub(crate) const POOR_WINDOW: f64 = 1.5;
/// Root mean square up to which a stretch is near the model.
pub(crate) const NEAR: f64 = 3.0;
/// Share of the windows, and of whole runs, that may be lost where the model is not doubted for it.
pub(crate) const FEW: f64 = 0.25;
pub(crate) const RUNS: f64 = 0.4;
/// Share of a run that must be followed at least.
const FIRST: f64 = 0.25;
/// Parts of a run, one of which is lost where the run is.
const PARTS: usize = 40;
/// Times that a start is fitted to what it follows.
const TURNS: usize = 3;

/// Starts that are drawn for a run, each time that it is followed further.
const DRAWN: usize = 64;

/// Whether a stretch is near the model.
pub(crate) fn is_near(stage: &Stage<'_>, built: &Built, segment: &Segment) -> bool {
    let cost = stage.residuals(built, segment).norm_squared();
    cost <= NEAR * NEAR * segment.weight * stage.count(segment) as f64
}

/// Share of a fit's segments whose initial states may stand in local minima.
pub(crate) fn calc_poor_share(stage: &Stage<'_>, fit: &Fit) -> f64 {
    let is_poor =
        |s: &Segment| stage.residuals(&fit.built, s).norm_squared() > POOR_WINDOW * s.weight * stage.count(s) as f64;
    let poor: Vec<bool> = fit.segments.par_iter().map(is_poor).collect();
    poor.iter().filter(|p| **p).count() as f64 / poor.len().max(1) as f64
}

/// Share of a fit's segments that are not near the model.
pub(crate) fn calc_share(stage: &Stage<'_>, fit: &Fit) -> f64 {
    calc_lost(&find_near(stage, fit))
}

fn find_near(stage: &Stage<'_>, fit: &Fit) -> Vec<bool> {
    fit.segments.par_iter().map(|s| is_near(stage, &fit.built, s)).collect()
}

fn calc_lost(near: &[bool]) -> f64 {
    near.iter().filter(|near| !**near).count() as f64 / near.len().max(1) as f64
}

/// A fit of whole runs with those that are lost cut off where the model loses them; as it was where most are lost.
pub(crate) fn cut_off(stage: &Stage<'_>, whole: Fit) -> Fit {
    let near = find_near(stage, &whole);
    let share = calc_lost(&near);
    if share == 0.0 || share > RUNS {
        return whole;
    }
    let of = |(segment, near): (&Segment, &bool)| match near {
        true => segment.clone(),
        false => followed_part(stage, &whole.built, segment).unwrap_or_else(|| segment.clone()),
    };
    let segments: Vec<Segment> = whole.segments.par_iter().zip(&near).map(of).collect();
    let (count, noise) = stage.noise(&segments);
    Fit { cost: stage.cost(&whole.built, &segments), count, noise, segments, ..whole }
}

/// The first part of a run, as far as a start leads along it; none where that is too little.
fn followed_part(stage: &Stage<'_>, built: &Built, run: &Segment) -> Option<Segment> {
    let mut now = first_part(stage, built, run)?;
    for _ in 0..TURNS {
        let end = followed_until(stage, built, &Segment { span: run.span, ..now.clone() });
        if end <= now.span.to {
            break;
        }
        now.span.to = end;
        now = stage.fit_starts(built, &[now], Effort::STARTS).pop()?.segment;
    }
    (is_near(stage, built, &now)).then_some(Segment { columns: None, ..now })
}

/// The part of a run that must be followed at least, from the best start for it.
fn first_part(stage: &Stage<'_>, built: &Built, run: &Segment) -> Option<Segment> {
    let mut first = Segment { columns: None, ..run.clone() };
    first.span.to = run.span.from + FIRST * (run.span.to - run.span.from);
    stage.begun_anew(built, &[first], (Effort::STARTS, POOR_RUN)).pop()
}

/// Whole runs with those that are lost begun from other starts, where some lead further that are as likely before the loss.
pub(crate) fn scattered(stage: &Stage<'_>, built: &Built, runs: &[Segment]) -> Vec<Segment> {
    let of = |run: &Segment| match is_near(stage, built, run) {
        true => run.clone(),
        false => drawn(stage, built, run).unwrap_or_else(|| run.clone()),
    };
    runs.par_iter().map(of).collect()
}

/// A run followed from part to part: where it is lost, on from the best of many starts that the part before leaves possible. None where none is near.
fn drawn(stage: &Stage<'_>, built: &Built, run: &Segment) -> Option<Segment> {
    let mut dice = ChaCha8Rng::seed_from_u64(run.run as u64);
    let mut now = first_part(stage, built, run)?;
    for _ in 0..TURNS {
        let end = followed_until(stage, built, &Segment { span: run.span, ..now.clone() });
        if end <= run.span.from {
            return None;
        }
        now.span.to = end;
        now = stage.fit_starts(built, &[Segment { columns: None, ..now }], Effort::STARTS).pop()?.segment;
        let starts = starts_beside(built, &now, &mut dice)?;
        let whole = |start| Segment { start, span: run.span, columns: None, ..now.clone() };
        let cost = |start: &Start| finite(stage.residuals(built, &whole(start.clone())).norm_squared());
        let costs: Vec<f64> = starts.par_iter().map(cost).collect();
        let best = (0..costs.len()).min_by(|a, b| costs[*a].total_cmp(&costs[*b]))?;
        now = stage.fit_starts(built, &[whole(starts[best].clone())], Effort::STARTS).pop()?.segment;
        if is_near(stage, built, &now) {
            return Some(Segment { columns: None, ..now });
        }
    }
    None
}

/// A part's start, and others that are as likely by its last linearisation; none where it has none, or nothing that moves.
fn starts_beside(built: &Built, part: &Segment, dice: &mut ChaCha8Rng) -> Option<Vec<Start>> {
    let known = part.columns.as_ref().filter(|known| !known.columns.is_empty())?;
    let spread = DMatrix::from_columns(&known.columns).svd(false, true);
    let axes = spread.v_t?.transpose();
    let largest = spread.singular_values.max();
    // What the part does not show at all stays where it is.
    let sizes = spread.singular_values.map(|s| if s > SHOWN * largest { 1.0 / s } else { 0.0 });
    let mut draw = || {
        let by = sizes.map(|size| size * <StandardNormal as Distribution<f64>>::sample(&StandardNormal, dice));
        part.start.retract_within(built, &known.freedoms, (&axes * by).as_slice())
    };
    let mut starts = vec![part.start.clone()];
    starts.extend((0..DRAWN).map(|_| draw()));
    Some(starts)
}

/// Share of what a part shows best that it has to show of something.
const SHOWN: f64 = 1e-6;

/// End of the last part of a run before the first that is lost, s.
fn followed_until(stage: &Stage<'_>, built: &Built, run: &Segment) -> f64 {
    let r = stage.residuals(built, run);
    let tape = &stage.tapes[run.run];
    let range = tape.range(run.span);
    let part_of = |time: f64| {
        let share = (time - run.span.from) / (run.span.to - run.span.from);
        ((share * PARTS as f64) as usize).min(PARTS - 1)
    };
    let mut parts = [(0.0, 0.0); PARTS];
    for i in range.clone() {
        let (first, next) =
            (tape.offsets[i] - tape.offsets[range.start], tape.offsets[i + 1] - tape.offsets[range.start]);
        let part = &mut parts[part_of(tape.events[i].time)];
        part.0 += r.rows(first, next - first).norm_squared();
        part.1 += (next - first) as f64;
    }
    let lost = parts.iter().position(|(cost, n)| *cost > NEAR * NEAR * n || cost.is_nan());
    run.span.from + lost.unwrap_or(PARTS) as f64 / PARTS as f64 * (run.span.to - run.span.from)
}
