//! Hulls and meshes against everything, in closed form where there is one.
//!
//! A hull is a polytope whose coplanar triangles are one face; a mesh is its triangles, with the topology that says which
//! of their edges are real ([`mesh`]). The axis of two convex pieces is proposed by parry3d's GJK and EPA from a cold
//! start and then replaced by the closed form that it stands for ([`narrow`]); which of the axes of single triangles a
//! mesh really has is judged by its topology ([`on_mesh`]). The points along an axis are those of the primitives: corners
//! of the overlap of two faces ([`crate::overlap`]), named by the two features that make them, whichever face gave the
//! normal.
//!
//! The pair is always asked in one order (half-space, mesh, hull, primitive), so exchanging A and B flips the normals.

mod ascent;
mod mesh;
mod narrow;
mod nearest;
mod on_mesh;
mod piece;
mod plane;
mod polytope;
mod touch;
mod triangle;

use crate::analytic::Raw;
use crate::manifold::mix;
use crate::scene::{Part, Solid};
use mesh::Mesh;
use narrow::{Couple, Narrow};
use on_mesh::{OnMesh, add_mesh_on_mesh, triangles_within};
use parry3d_f64::shape::SharedShape;
use piece::{Core, Piece};
use spatial::{Frame, Vec3};
use touch::{Touch, settle};

/// Number of a feature that makes no contact point of its own: an edge inside a flat face of a mesh.
const INTERNAL: u32 = u32::MAX;

/// A hull or a mesh.
#[derive(Clone)]
pub(crate) enum Faceted {
    Hull(Piece),
    Mesh(Box<Mesh>),
}

impl Faceted {
    /// parry's hull, or `None` if it spans no volume.
    pub(crate) fn hull(hull: &SharedShape) -> Option<Self> {
        let polytope = polytope::Polytope::of_hull(hull.as_convex_polyhedron()?)?;
        Some(Self::Hull(Piece { core: Core::Polytope(polytope), radius: 0.0 }))
    }

    /// A mesh whose indices are in range, with its welded vertices and triangles turned the right way out; `None` if no
    /// triangle has an area.
    pub(crate) fn mesh(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Option<(Vec<Vec3>, Vec<[u32; 3]>, Self)> {
        let mesh = Mesh::build(vertices, triangles)?;
        Some((mesh.points.clone(), mesh.corners.clone(), Self::Mesh(Box::new(mesh))))
    }
}

/// One of the two as this folder asks it.
enum Side<'a> {
    HalfSpace,
    Mesh(&'a Mesh),
    Hull(&'a Piece),
    Other(Piece),
}

impl Side<'_> {
    fn of(solid: &Solid) -> Option<Side<'_>> {
        Some(match solid {
            Solid::HalfSpace(_) => Side::HalfSpace,
            Solid::Other(_, Faceted::Mesh(mesh)) => Side::Mesh(mesh),
            Solid::Other(_, Faceted::Hull(piece)) => Side::Hull(piece),
            Solid::Ball(radius) => Side::Other(Piece::ball(*radius)),
            Solid::Primitive(convex, _) => Side::Other(Piece::primitive(convex)),
            Solid::Docking(_, _, Faceted::Mesh(mesh)) => Side::Mesh(mesh),
            Solid::Bed(_) | Solid::Docking(..) => return None,
        })
    }

    fn rank(&self) -> u8 {
        match self {
            Side::HalfSpace => 0,
            Side::Mesh(_) => 1,
            Side::Hull(_) => 2,
            Side::Other(_) => 3,
        }
    }

    fn piece(&self) -> Option<&Piece> {
        match self {
            Side::Hull(piece) => Some(piece),
            Side::Other(piece) => Some(piece),
            Side::HalfSpace | Side::Mesh(_) => None,
        }
    }
}

/// Scratch of a pair.
#[derive(Default)]
pub(crate) struct FacetBuffer {
    narrow: Narrow,
    triangles: (Vec<u32>, Vec<u32>),
}

impl FacetBuffer {
    /// Adds the points of two parts, of which one at least is a hull or a mesh, nearer than `margin`.
    pub(crate) fn add_points(
        &mut self,
        (a, frame_a): (&Part, &Frame),
        (b, frame_b): (&Part, &Frame),
        margin: f64,
        out: &mut Vec<Raw>,
    ) {
        let (Some(side_a), Some(side_b)) = (Side::of(&a.solid), Side::of(&b.solid)) else { return };
        let swapped = side_a.rank() > side_b.rank();
        let found = &mut self.narrow.out;
        found.clear();
        let (first, second) = ((&side_a, a, frame_a), (&side_b, b, frame_b));
        let frame = if swapped {
            self.find(second, first, margin);
            frame_b
        } else {
            self.find(first, second, margin);
            frame_a
        };
        settle(&mut self.narrow.out);
        let mut last = None;
        let mut ordinal = 0;
        for touch in &self.narrow.out {
            let key = (touch.fa, touch.fb);
            ordinal = if last == Some(key) { ordinal + 1 } else { 0 };
            last = Some(key);
            out.push(named(touch, ordinal, frame, swapped));
        }
    }

    /// Finds the points in the first's frame, whose rank is not above the second's.
    fn find(
        &mut self,
        (first, _, frame_a): (&Side<'_>, &Part, &Frame),
        (second, part_b, frame_b): (&Side<'_>, &Part, &Frame),
        margin: f64,
    ) {
        let ab = Frame { rot: frame_a.rot.tr_mul(&frame_b.rot), pos: frame_a.rot.tr_mul(&(frame_b.pos - frame_a.pos)) };
        match (first, second) {
            (Side::HalfSpace, Side::Mesh(mesh)) => plane::add_mesh(mesh, &ab, margin, &mut self.narrow.out),
            (Side::HalfSpace, Side::Hull(Piece { core: Core::Polytope(hull), .. })) => {
                plane::add_polytope(hull, &ab, margin, &mut self.narrow.out);
            }
            (Side::Mesh(a), Side::Mesh(b)) => {
                add_mesh_on_mesh((a, b), &ab, margin, &mut self.triangles, &mut self.narrow);
            }
            (Side::Mesh(mesh), other) => {
                let Some(piece) = other.piece() else { return };
                let about = (ab.point(&part_b.centre), ab.rot.abs() * part_b.half);
                self.triangles.0.clear();
                triangles_within(&mesh.tree, &about, margin, &mut self.triangles.0);
                let on = OnMesh { mesh, piece, ab, about, margin, from: None, deepest: 0.0 };
                on.add_points(&self.triangles.0, &mut self.narrow);
            }
            (a, b) => {
                let (Some(a), Some(b)) = (a.piece(), b.piece()) else { return };
                self.narrow.add_convex(&Couple { a, b, ab, margin });
            }
        }
    }
}

/// A point under its identity in W axes: two features, and an ordinal where points share both.
fn named(touch: &Touch, ordinal: u32, frame: &Frame, swapped: bool) -> Raw {
    let touch = if swapped { touch.swapped() } else { *touch };
    let feature = mix((u64::from(touch.fa) << 32) | u64::from(touch.fb), ordinal, 0);
    Raw { feature, point_a: frame.point(&touch.a), normal: frame.rot * touch.n, gap: touch.gap }
}
