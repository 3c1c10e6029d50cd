//! Recordings of a rig: a folder with `recording.toml` and one table per run, read as it is and said where it is odd.
//!
//! **folder → [`RecordingSet`] → [`RecordedRun`] → [`Series`].** Sensors of different rates share one file, so that each
//! channel becomes a series of its own with only the instants where it was sampled: finite, times strictly increasing.
//! Foreign columns are mapped and converted to SI; quaternions are unit and continuous in sign; repeated time stamps are
//! averaged. Whatever was changed on the way stands in [`RecordingSet::remarks`]; what cannot be read is an error that
//! names the file, the place and the way out. There is no half a set: every run is read, or none.

mod assemble;
mod channel_name;
mod group;
mod manifest;
mod mcap_file;
mod orientation;
mod quantum;
mod save;
mod series;
mod spelling;
mod table;
mod time;
mod turns;
pub mod units;

pub use channel_name::{ChannelName, Quantity};
pub use save::Format;
pub use series::{Series, median_step};

use crate::RecordError;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What a rig recorded in a day: runs of one hardware, under one description.
#[derive(Clone, Debug, Default)]
pub struct RecordingSet {
    /// The folder of `recording.toml`.
    pub folder: PathBuf,
    /// Rig card that describes the hardware.
    pub rig: String,
    /// One line for people.
    pub title: String,
    /// Length of the windows in which a model's predictions are judged, s, where the recording asks for one.
    pub window_s: Option<f64>,
    /// Standard deviation of the white noise from the data sheet, by channel or channel prefix, in the channel's SI
    /// unit (orientation: rad about each axis).
    pub noise: BTreeMap<String, f64>,
    /// The runs, in the order of `recording.toml`, and in one file in the order of its groups.
    pub runs: Vec<RecordedRun>,
    /// What was found and changed on reading.
    pub remarks: Vec<Remark>,
}

/// What a run may be used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// To find and fit a model.
    Fit,
    /// Only to judge it.
    Holdout,
}

impl Role {
    /// As written in `recording.toml`.
    pub fn key(self) -> &'static str {
        match self {
            Self::Fit => "fit",
            Self::Holdout => "holdout",
        }
    }
}

/// One run.
#[derive(Clone, Debug)]
pub struct RecordedRun {
    /// File as named in `recording.toml`; where a group column cuts it into runs, with the group: `tosses.csv#toss=3`.
    pub file: String,
    /// What it may be used for.
    pub role: Role,
    /// The team's note.
    pub note: String,
    /// Its channels, sorted by name.
    pub series: Vec<Series>,
}

/// How much a remark matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Handled; nothing is lost.
    Note,
    /// Handled, or to be kept in mind; a look at the data is due.
    Warning,
    /// The data contradict themselves or the format's units: do not fit a model to them as they are.
    Fault,
}

impl Severity {
    /// Lower-case word.
    pub fn key(self) -> &'static str {
        match self {
            Self::Note => "note",
            Self::Warning => "warning",
            Self::Fault => "fault",
        }
    }
}

/// A sentence about a set, a run or a channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Remark {
    /// [`RecordedRun::file`]; none: about the set.
    pub run: Option<String>,
    /// Channel or channel prefix; none: about the run.
    pub channel: Option<String>,
    /// The sentence, without its subject.
    pub what: String,
    /// How much it matters.
    pub severity: Severity,
}

impl RecordingSet {
    /// Reads a folder with `recording.toml`, or a single CSV or Parquet file as one `fit` run without noise figures.
    pub fn load(folder: &Path) -> Result<Self, RecordError> {
        let manifest = manifest::load(folder)?;
        let mut set = Self {
            folder: manifest.folder.clone(),
            rig: manifest.rig.clone(),
            window_s: manifest.window_s,
            title: manifest.title.clone(),
            noise: manifest.noise.clone(),
            ..Self::default()
        };
        assemble::add_runs(&mut set, &manifest)?;
        Ok(set)
    }

    /// Standard deviation of the white noise of a channel by the data sheet: that of the longest prefix in
    /// [`Self::noise`] that ends where a part of the name ends. For an orientation's components: rad about each axis.
    pub fn sigma(&self, channel: &str) -> Option<f64> {
        let fits = |prefix: &&String| {
            channel.strip_prefix(prefix.as_str()).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        let longest = self.noise.keys().filter(fits).max_by_key(|prefix| prefix.len())?;
        self.noise.get(longest).copied()
    }

    /// The runs of one role.
    pub fn runs_of(&self, role: Role) -> impl Iterator<Item = &RecordedRun> {
        self.runs.iter().filter(move |run| run.role == role)
    }
}

impl RecordedRun {
    /// A channel by its name.
    pub fn series(&self, channel: &str) -> Option<&Series> {
        let at = self.series.binary_search_by(|series| series.channel.as_str().cmp(channel)).ok()?;
        self.series.get(at)
    }

    /// First and last instant of any channel, s.
    pub fn span(&self) -> Option<(f64, f64)> {
        let first = self.series.iter().filter_map(|s| s.times.first()).copied().reduce(f64::min)?;
        let last = self.series.iter().filter_map(|s| s.times.last()).copied().reduce(f64::max)?;
        Some((first, last))
    }

    /// Last instant minus first, s.
    pub fn duration(&self) -> f64 {
        self.span().map_or(0.0, |(first, last)| last - first)
    }
}

impl Remark {
    /// A sentence about a whole set.
    pub fn new(severity: Severity, what: impl Into<String>) -> Self {
        Self { run: None, channel: None, what: what.into(), severity }
    }

    /// The sentence with its subject: run and channel, where it is about one.
    pub fn sentence(&self) -> String {
        let subject: Vec<&str> = [&self.run, &self.channel].into_iter().flatten().map(String::as_str).collect();
        let colon = if subject.is_empty() { "" } else { ": " };
        format!("{}{colon}{}", subject.join(", "), self.what)
    }

    pub(crate) fn of_run(mut self, run: &str) -> Self {
        self.run = Some(run.to_owned());
        self
    }

    pub(crate) fn of_channel(mut self, channel: &str) -> Self {
        self.channel = Some(channel.to_owned());
        self
    }
}

impl std::fmt::Display for Remark {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.severity.key(), self.sentence())
    }
}
