//! Recordings made on the spot: a tumbling body and a swinging joint with sensors that can be wrong on purpose.
#![allow(dead_code, clippy::unwrap_used)]

use record::{RecordingSet, inspect};
use spatial::nalgebra::{Quaternion, UnitQuaternion};
use spatial::{Rot, Vec3, exp_rotation};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A generator of white noise that is the same everywhere: splitmix64 (Steele, Lea and Flood 2014), Box–Muller.
pub struct Noise(u64);

impl Noise {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }

    pub fn vector(&mut self) -> Vec3 {
        Vec3::new(self.normal(), self.normal(), self.normal())
    }
}

/// What is wrong with the gyro: reading(t) = scale · (R(angle)ᵀ ω(t − delay)) + bias, then axes multiplied by `signs`.
#[derive(Clone, Copy)]
pub struct Gyro {
    pub scale: Vec3,
    pub angle: Vec3,
    pub bias: Vec3,
    pub delay: f64,
    pub factor: f64,
}

impl Gyro {
    pub const IDEAL: Self = Self {
        scale: Vec3::new(1.0, 1.0, 1.0),
        angle: Vec3::new(0.0, 0.0, 0.0),
        bias: Vec3::new(0.0, 0.0, 0.0),
        delay: 0.0,
        factor: 1.0,
    };

    fn read(&self, t: f64) -> Vec3 {
        let omega = exp_rotation(&self.angle).inverse() * omega(t - self.delay);
        (self.scale.component_mul(&omega) + self.bias) * self.factor
    }
}

pub const GYRO_NOISE: f64 = 2e-4;
pub const ATTITUDE_NOISE: f64 = 5e-4;

/// A made-up tumble in body axes, rad/s.
pub fn omega(t: f64) -> Vec3 {
    Vec3::new(0.08 * (0.31 * t).sin() + 0.02, 0.06 * (0.23 * t + 1.0).cos(), 0.07 * (0.17 * t + 0.4).sin() - 0.03)
}

/// The attitude at multiples of 0.1 s, integrated at 1 ms by the midpoint (error below 1e-9 rad here).
pub fn attitudes(count: usize) -> Vec<Rot> {
    let mut q = UnitQuaternion::from_quaternion(Quaternion::new(0.4, -0.7, 0.2, 0.5));
    let mut all = vec![q];
    for k in 1..count {
        for i in 0..100 {
            let t = (k - 1) as f64 * 0.1 + (f64::from(i) + 0.5) * 1e-3;
            q *= exp_rotation(&(omega(t) * 1e-3));
        }
        all.push(q);
    }
    all
}

/// CSV of a tumble: attitude at 10 Hz, gyro at 50 Hz, both noisy and rounded to 1e-5; `write_q` may change the quaternion.
pub fn tumble_csv(gyro: &Gyro, seed: u64, seconds: usize, write_q: fn(Rot) -> [f64; 4]) -> String {
    let (mut noise, attitudes) = (Noise::new(seed), attitudes(10 * seconds + 1));
    let mut text = String::from("t,");
    ["w", "x", "y", "z"].iter().for_each(|c| text.push_str(&format!("body.target.orientation.{c},")));
    text.push_str("body.target.angular_velocity.x,body.target.angular_velocity.y,body.target.angular_velocity.z\n");
    for i in 0..=50 * seconds {
        let t = i as f64 * 0.02;
        let _ = write!(text, "{t}");
        if i % 5 == 0 {
            let q = attitudes[i / 5] * exp_rotation(&(noise.vector() * ATTITUDE_NOISE));
            let sign = if noise.normal() > 0.0 { 1.0 } else { -1.0 };
            write_q(q).iter().for_each(|x| write!(text, ",{:.5}", sign * x).unwrap());
        } else {
            text.push_str(",,,,");
        }
        let reading = gyro.read(t) + noise.vector() * GYRO_NOISE * gyro.factor;
        reading.iter().for_each(|x| write!(text, ",{x:.5}").unwrap());
        text.push('\n');
    }
    text
}

pub fn as_is(q: Rot) -> [f64; 4] {
    [q.w, q.i, q.j, q.k]
}

/// A joint that swings: encoder at 250 Hz, rate at 250 Hz.
pub fn joint_csv(seed: u64, seconds: f64, reading: impl Fn(f64) -> f64) -> String {
    let mut noise = Noise::new(seed);
    let mut text = String::from("t,joint.elbow.position,joint.elbow.velocity\n");
    for i in 0..(250.0 * seconds) as usize {
        let t = i as f64 * 0.004;
        let position = 0.5 * (1.3 * t).sin() + 0.2 * (3.1 * t).cos() + 2e-5 * noise.normal();
        writeln!(text, "{t},{position:.6},{:.4}", reading(t) + 1e-3 * noise.normal()).unwrap();
    }
    text
}

/// Rate of that joint.
pub fn joint_rate(t: f64) -> f64 {
    0.65 * (1.3 * t).cos() - 0.62 * (3.1 * t).sin()
}

pub const TUMBLE: &str = r#"format = 1
rig = "tumbler"
[noise]
"body.target.orientation" = 5e-4
"body.target.angular_velocity" = 2e-4
"#;

pub const JOINT: &str = r#"format = 1
rig = "arm"
[noise]
"joint.elbow.position" = 2e-5
"joint.elbow.velocity" = 1e-3
"#;

/// A folder with a recording.toml (a `[[run]]` for each file is added, the last one a holdout) and its run files.
pub fn folder(head: &str, files: &[(&str, &str)]) -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    let mut toml = head.to_owned();
    for (i, (name, text)) in files.iter().enumerate() {
        fs::write(dir.path().join(name), text).unwrap();
        let role = if i + 1 == files.len() && i > 0 { "holdout" } else { "fit" };
        write!(toml, "[[run]]\nfile = \"{name}\"\nrole = \"{role}\"\n").unwrap();
    }
    fs::write(dir.path().join("recording.toml"), toml).unwrap();
    dir
}

/// A folder whose recording.toml is exactly this.
pub fn exact(toml: &str, files: &[(&str, &[u8])]) -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    files.iter().for_each(|(name, bytes)| fs::write(dir.path().join(name), bytes).unwrap());
    fs::write(dir.path().join("recording.toml"), toml).unwrap();
    dir
}

pub fn load(dir: &Path) -> RecordingSet {
    RecordingSet::load(dir).unwrap()
}

pub fn error(dir: &Path) -> String {
    RecordingSet::load(dir).unwrap_err().to_string()
}

pub fn inspected(dir: &TempDir) -> inspect::Inspection {
    inspect::inspect(&load(dir.path()))
}

pub fn remarks(inspection: &inspect::Inspection) -> String {
    inspection.remarks.iter().map(|remark| format!("{remark}\n")).collect()
}
