//! Where simulation and recording differ: locate it, name it, model it, show the fit improve.
//!
//! **scenario + recording → replay → residual → locate → hypotheses → fit → rank → report.** To diagnose is to search over
//! `[[effect]]` entries of a copy of the scenario; every hypothesis is simulated by the same `sim` that runs scenarios.
//!
//! What comes out: a [`Diagnosis`] (`diagnosis.json`) and, behind it, [`Evidence`] (the report's figures). [`score`] judges
//! diagnoses against answer keys.

pub mod diagnosis;
pub mod evidence;
pub mod score;
mod summary;

pub use diagnosis::Diagnosis;
pub use evidence::Evidence;
