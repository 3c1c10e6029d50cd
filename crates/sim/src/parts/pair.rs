//! The laws of one contact pair.

use contact::Normal;
use friction::{Friction, Pivot};
use spatial::{Mat3, Vec3};

/// The laws of one contact pair; both are forces on B, A the pair's first collider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairLaw {
    /// Along the normal.
    pub normal: Normal,
    /// In the tangent plane; `None` for a frictionless pair.
    pub friction: Option<Friction>,
    /// Against spinning and rolling, lumped in every point; `None` where several points of a patch do it.
    pub pivot: Option<Pivot>,
    /// Direction along which the friction levels are meant, for a law that differs across it.
    pub grain: Option<Grain>,
    /// Whether only the deepest point of the pair bears, under one identity wherever it moves to; else all of them do.
    pub only_deepest: bool,
}

impl PairLaw {
    /// Laws of forces alone, without a grain.
    pub fn new(normal: Normal, friction: Option<Friction>) -> Self {
        Self { normal, friction, pivot: None, grain: None, only_deepest: false }
    }

    /// Whether its points have memory.
    pub(crate) fn remembers(&self) -> bool {
        self.friction.is_some() || self.pivot.is_some()
    }
}

/// A direction of a surface, as brushed or turned: laid into the tangent plane at every point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grain {
    /// Whether it belongs to B; else to A.
    pub on_b: bool,
    /// The direction, axes of the body (of W for the world).
    pub axis: Vec3,
    /// Turn of the laid direction about the outward normal of the side it belongs to, rad.
    pub angle: f64,
}

impl Grain {
    /// The direction at a point with this normal, W axes, A and B turned by `rot_a` and `rot_b`; zero where it stands upright on the plane.
    pub(crate) fn calc_direction(&self, (rot_a, rot_b): (&Mat3, &Mat3), normal: &Vec3) -> Vec3 {
        let axis = if self.on_b { rot_b } else { rot_a } * self.axis;
        let laid = axis - normal * normal.dot(&axis);
        let laid = laid.try_normalize(UPRIGHT * axis.norm()).unwrap_or_default();
        if self.angle == 0.0 {
            return laid;
        }
        let outward = if self.on_b { -normal } else { *normal };
        let (sin, cos) = self.angle.sin_cos();
        laid * cos + outward.cross(&laid) * sin
    }
}

/// Sine of the angle to the normal below which a grain says nothing.
const UPRIGHT: f64 = 1e-6;
