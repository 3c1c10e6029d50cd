//! Watches motors: when one reaches the speed at which it stops pushing, and when a wheel is asked for more than its torque.

use super::Metric;
use crate::spec::{self, Scenario};
use record::{Event, EventKind};
use serde_json::Value;
use sim::{ActuatorKind, World};

/// A motor that has reached its limit counts as come off it below this share of it, so that one stay is told once.
const OFF: f64 = 0.99;

/// One motor that turns a coordinate with a speed limit.
#[derive(Clone, Debug)]
struct Motor {
    /// Index into the model's actuators.
    actuator: usize,
    coordinate: usize,
    name: String,
    is_wheel: bool,
    torque_limit: f64,
    is_at_limit: bool,
    speed_limited: Option<f64>,
    torque_limited: Option<f64>,
    peak_speed: f64,
}

/// The watcher.
#[derive(Clone, Debug, Default)]
pub(super) struct MotorWatch {
    motors: Vec<Motor>,
}

impl MotorWatch {
    /// For a world at its start.
    pub(super) fn new(scenario: &Scenario, world: &World) -> Self {
        let wheels = scenario.actuators.iter().filter(|a| matches!(a.kind, spec::ActuatorKind::ReactionWheel { .. }));
        let wheels: Vec<&str> = wheels.map(|a| a.name.as_str()).collect();
        let model = world.model();
        let motor = |(actuator, of): (usize, &sim::Actuator)| {
            let (coordinate, torque_limit) = match of.kind {
                ActuatorKind::JointEffort { coordinate, limit }
                | ActuatorKind::JointDrive { coordinate, limit, .. } => (coordinate, limit),
                ActuatorKind::Thruster { .. } | ActuatorKind::LatchRelease { .. } => return None,
            };
            model.coordinates[coordinate].speed_limit.is_finite().then(|| Motor {
                actuator,
                coordinate,
                name: of.name.clone(),
                is_wheel: wheels.contains(&of.name.as_str()),
                torque_limit,
                is_at_limit: false,
                speed_limited: None,
                torque_limited: None,
                peak_speed: 0.0,
            })
        };
        Self { motors: model.actuators.iter().enumerate().filter_map(motor).collect() }
    }

    pub(super) fn observe(&mut self, world: &World, events: &mut Vec<Event>) {
        let (time, step) = (world.state().time, world.state().steps);
        for motor in &mut self.motors {
            let (limit, speed) =
                (world.model().coordinates[motor.coordinate].speed_limit, world.motor_side(motor.coordinate).1.abs());
            motor.peak_speed = motor.peak_speed.max(speed);
            if motor.is_wheel && world.state().commands[motor.actuator].effort.abs() > motor.torque_limit {
                motor.torque_limited.get_or_insert(time);
            }
            if !motor.is_at_limit && speed > OFF * limit && world.is_speed_limited(motor.coordinate) {
                motor.is_at_limit = true;
                motor.speed_limited.get_or_insert(time);
                let unit = if motor.is_wheel { " rad/s" } else { " (rad/s or m/s)" };
                let text = format!("{} is at its speed limit of {limit}{unit} and pushes no further", motor.name);
                events.push(Event { t: time, step, kind: EventKind::Limit, text });
            }
            motor.is_at_limit &= speed > OFF * limit;
        }
    }

    /// Three figures for every wheel; for other motors the time at which they reached their limit, if they did.
    pub(super) fn add_metrics(&self, metrics: &mut Vec<Metric>) {
        let optional = |value: Option<f64>| value.map_or(Value::Null, Value::from);
        for motor in &self.motors {
            let mut add = |what: &str, value: Value, meaning| {
                metrics.push(Metric { name: format!("actuator.{}.{what}", motor.name).into(), value, meaning });
            };
            if motor.is_wheel || motor.speed_limited.is_some() {
                let meaning = "when it first reached the speed at which it stops pushing";
                add("speed_limited_s", optional(motor.speed_limited), meaning);
            }
            if motor.is_wheel {
                let meaning = "when it was first asked for more than its torque limit";
                add("torque_limited_s", optional(motor.torque_limited), meaning);
                add("peak_speed_rad_per_s", motor.peak_speed.into(), "largest speed of the wheel");
            }
        }
    }
}
