//! Prescribed motions: the base of a vehicle is where a path says, whatever the forces. A stage, a shaker, a table.
//!
//! With F the frame of the motion, d(t) the displacements along its axes, θ(t) the angle about its z axis and B₀ the base
//! pose at which all of them are zero:
//!
//!   pose_wb(t) = F · T(d) R_z(θ) · F⁻¹ · B₀,     ρ = R_z(θ) (F⁻¹ B₀)_origin
//!   ω = R_F θ̇ ẑ,   v = R_F (ḋ + θ̇ ẑ × ρ),   a = R_F (d̈ + θ̈ ẑ × ρ − θ̇² ρ_⊥)
//!
//! The vehicle's joints and whatever holds on to it feel this motion. What it takes to drive it crosses the system's border:
//! the drive's impulse and work are in [`crate::Account`], so that the books of momentum and energy stay closed. The slot of a
//! driven vehicle in [`crate::State::momentum`] holds what all others have given it.

mod path;
mod smooth;

pub use path::{DrivePath, Motion};

use spatial::{Pose, Twist, Vec3, exp_rotation};
use std::sync::Arc;

/// A coordinate of a drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriveAxis {
    /// Along x of the drive's frame, m.
    X,
    /// Along y, m.
    Y,
    /// Along z, m.
    Z,
    /// About z, rad.
    AboutZ,
}

/// A vehicle whose base follows paths.
#[derive(Clone, Debug)]
pub struct Drive {
    /// Unique name.
    pub name: String,
    /// The vehicle.
    pub vehicle: usize,
    /// The frame of the motion, in W.
    pub frame: Pose,
    /// Base pose where every path is at zero, in W.
    pub start: Pose,
    /// The driven coordinates; the others stay at zero.
    pub paths: Vec<(DriveAxis, Arc<DrivePath>)>,
}

/// How a driven base moves at an instant: pose, twist about its own origin, and spatial acceleration about that origin
/// taken as fixed in W.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BaseMotion {
    pub pose: Pose,
    pub twist: Twist,
    pub acceleration: Twist,
}

impl Drive {
    /// The motion of one coordinate; still at zero where none is driven.
    pub fn eval(&self, axis: DriveAxis, time: f64) -> Motion {
        self.paths.iter().find(|(a, _)| *a == axis).map_or(Motion::default(), |(_, path)| path.eval(time))
    }

    /// Displacement along the axes of the drive's frame, m.
    pub fn calc_displacement(&self, time: f64) -> Vec3 {
        let at = |axis| self.eval(axis, time).position;
        Vec3::new(at(DriveAxis::X), at(DriveAxis::Y), at(DriveAxis::Z))
    }

    pub(crate) fn calc_motion(&self, time: f64) -> BaseMotion {
        let mut along = [Motion::default(); 3];
        let mut turn = Motion::default();
        for (axis, path) in &self.paths {
            let motion = path.eval(time);
            match axis {
                DriveAxis::X => along[0] = motion,
                DriveAxis::Y => along[1] = motion,
                DriveAxis::Z => along[2] = motion,
                DriveAxis::AboutZ => turn = motion,
            }
        }
        let rot = self.frame.rotation;
        let of = |f: fn(&Motion) -> f64| rot * Vec3::new(f(&along[0]), f(&along[1]), f(&along[2]));
        let (shift, velocity, acceleration) = (of(|m| m.position), of(|m| m.velocity), of(|m| m.acceleration));
        if turn == Motion::default() {
            let place = self.start.translation.vector + shift;
            return BaseMotion {
                pose: Pose::from_parts(place.into(), self.start.rotation),
                twist: Twist::new(Vec3::zeros(), velocity),
                acceleration: Twist::new(Vec3::zeros(), acceleration),
            };
        }
        let axis = rot * Vec3::z();
        let turned = exp_rotation(&(turn.position * axis));
        let centre = self.frame.translation.vector;
        let arm = turned * (self.start.translation.vector - centre);
        let (omega, alpha) = (turn.velocity * axis, turn.acceleration * axis);
        let linear = velocity + omega.cross(&arm);
        let classical = acceleration + alpha.cross(&arm) + omega.cross(&omega.cross(&arm));
        BaseMotion {
            pose: Pose::from_parts((centre + shift + arm).into(), turned * self.start.rotation),
            twist: Twist::new(omega, linear),
            acceleration: Twist::new(alpha, classical - omega.cross(&linear)),
        }
    }
}
