//! One coordinate of a prescribed motion, as a function of time.
//!
//! | kind | motion |
//! | --- | --- |
//! | sine | A sin(2π f t + φ) |
//! | ramp | rate · t from t = 0 |
//! | through points | the cubic spline through them, at rest at both ends: twice differentiable |
//! | recorded | the smoothing spline of a noisy recording ([`DrivePath::smoothed`]) |
//!
//! Before its first and after its last point a path goes on with the velocity that it has there.

use super::smooth::smooth;

/// Position, velocity and acceleration of a coordinate; m or rad.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// m or rad.
    pub position: f64,
    /// Its rate.
    pub velocity: f64,
    /// Its rate's rate.
    pub acceleration: f64,
}

/// One coordinate of a prescribed motion.
#[derive(Clone, Debug, PartialEq)]
pub struct DrivePath {
    form: Form,
}

#[derive(Clone, Debug, PartialEq)]
enum Form {
    Sine { amplitude: f64, rate: f64, phase: f64 },
    Ramp { rate: f64 },
    Pieces(Pieces),
}

/// Polynomials of the fifth degree between knots, in the time since the knot.
#[derive(Clone, Debug, PartialEq)]
struct Pieces {
    knots: Vec<f64>,
    polynomials: Vec<[f64; 6]>,
    last: Motion,
    /// Pieces per second, where all are equally long.
    pace: Option<f64>,
}

impl DrivePath {
    /// amplitude · sin(2π frequency t + phase); frequency in Hz, phase in rad.
    pub fn sine(amplitude: f64, frequency: f64, phase: f64) -> Self {
        Self { form: Form::Sine { amplitude, rate: std::f64::consts::TAU * frequency, phase } }
    }

    /// rate · t, at rest before t = 0.
    pub fn ramp(rate: f64) -> Self {
        Self { form: Form::Ramp { rate } }
    }

    /// The cubic spline through points (s, value) in the order of time, at rest at both ends. Points that repeat a time,
    /// or are not finite, are left out; without any it stands at zero.
    pub fn through(points: &[[f64; 2]]) -> Self {
        let (times, values) = sieved(points.iter().map(|p| (p[0], p[1])));
        let slopes = calc_spline_slopes(&times, &values);
        let knot = |i: usize| (times[i], values[i], slopes[i]);
        let mut polynomials: Vec<_> = (1..times.len()).map(|i| cubic(knot(i - 1), knot(i))).collect();
        if let [alone] = values[..] {
            polynomials.push([alone, 0.0, 0.0, 0.0, 0.0, 0.0]);
        }
        Self { form: Form::Pieces(Pieces::new(times, polynomials)) }
    }

    /// The motion behind noisy samples: their smoothing spline, whose stiffness is the most likely one. `noise` is the
    /// standard deviation of a sample where it is known; else it is estimated with the stiffness. Samples that are not
    /// finite count as missing. Theory: `smooth`.
    pub fn smoothed(times: &[f64], values: &[f64], noise: Option<f64>) -> Self {
        let (times, values) = sieved(times.iter().copied().zip(values.iter().copied()));
        if times.len() < FEWEST {
            let points: Vec<_> = times.iter().zip(&values).map(|(t, x)| [*t, *x]).collect();
            return Self::through(&points);
        }
        let states = smooth(&times, &values, noise);
        let polynomials =
            (1..times.len()).map(|i| quintic(times[i] - times[i - 1], &states[i - 1], &states[i])).collect();
        Self { form: Form::Pieces(Pieces::new(times, polynomials)) }
    }

    /// Where it is and how it moves at a time.
    #[inline]
    pub fn eval(&self, time: f64) -> Motion {
        match &self.form {
            Form::Pieces(pieces) => pieces.eval(time),
            Form::Sine { amplitude, rate, phase } => {
                let (sin, cos) = (rate * time + phase).sin_cos();
                Motion {
                    position: amplitude * sin,
                    velocity: amplitude * rate * cos,
                    acceleration: -amplitude * rate * rate * sin,
                }
            }
            Form::Ramp { rate } if time >= 0.0 => {
                Motion { position: rate * time, velocity: *rate, ..Motion::default() }
            }
            Form::Ramp { .. } => Motion::default(),
        }
    }
}

/// Fewest samples that can be smoothed; fewer are taken as exact.
const FEWEST: usize = 8;

/// Finite points of strictly increasing time.
fn sieved(points: impl Iterator<Item = (f64, f64)>) -> (Vec<f64>, Vec<f64>) {
    let (mut times, mut values) = (Vec::new(), Vec::new());
    for (t, x) in points.filter(|(t, x)| t.is_finite() && x.is_finite()) {
        if times.last().is_none_or(|last| t > *last) {
            times.push(t);
            values.push(x);
        }
    }
    (times, values)
}

