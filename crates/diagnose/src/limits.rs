//! What a recording says of a scenario's limits before anything is fitted: joints that were pushed on beyond the speed at which their
//! drives stop pushing, and efforts that were measured rather than commanded.
//!
//! The velocity limit of a URDF is often a planner's. Where a recorded joint is faster while its command pushes it on, the rig has no
//! such limit: it is raised, and that is said; a model that stops pushing there would be off by more than any effect.
//!
//! Commands beyond what a drive may deliver are another matter: some rigs cut them, some do not. Windows in which there are such commands tell: they are
//! followed by both models, and the limit is raised where that follows them clearly better.

use crate::fit::Effort;
use crate::linear::{Segment, Stage};
use crate::number::short;
use crate::plant::{Built, Plant};
use crate::reading::{Reading, Value};
use crate::tape::{CommandTape, Commanded, Tape};
use record::{RecordingSet, Series};
use scenario::Scenario;
use scenario::measure::Quantity;
use sim::ActuatorKind;
use std::collections::BTreeSet;

/// Samples beyond a limit that are no outliers: so many, or this share of all.
const SAMPLES: usize = 5;
const SHARE: f64 = 1e-3;
/// Standard deviations of a sample, and share of the limit, by which it is passed beyond doubt.
const DEVIATIONS: f64 = 4.0;
const MARGIN: f64 = 0.01;
/// Samples between two positions that tell a speed.
const APART: usize = 8;
/// The limit that is put in its place, in largest speeds seen: far enough that nothing a corrected model does comes near.
const RAISED: f64 = 2.0;

/// The scenario without the speed limits that its recording passes, and which these are, in words; none where it passes none.
pub(crate) fn raised(plant: &Plant, built: &Built, tapes: &[Tape]) -> Option<(Scenario, String)> {
    let mut scenario = plant.scenario.clone();
    let mut passed = Vec::new();
    for (a, actuator) in built.model.actuators.iter().enumerate() {
        let ActuatorKind::JointEffort { coordinate, .. } = actuator.kind else { continue };
        let limit = built.model.coordinates[coordinate].speed_limit;
        let Some(speed) = speed_beyond(tapes, (a, coordinate), limit) else { continue };
        let Some(i) = scenario.actuators.iter().position(|s| s.name == actuator.name) else { continue };
        let now = scenario.set_speed_limit(i, (RAISED * speed, built.model.slides(coordinate)));
        passed.extend(now.map(|now| format!("{} ({} beyond {}; {now})", actuator.name, short(speed), short(limit))));
    }
    let words = || {
        format!(
            "Joints were pushed on beyond the speeds at which the scenario's drives stop pushing, so that the rig has no such limits; they are \
             raised: {}.",
            passed.join(", ")
        )
    };
    (!passed.is_empty()).then(|| (scenario, words()))
}

/// Windows with commands beyond a limit that are looked at, and share of their costs (geometric mean) below which there is none.
const LOOKED_AT: usize = 12;
const CLEARLY: f64 = 0.8;

/// An actuator of the scenario that is asked for more than it may deliver, and the most that it is asked for.
pub(crate) struct Asked {
    /// Index in the model.
    actuator: usize,
    limit: f64,
    most: f64,
}

/// The actuators that are asked for more than they may deliver.
pub(crate) fn asked_beyond(built: &Built, tapes: &[Tape]) -> Vec<Asked> {
    let of = |(actuator, a): (usize, &sim::Actuator)| {
        let ActuatorKind::JointEffort { limit, .. } = a.kind else { return None };
        let values =
            tapes.iter().flat_map(|t| &t.commands).filter(|c| c.is_effort_of(actuator)).flat_map(|c| &c.values);
        let mut beyond: Vec<f64> = values.map(|v| v.abs()).filter(|v| *v > (1.0 + MARGIN) * limit).collect();
        beyond.sort_by(|a, b| b.total_cmp(a));
        (beyond.len() > SAMPLES).then(|| Asked { actuator, limit, most: beyond[0] })
    };
    built.model.actuators.iter().enumerate().filter_map(of).collect()
}

