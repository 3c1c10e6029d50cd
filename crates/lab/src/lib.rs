//! Small experiments with one body or two: the contact and friction laws at work, each figure beside its closed form.
//!
//! An [`Experiment`] is a name, a question and a function; it answers with an [`Outcome`]: figures that say what they
//! should be and whether they are, charts, and where there is something to see the log of a run with its scene.

mod outcome;
pub mod real;

pub use outcome::{Allowed, Chart, Curve, Experiment, Figure, LabError, Options, Outcome};

/// All experiments, in the order of the report.
pub fn catalogue() -> Vec<Experiment> {
    vec![]
}
