//! The scenario with a set of effects, built for replay.

use crate::error::DiagnoseError;
use crate::tape::Commanded;
use record::{RecordedRun, RecordingSet};
use scenario::measure::{Gauge, MeasureError, Mount, Quantity, SensorModel};
use scenario::spec::{Effect, Integrator, IntegratorKind};
use scenario::{DriveChannel, OwnInertials, Scenario, Stock};
use sim::{Actuator, ActuatorKind, DrivePath, EffectKind, LineEffect, LineLaw, Model, State};
use std::sync::{Arc, OnceLock};

/// A scenario whose `[[effect]]` entries are varied, with what the recording says about it.
#[derive(Clone, Debug)]
pub struct Plant {
    /// The nominal scenario; its own effects belong to the nominal model.
    pub scenario: Scenario,
    /// Vector channels that are read.
    pub channels: Vec<String>,
    /// By run: paths of the driven coordinates.
    pub drives: Vec<Vec<Arc<DrivePath>>>,
    /// What its builds share; the first one fills it.
    stock: OnceLock<Stock>,
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
    /// The driven coordinates' channels.
    pub drives: Vec<DriveChannel>,
    /// Mass properties of the vehicles' links without what effects add to them or let move in them.
    pub own_inertials: Vec<OwnInertials>,
    /// Elastic mounts.
    pub mounts: Vec<Mount>,
    /// Delays of actuators, s, in the order of the effects.
    pub delays: Vec<f64>,
}

/// Commands of a joint by the end of their channels' names.
const COMMANDS: [(&str, Commanded); 3] = [
    (".effort_command", Commanded::Effort),
    (".position_command", Commanded::Position),
    (".velocity_command", Commanded::Velocity),
];

/// Step from which Runge–Kutta's is sought, in steps at which a scheme of lower order, which damps, holds.
const FINER: f64 = 0.25;

impl Plant {
    /// The scenario alone, before a recording is read.
    ///
    /// Replays go by Runge–Kutta, whatever the scenario's own scheme: what a scheme of first order loses at the scenario's step would be taken
    /// for physics. Their steps are chosen by what halving them moves.
    pub fn new(mut scenario: Scenario) -> Self {
        if scenario.integrator.kind != IntegratorKind::Rk4 {
            scenario.integrator = Integrator { kind: IntegratorKind::Rk4, step_s: FINER * scenario.integrator.step_s };
        }
        Self { scenario, channels: Vec::new(), drives: Vec::new(), stock: OnceLock::new() }
    }

    /// Takes channels and drive paths of a recording.
    ///
    /// A drive moves as the run's recording of it says; one that the scenario gives a motion may go unrecorded.
    pub fn attach(&mut self, set: &RecordingSet, built: &Built, channels: Vec<String>) -> Result<(), DiagnoseError> {
        self.channels = channels;
        if built.drives.is_empty() {
            return Ok(());
        }
        let own = || built.model.drives.iter().flat_map(|d| d.paths.iter().map(|(_, path)| path));
        let of_run = |run: &RecordedRun| -> Result<Vec<Arc<DrivePath>>, DiagnoseError> {
            built.drives.iter().zip(own()).map(|(drive, path)| drive_path(set, run, (drive, path))).collect()
        };
        self.drives = set.runs.iter().map(of_run).collect::<Result<_, _>>()?;
        Ok(())
    }

    /// The same recording beside another scenario of the same parts.
    pub fn of(&self, scenario: Scenario) -> Self {
        Self { scenario, channels: self.channels.clone(), drives: self.drives.clone(), stock: OnceLock::new() }
    }

    /// The scenario with `effects` added to its own.
    pub fn with(&self, effects: &[Effect]) -> Scenario {
        let mut scenario = self.scenario.clone();
        scenario.effects.extend(effects.iter().cloned());
        scenario
    }

    /// What a vector channel (without its component) measures in the nominal model.
    pub fn quantity(&self, model: &Model, channel: &str) -> Result<Quantity, MeasureError> {
        Gauge::resolve(&self.scenario, model, channel).map(|gauge| gauge.quantity())
    }

