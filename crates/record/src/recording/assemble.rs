//! From the manifest and its files to runs of series.

use super::channel_name::{self, ChannelName};
use super::group::{self, Stretch};
use super::manifest::{self, Manifest, RunEntry};
use super::quantum::find_quantum;
use super::spelling::{hint, listed, nearest};
use super::table::Table;
use super::time::{self, Merge, Timeline};
use super::{RecordedRun, RecordingSet, Remark, Series, Severity, orientation, turns};
use crate::RecordError;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A clock that starts later than this, s, counts from an epoch and not from the run's start.
const EPOCH: f64 = 1e6;

/// A column that is read as a channel.
struct Source<'a> {
    channel: &'a str,
    name: ChannelName<'a>,
    values: &'a [f64],
    factor: f64,
}

/// Reads every run of the manifest into the set.
pub(super) fn add_runs(set: &mut RecordingSet, manifest: &Manifest) -> Result<(), RecordError> {
    set.remarks.extend(manifest.remarks.iter().cloned());
    let mut done: Vec<&str> = Vec::new();
    let mut columns_seen: Vec<String> = Vec::new();
    let mut runs: Vec<(usize, RecordedRun)> = Vec::new();
    for entry in &manifest.runs {
        if done.contains(&entry.file.as_str()) {
            continue;
        }
        done.push(&entry.file);
        let table = load_table(manifest, entry)?;
        columns_seen.extend(table.columns.iter().map(|c| c.name.clone()));
        add_file(set, manifest, &table, entry, &mut runs)?;
    }
    // In the order of the [[run]] entries; the sort is stable, so that one entry's runs keep the order of the file.
    runs.sort_by_key(|(entry, _)| *entry);
    set.runs = runs.into_iter().map(|(_, run)| run).collect();
    check_mapping(manifest, &columns_seen)?;
    check_noise(set);
    check_roles(set);
    Ok(())
}

fn load_table(manifest: &Manifest, entry: &RunEntry) -> Result<Table, RecordError> {
    let path = manifest.folder.join(&entry.file);
    if !path.is_file() {
        let names = manifest::names_in(&manifest.folder);
        let others = names.iter().map(String::as_str).filter(|name| *name != manifest::FILE);
        let problem = format!("names the run file \"{}\", which is not there{}", entry.file, hint(&entry.file, others));
        return Err(RecordError::table(&manifest.path, problem));
    }
    Table::load(&path, manifest.group.as_deref())
}

fn add_file(
    set: &mut RecordingSet,
    manifest: &Manifest,
    table: &Table,
    entry: &RunEntry,
    runs: &mut Vec<(usize, RecordedRun)>,
) -> Result<(), RecordError> {
    let times = seconds(manifest, table)?;
    let sources = sources(set, manifest, table, &entry.file)?;
    set.remarks.extend(table.remarks.iter().cloned().map(|remark| remark.of_run(&entry.file)));
    let numbered = manifest.runs.iter().enumerate().filter(|(_, other)| other.file == entry.file);
    let (numbers, entries): (Vec<usize>, Vec<&RunEntry>) = numbered.unzip();
    let all = group::stretches(table, entry, manifest.group.as_deref());
    let (chosen, left) = group::choose(manifest, &entries, (&all, &times))?;
    set.remarks.extend(left.map(|remark| remark.of_run(&entry.file)));
    for (stretch, owner) in chosen {
        let series = read_stretch(set, manifest, table, (&stretch, &times), &sources)?;
        let RunEntry { role, note, .. } = entries[owner];
        runs.push((numbers[owner], RecordedRun { file: stretch.name, role: *role, note: note.clone(), series }));
    }
    Ok(())
}

