//! A run as a rig would have recorded it: what sensors said when it arrived, what was commanded when it changed, and nothing else.
//!
//! The format is that of recordings ([`record::RecordingSet`]): `softdock run --record` writes it, and a diagnosis reads it back.
//!
//! | channel | when |
//! | --- | --- |
//! | what a `[[sensor]]` reads | as it arrives |
//! | `joint.….position_command`, `.velocity_command`, `.effort_command` | as a joint's command changes |
//! | `actuator.….command` of the others; a thruster's by its largest force | likewise |
//! | `drive.….position`, `.angle` | at the scenario's log rate |

use crate::sensors::{self, Readers, Sensor};
use crate::{Mission, ScenarioErrors};
use record::{RecordedRun, RecordingSet, Role, Series};
use sim::{ActuatorKind, Command, DriveAxis, Flow, Model, Observer, World};
use std::collections::BTreeMap;

/// The observer that takes it down.
#[derive(Debug)]
pub struct RigLog {
    sensors: Readers,
    taken: BTreeMap<String, (Vec<f64>, Vec<f64>)>,
    commands: Vec<Commanded>,
    drives: Vec<String>,
    every: u64,
    /// When the world was seen last, s: commands that are seen now act since then.
    before: f64,
    scenario: String,
    title: String,
}

/// A command of an actuator.
#[derive(Debug)]
struct Commanded {
    channel: String,
    actuator: usize,
    value: fn(&Command) -> f64,
    /// What the recorded number is multiplied by to be the command.
    unit: f64,
    last: Option<f64>,
}

impl RigLog {
    /// For a mission at its start. Errors: sensors that no run can record; none at all.
    pub fn new(mission: &Mission) -> Result<Self, ScenarioErrors> {
        let (scenario, model) = (&mission.scenario, mission.world.model());
        if scenario.sensors.is_empty() {
            let reason =
                "is missing, and a rig records what its sensors read; add a [[sensor]], of kind joint-encoder for one";
            return Err(ScenarioErrors::new(vec![scenario.complaint("sensor", reason.to_owned())]));
        }
        let name = |(name, axis): (&str, DriveAxis)| match axis {
            DriveAxis::X => format!("drive.{name}.position.x"),
            DriveAxis::Y => format!("drive.{name}.position.y"),
            DriveAxis::Z => format!("drive.{name}.position.z"),
            DriveAxis::AboutZ => format!("drive.{name}.angle"),
        };
        Ok(Self {
            sensors: Readers::new(sensors::of(scenario, model).map_err(ScenarioErrors::new)?),
            taken: BTreeMap::new(),
            commands: commands_of(model),
            drives: model.driven_coordinates().map(|(n, axis)| name((n, axis))).collect(),
            every: mission.steps_per_sample,
            before: 0.0,
            scenario: scenario.name.clone(),
            title: scenario.description.clone().unwrap_or_default(),
        })
    }

    fn take(&mut self, channel: &str, time: f64, value: f64) {
        let (times, values) = self.taken.entry(channel.to_owned()).or_default();
        // Two that arrive at once: the later one counts.
        if times.last() == Some(&time) {
            values.pop();
            times.pop();
        }
        times.push(time);
        values.push(value);
    }

    fn take_commands(&mut self, world: &World) {
        let mut changed = Vec::new();
        for command in &mut self.commands {
            let value = (command.value)(&world.state().commands[command.actuator]) / command.unit;
            if command.last != Some(value) {
                command.last = Some(value);
                changed.push((command.channel.clone(), value));
            }
        }
        changed.into_iter().for_each(|(channel, value)| self.take(&channel, self.before, value));
    }

    fn take_drives(&mut self, world: &World) {
        let now = world.state().time;
        let channels = std::mem::take(&mut self.drives);
        let paths = world.model().drives.iter().flat_map(|d| d.paths.iter().map(|(_, path)| path.eval(now).position));
        channels.iter().zip(paths).for_each(|(channel, value)| self.take(channel, now, value));
        self.drives = channels;
    }

    /// The run as a set of one, under a file's name.
    pub fn finish(mut self, file: &str, (role, note): (Role, &str)) -> RecordingSet {
        let noise = self.sensors.sensors().map(Sensor::noise).filter(|(_, sigma)| *sigma > 0.0);
        let noise = noise.map(|(name, sigma)| (name.to_owned(), sigma)).collect();
        // A feed-forward that never was is no command.
        let idle: Vec<&str> =
            self.commands.iter().filter(|c| c.is_feed_forward()).map(|c| c.channel.as_str()).collect();
        self.taken.retain(|name, (_, values)| !idle.contains(&name.as_str()) || values.iter().any(|v| *v != 0.0));
        // Written as they are: what they were rounded to is found again by who reads them.
        let series =
            |(name, (times, values)): (String, (Vec<f64>, Vec<f64>))| Series::with_quantum(name, times, values, 0.0);
        let run = RecordedRun {
            file: file.to_owned(),
            role,
            note: note.to_owned(),
            series: self.taken.into_iter().map(series).collect(),
        };
        RecordingSet { rig: self.scenario, title: self.title, noise, runs: vec![run], ..RecordingSet::default() }
    }
}

impl Commanded {
    fn is_feed_forward(&self) -> bool {
        self.channel.ends_with(".effort_command")
    }
}

/// What can be commanded, by the names of recordings.
fn commands_of(model: &Model) -> Vec<Commanded> {
    let joint = |coordinate: usize, what: &str| {
        let own = crate::measure::joints(model).find(|(.., at)| *at == coordinate);
        own.map(|(vehicle, joint, _)| format!("joint.{vehicle}/{joint}.{what}_command"))
    };
    let mut all = Vec::new();
    for (index, actuator) in model.actuators.iter().enumerate() {
        let mut add = |channel: Option<String>, value: fn(&Command) -> f64, unit: f64| {
            let channel = channel.unwrap_or_else(|| format!("actuator.{}.command", actuator.name));
            all.push(Commanded { channel, actuator: index, value, unit, last: None });
        };
        match actuator.kind {
            ActuatorKind::JointEffort { coordinate, .. } => add(joint(coordinate, "effort"), |c| c.effort, 1.0),
            ActuatorKind::JointDrive { coordinate, stiffness, .. } => {
                if stiffness > 0.0 {
                    add(joint(coordinate, "position"), |c| c.position, 1.0);
                }
                add(joint(coordinate, "velocity"), |c| c.velocity, 1.0);
                add(joint(coordinate, "effort"), |c| c.effort, 1.0);
            }
            ActuatorKind::Thruster { max_force, .. } => add(None, |c| c.effort, max_force),
            ActuatorKind::LatchRelease { .. } => add(None, |c| c.effort, 1.0),
        }
    }
    all
}

impl Observer for RigLog {
    fn observe(&mut self, world: &World) -> Flow {
        let mut sensors = std::mem::replace(&mut self.sensors, Readers::new(Vec::new()));
        sensors.look(world, |_, sensor, arrival| {
            for (channel, value) in sensor.names().zip(sensor.shown(arrival.value)) {
                self.take(channel, arrival.arrives, value);
            }
        });
        self.sensors = sensors;
        // At the start nothing has been commanded yet.
        if world.state().steps > 0 {
            self.take_commands(world);
        }
        if world.state().steps.is_multiple_of(self.every) {
            self.take_drives(world);
        }
        self.before = world.state().time;
        Flow::Continue
    }
}
