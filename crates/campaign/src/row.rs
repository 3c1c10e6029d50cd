//! One run's line in the journal.
//!
//! JSON, with numbers that read back to the same bits. A line is whole when it ends in a line break and names its run; a process
//! that is killed leaves at most one that is not, at the end.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// What is kept of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Index of the run.
    pub run: u64,
    /// Its seed.
    pub seed: u64,
    /// Drawn values, in the order of the header's inputs.
    pub inputs: Vec<f64>,
    /// The same, read back from what was built; none where nothing could be built.
    pub applied: Vec<Option<f64>>,
    /// One word; `unbuildable`, `diverged` and `panicked` are failures of the run itself.
    pub outcome: String,
    /// A sentence.
    pub reason: String,
    /// The scenario's expectations that were not met, each in a sentence.
    pub unmet: Vec<String>,
    /// Metrics by name.
    pub metrics: Map<String, Value>,
    /// Work counters by name.
    pub work: Map<String, Value>,
}

impl Row {
    /// Whether the run itself failed: it gave no result.
    pub fn has_failed(&self) -> bool {
        is_failure(&self.outcome)
    }
}

/// Whether an outcome is that of a run without a result.
pub(crate) fn is_failure(outcome: &str) -> bool {
    ["unbuildable", "diverged", "panicked"].contains(&outcome)
}