impl Asked {
    /// The scenario with the limit so high that nothing is cut, and which it was, in words.
    pub(crate) fn raised(&self, plant: &Plant, built: &Built) -> Option<(Scenario, String)> {
        let actuator = &built.model.actuators[self.actuator];
        let ActuatorKind::JointEffort { coordinate, .. } = actuator.kind else { return None };
        let mut scenario = plant.scenario.clone();
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

    /// Whether windows with such commands are followed clearly better by a model that delivers them.
    pub(crate) fn is_delivered(&self, stage: &Stage<'_>, [own, raised]: [&Built; 2], windows: &[Segment]) -> bool {
        let has_such = |s: &&Segment| {
            let own = stage.tapes[s.run].commands.iter().filter(|c| c.is_effort_of(self.actuator));
            let is_beyond =
                |(t, v): (&f64, &f64)| (s.span.from..s.span.to).contains(t) && v.abs() > (1.0 + MARGIN) * self.limit;
            own.flat_map(|c| c.times.iter().zip(&c.values)).any(is_beyond)
        };
        let such: Vec<&Segment> = windows.iter().filter(has_such).collect();
        let every = such.len().div_ceil(LOOKED_AT).max(1);
        let some: Vec<Segment> = such.into_iter().step_by(every).cloned().collect();
        let costs = |built: &Built| -> Vec<f64> {
            stage.fit_starts(built, &some, Effort::JUDGED).iter().map(|s| s.cost).collect()
        };
        let ratios = costs(raised).into_iter().zip(costs(own)).map(|(b, a)| (b / a).ln()).filter(|l| l.is_finite());
        let (sum, count) = ratios.fold((0.0, 0), |(sum, count), l| (sum + l, count + 1));
        count > 0 && sum / f64::from(count) < CLEARLY.ln()
    }
}

/// The largest speed at which a joint was pushed on that outliers do not explain, where it is beyond the limit.
fn speed_beyond(tapes: &[Tape], (actuator, coordinate): (usize, usize), limit: f64) -> Option<f64> {
    let mut count = 0;
    let mut beyond = Vec::new();
    for tape in tapes {
        let Some(command) = tape.commands.iter().find(|c| c.actuator == actuator && c.what == Commanded::Effort) else {
            continue;
        };
        for reading in &tape.readings {
            let speeds = speeds_of(reading, coordinate);
            count += speeds.len();
            let passes = |(t, v, sigma): &(f64, f64, f64)| {
                v.abs() - DEVIATIONS * sigma > (1.0 + MARGIN) * limit && command.at(*t) * v > 0.0
            };
            beyond.extend(speeds.iter().filter(|s| passes(s)).map(|(_, v, _)| v.abs()));
        }
    }
    beyond.sort_by(|a: &f64, b| b.total_cmp(a));
    let outliers = SAMPLES.max((SHARE * count as f64) as usize);
    beyond.get(outliers).copied()
}

/// Instants, speeds and their standard deviations by what a reading says of a joint: measured, or told by positions some samples apart.
fn speeds_of(reading: &Reading, coordinate: usize) -> Vec<(f64, f64, f64)> {
    let value = |i: usize| match reading.values[i] {
        Value::Vector(v) => v.x,
        Value::Rotation(_) => f64::NAN,
    };
    let apart = |i: usize| {
        let (from, to) = (reading.times[i], reading.times[i + APART]);
        let speed = (value(i + APART) - value(i)) / (to - from);
        (0.5 * (from + to), speed, reading.sigma * std::f64::consts::SQRT_2 / (to - from))
    };
    match reading.quantity {
        Quantity::JointVelocity(v) if v == coordinate => {
            (0..reading.times.len()).map(|i| (reading.times[i], value(i), reading.sigma)).collect()
        }
        Quantity::JointPosition(v) if v == coordinate => {
            (0..reading.times.len().saturating_sub(APART)).map(apart).collect()
        }
        _ => Vec::new(),
    }
}

impl CommandTape {
    /// Whether it is what an actuator is asked to deliver.
    fn is_effort_of(&self, actuator: usize) -> bool {
        self.actuator == actuator && self.what == Commanded::Effort
    }

    /// The command that is held at an instant; the first one before it begins.
    fn at(&self, time: f64) -> f64 {
        let next = self.times.partition_point(|t| *t <= time);
        self.values.get(next.saturating_sub(1)).copied().unwrap_or(0.0)
    }
}

/// What is done with the efforts that were measured, in words.
pub(crate) fn said_of_efforts(set: &RecordingSet) -> Option<String> {
    let measured = |s: &&Series| s.channel.starts_with("joint.") && s.channel.ends_with(EFFORT);
    let channels: BTreeSet<&str> =
        set.runs.iter().flat_map(|r| r.series.iter().filter(measured).map(|s| s.channel.as_str())).collect();
    if channels.is_empty() {
        return None;
    }
    let list = channels.into_iter().collect::<Vec<_>>().join(", ");
    Some(format!(
        "{list}: measured efforts are what drives a joint whose command was not recorded, and are not looked at where it was."
    ))
}

/// How the channel of a measured effort ends.
const EFFORT: &str = ".effort";

/// The command channel of the joint whose effort a channel measured.
pub(crate) fn command_beside(channel: &str) -> Option<String> {
    channel.strip_suffix(EFFORT).map(|joint| format!("{joint}.effort_command"))
}
