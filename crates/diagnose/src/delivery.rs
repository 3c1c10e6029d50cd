//! Whether drives deliver what is asked of them beyond their limits.
//!
//! The effort limit of a URDF is often another one's: some rigs cut commands there, some do not, and a simulator of another team may know of no limit. With
//! e what a command exceeds the limit by (mean over an interval) and f̂ the force that is missing at the joint beside the nominal model,
//!
//!   α = Σ f̂e / Σ e²
//!
//! is one where all of it is delivered, and nothing where it is cut; what else is missing there is noise to that. Where it drowns in it, or runs are not
//! followed as a whole, windows with such commands are followed by both models.

use crate::along::{self, Course};
use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::facts::Facts;
use crate::fit::Effort;
use crate::identify::fit::{Fitted, Problem};
use crate::identify::track::Track;
use crate::limits::{MARGIN, RAISED, SAMPLES};
use crate::linear::{Segment, Stage};
use crate::noise;
use crate::number::short;
use crate::plant::{Built, Plant};
use crate::replay::Pace;
use crate::stretches::cut;
use crate::tape::{CommandTape, Commanded, Tape};
use crate::work::Work;
use record::Role;
use scenario::Scenario;
use scenario::spec::Effect;
use sim::ActuatorKind;

/// Share of what is asked beyond a limit from which on it is delivered, and its standard errors above nothing.
const HALF: f64 = 0.5;
const SURE: f64 = 3.0;

/// A scenario whose drives deliver what a recording follows beyond their limits, beside some effects, and which these are, in words; none where it follows
/// nothing beyond them.
pub(crate) fn delivered(
    (plant, built): (&Plant, &Built),
    effects: &[Effect],
    (tapes, window): (&[Tape], f64),
    work: &Work<'_>,
) -> Result<Option<Raised>, DiagnoseError> {
    let pace = Pace::even(plant.scenario.integrator.step_s);
    let stage = Stage { tapes, pace, work, doubt: noise::STATED, hears: None };
    raised_where((plant, built, effects), tapes, |asked, raised| {
        // A drive is the same in all runs: where no run that is fitted asks so much, those that are left out say what it delivers.
        let by = |role| {
            let windows = cut(built, tapes, Some(window), |t| t.role == role);
            asked.is_delivered(&stage, [built, raised], &windows)
        };
        by(Role::Fit).or_else(|| by(Role::Holdout)).unwrap_or(false)
    })
}

/// What is found along whole runs, or the scenario with limits raised beside which it is to be sought.
pub(crate) fn sought_along(
    stage: &Stage<'_>,
    plant: &Plant,
    (own, window): (&Facts, f64),
    known: &[EffectSet],
) -> Result<Result<Course, Raised>, DiagnoseError> {
    if let Some(raised) = missing_beyond_limits(stage, plant, own)? {
        return Ok(Err(raised));
    }
    let course = along::seek(stage, plant, (own, known))?;
    // Beside what was found a drive may be seen to deliver what is asked of it.
    let best = &course.found.best;
    let raised = delivered((plant, &best.built), &best.set.effects(), (stage.tapes, window), stage.work)?;
    Ok(raised.map_or(Ok(course), Err))
}

/// The scenario with limits raised by what is missing along whole runs beside the nominal model.
fn missing_beyond_limits(stage: &Stage<'_>, plant: &Plant, own: &Facts) -> Result<Option<Raised>, DiagnoseError> {
    let built = plant.build(&[])?;
    if asked_beyond(&built, stage.tapes).is_empty() {
        return Ok(None);
    }
    let problem = along::problem(stage, plant, own, Role::Fit);
    let nominal = problem.begin()?;
    raised_where((plant, &built, &[]), stage.tapes, |asked, _| asked.is_missing(&problem, &nominal))
}

/// A scenario with limits raised, and which, in words.
pub(crate) type Raised = (Scenario, Vec<String>);

/// A scenario without those limits of which a test says that what is asked beyond them is delivered.
fn raised_where(
    (plant, built, effects): (&Plant, &Built, &[Effect]),
    tapes: &[Tape],
    is_delivered: impl Fn(&Asked, &Built) -> bool,
) -> Result<Option<Raised>, DiagnoseError> {
    let mut found: Option<Raised> = None;
    for asked in asked_beyond(built, tapes) {
        let now = found.as_ref().map_or(&plant.scenario, |(scenario, _)| scenario);
        let Some((scenario, words)) = asked.raised(now, built) else { continue };
        if is_delivered(&asked, &plant.of(scenario.clone()).build(effects)?) {
            let said = found.map_or_else(Vec::new, |(_, said)| said);
            found = Some((scenario, [said, vec![words]].concat()));
        }
    }
    Ok(found)
}

/// Windows with commands beyond a limit that are looked at, and share of their costs (geometric mean) below which there is none.
const LOOKED_AT: usize = 12;
const CLEARLY: f64 = 0.8;

/// An actuator of a scenario that is asked for more than it may deliver, and the most that it is asked for.
struct Asked {
    /// Index in the model.
    actuator: usize,
    limit: f64,
    most: f64,
}

