//! A first guess of the state at an instant, from the samples around it.
//!
//! A parabola through the nearest samples of each component gives value and rate at the instant; of an orientation, through the rotation
//! vectors from the nearest sample. It goes through as many samples as it fits within their noise: an approach before an impact is known the
//! better the longer it was watched. What nothing measures stays as the scenario has it.

use crate::plant::Built;
use crate::reading::{Reading, Value};
use crate::start::Start;
use crate::tape::Tape;
use nalgebra::{Matrix3, Vector3};
use scenario::measure::Quantity;
use spatial::{Pose, Rot, Twist, Vec3, exp_rotation, log_rotation};

/// Samples that a guess looks at, at least and at most.
const NEAREST: [usize; 2] = [15, 480];
/// Standard deviations of the mean square up to which a parabola fits.
const FITTING: f64 = 3.0;

/// The start of a replay at `time`, guessed.
pub fn guess(built: &Built, tape: &Tape, time: f64) -> Start {
    let mut start = Start { time, ..Start::nominal(built) };
    for (v, vehicle) in built.model.vehicles.iter().enumerate().filter(|(_, v)| !v.base.is_held()) {
        let of_base = |of: usize, link: usize| of == v && link == 0;
        let nominal = start.bases[v];
        guess_base(&mut start, v, tape, time, of_base);
        let mask = vehicle.base.mask();
        start.bases[v] = guided(&start.bases[v], &nominal, &mask);
        mask_twist(&mut start.twists[v], &mask);
    }
    let is_read = |quantity: Quantity| tape.readings.iter().any(|r| r.quantity == quantity);
    for reading in &tape.readings {
        match reading.quantity {
            // The state has the link side; the motor side stands for it where nothing else is read.
            Quantity::JointPosition(v) if is_read(Quantity::JointLinkPosition(v)) => {}
            Quantity::JointVelocity(v) if is_read(Quantity::JointLinkVelocity(v)) => {}
            Quantity::JointPosition(v) | Quantity::JointLinkPosition(v) => {
                let (x, rate) = fit_vector(reading, time);
                start.q[built.model.coordinates[v].q_index] = x.x;
                if ![Quantity::JointVelocity(v), Quantity::JointLinkVelocity(v)].into_iter().any(is_read) {
                    start.v[v] = rate.x;
                }
            }
            Quantity::JointVelocity(v) | Quantity::JointLinkVelocity(v) => start.v[v] = fit_vector(reading, time).0.x,
            _ => {}
        }
    }
    if time > tape.span.0 {
        start.still = (0..start.bases.len()).map(|v| calc_still(v, tape, time)).collect();
        let measured: Vec<Option<Twist>> =
            (0..built.model.vehicles.len()).map(|v| acceleration(v, tape, time)).collect();
        start.free_bristles(built, tape.index, &measured);
    }
    start
}

/// Speed below which a base is still, m/s, and the time over which it is told, s.
const STILL: f64 = 1e-3;
const LAG: f64 = 0.03;

/// How long a base has been still at an instant, as far as its measured place tells, s.
fn calc_still(v: usize, tape: &Tape, time: f64) -> f64 {
    let place = tape.readings.iter().find(|r| r.quantity == Quantity::Position(v, 0));
    let Some(place) = place else { return 0.0 };
    let value = |i: usize| match place.values[i] {
        Value::Vector(x) => x,
        Value::Rotation(_) => Vec3::zeros(),
    };
    let end = place.times.partition_point(|t| *t <= time);
    let moved = (0..end).rev().find(|i| {
        let t = place.times[*i];
        let before = place.times[..*i].partition_point(|s| *s <= t - LAG);
        before > 0 && (value(*i) - value(before - 1)).norm() > STILL * (t - place.times[before - 1])
    });
    // It has come to rest where the stretch that still shows a way begins.
    time - moved.map_or(tape.span.0, |i| place.times[i] - LAG)
}

