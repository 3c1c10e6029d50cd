//! Pairs of convex primitives (boxes, cylinders, capsules; balls against them), exact to round-off.
//!
//! The axis says along which direction they meet ([`crate::axes`]); the faces, edges or vertices that look along it are
//! projected onto each other ([`crate::overlap`]), and every corner of the overlap is a point:
//!   gap = height of B's patch over A's along n, less the rounding radii.
//! A point's feature names what made it (a vertex of B over A, a vertex of A under B, an edge of each) and neither the face
//! nor which of the two faces lent its normal, so it persists while those change hands.

use crate::analytic::Raw;
use crate::axes::{Axis, Couple, FLAT};
use crate::convex::{Convex, Core};
use crate::overlap::Overlap;
use crate::patch::Patch;
use spatial::{Frame, Vec3};

/// Length, in extents of the smaller shape, below which corners of an overlap coincide.
const SAME: f64 = 1e-6;

/// How far above the lowest place of a piece its lowest contact point must be for the piece to be beside the face, in
/// extents of the smaller shape.
const BESIDE: f64 = 1e-4;

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
        let Some(axes) = couple.find_axis(margin + radii) else { return true };
        let start = out.len();
        if self.add_along(&couple, &axes.best, (frame_a, margin), out) {
            self.prefer_rim(&couple, &axes.best, (frame_a, margin), (start, out));
            return true;
        }
        // Along a face that the other does not lie over: apart by more than the margin, or nearest in another direction.
        match axes.otherwise {
            Some(axis) if axis.gap > margin + radii => return true,
            Some(axis) if self.add_along(&couple, &axis, (frame_a, margin), out) => return true,
            _ => {}
        }
        match couple.find_rim_axis() {
            Some(axis) if axis.gap > margin + radii => true,
            Some(axis) => self.add_along(&couple, &axis, (frame_a, margin), out),
            None => false,
        }
    }

    /// Where a face's points are all above the lowest place of the other (it is beside the face), a rim that leans on an
    /// edge takes their place, if its normal is not nearly the face's.
    fn prefer_rim(
        &mut self,
        couple: &Couple<'_>,
        axis: &Axis,
        (frame_a, margin): (&Frame, f64),
        (start, out): (usize, &mut Vec<Raw>),
    ) {
        let radii = couple.a.radius + couple.b.radius;
        let found = out[start..].iter().map(|p| p.gap).fold(f64::INFINITY, f64::min);
        if !axis.face || found + radii <= axis.gap + BESIDE * couple.scale {
            return;
        }
        let better = |rim: &Axis| rim.gap > axis.gap + BESIDE * couple.scale && rim.normal.dot(&axis.normal) < FLAT;
        if let Some(rim) = couple.find_rim_axis().filter(better) {
            let before = out.len();
            if self.add_along(couple, &rim, (frame_a, margin), out) {
                out.drain(start..before);
            }
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
        let normal_b = couple.frame_ab.rot.tr_mul(&axis.normal);
        let (bulge_a, bulge_b) = (couple.a.bulge(&axis.normal), couple.b.bulge(&normal_b));
        for meeting in &self.overlap.found {
            let more = |bulge: &Bulge| if meeting.upright < 1.0 { bulge.of(meeting.upright) } else { 0.0 };
            let radius = radius + more(&bulge_a);
            let gap = meeting.gap() - radius - couple.b.radius - more(&bulge_b);
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

/// How a lying cylinder or capsule bulges beside the line that its patch is.
///
/// Over an edge, along n, the axis is h high and the surface r / (n·u) lower at its lowest, u: common perpendicular of
/// edge and axis. The patch is r / cos φ below the axis (a cylinder's line; φ: lean) or r (a capsule's axis, less r).
#[derive(Clone, Copy, Default)]
struct Bulge {
    radius: f64,
    /// What the patch has already of r / (n·u), m.
    counted: f64,
}

impl Bulge {
    /// How much lower than the patch says the surface is over an edge, m. Beyond [`FLAT`] edges count for themselves.
    fn of(self, upright: f64) -> f64 {
        self.radius / upright.max(FLAT) - self.counted
    }
}

impl Convex {
    fn bulge(&self, n: &Vec3) -> Bulge {
        match &self.core {
            Core::Cuboid { .. } => Bulge::default(),
            Core::Segment { .. } => Bulge { radius: self.radius, counted: self.radius },
            Core::Cylinder(c) => Bulge { radius: c.radius, counted: c.radius / n.x.hypot(n.y).max(FLAT) },
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
fn way_out(core: &Core, p: &Vec3) -> (Vec3, f64) {
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
