//! Any two convex pieces: the contact axis, and the points along it.
//!
//! The separation along a unit vector n (from A to B) is  sep(n) = min_B n·x − max_A n·x;  the largest over all n is the
//! distance, or minus the depth. parry's GJK and EPA find the n of the largest roughly: where surfaces are curved only
//! to 1e-4 rad. So they only *propose* it. Then every direction that it may stand for is tried in closed form: faces of
//! either piece, common perpendiculars of edges and axes, radii of cylinders; the best of them is the axis, exact and
//! smooth as long as the features stay the same. The proposal itself is left for the rest (a rim on an edge).

use super::INTERNAL;
use super::ascent::Ascent;
use super::nearest::{Nearest, on_polytope, on_triangle};
use super::piece::{Core, Piece};
use super::touch::Touch;
use crate::convex::ALONG;
use crate::overlap::Overlap;
use crate::patch::Patch;
use crate::scene::to_parry;
use parry3d_f64::math::{Pose as ParryPose, Vector};
use parry3d_f64::query::epa::EPA;
use parry3d_f64::query::gjk::{CsoPoint, GJKResult, VoronoiSimplex, closest_points};
use parry3d_f64::shape::SupportMap;
use spatial::{Frame, Vec3};

/// Length below which points coincide, in extents of the smaller piece.
const COINCIDE: f64 = 1e-6;
/// By how much B's face must beat a nearly parallel one of A, in extents of the smaller piece.
const PREFER_A: f64 = 1e-4;
/// By how much a pair of edges must beat the faces, in extents of the smaller piece.
const PREFER_FACE: f64 = 1e-5;
/// Cosine of the angle (8°) to a face's normal within which edges are passed over: the overlap of the faces has the point
/// where they cross among its corners.
const FLAT: f64 = 0.99;
/// By how much a proposal must beat a closed form, in extents: above the round-off of sep.
const ROUND_OFF: f64 = 1e-12;
/// As [`FLAT`], for the side of a cylinder or capsule (2 mrad): its line for the face's normal lies r φ²/2 above its line for the edge.
const FLAT_ROUND: f64 = 1.0 - 2e-6;
/// By how much parry's distance may differ from sep along its direction, in extents.
const BELIEVED: f64 = 1e-6;
/// Cosine of the angle to the proposal within which a closed form may stand for it.
const NEAR: f64 = 0.999;

/// What an axis is made of.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    /// Normal of a flat face: faces overlap.
    Face,
    /// Common perpendicular of two edges or axes.
    Edges,
    /// Through these two points of the cores.
    Points(Vec3, Vec3),
}

/// A direction in which two cores are furthest apart; in A's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis {
    /// Unit, from A to B.
    pub(crate) n: Vec3,
    /// Separation of the cores, m.
    pub(crate) gap: f64,
    /// What it is made of.
    pub(crate) kind: Kind,
}

/// Two convex pieces, B's pose in A, and the gap below which points matter.
#[derive(Clone, Copy)]
pub(crate) struct Couple<'a> {
    pub(crate) a: &'a Piece,
    pub(crate) b: &'a Piece,
    pub(crate) ab: Frame,
    pub(crate) margin: f64,
}

/// Scratch of the narrow phase.
#[derive(Default)]
pub(crate) struct Narrow {
    patch_a: Patch,
    patch_b: Patch,
    overlap: Overlap,
    epa: EPA,
    ascent: Ascent,
    /// Points found, in A's frame.
    pub(crate) out: Vec<Touch>,
}

