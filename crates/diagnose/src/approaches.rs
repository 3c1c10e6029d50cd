//! Approaches: flights with the beginning of the touch that ends them.
//!
//! What happens in a touch is short and steep, and a window that begins in its midst must guess how deep and how bent everything is: there are
//! many wrong valleys in that. A flight tells where everything is and how it moves, without any contact's memory, as closely as its length
//! allows, if nothing is amiss in flight. So where runs fly from touch to touch as the model does, the continuation goes by the length of the
//! touch that is looked at after a flight, not by the length of windows, until a stretch reaches into the next touch: that needs no approach of
//! its own then.

use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::fit::{Effort, Fit, fit};
use crate::linear::{Segment, Stage};
use crate::plant::Plant;
use crate::reading::Reading;
use crate::replay::{Span, touches_in};
use crate::stretches::guessed;
use crate::tape::Tape;
use rayon::prelude::*;
use std::sync::Arc;

/// A stretch in which nothing touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Flight {
    /// Index of the run.
    pub run: usize,
    /// The stretch; it keeps away from touches by a margin, for the model may be late or early by a little.
    pub span: Span,
    /// When the touch begins that ends it, s; none where the run ends first.
    pub touch: Option<f64>,
}

/// Share of a window that a flight keeps away from touches.
const AHEAD: f64 = 0.02;
/// Growth of the touch that is looked at from one rung to the next.
const LONGER: f64 = 4.0;
/// Share of the longest run up to which approaches grow.
const LONGEST: f64 = 0.5;

/// The flights of at least a window, as the windows' replays tell, run by run and in order; empty where nothing ever or always touches.
pub(crate) fn find_flights(stage: &Stage<'_>, windows: &Fit) -> Vec<Flight> {
    between(stage, windows, &find_touches(stage, windows))
}

/// Where each window's replay touches.
fn find_touches(stage: &Stage<'_>, windows: &Fit) -> Vec<Vec<Span>> {
    let of = |s: &Segment| touches_in(&windows.built, &stage.tapes[s.run], &s.start, s.span, stage.pace);
    windows.segments.par_iter().map(of).collect()
}

/// The same but for what hangs on touches being as the model has them: what a window's replay does after its first touch, and where a sensor that rests
/// untouched reads a force.
pub(crate) fn find_sure_flights(stage: &Stage<'_>, windows: &Fit) -> Vec<Flight> {
    let felt = |s: &Segment| {
        let tape = &stage.tapes[s.run];
        let is_felt = |r: &&Reading| windows.built.sensor(&r.channel).is_some_and(|(gauge, _)| gauge.rests_untouched());
        let times = |r: &Reading| r.loud(FELT).filter(|t| (s.span.from..=s.span.to).contains(t)).collect::<Vec<_>>();
        tape.readings.iter().filter(is_felt).flat_map(times).collect::<Vec<f64>>()
    };
    let closed = |(s, touched): (&Segment, Vec<Span>)| after_first(s.span, &touched, felt(s)).into_iter().collect();
    let touched: Vec<Vec<Span>> = windows.segments.iter().zip(find_touches(stage, windows)).map(closed).collect();
    between(stage, windows, &touched)
}

/// Standard deviations of a force sensor's noise beyond which it feels a touch.
const FELT: f64 = 6.0;

/// The flights of at least a window between touches.
fn between(stage: &Stage<'_>, windows: &Fit, touched: &[Vec<Span>]) -> Vec<Flight> {
    if touched.iter().all(Vec::is_empty) {
        return Vec::new();
    }
    let mut flights = Vec::new();
    let mut runs: Vec<usize> = windows.segments.iter().map(|s| s.run).collect();
    runs.dedup();
    for run in runs {
        let of_run = windows.segments.iter().zip(touched).filter(|(s, _)| s.run == run);
        let least = of_run.clone().map(|(s, _)| s.span.to - s.span.from).fold(f64::INFINITY, f64::min);
        let closed: Vec<Span> = of_run.flat_map(|(_, touched)| touched.iter().copied()).collect();
        flights.extend(of_one_run(run, stage.tapes[run].span, (least, &closed)));
    }
    flights
}

