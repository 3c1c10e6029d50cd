//! The recorded tosses: poses, free flight, first impact, and where a simulation starts.
//!
//! A cube is thrown onto a table and tracked at 148 Hz. What the recording itself gets wrong is measured on it and kept
//! apart from contact ([`Correction`]): bodies in free flight fall at 9.6 m/s², and the cube rests 1.2 mm too low.
//!
//! W: z up, table near z = 0. B: the cube's axes, origin at its centre. The three moments are equal, so a cube in
//! free flight turns about a fixed axis in W at a constant rate: R(t) = exp(ω t) R₀.

use super::{RealError, Table};
use spatial::nalgebra::{DMatrix, DVector};
use spatial::{Pose, Rot, Twist, Vec3, exp_rotation, log_rotation};
use std::path::Path;

/// Edge of the cube, m.
pub const WIDTH: f64 = 0.1048;
/// Its mass, kg.
pub const MASS: f64 = 0.37;
/// Its moment of inertia about every axis through the centre, kg·m².
pub const MOMENT: f64 = 8.1e-4;
/// Samples per second.
pub const RATE: f64 = 148.0;
/// Height of the lowest corner above z = 0, m, from which on tracking may know of the impact.
const CLEAR: f64 = 0.010;
/// Samples (47 ms) that count as "just after" the first impact.
const AFTER: usize = 7;

/// Where a simulation starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Pose W←B.
    pub pose: Pose,
    /// Velocities in W axes, about the centre.
    pub twist: Twist,
}

/// One toss.
#[derive(Clone, Debug)]
pub struct Toss {
    /// Poses W←B, one per sample.
    pub poses: Vec<Pose>,
    /// The first sample as it stands.
    pub recorded: Start,
    /// Samples in free flight, from the first.
    pub free: usize,
    /// Sample of the first impact: a corner reaches z = 0.
    pub impact: usize,
}

/// What the recording says of gravity and table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correction {
    /// Gravity, m/s², downwards.
    pub gravity: f64,
    /// Height of the table, m.
    pub table: f64,
}

impl Correction {
    /// Nothing corrected.
    pub const NONE: Self = Self { gravity: 9.81, table: 0.0 };

    /// Gravity of the free flights (parabolas, weighted by how well their length tells it), height of the rests.
    pub fn measure(tosses: &[Toss]) -> Self {
        let (mut sum, mut weight) = (0.0, 0.0);
        for toss in tosses.iter().filter(|t| t.free >= 6) {
            let n = toss.free;
            let heights = DVector::from_fn(n, |k, _| toss.poses[k].translation.z);
            if let Some(parabola) = solve_powers(n, 3, &heights) {
                let w = (n as f64).powi(5);
                (sum, weight) = (sum - 2.0 * parabola[2] * w, weight + w);
            }
        }
        let rests: f64 = tosses.iter().map(|t| t.poses[t.poses.len() - 1].translation.z).sum();
        Self { gravity: sum / weight, table: rests / tosses.len() as f64 - 0.5 * WIDTH }
    }
}

/// Coefficients of the polynomial in time (`terms` of them) that fits the first `n` samples best.
fn solve_powers(n: usize, terms: usize, values: &DVector<f64>) -> Option<DVector<f64>> {
    let a = DMatrix::from_fn(n, terms, |k, power| (k as f64 / RATE).powi(power as i32));
    a.svd(true, true).solve(values, 1e-14).ok()
}

/// Reads all tosses of a recording.
pub fn load_tosses(folder: &Path) -> Result<Vec<Toss>, RealError> {
    let path = folder.join("contactnets_cube").join("cube_tosses_000_149.csv");
    let table = Table::load(&path)?;
    let names = [
        "toss", "qw", "qx", "qy", "qz", "x_m", "y_m", "z_m", "wx_rad_s", "wy_rad_s", "wz_rad_s", "vx_m_s", "vy_m_s",
        "vz_m_s",
    ];
    let mut columns = Vec::with_capacity(names.len());
    for name in names {
        columns.push(table.column(name)?);
    }
    let rows: Vec<[f64; 14]> = (0..columns[0].len()).map(|i| std::array::from_fn(|c| columns[c][i])).collect();
    let tosses: Vec<Toss> = rows.chunk_by(|a, b| a[0] == b[0]).map(Toss::from_rows).collect();
    if tosses.len() < 150 {
        let problem = format!("holds {} tosses; the split into 100 and 50 needs 150", tosses.len());
        return Err(RealError::Content { path, problem });
    }
    Ok(tosses)
}

impl Toss {
    fn from_rows(rows: &[[f64; 14]]) -> Self {
        let pose = |r: &[f64; 14]| {
            let rotation = Rot::new_normalize(spatial::nalgebra::Quaternion::new(r[1], r[2], r[3], r[4]));
            Pose::from_parts(Vec3::new(r[5], r[6], r[7]).into(), rotation)
        };
        let poses: Vec<Pose> = rows.iter().map(pose).collect();
        let first = &rows[0];
        let omega_b = Vec3::new(first[8], first[9], first[10]);
        let twist = Twist::new(poses[0].rotation * omega_b, Vec3::new(first[11], first[12], first[13]));
        let below = |height: f64| poses.iter().position(|p| calc_lowest(p) < height).unwrap_or(poses.len());
        let (free, impact) = (below(CLEAR), below(0.0));
        Self { recorded: Start { pose: poses[0], twist }, free, impact, poses }
    }

