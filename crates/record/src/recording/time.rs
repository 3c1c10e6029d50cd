//! The time base of a run: rows in order of time, and one value per instant.

use super::table::Table;
use crate::RecordError;
use std::ops::Range;

/// Rows in order of time.
#[derive(Clone, Debug)]
pub(super) struct Timeline {
    /// Row and its time, s, not decreasing; equal times in the order of the file.
    pub(super) rows: Vec<(usize, f64)>,
    /// Rows that stood before an earlier one.
    pub(super) swapped: usize,
    /// Rows that repeat the time of the one before.
    pub(super) repeated: usize,
}

/// Share of rows that may be out of order before the file is taken for several runs.
const SWAPPED: f64 = 0.01;
/// How far back, in median steps, a row may stand out of order.
const BACK: f64 = 50.0;

/// Orders rows by time; a few rows out of order are sorted, time that starts again is an error.
pub(super) fn order(table: &Table, times: &[f64], rows: Range<usize>, way_out: &str) -> Result<Timeline, RecordError> {
    let mut ordered: Vec<(usize, f64)> = Vec::with_capacity(rows.len());
    for row in rows {
        if !times[row].is_finite() {
            return Err(table.at(row, "the row has no time; mend or delete it".to_owned()));
        }
        ordered.push((row, times[row]));
    }
    let mut steps: Vec<f64> = ordered.windows(2).map(|w| (w[1].1 - w[0].1).abs()).collect();
    let middle = steps.len() / 2;
    let median = if steps.is_empty() { 0.0 } else { *steps.select_nth_unstable_by(middle, f64::total_cmp).1 };
    let back: Vec<usize> = (1..ordered.len()).filter(|i| ordered[*i].1 < ordered[*i - 1].1).collect();
    let allowed = (SWAPPED * ordered.len() as f64).max(1.0);
    let far = back.iter().copied().find(|i| ordered[*i - 1].1 - ordered[*i].1 > BACK * median);
    let first = if back.len() as f64 > allowed { back.first().copied() } else { None };
    if let Some(i) = far.or(first) {
        let ((_, before), (row, t)) = (ordered[i - 1], ordered[i]);
        return Err(table.at(row, format!("time goes back from {before} s to {t} s; {way_out}")));
    }
    ordered.sort_by(|a, b| a.1.total_cmp(&b.1));
    let repeated = ordered.windows(2).filter(|w| w[0].1 == w[1].1).count();
    Ok(Timeline { rows: ordered, swapped: back.len(), repeated })
}

/// How values of one instant become one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Merge {
    /// What was measured is averaged.
    Mean,
    /// What was commanded holds as last said.
    Last,
}

/// The instants at which a column was sampled, and its values there; how many samples were merged into others.
pub(super) fn samples(timeline: &Timeline, values: &[f64], merge: Merge) -> (Vec<f64>, Vec<f64>, usize) {
    let (mut times, mut out): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let (mut here, mut merged) = (0.0, 0);
    for (row, t) in timeline.rows.iter().filter(|(row, _)| values[*row].is_finite()) {
        match (times.last() == Some(t), out.last_mut(), merge) {
            (true, Some(last), Merge::Mean) => {
                here += 1.0;
                *last += (values[*row] - *last) / here;
                merged += 1;
            }
            (true, Some(last), Merge::Last) => {
                *last = values[*row];
                merged += 1;
            }
            _ => {
                here = 1.0;
                times.push(*t);
                out.push(values[*row]);
            }
        }
    }
    (times, out, merged)
}
