//! The stretches of a recording that a search looks at beside whole runs.
//!
//! Windows are shortened until the nominal model follows them, for a screen is linear; those in which most is amiss and an even selection of
//! the others speak for all. What is slow shows in long stretches only: flights between touches, which no event cuts, or thirds of runs. Where
//! runs fly as the nominal model does and windows had to be shortened, flights with the beginning of the next touch take the windows' place ([`crate::approaches`]).

use crate::approaches::{Flight, begin, find_flights, is_sustained};
use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::excerpts::evenly;
use crate::fit::{Effort, Fit, fit};
use crate::guess::guess;
use crate::linear::{Segment, Stage, Steps, windows};
use crate::plant::{Built, Plant};
use crate::replay::Span;
use crate::tape::Tape;
use rayon::prelude::*;
use record::Role;
use std::sync::Arc;

/// Root mean square in windows beyond which shorter ones are looked at.
pub(crate) const STEEP: f64 = 8.0;
/// Standard deviations of a segment's cost beyond which it is missed.
const MISSED: f64 = 6.0;
/// A shorter window's share of the last.
const SHORTER: f64 = 0.25;
/// Samples of the sparsest reading that a window has at least.
const SAMPLES: f64 = 12.0;
/// Root mean square in windows beyond which longer stretches are not worth a look.
const FAR: f64 = 30.0;
/// Windows of either kind, in all of the length in which predictions are judged.
const SPOKESMEN: std::ops::RangeInclusive<usize> = 4..=12;

/// Windows of some runs, with guessed starts.
pub(crate) fn cut(built: &Built, tapes: &[Tape], window: Option<f64>, wanted: impl Fn(&Tape) -> bool) -> Vec<Segment> {
    let runs = (0..tapes.len()).filter(|r| wanted(&tapes[*r]));
    let spans = runs.flat_map(|run| windows(&tapes[run], window).into_iter().map(move |span| (run, span)));
    let all: Vec<(usize, Span)> = spans.collect();
    all.par_iter().map(|(run, span)| guessed(built, tapes, *run, *span)).collect()
}

pub(crate) fn guessed(built: &Built, tapes: &[Tape], run: usize, span: Span) -> Segment {
    let start = guess(built, &tapes[run], span.from);
    Segment { run, span, guess: Arc::new(start.clone()), start, weight: 1.0, columns: None, steps: Steps::default() }
}

/// Whole runs, from the starts of their first windows.
pub(crate) fn joined(windows: &[Segment], tapes: &[Tape]) -> Vec<Segment> {
    let first = windows.iter().filter(|s| s.span.from == tapes[s.run].span.0);
    first
        .map(|s| Segment { span: Span { from: s.span.from, to: tapes[s.run].span.1 }, columns: None, ..s.clone() })
        .collect()
}

/// What a search looks at.
pub(crate) struct Stretches {
    /// The shortest windows, and long stretches where these are near enough, fitted by the nominal model.
    pub windows: Fit,
    /// Where windows had to be shortened, those of the lengths between them and whole runs, shortest first.
    pub rungs: Vec<Vec<Segment>>,
    /// Whole runs, from the best starts that are known.
    pub whole: Vec<Segment>,
}

/// Chooses from the nominal model's windows of the length in which predictions are judged.
pub(crate) fn choose(stage: &Stage<'_>, plant: &Plant, nominal: &Fit, window: f64) -> Result<Stretches, DiagnoseError> {
    let mut some = nominal.clone();
    let (mut length, mut many) = (window, 1.0);
    let mut rungs = Vec::new();
    while calc_miss(stage, &some) > STEEP && SHORTER * length > shortest(stage.tapes) {
        rungs.insert(0, representative(stage, &some, many).segments);
        (length, many) = (length * SHORTER, many / SHORTER);
        let segments = cut(&nominal.built, stage.tapes, Some(length), |t| t.role == Role::Fit);
        let shorter = fit(stage, plant, EffectSet::default(), segments, Effort::STARTS)?;
        stage.work.watch.step(&format!("windows of {length:.3} s: error {:.3}", shorter.rms()));
        // What no window follows any better is not lost with time: the longer one shows it.
        if rungs.len() == 1 && shorter.rms() > some.rms() {
            rungs.clear();
            many = 1.0;
            break;
        }
        some = shorter;
    }
    some = representative(stage, &some, many);
    let mut first = joined(&nominal.segments, stage.tapes);
    let flights = find_flights(stage, nominal);
    if flights.is_empty() && !(rungs.is_empty() && nominal.rms() < FAR) {
        return Ok(Stretches { windows: some, rungs, whole: first });
    }
    let long = long(stage, plant, nominal, &flights)?;
    let begins = |s: &&Segment| s.span.from == stage.tapes[s.run].span.0;
    for begun in joined(&long.segments.iter().filter(begins).cloned().collect::<Vec<_>>(), stage.tapes) {
        first.iter_mut().filter(|s| s.run == begun.run).for_each(|s| s.clone_from(&begun));
    }
    if flights.is_empty() {
        return Ok(Stretches { windows: together(some, long), rungs, whole: first });
    }
    let begun = if rungs.is_empty() { None } else { begin(stage, plant, (&flights, length), &long)? };
    if let Some((near, rungs)) = begun {
        let lasting = |s: &&Segment| is_sustained(s, &flights, 2.0 * window);
        let lasting: Vec<Segment> = some.segments.iter().filter(lasting).cloned().collect();
        let windows = if lasting.is_empty() { near } else { together(near, of_segments(stage, &some, lasting)) };
        return Ok(Stretches { windows, rungs, whole: first });
    }
    // What is slow keeps its weight as windows grow.
    rungs.iter_mut().for_each(|rung| rung.extend(long.segments.iter().cloned()));
    // What lies within flights is seen in these.
    let within =
        |s: &Segment| flights.iter().any(|f| f.run == s.run && f.span.from <= s.span.from && s.span.to <= f.span.to);
    let touching: Vec<Segment> = some.segments.iter().filter(|s| !within(s)).cloned().collect();
    let some = if touching.is_empty() { some } else { of_segments(stage, &some, touching) };
    Ok(Stretches { windows: together(some, long), rungs, whole: first })
}

