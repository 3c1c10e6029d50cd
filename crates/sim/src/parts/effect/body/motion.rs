//! Where a body-level effect acts, and how that place moves.
//!
//! Everything is told in the axes and about the origin of the *link* that the effect names; the link may be one of
//! several that fixed joints hold together. The centre of mass and the tensor are those of the whole rigid body that it
//! belongs to, with everything that moves inside it locked at rest: a leak pushes the body, not a bracket.

use spatial::{Frame, Mat3, Twist, Vec3, Wrench};

/// What a law must know of its body; constant, axes of the link L.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyPlace {
    /// Vehicle.
    pub vehicle: usize,
    /// Link of that vehicle.
    pub link: usize,
    /// Centre of mass of the link's rigid body from the link's origin, m.
    pub com: Vec3,
    /// Tensor of the link's rigid body about that centre, kg·m².
    pub tensor_com: Mat3,
}

/// The link at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyMotion {
    /// Link in W.
    pub frame_wl: Frame,
    /// Of the link, about its origin, W axes.
    pub twist: Twist,
    /// Since the run's start, s.
    pub time: f64,
}

impl BodyMotion {
    /// A force (W axes, N) at a point given from the link's origin in the link's axes, as a wrench about that origin.
    pub fn push_at(&self, force: Vec3, point_l: &Vec3) -> Wrench {
        Wrench::from_force_at(force, &(self.frame_wl.rot * point_l))
    }

    /// Velocity of the material point `point_l` (link's axes, m), W axes, m/s.
    pub fn velocity_at(&self, point_l: &Vec3) -> Vec3 {
        self.twist.at(&(self.frame_wl.rot * point_l))
    }
}

/// The axes that a constant vector is fixed in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axes {
    /// The link's: it turns with the body.
    Body,
    /// The world's.
    World,
}

impl Axes {
    /// The vector in W axes.
    pub(super) fn to_world(self, vector: &Vec3, rot_wl: &Mat3) -> Vec3 {
        match self {
            Self::Body => rot_wl * vector,
            Self::World => *vector,
        }
    }
}
