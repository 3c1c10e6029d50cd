//! How far a regression run may be from its baseline.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A margin of metrics or of signals; of several that match the last one decides.
///
/// Without any, numbers may differ by a hundred-thousandth, curves by a ten-thousandth of their own range, counters by half a per cent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-exactly-one" = [["metric", "signal"]]))]
pub struct Margin {
    /// Metrics, by glob.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1))]
    pub metric: Option<String>,
    /// Signals, by glob.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1))]
    pub signal: Option<String>,
    /// Difference allowed, in the unit of the quantity.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub absolute: f64,
    /// Difference allowed beside it: a share of a metric's value, or of a curve's own range.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub relative: f64,
}
