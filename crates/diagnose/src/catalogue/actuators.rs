//! Effects of actuators.

use super::hypothesis;
use crate::facts::JointFact;
use crate::hypothesis::{Coordinate, Hypothesis};

pub(super) fn add_joint(joint: &JointFact, all: &mut Vec<Hypothesis>) {
    let place = format!("joint:{}", joint.name);
    add(&place, joint.largest_command, all);
}

pub(super) fn add_thrusters(thrusters: &[String], all: &mut Vec<Hypothesis>) {
    let place = |name: &str| format!("actuator:{name}");
    let names = thrusters.iter().map(String::as_str).chain((thrusters.len() > 1).then_some("*"));
    for name in names {
        add(&place(name), 0.0, all);
        let tilt = vec![Coordinate::free("angle_y", 0.0), Coordinate::free("angle_z", 0.0)];
        all.push(hypothesis("actuator-misalignment", &place(name), tilt).screened(&[(0, 1e-4), (1, 1e-4)]));
    }
}

/// `largest`: the largest command, N or N·m; zero where commands are only on and off.
fn add(place: &str, largest: f64, all: &mut Vec<Hypothesis>) {
    let gain = vec![Coordinate::free("gain", 1.0)];
    all.push(hypothesis("actuator-gain", place, gain).screened(&[(0, 1e-4)]));
    let delay = vec![Coordinate { bounds: [0.0, 0.5], ..Coordinate::level("delay", 0.0) }];
    let mut late = hypothesis("actuator-delay", place, delay).screened_at("", &[vec![4e-3]]);
    late.is_dear = largest == 0.0;
    all.push(late);
    let lag = vec![Coordinate::log("time_constant", 5e-3, [1e-5, 2.0])];
    let mut slow = hypothesis("actuator-lag", place, lag).screened_at("", &[vec![5e-3_f64.ln()]]);
    slow.is_dear = largest == 0.0;
    all.push(slow);
    if largest > 0.0 {
        let limit = vec![Coordinate::log("limit", 0.8 * largest, [1e-3 * largest, largest])];
        let at = |share: f64| vec![vec![(share * largest).ln()]];
        all.push(
            hypothesis("actuator-saturation", place, limit)
                .screened_at("limit 0.9 of the largest command", &at(0.9))
                .screened_at("limit 0.7 of the largest command", &at(0.7)),
        );
    }
}
