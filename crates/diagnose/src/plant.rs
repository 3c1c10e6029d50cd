//! The scenario with a set of effects, built for replay.

use crate::error::DiagnoseError;
use crate::reading::{LinkPlace, Quantity};
use multibody::JointKind;
use record::{RecordedRun, RecordingSet};
use scenario::Scenario;
use scenario::measure::{Gauge, SensorModel};
use scenario::spec::{Effect, ParamValue};
use sim::{ActuatorKind, DriveAxis, DrivePath, Model, State};
use std::sync::Arc;

/// A scenario whose `[[effect]]` entries are varied, with what the recording says about it.
#[derive(Clone, Debug)]
pub struct Plant {
    /// The nominal scenario; its own effects belong to the nominal model.
    pub scenario: Scenario,
    /// Vector channels that are read.
    pub channels: Vec<String>,
    /// By run: paths of the driven coordinates.
    pub drives: Vec<Vec<Arc<DrivePath>>>,
}

/// A built set of effects.
#[derive(Clone, Debug)]
pub struct Built {
    /// The world's immutable part.
    pub model: Arc<Model>,
    /// The same on each run's drive paths; empty where nothing is driven.
    pub by_run: Vec<Arc<Model>>,
    /// The state that the scenario starts in.
    pub start: State,
    /// What each channel reads, and the faults of its sensor.
    pub sensors: Vec<(String, Gauge, SensorModel)>,
    /// Longest delay of an actuator, s.
    pub delay: f64,
}

impl Plant {
    /// The scenario alone, before a recording is read.
    pub fn new(scenario: Scenario) -> Self {
        Self { scenario, channels: Vec::new(), drives: Vec::new() }
    }

    /// Takes channels and drive paths of a recording.
    pub fn attach(&mut self, set: &RecordingSet, model: &Model, channels: Vec<String>) -> Result<(), DiagnoseError> {
        self.channels = channels;
        if model.drives.is_empty() {
            return Ok(());
        }
        let of_run = |run: &RecordedRun| -> Result<Vec<Arc<DrivePath>>, DiagnoseError> {
            model.driven_coordinates().map(|(name, axis)| drive_path(set, run, name, axis)).collect()
        };
        self.drives = set.runs.iter().map(of_run).collect::<Result<_, _>>()?;
        Ok(())
    }

    /// Builds the nominal scenario with `effects` added to its own.
    pub fn build(&self, effects: &[Effect]) -> Result<Built, DiagnoseError> {
        let mut scenario = self.scenario.clone();
        scenario.effects.extend(effects.iter().cloned());
        let mission = scenario::build(&scenario)?;
        let model = Arc::clone(mission.world.model());
        let late = scenario.effects.iter().filter(|e| e.name == "actuator-delay");
        let delays = late.filter_map(|e| e.params.get("delay").and_then(ParamValue::number));
        let sensor = |channel: &String| {
            let gauge = Gauge::resolve(&scenario, &model, channel).ok()?;
            Some((channel.clone(), gauge, SensorModel::of(&scenario.effects, channel)))
        };
        Ok(Built {
            by_run: self.drives.iter().map(|paths| Arc::new(model.with_drive_paths(paths.iter().cloned()))).collect(),
            start: mission.world.state().clone(),
            sensors: self.channels.iter().filter_map(sensor).collect(),
            delay: delays.fold(0.0, f64::max),
            model,
        })
    }
}

/// The motion behind a recorded drive.
fn drive_path(
    set: &RecordingSet,
    run: &RecordedRun,
    name: &str,
    axis: DriveAxis,
) -> Result<Arc<DrivePath>, DiagnoseError> {
    let component = match axis {
        DriveAxis::X => "position.x",
        DriveAxis::Y => "position.y",
        DriveAxis::Z => "position.z",
        DriveAxis::AboutZ => "angle",
    };
    let channel = format!("drive.{name}.{component}");
    let series = run.series(&channel).ok_or_else(|| DiagnoseError::Channel {
        channel: channel.clone(),
        file: run.file.clone(),
        reason: "is missing, and it is what moves the drive; record it, or map its column".to_owned(),
    })?;
    let quantum = series.quantum();
    let noise = set.sigma(&channel).map(|s| (s * s + quantum * quantum / 12.0).sqrt());
    Ok(Arc::new(DrivePath::smoothed(&series.times, &series.values, noise)))
}

