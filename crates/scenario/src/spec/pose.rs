//! Poses and twists as a file writes them, and their SI values.
//!
//! Angles are in degrees. `rpy_deg` is URDF's: R = R_z(yaw) R_y(pitch) R_x(roll), turning about fixed axes in the order
//! x, y, z. A quaternion is scalar first and of unit length; it is normalised once more on the way in.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use spatial::nalgebra::{Quaternion, Translation3, UnitQuaternion};
use spatial::{Pose, Rot, Twist, Vec3};

/// A pose: position and attitude of a frame in another, which the key it stands under names.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("x-at-most-one" = [["rpy_deg", "quaternion_wxyz"]]))]
pub struct PoseSpec {
    /// Position of the origin, m.
    pub position_m: [f64; 3],
    /// Roll, pitch and yaw about the fixed x, y and z axes, in that order, deg.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rpy_deg: Option<[f64; 3]>,
    /// Unit quaternion, scalar first; instead of `rpy_deg`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit-quaternion" = true))]
    pub quaternion_wxyz: Option<[f64; 4]>,
}

impl PoseSpec {
    /// The pose, in metres.
    pub fn pose(&self) -> Pose {
        Pose::from_parts(
            Translation3::from(Vec3::from(self.position_m)),
            attitude(self.rpy_deg.as_ref(), self.quaternion_wxyz.as_ref()),
        )
    }
}

/// The rotation that a file gives by at most one of the two; identity without either.
pub(super) fn attitude(rpy_deg: Option<&[f64; 3]>, quaternion_wxyz: Option<&[f64; 4]>) -> Rot {
    match (quaternion_wxyz, rpy_deg) {
        (Some(&[w, x, y, z]), _) => UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)),
        (None, Some(rpy)) => {
            let [roll, pitch, yaw] = rpy.map(f64::to_radians);
            UnitQuaternion::from_euler_angles(roll, pitch, yaw)
        }
        (None, None) => Rot::identity(),
    }
}

/// Initial motion of a vehicle's base: of its *base origin*, not of its centre of mass.
///
/// The linear part is in W axes, the angular part in the body's own axes, as a tumbling satellite's rates are given.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TwistSpec {
    /// Velocity of the base origin, in W axes, m/s.
    pub linear_m_per_s: [f64; 3],
    /// Angular velocity of the base, in body axes, deg/s.
    pub angular_deg_per_s: [f64; 3],
}

impl TwistSpec {
    /// Velocity of the base origin, in W axes, m/s.
    pub fn vel_wb_w(&self) -> Vec3 {
        Vec3::from(self.linear_m_per_s)
    }

    /// Angular velocity of the base, in its own axes, rad/s.
    pub fn omega_wb_b(&self) -> Vec3 {
        Vec3::from(self.angular_deg_per_s.map(f64::to_radians))
    }

    /// The twist of base B at `pose_wb`: in W axes, about the base origin.
    pub fn twist_wb_w(&self, pose_wb: &Pose) -> Twist {
        Twist::new(pose_wb.rotation * self.omega_wb_b(), self.vel_wb_w())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two roundings of a rotation of order one.
    const ROUNDING: f64 = 1e-15;

    #[test]
    fn yaw_of_90_degrees_turns_x_into_y() {
        let spec = PoseSpec { rpy_deg: Some([0.0, 0.0, 90.0]), ..PoseSpec::default() };
        assert!((spec.pose().rotation * Vec3::x() - Vec3::y()).norm() < ROUNDING);
    }

    #[test]
    fn roll_comes_before_yaw_about_fixed_axes() {
        // z goes to −y by the roll, and −y to x by the yaw.
        let spec = PoseSpec { rpy_deg: Some([90.0, 0.0, 90.0]), ..PoseSpec::default() };
        assert!((spec.pose().rotation * Vec3::z() - Vec3::x()).norm() < ROUNDING);
    }

    #[test]
    fn quaternion_and_rpy_agree() {
        let half = 15.0_f64.to_radians();
        let by_rpy = PoseSpec { rpy_deg: Some([30.0, 0.0, 0.0]), ..PoseSpec::default() };
        let by_quaternion =
            PoseSpec { quaternion_wxyz: Some([half.cos(), half.sin(), 0.0, 0.0]), ..PoseSpec::default() };
        assert!(by_rpy.pose().rotation.angle_to(&by_quaternion.pose().rotation) < 1e-7); // acos near 1
    }

    #[test]
    fn body_rates_turn_into_world_axes() {
        let pose_wb = PoseSpec { rpy_deg: Some([0.0, 0.0, 90.0]), ..PoseSpec::default() }.pose();
        let twist = TwistSpec { linear_m_per_s: [1.0, 0.0, 0.0], angular_deg_per_s: [180.0, 0.0, 0.0] };
        let twist_wb_w = twist.twist_wb_w(&pose_wb);
        assert!((twist_wb_w.ang - Vec3::y() * std::f64::consts::PI).norm() < 4.0 * ROUNDING);
        assert_eq!(twist_wb_w.lin, Vec3::x());
    }
}
