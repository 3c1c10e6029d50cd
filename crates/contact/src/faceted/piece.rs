//! A convex piece of this folder's pairs: a polytope, a triangle of a mesh, or a primitive that meets one.

use super::polytope::Polytope;
use super::triangle::Triangle;
use crate::convex::{self, Convex};
use crate::patch::Patch;
use spatial::Vec3;

/// The sharp part of a piece, in its own frame.
#[derive(Clone, Debug)]
pub(crate) enum Core {
    /// The origin.
    Point,
    /// A segment, a box or a cylinder about the origin.
    Primitive(convex::Core),
    /// The hull of points.
    Polytope(Polytope),
    /// A triangle of a mesh.
    Triangle(Triangle),
}

/// A convex piece.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    /// The core.
    pub(crate) core: Core,
    /// Rounding radius, m.
    pub(crate) radius: f64,
}

impl Piece {
    /// A ball.
    pub(crate) fn ball(radius: f64) -> Self {
        Self { core: Core::Point, radius }
    }

    /// A primitive.
    pub(crate) fn primitive(convex: &Convex) -> Self {
        Self { core: Core::Primitive(convex.core), radius: convex.radius }
    }

    /// A core of the primitives' kind, to ask it what they answer.
    #[inline]
    fn sharp(core: &convex::Core) -> Convex {
        Convex { core: *core, radius: 0.0 }
    }

    /// Number of the piece as a whole.
    #[inline]
    pub(crate) fn whole(&self) -> u32 {
        match &self.core {
            Core::Point => 0,
            Core::Primitive(core) => Self::sharp(core).whole(),
            Core::Polytope(p) => p.whole(),
            Core::Triangle(t) => t.face,
        }
    }

    /// Smallest extent, m: what tolerances are measured by.
    #[inline]
    pub(crate) fn scale(&self) -> f64 {
        match &self.core {
            Core::Point => self.radius,
            Core::Primitive(core) => Convex { core: *core, radius: self.radius }.scale(),
            Core::Polytope(p) => p.scale,
            Core::Triangle(t) => t.scale,
        }
    }

    /// The point of the core that lies furthest along `d` (any length).
    #[inline]
    pub(crate) fn support(&self, d: &Vec3) -> Vec3 {
        match &self.core {
            Core::Point => Vec3::zeros(),
            Core::Primitive(core) => Self::sharp(core).support(d),
            Core::Polytope(p) => p.support(d),
            Core::Triangle(t) => t.support(d),
        }
    }

    /// Outward normal of the flat face that looks most along the unit vector `d`.
    pub(crate) fn face_normal(&self, d: &Vec3) -> Option<Vec3> {
        match &self.core {
            Core::Point => None,
            Core::Primitive(core) => {
                let axes = core.face_axes().iter().copied();
                let k = axes.reduce(|i, j| if d[j].abs() > d[i].abs() { j } else { i })?;
                Some(Vec3::ith(k, 1f64.copysign(d[k])))
            }
            Core::Polytope(p) => Some(p.face_normal(d)),
            Core::Triangle(t) => Some(if t.normal.dot(d) < 0.0 { -t.normal } else { t.normal }),
        }
    }

    /// The face that looks most along the unit vector `d`; the segment or the point itself for those cores.
    pub(crate) fn face_patch(&self, d: &Vec3, out: &mut Patch) {
        match &self.core {
            Core::Point => self.edge_patch(d, out),
            Core::Primitive(core) => Self::sharp(core).face_patch(d, out),
            Core::Polytope(p) => p.face_patch(d, out),
            Core::Triangle(t) => t.face_patch(d, out),
        }
    }

    /// The edge or the vertex that supports the unit vector `d`.
    pub(crate) fn edge_patch(&self, d: &Vec3, out: &mut Patch) {
        match &self.core {
            Core::Point => {
                out.begin(*d, 0);
                out.push(Vec3::zeros(), 0, 0);
            }
            Core::Primitive(core) => Self::sharp(core).edge_patch(d, out),
            Core::Polytope(p) => p.edge_patch(d, out),
            Core::Triangle(t) => t.edge_patch(d, out),
        }
    }

    /// Whether it is a ball.
    #[inline]
    pub(crate) fn is_ball(&self) -> bool {
        matches!(self.core, Core::Point)
    }

    /// Whether it is a cylinder.
    #[inline]
    pub(crate) fn is_cylinder(&self) -> bool {
        matches!(self.core, Core::Primitive(convex::Core::Cylinder(_)))
    }

    /// Whether it is round about an axis: a capsule or a cylinder.
    #[inline]
    pub(crate) fn has_axis(&self) -> bool {
        matches!(self.core, Core::Primitive(convex::Core::Cylinder(_) | convex::Core::Segment { .. }))
    }
}