fn guess_base(start: &mut Start, v: usize, tape: &Tape, time: f64, of_base: impl Fn(usize, usize) -> bool) {
    for reading in &tape.readings {
        match reading.quantity {
            Quantity::Position(of, link) if of_base(of, link) => {
                let (x, rate) = fit_vector(reading, time);
                for &axis in &reading.axes {
                    start.bases[v].translation.vector[axis] = x[axis];
                    start.twists[v].lin[axis] = rate[axis];
                }
            }
            Quantity::Orientation(of, link) if of_base(of, link) => {
                let (rot, rate) = fit_rotation(reading, time);
                start.bases[v].rotation = rot;
                start.twists[v].ang = rate;
            }
            _ => {}
        }
    }
    for reading in &tape.readings {
        match reading.quantity {
            Quantity::LinearVelocity(of, link) if of_base(of, link) => {
                let (x, _) = fit_vector(reading, time);
                reading.axes.iter().for_each(|&axis| start.twists[v].lin[axis] = x[axis]);
            }
            Quantity::AngularVelocity(of, link) if of_base(of, link) && reading.axes.len() == 3 => {
                start.twists[v].ang = start.bases[v].rotation * fit_vector(reading, time).0;
            }
            _ => {}
        }
    }
}

/// Acceleration of a base by the curvature of its measured path; `None` where nothing measures its place.
fn acceleration(v: usize, tape: &Tape, time: f64) -> Option<Twist> {
    let mut found = None;
    for reading in tape.readings.iter().filter(|r| r.quantity == Quantity::Position(v, 0)) {
        let ([_, _, curvature], _) = longest_parabola(reading, time);
        let twist: &mut Twist = found.get_or_insert_with(Twist::default);
        reading.axes.iter().for_each(|&axis| twist.lin[axis] = 2.0 * curvature[axis]);
    }
    found
}

/// A measured pose on the guide that holds some of its components where they are nominally: off it a base would stay for the whole replay,
/// by what noise made of the samples around the instant.
fn guided(measured: &Pose, nominal: &Pose, mask: &[bool; 6]) -> Pose {
    let turn = log_rotation(&(measured.rotation * nominal.rotation.inverse()));
    let way = measured.translation.vector - nominal.translation.vector;
    let free = |v: &Vec3, first: usize| Vec3::from_fn(|axis, _| if mask[first + axis] { v[axis] } else { 0.0 });
    let place = nominal.translation.vector + free(&way, 3);
    Pose::from_parts(place.into(), exp_rotation(&free(&turn, 0)) * nominal.rotation)
}

/// The components of a twist that a guide holds are zero.
fn mask_twist(twist: &mut Twist, mask: &[bool; 6]) {
    for axis in 0..3 {
        if !mask[axis] {
            twist.ang[axis] = 0.0;
        }
        if !mask[3 + axis] {
            twist.lin[axis] = 0.0;
        }
    }
}

/// The samples nearest to an instant.
fn nearest(times: &[f64], time: f64, count: usize) -> std::ops::Range<usize> {
    let at = times.partition_point(|t| *t < time);
    let first = at.saturating_sub(count / 2).min(times.len().saturating_sub(count));
    first..(first + count).min(times.len())
}

/// Coefficients about `time` of the parabola through as many of the nearest samples as it fits, and the orientation that rotation vectors
/// are counted from.
fn longest_parabola(reading: &Reading, time: f64) -> ([Vec3; 3], Rot) {
    let centre = match reading.values[nearest(&reading.times, time, 1).start] {
        Value::Rotation(q) => q,
        Value::Vector(_) => Rot::identity(),
    };
    let mut best = None;
    let mut count = NEAREST[0];
    while count <= NEAREST[1] && (best.is_none() || count <= reading.times.len()) {
        let range = nearest(&reading.times, time, count);
        let value = |i: usize| match reading.values[i] {
            Value::Vector(v) => v,
            Value::Rotation(q) => log_rotation(&(q * centre.inverse())),
        };
        let times = &reading.times[range.clone()];
        let Some(c) = parabola(times, range.clone().map(value), time) else {
            let sum = range.clone().map(value).fold(Vec3::zeros(), |sum, v| sum + v);
            return (best.unwrap_or([sum / range.len().max(1) as f64, Vec3::zeros(), Vec3::zeros()]), centre);
        };
        let miss = |i: usize| {
            let x = reading.times[i] - time;
            (value(i) - c[0] - c[1] * x - c[2] * (x * x)).norm_squared() / reading.sigma.powi(2)
        };
        let scalars = (reading.width() * range.len()) as f64;
        let fits = range.clone().map(miss).sum::<f64>() < scalars + FITTING * (2.0 * scalars).sqrt();
        if !fits && best.is_some() {
            break;
        }
        best = Some(c);
        count *= 2;
    }
    (best.unwrap_or([Vec3::zeros(); 3]), centre)
}

