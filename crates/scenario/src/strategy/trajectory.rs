//! A quintic path of a pose that starts at rest and ends at a pose with a velocity and no acceleration.
//!
//!   x(s) = x₁ (10 s³ − 15 s⁴ + 6 s⁵) + T v₁ (−4 s³ + 7 s⁴ − 3 s⁵),   s = t/T
//! for the displacement from the start; rotations as rotation vectors from the start's attitude.

use spatial::{Pose, Twist, exp_rotation, log_rotation, rotation_rate_of_vector};

/// The path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quintic {
    pub(super) start: Pose,
    pub(super) end: Pose,
    /// Velocity at the end: W axes, about the moving frame's origin.
    pub(super) end_twist: Twist,
    /// Time between the two, s.
    pub(super) duration: f64,
}

impl Quintic {
    /// Pose at a time after the start; beyond the end it goes on with the end's velocity.
    pub(super) fn pose(&self, time: f64) -> Pose {
        let over = (time - self.duration).max(0.0);
        let s = (time / self.duration).clamp(0.0, 1.0);
        let (s3, s4, s5) = (s.powi(3), s.powi(4), s.powi(5));
        let reach = 10.0 * s3 - 15.0 * s4 + 6.0 * s5;
        let carry = self.duration * (-4.0 * s3 + 7.0 * s4 - 3.0 * s5);
        let turn = log_rotation(&(self.end.rotation * self.start.rotation.inverse()));
        let turn_rate = rotation_rate_of_vector(&turn, &self.end_twist.ang);
        let rotation = exp_rotation(&(reach * turn + carry * turn_rate)) * self.start.rotation;
        let shift = self.end.translation.vector - self.start.translation.vector;
        let position = self.start.translation.vector + reach * shift + (carry + over) * self.end_twist.lin;
        Pose::from_parts(position.into(), exp_rotation(&(over * self.end_twist.ang)) * rotation)
    }
}

/// Velocity of a moving pose from two of its values, W axes, about its origin.
pub(super) fn calc_rate(now: &Pose, later: &Pose, dt: f64) -> Twist {
    Twist::new(
        log_rotation(&(later.rotation * now.rotation.inverse())) / dt,
        (later.translation.vector - now.translation.vector) / dt,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use spatial::Vec3;

    #[test]
    fn path_meets_pose_and_velocity_at_the_end() {
        let path = Quintic {
            start: Pose::translation(1.0, 2.0, 3.0),
            end: Pose::from_parts(Vec3::new(0.5, 2.5, 3.2).into(), exp_rotation(&Vec3::new(0.3, -0.4, 0.2))),
            end_twist: Twist::new(Vec3::new(0.02, 0.03, -0.01), Vec3::new(0.05, 0.0, -0.02)),
            duration: 8.0,
        };
        assert!((path.pose(8.0).translation.vector - path.end.translation.vector).norm() < 1e-12);
        assert!(path.pose(8.0).rotation.angle_to(&path.end.rotation) < 1e-7); // acos near 1
        let rate = calc_rate(&path.pose(8.0 - 1e-4), &path.pose(8.0), 1e-4);
        // One-sided difference: error ∝ dt times the acceleration; the rotation rate is exact to fourth order in 0.5 rad.
        assert!((rate.lin - path.end_twist.lin).norm() < 1e-5);
        assert!((rate.ang - path.end_twist.ang).norm() < 1e-3 * path.end_twist.ang.norm() + 1e-5);
        assert!(calc_rate(&path.pose(0.0), &path.pose(1e-4), 1e-4).lin.norm() < 1e-6);
    }
}
