//! Triangle meshes: welded, turned the right way out, with the topology that tells real edges from seams.
//!
//! Files give each triangle its own vertices; equal ones are welded. A mesh is *closed* if each edge belongs to two
//! triangles that run along it in opposite directions; a closed mesh of negative volume is turned about. Across a
//! *flat* edge (within [`FLAT`]) two triangles are one face: such an edge makes no contact, and the face has the number
//! of its first triangle, so that a body slides over a tessellated plate as over one face.

use super::INTERNAL;
use super::piece::{Core, Piece};
use super::triangle::Triangle;
use crate::scene::to_parry;
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy};
use spatial::Vec3;
use std::collections::BTreeMap;

/// Angle between neighbours below which they are one face, rad: above what 32-bit coordinates of files do to a plane.
const FLAT: f64 = 1e-4;

/// How the surface bends at an edge, seen from the winding's outside.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Bend {
    /// One face on both sides.
    Flat,
    /// Only one triangle (or more than two).
    Border,
    /// Bent, with the neighbour's in-plane direction away from itself across the edge.
    Ridge {
        /// Away from the neighbour, in its plane.
        away: Vec3,
        /// Outwards (a ridge) or inwards (a groove).
        convex: bool,
    },
}

/// A mesh, ready for contact.
#[derive(Clone)]
pub(crate) struct Mesh {
    /// Triangles as convex pieces.
    pub(crate) triangles: Vec<Piece>,
    /// Bend at the edges p0p1, p1p2, p2p0 of each triangle, and whether the triangle is the edge's first.
    pub(crate) bends: Vec<[(Bend, bool); 3]>,
    /// Vertex indices of each triangle.
    pub(crate) corners: Vec<[u32; 3]>,
    /// First triangle of each vertex.
    pub(crate) owner: Vec<u32>,
    /// Vertices that share an edge with each vertex.
    pub(crate) around: Vec<Vec<u32>>,
    /// Welded vertices, m.
    pub(crate) points: Vec<Vec3>,
    /// Their numbers; internal where all edges around are flat.
    pub(crate) numbers: Vec<u32>,
    /// Whether it encloses a volume.
    pub(crate) closed: bool,
    /// Triangles by place.
    pub(crate) tree: Bvh,
    /// Bounding box: centre and half extents, m.
    pub(crate) bounds: (Vec3, Vec3),
}

type Edges = BTreeMap<(u32, u32), Vec<(usize, usize)>>;

impl Mesh {
    /// From vertices and triangles whose indices are in range; `None` if no triangle has an area.
    pub(crate) fn build(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Option<Self> {
        let (points, weld) = weld(vertices);
        let mut corners: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(|v| weld[v as usize])).collect();
        corners.retain(|t| normal_of(&points, t).is_some());
        if corners.is_empty() {
            return None;
        }
        let closed = is_closed(&edges_of(&corners), &corners);
        if closed && volume(&points, &corners) < 0.0 {
            corners.iter_mut().for_each(|t| t.swap(1, 2));
        }
        let edges = edges_of(&corners);
        let normals: Vec<Vec3> = corners.iter().filter_map(|t| normal_of(&points, t)).collect();
        let mut mesh = Self::without_features(points, corners, closed);
        mesh.find_bends(&edges, &normals);
        mesh.number(&edges, &normals);
        Some(mesh)
    }

    fn without_features(points: Vec<Vec3>, corners: Vec<[u32; 3]>, closed: bool) -> Self {
        let boxes: Vec<Aabb> = corners.iter().map(|t| box_of(t.map(|v| points[v as usize]))).collect();
        let mut owner = vec![u32::MAX; points.len()];
        let mut around = vec![Vec::new(); points.len()];
        for (t, c) in corners.iter().enumerate() {
            for k in 0..3 {
                let (v, w) = (c[k] as usize, c[(k + 1) % 3] as usize);
                owner[v] = owner[v].min(t as u32);
                around[v].push(w as u32);
                around[w].push(v as u32);
            }
        }
        around.iter_mut().for_each(|a| {
            a.sort_unstable();
            a.dedup();
        });
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
        let (triangles, bends, numbers) = (Vec::new(), vec![[(Bend::Border, true); 3]; corners.len()], Vec::new());
        let bounds = bounds_of(&points);
        Self { triangles, bends, corners, owner, around, points, numbers, closed, tree, bounds }
    }

    fn find_bends(&mut self, edges: &Edges, normals: &[Vec3]) {
        for sides in edges.values() {
            let first = sides.iter().map(|s| s.0).min();
            for (i, &(t, k)) in sides.iter().enumerate() {
                let bend = match sides.as_slice() {
                    [_, _] => self.bend((t, k), sides[1 - i], normals),
                    _ => Bend::Border,
                };
                self.bends[t][k] = (bend, first == Some(t));
            }
        }
    }

    /// Bend at edge `k` of triangle `t`, whose neighbour is triangle `u` with its edge `l`.
    fn bend(&self, (t, k): (usize, usize), (u, l): (usize, usize), normals: &[Vec3]) -> Bend {
        let point = |tri: usize, i: usize| self.points[self.corners[tri][i % 3] as usize];
        let (from, opposite) = (point(t, k), point(u, l + 2));
        if normals[t].cross(&normals[u]).norm() < FLAT && normals[t].dot(&normals[u]) > 0.0 {
            return Bend::Flat;
        }
        let along = (point(t, k + 1) - from).normalize();
        let inward = opposite - from;
        let away = -(inward - along * along.dot(&inward)).normalize();
        Bend::Ridge { away, convex: normals[t].dot(&inward) < 0.0 }
    }

