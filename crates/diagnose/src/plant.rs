//! The scenario with a set of effects, built for replay.

use crate::error::DiagnoseError;
use crate::reading::{LinkPlace, Quantity, SensorFault};
use multibody::JointKind;
use scenario::Scenario;
use scenario::spec::{Effect, ParamValue};
use sim::{ActuatorKind, Model, State};
use spatial::Vec3;
use std::sync::Arc;

/// A scenario whose `[[effect]]` entries are varied.
#[derive(Clone, Debug)]
pub struct Plant {
    /// The nominal scenario; its own effects belong to the nominal model.
    pub scenario: Scenario,
}

/// A built set of effects.
#[derive(Clone, Debug)]
pub struct Built {
    /// The world's immutable part.
    pub model: Arc<Model>,
    /// The state that the scenario starts in.
    pub start: State,
    /// Faults of sensors by channel prefix.
    pub faults: Vec<(String, SensorFault)>,
    /// Longest delay of an actuator, s.
    pub delay: f64,
}

impl Plant {
    /// Builds the nominal scenario with `effects` added to its own.
    pub fn build(&self, effects: &[Effect]) -> Result<Built, DiagnoseError> {
        let mut scenario = self.scenario.clone();
        let (faults, physics): (Vec<&Effect>, Vec<&Effect>) =
            effects.iter().partition(|e| e.name.starts_with("sensor-"));
        scenario.effects.extend(physics.into_iter().cloned());
        let mission = scenario::build(&scenario)?;
        let late = scenario.effects.iter().filter(|e| e.name == "actuator-delay");
        let delays = late.filter_map(|e| e.params.get("delay").and_then(ParamValue::number));
        Ok(Built {
            model: Arc::clone(mission.world.model()),
            start: mission.world.state().clone(),
            faults: collect_faults(&faults),
            delay: delays.fold(0.0, f64::max),
        })
    }
}

/// Faults by channel; several effects on one sensor come together.
fn collect_faults(effects: &[&Effect]) -> Vec<(String, SensorFault)> {
    let mut all: Vec<(String, SensorFault)> = Vec::new();
    for effect in effects {
        let channel = effect.place.trim_start_matches("sensor:").to_owned();
        if !all.iter().any(|(c, _)| *c == channel) {
            all.push((channel.clone(), SensorFault::default()));
        }
        let Some((_, fault)) = all.iter_mut().find(|(c, _)| *c == channel) else { continue };
        let number = |key: &str| effect.params.get(key).and_then(ParamValue::number);
        let vector = |key: &str| {
            let values = effect.params.get(key).and_then(ParamValue::numbers).unwrap_or(&[]);
            Vec3::from_fn(|k, _| values.get(k).copied().unwrap_or(0.0))
        };
        fault.bias += vector("bias");
        fault.scale *= number("scale").unwrap_or(1.0);
        fault.delay += number("delay").unwrap_or(0.0);
        fault.angle += vector("angle");
    }
    all
}

impl Built {
    /// Fault of the sensor behind a channel.
    pub fn fault(&self, channel: &str) -> SensorFault {
        self.faults
            .iter()
            .find(|(prefix, _)| channel.starts_with(prefix.as_str()))
            .map_or_else(SensorFault::default, |f| f.1)
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
