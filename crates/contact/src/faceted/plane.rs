//! A half-space (z ≤ 0 of its frame) against hulls and meshes: the vertices under or near the plane.

use super::INTERNAL;
use super::mesh::Mesh;
use super::polytope::Polytope;
use super::touch::Touch;
use spatial::{Frame, Vec3};

/// Appends the vertices of a polytope (B), posed in the plane's frame, that are nearer than `margin`.
pub(crate) fn add_polytope(polytope: &Polytope, pose: &Frame, margin: f64, out: &mut Vec<Touch>) {
    for (i, p) in polytope.points().iter().enumerate() {
        add_vertex(pose.point(p), i as u32, margin, out);
    }
}

/// The same for a mesh, but not for vertices inside flat faces: the corners of the face say it all.
pub(crate) fn add_mesh(mesh: &Mesh, pose: &Frame, margin: f64, out: &mut Vec<Touch>) {
    for (p, &number) in mesh.points.iter().zip(&mesh.numbers) {
        if number != INTERNAL {
            add_vertex(pose.point(p), number, margin, out);
        }
    }
}

#[inline]
fn add_vertex(b: Vec3, fb: u32, margin: f64, out: &mut Vec<Touch>) {
    if b.z < margin {
        out.push(Touch { fa: 0, fb, a: Vec3::new(b.x, b.y, 0.0), b, n: Vec3::z(), gap: b.z });
    }
}
