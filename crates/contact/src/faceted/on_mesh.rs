//! Meshes against convex pieces and against each other, triangle by triangle.
//!
//! A triangle alone does not know that its neighbour goes on where it ends: the nearest way out of it may lead across a
//! seam inside a flat plate. So the axis between the piece and the triangle is admitted only where the *mesh* has it:
//!   * near the face's normal: the faces overlap;
//!   * at a ridge or corner: within the cone of normals there, and only from the first triangle that has it;
//!   * elsewhere (across seams, in grooves): the face's own normal, if the piece is not much deeper behind it.
//!
//! Between two meshes an open one is solid behind its winding.
//!
//! Points at edges and vertices inside a flat face are dropped: the corners of the whole overlap say it all.

use super::mesh::{Bend, Mesh};
use super::narrow::{Axis, Couple, Kind, Narrow};
use super::piece::{Core, Piece};
use super::triangle::Triangle;
use crate::convex;
use crate::scene::to_parry;
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::partitioning::{Bvh, BvhNode};
use spatial::{Frame, Vec3};

/// Angle from the face's normal within which the face is meant, rad; also the least bend of a ridge.
const FACE: f64 = 1e-3;
/// Cosine beyond which two triangles of meshes lie face to face (within 2.5°).
const OPPOSED: f64 = -0.999;
/// How deep two meshes may be in each other and still meet face to face, in the smaller of their thicknesses.
const OVERLAP: f64 = 0.1;
/// How much deeper behind a face than the nearest way out a piece may be and still belong to the face, beside a ridge.
const DEEPER: f64 = 4.0;
/// The same across a seam or in a groove, where the surface goes on, in extents of the piece.
const SUNK: f64 = 0.5;

/// A mesh (A) and one convex piece (B), B's pose in A; `about`: B's bounding box, centre and half extents, in A.
pub(crate) struct OnMesh<'a> {
    pub(crate) mesh: &'a Mesh,
    pub(crate) piece: &'a Piece,
    pub(crate) ab: Frame,
    pub(crate) about: (Vec3, Vec3),
    pub(crate) margin: f64,
    /// The mesh that the piece is a triangle of, with its index there.
    pub(crate) from: Option<(&'a Mesh, u32)>,
    /// How deep two meshes may be in each other, m.
    pub(crate) deepest: f64,
}

/// What the mesh makes of an axis.
enum Verdict {
    /// The face itself, for pieces up to this deep behind it, m.
    Face(f64),
    Feature,
    Nothing,
}

/// Indices of the triangles within a box, ascending; appended to `out`.
pub(crate) fn triangles_within(tree: &Bvh, (centre, half): &(Vec3, Vec3), margin: f64, out: &mut Vec<u32>) {
    let half = half.add_scalar(margin);
    let query = BvhNode::leaf(Aabb::new(to_parry(&(centre - half)), to_parry(&(centre + half))), 0);
    let start = out.len();
    out.extend(tree.leaves(|node: &BvhNode| node.intersects(&query)));
    out[start..].sort_unstable();
}