/// The time column in seconds; with a group column, that it is there.
fn seconds(manifest: &Manifest, table: &Table) -> Result<Vec<f64>, RecordError> {
    let names = || table.columns.iter().map(|c| c.name.as_str()).collect::<Vec<_>>();
    for (key, column) in [("column", Some(&manifest.time_column)), ("group", manifest.group.as_ref())] {
        let Some(column) = column.filter(|column| table.column(column).is_none()) else { continue };
        let near = hint(column, names());
        let problem = format!("has no column \"{column}\" ([time] {key} in {}){near}", manifest::FILE);
        return Err(RecordError::table(&table.path, problem));
    }
    let Some(column) = table.column(&manifest.time_column) else { return Ok(Vec::new()) };
    table.numbers(column)?;
    Ok(column.values.iter().map(|t| t * manifest.time_factor).collect())
}

/// The columns that are channels: mapped ones, and those that bear a channel's name.
fn sources<'a>(
    set: &mut RecordingSet,
    manifest: &'a Manifest,
    table: &'a Table,
    file: &str,
) -> Result<Vec<Source<'a>>, RecordError> {
    let mut sources = BTreeMap::new();
    let mut ignored = Vec::new();
    for column in &table.columns {
        let taken = manifest.channels.contains_key(&column.name);
        match ChannelName::parse(&column.name) {
            Some(name) if !taken => {
                sources.insert(column.name.as_str(), (name, column, 1.0));
            }
            _ => ignored.push(column.name.as_str()),
        }
    }
    for (channel, mapping) in &manifest.channels {
        if let (Some(name), Some(column)) = (ChannelName::parse(channel), table.column(&mapping.column)) {
            sources.insert(channel, (name, column, mapping.factor));
            ignored.retain(|other| *other != mapping.column);
        }
    }
    let is_time = |name: &str| name == manifest.time_column || table.clocks.contains(&name);
    ignored.retain(|name| !is_time(name) && Some(*name) != manifest.group.as_deref() && !name.is_empty());
    say_ignored(set, manifest, &ignored, file);
    if sources.is_empty() {
        let columns = listed(table.columns.iter().map(|c| c.name.as_str()));
        let problem = format!(
            "has no column that is a channel; map its columns in [channels] of {}; its columns are {columns}",
            manifest::FILE
        );
        return Err(RecordError::table(&table.path, problem));
    }
    for (_, column, _) in sources.values() {
        table.numbers(column)?;
        if column.not_finite > 0 {
            let what =
                format!("column \"{}\": {} cells are not finite and count as missing", column.name, column.not_finite);
            set.remarks.push(Remark::new(Severity::Warning, what).of_run(file));
        }
    }
    let source = |(channel, (name, column, factor)): (&'a str, (ChannelName<'a>, &'a super::table::Column, f64))| {
        Source { channel, name, values: &column.values, factor }
    };
    Ok(sources.into_iter().map(source).collect())
}

fn say_ignored(set: &mut RecordingSet, manifest: &Manifest, ignored: &[&str], file: &str) {
    let near: Vec<(&str, String)> =
        ignored.iter().filter_map(|name| Some((*name, channel_name::meant(name)?))).collect();
    for (name, meant) in &near {
        let what = format!("column \"{name}\" is no channel and is not read; did you mean \"{meant}\"?");
        set.remarks.push(Remark::new(Severity::Warning, what).of_run(file));
    }
    let rest: Vec<&str> = ignored.iter().copied().filter(|name| near.iter().all(|(n, _)| n != name)).collect();
    if !rest.is_empty() {
        let severity = if manifest.channels.is_empty() { Severity::Warning } else { Severity::Note };
        let what = format!("{} columns are no channels and are not read: {}", rest.len(), listed(rest));
        set.remarks.push(Remark::new(severity, what).of_run(file));
    }
}