/// What of a window comes after its first touch, seen or felt.
fn after_first(window: Span, touched: &[Span], felt: Vec<f64>) -> Option<Span> {
    let first = touched.iter().map(|t| t.from).chain(felt).reduce(f64::min);
    first.map(|from| Span { from, ..window })
}

/// The flights of a run that are longer than `least` between what is closed.
fn of_one_run(run: usize, (begin, end): (f64, f64), (least, closed): (f64, &[Span])) -> Vec<Flight> {
    let (mut from, mut flights) = (begin, Vec::new());
    for touch in closed.iter().chain(std::iter::once(&Span { from: end, to: end })) {
        if touch.from - from > least {
            let ends = touch.from < end;
            let margin = if ends { AHEAD * least } else { 0.0 };
            let span = Span { from, to: touch.from - margin };
            flights.push(Flight { run, span, touch: ends.then_some(touch.from) });
        }
        from = touch.to + AHEAD * least;
    }
    flights
}

/// The shortest approaches that tell something, and longer ones.
pub(crate) type Begun = (Fit, Vec<Vec<Segment>>);

/// The shortest approaches in which the nominal model leaves something, their starts fitted, and the longer ones; none where something is amiss in
/// flight already (what comes of that in a touch is no way to tell what it is), or nothing in any touch. `length`: the shortest look at a touch,
/// s; `flown`: the flights under the nominal model.
pub(crate) fn begin(
    stage: &Stage<'_>,
    plant: &Plant,
    (flights, length): (&[Flight], f64),
    flown: &Fit,
) -> Result<Option<Begun>, DiagnoseError> {
    if flown.is_significant() {
        return Ok(None);
    }
    let built = &flown.built;
    let begun = |(run, span): (usize, Span)| {
        let flown = flown.segments.iter().find(|s| s.run == run && s.span.from == span.from);
        let flown = flown.map(|s| Segment { span, guess: Arc::new(s.start.clone()), columns: None, ..s.clone() });
        flown.unwrap_or_else(|| guessed(built, stage.tapes, run, span))
    };
    let of_length =
        |length: f64| -> Vec<Segment> { approaches(flights, stage.tapes, length).into_iter().map(begun).collect() };
    let mut rungs: Vec<Vec<Segment>> = lengths(length, stage.tapes).into_iter().map(of_length).collect();
    while !rungs.is_empty() {
        let near = fit(stage, plant, EffectSet::default(), rungs.remove(0), Effort::STARTS)?;
        stage.work.watch.step(&format!("flights and the beginning of the touches after them: error {:.3}", near.rms()));
        if near.is_significant() {
            return Ok(Some((near, rungs)));
        }
    }
    Ok(None)
}

/// Flights with as much of the touches after them; a touch that is reached from an earlier flight needs no approach of its own.
fn approaches(flights: &[Flight], tapes: &[Tape], length: f64) -> Vec<(usize, Span)> {
    let mut found: Vec<(usize, Span)> = Vec::new();
    for flight in flights {
        let Flight { run, span, touch } = *flight;
        let reached = found.last().filter(|f| f.0 == run).map_or(f64::NEG_INFINITY, |f| f.1.to);
        match touch {
            Some(touch) if touch > reached => {
                found.push((run, Span { from: span.from, to: (touch + length).min(tapes[run].span.1) }));
            }
            // Half of a flight at least tells something of its own.
            None if reached < 0.5 * (span.from + span.to) => {
                found.push((run, Span { from: span.from.max(reached), to: span.to }));
            }
            _ => {}
        }
    }
    found
}