impl OnMesh<'_> {
    /// Appends the points of the piece on the triangles `near`.
    pub(crate) fn add_points(&self, near: &[u32], narrow: &mut Narrow) {
        for &i in near {
            self.add_triangle(i, narrow);
        }
    }

    fn add_triangle(&self, i: u32, narrow: &mut Narrow) {
        let couple = Couple { a: &self.mesh.triangles[i as usize], b: self.piece, ab: self.ab, margin: self.margin };
        let Some(triangle) = self.mesh.triangle(i) else { return };
        // A closed mesh is solid behind its triangles; of an open one the piece's side is the outside.
        let behind = triangle.normal.dot(&(self.about.0 - triangle.p[0])) < 0.0;
        let side = if !self.mesh.closed && behind && self.from.is_none() { -1.0 } else { 1.0 };
        let outward = side * triangle.normal;
        if !self.faces_us(&outward) {
            return;
        }
        let face = couple.separation_of_face(&outward, &triangle.p[0]);
        if face - self.piece.radius > self.margin || self.is_beside(triangle) {
            return;
        }
        if self.lies_on(&outward, face) {
            narrow.add_overlap(&couple, &Axis { n: outward, gap: face, kind: Kind::Face });
            return;
        }
        let Some((axis, _)) = narrow.find_axis(&couple) else { return };
        match self.judge(i, triangle, &axis, side) {
            Verdict::Nothing => {}
            Verdict::Feature => narrow.add_manifold(&couple, &axis),
            Verdict::Face(deepest) if face - self.piece.radius >= -deepest - 1e-9 * triangle.scale => {
                narrow.add_overlap(&couple, &Axis { n: outward, gap: face, kind: Kind::Face });
            }
            Verdict::Face(_) => {}
        }
    }

    /// Whether the triangle is apart from the piece along one of a box's axes: cheaper than asking for the axis.
    fn is_beside(&self, triangle: &Triangle) -> bool {
        let Core::Primitive(convex::Core::Cuboid { half }) = &self.piece.core else { return false };
        let [p, q, r] = triangle.p.map(|p| self.ab.inverse_point(&p));
        let (low, high) = (p.inf(&q).inf(&r), p.sup(&q).sup(&r));
        (0..3).any(|k| low[k] > half[k] + self.margin || high[k] < -half[k] - self.margin)
    }

    /// Whether the piece, if it is a triangle of a closed mesh, does not turn its back on `outward`.
    fn faces_us(&self, outward: &Vec3) -> bool {
        match (&self.piece.core, self.from) {
            (Core::Triangle(t), Some((mesh, _))) if mesh.closed => (self.ab.rot * t.normal).dot(outward) < 0.5,
            _ => true,
        }
    }

    /// Whether the piece is a triangle of a mesh that lies face to face with this one, as deep as `face` < 0 behind it:
    /// taken by themselves such triangles are apart, on the wrong sides of each other.
    fn lies_on(&self, outward: &Vec3, face: f64) -> bool {
        match (&self.piece.core, self.from) {
            (Core::Triangle(t), Some(_)) => (self.ab.rot * t.normal).dot(outward) < OPPOSED && face > -self.deepest,
            _ => false,
        }
    }

    fn judge(&self, i: u32, triangle: &Triangle, axis: &Axis, side: f64) -> Verdict {
        let depth = axis.gap - self.piece.radius;
        let apart = depth > 0.0;
        let outward = side * triangle.normal;
        if axis.n.cross(&outward).norm() < FACE && axis.n.dot(&outward) > 0.0 {
            return Verdict::Face(f64::INFINITY);
        }
        let (corner, edge) = triangle.supporting(&axis.n);
        let admitted = match edge {
            Some(e) => self.on_edge(i, e, &axis.n, &outward, side),
            None => self.on_corner(i, corner, &axis.n),
        };
        match admitted {
            Some(true) if self.piece_admits(&-self.ab.rot.tr_mul(&axis.n)) => Verdict::Feature,
            Some(_) => Verdict::Nothing,
            None if self.goes_on(i, corner, edge, side) => {
                Verdict::Face(if apart { 0.0 } else { (SUNK * self.piece.scale()).max(-DEEPER * depth) })
            }
            // Apart and outside the cone at a ridge: another triangle is nearer.
            None if apart => Verdict::Nothing,
            None => Verdict::Face(-DEEPER * depth),
        }
    }

    /// Whether the surface goes on (flat or rising) across the edge, or across one of the edges at the corner.
    fn goes_on(&self, i: u32, corner: usize, edge: Option<usize>, side: f64) -> bool {
        let bends = &self.mesh.bends[i as usize];
        let across = |e: usize| match bends[e].0 {
            Bend::Flat => true,
            Bend::Border => false,
            Bend::Ridge { convex, .. } => convex != (side > 0.0),
        };
        edge.map_or_else(|| across(corner) || across((corner + 2) % 3), across)
    }

    /// Whether the edge has this normal and the triangle is its first; `None` if the edge has no such normal.
    fn on_edge(&self, i: u32, e: usize, n: &Vec3, outward: &Vec3, side: f64) -> Option<bool> {
        let (bend, first) = self.mesh.bends[i as usize][e];
        match bend {
            Bend::Border => Some(n.dot(outward) > -1.0 + FACE),
            Bend::Ridge { away, convex } if convex == (side > 0.0) && n.dot(&away) > FACE => Some(first),
            _ => None,
        }
    }

    /// The same for a vertex: all edges that leave it lean away from the normal.
    fn on_corner(&self, i: u32, corner: usize, n: &Vec3) -> Option<bool> {
        let v = self.mesh.corners[i as usize][corner] as usize;
        let from = self.mesh.points[v];
        let leans = |&w: &u32| {
            let along = self.mesh.points[w as usize] - from;
            along.dot(n) <= FACE * along.norm()
        };
        self.mesh.around[v].iter().all(leans).then_some(self.mesh.owner[v] == i)
    }

    /// Whether the mesh of a piece that is itself a triangle has a surface with the normal `n` there.
    fn piece_admits(&self, n: &Vec3) -> bool {
        let (Core::Triangle(t), Some((mesh, i))) = (&self.piece.core, self.from) else { return true };
        if n.cross(&t.normal).norm() < FACE {
            return n.dot(&t.normal) > 0.0 || !mesh.closed;
        }
        match t.supporting(n) {
            (_, Some(e)) => match mesh.bends[i as usize][e].0 {
                Bend::Border => true,
                Bend::Ridge { away, convex } => convex && n.dot(&away) > FACE,
                Bend::Flat => false,
            },
            (corner, None) => {
                let v = mesh.corners[i as usize][corner] as usize;
                mesh.around[v].iter().all(|&w| {
                    let along = mesh.points[w as usize] - mesh.points[v];
                    along.dot(n) <= FACE * along.norm()
                })
            }
        }
    }
}

