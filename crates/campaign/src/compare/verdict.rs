//! Which is better on success, by how much, how sure; or that the data cannot tell, and how many runs it would take.

use super::{Comparison, LEVEL, Pair, PairedMetric, PairedSuccess};
use crate::stats::Interval;
use crate::table::{Cells, Table};
use record::page::number::{digits, grouped, p_words, rate, short};
use record::page::unit::unit;

/// The sentence.
pub(super) fn sentence(comparison: &Comparison) -> String {
    match &comparison.success {
        Some(success) if success.p < LEVEL => better(comparison, success),
        Some(success) if success.table.only_a + success.table.only_b == 0 => same(comparison, success),
        Some(success) => cannot_tell(comparison, success),
        None => of_metrics(comparison),
    }
}

fn better(comparison: &Comparison, success: &PairedSuccess) -> String {
    let is_b = success.difference > 0.0;
    let (winner, loser) =
        if is_b { (&comparison.name_b, &comparison.name_a) } else { (&comparison.name_a, &comparison.name_b) };
    let (won, lost) = if is_b { (&success.rate_b, &success.rate_a) } else { (&success.rate_a, &success.rate_b) };
    let Interval { low, high } = success.interval;
    let (low, high) = if is_b { (low, high) } else { (-high, -low) };
    format!(
        "{winner} is better than {loser}: {} in {} of the same {} runs against {}, {} points more (95 % interval {} … \
         {}, exact McNemar {}).",
        flag(success),
        rate(won.value),
        grouped(comparison.pairs as u64),
        rate(lost.value),
        points(success.difference.abs()),
        points(low),
        points(high),
        p_words(success.p)
    )
}

fn same(comparison: &Comparison, success: &PairedSuccess) -> String {
    format!(
        "{} and {} agree on success in every one of the {} common runs ({} in {}); whatever difference remains is \
         below {} points with 95 %.",
        comparison.name_a,
        comparison.name_b,
        grouped(comparison.pairs as u64),
        flag(success),
        rate(success.rate_a.value),
        points(success.interval.high.max(-success.interval.low))
    )
}

fn cannot_tell(comparison: &Comparison, success: &PairedSuccess) -> String {
    let needed = match success.runs_needed {
        Some(runs) => {
            let runs = grouped(rounded(runs.max(comparison.pairs as u64 + 1)));
            format!("about {runs} runs would be needed to be sure of a difference as small as that")
        }
        None => "with equal rates no number of runs would show a difference".to_owned(),
    };
    format!(
        "The {} common runs cannot tell which is better: {} in {} with {} and in {} with {}, {} points apart (95 % \
         interval of B − A {} … {}, exact \
         McNemar {}); {needed}.",
        grouped(comparison.pairs as u64),
        flag(success),
        rate(success.rate_a.value),
        comparison.name_a,
        rate(success.rate_b.value),
        comparison.name_b,
        points(success.difference.abs()),
        points(success.interval.low),
        points(success.interval.high),
        p_words(success.p)
    )
}

fn of_metrics(comparison: &Comparison) -> String {
    let clear = clear(comparison);
    let Some(first) = clear.first() else {
        return format!(
            "Success cannot be compared, and none of the {} common metrics differs clearly in {} common runs.",
            comparison.metrics.len(),
            grouped(comparison.pairs as u64)
        );
    };
    format!(
        "Success cannot be compared; {} of {} common metrics differ clearly in {} common runs, most of all {}.",
        clear.len(),
        comparison.metrics.len(),
        grouped(comparison.pairs as u64),
        metric_words(first, &comparison.name_b)
    )
}

/// Parts of the names of metrics that account for round-off: they differ clearly and mean nothing.
const ROUND_OFF: [&str; 2] = ["momentum_drift", "integrator_energy"];

/// Metrics that differ clearly, the largest standardised difference first.
pub(super) fn clear(comparison: &Comparison) -> Vec<&PairedMetric> {
    let tells = |metric: &&PairedMetric| metric.is_clear && !ROUND_OFF.iter().any(|part| metric.name.contains(part));
    let mut clear: Vec<&PairedMetric> = comparison.metrics.iter().filter(tells).collect();
    let size = |metric: &PairedMetric| metric.standardised.map_or(0.0, f64::abs);
    clear.sort_by(|a, b| size(b).total_cmp(&size(a)));
    clear
}

