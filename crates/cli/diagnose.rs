//! `softdock diagnose`: where a scenario and a recording differ, what was left out, and how much better it predicts with it.

use anyhow::Result;
use clap::Args;
use std::path::PathBuf;
use crate::Status;

/// Arguments of `softdock diagnose`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The scenario that models the rig
    scenario: PathBuf,
    /// The folder of the recording, with its recording.toml
    recording: PathBuf,
    /// Folder for report.html, diagnosis.json and patched.toml [default: out/diagnose/RECORDING]
    #[arg(long)]
    out: Option<PathBuf>,
    /// Changes a value of the scenario first, e.g. vehicle.target.mass=3
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
}

/// Runs the command.
pub(crate) fn main(arguments: &Arguments) -> Result<Status> {
    let _ = &arguments.out;
    let scenario = softdock::scenario::load(&arguments.scenario, &arguments.set)?;
    let set = softdock::record::RecordingSet::load(&arguments.recording)?;
    softdock::diagnose::trial::run(scenario, &set)?;
    Ok(Status::AsExpected)
}
