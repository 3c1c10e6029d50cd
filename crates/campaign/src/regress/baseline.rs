//! What a scenario showed when it was last blessed.

use crate::error::CampaignError;
use crate::row::Row;
use record::Log;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::path::Path;

/// Value of the key `format`.
const FORMAT: &str = "softdock-baseline-1";
/// Significant digits of a curve's values: ten times finer than the default tolerance of a curve.
const DIGITS: i32 = 7;

/// A baseline.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Baseline {
    /// Format of the file.
    #[serde(default)]
    pub format: String,
    /// Name of the scenario.
    pub scenario: String,
    /// Why it was moved, the first time first.
    #[serde(default)]
    pub history: Vec<Entry>,
    /// Outcome of the run.
    pub outcome: String,
    /// Metrics by name.
    pub metrics: Map<String, Value>,
    /// Work counters by name.
    pub work: Map<String, Value>,
    /// Outcomes of the mutations by name.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub mutations: Map<String, Value>,
    /// The campaign, where it is part of the baseline.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub campaign: Option<CampaignBaseline>,
    /// Curves.
    pub curves: Curves,
}

/// A move of a baseline.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Entry {
    /// Version of softdock that wrote it.
    pub version: String,
    /// Why, in the words of who blessed it.
    pub reason: String,
    /// What moved.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub moved: Vec<String>,
}

/// Signals at a few instants.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Curves {
    /// Times, s.
    pub t: Vec<f64>,
    /// Values by channel, as many as times; none where it was not sampled.
    pub channels: BTreeMap<String, Vec<Option<f64>>>,
}

/// What the first runs of a campaign showed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CampaignBaseline {
    /// Number of runs.
    pub runs: u32,
    /// Runs by outcome.
    pub outcomes: BTreeMap<String, u32>,
    /// Values of every metric that is a number, ascending.
    pub values: BTreeMap<String, Vec<f64>>,
}

impl Curves {
    /// Of a log.
    pub(super) fn of(log: &Log) -> Self {
        let values = |values: &[f64]| values.iter().map(|x| x.is_finite().then(|| shortened(*x))).collect();
        let channels = log.signals.channels.iter().map(|c| (c.spec.name.clone(), values(&c.values))).collect();
        Self { t: log.signals.times.iter().map(|t| shortened(*t)).collect(), channels }
    }
}

/// A number to a few significant digits: baselines are read and kept by people.
fn shortened(x: f64) -> f64 {
    if x == 0.0 {
        return 0.0;
    }
    format!("{x:.*e}", (DIGITS - 1) as usize).parse().unwrap_or(x)
}

impl CampaignBaseline {
    /// Of the rows of a campaign.
    pub(super) fn of(rows: &[Row]) -> Self {
        let (mut outcomes, mut values) = (BTreeMap::new(), BTreeMap::<String, Vec<f64>>::new());
        for row in rows {
            *outcomes.entry(row.outcome.clone()).or_default() += 1;
            for (name, value) in &row.metrics {
                if let Some(x) = value.as_f64().filter(|x| x.is_finite()) {
                    values.entry(name.clone()).or_default().push(shortened(x));
                }
            }
        }
        values.values_mut().for_each(|list| list.sort_by(f64::total_cmp));
        // What only counts round-off has no distribution worth keeping.
        values.retain(|name, _| {
            !name.contains("drift") && !name.starts_with("integrator") && !name.starts_with("contact.")
        });
        Self { runs: rows.len() as u32, outcomes, values }
    }
}

impl Baseline {
    /// Reads a baseline; `None` where there is none.
    pub fn read(path: &Path) -> Result<Option<Self>, CampaignError> {
        if !path.exists() {
            return Ok(None);
        }
        let text = std::fs::read_to_string(path).map_err(CampaignError::read(path))?;
        let baseline: Self = serde_json::from_str(&text)
            .map_err(|e| CampaignError::table(path, format!("is no baseline: {e}; bless it anew, with a reason")))?;
        if baseline.format != FORMAT {
            let problem =
                format!("has the format \"{}\", not \"{FORMAT}\"; bless it anew, with a reason", baseline.format);
            return Err(CampaignError::table(path, problem));
        }
        Ok(Some(baseline))
    }

    /// Writes it, with a new entry of its history.
    pub fn bless(mut self, path: &Path, before: Option<&Self>, entry: Entry) -> Result<(), CampaignError> {
        FORMAT.clone_into(&mut self.format);
        self.history = before.map(|b| b.history.clone()).unwrap_or_default();
        self.history.push(entry);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(CampaignError::write(folder))?;
        }
        let text = pretty(&serde_json::to_value(&self).map_err(|e| CampaignError::table(path, e))?);
        Ok(record::write_file(path, text.as_bytes())?)
    }
}

/// JSON with a line for each key, and lists of numbers in one: what a diff of two baselines should show.
fn pretty(value: &Value) -> String {
    fn add(text: &mut String, value: &Value, indent: usize) {
        match value {
            Value::Object(map) if !map.is_empty() => {
                text.push_str("{\n");
                for (i, (key, value)) in map.iter().enumerate() {
                    let comma = if i == 0 { "" } else { ",\n" };
                    text.push_str(&format!(
                        "{comma}{:indent$}{}: ",
                        "",
                        Value::from(key.as_str()),
                        indent = indent + 1
                    ));
                    add(text, value, indent + 1);
                }
                text.push_str(&format!("\n{:indent$}}}", ""));
            }
            other => text.push_str(&other.to_string()),
        }
    }
    let mut text = String::new();
    add(&mut text, value, 0);
    text + "\n"
}
