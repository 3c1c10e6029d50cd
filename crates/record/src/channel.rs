//! Channels: named, unit-bearing signals over one time base.
//!
//! Names follow the recording format: `joint.<joint>.position`, `body.<body>.angular_velocity.x`,
//! `sensor.<sensor>.force.z`, `actuator.<name>.command`. A value that was not sampled is NaN in memory and an empty
//! cell (null) in files.

use crate::RecordError;
use std::fmt;
use std::path::Path;
use std::str::FromStr;

/// Which plot a channel is drawn in. Channels of one plot with different units get one set of axes per unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Plot {
    /// Tool relative to target: distance, angle, rates.
    Relative,
    /// Contact forces, slip, friction use.
    Contact,
    /// Momentum of the system and its drift.
    Momentum,
    /// Energies and powers.
    Energy,
    /// Joint positions, rates, efforts.
    Joints,
    /// Base and free bodies: positions, attitudes, twists.
    Bodies,
    /// Thrusters, wheels, drives.
    Actuators,
    /// What sensors report.
    Sensors,
    /// Everything else.
    #[default]
    Other,
}

impl Plot {
    /// All plots, most telling first.
    pub const ALL: [Self; 9] = [
        Self::Relative,
        Self::Contact,
        Self::Momentum,
        Self::Energy,
        Self::Joints,
        Self::Bodies,
        Self::Actuators,
        Self::Sensors,
        Self::Other,
    ];

    /// Lower-case key, as in file metadata and entity paths.
    pub fn key(self) -> &'static str {
        match self {
            Self::Relative => "relative",
            Self::Contact => "contact",
            Self::Momentum => "momentum",
            Self::Energy => "energy",
            Self::Joints => "joints",
            Self::Bodies => "bodies",
            Self::Actuators => "actuators",
            Self::Sensors => "sensors",
            Self::Other => "other",
        }
    }

    /// Heading for people.
    pub fn title(self) -> &'static str {
        match self {
            Self::Relative => "Relative motion",
            Self::Contact => "Contact",
            Self::Momentum => "Momentum",
            Self::Energy => "Energy",
            Self::Joints => "Joints",
            Self::Bodies => "Bodies",
            Self::Actuators => "Actuators",
            Self::Sensors => "Sensors",
            Self::Other => "Other",
        }
    }
}

impl fmt::Display for Plot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.key())
    }
}

impl FromStr for Plot {
    type Err = ();
    fn from_str(key: &str) -> Result<Self, ()> {
        Self::ALL.into_iter().find(|plot| plot.key() == key).ok_or(())
    }
}

/// What a channel is, without its values.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct ChannelSpec {
    /// Unique name, `joint.servicer/elbow.position`.
    pub name: String,
    /// SI unit as printed: `rad`, `N·m`, `kg·m²/s`, `1`.
    pub unit: String,
    /// One sentence: meaning, sign, frame.
    pub description: String,
    /// Where it is drawn.
    pub plot: Plot,
}

impl ChannelSpec {
    /// A channel without description.
    pub fn new(name: impl Into<String>, unit: impl Into<String>, plot: Plot) -> Self {
        Self { name: name.into(), unit: unit.into(), description: String::new(), plot }
    }

    /// The same with a description: meaning, sign, frame.
    pub fn described(mut self, description: impl Into<String>) -> Self {
        self.description = description.into();
        self
    }
}

/// One signal: its description and one value per instant of the time base.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// What it is.
    pub spec: ChannelSpec,
    /// One value per instant; NaN: not sampled.
    pub values: Vec<f64>,
}

/// A table of signals over one time base: what Parquet and CSV files hold.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Signals {
    /// Instants, s, strictly increasing.
    pub times: Vec<f64>,
    /// Signals, in file order.
    pub channels: Vec<Channel>,
}

impl Signals {
    /// An empty table with these columns.
    pub fn new(specs: Vec<ChannelSpec>) -> Self {
        let channels = specs.into_iter().map(|spec| Channel { spec, values: Vec::new() }).collect();
        Self { times: Vec::new(), channels }
    }

    /// The values of a channel by its name.
    pub fn values(&self, name: &str) -> Option<&[f64]> {
        self.channels.iter().find(|channel| channel.spec.name == name).map(|channel| channel.values.as_slice())
    }

    /// Channels grouped into sets of axes: by plot, most telling first, then by unit in order of appearance.
    pub fn axes(&self) -> Vec<Axes> {
        axes_of(self.channels.iter().map(|channel| &channel.spec))
    }

    /// Whether both hold the same names and, bit for bit, the same numbers; "not sampled" equals itself.
    pub fn same_numbers(&self, other: &Self) -> bool {
        let same = |(a, b): (&Channel, &Channel)| a.spec.name == b.spec.name && same_bits(&a.values, &b.values);
        same_bits(&self.times, &other.times)
            && self.channels.len() == other.channels.len()
            && self.channels.iter().zip(&other.channels).all(same)
    }

    /// The time base must be finite and strictly increasing, the names unique.
    pub(crate) fn check(&self, path: &Path) -> Result<(), RecordError> {
        if let Some(i) = (1..self.times.len()).find(|&i| self.times[i] <= self.times[i - 1]) {
            let (before, after) = (self.times[i - 1], self.times[i]);
            let problem = format!("time goes from {before} s to {after} s at row {}; t must increase strictly", i + 1);
            return Err(RecordError::table(path, problem));
        }
        let mut names: Vec<&str> = self.channels.iter().map(|channel| channel.spec.name.as_str()).collect();
        names.sort_unstable();
        match names.windows(2).find(|pair| pair[0] == pair[1]) {
            Some(pair) => Err(RecordError::table(path, format!("two columns are named \"{}\"; rename one", pair[0]))),
            None => Ok(()),
        }
    }
}

