//! Recorded commands, held from each sample to the next (zero-order hold).

use super::schedule::Target;
use crate::build::{ActuatorTable, Faults};
use crate::spec::{DriveMotion, Replay, Scenario};
use sim::{Command, Controller, Known, Model};

/// Plays columns of a recording.
#[derive(Clone, Debug)]
pub(super) struct ReplayPlayer {
    courses: Vec<Course>,
}

#[derive(Clone, Debug)]
struct Course {
    actuator: usize,
    target: Target,
    times: Vec<f64>,
    values: Vec<f64>,
}

pub(super) fn build(
    scenario: &Scenario,
    spec: &Replay,
    table: &ActuatorTable,
    model: &Model,
    faults: &mut Faults<'_>,
) -> Option<ReplayPlayer> {
    let path = scenario.source.file_dir().join(&spec.file);
    let read = match path.extension().and_then(|e| e.to_str()) {
        Some("parquet") => record::read_parquet(&path).map(|(_, signals)| signals),
        _ => record::read_csv(&path),
    };
    let recording = match read {
        Ok(recording) => recording,
        Err(error) => {
            faults.add("strategy.file", format!("the recording cannot be read: {error}"));
            return None;
        }
    };
    let mut courses = Vec::new();
    for (name, channel) in &spec.mapping {
        let found: Vec<usize> = table.find(name).collect();
        if found.is_empty() {
            let valid = model.actuators.iter().map(|a| a.name.as_str());
            faults.unknown("strategy.mapping", "actuator", name, valid);
        }
        let Some(values) = recording.values(channel) else {
            faults.unknown(
                "strategy.mapping",
                "channel",
                channel,
                recording.channels.iter().map(|c| c.spec.name.as_str()).collect::<Vec<_>>(),
            );
            continue;
        };
        courses.extend(found.into_iter().map(|a| course(model, a, &recording.times, values)));
    }
    for (a, actuator) in model.actuators.iter().enumerate() {
        let known = [format!("command.{}", actuator.name), format!("actuator.{}.command", actuator.name)];
        if !spec.mapping.contains_key(&actuator.name)
            && let Some(values) = known.iter().find_map(|name| recording.values(name))
        {
            courses.push(course(model, a, &recording.times, values));
        }
    }
    if courses.is_empty() && !moves_a_drive(scenario) {
        let reason = "no column of the recording commands an actuator or moves a drive; give strategy.mapping";
        faults.add("strategy.file", reason);
    }
    Some(ReplayPlayer { courses })
}

/// Whether a drive follows the strategy's recording.
fn moves_a_drive(scenario: &Scenario) -> bool {
    scenario.drives.iter().any(|d| matches!(&d.motion, DriveMotion::Recording { file: None, .. }))
}

/// The samples that are there; a cell that was not sampled keeps the command before it.
fn course(model: &Model, actuator: usize, times: &[f64], values: &[f64]) -> Course {
    let sampled = || times.iter().zip(values).filter(|(_, v)| v.is_finite());
    Course {
        actuator,
        target: Target::of(&model.actuators[actuator].kind),
        times: sampled().map(|(t, _)| *t).collect(),
        values: sampled().map(|(_, v)| *v).collect(),
    }
}

impl Controller for ReplayPlayer {
    fn command(&self, known: &Known<'_>, _: &mut Vec<f64>, commands: &mut [Command]) {
        // Half a step early: a sample's time and a step's may differ by rounding.
        let now = known.world.state().time + 0.5 * known.world.model().step;
        for course in &self.courses {
            let after = course.times.partition_point(|t| *t <= now);
            if let Some(value) = after.checked_sub(1).or(Some(0)).and_then(|i| course.values.get(i)) {
                course.target.write(*value, &mut commands[course.actuator]);
            }
        }
    }
}
