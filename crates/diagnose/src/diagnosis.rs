//! What a diagnosis says, as plain data with a stable JSON form: `diagnosis.json`.
//!
//! Keys that are stated here stay; further keys may come. A reader ignores keys that it does not know, and a number that is
//! not finite (a free run that diverged, a standard error of what the data cannot show) is `null`.
//!
//! Places are those of the table of effects, without the vehicle's name where the rest is unique:
//! `joint:<name>`, `link:<name>`, `body:<name>`, `contact:<a>/<b>`, `actuator:<name>`, `sensor:<channel prefix>`, `world`.
//! Parameters are in SI under the names of that table, vectors in its order and frame.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

pub use scenario::spec::{Effect, ParamValue};

/// Version of the JSON form.
pub const FORMAT: u32 = 1;

/// A diagnosis: `diagnosis.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Diagnosis {
    /// Version of this form: 1.
    #[serde(default = "format")]
    pub format: u32,
    /// Name of the scenario that was compared.
    #[serde(default)]
    pub scenario: String,
    /// Name of the recording it was compared with.
    #[serde(default)]
    pub recording: String,
    /// What came out.
    pub verdict: Verdict,
    /// Where the mismatch is, largest share first; empty where there is none.
    pub located: Vec<Located>,
    /// What explains it, in the order in which it was found; empty where nothing does.
    pub effects: Vec<Found>,
    /// Nominal numbers that were corrected within the tolerances that the scenario gives them; no findings.
    #[serde(default)]
    pub within_tolerance: Vec<Found>,
    /// How well the nominal and the corrected model predict.
    pub error: Errors,
    /// Share of the mismatch that the effects explain on runs left out of the fit; none where nothing was found that helps.
    #[serde(default)]
    pub explained_share: Option<Explained>,
    /// What the effects leave; none where nothing is detected in it.
    #[serde(default)]
    pub remainder: Option<Remainder>,
    /// What a reader must know besides: data quality, ridges, doubts. Sentences.
    #[serde(default)]
    pub remarks: Vec<String>,
}

fn format() -> u32 {
    FORMAT
}

/// What came out of a diagnosis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The scenario predicts the recording within the noise of its sensors.
    NoMismatch,
    /// With the effects added, it does.
    Explained,
    /// The effects named help on runs that were left out of the fit (by how much: `explained_share`); a remainder is detected.
    PartlyExplained,
    /// There is a significant mismatch, and nothing in the library helps on runs that were left out of the fit.
    Unknown,
}

impl Verdict {
    /// Its word in the JSON form.
    pub fn word(self) -> &'static str {
        match self {
            Self::NoMismatch => "no-mismatch",
            Self::Explained => "explained",
            Self::PartlyExplained => "partly-explained",
            Self::Unknown => "unknown",
        }
    }

    /// Whether effects were found that help.
    pub fn is_found(self) -> bool {
        matches!(self, Self::Explained | Self::PartlyExplained)
    }

    /// Whether nothing remains unexplained: exit status 0.
    pub fn is_good(self) -> bool {
        matches!(self, Self::NoMismatch | Self::Explained)
    }
}

/// One place where simulation and recording differ.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Located {
    /// Where.
    pub place: String,
    /// Share of the mismatch beyond the noise that a missing force (or reading) here explains alone, 0 to 1.
    #[serde(with = "finite")]
    #[schemars(with = "Option<f64>")]
    pub share: f64,
    /// Onset, s of the recording's time; its start where it was always there.
    #[serde(with = "finite")]
    #[schemars(with = "Option<f64>")]
    pub from_s: f64,
    /// End, s.
    #[serde(with = "finite")]
    #[schemars(with = "Option<f64>")]
    pub to_s: f64,
    /// The condition under which it lives, in words: "always", "in contact", "sliding", "near q = 1.02 rad".
    pub condition: String,
}

