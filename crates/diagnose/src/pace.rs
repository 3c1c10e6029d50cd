//! How finely replays advance: the diagnosis' own error against the noise of the sensors.
//!
//! The step is halved, from the longest stretch that no sample and no command cuts (where parts touch, from the scenario's own step), until a replay and one of half its step differ by less
//! than a small part of the noise (of what the model misses there, where nothing touches) over every window. Steps of free flight are chosen alike, with those in contact held.

use crate::catalogue;
use crate::effect_set::EffectSet;
use crate::facts::Facts;
use crate::fit::Fit;
use crate::hypothesis::{Column, Hypothesis, Tier};
use crate::linear::{Segment, Stage};
use crate::number::short;
use crate::plant::{Built, Plant};
use crate::replay::Pace;
use crate::tape::Tape;
use nalgebra::DVector;
use rayon::prelude::*;
use scenario::spec::Integrator;

/// Difference (rms over a window, units of noise) that a halved step may make.
pub const TOLERANCE: f64 = 0.05;
/// The same by long steps in free flight: a model that is varied may ask for shorter ones, and what it differs by is told in tenths of the noise.
const IN_FLIGHT: f64 = 1e-3;
/// Flights of at least so many steps are told from one long step; others are not, and may be made by the midpoint rule.
const LONG: f64 = 3.0;
/// The same over a whole run.
pub(crate) const WHOLE_TOLERANCE: f64 = 0.1;
/// The same where numbers are fitted to the end, in standard errors: steps that move n scalars by ε each may move a number by ε √n of them.
const BIAS: f64 = 3.0;
const FINAL_TOLERANCE: [f64; 2] = [0.01, WHOLE_TOLERANCE];
/// Share of what a number of a contact does that a halved step may move.
const ALIKE: f64 = 0.1;
/// Share of the difference that a halved step leaves at most where steps of some order converge.
const FADING: f64 = 0.7;
/// Halvings that whole runs may ask for.
const HALVINGS: i32 = 3;
/// Halvings of the scenario's own step that are tried beyond it.
const FINER: u32 = 2;
/// Share of a window up to which steps of free flight are tried.
const FREE: f64 = 0.125;
/// Part of what a model misses that counts like noise: steps need not be finer than that tells.
const OF_THE_MISS: f64 = 0.3;
/// Part of what a corrected model leaves above noise that steps may move: a hundredth of its mean square.
const OF_THE_REST: f64 = 0.1;
/// Error (units of noise) up to which steps that suit a corrected model are looked for.
pub(crate) const NEAR: f64 = 1.5;
/// Windows that are looked at.
const WINDOWS: usize = 24;

/// What the check found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Discretisation {
    /// The steps that were chosen.
    pub pace: Pace,
    /// Largest rms difference from steps of half the length, over any window, or, by what was found, what of it no start and no number follows; units of noise.
    pub worst: f64,
}

impl Discretisation {
    /// Steps, and what halving them moves.
    pub fn words(&self) -> String {
        let (Pace { step, free, .. }, worst) = (self.pace, self.worst);
        format!("steps of {step:.3e} s, {free:.3e} s in free flight: halving moves {worst:.1e}")
    }
}

/// The coarsest steps whose halves tell the same; `own` is the step below which half and quarter are the last that are tried, s. Where parts touch, steps
/// longer than that tell the same of what the `varied` models differ by, too: a step may follow a touch and hide from its derivative how stiff it is.
pub fn choose(
    stage: &Stage<'_>,
    (built, varied): (&Built, &[Built]),
    segments: &[Segment],
    own: f64,
) -> Discretisation {
    let every = segments.len().div_ceil(WINDOWS).max(1);
    let some: Vec<&Segment> = segments.iter().skip(every / 2).step_by(every).collect();
    let mut longest = match touches(built) && varied.is_empty() {
        true => own,
        false => stage.tapes.iter().map(longest_stretch).fold(own, f64::max),
    };
    if touches(built) {
        longest = telling(stage, (built, varied), &some, [longest, own]);
    }
    let finest = own * 0.5f64.powi(FINER as i32);
    let (found, mut worst) = halved(stage, built, &some, Pace::even(longest), (TOLERANCE, finest));
    let step = found.step;
    let longest = some.iter().map(|s| FREE * (s.span.to - s.span.from)).fold(0.0, f64::max);
    // Commands cut longer ones.
    let mut free = longest.min(stage.tapes.iter().map(|t| usual_stretch(&t.ticks)).fold(0.0, f64::max)).max(step);
    let replayed = |pace: Pace| Replayed::new(stage, built, &some, pace);
    let short = replayed(Pace::even(step));
    let moves = |free: f64| replayed(Pace { free, ..Pace::even(step) }).calc_difference(&short);
    // Through touches the least difference in flight tells, however short its steps are.
    let bound = IN_FLIGHT.max(2.0 * if free > step { moves(2.0 * step) } else { 0.0 }).min(TOLERANCE);
    while free > step {
        let moved = moves(free);
        if moved <= bound {
            worst = worst.max(moved);
            break;
        }
        free *= 0.5;
    }
    // Flights that are hardly longer gain nothing.
    let mut pace = Pace { free: if free < LONG * step { step } else { free }, ..Pace::even(step) };
    if built.model.is_smooth() && pace.free == step {
        pace.midpoint = replayed(Pace { midpoint: true, ..pace }).calc_difference(&short) <= IN_FLIGHT;
    }
    Discretisation { pace, worst }
}

