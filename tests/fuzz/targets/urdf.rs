//! Any bytes as a URDF: an answer in words or a sound robot, never a panic, a hang or a NaN.
#![no_main]

use libfuzzer_sys::fuzz_target;
use multibody::{RobotDescription, SearchPaths, parse_urdf};
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    let text = String::from_utf8_lossy(bytes);
    match parse_urdf(&text, Path::new("fuzz.urdf"), Path::new("/nonexistent"), &SearchPaths::default()) {
        Ok(loaded) => check(&loaded.robot),
        Err(errors) => assert!(errors.iter().count() > 0 && !errors.to_string().is_empty()),
    }
});

fn check(robot: &RobotDescription) {
    assert_eq!(robot.joints.len() + 1, robot.links.len());
    for (i, joint) in robot.joints.iter().enumerate() {
        assert!(joint.parent <= i);
        assert!((joint.axis.norm() - 1.0).abs() < 1e-9);
        assert!(joint.pose_pj.translation.vector.iter().all(|x| x.is_finite()));
        assert!(joint.position_limits.is_none_or(|[lower, upper]| lower <= upper));
        let leader = joint.mimic.map(|m| m.joint);
        assert!(leader.is_none_or(|l| l != i && robot.joints[l].mimic.is_none()));
    }
    for inertial in robot.links.iter().filter_map(|l| l.inertial) {
        assert!(inertial.mass >= 0.0 && inertial.tensor_com.iter().chain(&inertial.com).all(|x| x.is_finite()));
    }
}