impl Built {
    /// The model on a run's drive paths.
    pub fn model_of(&self, run: usize) -> &Arc<Model> {
        self.by_run.get(run).unwrap_or(&self.model)
    }

    /// What a channel reads, and the faults of its sensor.
    pub fn sensor(&self, channel: &str) -> Option<(Gauge, SensorModel)> {
        self.sensors.iter().find(|(c, ..)| c == channel).map(|(_, gauge, model)| (*gauge, *model))
    }

    /// What a vector channel (without its component) measures; `None` where the scenario has nothing of that name.
    pub fn quantity(&self, channel: &str) -> Option<Quantity> {
        let (family, rest) = channel.split_once('.')?;
        let (name, what) = rest.rsplit_once('.')?;
        match (family, what) {
            ("joint", "position") => self.joint(name).map(|(q, v)| Quantity::JointPosition { q, v }),
            ("joint", "velocity") => self.joint(name).map(|(q, v)| Quantity::JointVelocity { q, v }),
            ("body", "position") => self.link(name).map(Quantity::Position),
            ("body", "orientation") => self.link(name).map(Quantity::Orientation),
            ("body", "linear_velocity") => self.link(name).map(Quantity::LinearVelocity),
            ("body", "angular_velocity") => self.link(name).map(Quantity::AngularVelocity),
            ("sensor", "force") => Some(Quantity::Force),
            ("sensor", "torque") => Some(Quantity::Torque),
            _ => None,
        }
    }

    /// Actuator that a command channel drives, with the effort of a command of one.
    pub fn actuator(&self, channel: &str) -> Option<(usize, f64)> {
        let actuators = &self.model.actuators;
        if let Some(joint) = channel.strip_prefix("joint.").and_then(|c| c.strip_suffix(".effort_command")) {
            let (_, v) = self.joint(joint)?;
            let drives =
                |k: &ActuatorKind| matches!(k, ActuatorKind::JointEffort { coordinate, .. } if *coordinate == v);
            return actuators.iter().position(|a| drives(&a.kind)).map(|i| (i, 1.0));
        }
        let name = channel.strip_prefix("actuator.")?.strip_suffix(".command")?;
        let i = actuators.iter().position(|a| a.name == name || a.name.ends_with(&format!("/{name}")))?;
        let unit = if let ActuatorKind::Thruster { max_force, .. } = actuators[i].kind { max_force } else { 1.0 };
        Some((i, unit))
    }

    /// Indices into `q` and `v` of a joint with one coordinate, by `joint` where unique or `vehicle/joint`.
    fn joint(&self, name: &str) -> Option<(usize, usize)> {
        let all = self.model.vehicles.iter().flat_map(|vehicle| {
            let single =
                |j: &&multibody::Joint| matches!(j.kind, JointKind::Revolute | JointKind::Prismatic) && !j.is_mimic;
            vehicle.tree.joints.iter().filter(single).map(move |j| (vehicle, j))
        });
        let named =
            |(v, j): &(&sim::Vehicle, &multibody::Joint)| j.name == name || format!("{}/{}", v.name, j.name) == name;
        all.filter(named).map(|(v, j)| (v.q0 + j.q_index, v.v0 + j.v_index)).next()
    }

    /// A link by `link` where unique, by `vehicle/link`, or a vehicle's base by the vehicle's name.
    pub fn link(&self, name: &str) -> Option<LinkPlace> {
        if let Some((vehicle, link)) = self.model.link(name) {
            return Some(LinkPlace { vehicle, link });
        }
        let by_link = self
            .model
            .vehicles
            .iter()
            .enumerate()
            .find_map(|(vehicle, v)| v.tree.link(name).map(|link| LinkPlace { vehicle, link }));
        by_link.or_else(|| self.model.vehicle(name).map(|vehicle| LinkPlace { vehicle, link: 0 }))
    }
}
