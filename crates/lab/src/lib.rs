//! Small experiments with one body or two: the contact and friction laws at work, each figure beside its closed form.
//!
//! An [`Experiment`] is a name, a question and a function; it answers with an [`Outcome`]: figures that say what they
//! should be and whether they are, charts, and where there is something to see the log of a run with its scene.
//!
//! **scene** ([`mod@bench`]: a [`sim::ModelSpec`] with what is seen) → **run** ([`bench::Rig`]) → figures and charts → files
//! ([`report`], [`chart_svg`]). One file per experiment in `experiments/`; the closed forms that need more than a line stand
//! in `exact/`, with their own tests.

pub mod bench;
mod chart;
pub mod exact;
mod experiments;
mod outcome;
pub mod real;
pub mod report;
pub mod scene;

pub use chart::chart_svg;
pub use experiments::catalogue;
pub use outcome::{Allowed, Chart, Curve, Experiment, Figure, LabError, Options, Outcome, Recording};

/// An experiment by its name.
pub fn find(name: &str) -> Option<Experiment> {
    catalogue().into_iter().find(|e| e.name == name)
}
