//! Two campaigns on the same draws: which design is better, by how much, and how sure that is.
//!
//! Runs are paired by their index, so the spread of the draws cancels: a difference of a pair is what the change of the
//! design does under one and the same condition. That holds only where both runs were given the same numbers, so common
//! inputs must agree to the last bit. All differences are B − A.

mod changes;
mod drawings;
mod metrics;
mod page;
mod text;
mod verdict;

pub use metrics::PairedMetric;
pub use page::comparison_html;
pub use text::{JSON_FORMAT, comparison_json, comparison_markdown};

use crate::stats::{Interval, McNemar, Rate, difference_of_paired_rates, runs_needed};
use crate::table::{INPUT, Table};
use serde::Serialize;
use std::collections::BTreeMap;

/// Level below which a p-value speaks for a difference.
pub const LEVEL: f64 = 0.05;

/// Why two tables cannot be compared.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CompareError {
    /// The same draw is not the same.
    #[error(
        "run {run}: input \"{input}\" is {value_a} in {name_a} and {value_b} in {name_b}, so the runs are no pairs; \
         run both campaigns with the same \
         seed, dispersions and sampling"
    )]
    InputsDiffer {
        /// The first run in which an input differs.
        run: u32,
        /// The input.
        input: String,
        /// First campaign.
        name_a: String,
        /// Its value, all digits; `none` where it has none.
        value_a: String,
        /// Second campaign.
        name_b: String,
        /// Its value likewise.
        value_b: String,
    },
    /// Nothing to pair.
    #[error(
        "{name_a} ({runs_a} runs) and {name_b} ({runs_b} runs) have no run in common; compare campaigns whose runs \
         have the same indices"
    )]
    NoCommonRun {
        /// First campaign.
        name_a: String,
        /// Its runs.
        runs_a: usize,
        /// Second campaign.
        name_b: String,
        /// Its runs.
        runs_b: usize,
    },
    /// A run is there twice.
    #[error("run {run} is there twice in {name}; merge the shards of one campaign only once")]
    RunTwice {
        /// The campaign.
        name: String,
        /// The run.
        run: u32,
    },
}

/// What two tables say together.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// First campaign.
    pub name_a: String,
    /// Second campaign.
    pub name_b: String,
    /// Scenario of the first.
    pub scenario_a: String,
    /// Scenario of the second.
    pub scenario_b: String,
    /// Runs in both; all figures are of these.
    pub pairs: usize,
    /// Runs in the first only.
    pub only_in_a: usize,
    /// Runs in the second only.
    pub only_in_b: usize,
    /// Inputs in both, equal to the last bit in all pairs.
    pub common_inputs: Vec<String>,
    /// Inputs of the first only.
    pub inputs_only_in_a: Vec<String>,
    /// Inputs of the second only.
    pub inputs_only_in_b: Vec<String>,
    /// All of it in one sentence.
    pub verdict: String,
    /// What a reader should know beside.
    pub remarks: Vec<String>,
    /// Success; absent where one of the tables has no flag of it.
    pub success: Option<PairedSuccess>,
    /// Metrics in both, in the order of the first table.
    pub metrics: Vec<PairedMetric>,
    /// Runs in which one succeeds and the other does not.
    pub disagreements: Vec<Disagreement>,
}

/// Success of two designs on the same draws.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PairedSuccess {
    /// Flag of the first.
    pub flag_a: String,
    /// Flag of the second.
    pub flag_b: String,
    /// Rate of the first over the pairs.
    pub rate_a: Rate,
    /// Rate of the second over the pairs.
    pub rate_b: Rate,
    /// Pairs by who succeeds.
    pub table: McNemar,
    /// Rate of B less rate of A.
    pub difference: f64,
    /// Newcombe's 95 % interval of it, method 10.
    pub interval: Interval,
    /// Two-sided exact p-value of McNemar's test.
    pub p: f64,
    /// Pairs that would show a difference like the one seen in four campaigns of five; absent where none was seen.
    pub runs_needed: Option<u64>,
}

/// A run in which one succeeds and the other does not.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Disagreement {
    /// The run.
    pub run: u32,
    /// Name of the campaign that succeeds.
    pub succeeds: String,
    /// Outcome and reason in the first.
    pub outcome_a: String,
    /// Reason in the first.
    pub reason_a: String,
    /// Outcome in the second.
    pub outcome_b: String,
    /// Reason in the second.
    pub reason_b: String,
}

/// A run with its rows in the two tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Pair {
    pub(crate) run: u32,
    pub(crate) row_a: usize,
    pub(crate) row_b: usize,
}

