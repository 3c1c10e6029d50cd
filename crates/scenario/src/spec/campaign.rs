//! What a run must show, and how runs of a campaign differ.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A demand on a metric of the run; exactly one criterion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-exactly-one" = [["equals", "at_most", "at_least", "between"]]))]
pub struct Expect {
    /// Name of the metric, as `summary.json` has it.
    #[schemars(length(min = 1))]
    pub metric: String,
    /// It is this.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub equals: Option<Scalar>,
    /// It is no larger.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_most: Option<f64>,
    /// It is no smaller.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_least: Option<f64>,
    /// It lies within [low, high], ends included.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-ascending" = true))]
    pub between: Option<[f64; 2]>,
}

/// A value that a metric may equal.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Scalar {
    /// Yes or no.
    Flag(bool),
    /// A number, compared exactly.
    Number(f64),
    /// A text.
    Text(String),
}

/// Dispersed runs of the scenario.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Campaign {
    /// How many.
    #[schemars(range(min = 1))]
    pub runs: u32,
    /// What differs between them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub disperse: Vec<Disperse>,
}

/// One dispersed number; exactly one distribution.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-exactly-one" = [["normal", "uniform", "choice"]]))]
pub struct Disperse {
    /// Path of the number, as for `--set`, e.g. `vehicle.target.twist.angular_deg_per_s[2]`.
    #[schemars(extend("x-refers" = "path"))]
    pub path: String,
    /// Normal distribution.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal: Option<Normal>,
    /// Uniform distribution.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uniform: Option<Uniform>,
    /// One of these, with equal chances.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1))]
    pub choice: Option<Vec<f64>>,
}

/// Normal distribution, in the unit of the dispersed key.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Normal {
    /// Standard deviation.
    #[schemars(range(min = 0.0))]
    pub sigma: f64,
    /// Mean; the scenario's own value where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean: Option<f64>,
}

/// Uniform distribution, in the unit of the dispersed key.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-ordered" = [["low", "high"]]))]
pub struct Uniform {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}
