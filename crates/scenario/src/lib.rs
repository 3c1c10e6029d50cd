//! The scenario file, strategies, success criteria and metrics.
//!
//! [`load`] reads a scenario file, applies `--set` overrides and checks everything at once; [`Scenario`] is the result.

mod build;
mod document;
pub mod effects;
mod error;
mod finished;
mod glob;
mod load;
pub mod measure;
mod navigation;
pub mod outcome;
mod overrides;
pub mod recording;
mod rig_log;
mod schema;
mod sensors;
pub mod spec;
mod spelling;
mod starter;
pub mod strategy;

pub use build::{
    DriveChannel, Mission, OwnInertials, Stock, build, build_from, check_start, docking_visuals, shape_of_geometry,
};
pub use document::Source;
pub use error::{Place, Problem, ScenarioError, ScenarioErrors};
pub use finished::{Finished, run};
pub use glob::{glob_matches, is_glob};
pub use load::{load, parse, to_toml};
pub use rig_log::RigLog;
pub use schema::json_schema;
pub use spec::Scenario;
pub use starter::starter;