/// Value and rate at `time`.
fn fit_vector(reading: &Reading, time: f64) -> (Vec3, Vec3) {
    let ([value, rate, _], _) = longest_parabola(reading, time);
    (value, rate)
}

fn fit_rotation(reading: &Reading, time: f64) -> (Rot, Vec3) {
    let ([phi, rate, _], centre) = longest_parabola(reading, time);
    (exp_rotation(&phi) * centre, rate)
}

/// Coefficients of the parabola through some samples, about `time`; `None` of too few.
fn parabola(times: &[f64], values: impl Iterator<Item = Vec3>, time: f64) -> Option<[Vec3; 3]> {
    let width = times.iter().map(|t| (t - time).abs()).fold(1e-12, f64::max);
    let (mut a, mut b) = (Matrix3::zeros(), Matrix3::zeros());
    for (t, value) in times.iter().zip(values) {
        let x = (t - time) / width;
        let basis = Vector3::new(1.0, x, x * x);
        a += basis * basis.transpose();
        b += basis * value.transpose();
    }
    let c = (times.len() >= 6).then(|| a.try_inverse()).flatten()? * b;
    Some([c.row(0).transpose(), c.row(1).transpose() / width, c.row(2).transpose() / (width * width)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use record::Role;

    /// It slides at 20 mm/s until 1 s and rests from there; the readings are off by 5 µm one way and the other.
    fn slide() -> Tape {
        let times: Vec<f64> = (0..500).map(|i| f64::from(i) * 0.004).collect();
        let noise = |i: usize| if i.is_multiple_of(2) { 5e-6 } else { -5e-6 };
        let value = |(i, t): (usize, &f64)| Value::Vector(Vec3::new(0.02 * t.min(1.0) + noise(i), 0.0, 0.0));
        let values = times.iter().enumerate().map(value).collect();
        let reading = Reading {
            channel: "body.slider.position".to_owned(),
            quantity: Quantity::Position(0, 0),
            axes: vec![0, 1],
            sigma: 5e-6,
            times,
            values,
            rounding: 0.0,
            blur: Vec::new(),
            late_s: 0.0,
        };
        Tape {
            index: 0,
            file: String::new(),
            role: Role::Fit,
            commands: Vec::new(),
            readings: vec![reading],
            events: Vec::new(),
            offsets: Vec::new(),
            ticks: Vec::new(),
            span: (0.0, 2.0),
            rate: 10.0,
            coarser: Vec::new(),
        }
    }

    #[test]
    fn a_guess_lies_on_the_guide() {
        let nominal = Pose::from_parts(Vec3::new(1.0, 2.0, 0.25).into(), exp_rotation(&Vec3::new(0.0, 0.0, 0.3)));
        let noise = exp_rotation(&Vec3::new(4e-4, -3e-4, 0.0));
        let measured =
            Pose::from_parts(Vec3::new(1.5, 2.5, 0.2502).into(), noise * exp_rotation(&Vec3::new(0.0, 0.0, 0.8)));
        let found = guided(&measured, &nominal, &[false, false, true, true, true, false]);
        assert_eq!(found.translation.vector, Vec3::new(1.5, 2.5, 0.25));
        // The tilt's square is in the turn.
        assert!((found.rotation.scaled_axis() - Vec3::new(0.0, 0.0, 0.8)).norm() < 1e-6, "{}", found.rotation);
        assert!((guided(&measured, &nominal, &[true; 6]).rotation.angle_to(&measured.rotation)) < 1e-12);
    }

    #[test]
    fn how_long_it_has_rested_is_told_by_its_measured_place() {
        let tape = slide();
        // Two samples: what noise of that size may move the edge of a stretch.
        assert!((calc_still(0, &tape, 1.6) - 0.6).abs() < 0.008, "{}", calc_still(0, &tape, 1.6));
        assert!(calc_still(0, &tape, 0.9) < LAG + 0.008, "it slides");
        assert_eq!(calc_still(1, &tape, 1.6), 0.0, "nothing measures the other one");
    }
}