impl Couple<'_> {
    /// Separation of the cores along `n`, m.
    #[inline]
    pub(crate) fn separation(&self, n: &Vec3) -> f64 {
        n.dot(&(self.low_of_b(n) - self.a.support(n)))
    }

    /// The point of B's core that lies furthest against `n`.
    #[inline]
    pub(crate) fn low_of_b(&self, n: &Vec3) -> Vec3 {
        self.ab.point(&self.b.support(&-self.axes_of_b(n)))
    }

    #[inline]
    pub(crate) fn axes_of_b(&self, n: &Vec3) -> Vec3 {
        self.ab.rot.tr_mul(n)
    }

    #[inline]
    fn radii(&self) -> f64 {
        self.a.radius + self.b.radius
    }

    #[inline]
    pub(crate) fn scale(&self) -> f64 {
        self.a.scale().min(self.b.scale())
    }

    /// The faces of A and B that look along a proposal, as axes; of −∞ separation where a piece has none.
    fn faces(&self, proposal: &Axis) -> (Axis, Axis) {
        let none = Axis { gap: f64::NEG_INFINITY, ..*proposal };
        let of_a = self.a.face_normal(&proposal.n).map_or(none, |n| self.axis_at(n, Kind::Face));
        let of_b = self.b.face_normal(&-self.axes_of_b(&proposal.n));
        (of_a, of_b.map_or(none, |n| self.axis_at(-(self.ab.rot * n), Kind::Face)))
    }

    /// The face that an axis is nearly the normal of, instead of the edges that it belongs to: the overlap of the faces
    /// has the point where the edges cross among its corners. Not for rims, whose chords would cut it off.
    fn flattened(&self, axis: Axis, faces: [Axis; 2]) -> Axis {
        let ball = Piece::is_ball;
        if matches!(axis.kind, Kind::Face) || ball(self.a) || ball(self.b) {
            return axis;
        }
        if matches!(axis.kind, Kind::Points(..)) && self.meets_end(&axis.n) {
            return axis;
        }
        let flat = if has_axis(self.a) || has_axis(self.b) { FLAT_ROUND } else { FLAT };
        let near = faces.into_iter().filter(|f| f.gap.is_finite() && f.n.dot(&axis.n) > flat);
        near.reduce(|f, g| if g.gap > f.gap { g } else { f }).unwrap_or(axis)
    }

    /// Whether a cylinder or a segment meets `n` with its end, not its side.
    fn meets_end(&self, n: &Vec3) -> bool {
        let end = |convex: &Piece, d: &Vec3| has_axis(convex) && d.z.abs() > ALONG;
        end(self.a, n) || end(self.b, &self.axes_of_b(n))
    }

    pub(crate) fn axis_at(&self, n: Vec3, kind: Kind) -> Axis {
        Axis { n, gap: self.separation(&n), kind }
    }
}

impl Narrow {
    /// Appends the points of two convex pieces.
    pub(crate) fn add_convex(&mut self, couple: &Couple) {
        let Some((axis, sharpest)) = self.find_axis(couple) else { return };
        let before = self.out.len();
        self.add_manifold(couple, &axis);
        // Edges that were passed over for a face cross at this height over it, if they are edges of that face at all.
        let crossing = sharpest.gap / axis.n.dot(&sharpest.n) - couple.radii();
        let found = self.smallest_gap(before);
        if found > crossing + PREFER_FACE * couple.scale() {
            self.add_manifold(couple, &sharpest);
        }
    }

    /// The smallest gap of the points from number `first` on, m; infinite where there are none.
    fn smallest_gap(&self, first: usize) -> f64 {
        self.out[first..].iter().map(|t| t.gap).fold(f64::INFINITY, f64::min)
    }

    /// The contact axis, and what it was before a face was preferred to edges beside it; `None` where the pieces are
    /// further apart than the margin.
    pub(crate) fn find_axis(&mut self, couple: &Couple) -> Option<(Axis, Axis)> {
        let Couple { a, b, ab, margin } = couple;
        let ball = |place: Nearest| [on_ball(place, &ab.pos); 2].into();
        let (axis, sharpest) = match (&a.core, &b.core) {
            (Core::Triangle(t), Core::Point) => ball(on_triangle(t, &ab.pos)),
            (Core::Polytope(p), Core::Point) => ball(on_polytope(p, &ab.pos)),
            _ => self.propose_and_snap(couple)?,
        };
        (axis.gap - couple.radii() < *margin).then_some((axis, sharpest))
    }

    /// Appends the points along an axis.
    pub(crate) fn add_manifold(&mut self, couple: &Couple, axis: &Axis) {
        let before = self.out.len();
        self.add_overlap(couple, axis);
        let found = self.smallest_gap(before);
        // Nothing there, or a rim's deepest place just beside the other's face: the nearest points themselves.
        let round = |convex: &Piece| convex.is_cylinder();
        let tol = COINCIDE * couple.scale();
        let lost = (round(couple.a) || round(couple.b)) && found > axis.gap - couple.radii() + tol;
        if before == self.out.len() || lost {
            self.add_witness(couple, axis, found - tol);
        }
    }

