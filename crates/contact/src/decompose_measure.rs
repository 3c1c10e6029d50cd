//! A closed mesh as its decomposition asks it: what is inside, and how far another surface is from its own.

use crate::decompose::Hull;
use crate::decompose_cell::{Cell, Plane};
use crate::scene::{from_parry, to_parry};
use crate::{ContactError, Shape};
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::{ConvexPolyhedron, TriMesh};
use spatial::Vec3;
use std::f64::consts::TAU;

/// A closed mesh with outward triangles, its vertices each there once.
pub(crate) struct Surface {
    pub(crate) vertices: Vec<Vec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Diagonal of its box, m.
    pub(crate) size: f64,
}

/// A piece as the measure asks it.
struct Piece {
    shape: ConvexPolyhedron,
    planes: Vec<Plane>,
}

/// Distance off a surface, relative to the size, at which is looked whether another piece covers it.
const OFF: f64 = 1e-6;

impl Surface {
    /// Welds, checks that every edge has its two triangles, and turns the mesh right side out.
    pub(crate) fn new(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<Self, ContactError> {
        let open = |what| ContactError::OpenMesh { triangles: triangles.len(), what };
        if vertices.iter().flat_map(|v| v.iter()).any(|x| !x.is_finite()) {
            return Err(open("has a vertex that is not finite"));
        }
        if triangles.iter().flatten().any(|&i| i as usize >= vertices.len()) {
            return Err(open("names a vertex that does not exist"));
        }
        let (vertices, mut triangles) = weld(vertices, triangles);
        if !is_closed(&triangles) {
            return Err(open("is open: some edge does not have a triangle on each side"));
        }
        let low = vertices.iter().fold(Vec3::repeat(f64::INFINITY), |low, p| low.inf(p));
        let high = vertices.iter().fold(Vec3::repeat(f64::NEG_INFINITY), |high, p| high.sup(p));
        let six = |t: &[u32; 3]| {
            let [p, q, r] = t.map(|i| vertices[i as usize] - low);
            p.cross(&q).dot(&r)
        };
        let volume: f64 = triangles.iter().map(six).sum();
        if volume == 0.0 || triangles.is_empty() {
            return Err(open("encloses no volume"));
        }
        if volume < 0.0 {
            triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        Ok(Self { vertices, triangles, size: (high - low).norm() })
    }

    /// How often the mesh goes round a point: 1 inside, 0 outside (A. Van Oosterom and J. Strackee, "The solid angle of a
    /// plane triangle", IEEE Trans. Biomed. Eng. 30 (1983) 125–126).
    fn calc_winding(&self, p: &Vec3) -> f64 {
        let angle = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| self.vertices[i as usize] - p);
            let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
            let below = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
            a.dot(&b.cross(&c)).atan2(below)
        };
        self.triangles.iter().map(angle).sum::<f64>() / TAU
    }

    /// Whether most of a cell lies inside: its centre and points half-way to its corners have a say.
    pub(crate) fn holds(&self, cell: &Cell) -> bool {
        let eps = self.size * f64::EPSILON;
        let centre = cell.centre(eps);
        let inside = |p: Vec3| self.calc_winding(&p) > 0.5;
        let corners = cell.corners(eps);
        let some = corners.iter().step_by(1 + corners.len() / 16);
        let votes: Vec<bool> = some.map(|c| inside(0.5 * (centre + c))).chain([inside(centre)]).collect();
        2 * votes.iter().filter(|inside| **inside).count() > votes.len()
    }

    /// Points nearer than `reach` to a vertex of the mesh become it.
    pub(crate) fn snap(&self, points: Vec<Vec3>, reach: f64) -> Vec<Vec3> {
        let near = |p: Vec3| self.vertices.iter().find(|v| (*v - p).amax() <= reach).copied().unwrap_or(p);
        points.into_iter().map(near).collect()
    }

    /// See [`crate::calc_deviation`].
    pub(crate) fn calc_deviation(&self, pieces: &[Vec<Vec3>], spacing: f64) -> f64 {
        let pieces: Vec<Piece> = pieces.iter().filter_map(|p| Piece::new(p)).collect();
        let mesh = TriMesh::new(self.vertices.iter().map(to_parry).collect(), self.triangles.clone());
        let Ok(mesh) = mesh else { return f64::INFINITY };
        if pieces.is_empty() {
            return self.size;
        }
        let off = OFF * self.size;
        let mut worst = 0.0_f64;
        for_each_sample((&self.vertices, &self.triangles), spacing, |p, n| {
            worst = worst.max(miss(&pieces, p, &(p + off * n)));
        });
        for (i, piece) in pieces.iter().enumerate() {
            let (vertices, triangles) = piece.shape.to_trimesh();
            let vertices: Vec<Vec3> = vertices.into_iter().map(from_parry).collect();
            for_each_sample((&vertices, &triangles), spacing, |p, n| {
                let beyond = p + off * n;
                if !pieces.iter().enumerate().any(|(j, other)| j != i && other.calc_depth(&beyond) >= 0.0) {
                    worst = worst.max(mesh.distance_to_local_point(to_parry(p), false));
                }
            });
        }
        worst
    }
}