    /// Actuator that a command channel drives, what of it, and the value of a command of one; `None` for a channel that is no command.
    pub fn actuator(&self, model: &Model, channel: &str) -> Option<Result<(usize, Commanded, f64), MeasureError>> {
        let refuse = |fault: &str| MeasureError { channel: channel.to_owned(), fault: fault.to_owned() };
        let of_joint = |(suffix, what): (&str, Commanded)| {
            let joint = channel.strip_prefix("joint.")?.strip_suffix(suffix)?;
            Some((format!("joint.{joint}.position"), Some(what)))
        };
        let (name, of_joint) = match COMMANDS.into_iter().find_map(of_joint) {
            Some(found) => found,
            None if channel.starts_with("actuator.") => (channel.to_owned(), None),
            None => return None,
        };
        let drives = |a: &Actuator, v: usize, what: Commanded| match a.kind {
            ActuatorKind::JointEffort { coordinate, .. } => coordinate == v && what == Commanded::Effort,
            ActuatorKind::JointDrive { coordinate, .. } => coordinate == v,
            ActuatorKind::Thruster { .. } | ActuatorKind::LatchRelease { .. } => false,
        };
        Some(self.quantity(model, &name).and_then(|quantity| match (quantity, of_joint) {
            (Quantity::JointPosition(v), Some(what)) => {
                let found = model.actuators.iter().position(|a| drives(a, v, what));
                let missing =
                    "no [[actuator]] of the scenario takes this command of the joint; add one, or drop the column";
                found.map(|i| (i, what, 1.0)).ok_or_else(|| refuse(missing))
            }
            (Quantity::Command(i), None) => Ok(match model.actuators[i].kind {
                ActuatorKind::Thruster { max_force, .. } => (i, Commanded::Effort, max_force),
                ActuatorKind::JointDrive { stiffness, .. } if stiffness > 0.0 => (i, Commanded::Position, 1.0),
                ActuatorKind::JointDrive { .. } => (i, Commanded::Velocity, 1.0),
                ActuatorKind::JointEffort { .. } | ActuatorKind::LatchRelease { .. } => (i, Commanded::Effort, 1.0),
            }),
            _ => Err(refuse("commands nothing in the scenario; drop the column")),
        }))
    }

    /// Builds the nominal scenario with `effects` added to its own.
    pub fn build(&self, effects: &[Effect]) -> Result<Built, DiagnoseError> {
        let scenario = self.with(effects);
        let mission = match self.stock.get() {
            Some(stock) => scenario::build_from(&scenario, stock)?,
            None => scenario::build(&scenario)?,
        };
        self.stock.get_or_init(|| Stock::of(&mission));
        let model = Arc::clone(mission.world.model());
        let delay = |kind: &EffectKind| match kind {
            EffectKind::Line(LineEffect { law: LineLaw::Delay(delay), .. }) => Some(*delay),
            _ => None,
        };
        let delays = model.effects().iter().filter_map(|effect| delay(&effect.kind)).collect();
        let sensor = |channel: &String| {
            let gauge = Gauge::resolve(&scenario, &model, channel).ok()?;
            Some((channel.clone(), gauge, SensorModel::late(&scenario, &model, channel)))
        };
        Ok(Built {
            by_run: self.drives.iter().map(|paths| Arc::new(model.with_drive_paths(paths.iter().cloned()))).collect(),
            start: mission.world.state().clone(),
            sensors: self.channels.iter().filter_map(sensor).collect(),
            mounts: Mount::all(&model),
            drives: mission.drives,
            own_inertials: mission.own_inertials,
            delays,
            model,
        })
    }
}

/// The motion behind a recorded drive.
fn drive_path(
    set: &RecordingSet,
    run: &RecordedRun,
    (drive, own): (&DriveChannel, &Arc<DrivePath>),
) -> Result<Arc<DrivePath>, DiagnoseError> {
    let channel = &drive.channel;
    let Some(series) = run.series(channel) else {
        let reason = "is missing, and it is what moves the drive; record it, or map its column".to_owned();
        let missing = DiagnoseError::Channel { channel: channel.clone(), file: run.file.clone(), reason };
        return if drive.awaits_recording { Err(missing) } else { Ok(Arc::clone(own)) };
    };
    let quantum = series.quantum();
    let noise = set.sigma(channel).or(drive.noise).map(|s| (s * s + quantum * quantum / 12.0).sqrt());
    Ok(Arc::new(DrivePath::smoothed(&series.times, &series.values, noise)))
}

impl Built {
    /// The longest delay of an actuator, s.
    pub fn longest_delay(&self) -> f64 {
        self.delays.iter().copied().fold(0.0, f64::max)
    }

    /// The model on a run's drive paths.
    pub fn model_of(&self, run: usize) -> &Arc<Model> {
        self.by_run.get(run).unwrap_or(&self.model)
    }

    /// What a channel reads, and the faults of its sensor.
    pub fn sensor(&self, channel: &str) -> Option<(Gauge, SensorModel)> {
        self.sensors.iter().find(|(c, ..)| c == channel).map(|(_, gauge, model)| (*gauge, *model))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sim::Integrator as Scheme;

    #[test]
    fn replays_go_by_runge_kutta_whatever_runs_the_scenario() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/rigs/dock-impact.toml");
        let load = |set: &[String]| Plant::new(scenario::load(file.as_ref(), set).expect("it is in the repository"));
        let own = load(&[]);
        let damped = load(&["integrator.kind=\"implicit-euler\"".to_owned()]);
        for (plant, finer) in [(&own, 1.0), (&damped, FINER)] {
            let built = plant.build(&[]).expect("it builds");
            assert_eq!(built.model.integrator, Scheme::RungeKutta4);
            assert_eq!(built.model.step, finer * own.scenario.integrator.step_s);
        }
    }
}