fn read_stretch(
    set: &mut RecordingSet,
    manifest: &Manifest,
    table: &Table,
    (stretch, times): (&Stretch, &[f64]),
    sources: &[Source<'_>],
) -> Result<Vec<Series>, RecordError> {
    let way_out = match manifest.group {
        Some(_) => "sort the rows, or give each run a group value of its own",
        None => "sort the rows, or split the file where a new run begins ([time] group = \"column\" does that)",
    };
    let mut timeline = time::order(table, times, stretch.rows.clone(), way_out)?;
    let mut remarks = Vec::new();
    let cut = manifest.group.is_some() || stretch.rows.len() < times.len();
    shift(&mut timeline, cut, &mut remarks);
    if timeline.swapped > 0 {
        let what = format!("{} rows stood out of order of time and were sorted", timeline.swapped);
        remarks.push(Remark::new(Severity::Warning, what));
    }
    let mut series = Vec::new();
    let mut merged = 0;
    for source in sources {
        match source.name.quantity {
            quantity if quantity.is_orientation() => {}
            quantity => {
                let merge = if quantity.is_command() { Merge::Last } else { Merge::Mean };
                let (times, values, again) = time::samples(&timeline, source.values, merge);
                merged += again;
                let step = find_quantum(&values_of(&timeline, source.values)) * source.factor.abs();
                let mut values: Vec<f64> = values.into_iter().map(|v| v * source.factor).collect();
                if quantity.is_angle() {
                    say_turns(source.channel, turns::unwind(&mut values), &mut remarks);
                }
                let known = series.last().map(|s: &Series| &s.times).filter(|known| known[..] == times[..]);
                let times = known.map_or_else(|| times.into(), Arc::clone);
                series.push(Series::with_quantum(source.channel, times, values, step));
            }
        }
    }
    merged += add_orientations(&mut series, sources, &timeline, &mut remarks);
    if timeline.repeated > 0 {
        let what = format!(
            "{} rows repeat the time of the row before; {merged} samples were merged (measured: the mean; commanded: the last)",
            timeline.repeated
        );
        remarks.push(Remark::new(Severity::Warning, what));
    }
    for empty in series.iter().filter(|s| s.is_empty()) {
        remarks.push(Remark::new(Severity::Warning, "was never sampled").of_channel(&empty.channel));
    }
    series.retain(|s| !s.is_empty());
    series.sort_by(|a, b| a.channel.cmp(&b.channel));
    set.remarks.extend(remarks.into_iter().map(|remark| remark.of_run(&stretch.name)));
    Ok(series)
}

/// Time of a run cut out of a file, or by a clock that counts from an epoch, starts at its first row.
fn shift(timeline: &mut Timeline, cut: bool, remarks: &mut Vec<Remark>) {
    let Some((_, start)) = timeline.rows.first().copied() else { return };
    let epoch = start.abs() > EPOCH;
    if start == 0.0 || !(cut || epoch) {
        return;
    }
    timeline.rows.iter_mut().for_each(|(_, t)| *t -= start);
    remarks.push(Remark::new(Severity::Note, format!("its time counts from its first row, at {start} s of the file")));
}

fn values_of(timeline: &Timeline, values: &[f64]) -> Vec<f64> {
    timeline.rows.iter().map(|(row, _)| values[*row]).filter(|v| v.is_finite()).collect()
}

/// Reads quaternions whole; a body that lacks a component has no orientation.
fn add_orientations(
    series: &mut Vec<Series>,
    sources: &[Source<'_>],
    timeline: &Timeline,
    remarks: &mut Vec<Remark>,
) -> usize {
    let mut merged = 0;
    let parts = |prefix: &str| {
        ["w", "x", "y", "z"].map(|c| sources.iter().find(|s| s.name.prefix == prefix && s.name.component == c))
    };
    let mut prefixes: Vec<&str> =
        sources.iter().filter(|s| s.name.quantity.is_orientation()).map(|s| s.name.prefix).collect();
    prefixes.dedup();
    for prefix in prefixes {
        let [Some(w), Some(x), Some(y), Some(z)] = parts(prefix) else {
            let what = "has not all of w, x, y, z and is not read";
            remarks.push(Remark::new(Severity::Warning, what).of_channel(prefix));
            continue;
        };
        let sources = [w, x, y, z];
        let scaled = sources.map(|s| s.values.iter().map(|v| v * s.factor).collect::<Vec<f64>>());
        let read = orientation::read(timeline, [&scaled[0], &scaled[1], &scaled[2], &scaled[3]]);
        merged += read.merged;
        say_orientation(prefix, &read, remarks);
        // One rounding for all four: a component that hardly moves does not show its own.
        let steps = sources.map(|s| find_quantum(&values_of(timeline, s.values)) * s.factor.abs());
        let step = steps.into_iter().fold(0.0, f64::max);
        let times: Arc<[f64]> = read.times.into();
        for (source, values) in sources.into_iter().zip(read.parts) {
            series.push(Series::with_quantum(source.channel, Arc::clone(&times), values, step));
        }
    }
    merged
}

fn say_turns(channel: &str, times: usize, remarks: &mut Vec<Remark>) {
    if times > 0 {
        let what = format!("begins anew {times} times after a full turn; made continuous");
        remarks.push(Remark::new(Severity::Note, what).of_channel(channel));
    }
}

fn say_orientation(prefix: &str, read: &orientation::Orientation, remarks: &mut Vec<Remark>) {
    let mut say = |severity, what: String| remarks.push(Remark::new(severity, what).of_channel(prefix));
    if read.flips > 0 {
        say(Severity::Note, format!("the quaternion's sign flips {} times; unified", read.flips));
    }
    if read.broken > 0 {
        say(Severity::Warning, format!("{} rows hold an incomplete or zero quaternion and are left out", read.broken));
    }
    if read.off > 0 {
        let share = 100.0 * read.off as f64 / read.times.len().max(1) as f64;
        let what = format!(
            "{:.3} % of the quaternions are not unit (norms as far off as {:.4}); normalised, but is it a quaternion w, x, y, z?",
            share, read.farthest
        );
        say(if share > 10.0 { Severity::Fault } else { Severity::Warning }, what);
    }
}

/// A mapped column that no file has is a slip; one that some files lack is said by the inspection's gaps.
fn check_mapping(manifest: &Manifest, seen: &[String]) -> Result<(), RecordError> {
    let lacking = manifest.channels.iter().find(|(_, mapping)| !seen.contains(&mapping.column));
    let Some((channel, mapping)) = lacking else { return Ok(()) };
    let mut names: Vec<&str> = seen.iter().map(String::as_str).collect();
    names.sort_unstable();
    names.dedup();
    let near = hint(&mapping.column, names);
    let problem = format!("[channels] \"{channel}\": no run file has a column \"{}\"{near}", mapping.column);
    Err(RecordError::table(&manifest.path, problem))
}

fn check_noise(set: &mut RecordingSet) {
    let channels: Vec<&str> = set.runs.iter().flat_map(|run| &run.series).map(|s| s.channel.as_str()).collect();
    let mut remarks = Vec::new();
    for prefix in set.noise.keys() {
        let fits = |c: &&str| c.strip_prefix(prefix.as_str()).is_some_and(|r| r.is_empty() || r.starts_with('.'));
        if !channels.iter().any(fits) {
            let prefixes = channels.iter().flat_map(|c| [*c, c.rsplit_once('.').map_or(*c, |(head, _)| head)]);
            let near = nearest(prefix, prefixes).map(|near| format!("; did you mean \"{near}\"?")).unwrap_or_default();
            let what = format!("[noise] names a channel that no run has{near}");
            remarks.push(Remark::new(Severity::Warning, what).of_channel(prefix));
        }
    }
    set.remarks.extend(remarks);
}

fn check_roles(set: &mut RecordingSet) {
    for (role, what) in [
        (super::Role::Fit, "no run has the role fit: nothing may be fitted"),
        (
            super::Role::Holdout,
            "no run has the role holdout: a model fitted here is judged only by what it was fitted to",
        ),
    ] {
        if set.runs_of(role).next().is_none() {
            set.remarks.push(Remark::new(Severity::Warning, what));
        }
    }
}
