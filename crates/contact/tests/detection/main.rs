//! Contact points of pairs of shapes: where they are, who they are, and what they cost.

#![allow(clippy::unwrap_used)]

mod bad_input;
mod bars;
mod beds;
mod broad_phase;
mod closed_form;
mod handover;
mod identity;
mod properties;
mod support;
