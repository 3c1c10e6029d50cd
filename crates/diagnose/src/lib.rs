//! Where simulation and recording differ: locate it, name it, model it, show the fit improve.
//!
//! **scenario + recording → replay → residual → locate → hypotheses → fit → rank → report.** To diagnose is to search over
//! `[[effect]]` entries of a copy of the scenario; every hypothesis is simulated by the same `sim` that runs scenarios.
//!
//! What comes out: a [`Diagnosis`] (`diagnosis.json`) and, behind it, [`Evidence`]; from the two the page of [`report`], the text
//! of [`summary_text`] and the scenario of [`patched_toml`]. The crate `score` judges diagnoses against answer keys.

mod accuracy;
mod along;
mod approaches;
pub mod attempt;
mod better;
mod bias;
pub mod catalogue;
mod choice;
mod clock;
mod condition;
mod curves;
mod delivery;
mod detect;
pub mod diagnosis;
pub mod effect_set;
pub mod error;
pub mod evidence;
mod excerpts;
pub mod facts;
mod feed;
pub mod fit;
mod flown;
pub mod guess;
pub mod held;
pub mod hypothesis;
pub mod identify;
pub mod judge;
mod limits;
pub mod linear;
pub mod locate;
mod lost;
mod mounts;
mod noise;
mod nothing;
mod number;
mod output;
mod pace;
mod parsimony;
mod patched;
pub mod place;
pub mod plant;
pub mod reading;
mod refits;
pub mod replay;
pub mod report;
pub mod run;
pub mod screen;
pub mod search;
pub mod select;
mod settle;
mod share;
mod sought;
mod stamps;
pub mod standing;
pub mod start;
mod stretches;
mod summary;
pub mod synthetic;
pub mod tape;
mod tell;
mod ties;
mod together;
mod uncertainty;
mod unheard;
mod vocabulary;
mod waves;
pub mod words;
pub mod work;

pub use diagnosis::Diagnosis;
pub use error::DiagnoseError;
pub use evidence::Evidence;
pub use output::{DIAGNOSIS_FILE, OutputError, write_diagnosis};
pub use patched::{FILE as PATCHED_FILE, patched_toml};
pub use report::report_html;
pub use run::diagnose;
pub use summary::{aligned, summary_text};
pub use synthetic::synthesise;
pub use vocabulary::{plain_name, unit};
pub use work::Watch;
