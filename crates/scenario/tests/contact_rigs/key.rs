//! A set's answer key and its runs.

use crate::practice::practice;
use record::Signals;
use serde_json::Value;
use spatial::{Pose, Twist, Vec3, nalgebra};

/// One run: what was measured, and where the bodies truly started.
pub struct Run {
    pub name: String,
    pub signals: Signals,
    pub start: Vec<f64>,
}

/// A practice set with its key.
pub struct Set {
    pub name: String,
    pub key: Value,
    pub runs: Vec<Run>,
}

impl Set {
    /// Reads a set; `None`, loudly, where there are no recordings.
    pub fn read(name: &str) -> Option<Self> {
        let folder = practice()?;
        let text = std::fs::read_to_string(folder.join("keys").join(format!("{name}.json"))).unwrap();
        let key: Value = serde_json::from_str(&text).unwrap();
        let run = |entry: &Value| {
            let file = entry["run"].as_str().unwrap();
            let path = folder.join(name).join(file);
            let signals = if file.ends_with(".csv") {
                record::read_csv(&path).unwrap()
            } else {
                record::read_parquet(&path).unwrap().1
            };
            let start = numbers(&entry["true_initial_state"]);
            Run { name: file.to_owned(), signals, start }
        };
        let runs = key["runs"].as_array().unwrap().iter().map(run).collect();
        Some(Self { name: name.to_owned(), key, runs })
    }

    /// The parameter of an effect, as numbers.
    pub fn param(&self, effect: &str, param: &str) -> Option<Vec<f64>> {
        let effects = self.key["effects"].as_array().unwrap();
        effects.iter().find(|e| e["name"] == effect).map(|e| numbers(&e["params"][param]))
    }
}

pub fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(all) => all.iter().map(|v| v.as_f64().unwrap()).collect(),
        one => vec![one.as_f64().unwrap()],
    }
}

/// Poses and twists (W axes) of chaser and target at the start. The states are those of the centres of mass, `com` that of
/// the chaser in its frame.
pub fn start_of(state: &[f64], com: Vec3) -> [(Pose, Twist); 2] {
    let bodies: Vec<_> =
        state.chunks(state.len() / 2).map(|s| if s.len() == 6 { planar(s) } else { spatial_of(s) }).collect();
    let (pose, twist) = bodies[0];
    let arm = pose.rotation * com;
    let origin = Pose::from_parts((pose.translation.vector - arm).into(), pose.rotation);
    [(origin, Twist::new(twist.ang, twist.lin - twist.ang.cross(&arm))), bodies[1]]
}

fn spatial_of(s: &[f64]) -> (Pose, Twist) {
    let v = |k: usize| Vec3::new(s[k], s[k + 1], s[k + 2]);
    let rotation = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(s[3], s[4], s[5], s[6]));
    (Pose::from_parts(v(0).into(), rotation), Twist::new(rotation * v(10), v(7)))
}

/// x, y, heading and their rates, 0.25 m above the table.
fn planar(s: &[f64]) -> (Pose, Twist) {
    let rotation = nalgebra::UnitQuaternion::from_axis_angle(&Vec3::z_axis(), s[2]);
    let pose = Pose::from_parts(Vec3::new(s[0], s[1], 0.25).into(), rotation);
    (pose, Twist::new(Vec3::z() * s[5], Vec3::new(s[3], s[4], 0.0)))
}
