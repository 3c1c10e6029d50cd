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

/// The spans of time that the entries of one file ask for, an entry each.
pub(super) fn spans(
    manifest: &Manifest,
    entries: &[&RunEntry],
    (table, times): (&Table, &[f64]),
) -> Result<Vec<Stretch>, RecordError> {
    let one = |entry: &&RunEntry| {
        let Some([from, to]) = entry.span else {
            return Ok(Stretch { name: entry.file.clone(), value: String::new(), rows: 0..table.places.len() });
        };
        let is_in = |t: &f64| (from..to).contains(t);
        let (first, last) = (times.iter().position(is_in), times.iter().rposition(is_in));
        let Some((first, last)) = first.zip(last) else {
            let ends = times.first().zip(times.last()).map(|(a, b)| format!("; it goes from {a} to {b} s"));
            let problem =
                format!("[[run]] of {}: no row from {from} to {to} s{}", entry.file, ends.unwrap_or_default());
            return Err(RecordError::table(&manifest.path, problem));
        };
        let [from, to] = [times[first], times[last]];
        Ok(Stretch { name: format!("{}#{from}-{to}s", entry.file), value: String::new(), rows: first..last + 1 })
    };
    entries.iter().map(one).collect()
}

/// Which stretches of one file belong to which of its entries.
pub(super) fn choose(
    manifest: &Manifest,
    entries: &[&RunEntry],
    all: &[Stretch],
) -> Result<(Vec<usize>, Option<Remark>), RecordError> {
    let mut owner = vec![usize::MAX; all.len()];
    for (e, entry) in entries.iter().enumerate() {
        let mut found = 0;
        for (stretch, owner) in all.iter().zip(&mut owner).filter(|(s, _)| belongs(entry, &s.value)) {
            if *owner != usize::MAX {
                let problem = format!("two [[run]] claim {}; give each its own groups = [\"0-99\", …]", stretch.name);
                return Err(RecordError::table(&manifest.path, problem));
            }
            *owner = e;
            found += 1;
        }
        if found == 0 {
            let values = listed(all.iter().map(|s| s.value.as_str()));
            let problem =
                format!("[[run]] of {} chooses groups that the file does not have; it has {values}", entry.file);
            return Err(RecordError::table(&manifest.path, problem));
        }
    }
    let left: Vec<&str> = all.iter().zip(&owner).filter(|(_, o)| **o == usize::MAX).map(|(s, _)| &*s.value).collect();
    let what =
        || format!("{} groups that no [[run]] chooses are not read: {}", left.len(), listed(left.iter().copied()));
    Ok((owner, (!left.is_empty()).then(|| Remark::new(Severity::Note, what()))))
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