/// An effect that was found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Found {
    /// Which, by its name in the table of effects.
    pub name: String,
    /// Where.
    pub place: String,
    /// Its parameters, SI.
    pub params: BTreeMap<String, ParamValue>,
    /// One standard error of each parameter that was fitted, in the parameter's shape.
    pub std_err: BTreeMap<String, StdErr>,
    /// Whether it acts on a joint that slides, so that its units are those of forces instead of torques.
    #[serde(default)]
    pub slides: bool,
    /// What else explains the same data nearly as well, nearest first.
    #[serde(default)]
    pub rivals: Vec<Rival>,
}

impl Found {
    /// The effect as an entry of a scenario.
    pub fn effect(&self) -> Effect {
        Effect { name: self.name.clone(), place: self.place.clone(), params: self.params.clone() }
    }
}

/// Another explanation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Rival {
    /// Name of the effect.
    pub name: String,
    /// Where.
    pub place: String,
    /// How much worse it is: difference of the information criterion after a refit; below about 10 the data do not decide.
    #[serde(with = "finite")]
    #[schemars(with = "Option<f64>")]
    pub score_gap: f64,
}

/// A standard error: of a number, or of each entry of a vector; `null` where the data do not show the parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum StdErr {
    /// Of a number.
    One(Option<f64>),
    /// Of each entry.
    Each(Vec<Option<f64>>),
}

impl StdErr {
    /// Of a number; what is not finite is not shown by the data.
    pub fn one(value: f64) -> Self {
        Self::One(known(value))
    }

    /// Of a vector.
    pub fn each(values: &[f64]) -> Self {
        Self::Each(values.iter().copied().map(known).collect())
    }

    /// Entries; `None` where the data do not show them.
    pub fn entries(&self) -> &[Option<f64>] {
        match self {
            Self::One(value) => std::slice::from_ref(value),
            Self::Each(values) => values,
        }
    }
}

fn known(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// Prediction errors: RMS in units of the sensors' noise (1.0 is perfect), pooled over all noisy scalar samples that the model
/// predicts; an orientation counts as the three components of its rotation vector. Measured drives and commands do not count.
///
/// *Free run*: the initial state, and only that, is estimated on the whole run under each model alike. *Windowed*: the same
/// with the state estimated anew every `window_s`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Errors {
    /// Free run, runs that were used to find and fit.
    pub fit: BeforeAfter,
    /// Free run, runs that were not used; `null` where the recording has none.
    pub holdout: Option<BeforeAfter>,
    /// Length of a window, s.
    pub window_s: f64,
    /// Windowed, over the holdout runs; over the fit runs where there are none.
    pub windowed: BeforeAfter,
    /// Windowed, over the same runs: the nominal model with its numbers corrected within the scenario's tolerances, and no effect; what effects explain is a
    /// share of this. None where no number is free or no effect was found.
    #[serde(default)]
    pub within_tolerance: Option<f64>,
    /// Run by run.
    pub runs: Vec<RunError>,
    /// Channel by channel in its own unit, the one that is most wrong first; over the holdout runs, or the fit runs where there are none.
    #[serde(default)]
    pub channels: Vec<ChannelError>,
}

/// Root mean square error of one channel, in its own unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ChannelError {
    /// Channel, without the component where it has several.
    pub channel: String,
    /// Its unit; rad for an orientation.
    pub unit: String,
    /// Its noise, one standard deviation, rounding included.
    pub sigma: f64,
    /// Free run.
    pub free: BeforeAfter,
    /// Windowed.
    pub windowed: BeforeAfter,
}

/// Share of the mismatch that the effects found explain, in mean square beyond the noise, over windows each with an initial state of its own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Explained {
    /// The share; below zero where they make it worse.
    pub share: f64,
    /// Its 95 % interval over resampled windows.
    pub interval: [f64; 2],
    /// Horizon: length of a window, s.
    pub window_s: f64,
    /// Runs over which it was judged.
    pub runs: usize,
    /// Whether these were left out of the fit; a recording may have none to leave out.
    pub left_out: bool,
    /// Files of the runs that are predicted clearly worse than by the nominal model.
    #[serde(default)]
    pub harmed: Vec<String>,
}

/// What is left of a mismatch by the effects that were found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Remainder {
    /// Its error in windows over all runs, units of noise (1 is perfect).
    #[serde(with = "finite")]
    #[schemars(with = "Option<f64>")]
    pub error: f64,
    /// Where it is, when, and on what it depends, largest share first.
    pub located: Vec<Located>,
}