    /// Appends the overlap of the two faces (or edges) along the axis.
    pub(crate) fn add_overlap(&mut self, couple: &Couple, axis: &Axis) {
        let Couple { a, b, ab, margin } = couple;
        let against = -couple.axes_of_b(&axis.n);
        match axis.kind {
            Kind::Face => {
                a.face_patch(&axis.n, &mut self.patch_a);
                b.face_patch(&against, &mut self.patch_b);
            }
            _ => {
                a.edge_patch(&axis.n, &mut self.patch_a);
                b.edge_patch(&against, &mut self.patch_b);
            }
        }
        self.patch_b.transform(ab);
        let lone = |p: &Patch| p.corners.len() == 1;
        if !matches!(axis.kind, Kind::Face) && (lone(&self.patch_a) || lone(&self.patch_b)) {
            return;
        }
        let tol = COINCIDE * couple.scale();
        self.overlap.find(&self.patch_a, &self.patch_b, &axis.n, tol);
        for m in &self.overlap.found {
            let (a0, b0) = self.overlap.witnesses(m);
            let gap = axis.n.dot(&(b0 - a0)) - couple.radii();
            if gap < *margin && m.fa != INTERNAL && m.fb != INTERNAL {
                let (a, b) = (a0 + axis.n * a.radius, b0 - axis.n * b.radius);
                self.out.push(Touch { fa: m.fa, fb: m.fb, a, b, n: axis.n, gap });
            }
        }
    }

    /// Appends the one point through which the axis goes (a vertex, a rim, a ball) if its gap is below `limit`, m.
    fn add_witness(&mut self, couple: &Couple, axis: &Axis, limit: f64) {
        let Couple { a, b, margin, .. } = couple;
        let (n, sep, a0, b0) = match axis.kind {
            Kind::Points(a0, b0) => (axis.n, axis.gap, a0, b0),
            _ => match self.propose(couple) {
                // The faces do not overlap: the nearest points of the pieces, or the edges that were passed over.
                Some(Axis { n, gap, kind: Kind::Points(a0, b0) }) if gap > axis.gap => (n, gap, a0, b0),
                _ => (axis.n, axis.gap, a.support(&axis.n), couple.low_of_b(&axis.n)),
            },
        };
        // The separation is exact to second order in the error of n; parry's points on curved rims are not.
        let excess = 0.5 * (n.dot(&(b0 - a0)) - sep);
        let (a0, b0, gap) = (a0 + n * excess, b0 - n * excess, sep - couple.radii());
        let ball = a.is_ball() || b.is_ball();
        let of = |patch: &Patch, convex: &Piece| match patch.corners.as_slice() {
            _ if ball && !matches!(convex.core, Core::Triangle(_)) => convex.whole(),
            [c] => c.vertex,
            [c, _] => c.edge,
            _ => patch.whole,
        };
        let (fa, fb) = (of(&self.patch_a, a), of(&self.patch_b, b));
        if gap < margin.min(limit) && fa != INTERNAL && fb != INTERNAL {
            self.out.push(Touch { fa, fb, a: a0 + n * a.radius, b: b0 - n * b.radius, n, gap });
        }
    }

    /// parry's answer from a cold start: GJK, then EPA where the cores overlap.
    fn propose(&mut self, couple: &Couple) -> Option<Axis> {
        let (ours, theirs) =
            (Probe { convex: couple.a, frame: None }, Probe { convex: couple.b, frame: Some(&couple.ab) });
        let identity = ParryPose::IDENTITY;
        let mut simplex = VoronoiSimplex::new();
        let start = couple.ab.pos.try_normalize(0.0).unwrap_or(Vec3::x());
        simplex.reset(CsoPoint::from_shapes(&identity, &ours, &theirs, to_parry(&start)));
        let reach = couple.margin + couple.radii();
        let (found, side) = match closest_points(&identity, &ours, &theirs, reach, true, &mut simplex) {
            GJKResult::ClosestPoints(p, q, n) => (Some((p, q, n)), 1.0),
            GJKResult::NoIntersection(_) => return None,
            _ => (self.epa.closest_points(&identity, &ours, &theirs, &simplex), -1.0),
        };
        let Some((p, q, n)) = found else {
            return Some(self.ascent.find(couple, start));
        };
        let (p, q, n) = (Vec3::new(p.x, p.y, p.z), Vec3::new(q.x, q.y, q.z), Vec3::new(n.x, n.y, n.z));
        // Of well separated points the difference is the better direction; otherwise the search's own, the right way round.
        let n = n.try_normalize(0.0).unwrap_or(start);
        let apart = (q - p).try_normalize(1e-9 * couple.scale()).unwrap_or(n);
        let axes = [n, -n, apart].map(|n| couple.axis_at(n, Kind::Points(p, q)));
        let best = axes.into_iter().reduce(|x, y| if y.gap > x.gap { y } else { x })?;
        // Where the cores just touch, both searches may return any direction: sep tells.
        if best.gap < side * (q - p).norm() - BELIEVED * couple.scale() {
            let own = self.ascent.find(couple, best.n);
            return Some(if own.gap > best.gap { own } else { best });
        }
        best.gap.is_finite().then_some(best)
    }