/// Root mean square over the segments that are missed: a few among many that are followed count like many.
fn calc_miss(stage: &Stage<'_>, fit: &Fit) -> f64 {
    let of = |s: &Segment| {
        let (cost, n) = (stage.residuals(&fit.built, s).norm_squared(), stage.count(s));
        if is_missed(cost, n) { (cost, n as f64) } else { (0.0, 0.0) }
    };
    let all: Vec<(f64, f64)> = fit.segments.par_iter().map(of).collect();
    let (cost, n) = all.iter().fold((0.0, 0.0), |sum, s| (sum.0 + s.0, sum.1 + s.1));
    (cost / f64::max(n, 1.0)).sqrt()
}

/// Whether a stretch of `n` scalars costs more than noise leaves.
pub(crate) fn is_missed(cost: f64, n: usize) -> bool {
    cost > n as f64 + MISSED * (2.0 * n as f64).sqrt()
}

/// The shortest window that the sparsest reading fills.
fn shortest(tapes: &[Tape]) -> f64 {
    let sampled = tapes.iter().flat_map(|t| {
        let duration = t.span.1 - t.span.0;
        t.readings.iter().map(move |r| duration / r.times.len().max(1) as f64)
    });
    SAMPLES * sampled.fold(0.0, f64::max)
}

/// Windows that speak for all in a search: those in which most is amiss, and an even selection.
fn representative(stage: &Stage<'_>, fit: &Fit, many: f64) -> Fit {
    let most = (fit.segments.len() / 6).clamp(*SPOKESMEN.start(), (many.sqrt() * *SPOKESMEN.end() as f64) as usize);
    if fit.segments.len() <= 2 * most {
        return fit.clone();
    }
    of_spokesmen(stage, fit, (most, most))
}

/// A fit of so many of its worst segments, and of an even selection.
fn of_spokesmen(stage: &Stage<'_>, fit: &Fit, (worst, even): (usize, usize)) -> Fit {
    let excess = |s: &Segment| {
        let r = stage.residuals(&fit.built, s);
        r.norm_squared() - r.len() as f64
    };
    let excesses: Vec<f64> = fit.segments.par_iter().map(excess).collect();
    let chosen = spokesmen(&excesses, (worst, even));
    of_segments(stage, fit, chosen.iter().map(|i| fit.segments[*i].clone()).collect())
}

/// Indices of the worst of some segments, and of an even selection of all, in order.
pub(crate) fn spokesmen(excesses: &[f64], (worst, even): (usize, usize)) -> Vec<usize> {
    let count = excesses.len();
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|a, b| excesses[*b].total_cmp(&excesses[*a]));
    order.truncate(worst);
    order.extend(evenly(count, even));
    order.sort_unstable();
    order.dedup();
    order
}

/// A fit of some of its segments.
fn of_segments(stage: &Stage<'_>, fit: &Fit, segments: Vec<Segment>) -> Fit {
    let (cost, (count, noise)) = (stage.cost(&fit.built, &segments), stage.noise(&segments));
    let freedom = fit.freedom * segments.len() / fit.segments.len();
    Fit { segments, cost, count, noise, freedom, ..fit.clone() }
}

/// Flights between touches where there are some, else thirds of the runs, also where an event later in the run hides what is slow.
fn long(stage: &Stage<'_>, plant: &Plant, nominal: &Fit, flights: &[Flight]) -> Result<Fit, DiagnoseError> {
    if flights.is_empty() {
        let third = stage.tapes.iter().map(|t| (t.span.1 - t.span.0) / 3.0).fold(0.0, f64::max);
        let thirds = cut(&nominal.built, stage.tapes, Some(third), |t| t.role == Role::Fit);
        let thirds = fit(stage, plant, EffectSet::default(), thirds, Effort::STARTS)?;
        return Ok(of_spokesmen(stage, &thirds, THIRDS));
    }
    let flights = flights.iter().map(|f| guessed(&nominal.built, stage.tapes, f.run, f.span)).collect();
    fit(stage, plant, EffectSet::default(), flights, Effort::STARTS)
}

/// Thirds of runs that speak for all: the worst, and an even selection.
const THIRDS: (usize, usize) = (2, 3);

fn together(a: Fit, b: Fit) -> Fit {
    Fit {
        segments: [a.segments, b.segments].concat(),
        cost: a.cost + b.cost,
        count: a.count + b.count,
        noise: a.noise + b.noise,
        freedom: a.freedom + b.freedom,
        ..a
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_and_an_even_selection_speak_for_all() {
        let mut excesses = vec![0.0; 20];
        (excesses[7], excesses[8]) = (5.0, 9.0);
        assert_eq!(spokesmen(&excesses, (2, 4)), [2, 7, 8, 12, 17]);
        assert_eq!(spokesmen(&excesses[..3], (1, 12)), [0, 1, 2]);
        assert!(spokesmen(&[], (2, 4)).is_empty());
    }

    #[test]
    fn what_noise_leaves_is_not_missed() {
        // 6 standard deviations, each √(2 n).
        assert!(!is_missed(100.0 + 80.0, 100) && is_missed(100.0 + 90.0, 100));
    }
}
