//! What a recording says of a scenario's limits before anything is fitted: joints that were pushed on beyond the speed at which their
//! drives stop pushing, joints that went on beyond their stops, and efforts that were measured rather than commanded.
//!
//! The velocity limit of a URDF is often a planner's. Where a recorded joint is faster while its command pushes it on, the rig has no
//! such limit: it is raised, and that is said; a model that stops pushing there would be off by more than any effect.

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
pub(crate) const SAMPLES: usize = 5;
const SHARE: f64 = 1e-3;
/// Standard deviations of a sample, and share of the limit, by which it is passed beyond doubt.
const DEVIATIONS: f64 = 4.0;
pub(crate) const MARGIN: f64 = 2e-3;
/// Samples between two positions that tell a speed.
const APART: usize = 8;
/// The limit that is put in its place, in largest speeds seen: far enough that nothing a corrected model does comes near.
pub(crate) const RAISED: f64 = 2.0;

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

/// The scenario without the stops that its recording passes, and which these are, in words; none where it passes none.
pub(crate) fn unstopped(plant: &Plant, built: &Built, tapes: &[Tape]) -> Option<(Scenario, String)> {
    let mut scenario = plant.scenario.clone();
    let mut passed = Vec::new();
    for (v, vehicle) in built.model.vehicles.iter().enumerate() {
        for joint in vehicle.tree.joints.iter().filter(|j| !j.is_mimic) {
            let Some([lower, upper]) = joint.position_limits else { continue };
            let coordinate = vehicle.v0 + joint.v_index;
            let yields = YIELDS[usize::from(built.model.slides(coordinate))];
            let Some(far) = place_beyond(tapes, coordinate, [lower - yields, upper + yields]) else { continue };
            let range = format!("{} … {}", short(lower), short(upper));
            let now = scenario.lift_stops(v, &joint.name);
            passed.extend(now.map(|now| format!("{} ({} beyond {range}; {now})", joint.name, short(far))));
        }
    }
    let words = || {
        format!(
            "Joints went on beyond the ends of their ranges in the URDF, so that the rig has no such stops; they are taken away: {}.",
            passed.join(", ")
        )
    };
    (!passed.is_empty()).then(|| (scenario, words()))
}

/// What a stop yields at most, rad and m: twice what the scenario's own do at a drive's full effort.
const YIELDS: [f64; 2] = [2e-2, 2e-3];

/// The place farthest outside a range at which a joint was read that outliers do not explain.
fn place_beyond(tapes: &[Tape], coordinate: usize, [lower, upper]: [f64; 2]) -> Option<f64> {
    let is_place = |r: &&Reading| matches!(r.quantity, Quantity::JointPosition(v) | Quantity::JointLinkPosition(v) if v == coordinate);
    let readings: Vec<&Reading> = tapes.iter().flat_map(|t| &t.readings).filter(is_place).collect();
    let outside = |r: &Reading, q: f64| (lower - q).max(q - upper) - DEVIATIONS * r.sigma;
    let places = readings.iter().flat_map(|r| r.values.iter().map(Value::scalar).map(|q| (outside(r, q), q)));
    let count = readings.iter().map(|r| r.values.len()).sum();
    farthest(places.filter(|p| p.0 > 0.0).collect(), count)
}

/// Of samples beyond a limit, how far and what each is, the farthest that outliers among so many do not explain.
fn farthest(mut beyond: Vec<(f64, f64)>, count: usize) -> Option<f64> {
    beyond.sort_by(|a, b| b.0.total_cmp(&a.0));
    beyond.get(SAMPLES.max((SHARE * count as f64) as usize)).map(|p| p.1)
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
            beyond.extend(speeds.iter().filter(|s| passes(s)).map(|(_, v, _)| (v.abs(), v.abs())));
        }
    }
    farthest(beyond, count)
}

/// Instants, speeds and their standard deviations by what a reading says of a joint: measured, or told by positions some samples apart.
fn speeds_of(reading: &Reading, coordinate: usize) -> Vec<(f64, f64, f64)> {
    let value = |i: usize| reading.values[i].scalar();
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
    /// The command that is held at an instant; the first one before it begins.
    pub(crate) fn at(&self, time: f64) -> f64 {
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
