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
///
/// Run i draws the same sample whatever the number of runs, their order and the number of threads.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Campaign {
    /// How many.
    #[schemars(range(min = 1))]
    pub runs: u32,
    /// How the distributions are sampled.
    #[serde(default)]
    pub sampling: Sampling,
    /// Runs that make one Latin hypercube; `runs` where absent. A campaign of several times as many is as many hypercubes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 2))]
    pub strata: Option<u32>,
    /// The flag among the metrics that counts as success; "captured" where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub success: Option<String>,
    /// Channels of every run that are kept, by glob, each run in a file of its own; none by default.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub signals: Vec<String>,
    /// What differs between the runs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub disperse: Vec<Disperse>,
    /// Which of the dispersed numbers go together.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub correlate: Vec<Correlate>,
    /// Other dispersions of the same scenario, chosen by name: the corners of a box, a sweep.
    #[serde(default, rename = "variant", skip_serializing_if = "Vec::is_empty")]
    pub variants: Vec<Variant>,
    /// What the campaign as a whole must show.
    #[serde(default, rename = "expect", skip_serializing_if = "Vec::is_empty")]
    pub expects: Vec<CampaignExpect>,
}

/// Dispersions that take the place of the campaign's own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Variant {
    /// Its name, for `--variant`.
    #[schemars(extend("x-name" = true))]
    pub name: String,
    /// How many runs.
    #[schemars(range(min = 1))]
    pub runs: u32,
    /// What differs between them.
    #[schemars(length(min = 1))]
    pub disperse: Vec<Disperse>,
    /// What this campaign as a whole must show.
    #[serde(default, rename = "expect", skip_serializing_if = "Vec::is_empty")]
    pub expects: Vec<CampaignExpect>,
}

/// A change of the scenario that must end otherwise: it shows that the scenario can tell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mutation {
    /// Its name.
    #[schemars(extend("x-name" = true))]
    pub name: String,
    /// Overrides, `path=value`.
    #[schemars(length(min = 1), inner(length(min = 3)))]
    pub set: Vec<String>,
    /// The outcome that it must have.
    #[schemars(length(min = 1))]
    pub outcome: String,
}

/// How the unit cube behind the distributions is filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Sampling {
    /// Independent draws; those of one number do not depend on what else is dispersed.
    #[default]
    Random,
    /// Every number evenly over its strata, in random order (McKay, Beckman and Conover 1979).
    LatinHypercube,
    /// Scrambled Sobol sequence (Owen 1998; Burley 2020).
    Sobol,
}

/// One dispersed number, or two or three that make a vector; exactly one distribution.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-exactly-one" = [
    ["path", "paths"],
    ["normal", "uniform", "choice", "grid", "sweep", "ball", "directions"],
]))]
pub struct Disperse {
    /// Path of the number, as for `--set`, e.g. `vehicle.target.twist.angular_deg_per_s[2]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-refers" = "path"))]
    pub path: Option<String>,
    /// Paths of the components of a vector, for `ball` and `directions`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 2, max = 3), extend("x-refers" = "path"))]
    pub paths: Option<Vec<String>>,
    /// Short name of its column in tables; the path where absent. Components get `_x`, `_y`, `_z`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1))]
    pub name: Option<String>,
    /// Normal distribution, truncated where `low` or `high` stand.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal: Option<Normal>,
    /// Uniform distribution.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uniform: Option<Uniform>,
    /// One of these, with equal chances.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1))]
    pub choice: Option<Vec<f64>>,
    /// Each of these in turn: with all other grids, sweeps and directions, every combination once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1))]
    pub grid: Option<Vec<f64>>,
    /// A grid of evenly spaced values.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sweep: Option<Sweep>,
    /// Uniform within a disc (two paths) or a ball (three).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ball: Option<Ball>,
    /// A grid of directions in a plane (two paths), all of one length: the corners of a bound on a vector sum.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub directions: Option<Directions>,
}

/// Normal distribution, in the unit of the dispersed key.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-ordered" = [["low", "high"]]))]
pub struct Normal {
    /// Standard deviation before truncation.
    #[schemars(range(min = 0.0))]
    pub sigma: f64,
    /// Mean before truncation; the scenario's own value where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean: Option<f64>,
    /// Nothing below.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub low: Option<f64>,
    /// Nothing above.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub high: Option<f64>,
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

/// Evenly spaced values, both ends included.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-ordered" = [["low", "high"]]))]
pub struct Sweep {
    /// First value.
    pub low: f64,
    /// Last value.
    pub high: f64,
    /// How many.
    #[schemars(range(min = 2))]
    pub count: u32,
}

/// A disc or ball about zero, in the unit of the dispersed keys.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ball {
    /// Its radius.
    #[schemars(range(min = 0.0))]
    pub radius: f64,
}

/// Directions in a plane, evenly spaced, the first along the first path.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Directions {
    /// Length of the vector, in the unit of the dispersed keys.
    #[schemars(range(min = 0.0))]
    pub radius: f64,
    /// How many.
    #[schemars(range(min = 1))]
    pub count: u32,
}

/// Two dispersed numbers that go together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Correlate {
    /// Names (or paths) of two entries with a normal or uniform distribution.
    pub between: [String; 2],
    /// Correlation of the normal scores behind them (a Gaussian copula).
    #[schemars(range(min = -1.0, max = 1.0))]
    pub rho: f64,
}

/// A demand on the campaign as a whole; exactly one bound.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-exactly-one" = [["at_most", "at_least"]]))]
pub struct CampaignExpect {
    /// A metric; of a flag its rate counts, of a number the quantile.
    #[schemars(length(min = 1))]
    pub metric: String,
    /// Which quantile of a number; 0.5 (the median) where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub quantile: Option<f64>,
    /// It is no larger.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_most: Option<f64>,
    /// It is no smaller.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_least: Option<f64>,
}
