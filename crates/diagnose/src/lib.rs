//! Where simulation and recording differ: locate it, name it, model it, show the fit improve.
//!
//! **scenario + recording → replay → residual → locate → hypotheses → fit → rank → report.** To diagnose is to search over
//! `[[effect]]` entries of a copy of the scenario; every hypothesis is simulated by the same `sim` that runs scenarios.

pub mod catalogue;
pub mod error;
pub mod facts;
pub mod fit;
pub mod guess;
pub mod hypothesis;
pub mod linear;
pub mod plant;
pub mod reading;
pub mod replay;
pub mod screen;
pub mod search;
pub mod start;
pub mod tape;
pub mod trial;

pub use error::DiagnoseError;