/// Steps at which whole runs, which carry errors on for longer than windows do, are as exact: the present ones, in contact and in flight each
/// halved as often as that takes; and what halving them once more would move, units of noise.
pub fn refine(stage: &Stage<'_>, built: &Built, runs: &[Segment], tolerance: f64) -> Discretisation {
    let runs: Vec<&Segment> = runs.iter().collect();
    let mut pace = stage.pace;
    let finest = half_times(pace, HALVINGS);
    let mut before = Discretisation { pace, worst: f64::INFINITY };
    loop {
        let Pace { step, free, .. } = pace;
        // Where flights have no steps of their own, both are one.
        let finer = [
            Pace { step: 0.5 * step, free: if free > step { free } else { 0.5 * step }, ..pace },
            Pace { step: step.min(0.5 * free), free: 0.5 * free, ..pace },
        ];
        let may = [step > finest.step, free > finest.free];
        let now = Replayed::new(stage, built, &runs, pace);
        let moved = finer.map(|finer| now.calc_difference(&Replayed::new(stage, built, &runs, finer)));
        let worst = moved[0].max(moved[1]);
        if worst > tolerance && pace.midpoint {
            pace.midpoint = false;
            continue;
        }
        // Where halving no longer tells less, what it tells is the roughness of touches, which no step ends.
        if worst <= WHOLE_TOLERANCE && before.worst <= WHOLE_TOLERANCE && worst > FADING * before.worst {
            return before;
        }
        before = Discretisation { pace, worst };
        let is_due = |k: usize| may[k] && moved[k] > 0.5 * tolerance;
        if worst <= tolerance || !is_due(0) && !is_due(1) {
            return Discretisation { pace, worst };
        }
        for finer in (0..2).filter(|k| is_due(*k)).map(|k| finer[k]) {
            pace = Pace { step: pace.step.min(finer.step), free: pace.free.min(finer.free), ..pace };
        }
    }
}

/// Steps that suit a corrected model as it stands, said: what it leaves is not theirs, and is more than they move.
pub(crate) fn suited(stage: &Stage<'_>, judged: &Fit) -> Discretisation {
    let left = (judged.rms().powi(2) - 1.0).max(0.0).sqrt();
    let tolerance = tolerance_of(judged.count).max(OF_THE_REST * left);
    let found = refine(stage, &judged.built, &judged.segments, tolerance);
    stage.work.watch.step(&found.words());
    found
}

/// Difference by halved steps, units of noise, that so many scalars bear where numbers are fitted to the end.
pub(crate) fn tolerance_of(count: usize) -> f64 {
    let [least, most] = FINAL_TOLERANCE;
    (BIAS / (count.max(1) as f64).sqrt()).clamp(least, most)
}

/// The longest step, halved from one down to another, that tells by how much some models differ from one as half of it does.
fn telling(
    stage: &Stage<'_>,
    (built, varied): (&Built, &[Built]),
    segments: &[&Segment],
    [mut longest, own]: [f64; 2],
) -> f64 {
    let replayed = |step: f64| {
        let of = |built: &Built| Replayed::new(stage, built, segments, Pace::even(step)).residuals;
        let base = of(built);
        let less = |r: &[DVector<f64>]| r.iter().zip(&base).map(|(r, b)| r - b).collect::<Vec<_>>();
        varied.iter().map(|v| less(&of(v))).collect::<Vec<_>>()
    };
    let share = |(coarse, fine): (&Vec<DVector<f64>>, &Vec<DVector<f64>>)| {
        let differs: f64 = coarse.iter().zip(fine).map(|(a, b)| (a - b).norm_squared()).sum();
        let all: f64 = fine.iter().map(DVector::norm_squared).sum();
        if all > 0.0 { (differs / all).sqrt() } else { 0.0 }
    };
    let mut now = replayed(longest);
    while longest > own {
        let finer = replayed(0.5 * longest);
        let worst = now.iter().zip(&finer).map(share).fold(0.0, f64::max);
        if worst <= ALIKE {
            break;
        }
        (longest, now) = (0.5 * longest, finer);
    }
    longest.max(own)
}

