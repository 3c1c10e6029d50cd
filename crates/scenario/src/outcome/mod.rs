//! What became of a run: outcome, reason, metrics, events, and the file's expectations.

mod base;
mod capture;
mod contacts;
mod creep;
mod docking;
mod energy;
mod expect;
mod interface;
mod judge;
mod keep_out;
mod mechanisms;
mod motors;

pub(crate) use docking::calc_base_motion;
pub use expect::{Verdict, check_expectations};
pub use judge::Judge;

use record::Event;
use serde_json::{Map, Value};
use std::borrow::Cow;

/// One figure of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Metric {
    /// Its name in `summary.json` and in `[[expect]]`; a figure's name ends in its unit.
    pub name: Cow<'static, str>,
    /// A flag, number or text.
    pub value: Value,
    /// What it is, for people.
    pub meaning: &'static str,
}

/// What became of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// `captured`, `lost`, `not-reached`, …; of a docking as [`crate::spec::Docking`] lists them; `completed`, `diverged`.
    pub outcome: &'static str,
    /// Why, in a sentence.
    pub reason: String,
    /// Figures.
    pub metrics: Vec<Metric>,
    /// Events in order of time.
    pub events: Vec<Event>,
    /// What a reader of the figures must know, in sentences with a way out.
    pub warnings: Vec<String>,
}

impl Outcome {
    /// A metric's value.
    pub fn metric(&self, name: &str) -> Option<&Value> {
        self.metrics.iter().find(|m| m.name == name).map(|m| &m.value)
    }

    /// The metrics as JSON.
    pub fn metrics_json(&self) -> Map<String, Value> {
        self.metrics.iter().map(|m| (m.name.to_string(), m.value.clone())).collect()
    }
}