/// Slopes at the knots of the cubic spline at rest at both ends: tridiagonal, diagonally dominant.
fn calc_spline_slopes(times: &[f64], values: &[f64]) -> Vec<f64> {
    let n = times.len();
    let mut slopes = vec![0.0; n];
    let mut factors = vec![0.0; n];
    for i in 1..n.saturating_sub(1) {
        let (left, right) = (1.0 / (times[i] - times[i - 1]), 1.0 / (times[i + 1] - times[i]));
        let (rise_left, rise_right) = ((values[i] - values[i - 1]) * left, (values[i + 1] - values[i]) * right);
        let pivot = 2.0 * (left + right) - left * factors[i - 1];
        factors[i] = right / pivot;
        slopes[i] = (3.0 * (left * rise_left + right * rise_right) - left * slopes[i - 1]) / pivot;
    }
    for i in (1..n.saturating_sub(1)).rev() {
        slopes[i] -= factors[i] * slopes[i + 1];
    }
    slopes
}

/// The cubic with given values and slopes at both ends.
fn cubic((t0, x0, v0): (f64, f64, f64), (t1, x1, v1): (f64, f64, f64)) -> [f64; 6] {
    let h = t1 - t0;
    let rise = (x1 - x0) / h;
    [x0, v0, (3.0 * rise - 2.0 * v0 - v1) / h, (v0 + v1 - 2.0 * rise) / (h * h), 0.0, 0.0]
}

/// The quintic with given positions, velocities and accelerations at both ends.
fn quintic(h: f64, start: &[f64; 3], end: &[f64; 3]) -> [f64; 6] {
    let ([x0, v0, a0], [x1, v1, a1]) = (*start, *end);
    // What is left at the end of the parabola from the start, per its power of the length.
    let x = (x1 - x0 - h * (v0 + 0.5 * h * a0)) / (h * h * h);
    let v = (v1 - v0 - h * a0) / (h * h);
    let a = (a1 - a0) / h;
    [
        x0,
        v0,
        0.5 * a0,
        10.0 * x - 4.0 * v + 0.5 * a,
        (7.0 * v - 15.0 * x - a) / h,
        (6.0 * x - 3.0 * v + 0.5 * a) / (h * h),
    ]
}

impl Pieces {
    fn new(knots: Vec<f64>, polynomials: Vec<[f64; 6]>) -> Self {
        let length = knots.len().checked_sub(2).map_or(0.0, |i| knots[i + 1] - knots[i]);
        let last = polynomials.last().map_or(Motion::default(), |piece| eval(piece, length));
        let pace = calc_pace(&knots);
        Self { last: Motion { acceleration: 0.0, ..last }, knots, polynomials, pace }
    }

    fn eval(&self, time: f64) -> Motion {
        let (Some(first), Some(end)) = (self.knots.first(), self.knots.last()) else { return Motion::default() };
        if time < *first {
            let start = eval(&self.polynomials[0], 0.0);
            return going_on(start, time - first);
        }
        if time > *end {
            return going_on(self.last, time - end);
        }
        let index = match self.pace {
            Some(pace) => self.near(((time - first) * pace) as usize, time),
            None => (self.knots.partition_point(|t| *t <= time) - 1).min(self.polynomials.len() - 1),
        };
        eval(&self.polynomials[index], time - self.knots[index])
    }

    /// The piece that holds a time, when rounding may have missed it by one.
    fn near(&self, index: usize, time: f64) -> usize {
        let mut index = index.min(self.polynomials.len() - 1);
        while index > 0 && self.knots[index] > time {
            index -= 1;
        }
        while index + 1 < self.polynomials.len() && self.knots[index + 1] <= time {
            index += 1;
        }
        index
    }
}

/// Motion on with constant velocity.
fn going_on(from: Motion, elapsed: f64) -> Motion {
    Motion { position: from.position + elapsed * from.velocity, acceleration: 0.0, ..from }
}

/// Pieces per second, where every knot is within a tenth of a piece of an even pace.
fn calc_pace(knots: &[f64]) -> Option<f64> {
    let (first, last) = (knots.first()?, knots.last().filter(|_| knots.len() > 1)?);
    let length = (last - first) / (knots.len() - 1) as f64;
    let even = |(i, t): (usize, &f64)| (t - first - i as f64 * length).abs() < 0.1 * length;
    knots.iter().enumerate().all(even).then_some(1.0 / length)
}

#[inline]
fn eval(c: &[f64; 6], t: f64) -> Motion {
    Motion {
        position: c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5])))),
        velocity: c[1] + t * (2.0 * c[2] + t * (3.0 * c[3] + t * (4.0 * c[4] + t * (5.0 * c[5])))),
        acceleration: 2.0 * c[2] + t * (6.0 * c[3] + t * (12.0 * c[4] + t * (20.0 * c[5]))),
    }
}
