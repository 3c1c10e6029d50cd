//! The direction along which two convex primitives are farthest apart (or overlap least).
//!
//! For every unit vector u the cores are at least  |u · p| − w_A(u) − w_B(u)  apart (p: from A's centre to B's, w: half
//! widths), and some u attains the distance. For these cores it is one of few: the normal of a face of A or of B, the
//! common perpendicular of an edge of each, or the direction from one to a corner of the other (separating axes,
//! Gottschalk, Lin and Manocha 1996). A cylinder's rim against an edge is left
//! to [`crate::rim`].
//!
//! # Which of equals
//!
//! Two faces that lie on each other are equally good axes, and round-off would choose. So:
//!   * nearly parallel faces of A and B are *both* used: the normal is their weighted mean, the weights going smoothly from
//!     one to the other as the difference of their separations passes ± [`BLEND`] of the smaller shape's extent;
//!   * an edge pair whose normal lies within [`FLATTER`] of a face's normal is passed over for the face: the overlap of the
//!     faces has the point where those edges cross among its corners. From there to [`FLAT`] the normal turns from the
//!     face's to the edges', so that the force does not jump where edges take over and the other corners are left. Where the faces of both are nearly parallel, edges are
//!     not asked at all: their perpendiculars are all nearly normals of faces;
//!   * a cylinder that lies on a face meets it with a line, two points, for as long as the line is over the face: a bar that
//!     overhangs a pad and leans by a tenth of a milliradian is farthest apart along the pad's edge, but its other end has
//!     risen by a micrometre only. So the face goes before radii of the cylinder within [`FLAT`] of its normal, too, and only
//!     where the line is beside the face (then they differ by a rounding of the line's place) the radius is taken.

use crate::convex::{Convex, Core};
use spatial::{Frame, Vec3};

/// Cosine of the angle (10°) between two normals below which they count as the same side.
pub(crate) const FLAT: f64 = 0.984_807_753_012_208;
/// Cosine of the angle (5°) from which an edge pair's normal is mixed in.
const FLATTER: f64 = 0.996_194_698_091_745_5;
/// Difference of separations, in extents of the smaller shape, over which the normal goes from one face's to the other's.
const BLEND: f64 = 1e-2;
/// Axial part of a direction below which a cylinder that meets it lies on its side: the sine of the angle of [`FLAT`].
const LYING: f64 = 0.173_648_177_666_930_33;
/// Sine of the angle below which two edges have no common perpendicular.
const PARALLEL: f64 = 1e-3;
/// By how much, in extents, an edge pair must beat the faces.
const PREFER_FACE: f64 = 1e-3;
/// By how much, in extents, anything must beat what was found first: above round-off.
const PREFER_FIRST: f64 = 1e-12;

/// A direction from A to B and the distance of the cores along it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis {
    /// Unit vector, A's axes.
    pub(crate) normal: Vec3,
    /// Separation of the cores, m; negative: overlap.
    pub(crate) gap: f64,
    /// Whether it is the normal of a face (of A, of B, or between).
    pub(crate) face: bool,
}

/// Whether an axis is nearly the normal of a face.
fn is_flat_for(axis: &Axis, face: &Axis) -> bool {
    face.face && axis.normal.dot(&face.normal) > FLAT
}

/// The axis between a face and edges that beat it: the face's within [`FLATTER`] of the normal of either body's face, the
/// edges' beyond [`FLAT`], and turning from one to the other between.
fn hand_over(best: &Axis, edges: &Axis, faces: [&Axis; 2]) -> Axis {
    let cosine = |face: &Axis| if face.face { edges.normal.dot(&face.normal) } else { -1.0 };
    let x = (FLATTER - cosine(faces[0]).max(cosine(faces[1]))) / (FLATTER - FLAT);
    if x >= 1.0 || !best.face {
        return *edges;
    }
    if x <= 0.0 {
        return *best;
    }
    let weight = x * x * (3.0 - 2.0 * x);
    let normal = (weight * edges.normal + (1.0 - weight) * best.normal).normalize();
    Axis { normal, gap: best.gap, face: true }
}

/// The axis to use, and the one to use where the patches along it do not overlap.
pub(crate) struct Axes {
    pub(crate) best: Axis,
    pub(crate) otherwise: Option<Axis>,
}

/// Two primitives, B's pose in A.
pub(crate) struct Couple<'a> {
    pub(crate) a: &'a Convex,
    pub(crate) b: &'a Convex,
    pub(crate) frame_ab: Frame,
    /// The smaller extent of the two, m.
    pub(crate) scale: f64,
}

