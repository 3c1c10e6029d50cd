//! Readings: what a recording measured, and what the simulated world says at the same instant.
//!
//! A reading is a scalar, some components of a vector that were sampled together, or an orientation. Its residual is
//!
//!   r = (predicted − measured)/σ,    of an orientation r = log(q_measured⁻¹ q_predicted)/σ  (three components, body axes)
//!
//! with σ² = σ_sensor² + q²/12, q the written rounding. A faulty sensor reads
//!
//!   y(t) = scale · exp(angle)ᵀ x(t − delay) + bias,    an orientation q(t − delay) exp(angle).

use sim::World;
use spatial::{Rot, Vec3, exp_rotation, log_rotation};

/// What is read from the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Joint coordinate by its index into `q` and `v`; the motor's where the joint is elastic.
    JointPosition {
        /// Index into `q`.
        q: usize,
        /// Index into `v`.
        v: usize,
    },
    /// Joint rate.
    JointVelocity {
        /// Index into `q`.
        q: usize,
        /// Index into `v`.
        v: usize,
    },
    /// Origin of a link in W, m.
    Position(LinkPlace),
    /// Orientation of a link in W.
    Orientation(LinkPlace),
    /// Velocity of a link's origin, W axes, m/s.
    LinearVelocity(LinkPlace),
    /// Angular velocity of a link, link axes, rad/s.
    AngularVelocity(LinkPlace),
    /// Force of a sensor, N, by the sensor's index.
    Force(usize),
    /// Moment of a sensor, N·m, by the sensor's index.
    Torque(usize),
}

/// A link of a vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LinkPlace {
    /// Index of the vehicle.
    pub vehicle: usize,
    /// Index of the link in its tree.
    pub link: usize,
}

impl Quantity {
    /// Whether its prediction is an orientation.
    pub fn is_orientation(&self) -> bool {
        matches!(self, Self::Orientation(_))
    }

    /// Whether it is a force or moment, which changes at once when contact begins.
    pub fn is_force(&self) -> bool {
        matches!(self, Self::Force(_) | Self::Torque(_))
    }
}

/// A fault of one sensor; the default is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorFault {
    /// Added to the reading, its unit.
    pub bias: Vec3,
    /// Factor.
    pub scale: f64,
    /// Age of the value when it is read, s.
    pub delay: f64,
    /// Rotation vector of the true sensor in its nominal frame, rad.
    pub angle: Vec3,
}

impl Default for SensorFault {
    fn default() -> Self {
        Self { bias: Vec3::zeros(), scale: 1.0, delay: 0.0, angle: Vec3::zeros() }
    }
}

impl SensorFault {
    /// What the faulty sensor makes of a vector or scalar (in x).
    pub fn apply(&self, value: &Vec3) -> Vec3 {
        if *self == Self::default() {
            return *value;
        }
        exp_rotation(&self.angle).inverse_transform_vector(value) * self.scale + self.bias
    }

    /// What it makes of an orientation.
    pub fn apply_rotation(&self, value: &Rot) -> Rot {
        if self.angle == Vec3::zeros() { *value } else { value * exp_rotation(&self.angle) }
    }
}

/// A value of the world at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A vector; a scalar stands in x.
    Vector(Vec3),
    /// An orientation.
    Rotation(Rot),
}

/// What a recording measured of one quantity.
#[derive(Clone, Debug)]
pub struct Reading {
    /// Channel, without the component where it has several: `body.target.orientation`.
    pub channel: String,
    /// What it is in the world.
    pub quantity: Quantity,
    /// Components that were sampled, of a vector; `[0]` for a scalar, three for an orientation.
    pub axes: Vec<usize>,
    /// Standard deviation of one component, rounding included.
    pub sigma: f64,
    /// Instants, s.
    pub times: Vec<f64>,
    /// Measured values; components that were not sampled are zero.
    pub values: Vec<Value>,
}

impl Reading {
    /// Scalars per sample.
    pub fn width(&self) -> usize {
        self.axes.len()
    }

    /// Name of one component: `sensor.probe.force.x`.
    pub fn component(&self, k: usize) -> String {
        match self.quantity {
            Quantity::JointPosition { .. } | Quantity::JointVelocity { .. } => self.channel.clone(),
            _ => format!("{}.{}", self.channel, ["x", "y", "z"][self.axes[k]]),
        }
    }

    /// Residual of sample `i` in units of noise, written to the front of `out`.
    pub fn write_residual(&self, i: usize, predicted: &Value, out: &mut [f64]) {
        let difference = match (predicted, &self.values[i]) {
            (Value::Vector(p), Value::Vector(m)) => p - m,
            (Value::Rotation(p), Value::Rotation(m)) => log_rotation(&(m.inverse() * p)),
            _ => Vec3::repeat(f64::NAN),
        };
        out.iter_mut().zip(&self.axes).for_each(|(r, &axis)| *r = difference[axis] / self.sigma);
    }
}

/// Reads a kinematic quantity; forces are the sensors' business.
pub fn read_motion(quantity: Quantity, world: &World) -> Value {
    let x = |value: f64| Value::Vector(Vec3::new(value, 0.0, 0.0));
    match quantity {
        Quantity::JointPosition { v, .. } => x(world.motor_side(v).0),
        Quantity::JointVelocity { v, .. } => x(world.motor_side(v).1),
        Quantity::Position(p) => Value::Vector(world.link_frame(p.vehicle, p.link).pos),
        Quantity::Orientation(p) => Value::Rotation(world.link_frame(p.vehicle, p.link).to_pose().rotation),
        Quantity::LinearVelocity(p) => Value::Vector(world.link_twist(p.vehicle, p.link).lin),
        Quantity::AngularVelocity(p) => {
            let frame = world.link_frame(p.vehicle, p.link);
            Value::Vector(frame.rot.tr_mul(&world.link_twist(p.vehicle, p.link).ang))
        }
        Quantity::Force(_) | Quantity::Torque(_) => Value::Vector(Vec3::zeros()),
    }
}
