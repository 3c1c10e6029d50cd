//! `softdock schema`: the JSON Schema of the scenario file, for editors.

use crate::Status;
use std::io::Write;

/// Prints the schema.
pub(crate) fn main() -> anyhow::Result<Status> {
    let schema = softdock::scenario::json_schema();
    let mut out = std::io::stdout().lock();
    serde_json::to_writer_pretty(&mut out, &schema)?;
    writeln!(out)?;
    Ok(Status::AsExpected)
}
