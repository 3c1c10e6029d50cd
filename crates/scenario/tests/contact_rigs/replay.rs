//! Runs a world along a recording and compares, family by family, in units of the sensors' noise.

use crate::key::{Run, start_of};
use sim::{Command, World};
use spatial::{Twist, Vec3, nalgebra};
use std::collections::BTreeMap;

type Quat = nalgebra::UnitQuaternion<f64>;

/// Sums of squares and counts by channel family.
#[derive(Default, Debug, Clone)]
pub struct Errors(pub BTreeMap<&'static str, (f64, usize)>);

impl Errors {
    fn add(&mut self, family: &'static str, error: f64, sigma: f64) {
        if error.is_nan() {
            return;
        }
        let sum = self.0.entry(family).or_default();
        sum.0 += (error / sigma).powi(2);
        sum.1 += 1;
    }

    pub fn merge(&mut self, other: &Self) {
        for (family, (sum, n)) in &other.0 {
            let own = self.0.entry(family).or_default();
            own.0 += sum;
            own.1 += n;
        }
    }

    /// RMS over noise by family, and its standard deviation if all is noise.
    pub fn rms(&self) -> Vec<(&'static str, f64, f64)> {
        self.0.iter().map(|(f, (sum, n))| (*f, (sum / *n as f64).sqrt(), (0.5 / *n as f64).sqrt())).collect()
    }
}

/// What a rig measures and how well: (position, attitude, rate, force, torque), and where its force sensor is.
pub struct Rig {
    pub sigma: [f64; 5],
    pub written_to: [f64; 5],
    pub sensor: Vec3,
    /// Stiffness and damping of an elastic mount behind which the sensor sits.
    pub mount: Option<(f64, f64)>,
}

pub const DOCK_IMPACT: Rig = Rig {
    sigma: [1e-4, 1e-4, 1e-4, 0.5, 0.05],
    written_to: [1e-5, 1e-6, 1e-5, 0.1, 0.01],
    sensor: Vec3::new(0.8, 0.0, 0.0),
    mount: None,
};
pub const AIR_TABLE: Rig = Rig {
    sigma: [2e-4, 5e-4, 1e-3, 0.05, f64::INFINITY],
    written_to: [1e-5, 1e-5, 1e-4, 0.01, 0.0],
    sensor: Vec3::new(0.32, 0.0, 0.0),
    mount: None,
};

/// What the model says at an instant.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seen {
    pub pos: [Vec3; 2],
    pub rot: [Quat; 2],
    pub rate: [Vec3; 2],
    pub force: Vec3,
    pub torque: Vec3,
}

impl Rig {
    fn noise(&self, k: usize) -> f64 {
        self.sigma[k].hypot(self.written_to[k] / 12f64.sqrt())
    }

    /// Force and moment on the chaser's part, in the sensor's frame.
    fn sense(&self, world: &mut World) -> (Vec3, Vec3) {
        world.refresh_touches();
        if let Some((stiffness, damping)) = self.mount {
            let (q, v) = (&world.state().q, &world.state().v);
            let u = Vec3::new(q[0], q[1], q[2]);
            let force = stiffness * u + damping * Vec3::new(v[0], v[1], v[2]);
            let at = world.frame(0);
            let tip = Vec3::new(1.1, 0.0, 0.0) + u;
            let tip_w = at.point(&tip);
            // The tip hands on what the contact turns about it.
            let turn: Vec3 = world.touches().map(|t| (t.point_w - tip_w).cross(&-t.force_w)).sum();
            return (force, (tip - self.sensor).cross(&force) + at.rot.tr_mul(&turn));
        }
        let frame = world.frame(0);
        let at = frame.point(&self.sensor);
        let (mut force, mut torque) = (Vec3::zeros(), Vec3::zeros());
        for touch in world.touches() {
            let on_chaser = if world.model().pair_bodies(touch.pair).0 == 0 { -touch.force_w } else { touch.force_w };
            force += on_chaser;
            torque += (touch.point_w - at).cross(&on_chaser);
        }
        (frame.rot.tr_mul(&force), frame.rot.tr_mul(&torque))
    }

