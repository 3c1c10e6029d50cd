//! Readings: what a recording measured, and what the simulated world says at the same instant.
//!
//! A reading is a scalar, some components of a vector that were sampled together, or an orientation. Its residual is
//!
//!   r = (predicted − measured)/σ,    of an orientation r = log(q_measured⁻¹ q_predicted)/σ  (three components, body axes)
//!
//! with σ² = σ_sensor² + q²/12, q the written rounding. A faulty sensor reads
//!
//!   y(t) = scale · exp(angle)ᵀ x(t − delay) + bias,    an orientation q(t − delay) exp(angle).

use scenario::measure::Quantity;
use spatial::{Rot, Vec3, log_rotation};

/// A value, with a scalar in x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A vector.
    Vector(Vec3),
    /// An orientation.
    Rotation(Rot),
}

impl Value {
    /// The scalar, of an orientation no number.
    pub(crate) fn scalar(&self) -> f64 {
        match self {
            Self::Vector(v) => v.x,
            Self::Rotation(_) => f64::NAN,
        }
    }
}

impl From<scenario::measure::Reading> for Value {
    fn from(reading: scenario::measure::Reading) -> Self {
        match reading {
            scenario::measure::Reading::Scalar(x) => Self::Vector(Vec3::new(x, 0.0, 0.0)),
            scenario::measure::Reading::Vector(v) => Self::Vector(v),
            scenario::measure::Reading::Rotation(q) => Self::Rotation(q),
        }
    }
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
    /// What of it is rounding: there is no less noise.
    pub rounding: f64,
    /// Instants, s.
    pub times: Vec<f64>,
    /// Measured values; components that were not sampled are zero.
    pub values: Vec<Value>,
    /// What a stamp that is off by its standard deviation does to each sample, units of noise, axes as of a residual; nothing where stamps are right.
    pub blur: Vec<Vec3>,
    /// How late its sensor was found to be, s: what is read so soon after the begin of a window tells of what was before it, and is not judged.
    pub late_s: f64,
}

impl Reading {
    /// Whether it is an orientation.
    pub fn is_orientation(&self) -> bool {
        self.quantity.is_orientation()
    }

    /// Scalars per sample.
    pub fn width(&self) -> usize {
        self.axes.len()
    }

    /// Name of one component: `sensor.probe.force.x`.
    pub fn component(&self, k: usize) -> String {
        match self.quantity {
            quantity if quantity.is_joint() => self.channel.clone(),
            _ => format!("{}.{}", self.channel, ["x", "y", "z"][self.axes[k]]),
        }
    }

    /// Instants at which a component is off zero by more than so many standard deviations, s.
    pub(crate) fn loud(&self, sigmas: f64) -> impl Iterator<Item = f64> + '_ {
        let is_loud = move |v: &Value| matches!(v, Value::Vector(v) if v.amax() > sigmas * self.sigma);
        self.times.iter().zip(&self.values).filter(move |(_, v)| is_loud(v)).map(|(t, _)| *t)
    }

    /// Some of its samples, with all that belongs to each.
    pub(crate) fn of_samples(&self, samples: &[usize]) -> Self {
        let blur = if self.blur.is_empty() { Vec::new() } else { samples.iter().map(|i| self.blur[*i]).collect() };
        let (times, values) = samples.iter().map(|i| (self.times[*i], self.values[*i])).unzip();
        Self {
            channel: self.channel.clone(),
            quantity: self.quantity,
            axes: self.axes.clone(),
            sigma: self.sigma,
            rounding: self.rounding,
            times,
            values,
            blur,
            late_s: self.late_s,
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
        if let Some(blur) = self.blur.get(i) {
            whiten(out, &self.axes, blur);
        }
    }
}

/// Residuals of covariance 1 + b bᵀ made white: along b they are less sure.
fn whiten(residual: &mut [f64], axes: &[usize], blur: &Vec3) {
    let square: f64 = axes.iter().map(|&axis| blur[axis].powi(2)).sum();
    if square > 0.0 {
        let along: f64 = residual.iter().zip(axes).map(|(r, &axis)| r * blur[axis]).sum();
        let by = along / square * (1.0 - (1.0 + square).sqrt().recip());
        residual.iter_mut().zip(axes).for_each(|(r, &axis)| *r -= by * blur[axis]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stamp_that_is_off_makes_a_sample_less_sure_along_its_motion_only() {
        let (axes, blur) = ([0, 2], Vec3::new(3.0, 7.0, 4.0));
        let mut along = [3.0, 4.0];
        whiten(&mut along, &axes, &blur);
        let expected = 5.0 / 26f64.sqrt();
        assert!((along[0] - 0.6 * expected).abs() < 1e-12 && (along[1] - 0.8 * expected).abs() < 1e-12, "{along:?}");
        let mut across = [4.0, -3.0];
        whiten(&mut across, &axes, &blur);
        assert!((across[0] - 4.0).abs() < 1e-12 && (across[1] + 3.0).abs() < 1e-12);
    }

    #[test]
    fn what_is_loud_is_so_in_any_component_and_either_sign() {
        let force = |y: f64| Value::Vector(Vec3::new(0.1, y, 0.0));
        let reading = Reading {
            channel: "sensor.probe.force".to_owned(),
            quantity: Quantity::JointPosition(0),
            axes: vec![0, 1],
            sigma: 0.05,
            times: vec![0.0, 1.0, 2.0, 3.0],
            values: vec![force(0.0), force(-0.4), force(0.2), force(9.0)],
            rounding: 0.0,
            blur: Vec::new(),
            late_s: 0.0,
        };
        assert_eq!(reading.loud(6.0).collect::<Vec<_>>(), [1.0, 3.0]);
    }
}
