//! What is in a recording, and whether it can be trusted: channels, rates, gaps, noise, warnings, consistency.
//!
//! [`inspect`] looks at every channel of every run by itself (clock, rounding, white noise, stuck values, spikes,
//! limits) and at the pairs that kinematics ties together ([`crate::consistency`]). It needs no model: whatever it finds
//! is in the sensors, the units or the files.

mod jitter;
mod noise;
mod quality;
mod text;
mod warn;

pub use jitter::{duration, speeds, stamp_jitter};
pub use noise::{White, white_noise, white_variance};
pub use quality::{Clock, Spike, Stuck, at_limit, clock, spikes, stuck};
pub use text::{said_once, to_text};

use crate::consistency::{self, Consistency};
use crate::{ChannelName, Quantity, RecordingSet, Remark, Series};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;

/// Value of the key `format` in `inspection.json`.
pub const FORMAT: &str = "softdock-inspection-1";

/// A channel over all runs.
#[derive(Clone, Debug, Serialize)]
pub struct ChannelReport {
    /// Name.
    pub channel: String,
    /// SI unit; a joint's is that of a turning or a sliding one.
    pub unit: String,
    /// Runs that have it.
    pub runs: usize,
    /// Samples in all of them.
    pub samples: usize,
    /// Samples per second.
    pub rate: f64,
    /// Missing samples by the median step, all runs.
    pub gaps: usize,
    /// Smallest value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
    /// Written rounding, in the channel's unit.
    pub rounding: f64,
    /// White noise from the samples, without rounding; orientation: rad about each axis. None: command, or too short.
    pub noise: Option<f64>,
    /// White noise by the data sheet.
    pub stated: Option<f64>,
    /// Standard deviation of its stamps, s, where its noise grows with its speed.
    pub jitter_s: Option<f64>,
}

/// A run.
#[derive(Clone, Debug, Serialize)]
pub struct RunReport {
    /// File, with its group where it has one.
    pub file: String,
    /// `fit` or `holdout`.
    pub role: &'static str,
    /// The team's note.
    pub note: String,
    /// First instant, s.
    pub from_s: f64,
    /// Last instant, s.
    pub to_s: f64,
    /// Number of channels.
    pub channels: usize,
    /// Samples of all channels.
    pub samples: usize,
}

/// Everything that was found.
#[derive(Clone, Debug)]
pub struct Inspection {
    /// The rig.
    pub rig: String,
    /// The set's title.
    pub title: String,
    /// Its runs.
    pub runs: Vec<RunReport>,
    /// Its channels, by name.
    pub channels: Vec<ChannelReport>,
    /// Rates against positions.
    pub consistency: Vec<Consistency>,
    /// What was said on reading and what was found, most severe first.
    pub remarks: Vec<Remark>,
}

/// Looks at everything.
pub fn inspect(set: &RecordingSet) -> Inspection {
    let channels = channels(set);
    let by_name: BTreeMap<&str, &ChannelReport> = channels.iter().map(|c| (c.channel.as_str(), c)).collect();
    let sigma = |channel: &str| by_name.get(channel).and_then(|report| sigma_of(report));
    let consistency = consistency::check(set, &sigma);
    let mut remarks = set.remarks.clone();
    remarks.extend(warn::of_channels(set, &channels));
    remarks.extend(warn::of_runs(set, &channels));
    remarks.extend(warn::of_consistency(&consistency));
    remarks.sort_by_key(|remark| std::cmp::Reverse(remark.severity));
    Inspection {
        rig: set.rig.clone(),
        title: set.title.clone(),
        runs: set.runs.iter().map(run_report).collect(),
        channels,
        consistency,
        remarks,
    }
}

/// The noise to reckon with, rounding included: the stated one, or the measured one where that is clearly larger or
/// nothing is stated. None for commands and where nothing is known.
pub fn sigma_of(report: &ChannelReport) -> Option<f64> {
    /// An estimate is sure to some per cent; more than this is another sensor.
    const CLEARLY: f64 = 1.2;
    let sigma = match (report.stated, report.noise) {
        (Some(stated), Some(found)) if found > CLEARLY * stated => found,
        (Some(stated), _) => stated,
        (None, found) => found?,
    };
    let is_orientation = is_orientation(&report.channel);
    let q = if is_orientation { 2.0 * report.rounding } else { report.rounding };
    let sigma = (sigma * sigma + q * q / 12.0).sqrt();
    (sigma > 0.0).then_some(sigma)
}