/// Lengths of touches to look at, shortest first, s.
fn lengths(first: f64, tapes: &[Tape]) -> Vec<f64> {
    let longest = tapes.iter().map(|t| t.span.1 - t.span.0).fold(0.0, f64::max);
    let all = std::iter::successors(Some(first), |l| Some(LONGER * l));
    all.take_while(|l| *l < LONGEST * longest).collect()
}

/// Whether most of what is looked at lies in a touch long after it began: no approach shows it.
pub(crate) fn is_sustained(window: &Segment, flights: &[Flight], after: f64) -> bool {
    let of_run = flights.iter().filter(|f| f.run == window.run);
    let is_flown = of_run.clone().any(|f| f.span.from < window.span.to && window.span.from < f.span.to);
    let began = of_run.filter_map(|f| f.touch).filter(|t| *t <= window.span.from).fold(f64::NEG_INFINITY, f64::max);
    !is_flown && window.span.from > began + after
}

#[cfg(test)]
mod tests {
    use super::*;
    use record::Role;

    fn flown() -> (Vec<Tape>, Vec<Flight>) {
        let mut tape = Tape::assemble(("run", Role::Fit), Vec::new(), Vec::new());
        tape.span = (0.0, 5.0);
        let flight = |from: f64, to: f64, touch| Flight { run: 0, span: Span { from, to }, touch };
        (vec![tape], vec![flight(0.0, 0.49, Some(0.5)), flight(0.6, 1.39, Some(1.4)), flight(1.6, 5.0, None)])
    }

    #[test]
    fn short_approaches_end_in_their_own_touch_long_ones_take_the_next_with_them() {
        let (tapes, flights) = flown();
        let spans =
            |length| approaches(&flights, &tapes, length).iter().map(|s| (s.1.from, s.1.to)).collect::<Vec<_>>();
        assert_eq!(spans(0.125), [(0.0, 0.625), (0.6, 1.525), (1.6, 5.0)]);
        assert_eq!(spans(0.5), [(0.0, 1.0), (0.6, 1.9), (1.9, 5.0)]);
        assert_eq!(spans(2.0), [(0.0, 2.5), (2.5, 5.0)]);
        assert_eq!(spans(4.0), [(0.0, 4.5)]);
        assert_eq!(lengths(0.125, &tapes), [0.125, 0.5, 2.0]);
    }

    #[test]
    fn a_window_is_trusted_to_its_first_touch_and_flights_are_what_lies_between() {
        let span = |from: f64, to: f64| Span { from, to };
        let window = span(1.0, 2.0);
        assert_eq!(after_first(window, &[span(1.3, 1.31), span(1.7, 1.8)], vec![1.4]), Some(span(1.3, 2.0)));
        assert_eq!(after_first(window, &[], vec![1.25, 1.2]), Some(span(1.2, 2.0)));
        assert_eq!(after_first(window, &[], Vec::new()), None);
        let flights = of_one_run(3, (0.0, 10.0), (0.5, &[span(1.3, 2.0), span(2.2, 3.0)]));
        let told: Vec<(f64, f64, Option<f64>)> = flights.iter().map(|f| (f.span.from, f.span.to, f.touch)).collect();
        assert_eq!(told, [(0.0, 1.29, Some(1.3)), (3.01, 10.0, None)], "0.2 s are too short for one");
        assert!(flights.iter().all(|f| f.run == 3));
    }

    #[test]
    fn what_lasts_is_not_seen_by_approaches() {
        let (tapes, mut flights) = flown();
        flights.pop();
        let guess = std::sync::Arc::default();
        let window = |from: f64| Segment {
            run: 0,
            span: Span { from, to: from + 0.1 },
            start: Default::default(),
            guess: std::sync::Arc::clone(&guess),
            weight: 1.0,
            columns: None,
            steps: Default::default(),
        };
        assert!(!is_sustained(&window(1.45), &flights, 1.0) && !is_sustained(&window(0.8), &flights, 0.0));
        assert!(is_sustained(&window(3.0), &flights, 1.0) && tapes.len() == 1);
    }
}