impl Couple<'_> {
    /// The axis to use; `None` where some axis shows that the cores are farther apart than `margin`, m.
    pub(crate) fn find_axis(&self, margin: f64) -> Option<Axes> {
        let none = Axis { normal: Vec3::z(), gap: f64::NEG_INFINITY, face: false };
        let (mut face_a, mut face_b, mut edges, mut points) = (none, none, none, none);
        for &k in self.a.face_axes() {
            self.improve(&mut face_a, Vec3::ith(k, 1.0), true);
        }
        for &k in self.b.face_axes() {
            self.improve(&mut face_b, self.frame_ab.rot.column(k).into_owned(), true);
        }
        if face_a.gap.max(face_b.gap) > margin {
            return None;
        }
        let both_flat = face_a.face && face_b.face && face_a.normal.dot(&face_b.normal) > FLAT;
        if !both_flat {
            self.try_edges(&mut edges);
        }
        if self.a.is_round() || self.b.is_round() {
            self.try_points(&mut points);
        }
        if edges.gap.max(points.gap) > margin {
            return None;
        }
        let mut best = self.blend(&face_a, &face_b);
        if edges.gap > best.gap + PREFER_FACE * self.scale {
            best = hand_over(&best, &edges, [&face_a, &face_b]);
        }
        // Edges that were passed over for a face are still farther apart than a point must be to win.
        if points.gap <= best.gap.max(edges.gap) + PREFER_FIRST * self.scale {
            return Some(Axes { best, otherwise: None });
        }
        let lies = is_flat_for(&points, &best) && self.meets_with_its_side(&points.normal);
        Some(if lies { Axes { best, otherwise: Some(points) } } else { Axes { best: points, otherwise: None } })
    }

    /// The best pair of edges, also where the faces of both are nearly parallel.
    pub(crate) fn find_edges(&self) -> Option<Axis> {
        let mut best = Axis { normal: Vec3::z(), gap: f64::NEG_INFINITY, face: false };
        self.try_edges(&mut best);
        best.gap.is_finite().then_some(best)
    }

    /// Whether one of the two is a cylinder that meets `n` with a line of its side.
    fn meets_with_its_side(&self, n: &Vec3) -> bool {
        let lies = |convex: &Convex, d: &Vec3| matches!(convex.core, Core::Cylinder(_)) && d.z.abs() < LYING;
        lies(self.a, n) || lies(self.b, &self.frame_ab.rot.tr_mul(n))
    }

    /// Takes the unit vector `u` (A's axes, either way round) where the cores are farther apart along it.
    #[inline]
    fn improve(&self, best: &mut Axis, u: Vec3, face: bool) {
        let apart = u.dot(&self.frame_ab.pos);
        let gap = apart.abs() - self.a.half_width(&u) - self.b.half_width(&self.frame_ab.rot.tr_mul(&u));
        if gap > best.gap + PREFER_FIRST * self.scale {
            *best = Axis { normal: if apart < 0.0 { -u } else { u }, gap, face };
        }
    }

    fn try_edges(&self, best: &mut Axis) {
        for &i in self.a.edge_axes() {
            let e = Vec3::ith(i, 1.0);
            for &j in self.b.edge_axes() {
                let u = e.cross(&self.frame_ab.rot.column(j));
                let sine = u.norm();
                if sine > PARALLEL {
                    self.improve(best, u / sine, false);
                }
            }
        }
    }

    /// Directions between one core and the other's corners or axis.
    fn try_points(&self, best: &mut Axis) {
        let Frame { rot, pos } = &self.frame_ab;
        let (corners, count) = self.b.corners();
        for corner in &corners[..count] {
            if let Some(u) = self.a.direction_to(&self.frame_ab.point(corner)) {
                self.improve(best, u, false);
            }
        }
        let (corners, count) = self.a.corners();
        for corner in &corners[..count] {
            if let Some(u) = self.b.direction_to(&self.frame_ab.inverse_point(corner)) {
                self.improve(best, rot * u, false);
            }
        }
        for (convex, axis) in [(self.a, Vec3::z()), (self.b, rot.column(2).into_owned())] {
            if matches!(convex.core, Core::Cylinder(_))
                && let Some(u) = (pos - axis * axis.dot(pos)).try_normalize(0.0)
            {
                self.improve(best, u, false);
            }
        }
    }

    /// The better of two faces, or their mean where they are nearly parallel and nearly equal.
    fn blend(&self, a: &Axis, b: &Axis) -> Axis {
        let lead = (a.gap - b.gap) / (BLEND * self.scale);
        if !(a.face && b.face) || a.normal.dot(&b.normal) < FLAT || lead.abs() >= 1.0 {
            return if b.gap > a.gap + PREFER_FIRST * self.scale { *b } else { *a };
        }
        let x = 0.5 * (1.0 + lead);
        let weight = x * x * (3.0 - 2.0 * x);
        let normal = (weight * a.normal + (1.0 - weight) * b.normal).normalize();
        Axis { normal, gap: a.gap.max(b.gap), face: true }
    }
}
