//! The capture envelope: success in bins over two inputs.
//!
//! Bins are equally wide between the smallest and the largest draw, about eight runs to a cell on average, or one to
//! each value of an input that takes few again and again (a grid). A cell without a run says nothing, and is not drawn.

use super::{Options, Sensitivity};
use crate::table::{INPUT, Table};
use serde::Serialize;

/// Runs of a cell on average, and the fewest and the most bins of a side.
const PER_CELL: f64 = 8.0;
const BINS: (usize, usize) = (2, 10);
/// Most values of a grid, and how often each is taken on average at least.
const GRID: usize = 24;
const AGAIN: usize = 2;

/// Success over two inputs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Envelope {
    /// The input across.
    pub across: String,
    /// The input up.
    pub up: String,
    /// Ends of the bins across, one more than bins.
    pub across_edges: Vec<f64>,
    /// Ends of the bins up, one more than bins.
    pub up_edges: Vec<f64>,
    /// Values across, where each has a bin of its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub across_values: Option<Vec<f64>>,
    /// Values up, where each has a bin of its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub up_values: Option<Vec<f64>>,
    /// Rows of cells, from the lowest up; a row runs across.
    pub cells: Vec<Vec<Cell>>,
}

/// Runs of a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Cell {
    /// All of them.
    pub runs: usize,
    /// Those that succeeded.
    pub successes: usize,
}

impl Cell {
    /// Share of successes; none without a run.
    pub fn rate(&self) -> Option<f64> {
        (self.runs > 0).then(|| self.successes as f64 / self.runs as f64)
    }
}

pub(super) fn map(table: &Table, options: &Options, sensitivity: &Sensitivity) -> Option<Envelope> {
    let successes = table.successes()?;
    let (across, up) = chosen(table, options).or_else(|| strongest(sensitivity))?;
    let numbers = |name: &str| table.numbers(&format!("{INPUT}{name}"));
    let (x, y) = (numbers(&across)?, numbers(&up)?);
    let points: Vec<(f64, f64, bool)> =
        x.iter().zip(&y).zip(successes).filter_map(|((x, y), s)| Some(((*x)?, (*y)?, s))).collect();
    let side = ((points.len() as f64 / PER_CELL).sqrt().round() as usize).clamp(BINS.0, BINS.1);
    let (across_edges, across_values) = edges(points.iter().map(|p| p.0).collect(), side)?;
    let (up_edges, up_values) = edges(points.iter().map(|p| p.1).collect(), side)?;
    let mut cells = vec![vec![Cell::default(); across_edges.len() - 1]; up_edges.len() - 1];
    for (x, y, is_success) in points {
        let cell = &mut cells[bin(&up_edges, y)][bin(&across_edges, x)];
        cell.runs += 1;
        cell.successes += usize::from(is_success);
    }
    Some(Envelope { across, up, across_edges, up_edges, across_values, up_values, cells })
}

/// The pair that was asked for, where both are inputs.
fn chosen(table: &Table, options: &Options) -> Option<(String, String)> {
    let names = table.input_names();
    options.envelope.clone().filter(|(a, b)| a != b && names.contains(a) && names.contains(b))
}

fn strongest(sensitivity: &Sensitivity) -> Option<(String, String)> {
    let mut varying = sensitivity.ranking.iter().map(|driver| driver.input.clone());
    Some((varying.next()?, varying.next()?))
}

/// Ends of the bins, and the values where each has its own; none where they do not vary.
fn edges(mut values: Vec<f64>, bins: usize) -> Option<(Vec<f64>, Option<Vec<f64>>)> {
    values.sort_by(f64::total_cmp);
    let (low, high) = (*values.first()?, *values.last()?);
    if high <= low {
        return None;
    }
    let count = values.len();
    values.dedup();
    if values.len() <= bins || values.len() <= GRID && AGAIN * values.len() <= count {
        // Half-way between values; as far beyond the first and the last.
        let between: Vec<f64> = values.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
        let (first, last) = (between.first()?, between.last()?);
        let ends = (2.0 * low - first, 2.0 * high - last);
        let all = [ends.0].into_iter().chain(between.iter().copied()).chain([ends.1]).collect();
        return Some((all, Some(values)));
    }
    Some(((0..=bins).map(|k| low + (high - low) * k as f64 / bins as f64).collect(), None))
}

fn bin(edges: &[f64], value: f64) -> usize {
    edges.partition_point(|edge| *edge <= value).saturating_sub(1).min(edges.len() - 2)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::findings::tests::table;

    #[test]
    fn every_run_is_in_one_cell() {
        let table = table(400, |i| i < 200);
        let options = Options { envelope: Some(("b_m".into(), "a_deg".into())), ..Options::default() };
        let sensitivity = Sensitivity::of(&table, "");
        let map = map(&table, &options, &sensitivity).unwrap();
        assert_eq!((map.across.as_str(), map.up.as_str(), map.cells.len()), ("b_m", "a_deg", 7));
        let total: usize = map.cells.iter().flatten().map(|c| c.runs).sum();
        assert_eq!(total, 400);
        assert!(map.cells[0].iter().all(|c| c.rate().is_none_or(|r| r == 1.0)));
        assert!(map.cells[6].iter().all(|c| c.rate().is_none_or(|r| r == 0.0)));
    }

    #[test]
    fn few_values_have_a_bin_each() {
        assert_eq!(edges(vec![1.0, 3.0, 1.0, 2.0], 8), Some((vec![0.5, 1.5, 2.5, 3.5], Some(vec![1.0, 2.0, 3.0]))));
        // A grid keeps its values; as many draws of a continuous number do not make one.
        let grid: Vec<f64> = (0..100).map(|i| 2f64.powi(i % 10)).collect();
        assert_eq!(edges(grid, 4).and_then(|e| e.1).map(|v| v.len()), Some(10));
        let draws: Vec<f64> = (0..20).map(|i| f64::from(i).sqrt()).collect();
        assert_eq!(edges(draws, 2).map(|e| (e.0.len(), e.1)), Some((3, None)));
        assert_eq!(edges(vec![1.0, 1.0], 8), None);
        assert_eq!((bin(&[0.0, 1.0, 2.0], 0.0), bin(&[0.0, 1.0, 2.0], 1.0), bin(&[0.0, 1.0, 2.0], 2.0)), (0, 1, 1));
    }
}
