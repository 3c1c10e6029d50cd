//! A search in windows and over whole runs, for rigs whose parts touch: what acts in flight first, what touches do beside it.

use crate::attempt::Attempt;
use crate::catalogue::{self, hypotheses};
use crate::clock::Clock;
use crate::diagnosis::Rival;
use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::facts::Facts;
use crate::fit::{Effort, Fit, fit};
use crate::flown::{self, Flown};
use crate::hypothesis::Hypothesis;
use crate::linear::{Segment, Stage};
use crate::locate::{Located, Place, locate, places};
use crate::lost;
use crate::plant::Plant;
use crate::replay::Span;
use crate::search::{Candidates, Limits, WHOLE, errors, search};
use crate::select::lines::say;
use crate::standing::{Standing, follow};
use crate::stretches::{self, Stretches};
use crate::tape::Tape;
use crate::waves::waves;

/// Limits of the search.
const LIMITS: Limits = Limits { effects: 6, refits: 6, ends: 2 };

/// What a search has found, and beside what.
pub(crate) struct Sought {
    /// The nominal model in windows, and over whole runs.
    pub nominal: Fit,
    /// Over whole runs.
    pub whole: Fit,
    /// The same in windows and over whole runs, its numbers free within their tolerances.
    pub tolerated: [Fit; 2],
    /// Where forces are missing beside it.
    pub located: Located,
    /// What was found.
    pub standing: Standing,
    /// What was tried.
    pub attempts: Vec<Attempt>,
    /// What stands for effects in flight as well.
    pub rivals: Vec<(String, Rival)>,
}

/// Says where forces are missing and searches for what they are; the stage is left at the pace that this took.
pub(crate) fn seek(
    stage: &mut Stage<'_>,
    plant: &Plant,
    (nominal, tapes, window): (Fit, &[Tape], f64),
    clock: &mut Clock<'_>,
) -> Result<Sought, DiagnoseError> {
    let nominal = doubted(stage, plant, nominal)?;
    clock.stage("locate the missing force", 0.15);
    let own_parts = Facts::new(&nominal.built, tapes);
    let located = locate(stage, plant, &nominal, places(&own_parts, window))?;
    clock.stage("search", 0.25);
    let (standing, whole) = stood(stage, plant, (&nominal, window))?;
    let tolerated = [&standing.windows, &standing.whole].map(Fit::clone);
    let candidates = |stage: &Stage<'_>, now: &Fit| {
        let own = Facts::new(&now.built, tapes).of_parts(&own_parts);
        let window = median_length(&now.segments);
        let pushed = places(&own, window).into_iter().filter(Place::is_told_in_waves).collect();
        let here = locate(stage, plant, now, pushed)?;
        let spans: Vec<(usize, Span)> = now.segments.iter().map(|s| (s.run, s.span)).collect();
        let facts = Facts { lines: waves(&here, &spans, window), ..own };
        say(stage.work.watch, "waves", &facts.lines, " Hz");
        let all = hypotheses(&facts);
        // Numbers that may be off by a tolerance take a force on as far as they can.
        let is_unique = plant.scenario.tolerance.is_exact();
        Ok(if is_unique { promising(&here, all) } else { all })
    };
    let (rivals, (standing, attempts)) = match flown::found(stage, plant, &standing, (&nominal, &own_parts, window)) {
        Some(flown) => (flown.rivals.clone(), beside_flights(stage, plant, (&nominal, window, flown), &candidates)?),
        None => (Vec::new(), search(stage, plant, (standing, Vec::new()), &candidates, &LIMITS)?),
    };
    Ok(Sought { nominal, whole, tolerated, located, standing, attempts, rivals })
}

/// A model as it stands in windows and over whole runs, with its numbers free within their tolerances; and its whole runs without that.
fn stood(stage: &Stage<'_>, plant: &Plant, (nominal, window): (&Fit, f64)) -> Result<(Standing, Fit), DiagnoseError> {
    let Stretches { windows, rungs, whole } = stretches::choose(stage, plant, nominal, window)?;
    let mut whole = follow(stage, plant, EffectSet::default(), &whole)?;
    // Windows that are followed are no reason to doubt the model for runs that are not.
    if lost::calc_share(stage, &whole) > 0.0 && lost::calc_poor_share(stage, nominal) == 0.0 {
        let runs = lost::scattered(stage, &whole.built, &whole.segments);
        whole = fit(stage, plant, EffectSet::default(), runs, Effort::STARTS)?;
    }
    let [short, long] = [nominal.rms(), whole.rms()];
    stage.work.watch.step(&format!("the nominal model: error {short:.3} in windows, {long:.3} over whole runs"));
    let standing = loosened(stage, plant, Standing::new(stage, windows, whole.clone(), rungs))?;
    Ok((standing, whole))
}