    fn propose_and_snap(&mut self, couple: &Couple) -> Option<(Axis, Axis)> {
        let proposal = self.propose(couple)?;
        let scale = couple.scale();
        let (face_a, face_b) = couple.faces(&proposal);
        let parallel = face_a.n.dot(&face_b.n) > 0.98;
        let lead = if parallel { PREFER_A } else { ROUND_OFF } * scale;
        let mut best = if face_b.gap > face_a.gap + lead { face_b } else { face_a };
        // Sharp pieces: faces have a lead; rounded ones follow sep to the last bit.
        let sharp = couple.radii() == 0.0 && best.gap.is_finite();
        let floor = best.gap + if sharp { PREFER_FACE * scale } else { 0.0 };
        let mut improve = |axis: Axis| {
            if axis.gap > floor.max(best.gap + ROUND_OFF * scale) {
                best = axis;
            }
        };
        self.try_edges(couple, &proposal.n, &mut improve);
        try_radii(couple, &proposal.n, &mut improve);
        improve(proposal);
        Some((couple.flattened(best, [face_a, face_b]), best))
    }

    /// Common perpendiculars of the edges of the two faces that look along the proposal.
    fn try_edges(&mut self, couple: &Couple, n: &Vec3, improve: &mut impl FnMut(Axis)) {
        couple.a.face_patch(n, &mut self.patch_a);
        couple.b.face_patch(&-couple.axes_of_b(n), &mut self.patch_b);
        self.patch_b.transform(&couple.ab);
        for e in edges(couple.a, &self.patch_a) {
            for f in edges(couple.b, &self.patch_b) {
                let u = e.cross(&f);
                let len = u.norm();
                let along = u.dot(n);
                if len * len > 1e-6 * e.norm_squared() * f.norm_squared() && along.abs() > NEAR * len {
                    improve(couple.axis_at(u / (len * along.signum()), Kind::Edges));
                }
            }
        }
    }
}

/// Edge vectors of a patch; none of the chords of a cylinder's rim.
fn edges<'a>(convex: &Piece, patch: &'a Patch) -> impl Iterator<Item = Vec3> + 'a {
    let n = patch.corners.len();
    let count = match n {
        _ if convex.is_cylinder() && n > 2 => 0,
        0 | 1 => 0,
        2 => 1,
        _ => n,
    };
    (0..count).map(move |i| patch.corners[(i + 1) % n].p - patch.corners[i].p)
}

fn has_axis(convex: &Piece) -> bool {
    convex.has_axis()
}

/// The axis through the nearest place to a ball's centre.
fn on_ball(place: Nearest, centre: &Vec3) -> Axis {
    Axis { n: place.n, gap: place.gap, kind: Kind::Points(place.q, *centre) }
}

/// The radius of a cylinder or segment through the other piece's nearest vertex.
fn try_radii(couple: &Couple, n: &Vec3, improve: &mut impl FnMut(Axis)) {
    if has_axis(couple.a) {
        let q = couple.low_of_b(n);
        if let Some(u) = Vec3::new(q.x, q.y, 0.0).try_normalize(0.0).filter(|u| u.dot(n) > NEAR) {
            improve(couple.axis_at(u, Kind::Points(u * u.dot(&couple.a.support(&u)) + Vec3::z() * q.z, q)));
        }
    }
    if has_axis(couple.b) {
        let p = couple.a.support(n);
        let local = couple.ab.inverse_point(&p);
        let radial = Vec3::new(local.x, local.y, 0.0).try_normalize(0.0);
        if let Some(u) = radial.filter(|u| -(couple.ab.rot * u).dot(n) > NEAR) {
            let on = u * u.dot(&couple.b.support(&u)) + Vec3::z() * local.z;
            improve(couple.axis_at(-(couple.ab.rot * u), Kind::Points(p, couple.ab.point(&on))));
        }
    }
}

/// A core as parry asks it, in A's frame.
struct Probe<'a> {
    convex: &'a Piece,
    frame: Option<&'a Frame>,
}

impl SupportMap for Probe<'_> {
    fn local_support_point(&self, dir: Vector) -> Vector {
        let d = Vec3::new(dir.x, dir.y, dir.z);
        match self.frame {
            None => to_parry(&self.convex.support(&d)),
            Some(f) => to_parry(&f.point(&self.convex.support(&f.rot.tr_mul(&d)))),
        }
    }

    fn support_point(&self, _: &ParryPose, dir: Vector) -> Vector {
        self.local_support_point(dir)
    }

    fn support_point_toward(&self, _: &ParryPose, dir: Vector) -> Vector {
        self.local_support_point(dir)
    }
}