    fn see(&self, world: &mut World, wants_force: bool) -> Seen {
        let mut seen = Seen::default();
        for v in 0..2 {
            let (pose, twist) = (world.state().bases[v], world.link_twist(v, 0));
            seen.rot[v] = pose.rotation;
            seen.pos[v] = pose.translation.vector;
            seen.rate[v] = pose.rotation.inverse() * twist.ang;
        }
        if wants_force {
            (seen.force, seen.torque) = self.sense(world);
        }
        seen
    }

    /// Adds a row's differences.
    pub fn compare(&self, errors: &mut Errors, run: &Run, row: usize, seen: &Seen) {
        let value = |name: String| run.signals.values(&name).map_or(f64::NAN, |v| v[row]);
        for (v, body) in ["chaser", "target"].into_iter().enumerate() {
            for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
                errors.add("position", value(format!("body.{body}.position.{axis}")) - seen.pos[v][k], self.noise(0));
                errors.add(
                    "gyro",
                    value(format!("body.{body}.angular_velocity.{axis}")) - seen.rate[v][k],
                    self.noise(2),
                );
            }
            let q = ["w", "x", "y", "z"].map(|a| value(format!("body.{body}.orientation.{a}")));
            if !q[0].is_nan() {
                let measured = Quat::from_quaternion(nalgebra::Quaternion::new(q[0], q[1], q[2], q[3]));
                let turn = (seen.rot[v].inverse() * measured).scaled_axis();
                (0..3).for_each(|k| errors.add("attitude", turn[k], self.noise(1)));
            }
        }
        for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
            errors.add("force", value(format!("sensor.probe.force.{axis}")) - seen.force[k], self.noise(3));
            errors.add("torque", value(format!("sensor.probe.torque.{axis}")) - seen.torque[k], self.noise(4));
        }
    }

    /// What the world says along a run, row by row.
    pub fn predict(&self, world: &mut World, run: &Run, com: Vec3) -> Vec<Seen> {
        let start = start_of(&run.start, com);
        (0..2).for_each(|v| world.state_mut().bases[v] = start[v].0);
        let mut twists = vec![Twist::default(); world.model().vehicles.len()];
        (0..2).for_each(|v| twists[v] = start[v].1);
        world.set_base_twists(&twists);
        let h = world.model().step;
        let commands: Vec<_> =
            (1..=8).filter_map(|k| run.signals.values(&format!("actuator.thruster_{k}.command"))).collect();
        let force = run.signals.values("sensor.probe.force.x").unwrap();
        let mut all = Vec::with_capacity(run.signals.times.len());
        for (row, t) in run.signals.times.iter().enumerate() {
            while world.state().time + h < t - 1e-9 {
                world.advance_by(h).unwrap();
            }
            world.advance_by(t - world.state().time).unwrap();
            for (k, column) in commands.iter().enumerate().filter(|(_, c)| !c[row].is_nan()) {
                world.commands_mut()[k] = Command { effort: 0.5 * column[row], ..Command::default() };
            }
            all.push(self.see(world, !force[row].is_nan()));
        }
        all
    }

    /// Error of a run in units of noise.
    pub fn replay(&self, world: &mut World, run: &Run, com: Vec3) -> Errors {
        let mut errors = Errors::default();
        let seen = self.predict(world, run, com);
        seen.iter().enumerate().for_each(|(row, seen)| self.compare(&mut errors, run, row, seen));
        errors
    }

    /// RMS of the difference of two predictions, in units of noise: position, attitude, rate, force, torque.
    pub fn differ(&self, a: &[Seen], b: &[Seen]) -> [f64; 5] {
        let mut sums = [0.0; 5];
        for (a, b) in a.iter().zip(b) {
            for v in 0..2 {
                sums[0] += (a.pos[v] - b.pos[v]).norm_squared() / 2.0;
                sums[1] += a.rot[v].angle_to(&b.rot[v]).powi(2) / 2.0;
                sums[2] += (a.rate[v] - b.rate[v]).norm_squared() / 2.0;
            }
            sums[3] += (a.force - b.force).norm_squared();
            sums[4] += (a.torque - b.torque).norm_squared();
        }
        std::array::from_fn(|k| (1e4 * (sums[k] / (3 * a.len()) as f64).sqrt() / self.noise(k)).round() / 1e4)
    }
}