    /// The samples until just after the first impact.
    pub fn early(&self) -> usize {
        (self.impact + AFTER + 1).min(self.poses.len())
    }

    /// State at the first sample, from the whole free flight in least squares: a parabola under `gravity` (m/s²) and a
    /// constant rate of turning. The recorded one where the flight is shorter than four samples.
    pub fn fit_start(&self, gravity: f64) -> Start {
        let n = self.free;
        if n < 4 {
            return self.recorded;
        }
        let (mut p0, mut v0) = (Vec3::zeros(), Vec3::zeros());
        for axis in 0..3 {
            let fall = if axis == 2 { 0.5 * gravity } else { 0.0 };
            let at = |k: usize| self.poses[k].translation.vector[axis] + fall * (k as f64 / RATE).powi(2);
            let Some(line) = solve_powers(n, 2, &DVector::from_fn(n, |k, _| at(k))) else { return self.recorded };
            (p0[axis], v0[axis]) = (line[0], line[1]);
        }
        let (rotation, omega) = self.fit_turning(n);
        Start { pose: Pose::from_parts(p0.into(), rotation), twist: Twist::new(omega, v0) }
    }

    /// Attitude at the first sample and angular velocity in W axes: Gauss and Newton on rotation
    /// vectors, with the identity for the Jacobian of the exponential: linear convergence, by a few digits a pass.
    fn fit_turning(&self, n: usize) -> (Rot, Vec3) {
        let (mut r0, mut omega) = (self.poses[0].rotation, self.recorded.twist.ang);
        for _ in 0..20 {
            let off = |k: usize| {
                log_rotation(&(self.poses[k].rotation * (exp_rotation(&(omega * (k as f64 / RATE))) * r0).inverse()))
            };
            let all: Vec<Vec3> = (0..n).map(off).collect();
            let (mut d0, mut dw) = (Vec3::zeros(), Vec3::zeros());
            for axis in 0..3 {
                let Some(line) = solve_powers(n, 2, &DVector::from_fn(n, |k, _| all[k][axis])) else { break };
                (d0[axis], dw[axis]) = (line[0], line[1]);
            }
            r0 = exp_rotation(&d0) * r0;
            omega += dw;
        }
        (r0, omega)
    }
}

/// Height of the lowest corner, m.
fn calc_lowest(pose: &Pose) -> f64 {
    let rot = pose.rotation.to_rotation_matrix();
    pose.translation.z - 0.5 * WIDTH * (0..3).map(|axis| rot[(2, axis)].abs()).sum::<f64>()
}

/// How far a simulation is from the recording, per sample: centres in % of the width, attitudes in degrees.
#[derive(Clone, Debug, Default)]
pub struct Miss {
    /// Distance of the centres, % of the cube's width.
    pub position: Vec<f64>,
    /// Angle between the attitudes, deg.
    pub rotation: Vec<f64>,
}

impl Miss {
    /// Compares sample by sample.
    pub fn measure(simulated: &[Pose], toss: &Toss) -> Self {
        let pairs = || simulated.iter().zip(&toss.poses);
        Self {
            position: pairs()
                .map(|(s, r)| 100.0 / WIDTH * (s.translation.vector - r.translation.vector).norm())
                .collect(),
            rotation: pairs().map(|(s, r)| s.rotation.angle_to(&r.rotation).to_degrees()).collect(),
        }
    }

    /// Means over the toss and until just after the first impact, and what is left at its end.
    pub fn summarise(&self, toss: &Toss) -> Summary {
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let early = toss.early();
        let last = |values: &[f64]| values.last().copied().unwrap_or(f64::NAN);
        Summary {
            whole: [mean(&self.position), mean(&self.rotation)],
            early: [mean(&self.position[..early]), mean(&self.rotation[..early])],
            end: [last(&self.position), last(&self.rotation)],
        }
    }
}

/// Errors of position (% of the cube's width) and rotation (deg).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Summary {
    /// Mean over the toss.
    pub whole: [f64; 2],
    /// Mean until 47 ms after the first impact.
    pub early: [f64; 2],
    /// At the last sample, at rest.
    pub end: [f64; 2],
}

impl Summary {
    /// Mean over tosses, summed in their order.
    pub fn mean(all: &[Self]) -> Self {
        let n = all.len() as f64;
        let over = |pick: fn(&Self) -> [f64; 2]| {
            all.iter().fold([0.0; 2], |sum, s| [sum[0] + pick(s)[0] / n, sum[1] + pick(s)[1] / n])
        };
        Self { whole: over(|s| s.whole), early: over(|s| s.early), end: over(|s| s.end) }
    }
}