fn same_bits(a: &[f64], b: &[f64]) -> bool {
    let same = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
    a.len() == b.len() && a.iter().zip(b).all(same)
}

/// One set of axes: channels of one plot and one unit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Axes {
    /// The plot they belong to.
    pub plot: Plot,
    /// Their common unit.
    pub unit: String,
    /// Indices of the channels.
    pub channels: Vec<usize>,
    /// Legend names: what is left of each name without the words that all share.
    pub labels: Vec<String>,
}

impl Axes {
    /// `Joints · position (rad)`: the plot, the words that all channels share at the end, and the unit.
    pub fn title(&self, specs: &[&ChannelSpec]) -> String {
        let names: Vec<&str> = self.channels.iter().map(|&i| specs[i].name.as_str()).collect();
        let shared = shared_suffix(&names);
        let unit = if self.unit.is_empty() || self.unit == "1" { String::new() } else { format!(" ({})", self.unit) };
        match shared.is_empty() {
            true => format!("{}{unit}", self.plot.title()),
            false => format!("{} · {}{unit}", self.plot.title(), shared.replace('_', " ")),
        }
    }
}

/// Groups channels into sets of axes; see [`Signals::axes`].
pub fn axes_of<'a>(specs: impl IntoIterator<Item = &'a ChannelSpec>) -> Vec<Axes> {
    let mut all: Vec<Axes> = Vec::new();
    let specs: Vec<&ChannelSpec> = specs.into_iter().collect();
    for (i, spec) in specs.iter().enumerate() {
        match all.iter_mut().find(|axes| axes.plot == spec.plot && axes.unit == spec.unit) {
            Some(axes) => axes.channels.push(i),
            None => all.push(Axes { plot: spec.plot, unit: spec.unit.clone(), channels: vec![i], labels: Vec::new() }),
        }
    }
    for axes in &mut all {
        let names: Vec<&str> = axes.channels.iter().map(|&i| specs[i].name.as_str()).collect();
        axes.labels = short_labels(&names);
    }
    all.sort_by_key(|axes| axes.plot);
    all
}

/// Drops the dotted words that all names share at the front and at the end, then the vehicle that all share.
fn short_labels(names: &[&str]) -> Vec<String> {
    let words: Vec<Vec<&str>> = names.iter().map(|name| name.split('.').collect()).collect();
    let shortest = words.iter().map(Vec::len).min().unwrap_or(0);
    let limit = shortest.saturating_sub(1);
    let same = |i: usize| words.iter().all(|w| w[i] == words[0][i]);
    let alone = names.len() < 2;
    let front = if alone { limit.min(1) } else { (0..limit).take_while(|&i| same(i)).count() };
    let same_back = |i: usize| words.iter().all(|w| w[w.len() - 1 - i] == words[0][words[0].len() - 1 - i]);
    let back = if alone { 0 } else { (0..limit - front).take_while(|&i| same_back(i)).count() };
    let labels: Vec<String> = words.iter().map(|w| w[front..w.len() - back].join(".")).collect();
    let vehicle = labels.first().and_then(|label| label.split_once('/')).map(|(vehicle, _)| format!("{vehicle}/"));
    match vehicle.filter(|vehicle| labels.iter().all(|label| label.starts_with(vehicle.as_str()))) {
        Some(vehicle) => labels.iter().map(|label| label[vehicle.len()..].to_string()).collect(),
        None => labels,
    }
}

/// The dotted words that all names share at the end (`position`), empty for a single name.
fn shared_suffix(names: &[&str]) -> String {
    if names.len() < 2 {
        return String::new();
    }
    let words: Vec<Vec<&str>> = names.iter().map(|name| name.rsplit('.').collect()).collect();
    let limit = words.iter().map(Vec::len).min().unwrap_or(0).saturating_sub(1);
    let back = (0..limit).take_while(|&i| words.iter().all(|w| w[i] == words[0][i])).count();
    words[0][..back].iter().rev().copied().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_keep_only_what_tells_channels_apart() {
        let names = ["joint.servicer/elbow.position", "joint.servicer/wrist.position"];
        assert_eq!(short_labels(&names), ["elbow", "wrist"]);
        assert_eq!(short_labels(&["joint.a/hip.effort", "joint.b/hip.effort"]), ["a/hip", "b/hip"]);
        assert_eq!(short_labels(&["relative.distance"]), ["distance"]);
        assert_eq!(short_labels(&["joint.servicer/finger.position"]), ["finger.position"]);
        assert_eq!(short_labels(&["t"]), ["t"]);
        assert_eq!(short_labels(&["a", "a.b"]), ["a", "a.b"]);
    }

    #[test]
    fn one_set_of_axes_per_plot_and_unit_most_telling_first() {
        let specs = [
            ChannelSpec::new("joint.a.position", "rad", Plot::Joints),
            ChannelSpec::new("joint.a.velocity", "rad/s", Plot::Joints),
            ChannelSpec::new("relative.distance", "m", Plot::Relative),
            ChannelSpec::new("joint.b.position", "rad", Plot::Joints),
        ];
        let axes = axes_of(&specs);
        assert_eq!(axes.len(), 3);
        assert_eq!(axes[0].plot, Plot::Relative);
        assert_eq!(axes[1].channels, [0, 3]);
        assert_eq!(axes[1].title(&specs.iter().collect::<Vec<_>>()), "Joints · position (rad)");
    }

    #[test]
    fn every_plot_is_found_by_its_key() {
        assert!(Plot::ALL.into_iter().all(|plot| plot.key().parse() == Ok(plot)));
    }
}
