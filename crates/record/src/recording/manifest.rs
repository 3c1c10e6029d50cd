//! `recording.toml`: what the folder says of itself.
//!
//! ```toml
//! format = 1
//! rig    = "cube"
//! [noise]
//! "body.cube.position" = 1e-5              # always in the channel's SI unit, whatever the column's
//! [time]
//! column = "t_ms"                          # default: t
//! unit   = "ms"                            # default: s
//! group  = "toss"                          # optional: every new value of this column starts a run
//! [channels]
//! "body.cube.angular_velocity.x" = { column = "wx_deg_s", unit = "deg/s", scale = -1.0 }
//! [[run]]
//! file   = "tosses.csv"
//! role   = "fit"
//! groups = ["0-99", 120]                   # with [time] group: which of its values; default: all of them
//! [[run]]
//! file   = "tosses.csv"                    # the same file again, with other groups and another role
//! role   = "holdout"
//! groups = ["130-149"]
//! ```
//!
//! `from_s` and `to_s` cut a run out of a long file, or out of each of its groups, in s of the file's clock; several runs may share it so.

use super::channel_name::{self, ChannelName};
use super::spelling::{hint, listed};
use super::units::{self, Dimension};
use super::{Remark, Role, Severity};
use crate::RecordError;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// Name of the file.
pub(super) const FILE: &str = "recording.toml";

/// A column that is read as a channel.
#[derive(Clone, Debug)]
pub(super) struct Mapping {
    /// Name in the run file.
    pub(super) column: String,
    /// SI units per unit of the column.
    pub(super) factor: f64,
}

/// A `[[run]]`.
#[derive(Clone, Debug)]
pub(super) struct RunEntry {
    pub(super) file: String,
    pub(super) role: Role,
    pub(super) note: String,
    /// Values of the group column, none: all.
    pub(super) groups: Option<Vec<String>>,
    /// From when, and before when, by the file's clock, s; none: all of it.
    pub(super) span: Option<[f64; 2]>,
}

/// What `recording.toml` says.
#[derive(Clone, Debug)]
pub(super) struct Manifest {
    pub(super) path: PathBuf,
    pub(super) folder: PathBuf,
    pub(super) rig: String,
    pub(super) window_s: Option<f64>,
    pub(super) title: String,
    pub(super) noise: BTreeMap<String, f64>,
    pub(super) runs: Vec<RunEntry>,
    pub(super) time_column: String,
    /// Seconds per unit of the time column.
    pub(super) time_factor: f64,
    pub(super) group: Option<String>,
    pub(super) channels: BTreeMap<String, Mapping>,
    pub(super) remarks: Vec<Remark>,
}

/// Reads `recording.toml` of a folder; a single run file makes a manifest of its own.
pub(super) fn load(place: &Path) -> Result<Manifest, RecordError> {
    let file = place.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    let (path, folder) = match (place.is_file(), file.as_str()) {
        (true, "toml") => (place.to_owned(), parent(place)),
        (true, _) => return Ok(of_one_file(place)),
        (false, _) => (place.join(FILE), place.to_owned()),
    };
    if !folder.is_dir() {
        let problem = "there is no such folder; give a folder with recording.toml, or one run file (.csv, .parquet)";
        return Err(RecordError::table(place, problem));
    }
    if !path.is_file() {
        let problem = format!(
            "holds no {FILE}; write one (format = 1, rig = \"…\", and a [[run]] with file and role for each run); \
             the folder holds {}",
            listed(names_in(&folder).iter().map(String::as_str))
        );
        return Err(RecordError::table(&folder, problem));
    }
    let text = std::fs::read_to_string(&path).map_err(RecordError::read(&path))?;
    Reader { path: path.clone(), text: &text }.read(folder)
}

fn parent(file: &Path) -> PathBuf {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    }
}