/// `peak_contact_force_n is 12 N smaller with B (95 % interval 10 … 14 N)`.
pub(super) fn metric_words(metric: &PairedMetric, name_b: &str) -> String {
    let unit = unit(&metric.name).map_or_else(String::new, |unit| format!(" {unit}"));
    let sign = if metric.mean_difference < 0.0 { -1.0 } else { 1.0 };
    let word = if sign < 0.0 { "smaller" } else { "larger" };
    let interval = metric.interval.map_or_else(String::new, |i| {
        let (low, high) = if sign < 0.0 { (-i.high, -i.low) } else { (i.low, i.high) };
        format!(" (95 % interval {} … {}{unit})", digits(low, 3), digits(high, 3))
    });
    format!("{} is {}{unit} {word} with {name_b}{interval}", metric.name, digits(metric.mean_difference.abs(), 3))
}

fn flag(success: &PairedSuccess) -> String {
    success.flag_a.replace('_', " ")
}

/// A difference of rates in points of per cent, one decimal, two below a tenth.
pub(super) fn points(difference: f64) -> String {
    let points = 100.0 * difference;
    let places = if points.abs() < 0.1 && points != 0.0 { 2 } else { 1 };
    format!("{points:.places$}").replace('-', "−")
}

/// Two digits, upwards.
fn rounded(runs: u64) -> u64 {
    let unit = 10_u64.pow(runs.max(1).ilog10().saturating_sub(1));
    runs.div_ceil(unit) * unit
}

/// What a reader should know beside.
pub(super) fn remarks(comparison: &Comparison, a: &Table, b: &Table, pairs: &[Pair]) -> Vec<String> {
    let (name_a, name_b) = (&comparison.name_a, &comparison.name_b);
    let mut remarks = Vec::new();
    let only = [(comparison.only_in_a, name_a), (comparison.only_in_b, name_b)];
    for (count, name) in only.into_iter().filter(|only| only.0 > 0) {
        let runs = if count == 1 { "run is".to_owned() } else { format!("{} runs are", grouped(count as u64)) };
        let runs = if count == 1 { format!("1 {runs}") } else { runs };
        remarks.push(format!("{runs} in {name} only and left out of the comparison."));
    }
    if comparison.common_inputs.is_empty() {
        remarks.push("The campaigns have no input in common: their runs are paired by index alone.".to_owned());
    }
    let inputs = [(&comparison.inputs_only_in_a, name_a), (&comparison.inputs_only_in_b, name_b)];
    for (names, name) in inputs.into_iter().filter(|(names, _)| !names.is_empty()) {
        remarks.push(format!("Dispersed in {name} only: {}.", names.join(", ")));
    }
    if comparison.success.is_none() {
        remarks.push("One of the campaigns has no flag of success.".to_owned());
    } else if a.header.success != b.header.success {
        let (flag_a, flag_b) = (&a.header.success, &b.header.success);
        remarks.push(format!("Success is “{flag_a}” in {name_a} and “{flag_b}” in {name_b}."));
    }
    if seeds_differ(a, b, pairs) {
        remarks.push("Seeds of common runs differ: noise of sensors and other random parts are not paired.".to_owned());
    }
    remarks
}

fn seeds_differ(a: &Table, b: &Table, pairs: &[Pair]) -> bool {
    let seeds = |table: &Table| match table.column("seed").map(|column| column.cells.clone()) {
        Some(Cells::Integers(seeds)) => seeds,
        _ => Vec::new(),
    };
    let (of_a, of_b) = (seeds(a), seeds(b));
    let at = |seeds: &[Option<i64>], row: usize| seeds.get(row).copied().flatten();
    let differs = |pair: &Pair| at(&of_a, pair.row_a).zip(at(&of_b, pair.row_b)).is_some_and(|(x, y)| x != y);
    pairs.iter().any(differs)
}

/// A number with its unit.
pub(super) fn with_unit(value: f64, name: &str) -> String {
    unit(name).map_or_else(|| short(value), |unit| format!("{} {unit}", short(value)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_and_runs_are_round() {
        assert_eq!([points(0.032), points(-0.0004), points(0.0)], ["3.2", "−0.04", "0.0"]);
        assert_eq!([rounded(7), rounded(41_234), rounded(100)], [7, 42_000, 100]);
    }
}
