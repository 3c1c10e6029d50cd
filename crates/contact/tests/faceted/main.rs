//! Hulls and meshes beside the primitives: the same points, gaps and names, whatever a shape is made of.

#![allow(clippy::unwrap_used)]

mod gaps;
mod mesh;
mod motion;
mod parry;
mod smooth;
mod support;