impl Couple<'_> {
    /// Height of B's lowest point over the plane through `p` with the normal `n`, m.
    fn separation_of_face(&self, n: &Vec3, p: &Vec3) -> f64 {
        n.dot(&(self.low_of_b(n) - p))
    }
}

/// Two meshes, B's pose in A: B's triangles are the pieces.
pub(crate) fn add_mesh_on_mesh(
    (a, b): (&Mesh, &Mesh),
    ab: &Frame,
    margin: f64,
    scratch: &mut (Vec<u32>, Vec<u32>),
    narrow: &mut Narrow,
) {
    let ba = Frame { rot: ab.rot.transpose(), pos: -ab.rot.tr_mul(&ab.pos) };
    let (centre, half) = a.bounds;
    let deepest = OVERLAP * a.thickness().min(b.thickness());
    let reach = margin + deepest;
    scratch.0.clear();
    triangles_within(&b.tree, &(ba.point(&centre), ba.rot.abs() * half), reach, &mut scratch.0);
    for &j in &scratch.0 {
        let Some(t) = b.triangle(j) else { continue };
        let p = t.p.map(|p| ab.point(&p));
        let (low, high) = (p[0].inf(&p[1]).inf(&p[2]), p[0].sup(&p[1]).sup(&p[2]));
        let about = (0.5 * (low + high), 0.5 * (high - low));
        scratch.1.clear();
        triangles_within(&a.tree, &about, reach, &mut scratch.1);
        let piece = &b.triangles[j as usize];
        OnMesh { mesh: a, piece, ab: *ab, about, margin, from: Some((b, j)), deepest }.add_points(&scratch.1, narrow);
    }
}
