//! Recordings of real things, and what our laws make of them.
//!
//! The recordings are not part of softdock; `--data DIR` or the environment variable `SOFTDOCK_RECORDINGS` names the
//! folder that holds them, one folder per experiment:
//!
//! | folder | file | is |
//! | --- | --- | --- |
//! | `contactnets_cube` | `cube_tosses_000_149.csv` | 150 tosses of an acrylic cube onto a table, 148 Hz (Pfrommer, Halm and Posa 2020) |
//! | `fretting_friction` | `fretting_200hz.csv` | a loaded contact dragged to and fro over 0.24 mm, 200 Hz (FrictionModels.jl) |
//!
//! **recording → state and drive → law or world → errors → fit**; the entries of the catalogue are `entry_fretting` and
//! `entry_tosses`. Parameters are fitted on one part of a recording and judged on the other. By default the committed ones are judged;
//! with `--refit` they are found again first.

pub mod committed;
pub mod entry_fretting;
pub mod entry_tosses;
pub mod fretting;
pub mod fretting_fit;
mod search;
mod table;
pub mod toss;
pub mod toss_fit;
pub mod toss_world;

pub use search::{Found, Search};
pub use table::Table;

use crate::Experiment;
use std::path::{Path, PathBuf};

/// Environment variable that names the folder of the recordings.
pub const RECORDINGS: &str = "SOFTDOCK_RECORDINGS";

/// How the question of an experiment ends that cannot run without recordings.
pub const NEEDS_RECORDINGS: &str = "(needs recordings)";

/// Why a recording could not be judged.
#[derive(Debug, thiserror::Error)]
pub enum RealError {
    /// Nobody said where the recordings are.
    #[error(
        "no recordings: they are not part of softdock; give their folder with --data DIR or in {RECORDINGS} \
         (it holds contactnets_cube/ and fretting_friction/)"
    )]
    NoFolder,
    /// A file cannot be read.
    #[error("recording {path}: {source}; is --data the folder that holds contactnets_cube/ and fretting_friction/?")]
    Read {
        /// Which.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file is not what it should be.
    #[error("recording {path}: {problem}")]
    Content {
        /// Which.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
    /// The parameters do not make a model.
    #[error(transparent)]
    Model(#[from] sim::ModelError),
}

/// The folder of the recordings: as given, else from the environment; or `real` in it, where there is one.
pub fn find_folder(given: Option<&Path>) -> Result<PathBuf, RealError> {
    let from_environment = || std::env::var_os(RECORDINGS).filter(|folder| !folder.is_empty()).map(PathBuf::from);
    let folder = given.map(Path::to_owned).or_else(from_environment).ok_or(RealError::NoFolder)?;
    Ok(Some(folder.join("real")).filter(|real| real.is_dir()).unwrap_or(folder))
}

/// Whether an experiment cannot run because nobody said where its recordings are.
pub fn lacks_recordings(experiment: &Experiment, given: Option<&Path>) -> bool {
    experiment.question.ends_with(NEEDS_RECORDINGS) && find_folder(given).is_err()
}
