//! Dispersed inputs: as drawn, and what the built model says. Both are shown so that nobody has to believe that a draw
//! arrived.

use super::metrics::rows_of;
use crate::stats::Moments;
use crate::table::{APPLIED, INPUT, Table};
use serde::Serialize;

/// An input.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct InputSummary {
    /// Its name.
    pub name: String,
    /// Path of the number in the scenario; empty where the header does not say it.
    pub path: String,
    /// Its distribution in words; empty likewise.
    pub distribution: String,
    /// Runs that drew it.
    pub count: usize,
    /// Smallest draw.
    pub min: f64,
    /// Largest draw.
    pub max: f64,
    /// Mean of the draws.
    pub mean: f64,
    /// Standard deviation of the draws; absent of a single one.
    pub std: Option<f64>,
    /// Runs in which the value was read back from the built model.
    pub applied_count: usize,
    /// Largest |applied − drawn|; absent where nothing was read back.
    pub largest_deviation: Option<f64>,
    /// The run of it.
    pub deviation_run: Option<u32>,
}

pub(super) fn summaries(table: &Table) -> Vec<InputSummary> {
    table.input_names().into_iter().filter_map(|name| summary(table, name)).collect()
}

fn summary(table: &Table, name: String) -> Option<InputSummary> {
    let drawn = table.numbers(&format!("{INPUT}{name}"))?;
    let applied = table.numbers(&format!("{APPLIED}{name}")).unwrap_or_default();
    let values: Vec<f64> = drawn.iter().flatten().copied().collect();
    let moments = Moments::of(&values)?;
    let both = rows_of(&drawn)
        .into_iter()
        .filter_map(|(row, x)| Some((row, (applied.get(row).copied().flatten()? - x).abs())));
    let deviations: Vec<(usize, f64)> = both.collect();
    let largest = deviations.iter().copied().reduce(|a, b| if b.1 > a.1 { b } else { a });
    let known = table.header.inputs.iter().find(|input| input.name == name);
    Some(InputSummary {
        path: known.map(|input| input.path.clone()).unwrap_or_default(),
        distribution: known.map(|input| input.distribution.clone()).unwrap_or_default(),
        name,
        count: moments.count,
        min: values.iter().copied().fold(f64::INFINITY, f64::min),
        max: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        mean: moments.mean,
        std: moments.std,
        applied_count: deviations.len(),
        largest_deviation: largest.map(|l| l.1),
        deviation_run: largest.map(|l| table.run(l.0)),
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::findings::tests::table;

    #[test]
    fn the_largest_deviation_and_its_run_are_found() {
        let inputs = summaries(&table(11, |_| true));
        assert_eq!((inputs[0].name.as_str(), inputs[0].min, inputs[0].max, inputs[0].mean), ("a_deg", 0.0, 10.0, 5.0));
        assert_eq!((inputs[0].applied_count, inputs[0].deviation_run), (11, Some(3)));
        assert!((inputs[0].largest_deviation.unwrap() - 1e-9).abs() < 1e-15);
        assert_eq!((inputs[1].applied_count, inputs[1].largest_deviation), (0, None));
    }
}
