//! Which rows make which run: a whole file, spans of its time, or its stretches of equal value in the group column.

use super::manifest::{Manifest, RunEntry};
use super::spelling::listed;
use super::table::Table;
use super::{Remark, Severity};
use crate::RecordError;
use std::ops::Range;

/// Rows of one run.
#[derive(Clone, Debug)]
pub(super) struct Stretch {
    /// Name of the run.
    pub(super) name: String,
    /// Value of the group column; empty without one.
    pub(super) value: String,
    /// Rows of the table.
    pub(super) rows: Range<usize>,
}

/// Stretches of a file, in order. A value that comes again later starts a run of its own.
pub(super) fn stretches(table: &Table, entry: &RunEntry, group: Option<&str>) -> Vec<Stretch> {
    let Some(group) = group else {
        let (name, rows) = (entry.file.clone(), 0..table.places.len());
        return vec![Stretch { name, value: String::new(), rows }];
    };
    let mut all: Vec<Stretch> = Vec::new();
    for (row, label) in table.labels.iter().enumerate() {
        match all.last_mut() {
            Some(last) if last.value == *label => last.rows.end = row + 1,
            _ => {
                let before = all.iter().filter(|s| s.value == *label).count();
                let again = if before > 0 { format!("({})", before + 1) } else { String::new() };
                let name = format!("{}#{group}={label}{again}", entry.file);
                all.push(Stretch { name, value: label.clone(), rows: row..row + 1 });
            }
        }
    }
    all
}

/// The rows of a stretch within the span of time that an entry asks for.
fn cut(
    manifest: &Manifest,
    entry: &RunEntry,
    stretch: &Stretch,
    (times, is_alone): (&[f64], bool),
) -> Result<Stretch, RecordError> {
    let Some([from, to]) = entry.span else { return Ok(stretch.clone()) };
    let is_in = |t: &f64| (from..to).contains(t);
    let own = &times[stretch.rows.clone()];
    let (first, last) = (own.iter().position(is_in), own.iter().rposition(is_in));
    let Some((first, last)) = first.zip(last) else {
        let ends = own.first().zip(own.last()).map(|(a, b)| format!("; it goes from {a} to {b} s"));
        let problem = format!("[[run]] of {}: no row from {from} to {to} s{}", stretch.name, ends.unwrap_or_default());
        return Err(RecordError::table(&manifest.path, problem));
    };
    let [from, to] = [own[first], own[last]];
    let name = if is_alone { stretch.name.clone() } else { format!("{}#{from}-{to}s", stretch.name) };
    let begin = stretch.rows.start;
    Ok(Stretch { name, value: stretch.value.clone(), rows: begin + first..begin + last + 1 })
}

/// Rows of a run, and the number of its entry among those of its file.
pub(super) type Chosen = (Stretch, usize);

/// The runs of one file, each with its entry: stretches, or what their entries cut out of them.
pub(super) fn choose(
    manifest: &Manifest,
    entries: &[&RunEntry],
    (all, times): (&[Stretch], &[f64]),
) -> Result<(Vec<Chosen>, Option<Remark>), RecordError> {
    let mut chosen: Vec<(usize, usize)> = Vec::new();
    for (e, entry) in entries.iter().enumerate() {
        let own = (0..all.len()).filter(|s| belongs(entry, &all[*s].value));
        let before = chosen.len();
        for s in own {
            if chosen.iter().any(|(of, other)| *of == s && overlap(entries[*other], entry)) {
                let problem = format!("two [[run]] claim {}; give each its own groups = [\"0-99\", …]", all[s].name);
                return Err(RecordError::table(&manifest.path, problem));
            }
            chosen.push((s, e));
        }
        if chosen.len() == before {
            let values = listed(all.iter().map(|s| s.value.as_str()));
            let problem =
                format!("[[run]] of {} chooses groups that the file does not have; it has {values}", entry.file);
            return Err(RecordError::table(&manifest.path, problem));
        }
    }
    chosen.sort_by_key(|(s, _)| *s);
    let is_chosen = |s: usize| chosen.iter().any(|(of, _)| *of == s);
    let left: Vec<&str> = (0..all.len()).filter(|s| !is_chosen(*s)).map(|s| &*all[s].value).collect();
    let what =
        || format!("{} groups that no [[run]] chooses are not read: {}", left.len(), listed(left.iter().copied()));
    let remark = (!left.is_empty()).then(|| Remark::new(Severity::Note, what()));
    let is_alone = |s: usize| manifest.group.is_some() && chosen.iter().filter(|(of, _)| *of == s).count() == 1;
    let run = |(s, e): &(usize, usize)| Ok((cut(manifest, entries[*e], &all[*s], (times, is_alone(*s)))?, *e));
    Ok((chosen.iter().map(run).collect::<Result<_, RecordError>>()?, remark))
}

/// Whether two entries ask for a moment that is in both.
pub(super) fn overlap(a: &RunEntry, b: &RunEntry) -> bool {
    let whole = [f64::NEG_INFINITY, f64::INFINITY];
    let ([a_from, a_to], [b_from, b_to]) = (a.span.unwrap_or(whole), b.span.unwrap_or(whole));
    a_from < b_to && b_from < a_to
}

fn belongs(entry: &RunEntry, value: &str) -> bool {
    let Some(groups) = &entry.groups else { return true };
    groups.iter().any(|group| group == value || in_range(group, value) || equal_numbers(group, value))
}

/// `"0-99"` holds every number from 0 to 99.
fn in_range(range: &str, value: &str) -> bool {
    let number = |text: &str| text.trim().parse::<f64>().ok();
    let bounds = range.split_once('-').and_then(|(low, high)| Some((number(low)?, number(high)?)));
    matches!((bounds, number(value)), (Some((low, high)), Some(v)) if low <= v && v <= high)
}

fn equal_numbers(a: &str, b: &str) -> bool {
    matches!((a.trim().parse::<f64>(), b.trim().parse::<f64>()), (Ok(a), Ok(b)) if a == b)
}
