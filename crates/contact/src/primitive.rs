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
use crate::overlap::{Bulging, Overlap};
use crate::patch::Patch;
use spatial::{Frame, Vec3};

/// Length, in extents of the smaller shape, below which corners of an overlap coincide.
const SAME: f64 = 1e-6;

/// How far above the lowest place of a piece its lowest contact point must be for the piece to be beside the face, in
/// extents of the smaller shape.
const BESIDE: f64 = 1e-4;
/// Square of the extent of a face's points, in depths, below which edges are asked.
const NARROW: f64 = 100.0;

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
            self.prefer_edges(&couple, &axes.best, (frame_a, margin), (start, out));
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

    /// Where a face is the wrong choice, the edges that it was preferred to take its place, if their normal is not nearly its:
    /// where its points are all above the lowest place of the other (it is beside the face, a rim leans on an edge), and
    /// where they are close together beside their depth (two corners that overlap by a hair).
    fn prefer_edges(
        &mut self,
        couple: &Couple<'_>,
        axis: &Axis,
        (frame_a, margin): (&Frame, f64),
        (start, out): (usize, &mut Vec<Raw>),
    ) {
        let found = &out[start..];
        // Four points or more of boxes are a face's.
        let sharp = !couple.a.is_round() && !couple.b.is_round();
        if !axis.face || (sharp && found.len() >= 4) {
            return;
        }
        let least = axis.gap + BESIDE * couple.scale;
        let deepest = found.iter().map(|p| p.gap).fold(f64::INFINITY, f64::min);
        let width = found.iter().map(|p| (p.point_a - found[0].point_a).norm_squared()).fold(0.0, f64::max);
        let beside = deepest + couple.a.radius + couple.b.radius > least;
        let rim = if beside { couple.find_rim_axis() } else { None };
        let edges = if deepest < 0.0 && width < NARROW * deepest * deepest { couple.find_edges() } else { None };
        let better = |other: &Axis| other.gap > least && other.normal.dot(&axis.normal) < FLAT;
        if let Some(other) = rim.or(edges).filter(better) {
            let before = out.len();
            if self.add_along(couple, &other, (frame_a, margin), out) {
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
        let normal_b = couple.frame_ab.rot.tr_mul(&axis.normal);
        let (bulge_a, bulge_b) = (couple.a.bulge(&axis.normal), couple.b.bulge(&normal_b));
        self.overlap.round = if axis.face { bulge_a.radius + bulge_b.radius } else { 0.0 };
        self.overlap_along(couple, axis);
        let start = out.len();
        let normal = frame_a.rot * axis.normal;
        let radius = couple.a.radius;
        for meeting in &self.overlap.found {
            let more = |bulge: &Bulge| meeting.bulge.map_or(0.0, |b| bulge.of(&b));
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
/// Over an edge, along n, its axis is h high and the surface is r / (n·u) lower at its lowest, u: common perpendicular of
/// edge and axis. Along n straight below the axis it is r / cos φ lower, φ: lean; the patch is there (a cylinder's line), or
/// on the axis, less r (a capsule's).
#[derive(Clone, Copy, Default)]
struct Bulge {
    radius: f64,
    /// r / cos φ, m.
    below: f64,
    /// What of it the patch or the rounding radius counts already, m.
    counted: f64,
}

impl Bulge {
    /// How much lower than the patch says the surface is over an edge, m. Beyond [`FLAT`] edges count for themselves.
    fn of(&self, at: &Bulging) -> f64 {
        let lowest = (self.radius / at.upright.max(FLAT)).max(self.below);
        at.along_line * (self.below - self.counted + at.along_edge * (lowest - self.below))
    }
}

impl Convex {
    fn bulge(&self, n: &Vec3) -> Bulge {
        let below = |radius: f64| radius / n.x.hypot(n.y).max(FLAT);
        match &self.core {
            Core::Cuboid { .. } => Bulge::default(),
            Core::Segment { .. } => Bulge { radius: self.radius, below: below(self.radius), counted: self.radius },
            Core::Cylinder(c) => Bulge { radius: c.radius, below: below(c.radius), counted: below(c.radius) },
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
