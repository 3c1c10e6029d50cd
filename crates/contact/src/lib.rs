//! Shapes, contact points with identity, and normal laws, on parry3d (f64).
//!
//! A [`Scene`] is what may touch what: colliders, fixed in bodies, and the pairs of them that are looked at. A
//! [`Detector`] finds, for the poses of the bodies, the [`ContactPoint`]s of each pair:
//!
//!   gap = n · (b − a),      n: unit, from A to B;  a, b: witness points on the two surfaces;  gap < 0: penetration
//!
//! # A pure function of the poses
//!
//! Nothing is warm-started and nothing remembered, so the points are the same whatever was asked before: snapshots,
//! Runge–Kutta stages and replays see the same contact. All shapes are answered in closed form (the rim of a cylinder on an
//! edge by bisection), with gaps exact to round-off, so that what rests stays at rest; of hulls and meshes parry3d proposes
//! the direction from a cold start, and the face, edges or vertex it stands for give the answer. The rims of two cylinders
//! and deep overlaps are left to parry3d, to about 1e-9 m (the normal of two crossing rims to about 1e-5 rad); the side of
//! one cylinder over the rim of another is within half a per cent of its radius.
//!
//! Docking shapes ([`Docking`]: drogue, bore, ring, petal) are smooth surfaces of revolution with exact gaps, against each
//! other and against the primitives; how many points they make, and how stiff a seat is, stands in their module.
//!
//! # Identity
//!
//! [`ContactPoint::feature`] names the vertex of one body, or the edge of each, that makes the point, mixed with the part of
//! a compound they belong to. It does not name faces, and where faces lie on each other both lend their normal, so nothing
//! jumps when a resting body rocks by round-off. Coplanar triangles of hulls and meshes are one face: a body slides over
//! them without feeling a seam. Where two points have the same features, an ordinal along A tells them apart. Where
//! features say nothing (a ball that rolls) it is constant, and the nearest position decides.
//!
//! At most 16 points of a pair stay, with weights that keep what all of them do together where a face lies on a face.
//!
//! # Distributed contact
//!
//! A [`Bed`] spreads contact over a face by samples with areas; each of its points has a [`ContactPoint::weight`] that scales
//! the pair's law. Its points are not reduced, and known by their sample.
//!
//! # Limits
//!
//! A closed mesh is a solid (turned if it is inside out), an open one thin and two-sided; a body that is wholly inside one
//! touches nothing. Penetration is meant to be small beside the
//! shapes: deep and concentric pairs give a finite unit normal, but not always the shortest way out. Two half-spaces
//! never touch.

mod analytic;
mod axes;
mod bed;
mod bed_faces;
mod bed_points;
mod convex;
mod cylinder;
mod decompose;
mod decompose_cell;
mod decompose_measure;
mod detector;
mod docking;
mod error;
mod faceted;
mod glob;
mod manifold;
mod normal;
mod overlap;
mod patch;
mod primitive;
mod reduce;
mod rim;
mod scene;
mod shape;

pub use bed::{Bed, BedSample};
pub use decompose::{DecomposeOptions, Decomposition, calc_deviation, decompose};
pub use detector::Detector;
pub use docking::{Docking, DockingDispatcher, DockingShape, Tessellation};
pub use error::ContactError;
pub use glob::glob_matches;
pub use normal::{Normal, NormalForce, NormalLaw};
pub use scene::{ContactPoint, Scene};
pub use shape::{Collider, Shape};
