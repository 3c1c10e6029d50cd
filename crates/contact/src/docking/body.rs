//! A body that a docking shape meets: how far a point is from it, and which of its points and curves lead.

use super::arc::Curve;
use super::sheet::{Near, Sheet};
use crate::convex::{Convex, Core};
use crate::scene::Solid;
use spatial::{Frame, Vec3};

/// The sharp part of a body.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind<'a> {
    /// A ball's centre.
    Point,
    /// A capsule's axis, a box, a cylinder.
    Core(&'a Core),
    /// All below z = 0.
    Plane,
    /// A docking shape's piece.
    Sheet(&'a Sheet),
}

/// A body in a common frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Body<'a> {
    pub(crate) kind: Kind<'a>,
    /// Rounding radius, m.
    pub(crate) radius: f64,
    pub(crate) frame: Frame,
}

impl<'a> Body<'a> {
    /// A piece of a scene, if it is one that docking shapes answer.
    pub(crate) fn of(solid: &'a Solid, frame: &Frame) -> Option<Self> {
        let (kind, radius) = match solid {
            Solid::Ball(radius) => (Kind::Point, *radius),
            Solid::Primitive(Convex { core, radius }, _) => (Kind::Core(core), *radius),
            Solid::HalfSpace(_) => (Kind::Plane, 0.0),
            Solid::Docking(sheet, ..) => (Kind::Sheet(sheet), sheet.radius),
            _ => return None,
        };
        Some(Self { kind, radius, frame: *frame })
    }

    /// Another body's frame in this one's.
    pub(crate) fn frame_of(&self, other: &Self) -> Frame {
        let (own, frame) = (&self.frame, &other.frame);
        Frame { rot: own.rot.tr_mul(&frame.rot), pos: own.rot.tr_mul(&(frame.pos - own.pos)) }
    }

    /// Direction and distance of `p` from the core.
    #[inline]
    pub(crate) fn nearest(&self, p: &Vec3) -> Near {
        let local = self.frame.inverse_point(p);
        let near = match self.kind {
            Kind::Point => Near::from_away(local, Vec3::z),
            Kind::Plane => Near { normal: Vec3::z(), distance: local.z },
            Kind::Sheet(sheet) => sheet.nearest(&local),
            Kind::Core(core) => nearest_of_core(core, &local),
        };
        Near { normal: self.frame.rot * near.normal, ..near }
    }

    /// Length by which places on it are told apart, m.
    pub(crate) fn scale(&self) -> f64 {
        match self.kind {
            Kind::Sheet(sheet) => sheet.scale(),
            Kind::Core(core) if self.radius == 0.0 => 0.25 * Convex { core: *core, radius: 0.0 }.scale(),
            _ => self.radius,
        }
    }

    /// Points that lead whatever they meet: centre, ends, corners; how many of the array count.
    pub(crate) fn points(&self) -> ([Vec3; 8], usize) {
        let mut out = [Vec3::zeros(); 8];
        let count = match self.kind {
            Kind::Plane => 0,
            Kind::Point => {
                out[0] = self.frame.pos;
                1
            }
            Kind::Sheet(sheet) => {
                let (corners, count) = sheet.corners(&self.frame);
                out[..4].copy_from_slice(&corners);
                count
            }
            Kind::Core(core) => {
                let (corners, count) = Convex { core: *core, radius: 0.0 }.corners();
                out.iter_mut().zip(&corners).for_each(|(p, corner)| *p = self.frame.point(corner));
                count
            }
        };
        (out, count)
    }

    /// Curve number `i` with its rounding radius; `None` past the last.
    pub(crate) fn curve(&self, i: usize) -> Option<(Option<Curve>, f64)> {
        match self.kind {
            Kind::Point | Kind::Plane => None,
            Kind::Sheet(sheet) => sheet.curves(&self.frame).get(i).map(|curve| (*curve, self.radius)),
            Kind::Core(core) => {
                curve_of_core(core, &self.frame, i).map(|(curve, radius)| (Some(curve), radius + self.radius))
            }
        }
    }

    /// Whether a single closed curve is all there is of it.
    pub(crate) fn is_ring(&self) -> bool {
        matches!(self.kind, Kind::Sheet(sheet) if sheet.is_ring())
    }

    /// The sheet, if a ball can sit in it.
    pub(crate) fn seat(&self) -> Option<&'a Sheet> {
        match self.kind {
            Kind::Sheet(sheet) if sheet.has_seat() => Some(sheet),
            _ => None,
        }
    }
}

fn nearest_of_core(core: &Core, p: &Vec3) -> Near {
    let foot = Convex { core: *core, radius: 0.0 }.nearest(p);
    let (away, inside) = (p - foot, foot == *p && !matches!(core, Core::Segment { .. }));
    if inside {
        let (normal, distance) = crate::primitive::way_out(core, p);
        return Near { normal, distance };
    }
    Near::from_away(away, Vec3::x)
}

/// Rims and axis of a cylinder, axis of a capsule, edges of a box.
fn curve_of_core(core: &Core, frame: &Frame, i: usize) -> Option<(Curve, f64)> {
    let axis =
        |half: f64| Curve::segment(frame.point(&Vec3::new(0.0, 0.0, -half)), frame.point(&Vec3::new(0.0, 0.0, half)));
    match core {
        Core::Segment { half } => (i == 0).then(|| (axis(*half), 0.0)),
        Core::Cylinder(c) if i < 2 => {
            let centre = frame.point(&Vec3::new(0.0, 0.0, if i == 0 { -c.half } else { c.half }));
            let radii = [0, 1].map(|k| c.radius * frame.rot.column(k).into_owned());
            Some((Curve::arc(centre, radii, 0.0, std::f64::consts::TAU), 0.0))
        }
        Core::Cylinder(c) => (i == 2).then(|| (axis(c.half), c.radius)),
        Core::Cuboid { half } => (i < 12).then(|| {
            let (k, corner) = (i / 4, i % 4);
            let sign = |bit: usize| if corner & bit == 0 { -1.0 } else { 1.0 };
            let mut from = Vec3::zeros();
            (from[k], from[(k + 1) % 3], from[(k + 2) % 3]) =
                (-half[k], sign(1) * half[(k + 1) % 3], sign(2) * half[(k + 2) % 3]);
            let mut to = from;
            to[k] = half[k];
            (Curve::segment(frame.point(&from), frame.point(&to)), 0.0)
        }),
    }
}
