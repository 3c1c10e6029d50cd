//! A triangle of a mesh as a convex piece.

use crate::convex::ALONG;
use crate::patch::Patch;
use spatial::Vec3;

/// A triangle of a mesh, with the numbers that its features have in the mesh.
#[derive(Clone, Debug)]
pub(crate) struct Triangle {
    /// Corners, m.
    pub(crate) p: [Vec3; 3],
    /// Unit normal by the winding.
    pub(crate) normal: Vec3,
    /// Numbers of the corners; internal where all edges around are flat.
    pub(crate) vertices: [u32; 3],
    /// Numbers of the edges p0p1, p1p2, p2p0; internal where the mesh is flat across.
    pub(crate) edges: [u32; 3],
    /// Number of the flat face of the mesh that it belongs to.
    pub(crate) face: u32,
    /// Half of its smallest height, m.
    pub(crate) scale: f64,
}

impl Triangle {
    /// The corner furthest along `d`.
    #[inline]
    pub(crate) fn support(&self, d: &Vec3) -> Vec3 {
        self.p[self.support_index(d)]
    }

    #[inline]
    fn support_index(&self, d: &Vec3) -> usize {
        let s = [self.p[0].dot(d), self.p[1].dot(d), self.p[2].dot(d)];
        if s[0] >= s[1] && s[0] >= s[2] {
            0
        } else if s[1] >= s[2] {
            1
        } else {
            2
        }
    }

    /// The triangle, its normal turned towards `d`.
    pub(crate) fn face_patch(&self, d: &Vec3, out: &mut Patch) {
        if self.normal.dot(d) >= 0.0 {
            out.begin(self.normal, self.face);
            for i in 0..3 {
                out.push(self.p[i], self.vertices[i], self.edges[i]);
            }
        } else {
            out.begin(-self.normal, self.face);
            for i in [2, 1, 0] {
                out.push(self.p[i], self.vertices[i], self.edges[(i + 2) % 3]);
            }
        }
    }

    /// The edge or corner that supports the unit vector `d`, as (corner, edge if it is one).
    pub(crate) fn supporting(&self, d: &Vec3) -> (usize, Option<usize>) {
        let v = self.support_index(d);
        let cosine = |e: usize| {
            let along = self.p[(e + 1) % 3] - self.p[e];
            along.dot(d).abs() / along.norm()
        };
        let (e, f) = (v, (v + 2) % 3);
        let best = if cosine(e) <= cosine(f) { e } else { f };
        (v, (cosine(best) < ALONG).then_some(best))
    }

    /// The edge or corner that supports the unit vector `d`.
    pub(crate) fn edge_patch(&self, d: &Vec3, out: &mut Patch) {
        out.begin(*d, self.face);
        match self.supporting(d) {
            (_, Some(e)) => {
                for v in [e, (e + 1) % 3] {
                    out.push(self.p[v], self.vertices[v], self.edges[e]);
                }
            }
            (v, None) => out.push(self.p[v], self.vertices[v], self.vertices[v]),
        }
    }
}
