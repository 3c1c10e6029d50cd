//! Pairs of convex primitives (boxes, cylinders, capsules; balls against them), exact to round-off.
//!
//! The axis says along which direction they meet ([`crate::axes`]); the faces, edges or vertices that look along it are
//! projected onto each other ([`crate::overlap`]), and every corner of the overlap is a point:
//!   gap = height of B's patch over A's along n, less the rounding radii.
//! A point's feature names what made it (a vertex of B over A, a vertex of A under B, an edge of each) and neither the face
//! nor which of the two faces lent its normal, so it persists while those change hands.

use crate::analytic::Raw;
use crate::axes::{Axis, Couple};
use crate::convex::{Convex, Core};
use crate::overlap::Overlap;
use crate::patch::Patch;
use spatial::{Frame, Vec3};

/// Length, in extents of the smaller shape, below which corners of an overlap coincide.
const SAME: f64 = 1e-6;

/// Scratch of a pair.
#[derive(Debug, Default)]
pub(crate) struct PrimitiveBuffer {
    patch_a: Patch,
    patch_b: Patch,
    overlap: Overlap,
}

impl PrimitiveBuffer {
    /// Adds the points of A and B nearer than `margin`; says whether that answers the question. It does not where the
    /// cores come near each other and the axes show no overlap: the rims of two cylinders, a deep penetration.
    pub(crate) fn add_points(
        &mut self,
        (a, frame_a): (&Convex, &Frame),
        (b, frame_b): (&Convex, &Frame),
        margin: f64,
        out: &mut Vec<Raw>,
    ) -> bool {
        let frame_ab =
            Frame { rot: frame_a.rot.tr_mul(&frame_b.rot), pos: frame_a.rot.tr_mul(&(frame_b.pos - frame_a.pos)) };
        let couple = Couple { a, b, frame_ab, scale: a.scale().min(b.scale()) };
        let radii = a.radius + b.radius;
        let Some(axis) = couple.find_axis(margin + radii) else { return true };
        if self.add_along(&couple, &axis, (frame_a, margin), out) {
            return true;
        }
        match couple.find_rim_axis() {
            Some(axis) if axis.gap > margin + radii => true,
            Some(axis) => self.add_along(&couple, &axis, (frame_a, margin), out),
            None => false,
        }
    }

    /// Adds the points along an axis; whether there are any.
    fn add_along(
        &mut self,
        couple: &Couple<'_>,
        axis: &Axis,
        (frame_a, margin): (&Frame, f64),
        out: &mut Vec<Raw>,
    ) -> bool {
        self.overlap_along(couple, axis);
        let start = out.len();
        let normal = frame_a.rot * axis.normal;
        let radius = couple.a.radius;
        for meeting in &self.overlap.found {
            let gap = meeting.gap() - radius - couple.b.radius;
            if gap < margin {
                let (on_a, _) = self.overlap.witnesses(meeting);
                let point_a = frame_a.point(&(on_a + radius * axis.normal));
                out.push(Raw { feature: meeting.feature(), point_a, normal, gap });
            }
        }
        out.len() > start
    }

    fn overlap_along(&mut self, couple: &Couple<'_>, axis: &Axis) {
        let normal_b = -couple.frame_ab.rot.tr_mul(&axis.normal);
        if axis.face {
            couple.a.face_patch(&axis.normal, &mut self.patch_a);
            couple.b.face_patch(&normal_b, &mut self.patch_b);
        } else {
            couple.a.edge_patch(&axis.normal, &mut self.patch_a);
            couple.b.edge_patch(&normal_b, &mut self.patch_b);
        }
        self.patch_b.transform(&couple.frame_ab);
        self.overlap.find(&self.patch_a, &self.patch_b, &axis.normal, SAME * couple.scale);
    }

    /// A plane (the frame's z = 0, solid below) as A, a primitive as B.
    pub(crate) fn add_plane_points(
        &mut self,
        plane: &Frame,
        (b, frame_b): (&Convex, &Frame),
        margin: f64,
        out: &mut Vec<Raw>,
    ) {
        let normal = plane.rot.column(2).into_owned();
        b.face_patch(&-frame_b.rot.tr_mul(&normal), &mut self.patch_b);
        self.patch_b.transform(frame_b);
        for corner in &self.patch_b.corners {
            let height = normal.dot(&(corner.p - plane.pos));
            let gap = height - b.radius;
            if gap < margin {
                out.push(Raw { feature: u64::from(corner.vertex), point_a: corner.p - height * normal, normal, gap });
            }
        }
    }
}

/// A primitive as A, a ball as B: one point, without a feature of its own.
pub(crate) fn convex_ball(convex: &Convex, frame: &Frame, centre: &Vec3, radius: f64) -> Raw {
    let p = frame.inverse_point(centre);
    let (normal, gap) = match out_of(convex, &p) {
        Some((away, distance)) => (away / distance, distance),
        None => way_out(&convex.core, &p),
    };
    let gap = gap - convex.radius;
    let point_a = frame.point(&(p - gap * normal));
    Raw { feature: 0, point_a, normal: frame.rot * normal, gap: gap - radius }
}

/// From the core's nearest point to `p` outside of it, and the distance, m.
fn out_of(convex: &Convex, p: &Vec3) -> Option<(Vec3, f64)> {
    let away = p - convex.nearest(p);
    let distance = away.norm();
    (distance > 0.0).then_some((away, distance))
}

/// Outward normal and (negative) distance of the surface nearest to `p` inside the core.
pub(crate) fn way_out(core: &Core, p: &Vec3) -> (Vec3, f64) {
    let across = p.xy().norm();
    let radial = if across > 0.0 { Vec3::new(p.x / across, p.y / across, 0.0) } else { Vec3::x() };
    match core {
        Core::Segment { .. } => (radial, 0.0),
        Core::Cuboid { half } => {
            let depth = half - p.abs();
            let k = depth.imin();
            (Vec3::ith(k, 1f64.copysign(p[k])), -depth[k])
        }
        Core::Cylinder(c) => {
            let (side, end) = (c.radius - across, c.half - p.z.abs());
            if side <= end { (radial, -side) } else { (Vec3::new(0.0, 0.0, 1f64.copysign(p.z)), -end) }
        }
    }
}