/// How far a point of the mesh's surface is from the union's: outside, the distance to the nearest piece; where the union
/// goes on beyond it, the depth in the piece that covers it most.
fn miss(pieces: &[Piece], p: &Vec3, beyond: &Vec3) -> f64 {
    let nearest = pieces.iter().map(|piece| piece.calc_distance(p)).fold(f64::INFINITY, f64::min);
    let covered = pieces.iter().any(|piece| piece.calc_depth(beyond) > 0.0);
    let buried = pieces.iter().map(|piece| piece.calc_depth(p)).fold(0.0, f64::max);
    nearest.max(if covered { buried } else { 0.0 })
}

impl Piece {
    fn new(corners: &[Vec3]) -> Option<Self> {
        let hull = Hull::of(corners)?;
        let plane = |t: &[u32; 3]| Plane::through(t.map(|i| hull.vertices[i as usize]));
        let planes = hull.triangles.iter().filter_map(plane).collect();
        let points = hull.vertices.iter().map(to_parry).collect();
        Some(Self { shape: ConvexPolyhedron::from_convex_mesh(points, &hull.triangles)?, planes })
    }

    /// Depth inside, m; negative outside.
    fn calc_depth(&self, p: &Vec3) -> f64 {
        self.planes.iter().map(|plane| -plane.height(p)).fold(f64::INFINITY, f64::min)
    }

    fn calc_distance(&self, p: &Vec3) -> f64 {
        let depth = self.calc_depth(p);
        if depth >= 0.0 {
            return 0.0;
        }
        // parry's distance has a tolerance of its own; near the surface the planes' is exact.
        let distance = self.shape.distance_to_local_point(to_parry(p), true);
        if distance < -2.0 * depth { distance.min(-depth) } else { distance }
    }
}

/// Corners, and inner points of cuts about `spacing` apart, of every triangle, with its outward normal.
fn for_each_sample((vertices, triangles): (&[Vec3], &[[u32; 3]]), spacing: f64, mut visit: impl FnMut(&Vec3, &Vec3)) {
    for t in triangles {
        let [p, q, r] = t.map(|i| vertices[i as usize]);
        let Some(plane) = Plane::through([p, q, r]) else { continue };
        let longest = (q - p).norm().max((r - p).norm()).max((r - q).norm());
        let k = (longest / spacing).ceil().clamp(1.0, 200.0) as usize;
        for i in 0..=k {
            for j in 0..=k - i {
                visit(&(p + (q - p) * (i as f64 / k as f64) + (r - p) * (j as f64 / k as f64)), &plane.n);
            }
        }
    }
}

/// The same mesh with every position there once, and without triangles that have lost a corner.
fn weld(vertices: &[Vec3], triangles: &[[u32; 3]]) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let key = |v: &Vec3| [v.x, v.y, v.z].map(|x| (x + 0.0).to_bits());
    let mut order: Vec<u32> = (0..vertices.len() as u32).collect();
    order.sort_by_key(|&i| (key(&vertices[i as usize]), i));
    let mut first: Vec<u32> = vec![0; vertices.len()];
    for (at, &i) in order.iter().enumerate() {
        let before = at.checked_sub(1).map(|b| order[b]);
        let same = before.filter(|&b| key(&vertices[b as usize]) == key(&vertices[i as usize]));
        first[i as usize] = same.map_or(i, |b| first[b as usize]);
    }
    let welded = triangles.iter().map(|t| t.map(|i| first[i as usize]));
    let triangles = welded.filter(|[a, b, c]| a != b && b != c && c != a).collect();
    (vertices.to_vec(), triangles)
}

/// Whether a shape is a mesh with a triangle on each side of every edge.
pub(crate) fn is_closed_mesh(shape: &Shape) -> bool {
    matches!(shape, Shape::TriMesh { vertices, triangles } if is_closed(&weld(vertices, triangles).1))
}

/// Whether every directed edge has its opposite.
fn is_closed(triangles: &[[u32; 3]]) -> bool {
    let edges = |turn: bool| {
        let mut out: Vec<(u32, u32)> = triangles
            .iter()
            .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
            .map(|(a, b)| if turn { (b, a) } else { (a, b) })
            .collect();
        out.sort_unstable();
        out
    };
    edges(false) == edges(true)
}