impl Comparison {
    /// Compares two tables.
    ///
    /// # Errors
    ///
    /// Where they have no run in common, where a run is there twice, and where a common input differs in a common run.
    pub fn of(a: &Table, b: &Table, names: (&str, &str)) -> Result<Self, CompareError> {
        let pairs = pairs(a, b, names)?;
        let (inputs_a, inputs_b) = (a.input_names(), b.input_names());
        let common: Vec<String> = inputs_a.iter().filter(|name| inputs_b.contains(name)).cloned().collect();
        check_inputs(a, b, names, &pairs, &common)?;
        let only = |of: &[String]| of.iter().filter(|name| !common.contains(name)).cloned().collect();
        let mut comparison = Self {
            name_a: names.0.to_owned(),
            name_b: names.1.to_owned(),
            scenario_a: a.header.scenario.clone(),
            scenario_b: b.header.scenario.clone(),
            pairs: pairs.len(),
            only_in_a: a.len() - pairs.len(),
            only_in_b: b.len() - pairs.len(),
            inputs_only_in_a: only(&inputs_a),
            inputs_only_in_b: only(&inputs_b),
            common_inputs: common,
            verdict: String::new(),
            remarks: Vec::new(),
            success: success(a, b, &pairs),
            metrics: metrics::all(a, b, &pairs),
            disagreements: disagreements(a, b, names, &pairs),
        };
        comparison.remarks = verdict::remarks(&comparison, a, b, &pairs);
        comparison.verdict = verdict::sentence(&comparison);
        Ok(comparison)
    }
}

/// Runs in both tables, in the order of their indices.
pub(crate) fn pairs(a: &Table, b: &Table, names: (&str, &str)) -> Result<Vec<Pair>, CompareError> {
    let (rows_a, rows_b) = (rows(a, names.0)?, rows(b, names.1)?);
    let pair = |(run, row): (&u32, &usize)| Some(Pair { run: *run, row_a: *row, row_b: *rows_b.get(run)? });
    let pairs: Vec<Pair> = rows_a.iter().filter_map(pair).collect();
    if pairs.is_empty() {
        let (name_a, name_b) = (names.0.to_owned(), names.1.to_owned());
        return Err(CompareError::NoCommonRun { name_a, runs_a: a.len(), name_b, runs_b: b.len() });
    }
    Ok(pairs)
}

fn rows(table: &Table, name: &str) -> Result<BTreeMap<u32, usize>, CompareError> {
    let mut rows = BTreeMap::new();
    for row in 0..table.len() {
        let run = table.run(row);
        if rows.insert(run, row).is_some() {
            return Err(CompareError::RunTwice { name: name.to_owned(), run });
        }
    }
    Ok(rows)
}

/// Fails at the first run and input that is not the same to the last bit.
fn check_inputs(
    a: &Table,
    b: &Table,
    names: (&str, &str),
    pairs: &[Pair],
    inputs: &[String],
) -> Result<(), CompareError> {
    let numbers = |table: &Table, name: &String| table.numbers(&format!("{INPUT}{name}")).unwrap_or_default();
    let columns: Vec<_> = inputs.iter().map(|name| (name, numbers(a, name), numbers(b, name))).collect();
    let at = |cells: &[Option<f64>], row: usize| cells.get(row).copied().flatten();
    for pair in pairs {
        for (input, of_a, of_b) in &columns {
            let (x, y) = (at(of_a, pair.row_a), at(of_b, pair.row_b));
            if x.map(f64::to_bits) != y.map(f64::to_bits) {
                return Err(CompareError::InputsDiffer {
                    run: pair.run,
                    input: (*input).clone(),
                    name_a: names.0.to_owned(),
                    value_a: all_digits(x),
                    name_b: names.1.to_owned(),
                    value_b: all_digits(y),
                });
            }
        }
    }
    Ok(())
}

fn all_digits(value: Option<f64>) -> String {
    value.map_or_else(|| "none".to_owned(), |value| format!("{value:?}"))
}

/// Who succeeds in each pair; none where a table has no flag.
pub(crate) fn who_succeeds(a: &Table, b: &Table, pairs: &[Pair]) -> Option<Vec<(bool, bool)>> {
    let (of_a, of_b) = (a.successes()?, b.successes()?);
    let at = |flags: &[bool], row: usize| flags.get(row).copied().unwrap_or(false);
    Some(pairs.iter().map(|pair| (at(&of_a, pair.row_a), at(&of_b, pair.row_b))).collect())
}

fn success(a: &Table, b: &Table, pairs: &[Pair]) -> Option<PairedSuccess> {
    let who = who_succeeds(a, b, pairs)?;
    let table = McNemar::of(who.iter().copied());
    let (difference, interval) = difference_of_paired_rates(&table)?;
    let apart = (table.only_a + table.only_b) as f64 / table.pairs() as f64;
    Some(PairedSuccess {
        flag_a: a.header.success.clone(),
        flag_b: b.header.success.clone(),
        rate_a: Rate::of_flags(who.iter().map(|pair| pair.0))?,
        rate_b: Rate::of_flags(who.iter().map(|pair| pair.1))?,
        table,
        difference,
        interval,
        p: table.p(),
        runs_needed: runs_needed(difference, apart),
    })
}

fn disagreements(a: &Table, b: &Table, names: (&str, &str), pairs: &[Pair]) -> Vec<Disagreement> {
    let who = who_succeeds(a, b, pairs).unwrap_or_default();
    let one = |(pair, (of_a, _)): (&Pair, (bool, bool))| Disagreement {
        run: pair.run,
        succeeds: if of_a { names.0 } else { names.1 }.to_owned(),
        outcome_a: a.text("outcome", pair.row_a).to_owned(),
        reason_a: a.text("reason", pair.row_a).to_owned(),
        outcome_b: b.text("outcome", pair.row_b).to_owned(),
        reason_b: b.text("reason", pair.row_b).to_owned(),
    };
    pairs.iter().zip(who).filter(|(_, (of_a, of_b))| of_a != of_b).map(one).collect()
}

#[cfg(test)]
mod tests;
