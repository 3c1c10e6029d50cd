//! Convex polytopes: parry's hull, its coplanar triangles merged.
//!
//! Features: vertices, then edges, then the whole.

use crate::convex::ALONG;
use crate::patch::Patch;
use crate::scene::from_parry;
use parry3d_f64::shape::ConvexPolyhedron;
use spatial::Vec3;

/// A face: its outward normal and its range in [`Polytope::ring`].
#[derive(Clone, Debug)]
struct Face {
    normal: Vec3,
    start: usize,
    end: usize,
}

/// A convex polytope.
#[derive(Clone, Debug)]
pub(crate) struct Polytope {
    points: Vec<Vec3>,
    faces: Vec<Face>,
    /// (vertex, edge that leaves it) of all faces, one after another.
    ring: Vec<(u32, u32)>,
    edges: Vec<[u32; 2]>,
    /// Smallest half extent, m.
    pub(crate) scale: f64,
}

impl Polytope {
    /// parry's hull, or `None` if a face of it has no area.
    pub(crate) fn of_hull(hull: &ConvexPolyhedron) -> Option<Self> {
        let points: Vec<Vec3> = hull.points().iter().map(|p| from_parry(*p)).collect();
        let ring = hull.vertices_adj_to_face().iter().copied().zip(hull.edges_adj_to_face().iter().copied()).collect();
        let mut out = Self { faces: Vec::new(), ring, edges: Vec::new(), scale: 0.0, points };
        out.edges = hull.edges().iter().map(|e| e.vertices).collect();
        for f in hull.faces() {
            let start = f.first_vertex_or_edge as usize;
            let end = start + f.num_vertices_or_edges as usize;
            let normal = out.newell(start, end)?;
            out.faces.push(Face { normal, start, end });
        }
        out.drop_inner_edges();
        out.scale = out.smallest_half_extent();
        (out.faces.len() >= 4).then_some(out)
    }

    /// Keeps only the edges that bound a face: parry also lists those between merged triangles.
    fn drop_inner_edges(&mut self) {
        let mut number = vec![u32::MAX; self.edges.len()];
        let mut kept = Vec::new();
        for (_, edge) in &mut self.ring {
            let old = *edge as usize;
            if number[old] == u32::MAX {
                number[old] = kept.len() as u32;
                kept.push(self.edges[old]);
            }
            *edge = number[old];
        }
        self.edges = kept;
    }

    /// Unit normal of a ring by Newell's sum: exact for planar rings, the mean plane for nearly planar ones.
    fn newell(&self, start: usize, end: usize) -> Option<Vec3> {
        let p = |i: usize| self.points[self.ring[i].0 as usize];
        let sum: Vec3 = (start + 1..end - 1).map(|i| (p(i) - p(start)).cross(&(p(i + 1) - p(start)))).sum();
        sum.try_normalize(0.0)
    }

    fn smallest_half_extent(&self) -> f64 {
        let width = |n: &Vec3| self.support(n).dot(n) - self.support(&-n).dot(n);
        self.faces.iter().map(|f| 0.5 * width(&f.normal)).fold(f64::INFINITY, f64::min)
    }

    /// Number of the piece as a whole.
    #[inline]
    pub(crate) fn whole(&self) -> u32 {
        (self.points.len() + self.edges.len()) as u32
    }

    pub(crate) fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// Outward unit normal of a face.
    pub(crate) fn normal(&self, face: usize) -> Vec3 {
        self.faces[face].normal
    }

    pub(crate) fn corner_count(&self, face: usize) -> usize {
        self.faces[face].end - self.faces[face].start
    }

    /// A corner of a face, counter-clockwise, m.
    #[inline]
    pub(crate) fn corner(&self, face: usize, i: usize) -> Vec3 {
        self.points[self.ring[self.faces[face].start + i].0 as usize]
    }

    /// The vertices, m.
    pub(crate) fn points(&self) -> &[Vec3] {
        &self.points
    }

    #[inline]
    fn support_index(&self, d: &Vec3) -> usize {
        let (mut best, mut far) = (0, f64::NEG_INFINITY);
        for (i, p) in self.points.iter().enumerate() {
            let s = p.dot(d);
            if s > far {
                (best, far) = (i, s);
            }
        }
        best
    }

    /// The vertex furthest along `d`.
    #[inline]
    pub(crate) fn support(&self, d: &Vec3) -> Vec3 {
        self.points[self.support_index(d)]
    }

    fn face(&self, d: &Vec3) -> &Face {
        let (mut best, mut far) = (0, f64::NEG_INFINITY);
        for (i, f) in self.faces.iter().enumerate() {
            let s = f.normal.dot(d);
            if s > far {
                (best, far) = (i, s);
            }
        }
        &self.faces[best]
    }

    /// Normal of the face that looks most along `d`.
    pub(crate) fn face_normal(&self, d: &Vec3) -> Vec3 {
        self.face(d).normal
    }

    /// All face normals and edge vectors.
    pub(crate) fn collect_directions(&self, faces: &mut Vec<Vec3>, edges: &mut Vec<Vec3>) {
        faces.extend(self.faces.iter().map(|f| f.normal));
        edges.extend(self.edges.iter().map(|e| self.points[e[1] as usize] - self.points[e[0] as usize]));
    }

    /// The face that looks most along `d`.
    pub(crate) fn face_patch(&self, d: &Vec3, out: &mut Patch) {
        let face = self.face(d);
        out.begin(face.normal, self.whole());
        for &(v, e) in &self.ring[face.start..face.end] {
            out.push(self.points[v as usize], v, self.points.len() as u32 + e);
        }
    }

    /// The edge at the support vertex that is most perpendicular to the unit vector `d`, or that vertex alone.
    pub(crate) fn edge_patch(&self, d: &Vec3, out: &mut Patch) {
        out.begin(*d, self.whole());
        let v = self.support_index(d);
        let mut best = (ALONG, None);
        for (i, e) in self.edges.iter().enumerate().filter(|(_, e)| e.contains(&(v as u32))) {
            let along = self.points[e[1] as usize] - self.points[e[0] as usize];
            let cosine = along.dot(d).abs() / along.norm();
            if cosine < best.0 {
                best = (cosine, Some(i));
            }
        }
        let first_edge = self.points.len() as u32;
        match best.1 {
            Some(i) => {
                for v in self.edges[i] {
                    out.push(self.points[v as usize], v, first_edge + i as u32);
                }
            }
            None => out.push(self.points[v], v as u32, v as u32),
        }
    }
}