/// An error of the nominal and of the corrected model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BeforeAfter {
    /// Nominal model, in units of noise; `null` where it diverged.
    #[serde(with = "finite")]
    #[schemars(with = "Option<f64>")]
    pub before: f64,
    /// Corrected model.
    #[serde(with = "finite")]
    #[schemars(with = "Option<f64>")]
    pub after: f64,
}

/// Errors of one run, in units of noise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RunError {
    /// File of the run.
    pub file: String,
    /// Whether the run was used to find and fit.
    pub role: Role,
    /// Free run, nominal model.
    #[serde(with = "finite")]
    #[schemars(with = "Option<f64>")]
    pub before: f64,
    /// Free run, corrected model.
    #[serde(with = "finite")]
    #[schemars(with = "Option<f64>")]
    pub after: f64,
    /// Windows, nominal model.
    #[serde(with = "finite")]
    #[schemars(with = "Option<f64>")]
    pub windowed_before: f64,
    /// Windows, corrected model.
    #[serde(with = "finite")]
    #[schemars(with = "Option<f64>")]
    pub windowed_after: f64,
}

/// What a run is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Role {
    /// May be used to find and fit a model.
    Fit,
    /// For judging it only.
    Holdout,
}

impl Role {
    /// Its word in the JSON form.
    pub fn word(self) -> &'static str {
        match self {
            Self::Fit => "fit",
            Self::Holdout => "holdout",
        }
    }
}

/// The error that says most: of whole runs where the model predicts these, else in windows, the horizon at which it does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judged {
    /// Before and after.
    pub error: BeforeAfter,
    /// Whether of runs left out of the fit.
    pub left_out: bool,
    /// Length of the windows, s; none for whole runs.
    pub window_s: Option<f64>,
}

/// Growth of an error from windows to whole runs beyond which these are not predictable: deviations grow, whatever the model.
/// It moves what the headline tells, no verdict.
const PREDICTABLE: f64 = 5.0;

impl Diagnosis {
    /// Whether there is a corrected model beside the nominal one: effects were found, or nominal numbers corrected within their tolerances.
    pub fn is_corrected(&self) -> bool {
        !self.effects.is_empty() || !self.within_tolerance.is_empty()
    }

    /// The error that the headline tells.
    pub fn judged(&self) -> Judged {
        let Errors { fit, holdout, windowed, window_s, .. } = &self.error;
        let free = holdout.unwrap_or(*fit);
        let is_followed = free.before.is_finite() && free.after.is_finite();
        let is_predictable = is_followed && free.after <= PREDICTABLE * windowed.after.max(1.0);
        match is_predictable {
            true => Judged { error: free, left_out: holdout.is_some(), window_s: None },
            false => Judged { error: *windowed, left_out: holdout.is_some(), window_s: Some(*window_s) },
        }
    }

    /// The channel that is most wrong, and its error at the horizon of [`Self::judged`], in its own unit.
    pub fn most_wrong(&self) -> Option<(&ChannelError, BeforeAfter)> {
        let first = self.error.channels.first()?;
        Some((first, if self.judged().window_s.is_some() { first.windowed } else { first.free }))
    }

    /// The JSON document, indented, with a newline at its end.
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }

    /// Reads a JSON document; keys that are not known are ignored.
    pub fn from_json(text: &str) -> Result<Self, serde_json::Error> {
        serde_json::from_str(text)
    }
}

/// JSON Schema of `diagnosis.json`.
pub fn json_schema() -> serde_json::Value {
    schemars::schema_for!(Diagnosis).to_value()
}

/// A number that JSON may not be able to say: `null` stands for what is not finite.
mod finite {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(value: &f64, to: S) -> Result<S::Ok, S::Error> {
        value.is_finite().then_some(*value).serialize(to)
    }

    pub(super) fn deserialize<'d, D: Deserializer<'d>>(from: D) -> Result<f64, D::Error> {
        Ok(Option::<f64>::deserialize(from)?.unwrap_or(f64::NAN))
    }
}
