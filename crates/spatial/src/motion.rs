//! Frames, twists and wrenches.
//!
//! A twist about a point O of a body holds ω and the velocity of the body's material point at O; a wrench about O holds
//! the moment about O and the force. Moving the point from O to P, with r = P − O:
//!   v_P = v_O + ω × r,   m_P = m_O − r × f.

use crate::{Mat3, Pose, Vec3};
use serde::{Deserialize, Serialize};
use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

/// A pose as a rotation matrix and a position: what kinematics computes with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Rotation, child to parent axes.
    pub rot: Mat3,
    /// Position of the child's origin in the parent, m.
    pub pos: Vec3,
}

impl Frame {
    /// No rotation, no translation.
    pub fn identity() -> Self {
        Self { rot: Mat3::identity(), pos: Vec3::zeros() }
    }

    /// A point given in the child, in the parent, m.
    #[inline]
    pub fn point(&self, p: &Vec3) -> Vec3 {
        self.rot * p + self.pos
    }

    /// A point given in the parent, in the child, m.
    #[inline]
    pub fn inverse_point(&self, p: &Vec3) -> Vec3 {
        self.rot.tr_mul(&(p - self.pos))
    }

    /// The pose with a unit quaternion.
    pub fn to_pose(&self) -> Pose {
        let rot = nalgebra::Rotation3::from_matrix_unchecked(self.rot);
        Pose::from_parts(self.pos.into(), nalgebra::UnitQuaternion::from_rotation_matrix(&rot))
    }
}

impl From<&Pose> for Frame {
    fn from(pose: &Pose) -> Self {
        Self { rot: *pose.rotation.to_rotation_matrix().matrix(), pos: pose.translation.vector }
    }
}

impl Mul for &Frame {
    type Output = Frame;
    #[inline]
    fn mul(self, child: &Frame) -> Frame {
        Frame { rot: self.rot * child.rot, pos: self.rot * child.pos + self.pos }
    }
}

/// Angular and linear velocity (or acceleration, or a joint's screw).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Twist {
    /// Angular part, rad/s.
    pub ang: Vec3,
    /// Linear part at the point that the twist is about, m/s.
    pub lin: Vec3,
}

/// Moment and force.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Wrench {
    /// Moment about the point that the wrench is about, N·m.
    pub moment: Vec3,
    /// Force, N.
    pub force: Vec3,
}

impl Twist {
    /// From its angular and linear parts.
    #[inline]
    pub fn new(ang: Vec3, lin: Vec3) -> Self {
        Self { ang, lin }
    }

    /// Velocity of the body's material point at `r` from the twist's point, m/s.
    #[inline]
    pub fn at(&self, r: &Vec3) -> Vec3 {
        self.lin + self.ang.cross(r)
    }

    /// The same motion about the point at `r`.
    #[inline]
    pub fn about(&self, r: &Vec3) -> Self {
        Self { ang: self.ang, lin: self.at(r) }
    }

    /// Spatial cross product with a motion: the rate of `m` that is fixed in a body moving with `self`.
    #[inline]
    pub fn cross_motion(&self, m: &Twist) -> Twist {
        Twist { ang: self.ang.cross(&m.ang), lin: self.lin.cross(&m.ang) + self.ang.cross(&m.lin) }
    }

    /// Spatial cross product with a force: the rate of `f` that is fixed in a body moving with `self`.
    #[inline]
    pub fn cross_force(&self, f: &Wrench) -> Wrench {
        Wrench { moment: self.ang.cross(&f.moment) + self.lin.cross(&f.force), force: self.ang.cross(&f.force) }
    }

    /// Power of a wrench about the same point, W.
    #[inline]
    pub fn dot(&self, f: &Wrench) -> f64 {
        self.ang.dot(&f.moment) + self.lin.dot(&f.force)
    }
}

impl Wrench {
    /// From its moment and force.
    #[inline]
    pub fn new(moment: Vec3, force: Vec3) -> Self {
        Self { moment, force }
    }

    /// Of a force that acts at `r` from the wrench's point.
    #[inline]
    pub fn from_force_at(force: Vec3, r: &Vec3) -> Self {
        Self { moment: r.cross(&force), force }
    }

    /// The same wrench about the point at `r` from the present one.
    #[inline]
    pub fn about(&self, r: &Vec3) -> Self {
        Self { moment: self.moment - r.cross(&self.force), force: self.force }
    }
}

macro_rules! linear_space {
    ($t:ty, $a:ident, $b:ident) => {
        impl Add for $t {
            type Output = Self;
            #[inline]
            fn add(self, o: Self) -> Self {
                Self { $a: self.$a + o.$a, $b: self.$b + o.$b }
            }
        }
        impl Sub for $t {
            type Output = Self;
            #[inline]
            fn sub(self, o: Self) -> Self {
                Self { $a: self.$a - o.$a, $b: self.$b - o.$b }
            }
        }
        impl Neg for $t {
            type Output = Self;
            #[inline]
            fn neg(self) -> Self {
                Self { $a: -self.$a, $b: -self.$b }
            }
        }
        impl Mul<f64> for $t {
            type Output = Self;
            #[inline]
            fn mul(self, k: f64) -> Self {
                Self { $a: self.$a * k, $b: self.$b * k }
            }
        }
        impl AddAssign for $t {
            #[inline]
            fn add_assign(&mut self, o: Self) {
                self.$a += o.$a;
                self.$b += o.$b;
            }
        }
        impl SubAssign for $t {
            #[inline]
            fn sub_assign(&mut self, o: Self) {
                self.$a -= o.$a;
                self.$b -= o.$b;
            }
        }
    };
}
linear_space!(Twist, ang, lin);
linear_space!(Wrench, moment, force);

#[cfg(test)]
mod tests {
    use super::*;

    // Round-off of a few products of numbers near one.
    const ROUND_OFF: f64 = 1e-14;

    fn vectors() -> [Vec3; 5] {
        [
            Vec3::new(0.3, -0.2, 0.5),
            Vec3::new(-0.7, 0.1, 0.4),
            Vec3::new(0.2, 0.9, -0.6),
            Vec3::new(0.5, 0.5, 0.1),
            Vec3::new(-0.4, 0.8, 0.3),
        ]
    }

    #[test]
    fn power_does_not_depend_on_the_point() {
        let [w, v, m, f, r] = vectors();
        let (twist, wrench) = (Twist::new(w, v), Wrench::new(m, f));
        assert!((twist.dot(&wrench) - twist.about(&r).dot(&wrench.about(&r))).abs() < ROUND_OFF);
    }

    #[test]
    fn cross_products_are_dual() {
        let [w, v, m, f, r] = vectors();
        let (a, b, g) = (Twist::new(w, v), Twist::new(r, m), Wrench::new(v, f));
        assert!((a.cross_motion(&b).dot(&g) + b.dot(&a.cross_force(&g))).abs() < ROUND_OFF);
    }
}