fn of_one_file(file: &Path) -> Manifest {
    let name = file.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    Manifest {
        path: file.to_owned(),
        folder: parent(file),
        rig: String::new(),
        window_s: None,
        title: name.clone(),
        noise: BTreeMap::new(),
        runs: vec![RunEntry { file: name, role: Role::Fit, note: String::new(), groups: None, span: None }],
        time_column: "t".to_owned(),
        time_factor: 1.0,
        group: None,
        channels: BTreeMap::new(),
        remarks: vec![Remark::new(
            Severity::Note,
            "a single file without recording.toml: read as one run to fit, without noise figures",
        )],
    }
}

/// Names of the files of a folder, sorted.
pub(super) fn names_in(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

struct Reader<'a> {
    path: PathBuf,
    text: &'a str,
}

impl Reader<'_> {
    fn read(&self, folder: PathBuf) -> Result<Manifest, RecordError> {
        let table: Table = self.text.parse().map_err(|e: toml::de::Error| RecordError::table(&self.path, e))?;
        self.check_keys(
            &table,
            "the file",
            &["format", "rig", "title", "window_s", "noise", "run", "time", "channels"],
        )?;
        self.check_format(&table)?;
        let (time_column, time_factor, group) = self.time(&table)?;
        let (noise, remarks) = self.noise(&table)?;
        Ok(Manifest {
            folder,
            rig: self.text_of(&table, "rig", "the file")?.ok_or_else(|| {
                self.wrong("rig", "has no rig: name the rig card that describes the hardware, rig = \"…\"")
            })?,
            title: self.text_of(&table, "title", "the file")?.unwrap_or_default(),
            window_s: self.window(&table)?,
            noise,
            runs: self.runs(&table, group.is_some())?,
            time_column,
            time_factor,
            group,
            channels: self.channels(&table)?,
            remarks,
            path: self.path.clone(),
        })
    }

    fn window(&self, table: &Table) -> Result<Option<f64>, RecordError> {
        let Some(value) = table.get("window_s") else { return Ok(None) };
        let window = number(value).filter(|w| w.is_finite() && *w > 0.0);
        let wrong = || {
            self.wrong("window_s", format!("window_s = {value} is not a length of time; it is a number above 0, in s"))
        };
        window.map(Some).ok_or_else(wrong)
    }

    fn check_format(&self, table: &Table) -> Result<(), RecordError> {
        match table.get("format") {
            Some(Value::Integer(1)) => Ok(()),
            Some(other) => Err(self.wrong("format", format!("format = {other} is not known; this reads format = 1"))),
            None => Err(self.wrong("format", "has no format; its first line is `format = 1`")),
        }
    }

    fn time(&self, table: &Table) -> Result<(String, f64, Option<String>), RecordError> {
        let Some(time) = self.table_of(table, "time")? else { return Ok(("t".to_owned(), 1.0, None)) };
        self.check_keys(time, "[time]", &["column", "group", "unit"])?;
        let column = self.text_of(time, "column", "[time]")?.unwrap_or_else(|| "t".to_owned());
        let factor = match self.text_of(time, "unit", "[time]")? {
            Some(unit) => self.factor(&unit, &[Dimension::Time], "[time]")?,
            None => 1.0,
        };
        Ok((column, factor, self.text_of(time, "group", "[time]")?))
    }

    fn noise(&self, table: &Table) -> Result<(BTreeMap<String, f64>, Vec<Remark>), RecordError> {
        let mut noise = BTreeMap::new();
        for (channel, value) in self.table_of(table, "noise")?.into_iter().flatten() {
            let sigma = number(value).filter(|sigma| sigma.is_finite() && *sigma >= 0.0).ok_or_else(|| {
                let problem =
                    format!("[noise] \"{channel}\" = {value} is not a standard deviation; it is a number, 0 or above");
                self.wrong(channel, problem)
            })?;
            noise.insert(channel.clone(), sigma);
        }
        Ok((noise, Vec::new()))
    }

    fn channels(&self, table: &Table) -> Result<BTreeMap<String, Mapping>, RecordError> {
        let mut channels = BTreeMap::new();
        for (channel, value) in self.table_of(table, "channels")?.into_iter().flatten() {
            channels.insert(channel.clone(), self.mapping(channel, value)?);
        }
        Ok(channels)
    }

    fn mapping(&self, channel: &str, value: &Value) -> Result<Mapping, RecordError> {
        let place = format!("[channels] \"{channel}\"");
        let Some(name) = ChannelName::parse(channel) else {
            let meant = match channel_name::meant(channel) {
                Some(meant) => format!("; did you mean \"{meant}\"?"),
                None => format!("; a channel is one of {}", channel_name::forms().join(", ")),
            };
            return Err(self.wrong(channel, format!("{place} is no channel of the recording format{meant}")));
        };
        let Value::Table(table) = value else {
            let problem = format!("{place} must be a table such as {{ column = \"meas_pos_m\", unit = \"mm\" }}");
            return Err(self.wrong(channel, problem));
        };
        self.check_keys(table, &place, &["column", "scale", "unit"])?;
        let column = self.text_of(table, "column", &place)?;
        let column =
            column.ok_or_else(|| self.wrong(channel, format!("{place} has no column; name the file's column")))?;
        let unit = match self.text_of(table, "unit", &place)? {
            Some(unit) => self.factor(&unit, name.quantity.dimensions(), &place)?,
            None => 1.0,
        };
        let scale = match table.get("scale") {
            None => 1.0,
            Some(value) => number(value)
                .filter(|s| s.is_finite() && *s != 0.0)
                .ok_or_else(|| self.wrong(channel, format!("{place}: scale = {value} is not a number other than 0")))?,
        };
        Ok(Mapping { column, factor: scale * unit })
    }

    fn factor(&self, unit: &str, dimensions: &[Dimension], place: &str) -> Result<f64, RecordError> {
        let fitting = units::names_of(dimensions);
        match units::find(unit) {
            Some(found) if dimensions.contains(&found.dimension) => Ok(found.in_si),
            Some(_) => {
                let problem =
                    format!("{place}: unit \"{unit}\" does not fit here; units that do: {}", fitting.join(", "));
                Err(self.wrong(unit, problem))
            }
            None => {
                let problem = format!(
                    "{place}: unit \"{unit}\" is not known; units that fit here: {}; for another, give scale instead",
                    fitting.join(", ")
                );
                Err(self.wrong(unit, problem))
            }
        }
    }

    fn runs(&self, table: &Table, grouped: bool) -> Result<Vec<RunEntry>, RecordError> {
        let none = || self.wrong("run", "names no run; add a [[run]] with file and role for each run file");
        let Some(Value::Array(entries)) = table.get("run") else { return Err(none()) };
        let mut runs: Vec<RunEntry> = Vec::new();
        for (i, entry) in entries.iter().enumerate() {
            let run = self.run(entry, i + 1, grouped)?;
            if !grouped && runs.iter().any(|other| other.file == run.file && super::group::overlap(other, &run)) {
                let problem = format!(
                    "[[run]] {} names \"{}\" a second time; a run has one role (from_s and to_s cut it in two)",
                    i + 1,
                    run.file
                );
                return Err(self.wrong(&run.file, problem));
            }
            runs.push(run);
        }
        if runs.is_empty() { Err(none()) } else { Ok(runs) }
    }

    fn run(&self, entry: &Value, number: usize, grouped: bool) -> Result<RunEntry, RecordError> {
        let place = format!("[[run]] {number}");
        let Value::Table(table) = entry else {
            return Err(self.wrong("run", format!("{place} must be a table with file and role")));
        };
        self.check_keys(table, &place, &["file", "role", "note", "groups", "from_s", "to_s"])?;
        let file = self.text_of(table, "file", &place)?.filter(|file| !file.is_empty());
        let file = file.ok_or_else(|| self.wrong("run", format!("{place} has no file")))?;
        let role = match self.text_of(table, "role", &place)?.as_deref() {
            Some("fit") => Role::Fit,
            Some("holdout") => Role::Holdout,
            Some(other) => {
                let near = hint(other, ["fit", "holdout"]);
                return Err(self.wrong(other, format!("{place} ({file}): role = \"{other}\" is not known{near}")));
            }
            None => {
                return Err(self.wrong(&file, format!("{place} ({file}) has no role; it is \"fit\" or \"holdout\"")));
            }
        };
        let groups = match table.get("groups") {
            None => None,
            Some(_) if !grouped => {
                let problem =
                    format!("{place}: groups are chosen but [time] names no group column; add group = \"…\" there");
                return Err(self.wrong("groups", problem));
            }
            Some(value) => Some(self.groups(value, &place)?),
        };
        let span = self.span(table, &place)?;
        Ok(RunEntry { file, role, note: self.text_of(table, "note", &place)?.unwrap_or_default(), groups, span })
    }

    fn span(&self, table: &Table, place: &str) -> Result<Option<[f64; 2]>, RecordError> {
        let bound = |key: &str, without: f64| match table.get(key) {
            None => Ok(without),
            Some(value) => number(value).filter(|t| t.is_finite()).ok_or_else(|| {
                self.wrong(key, format!("{place}: {key} = {value} is not a time; it is a number, in s"))
            }),
        };
        let span = [bound("from_s", f64::NEG_INFINITY)?, bound("to_s", f64::INFINITY)?];
        if span == [f64::NEG_INFINITY, f64::INFINITY] {
            return Ok(None);
        }
        if span[0] >= span[1] {
            let problem = format!("{place}: it ends, to_s = {}, before it begins, from_s = {}", span[1], span[0]);
            return Err(self.wrong("to_s", problem));
        }
        Ok(Some(span))
    }

    fn groups(&self, value: &Value, place: &str) -> Result<Vec<String>, RecordError> {
        let wrong = || {
            let problem =
                format!("{place}: groups is a list of values and ranges of the group column, such as [\"0-99\", 120]");
            self.wrong("groups", problem)
        };
        let Value::Array(items) = value else { return Err(wrong()) };
        let one = |item: &Value| match item {
            Value::String(text) => Ok(text.clone()),
            Value::Integer(n) => Ok(n.to_string()),
            Value::Float(x) => Ok(x.to_string()),
            _ => Err(wrong()),
        };
        items.iter().map(one).collect()
    }

    fn table_of<'t>(&self, table: &'t Table, key: &str) -> Result<Option<&'t Table>, RecordError> {
        match table.get(key) {
            None => Ok(None),
            Some(Value::Table(inner)) => Ok(Some(inner)),
            Some(_) => Err(self.wrong(key, format!("`{key}` must be a table, [{key}]"))),
        }
    }

    fn text_of(&self, table: &Table, key: &str, place: &str) -> Result<Option<String>, RecordError> {
        match table.get(key) {
            None => Ok(None),
            Some(Value::String(text)) => Ok(Some(text.clone())),
            Some(other) => Err(self.wrong(key, format!("{place}: {key} = {other} must be text in quotes"))),
        }
    }

    fn check_keys(&self, table: &Table, place: &str, known: &[&str]) -> Result<(), RecordError> {
        let Some(key) = table.keys().find(|key| !known.contains(&key.as_str())) else { return Ok(()) };
        Err(self.wrong(key, format!("{place}: unknown key `{key}`{}", hint(key, known.iter().copied()))))
    }

    /// An error at the first line that holds the word; at the file where none does.
    fn wrong(&self, word: &str, problem: impl Into<String>) -> RecordError {
        let problem = problem.into();
        match self.text.lines().position(|line| line.contains(word)) {
            Some(line) => RecordError::Line { path: self.path.clone(), line: line + 1, problem },
            None => RecordError::Table { path: self.path.clone(), problem },
        }
    }
}

fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Float(x) => Some(*x),
        Value::Integer(n) => Some(*n as f64),
        _ => None,
    }
}