/// Steps halved until halving them once more moves nothing by more than a tolerance, or reaches the finest; and what that moves.
fn halved(
    stage: &Stage<'_>,
    built: &Built,
    segments: &[&Segment],
    mut pace: Pace,
    (tolerance, finest): (f64, f64),
) -> (Pace, f64) {
    let mut now = Replayed::new(stage, built, segments, pace);
    loop {
        let finer = Replayed::new(stage, built, segments, half(pace));
        let worst = now.calc_difference(&finer);
        if worst <= tolerance || 0.5 * pace.step <= finest {
            return (pace, worst);
        }
        (pace, now) = (half(pace), finer);
    }
}

pub(crate) fn half(pace: Pace) -> Pace {
    half_times(pace, 1)
}

fn half_times(pace: Pace, times: i32) -> Pace {
    let share = 0.5f64.powi(times);
    Pace { step: share * pace.step, free: share * pace.free, ..pace }
}

/// Residuals of some segments at a pace.
struct Replayed<'a> {
    stage: &'a Stage<'a>,
    segments: &'a [&'a Segment],
    residuals: Vec<DVector<f64>>,
    /// Part of what is missed that counts like noise.
    of_the_miss: f64,
}

impl<'a> Replayed<'a> {
    fn new(stage: &'a Stage<'a>, built: &Built, segments: &'a [&'a Segment], pace: Pace) -> Self {
        let paced = Stage { pace, ..*stage };
        let residuals = segments.par_iter().map(|s| paced.residuals(built, s)).collect();
        // Where parts touch a coarse step changes what happens, not only how exactly.
        let of_the_miss = if touches(built) { 0.0 } else { OF_THE_MISS };
        Self { stage, segments, residuals, of_the_miss }
    }

    /// Largest difference (rms over a segment, units of noise) from finer steps.
    fn calc_difference(&self, finer: &Self) -> f64 {
        let of = |(segment, (a, b)): (&&Segment, (&DVector<f64>, &DVector<f64>))| {
            let count = self.stage.count(segment).max(1) as f64;
            let missed = (b.norm_squared() / (segment.weight * count)).sqrt();
            let difference = (a - b).norm_squared() / count;
            if difference.is_finite() {
                difference.sqrt() / (self.of_the_miss * missed).max(1.0)
            } else {
                f64::INFINITY
            }
        };
        let pairs = self.residuals.iter().zip(&finer.residuals);
        self.segments.iter().zip(pairs).map(of).fold(0.0, f64::max)
    }
}

/// Models with each nominal number of a contact as its derivatives are taken with; none where nothing touches.
pub(crate) fn varied(plant: &Plant, built: &Built, tapes: &[Tape]) -> Vec<Built> {
    if !touches(built) {
        return Vec::new();
    }
    let all = catalogue::hypotheses(&Facts::new(built, tapes));
    let of = |h: &Hypothesis| {
        let beside = |c: &Column| -> Option<Built> {
            let x: Vec<f64> = c.base.iter().zip(&c.direction).map(|(b, d)| b + c.step * d).collect();
            plant.build(&EffectSet::default().with(h, &h.clamped(&x)).effects()).ok()
        };
        let columns = h.screens.iter().flat_map(|s| &s.columns).filter(|c| !c.secant);
        columns.filter_map(beside).collect::<Vec<_>>()
    };
    all.iter().filter(|h| h.tier == Tier::Nominal && h.place.starts_with("contact:")).flat_map(of).collect()
}

/// Whether any parts of a model may touch.
pub(crate) fn touches(built: &Built) -> bool {
    !built.model.scene.pairs().is_empty()
}

/// The longest stretch between two instants at which a sensor reads or a command changes, s; gaps in the data left out.
fn longest_stretch(tape: &Tape) -> f64 {
    let mut stops: Vec<f64> = tape.events.iter().map(|e| e.time).chain(tape.ticks.iter().copied()).collect();
    stops.sort_by(f64::total_cmp);
    let stretch = usual_stretch(&stops);
    if stretch.is_finite() { stretch } else { 0.0 }
}

/// The longest of nine tenths of the stretches between ascending instants, s; without end where there are none.
fn usual_stretch(stops: &[f64]) -> f64 {
    let mut stretches: Vec<f64> = stops.windows(2).map(|w| w[1] - w[0]).filter(|d| *d > 1e-9).collect();
    stretches.sort_by(f64::total_cmp);
    stretches.get(stretches.len() * 9 / 10).copied().unwrap_or(f64::INFINITY)
}
/// That replays do not go by the scenario's own scheme, where they do not.
pub(crate) fn said_of_scheme(own: Integrator, plant: &Plant) -> Option<String> {
    (own.kind != plant.scenario.integrator.kind).then(|| {
        format!(
            "Replays go by Runge–Kutta with steps of their own, not by the scenario's integrator: what that loses at its step of {} s would be \
             taken for physics.",
            short(own.step_s)
        )
    })
}
