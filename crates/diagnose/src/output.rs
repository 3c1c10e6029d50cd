//! The files of a diagnosis.

use crate::diagnosis::Diagnosis;
use crate::evidence::Evidence;
use crate::{patched, report};
use record::{OutputFolder, RecordError, write_file};
use scenario::{Scenario, ScenarioErrors};
use thiserror::Error;

/// Name of the machine-readable file.
pub const DIAGNOSIS_FILE: &str = "diagnosis.json";

/// Why the files of a diagnosis could not be written.
#[derive(Debug, Error)]
pub enum OutputError {
    /// A file could not be written.
    #[error(transparent)]
    Write(#[from] RecordError),
    /// The diagnosis has no JSON form.
    #[error("diagnosis.json cannot be written: {0}; this is a fault of softdock")]
    Json(#[from] serde_json::Error),
    /// The effects that were found cannot be written into the scenario.
    #[error("the scenario with the effects that were found is not sound:\n{0}")]
    Patched(ScenarioErrors),
}

/// Writes `diagnosis.json` and `report.html`, and `patched.toml` where effects were found.
pub fn write_diagnosis(
    folder: &OutputFolder,
    scenario: &Scenario,
    diagnosis: &Diagnosis,
    evidence: &Evidence,
) -> Result<(), OutputError> {
    write_file(&folder.file(DIAGNOSIS_FILE), diagnosis.to_json()?.as_bytes())?;
    write_file(&folder.file(report::FILE), report::report_html(diagnosis, evidence).as_bytes())?;
    if !diagnosis.effects.is_empty() {
        let text = patched::patched_toml(scenario, diagnosis, folder.target()).map_err(OutputError::Patched)?;
        write_file(&folder.file(patched::FILE), text.as_bytes())?;
    }
    Ok(())
}
