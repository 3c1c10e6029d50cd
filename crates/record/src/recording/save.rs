//! Writing a set: what was read, or what was made, as a folder that reads back the same.

use super::{RecordedRun, RecordingSet, Series};
use crate::{Channel, ChannelSpec, Meta, Plot, RecordError, Signals, encode_parquet, write_file};
use std::fmt::Write;
use std::path::Path;
use toml::Value;

/// Decimals of values whose rounding is not a power of ten.
const DECIMALS: usize = 12;

/// How the file of a run is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Format {
    /// Text, a column a channel.
    #[default]
    Csv,
    /// The same columns in Parquet.
    Parquet,
    /// MCAP: a JSON message for every instant, with its time as `t` and each channel that was sampled then by its name.
    Mcap,
}

/// All of them.
const ALL: [Format; 3] = [Format::Csv, Format::Parquet, Format::Mcap];

impl Format {
    /// The ending of its files.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Parquet => "parquet",
            Self::Mcap => "mcap",
        }
    }

    fn encode(self, run: &RecordedRun) -> Result<Vec<u8>, RecordError> {
        match self {
            Self::Csv => Ok(encode(run).into_bytes()),
            Self::Parquet => encode_parquet(&Meta::default(), &signals_of(run)),
            Self::Mcap => encode_mcap(run),
        }
    }
}

impl RecordingSet {
    /// Writes `recording.toml` and one CSV for each run into a folder; channels have the names and units of the format.
    pub fn save(&self, folder: &Path) -> Result<(), RecordError> {
        for run in &self.runs {
            write_file(&folder.join(&run.file), encode(run).as_bytes())?;
        }
        write_file(&folder.join(super::manifest::FILE), self.manifest().as_bytes())
    }

    /// Adds the runs of this set to the one in a folder, or begins it: files of runs are those that it has not yet, `run-01.csv`, `run-02.csv`, …
    ///
    /// Errors: what is there is no set, one of another rig, or one whose `recording.toml` says more than is written here (columns that are mapped, runs that
    /// are cut): that would be lost.
    pub fn append_to(mut self, folder: &Path, format: Format) -> Result<Vec<String>, RecordError> {
        let manifest = folder.join(super::manifest::FILE);
        let known = if manifest.exists() { Some(Self::load(folder)?) } else { None };
        if let Some(known) = known.as_ref().filter(|known| known.rig != self.rig) {
            let problem = format!("is of the rig \"{}\", not \"{}\"; record into another folder", known.rig, self.rig);
            return Err(RecordError::table(&manifest, problem));
        }
        if known.is_some() {
            refuse_foreign(&manifest)?;
        }
        let mut number = 0;
        for run in &mut self.runs {
            // A number that no file has yet, whatever its format.
            let is_taken = |n: usize| ALL.iter().any(|f| folder.join(format!("run-{n:02}.{}", f.ending())).exists());
            number = (number + 1..).find(|n| !is_taken(*n)).unwrap_or(number + 1);
            run.file = format!("run-{number:02}.{}", format.ending());
            write_file(&folder.join(&run.file), &format.encode(run)?)?;
        }
        let added = self.runs.iter().map(|run| run.file.clone()).collect();
        if let Some(mut known) = known {
            known.noise.append(&mut self.noise);
            known.runs.append(&mut self.runs);
            (self.noise, self.runs, self.title, self.window_s) = (known.noise, known.runs, known.title, known.window_s);
        }
        write_file(&manifest, self.manifest().as_bytes())?;
        Ok(added)
    }

    fn manifest(&self) -> String {
        let quoted = |text: &str| Value::from(text).to_string();
        let mut text = format!("format = 1\nrig = {}\ntitle = {}\n", quoted(&self.rig), quoted(&self.title));
        text += &self.window_s.map_or_else(String::new, |window| format!("window_s = {window}\n"));
        text += "\n[noise]\n";
        for (channel, sigma) in &self.noise {
            let _ = writeln!(text, "{} = {sigma:e}", quoted(channel));
        }
        for run in &self.runs {
            let (file, note) = (quoted(&run.file), quoted(&run.note));
            let _ = write!(text, "\n[[run]]\nfile = {file}\nrole = \"{}\"\nnote = {note}\n", run.role.key());
        }
        text
    }
}

/// A table of all series: a row for each instant, empty cells where a channel was not sampled.
fn encode(run: &RecordedRun) -> String {
    let times = instants_of(run);
    let mut text = String::from("t");
    run.series.iter().for_each(|s| text.extend([",", s.channel.as_str()]));
    text.push('\n');
    let decimals: Vec<Option<usize>> = run.series.iter().map(decimals_of).collect();
    let mut next = vec![0; run.series.len()];
    for time in times {
        let _ = write!(text, "{time}");
        for ((series, at), decimals) in run.series.iter().zip(&mut next).zip(&decimals) {
            text.push(',');
            if series.times.get(*at) == Some(&time) {
                let _ = match decimals {
                    Some(decimals) => write!(text, "{:.decimals$}", series.values[*at]),
                    None => write!(text, "{}", series.values[*at]),
                };
                *at += 1;
            }
        }
        text.push('\n');
    }
    text
}