/// What is found where effects that act in flight belong to the nominal model, and all of it fitted together.
fn beside_flights(
    stage: &mut Stage<'_>,
    plant: &Plant,
    (nominal, window, flown): (&Fit, f64, Flown),
    candidates: &Candidates<'_>,
) -> Result<(Standing, Vec<Attempt>), DiagnoseError> {
    let Flown { set, attempts, starts, .. } = flown;
    let with = plant.of(plant.with(&set.effects()));
    let begun = |segments: &[Segment]| -> Vec<Segment> {
        let of = |segment: &Segment| {
            let known = starts.iter().find(|s| (s.0, s.1) == (segment.run, segment.span.from));
            let start = known.map_or_else(|| segment.start.clone(), |s| s.2.clone());
            Segment { start, columns: None, ..segment.clone() }
        };
        segments.iter().map(of).collect()
    };
    let flying = fit(stage, &with, EffectSet::default(), begun(&nominal.segments), Effort::STARTS)?;
    let said = [nominal, &flying].map(|fit| format!("{:.3}", fit.rms())).join(" → ");
    stage.work.watch.step(&format!("windows with what was found in flight: error {said}"));
    let (mut standing, _) = stood(stage, &with, (&flying, window))?;
    // A flight as a whole may tell its begin better than the window that begins there.
    let by_flights = follow(stage, &with, EffectSet::default(), &begun(&standing.whole.segments))?;
    if by_flights.rms() < standing.whole.rms() {
        standing.whole = by_flights;
    }
    let others = |stage: &Stage<'_>, now: &Fit| {
        let mut all = candidates(stage, now)?;
        all.retain(|h| !set.has_finding(h));
        Ok(all)
    };
    // Where whole runs are near, what they miss may be what the numbers are off by that flights alone have told.
    let (standing, attempts) = match standing.whole.rms() < lost::NEAR {
        true => (standing, attempts),
        false => search(stage, &with, (standing, attempts), &others, &LIMITS)?,
    };
    let joint = together(stage, plant, (&standing, &set))?;
    search(stage, plant, (joint, attempts), candidates, &LIMITS)
}

/// What stands beside effects in flight, fitted together with them.
fn together(
    stage: &Stage<'_>,
    plant: &Plant,
    (standing, flown): (&Standing, &EffectSet),
) -> Result<Standing, DiagnoseError> {
    let beside = &standing.judge().set;
    let all = beside.members.iter().fold(flown.clone(), |all, (h, x)| all.with(h, x));
    let known = standing.of_plant(plant, &all)?;
    let joint = known.refit(stage, plant, all, WHOLE)?;
    stage.work.watch.step(&format!("together with what was found in flight: {}", errors(&joint)));
    Ok(if joint.is_better(&known) { joint } else { known })
}

/// The same with the initial states of windows that stand out begun anew: where most are followed it is not the model that loses them.
fn doubted(stage: &Stage<'_>, plant: &Plant, nominal: Fit) -> Result<Fit, DiagnoseError> {
    let share = lost::calc_poor_share(stage, &nominal);
    if share == 0.0 || share > lost::FEW {
        return Ok(nominal);
    }
    let segments = stage.begun_anew(&nominal.built, &nominal.segments, (Effort::STARTS, lost::POOR_WINDOW));
    fit(stage, plant, EffectSet::default(), segments, Effort::STARTS)
}

/// The same with the nominal numbers free within the tolerances that the scenario gives them.
fn loosened(stage: &Stage<'_>, plant: &Plant, nominal: Standing) -> Result<Standing, DiagnoseError> {
    let within = catalogue::within(&Facts::new(&nominal.windows.built, stage.tapes), &plant.scenario.tolerance);
    if within.members.is_empty() || !nominal.judge().is_significant() {
        return Ok(nominal);
    }
    let numbers = within.slots().len();
    let loose = nominal.refit(stage, plant, within, WHOLE)?;
    stage.work.watch.step(&format!("{numbers} numbers free within their tolerances: {}", errors(&loose)));
    Ok(loose)
}

/// Median length of some windows, s.
fn median_length(segments: &[Segment]) -> f64 {
    let mut lengths: Vec<f64> = segments.iter().map(|s| s.span.to - s.span.from).collect();
    lengths.sort_by(f64::total_cmp);
    lengths.get(lengths.len() / 2).copied().unwrap_or(1.0)
}

/// Effects at joints where no force is missing are not looked at: an arm has many places.
fn promising(located: &Located, mut all: Vec<Hypothesis>) -> Vec<Hypothesis> {
    let joints = (0..located.places.len()).filter(|p| located.places[*p].name.starts_with("joint:"));
    let best = joints.map(|p| located.share(p)).fold(0.0, f64::max);
    let is_dull = |place: &str| {
        let at = located.places.iter().position(|p| p.name == place);
        place.starts_with("joint:") && at.is_some_and(|p| located.share(p) < DULL * best)
    };
    all.retain(|h| !is_dull(&h.place));
    all
}

/// Share of the best place's below which a joint is dull.
const DULL: f64 = 0.15;
