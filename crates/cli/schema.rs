//! `softdock schema`: the JSON Schema of the scenario file, for editors, or of `diagnosis.json`, for programs.

use crate::Status;
use std::io::Write;

/// Arguments of `softdock schema`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The schema of diagnosis.json instead
    #[arg(long)]
    diagnosis: bool,
}

/// Prints the schema.
pub(crate) fn main(arguments: &Arguments) -> anyhow::Result<Status> {
    let schema = match arguments.diagnosis {
        true => softdock::diagnose::diagnosis::json_schema(),
        false => softdock::scenario::json_schema(),
    };
    let mut out = std::io::stdout().lock();
    serde_json::to_writer_pretty(&mut out, &schema)?;
    writeln!(out)?;
    Ok(Status::AsExpected)
}