pub(crate) fn is_orientation(channel: &str) -> bool {
    ChannelName::parse(channel).is_some_and(|name| name.quantity.is_orientation())
}

fn run_report(run: &crate::RecordedRun) -> RunReport {
    let (from_s, to_s) = run.span().unwrap_or_default();
    RunReport {
        file: run.file.clone(),
        role: run.role.key(),
        note: run.note.clone(),
        from_s,
        to_s,
        channels: run.series.len(),
        samples: run.series.iter().map(Series::len).sum(),
    }
}

fn channels(set: &RecordingSet) -> Vec<ChannelReport> {
    let mut all: BTreeMap<&str, Vec<&Series>> = BTreeMap::new();
    for series in set.runs.iter().flat_map(|run| &run.series) {
        all.entry(&series.channel).or_default().push(series);
    }
    all.par_iter().map(|(channel, series)| channel_report(set, channel, series)).collect()
}

fn channel_report(set: &RecordingSet, channel: &str, series: &[&Series]) -> ChannelReport {
    let values = || series.iter().flat_map(|s| s.values.iter().copied());
    let quantity = ChannelName::parse(channel).map(|name| name.quantity);
    let is_command = quantity.is_some_and(Quantity::is_command);
    ChannelReport {
        channel: channel.to_owned(),
        unit: quantity.map_or("", Quantity::unit).to_owned(),
        runs: series.len(),
        samples: series.iter().map(|s| s.len()).sum(),
        rate: median(series.iter().map(|s| s.rate()).collect()).unwrap_or_default(),
        gaps: series.iter().map(|s| clock(s).gaps).sum(),
        low: values().fold(f64::INFINITY, f64::min),
        high: values().fold(f64::NEG_INFINITY, f64::max),
        rounding: median(series.iter().map(|s| s.quantum()).collect()).unwrap_or_default(),
        noise: if is_command { None } else { noise_of(set, channel) },
        stated: if is_command { None } else { set.sigma(channel) },
        jitter_s: if is_command || is_orientation(channel) { None } else { jitter_of(series) },
    }
}

fn jitter_of(series: &[&Series]) -> Option<f64> {
    let runs: Vec<(&[f64], &[f64])> = series.iter().map(|s| (&s.times[..], &s.values[..])).collect();
    stamp_jitter(&runs)
}

/// Median over the runs.
fn noise_of(set: &RecordingSet, channel: &str) -> Option<f64> {
    match ChannelName::parse(channel).filter(|name| name.quantity.is_orientation()) {
        Some(name) => noise_of_parts(set, &["w", "x", "y", "z"].map(|part| format!("{}.{part}", name.prefix))),
        None => noise_of_parts(set, &[channel.to_owned()]),
    }
}

fn noise_of_parts(set: &RecordingSet, channels: &[String]) -> Option<f64> {
    let of_run = |run: &crate::RecordedRun| {
        let parts: Option<Vec<&Series>> = channels.iter().map(|c| run.series(c)).collect();
        white_noise(&parts?)
    };
    median(set.runs.iter().filter_map(of_run).collect())
}

pub(crate) fn median(mut values: Vec<f64>) -> Option<f64> {
    if values.is_empty() {
        return None;
    }
    let middle = values.len() / 2;
    Some(*values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

impl Inspection {
    /// The most severe remark.
    pub fn worst(&self) -> Option<crate::Severity> {
        self.remarks.iter().map(|remark| remark.severity).max()
    }

    /// The content of `inspection.json`.
    pub fn to_json(&self) -> serde_json::Value {
        let remark = |r: &Remark| serde_json::json!({ "severity": r.severity.key(), "run": r.run, "channel": r.channel, "what": r.what });
        serde_json::json!({
            "format": FORMAT,
            "rig": self.rig,
            "title": self.title,
            "runs": self.runs,
            "channels": self.channels,
            "consistency": self.consistency,
            "remarks": self.remarks.iter().map(remark).collect::<Vec<_>>(),
        })
    }
}
