//! Where the fit starts: near the ideal sensor, or far from it where units, axes or conventions are wrong.
//!
//! Mean readings over some seconds against changes of position, by least squares: crude, but it finds 57.3, −1 or an
//! exchange of axes, from where the filter converges.

use super::filter::Model;
use super::pairs::Pair;
use super::track::{Measured, Track};
use spatial::nalgebra::{DMatrix, DVector};
use spatial::{Mat3, Rot, Vec3, log_rotation};

/// Windows per run.
const WINDOWS: usize = 60;
/// Largest turn in a window that its rotation vector stands for, rad.
const TURN: f64 = 1.0;
/// Share of the readings' variance that the crude law must explain before it is believed.
const BELIEVED: f64 = 0.8;
/// Distance from the ideal sensor, but for its size, within which a convention is taken for the right one.
const NEAR: f64 = 0.4;
/// Distance from the ideal sensor from which the crude law is the better start.
const FAR: f64 = 0.1;

/// A window: mean rate from positions, mean reading.
type Window = (Vec3, Vec3);

/// How a quaternion is to be read, whether the rate is in world axes, and what is then to be said.
type Convention = (fn(Rot) -> Rot, bool, &'static str);

/// The start of the fit.
pub(super) fn guess(axes: usize, tracks: &[Track]) -> Model {
    let ideal = Model::IDEAL;
    let Some((sensor, bias, explained)) = regress(axes, &windows(tracks, |q| q, false)) else { return ideal };
    let is_far = (sensor - Mat3::identity()).norm() > FAR;
    match sensor.try_inverse() {
        Some(c) if is_far && explained > BELIEVED && sensor.determinant().abs() > 1e-12 => {
            // reading = S ω + b, so that ω = S⁻¹ (reading − b).
            Model { c, b: bias, tau: 0.0 }
        }
        _ => ideal,
    }
}

/// The convention that fits an orientation and its gyro much better than the format's, if one does.
pub(super) fn other_convention(pair: &Pair, tracks: &[Track]) -> Option<&'static str> {
    if !pair.is_rotation {
        return None;
    }
    // A sensor as it should be, but for its unit and some misalignment.
    let fits = |turn: fn(Rot) -> Rot, world: bool| {
        let Some((sensor, _, explained)) = regress(3, &windows(tracks, turn, world)) else { return false };
        let size = sensor.determinant().cbrt();
        explained > BELIEVED && size > 0.0 && (sensor / size - Mat3::identity()).norm() < NEAR
    };
    if fits(|q| q, false) {
        return None;
    }
    let others: [Convention; 3] = [
        (
            |q| q.inverse(),
            false,
            "the quaternion seems to rotate world vectors into the body frame: invert it (negate x, y, z)",
        ),
        (|q| q, true, "the angular velocity seems to be in world axes: the format wants it in the body frame"),
        (last_first, false, "the quaternion's components seem to be in the order x, y, z, w: map the columns anew"),
    ];
    others.into_iter().find(|(turn, world, _)| fits(*turn, *world)).map(|(_, _, what)| what)
}

fn last_first(q: Rot) -> Rot {
    // Read as w, x, y, z, written as x, y, z, w.
    Rot::new_normalize(spatial::nalgebra::Quaternion::new(q.k, q.w, q.i, q.j))
}

fn windows(tracks: &[Track], turn: fn(Rot) -> Rot, in_world: bool) -> Vec<Window> {
    let mut windows = Vec::new();
    for track in tracks {
        // Readings between two positions may be few: a window is as long as ten of them at least.
        let span = track.times[track.times.len() - 1] - track.times[0];
        let wanted = (span / WINDOWS as f64).max(10.0 * track.step);
        let mut from = 0;
        for to in 1..track.times.len() {
            if track.times[to] - track.times[from] >= wanted {
                windows.extend(window(track, (from, to), turn, in_world));
                from = to;
            }
        }
    }
    windows
}

fn window(track: &Track, (from, to): (usize, usize), turn: fn(Rot) -> Rot, in_world: bool) -> Option<Window> {
    let dt = track.times[to] - track.times[from];
    let change = match &track.measured {
        Measured::Vector(p) => p[to] - p[from],
        Measured::Rotation(q) => {
            let (a, b) = (turn(q[from]), turn(q[to]));
            log_rotation(&if in_world { b * a.inverse() } else { a.inverse() * b })
        }
    };
    if matches!(track.measured, Measured::Rotation(_)) && change.norm() > TURN {
        return None;
    }
    let first = track.rate_times.partition_point(|t| *t < track.times[from]);
    let last = track.rate_times.partition_point(|t| *t <= track.times[to]);
    let readings = track.rates.get(first..last).filter(|readings| !readings.is_empty())?;
    Some((change / dt, readings.iter().sum::<Vec3>() / readings.len() as f64))
}

/// Axes about which the positions move, beside the one that moves most.
fn moving(axes: usize, windows: &[Window]) -> [bool; 3] {
    const SHARE: f64 = 0.2;
    let square = |j: usize| windows.iter().map(|w| w.0[j] * w.0[j]).sum::<f64>();
    let most = (0..axes).map(square).fold(0.0, f64::max);
    std::array::from_fn(|j| j < axes && square(j) > SHARE * SHARE * most)
}

/// Least squares of reading = S rate + b; the share of the readings' variance that it explains.
fn regress(axes: usize, windows: &[Window]) -> Option<(Mat3, Vec3, f64)> {
    if windows.len() < 4 * (axes + 1) {
        return None;
    }
    let regressor = |w: &Window| DVector::from_fn(axes + 1, |i, _| if i < axes { w.0[i] } else { 1.0 });
    let mut normal = DMatrix::zeros(axes + 1, axes + 1);
    let mut right = DMatrix::zeros(axes + 1, axes);
    for w in windows {
        let x = regressor(w);
        normal += &x * x.transpose();
        right += &x * DVector::from_fn(axes, |i, _| w.1[i]).transpose();
    }
    let ridge = 1e-9 * normal.diagonal().iter().take(axes).copied().fold(0.0, f64::max);
    (0..axes).for_each(|i| normal[(i, i)] += ridge);
    let kept = moving(axes, windows);
    for j in (0..axes).filter(|j| !kept[*j]) {
        // An axis about which nothing moves says nothing: its column is held at 0 here and filled in below.
        normal[(j, j)] += 1e9 * normal.diagonal().max().max(1.0);
    }
    let solution = normal.try_inverse()? * right;
    let mean = windows.iter().map(|w| w.1).sum::<Vec3>() / windows.len() as f64;
    let (mut rest, mut all) = (0.0, 0.0);
    for w in windows {
        let predicted = solution.transpose() * regressor(w);
        rest += (0..axes).map(|i| (w.1[i] - predicted[i]).powi(2)).sum::<f64>();
        all += (0..axes).map(|i| (w.1[i] - mean[i]).powi(2)).sum::<f64>();
    }
    let mut sensor = Mat3::identity();
    let mut bias = Vec3::zeros();
    for i in 0..axes {
        (0..axes).for_each(|j| sensor[(i, j)] = solution[(j, i)]);
        bias[i] = solution[(axes, i)];
    }
    let moving: Vec<usize> = (0..axes).filter(|j| kept[*j]).collect();
    let size = moving.iter().map(|j| sensor.column(*j).norm()).sum::<f64>() / moving.len().max(1) as f64;
    (0..axes).filter(|j| !kept[*j]).for_each(|j| sensor.set_column(j, &(Vec3::ith(j, size))));
    (all > 0.0).then(|| (sensor, bias, 1.0 - rest / all))
}
