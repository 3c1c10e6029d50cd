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
//! Runge–Kutta stages and replays see the same contact. Balls, boxes, capsules, cylinders and planes are answered in closed
//! form (the rim of a cylinder on an edge by bisection), with gaps exact to round-off, so that what rests stays at rest;
//! hulls and meshes, the rims of two cylinders and deep overlaps by parry3d's algorithms from a cold start, to about 1e-9 m
//! (the normal of two crossing rims to about 1e-5 rad).
//!
//! Docking shapes ([`Docking`]: drogue, bore, ring, petal) are smooth surfaces of revolution with exact gaps, against each
//! other and against the primitives; how many points they make, and how stiff a seat is, stands in their module.
//!
//! # Identity
//!
//! [`ContactPoint::feature`] names the vertex of one body, or the edge of each, that makes the point, mixed with the part of
//! a compound or the triangle of a mesh they belong to. It does not name faces, and where faces lie on each other both lend
//! their normal, so nothing jumps when a resting body rocks by round-off. Where parry3d names a pair of features twice, an
//! ordinal along A tells them apart. Where features say nothing (a ball that rolls) it is constant, and the nearest
//! position decides.
//!
//! # Limits
//!
//! Meshes are surfaces: a body that is wholly inside one touches nothing. Penetration is meant to be small beside the
//! shapes: deep and concentric pairs give a finite unit normal, but not always the shortest way out. Two half-spaces
//! never touch.

mod analytic;
mod axes;
mod convex;
mod cylinder;
mod detector;
mod docking;
mod error;
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

pub use detector::Detector;
pub use docking::{Docking, DockingDispatcher, DockingShape, Tessellation};
pub use error::ContactError;
pub use glob::glob_matches;
pub use normal::{Normal, NormalForce, NormalLaw};
pub use scene::{ContactPoint, Scene};
pub use shape::{Collider, Shape};
