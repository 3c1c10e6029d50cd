//! What acts in flight, found in flight.
//!
//! Where parts touch now and then, a touch makes much of whatever went before it, and a search that has to follow it finds wrong valleys there. Between touches a
//! rig is one whose parts do not touch: its flights are runs of their own, along which the search goes as along whole runs. What is missing there is found
//! there, and what touches do is looked for beside it.

use crate::along;
use crate::approaches::{Flight, find_sure_flights};
use crate::attempt::Attempt;
use crate::diagnosis::Rival;
use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::facts::Facts;
use crate::fit::Fit;
use crate::held::holds;
use crate::identify::fit::{Fitted, Problem};
use crate::identify::track::{Interval, Track};
use crate::linear::Stage;
use crate::pace;
use crate::plant::{Built, Plant};
use crate::replay::{Pace, SAME, Span};
use crate::select::search::remainder;
use crate::standing::Standing;
use crate::start::Start;
use crate::stretches::cut;
use crate::tape::Tape;
use record::Role;
use scenario::spec::ContactRule;

/// What flights say.
pub(crate) struct Flown {
    /// Effects with their numbers.
    pub set: EffectSet,
    /// What was tried.
    pub attempts: Vec<Attempt>,
    /// What stands for them as well there, by the title of the effect.
    pub rivals: Vec<(String, Rival)>,
    /// States at the begins of segments that lie in flights, by run and time, s.
    pub starts: Vec<(usize, f64, Start)>,
}

/// Samples of the sparsest reading that a flight has, and its length as a share of the longest flight's.
const SAMPLES: usize = 48;
const SHARE: f64 = 0.25;
/// Share of what the nominal model leaves in flight that what is found there may leave.
const LEFT: f64 = 0.01;

/// What acts in flight, where the nominal model misses anything at all.
pub(crate) fn found(
    stage: &Stage<'_>,
    plant: &Plant,
    standing: &Standing,
    (nominal, own, window): (&Fit, &Facts, f64),
) -> Option<Flown> {
    if !nominal.is_significant() && !standing.whole.is_significant() {
        return None;
    }
    let flights = find_sure_flights(stage, nominal);
    let fits = [&standing.windows, &standing.whole, nominal];
    let begins: Vec<(usize, f64)> = fits.iter().flat_map(|fit| &fit.segments).map(|s| (s.run, s.span.from)).collect();
    found_in(stage, plant, (&flights, own, window), &begins).unwrap_or_else(|error| {
        stage.work.watch.step(&format!("flights tell nothing: {error}"));
        None
    })
}

/// What acts in the flights of runs that may be fitted; none where nothing is missing in them, or too little of them is left to say so. `own`: the parts of the
/// model as it touches.
fn found_in(
    stage: &Stage<'_>,
    plant: &Plant,
    (flights, own, window): (&[Flight], &Facts, f64),
    begins: &[(usize, f64)],
) -> Result<Option<Flown>, DiagnoseError> {
    let Some(free) = without_touches(plant) else { return Ok(None) };
    let Ok(built) = free.build(&[]) else { return Ok(None) };
    if holds(&built) {
        return Ok(None);
    }
    let Some((tapes, pace)) = flown(stage, (&free, &built), (flights, own, window))? else { return Ok(None) };
    let flying = Stage { tapes: &tapes, pace, ..*stage };
    let course = along::seek(&flying, &free, (own, &[]))?;
    let course = along::told_by_all_runs(&flying, &free, own, course)?;
    let [before, after] = course.left;
    let best = &course.found.best.set;
    let is_told = after.is_noise() || after.rise < LEFT * before.rise;
    if before.is_noise() || !best.has_findings() || !is_told {
        return Ok(None);
    }
    let mut attempts = along::attempts(&course);
    attempts.retain(|a| a.fall.is_some());
    // What it gained is told by likelihoods of flights, which a search beside touches does not hold against its own.
    attempts.iter_mut().filter(|a| !a.kept).for_each(|a| a.gain = None);
    let set = best.without_tolerated();
    let problem = along::problem(&flying, &free, own, Role::Fit);
    let frame = problem.frame(&course.found.best);
    let start = |(run, time): &(usize, f64)| {
        let holds = |i: &Interval| i.span.from <= *time + SAME && *time < i.span.to;
        let is_in = |t: &&Track| tapes[t.run].index == *run && t.intervals.iter().any(holds);
        let track = course.found.best.tracks.iter().find(is_in)?;
        Some((*run, *time, frame.state_at(track, *time)?))
    };
    let starts = begins.iter().filter_map(start).collect();
    Ok(Some(Flown { set, attempts, rivals: along::rivals(&course), starts }))
}

