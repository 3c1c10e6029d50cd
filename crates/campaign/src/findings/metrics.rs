//! Figures of every metric, and runs worth a look.

use crate::stats::{Moments, Rate, quantile, sorted};
use crate::table::{Cells, Column, Table, WORK};
use serde::Serialize;

/// Runs listed with the largest values, and failures listed.
const LISTED: (usize, usize) = (3, 5);

/// Figures of a metric that is a number.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MetricSummary {
    /// Its name.
    pub name: String,
    /// Runs that have it; all figures are of these.
    pub count: usize,
    /// Mean.
    pub mean: f64,
    /// Standard deviation; absent of a single run.
    pub std: Option<f64>,
    /// Smallest.
    pub min: f64,
    /// 5 % quantile.
    pub p05: f64,
    /// Median.
    pub p50: f64,
    /// 95 % quantile.
    pub p95: f64,
    /// 99 % quantile.
    pub p99: f64,
    /// Largest.
    pub max: f64,
    /// Run of the smallest, the first where several are.
    pub min_run: u32,
    /// Run of the largest, the first where several are.
    pub max_run: u32,
}

impl MetricSummary {
    /// Whether the values differ.
    pub fn varies(&self) -> bool {
        self.max > self.min
    }
}

/// How often a metric that is a flag is true.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FlagSummary {
    /// Its name.
    pub name: String,
    /// True ones of the runs that have it.
    pub rate: Rate,
}

/// Runs worth a look.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Notable {
    /// The metric by which `worst` and `median` were chosen; absent where none varies.
    pub metric: Option<String>,
    /// Runs of its largest values, the largest first.
    pub worst: Vec<NotableRun>,
    /// The run nearest to its median.
    pub median: Option<NotableRun>,
    /// The first runs that failed.
    pub first_failures: Vec<NotableRun>,
}

/// A run worth a look.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NotableRun {
    /// Index of the run.
    pub run: u32,
    /// Its value of the metric.
    pub value: Option<f64>,
    /// Its outcome.
    pub outcome: String,
    /// Why.
    pub reason: String,
}

/// Metrics that are numbers and have one.
pub(super) fn numbers(table: &Table) -> Vec<MetricSummary> {
    table.metrics().filter_map(|column| summary(table, column, &column.name)).collect()
}

/// Work counters.
pub(super) fn work(table: &Table) -> Vec<MetricSummary> {
    let counters = table.columns.iter().filter_map(|column| Some((column, column.name.strip_prefix(WORK)?)));
    counters.filter_map(|(column, name)| summary(table, column, name)).collect()
}

/// Metrics that are flags and have one.
pub(super) fn flags(table: &Table) -> Vec<FlagSummary> {
    let rate = |column: &Column| match &column.cells {
        Cells::Flags(cells) => Rate::of_flags(cells.iter().flatten().copied()),
        _ => None,
    };
    table.metrics().filter_map(|c| Some(FlagSummary { name: c.name.clone(), rate: rate(c)? })).collect()
}

/// Values of a column with their rows.
pub(super) fn rows_of(cells: &[Option<f64>]) -> Vec<(usize, f64)> {
    cells.iter().enumerate().filter_map(|(row, cell)| Some((row, (*cell)?))).collect()
}

fn summary(table: &Table, column: &Column, name: &str) -> Option<MetricSummary> {
    let rows = rows_of(&column.cells.numbers()?);
    let values: Vec<f64> = rows.iter().map(|row| row.1).collect();
    let moments = Moments::of(&values)?;
    // The first of equal ones, whichever way they are compared.
    let min = rows.iter().copied().reduce(|a, b| if b.1 < a.1 { b } else { a })?;
    let max = rows.iter().copied().reduce(|a, b| if b.1 > a.1 { b } else { a })?;
    let values = sorted(values);
    Some(MetricSummary {
        name: name.to_owned(),
        count: moments.count,
        mean: moments.mean,
        std: moments.std,
        min: min.1,
        p05: quantile(&values, 0.05)?,
        p50: quantile(&values, 0.5)?,
        p95: quantile(&values, 0.95)?,
        p99: quantile(&values, 0.99)?,
        max: max.1,
        min_run: table.run(min.0),
        max_run: table.run(max.0),
    })
}

/// Runs worth a look, by a metric; its name is empty where none varies.
pub(super) fn notable(table: &Table, metric: &str) -> Notable {
    let cells = table.numbers(metric).unwrap_or_default();
    let run = |row: usize| NotableRun {
        run: table.run(row),
        value: cells.get(row).copied().flatten(),
        outcome: table.text("outcome", row).to_owned(),
        reason: table.text("reason", row).to_owned(),
    };
    let mut rows = rows_of(&cells);
    rows.sort_by(|a, b| b.1.total_cmp(&a.1));
    let median = rows.get(rows.len() / 2).map(|(row, _)| run(*row));
    let failed: Vec<usize> = match table.successes() {
        Some(flags) => (0..flags.len()).filter(|row| !flags[*row]).collect(),
        None => (0..table.len()).filter(|row| table.text("outcome", *row) == "diverged").collect(),
    };
    Notable {
        metric: (!metric.is_empty()).then(|| metric.to_owned()),
        worst: rows.iter().take(LISTED.0).map(|(row, _)| run(*row)).collect(),
        median,
        first_failures: failed.into_iter().take(LISTED.1).map(run).collect(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::findings::tests::table;

    #[test]
    fn figures_of_a_ramp() {
        let numbers = numbers(&table(101, |_| true));
        let force = &numbers[0];
        assert_eq!(
            (force.name.as_str(), force.count, force.min_run, force.max_run),
            ("peak_contact_force_n", 101, 0, 100)
        );
        assert_eq!(
            (force.min, force.p05, force.p50, force.p95, force.p99, force.max),
            (10.0, 15.0, 60.0, 105.0, 109.0, 110.0)
        );
        // 101 consecutive integers: variance (n² + n) / 12 with n − 1.
        assert!((force.std.unwrap().powi(2) - 101.0 * 102.0 / 12.0).abs() < 1e-9 && (force.mean - 60.0).abs() < 1e-12);
        assert!(!numbers[1].varies() && numbers[1].min_run == 0, "a constant stays, an empty column goes");
        assert_eq!(numbers.len(), 2);
    }

    #[test]
    fn the_worst_come_first_and_failures_in_their_order() {
        let notable = notable(&table(50, |i| i % 10 != 9), "peak_contact_force_n");
        let runs = |list: &[NotableRun]| list.iter().map(|r| r.run).collect::<Vec<_>>();
        assert_eq!(runs(&notable.worst), [49, 48, 47]);
        assert_eq!(runs(&notable.first_failures), [9, 19, 29, 39, 49]);
        assert_eq!(notable.median.unwrap().run, 24);
    }
}
