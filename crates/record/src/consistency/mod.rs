//! Kinematic consistency: a rate channel against the change of its position, whatever the forces.
//!
//! A joint's tachometer is the derivative of its encoder, a gyro that of the orientation, whatever acts on them. What
//! breaks this is a sensor, a unit or a clock. For each pair the sensor model
//!
//!   ω(t) = C (y(t + τ) − b)      y: reading, ω: true rate, C ≈ 1 (3×3; 1×1 for a joint), b: bias, τ: delay
//!
//! is fitted to the measured positions by a filter whose state is the position error (driven by the rate's noise) and
//! whose constants are C, b and τ (`filter`): every figure has its standard error, and the normalised innovations say
//! whether the pair is consistent at all. Signs as in the list of effects: reading = scale · true + bias, the reading at t
//! belongs to t − delay, and the sensor is turned by the rotation vector `angle` in its nominal frame.
//!
//! Kinematics sees differences only. A delay here is the rate's relative to the position's; a turned gyro and a turned
//! attitude sensor look alike; a scale of a gyro is its own, since an orientation has none.

mod filter;
mod pairs;
mod say;
mod start;
mod track;

use crate::RecordingSet;
use filter::{Fit, fit};
use rayon::prelude::*;
use serde::Serialize;

/// A figure and its standard error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The figure.
    pub value: f64,
    /// Standard error.
    pub std_err: f64,
}

impl Estimate {
    /// Distance from a reference in standard errors.
    pub fn z(&self, reference: f64) -> f64 {
        (self.value - reference) / self.std_err
    }
}

/// How a rate channel and the position it should be the derivative of fit together.
#[derive(Clone, Debug, Serialize)]
pub struct Consistency {
    /// The rate's channel or channel prefix: the sensor whose scale, bias, delay and angle are given.
    pub rate: String,
    /// The position's.
    pub position: String,
    /// Whether the position is an orientation.
    pub is_rotation: bool,
    /// Runs that were used.
    pub runs: usize,
    /// Scalar innovations.
    pub samples: usize,
    /// Mean square innovation in units of its expected variance, sensors as they should be; 1: consistent.
    pub misfit: f64,
    /// The same with the fitted sensor.
    pub misfit_fitted: f64,
    /// Fall of the sum of squares by the fit: χ² with [`Self::parameters`] degrees of freedom where nothing is wrong.
    pub gain: f64,
    /// Number of fitted figures.
    pub parameters: usize,
    /// reading = scale · true, per axis; none: the motion does not show it.
    pub scale: Vec<Option<Estimate>>,
    /// Added to the reading, per axis, in the rate's unit.
    pub bias: Vec<Option<Estimate>>,
    /// The reading at t belongs to t − delay, s.
    pub delay: Option<Estimate>,
    /// Rotation vector of the true sensor in its nominal frame, rad.
    pub angle: Option<[Estimate; 3]>,
    /// Whether the fitted sensor is a mirror image: an axis with the wrong sign.
    pub is_mirrored: bool,
    /// C, rows; 1×1 for a joint.
    pub matrix: Vec<Vec<f64>>,
    /// What is wrong, as sentences with figures; empty where the pair is consistent.
    pub findings: Vec<String>,
    /// Whether the findings make the data unfit as they are: units, mirrored axes, clocks.
    pub is_fault: bool,
}

/// Every pair of position and rate of a set. `sigma`: noise of a channel, rounding included; `None` leaves the pair out.
pub fn check(set: &RecordingSet, sigma: &Sigma<'_>) -> Vec<Consistency> {
    pairs::find(set).par_iter().filter_map(|pair| check_pair(set, pair, sigma)).collect()
}

/// Noise of a channel by its name, where it is known.
pub type Sigma<'a> = dyn Fn(&str) -> Option<f64> + Sync + 'a;

fn check_pair(set: &RecordingSet, pair: &pairs::Pair, sigma: &Sigma<'_>) -> Option<Consistency> {
    let noise = pairs::noise(pair, sigma)?;
    let tracks = pairs::tracks(set, pair, &noise);
    if tracks.iter().map(|track| track.times.len()).sum::<usize>() < FEWEST {
        return None;
    }
    let other = start::other_convention(pair, &tracks);
    let fit = fit(pair.axes, &tracks, &noise, start::guess(pair.axes, &tracks));
    let mut found = report(pair, tracks.len(), &fit);
    let (findings, is_fault) = say::findings(&found, other);
    (found.findings, found.is_fault) = (findings, is_fault);
    Some(found)
}

/// Fewest positions that are worth a fit.
const FEWEST: usize = 30;

fn report(pair: &pairs::Pair, runs: usize, fit: &Fit) -> Consistency {
    let d = pair.axes;
    let sensor = fit.model.c.try_inverse();
    let scale = |i: usize| {
        let std_err = fit.std_err_c(i, i)?;
        let s = sensor?[(i, i)];
        Some(Estimate { value: s, std_err: s * s * std_err })
    };
    Consistency {
        rate: pair.rate.clone(),
        position: pair.position.clone(),
        is_rotation: pair.is_rotation,
        runs,
        samples: fit.samples,
        misfit: fit.before / fit.samples.max(1) as f64,
        misfit_fitted: fit.after / fit.samples.max(1) as f64,
        gain: fit.before - fit.after,
        parameters: fit.parameters(),
        scale: (0..d).map(scale).collect(),
        bias: (0..d).map(|i| Some(Estimate { value: fit.model.b[i], std_err: fit.std_err_b(i)? })).collect(),
        delay: fit.std_err_tau().map(|std_err| Estimate { value: fit.model.tau, std_err }),
        angle: if pair.is_rotation { fit.angle() } else { None },
        is_mirrored: fit.model.c.determinant() < 0.0,
        matrix: (0..d).map(|i| (0..d).map(|j| fit.model.c[(i, j)]).collect()).collect(),
        findings: Vec::new(),
        is_fault: false,
    }
}