/// Flights as runs, and the steps that suit them; none where too little is left or nothing is missing in them.
fn flown(
    stage: &Stage<'_>,
    (free, built): (&Plant, &Built),
    (flights, own, window): (&[Flight], &Facts, f64),
) -> Result<Option<(Vec<Tape>, Pace)>, DiagnoseError> {
    let tapes = tapes_of(stage, built, flights);
    if tapes.is_empty() {
        return Ok(None);
    }
    let segments = cut(built, &tapes, Some(window), |_| true);
    let mut flying = Stage { tapes: &tapes, ..*stage };
    let pace = pace::choose(&flying, (built, &[]), &segments, free.scenario.integrator.step_s).pace;
    flying.pace = pace;
    let problem = along::problem(&flying, free, own, Role::Fit);
    let nominal = problem.begin()?;
    let parts = unbroken(&problem, &nominal);
    if parts.is_none() && remainder(&problem, &nominal)?.is_noise() {
        stage.work.watch.step("nothing is missing in flight");
        return Ok(None);
    }
    let tapes = parts.map(|parts| tapes_of(stage, built, &parts)).unwrap_or(tapes);
    stage.work.watch.step(&format!("{} flights", tapes.len()));
    Ok((!tapes.is_empty()).then_some((tapes, pace)))
}

/// Flights without the intervals that no force follows: a touch that the nominal model does not know of, at another place or time, is a jump of rates. None
/// where all are followed.
fn unbroken(problem: &Problem<'_>, nominal: &Fitted) -> Option<Vec<Flight>> {
    let is_followed = |track: usize, k: usize| nominal.spread.local_of(track, k).is_none_or(|l| l.noise.amax() < JUMPS);
    let mut parts = Vec::new();
    let mut is_whole = true;
    for (number, track) in nominal.tracks.iter().enumerate() {
        let tape = &problem.stage.tapes[track.run];
        let all: Vec<usize> = (0..track.intervals.len()).collect();
        for part in all.chunk_by(|a, b| is_followed(number, *a) == is_followed(number, *b)) {
            let [first, last] = [part[0], part[part.len() - 1]];
            if !is_followed(number, first) {
                is_whole = false;
                continue;
            }
            let is_last = last + 1 == all.len();
            // Next to a jump an interval is left out as well.
            let to = if is_last { tape.span.1 } else { track.intervals[last].span.from };
            let span = Span { from: track.intervals[first].span.from, to };
            parts.push(Flight { run: tape.index, span, touch: None });
        }
    }
    (!is_whole).then_some(parts)
}

/// Factor of the noise of an interval from which on no force follows it.
const JUMPS: f64 = 5.0;

/// The scenario with nothing that touches; none where parts are held to each other by other things as well.
fn without_touches(plant: &Plant) -> Option<Plant> {
    let mut scenario = plant.scenario.clone();
    scenario.contacts.push(ContactRule::apart());
    scenario.mechanisms.is_empty().then(|| plant.of(scenario))
}

/// Flights as runs, with the readings that tell something there.
fn tapes_of(stage: &Stage<'_>, built: &Built, flights: &[Flight]) -> Vec<Tape> {
    let may_tell = |channel: &str| built.sensor(channel).is_some_and(|(gauge, _)| !gauge.reads_contact());
    let of = |flight: &Flight| {
        let tape = &stage.tapes[flight.run];
        (tape.role == Role::Fit).then(|| tape.within(flight.span, may_tell))
    };
    let mut tapes: Vec<Tape> = flights.iter().filter_map(of).collect();
    let length = |t: &Tape| t.span.1 - t.span.0;
    let longest = tapes.iter().map(length).fold(0.0, f64::max);
    let sparsest = |t: &Tape| t.readings.iter().map(|r| r.times.len()).min().unwrap_or(0);
    tapes.retain(|t| sparsest(t) >= SAMPLES && length(t) >= SHARE * longest);
    tapes
}