/// A manifest that says what this module does not write is nobody's to write again.
fn refuse_foreign(manifest: &Path) -> Result<(), RecordError> {
    let text = std::fs::read_to_string(manifest).map_err(RecordError::read(manifest))?;
    let table: toml::Table =
        text.parse().map_err(|error| RecordError::table(manifest, format!("is no TOML: {error}")))?;
    let runs = table.get("run").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_table);
    let of_set =
        table.keys().filter(|key| !["format", "rig", "title", "window_s", "noise", "run"].contains(&key.as_str()));
    let of_runs = runs.flat_map(toml::Table::keys).filter(|key| !["file", "role", "note"].contains(&key.as_str()));
    match of_set.chain(of_runs).next() {
        None => Ok(()),
        Some(key) => {
            let problem = format!("has `{key}`, which a run that is added would not keep; record into another folder");
            Err(RecordError::table(manifest, problem))
        }
    }
}

/// The instants of all channels of a run, ascending.
fn instants_of(run: &RecordedRun) -> Vec<f64> {
    let mut times: Vec<f64> = run.series.iter().flat_map(|s| s.times.iter().copied()).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

/// A run as a table over the instants of all its channels.
fn signals_of(run: &RecordedRun) -> Signals {
    let times = instants_of(run);
    let channel = |series: &Series| {
        let mut values = vec![f64::NAN; times.len()];
        for (time, value) in series.times.iter().zip(&series.values) {
            values[times.partition_point(|t| t < time)] = *value;
        }
        Channel { spec: ChannelSpec::new(series.channel.as_str(), "", Plot::Other), values }
    };
    let channels = run.series.iter().map(channel).collect();
    Signals { times, channels }
}

fn encode_mcap(run: &RecordedRun) -> Result<Vec<u8>, RecordError> {
    let signals = signals_of(run);
    let write = || -> Result<Vec<u8>, mcap::McapError> {
        let mut file = std::io::Cursor::new(Vec::new());
        // Nothing of a clock or a host: equal runs give equal bytes.
        let options = mcap::WriteOptions::new().library("softdock").compression(Some(mcap::Compression::Zstd));
        let mut writer = options.create(&mut file)?;
        let channel = writer.add_channel(0, "softdock", "json", &std::collections::BTreeMap::new())?;
        for (row, time) in signals.times.iter().enumerate() {
            let sampled = signals.channels.iter().filter(|c| !c.values[row].is_nan());
            let sampled = sampled.map(|c| (c.spec.name.clone(), c.values[row].into()));
            let message = std::iter::once(("t".to_owned(), (*time).into())).chain(sampled).collect();
            let nanoseconds = (time * 1e9).round().max(0.0) as u64;
            let header = mcap::records::MessageHeader {
                channel_id: channel,
                sequence: row as u32,
                log_time: nanoseconds,
                publish_time: nanoseconds,
            };
            writer.write_to_known_channel(&header, serde_json::Value::Object(message).to_string().as_bytes())?;
        }
        writer.finish()?;
        drop(writer);
        Ok(file.into_inner())
    };
    write().map_err(|error| RecordError::Encode { what: "a run in MCAP", reason: error.to_string() })
}

/// Decimals that show a series' rounding; none where its values are continuous.
fn decimals_of(series: &Series) -> Option<usize> {
    let quantum = series.quantum();
    let places = -quantum.log10();
    let is_decimal = (places - places.round()).abs() < 1e-9 && places > -0.5;
    (quantum > 0.0).then(|| if is_decimal { places.round() as usize } else { DECIMALS })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Role;

    #[test]
    fn a_set_reads_back_as_it_was_written() {
        let times: Vec<f64> = (0..50).map(|i| f64::from(i) * 0.02).collect();
        let position: Vec<f64> = times.iter().map(|t| ((3.0 * t).sin() * 1e4).round() / 1e4).collect();
        let slow: Vec<f64> = times.iter().step_by(3).copied().collect();
        let command: Vec<f64> = slow.iter().map(|t| 0.1 + t.cos() / 3.0).collect();
        let series = vec![
            Series::new("joint.elbow.effort_command", slow, command),
            Series::new("joint.elbow.position", times, position),
        ];
        let run = RecordedRun { file: "run-01.csv".into(), role: Role::Holdout, note: "a \"note\"".into(), series };
        let set = RecordingSet {
            rig: "arm".into(),
            window_s: None,
            title: "one joint".into(),
            noise: [("joint.elbow.position".to_owned(), 2e-5)].into(),
            runs: vec![run],
            ..RecordingSet::default()
        };
        let folder = tempfile::tempdir().expect("a folder");
        set.save(folder.path()).expect("it is written");
        let read = RecordingSet::load(folder.path()).expect("it is read");
        assert_eq!((&read.rig, &read.title, &read.noise), (&set.rig, &set.title, &set.noise));
        let (a, b) = (&read.runs[0], &set.runs[0]);
        assert_eq!((&a.file, a.role, &a.note, &a.series), (&b.file, b.role, &b.note, &b.series));
    }
}