    /// Numbers faces (by first triangle), vertices and edges, and makes the triangles.
    fn number(&mut self, edges: &Edges, normals: &[Vec3]) {
        let (t, v) = (self.corners.len() as u32, self.points.len() as u32);
        let faces = self.flat_faces(edges);
        let bent = |s: &(usize, usize)| !matches!(self.bends[s.0][s.1].0, Bend::Flat);
        self.numbers = vec![INTERNAL; self.points.len()];
        let mut edge_numbers = vec![[INTERNAL; 3]; self.corners.len()];
        for (i, (ends, sides)) in edges.iter().enumerate() {
            if sides.iter().any(bent) {
                for end in [ends.0, ends.1] {
                    self.numbers[end as usize] = t + end;
                }
                for &(tri, k) in sides {
                    edge_numbers[tri][k] = t + v + i as u32;
                }
            }
        }
        for (i, corners) in self.corners.iter().enumerate() {
            let p = corners.map(|c| self.points[c as usize]);
            let longest = (0..3).map(|k| (p[(k + 1) % 3] - p[k]).norm()).fold(0.0, f64::max);
            let scale = 0.5 * (p[1] - p[0]).cross(&(p[2] - p[0])).norm() / longest;
            let vertices = corners.map(|c| self.numbers[c as usize]);
            let face = faces[i];
            let triangle = Triangle { p, normal: normals[i], vertices, edges: edge_numbers[i], face, scale };
            self.triangles.push(Piece { core: Core::Triangle(triangle), radius: 0.0 });
        }
    }

    /// The first triangle of the flat face of each triangle.
    fn flat_faces(&self, edges: &Edges) -> Vec<u32> {
        let mut parent: Vec<u32> = (0..self.corners.len() as u32).collect();
        for sides in edges.values() {
            if let [(t, k), (u, _)] = sides[..]
                && matches!(self.bends[t][k].0, Bend::Flat)
            {
                let (p, q) = (root(&mut parent, t as u32), root(&mut parent, u as u32));
                parent[p.max(q) as usize] = p.min(q);
            }
        }
        (0..parent.len() as u32).map(|i| root(&mut parent, i)).collect()
    }

    /// Smallest half extent of a closed mesh, largest of an open one, m.
    pub(crate) fn thickness(&self) -> f64 {
        if self.closed { self.bounds.1.min() } else { self.bounds.1.max() }
    }

    /// The triangle `i`.
    #[inline]
    pub(crate) fn triangle(&self, i: u32) -> Option<&Triangle> {
        match &self.triangles[i as usize].core {
            Core::Triangle(t) => Some(t),
            _ => None,
        }
    }
}

fn bounds_of(points: &[Vec3]) -> (Vec3, Vec3) {
    let low = points.iter().fold(Vec3::repeat(f64::INFINITY), |low, p| low.inf(p));
    let high = points.iter().fold(Vec3::repeat(f64::NEG_INFINITY), |high, p| high.sup(p));
    (0.5 * (low + high), 0.5 * (high - low))
}

/// parry's box of three points.
fn box_of(p: [Vec3; 3]) -> Aabb {
    let (low, high) = (p[0].inf(&p[1]).inf(&p[2]), p[0].sup(&p[1]).sup(&p[2]));
    Aabb::new(to_parry(&low), to_parry(&high))
}

fn root(parent: &mut [u32], mut i: u32) -> u32 {
    while parent[i as usize] != i {
        parent[i as usize] = parent[parent[i as usize] as usize];
        i = parent[i as usize];
    }
    i
}

/// Distinct vertices, and which of them each vertex is.
fn weld(vertices: &[Vec3]) -> (Vec<Vec3>, Vec<u32>) {
    let (mut points, mut seen) = (Vec::new(), BTreeMap::new());
    let weld = vertices.iter().map(|v| {
        // Adding zero makes −0 and 0 one.
        let key = [(v.x + 0.0).to_bits(), (v.y + 0.0).to_bits(), (v.z + 0.0).to_bits()];
        *seen.entry(key).or_insert_with(|| {
            points.push(*v);
            points.len() as u32 - 1
        })
    });
    let weld = weld.collect();
    (points, weld)
}

/// Unit normal by the winding; `None` for a triangle that is a line or a point.
fn normal_of(points: &[Vec3], t: &[u32; 3]) -> Option<Vec3> {
    let [a, b, c] = t.map(|v| points[v as usize]);
    let (e, f) = (b - a, c - a);
    let n = e.cross(&f);
    let longest = e.norm_squared().max(f.norm_squared()).max((c - b).norm_squared());
    (n.norm() > 1e-12 * longest).then(|| n.normalize())
}

/// Edges by their ends (smaller index first), each with its (triangle, side)s.
fn edges_of(corners: &[[u32; 3]]) -> Edges {
    let mut edges = Edges::new();
    for (t, c) in corners.iter().enumerate() {
        for k in 0..3 {
            let (v, w) = (c[k], c[(k + 1) % 3]);
            edges.entry((v.min(w), v.max(w))).or_default().push((t, k));
        }
    }
    edges
}

fn is_closed(edges: &Edges, corners: &[[u32; 3]]) -> bool {
    edges.values().all(|sides| match sides[..] {
        [(t, k), (u, l)] => corners[t][k] == corners[u][(l + 1) % 3],
        _ => false,
    })
}

fn volume(points: &[Vec3], corners: &[[u32; 3]]) -> f64 {
    let p = |v: u32| points[v as usize];
    // About a vertex, so that a mesh far from its origin does not cancel.
    let o = p(corners[0][0]);
    corners.iter().map(|t| (p(t[0]) - o).cross(&(p(t[1]) - o)).dot(&(p(t[2]) - o)) / 6.0).sum()
}