/// The actuators that are asked for more than they may deliver.
fn asked_beyond(built: &Built, tapes: &[Tape]) -> Vec<Asked> {
    let of = |(actuator, a): (usize, &sim::Actuator)| {
        let ActuatorKind::JointEffort { limit, .. } = a.kind else { return None };
        let values =
            tapes.iter().flat_map(|t| &t.commands).filter(|c| c.is_effort_of(actuator)).flat_map(|c| &c.values);
        let mut beyond: Vec<f64> = values.map(|v| v.abs()).filter(|v| is_beyond(*v, limit)).collect();
        beyond.sort_by(|a, b| b.total_cmp(a));
        (beyond.len() > SAMPLES).then(|| Asked { actuator, limit, most: beyond[0] })
    };
    built.model.actuators.iter().enumerate().filter_map(of).collect()
}

impl Asked {
    /// The scenario with the limit so high that nothing is cut, and which it was, in words.
    fn raised(&self, scenario: &Scenario, built: &Built) -> Option<(Scenario, String)> {
        let actuator = &built.model.actuators[self.actuator];
        let ActuatorKind::JointEffort { coordinate, .. } = actuator.kind else { return None };
        let mut scenario = scenario.clone();
        let at = scenario.actuators.iter().position(|s| s.name == actuator.name)?;
        let now = scenario.set_effort_limit(at, (RAISED * self.most, built.model.slides(coordinate)))?;
        let words = format!(
            "{} was asked for up to {} where the scenario lets it deliver {}; the recording follows a drive that delivers that, and the limit is raised: {now}.",
            actuator.name,
            short(self.most),
            short(self.limit)
        );
        Some((scenario, words))
    }

    /// Whether the force that is missing beside a model along whole runs is what is asked beyond the limit.
    fn is_missing(&self, problem: &Problem<'_>, fit: &Fitted) -> bool {
        let ActuatorKind::JointEffort { coordinate, .. } = fit.built.model.actuators[self.actuator].kind else {
            return false;
        };
        let Some(j) = problem.forces.iter().position(|f| f.acts_on(coordinate)) else { return false };
        let of_run = |track: &Track| {
            let beyond = problem.stage.tapes[track.run].commands.iter().find(|c| c.is_effort_of(self.actuator));
            let beyond = beyond.map(|c| {
                let values = c.values.iter().map(|v| v - v.clamp(-self.limit, self.limit)).collect();
                CommandTape { values, ..c.clone() }
            });
            let mean = |from, to| beyond.as_ref().map_or(0.0, |c| c.mean(from, to));
            track.intervals.iter().map(|i| (i.force[j], mean(i.span.from, i.span.to))).collect::<Vec<_>>()
        };
        let all: Vec<(f64, f64)> = fit.tracks.iter().flat_map(of_run).collect();
        delivers(&all)
    }

    /// Whether windows with such commands are followed clearly better by a model that delivers them; none where there are no such windows.
    fn is_delivered(&self, stage: &Stage<'_>, [own, raised]: [&Built; 2], windows: &[Segment]) -> Option<bool> {
        let has_such = |s: &&Segment| {
            let own = stage.tapes[s.run].commands.iter().filter(|c| c.is_effort_of(self.actuator));
            let is_such = |(t, v): (&f64, &f64)| (s.span.from..s.span.to).contains(t) && is_beyond(*v, self.limit);
            own.flat_map(|c| c.times.iter().zip(&c.values)).any(is_such)
        };
        let such: Vec<&Segment> = windows.iter().filter(has_such).collect();
        let every = such.len().div_ceil(LOOKED_AT).max(1);
        let some: Vec<Segment> = such.into_iter().step_by(every).cloned().collect();
        let costs = |built: &Built| -> Vec<f64> {
            stage.fit_starts(built, &some, Effort::JUDGED).iter().map(|s| s.cost).collect()
        };
        let ratios = costs(raised).into_iter().zip(costs(own)).map(|(b, a)| (b / a).ln()).filter(|l| l.is_finite());
        let (sum, count) = ratios.fold((0.0, 0), |(sum, count), l| (sum + l, count + 1));
        (count > 0).then(|| sum / f64::from(count) < CLEARLY.ln())
    }
}

/// Whether a command asks for clearly more than a limit.
fn is_beyond(command: f64, limit: f64) -> bool {
    command.abs() > (1.0 + MARGIN) * limit
}

/// Whether missing forces are what is asked beyond a limit, interval by interval.
fn delivers(all: &[(f64, f64)]) -> bool {
    let square: f64 = all.iter().map(|(_, e)| e * e).sum();
    let share = all.iter().map(|(f, e)| f * e).sum::<f64>() / square;
    let left: f64 = all.iter().map(|(f, e)| (f - share * e).powi(2)).sum::<f64>() / all.len().max(1) as f64;
    share > HALF.max(SURE * (left / square).sqrt())
}

impl CommandTape {
    /// Whether it is what an actuator is asked to deliver.
    fn is_effort_of(&self, actuator: usize) -> bool {
        self.actuator == actuator && self.what == Commanded::Effort
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_force_is_what_is_asked_beyond_a_limit_or_it_is_not() {
        let beyond = |k: usize| if (20..24).contains(&k) { 8.0 } else { 0.0 };
        let noise = |k: usize| 0.3 * (1.7 * k as f64).sin();
        let all = |share: f64, noisy: f64| -> Vec<(f64, f64)> {
            (0..48).map(|k| (share * beyond(k) + noisy * noise(k), beyond(k))).collect()
        };
        assert!(delivers(&all(1.0, 1.0)) && delivers(&all(0.8, 1.0)));
        assert!(!delivers(&all(0.0, 1.0)) && !delivers(&all(0.3, 1.0)));
        assert!(!delivers(&all(1.0, 300.0)), "it drowns in what else is missing");
        assert!(!delivers(&[(1.0, 0.0); 4]), "nothing is asked");
    }
}
