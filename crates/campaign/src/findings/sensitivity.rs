//! What drives what: rank correlation and first-order Sobol' index of every input in success and in every metric that
//! varies.
//!
//! An effect is *clear* where its index is above its noise level, which chance passes with the strongest of all inputs
//! in one campaign of twenty, or where the p-value of its correlation is below 1 % over the number of inputs
//! (Bonferroni), which sees weak monotonic effects that are lost in the index. For one output and inputs without any
//! influence both together show an effect in about six campaigns of a hundred.

use crate::stats::{Noise, Parting, Rate, class_count, kolmogorov_smirnov, ranks, spearman_of_ranks};
use crate::table::{Cells, INPUT, Table};
use serde::Serialize;

/// Two-sided level of a correlation, for all inputs together.
const CORRELATED: f64 = 0.01;

/// What drives what.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Sensitivity {
    /// Inputs that vary, in the order of the table.
    pub inputs: Vec<String>,
    /// Outputs that vary: the flag of success, then metrics in the order of the table.
    pub outputs: Vec<String>,
    /// Every input in every output, output by output.
    pub effects: Vec<Effect>,
    /// The output that the ranking is of: success, or, where that does not vary, the metric of notable runs; absent
    /// where neither does.
    pub ranked_by: Option<String>,
    /// Inputs by their influence on it, the strongest first.
    pub ranking: Vec<Driver>,
}

/// One input in one output.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Effect {
    /// The input.
    pub input: String,
    /// The output.
    pub output: String,
    /// Runs that have both.
    pub runs: usize,
    /// Spearman's ρ.
    pub spearman: Option<f64>,
    /// Its two-sided p-value, for itself.
    pub p: Option<f64>,
    /// First-order Sobol' index, bias taken off: chance scatters it around zero.
    pub first_order: Option<f64>,
    /// What chance alone stays below in 95 % of campaigns, for the largest of all inputs.
    pub noise: Option<f64>,
    /// Classes of the input from which the index was found.
    pub classes: usize,
    /// Whether it is more than chance.
    pub is_clear: bool,
}

impl Effect {
    /// How strong it is, for ranking: the index, then the correlation.
    pub(crate) fn strength(&self) -> (f64, f64) {
        (self.first_order.unwrap_or(f64::MIN), self.spearman.map_or(-1.0, f64::abs))
    }
}

/// An input and what it does to success.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Driver {
    /// The input.
    pub input: String,
    /// First-order Sobol' index.
    pub first_order: Option<f64>,
    /// Its noise level.
    pub noise: Option<f64>,
    /// Spearman's ρ.
    pub spearman: Option<f64>,
    /// Its p-value.
    pub p: Option<f64>,
    /// Kolmogorov–Smirnov distance between its values in runs that succeed and in runs that fail.
    pub ks: Option<f64>,
    /// Its p-value.
    pub ks_p: Option<f64>,
    /// Whether its influence is more than chance.
    pub is_clear: bool,
    /// Success in each fifth of its values; empty without a flag of success.
    pub by_fifth: Vec<Fifth>,
}

/// Success in a fifth of an input's values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Fifth {
    /// Smallest value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
    /// Rate of success.
    pub rate: Rate,
}

/// An input over some of the runs.
struct Prepared {
    ranks: Vec<f64>,
    parting: Option<Parting>,
}

/// Inputs over the runs that have a value of some output.
struct Subset {
    rows: Vec<usize>,
    inputs: Vec<Prepared>,
}

impl Sensitivity {
    /// Of a table; `metric` is ranked by where success does not vary.
    pub(crate) fn of(table: &Table, metric: &str) -> Self {
        let inputs = inputs(table);
        let outputs = outputs(table);
        let mut subsets: Vec<Subset> = Vec::new();
        let mut effects = Vec::new();
        for (output, cells) in &outputs {
            effects.extend(effects_on(output, cells, &inputs, &mut subsets));
        }
        let is_output = |name: &str| outputs.iter().any(|(output, _)| output == name);
        let ranked_by =
            [table.header.success.as_str(), metric].into_iter().find(|name| is_output(name)).map(str::to_owned);
        let ranking = ranking(table, &inputs, &effects, ranked_by.as_deref());
        Self {
            inputs: inputs.into_iter().map(|(name, _)| name).collect(),
            outputs: outputs.into_iter().map(|(name, _)| name).collect(),
            effects,
            ranked_by,
            ranking,
        }
    }

    /// An effect by its names.
    pub fn effect(&self, input: &str, output: &str) -> Option<&Effect> {
        self.effects.iter().find(|effect| effect.input == input && effect.output == output)
    }
}

type Named = (String, Vec<Option<f64>>);

/// Inputs that vary.
fn inputs(table: &Table) -> Vec<Named> {
    let numbers = |name: String| Some((name.clone(), table.numbers(&format!("{INPUT}{name}"))?));
    table.input_names().into_iter().filter_map(numbers).filter(|(_, cells)| varies(cells)).collect()
}

/// The flag of success first, then all metrics that vary; flags as 0 and 1.
fn outputs(table: &Table) -> Vec<Named> {
    let number = |flag: bool| Some(f64::from(u8::from(flag)));
    let success = table.header.success.as_str();
    let mut outputs: Vec<Named> = Vec::new();
    let flags = table.successes();
    let has_flag = flags.is_some();
    outputs.extend(flags.map(|flags| (success.to_owned(), flags.into_iter().map(number).collect())));
    for column in table.metrics().filter(|column| !has_flag || column.name != success) {
        let cells = match &column.cells {
            Cells::Flags(cells) => Some(cells.iter().map(|cell| cell.and_then(number)).collect()),
            other => other.numbers(),
        };
        outputs.extend(cells.map(|cells| (column.name.clone(), cells)));
    }
    outputs.retain(|(_, cells)| varies(cells));
    outputs
}

fn varies(cells: &[Option<f64>]) -> bool {
    let mut values = cells.iter().flatten();
    values.next().is_some_and(|first| values.any(|value| value != first))
}

fn effects_on(output: &str, cells: &[Option<f64>], inputs: &[Named], subsets: &mut Vec<Subset>) -> Vec<Effect> {
    let rows: Vec<usize> = super::metrics::rows_of(cells).iter().map(|row| row.0).collect();
    let y: Vec<f64> = cells.iter().flatten().copied().collect();
    let y_ranks = ranks(&y);
    let mut noise = Noise::among(inputs.len());
    let at = subsets.iter().position(|subset| subset.rows == rows).unwrap_or_else(|| {
        subsets.push(Subset::of(rows, inputs));
        subsets.len() - 1
    });
    let mut effects = Vec::new();
    for ((input, _), prepared) in inputs.iter().zip(&subsets[at].inputs) {
        let correlation = spearman_of_ranks(&prepared.ranks, &y_ranks);
        let share = prepared.parting.as_ref().and_then(|parting| parting.share(&y));
        let level = prepared.parting.as_ref().and_then(|parting| noise.level(&parting.sizes, &y));
        let is_above = share.zip(level).is_some_and(|(share, level)| share > level);
        let is_correlated = correlation.is_some_and(|c| c.p * (inputs.len() as f64) < CORRELATED);
        effects.push(Effect {
            input: input.clone(),
            output: output.to_owned(),
            runs: y.len(),
            spearman: correlation.map(|c| c.rho),
            p: correlation.map(|c| c.p),
            first_order: share,
            noise: level,
            classes: prepared.parting.as_ref().map_or(0, |parting| parting.sizes.len()),
            is_clear: is_above || is_correlated,
        });
    }
    effects
}

impl Subset {
    fn of(rows: Vec<usize>, inputs: &[Named]) -> Self {
        let prepare = |(_, cells): &Named| {
            // A run without a draw has no place among the others: such an input has no effect to show.
            let values: Option<Vec<f64>> = rows.iter().map(|row| cells.get(*row).copied().flatten()).collect();
            let ranks = ranks(&values.unwrap_or_default());
            let parting = class_count(ranks.len()).and_then(|wanted| Parting::of_ranks(&ranks, wanted));
            Prepared { ranks, parting }
        };
        let inputs = inputs.iter().map(prepare).collect();
        Self { rows, inputs }
    }
}

fn ranking(table: &Table, inputs: &[Named], effects: &[Effect], output: Option<&str>) -> Vec<Driver> {
    let mut chosen: Vec<&Effect> = effects.iter().filter(|effect| Some(effect.output.as_str()) == output).collect();
    chosen.sort_by(|a, b| {
        let (a, b) = (a.strength(), b.strength());
        b.0.total_cmp(&a.0).then(b.1.total_cmp(&a.1))
    });
    let successes = table.successes();
    let driver = |effect: &Effect| {
        let cells = inputs.iter().find(|(name, _)| *name == effect.input).map_or(&[][..], |(_, cells)| cells);
        let flags = successes.as_deref().unwrap_or(&[]);
        let pairs: Vec<(f64, bool)> = cells.iter().zip(flags).filter_map(|(x, s)| Some(((*x)?, *s))).collect();
        let values = |wanted: bool| pairs.iter().filter(|p| p.1 == wanted).map(|p| p.0).collect::<Vec<f64>>();
        let distance = kolmogorov_smirnov(&values(true), &values(false));
        Driver {
            input: effect.input.clone(),
            first_order: effect.first_order,
            noise: effect.noise,
            spearman: effect.spearman,
            p: effect.p,
            ks: distance.map(|d| d.value),
            ks_p: distance.map(|d| d.p),
            is_clear: effect.is_clear,
            by_fifth: fifths(&pairs),
        }
    };
    chosen.into_iter().map(driver).collect()
}

/// Success in fifths of an input, or at each of its values where it has no more than five.
fn fifths(pairs: &[(f64, bool)]) -> Vec<Fifth> {
    let values: Vec<f64> = pairs.iter().map(|pair| pair.0).collect();
    let Some(parting) = Parting::of_ranks(&ranks(&values), 5) else { return Vec::new() };
    let fifth = |class: usize| {
        let members =
            || pairs.iter().zip(&parting.labels).filter(move |(_, label)| **label == class).map(|(pair, _)| pair);
        let low = members().map(|pair| pair.0).fold(f64::INFINITY, f64::min);
        let high = members().map(|pair| pair.0).fold(f64::NEG_INFINITY, f64::max);
        Some(Fifth { low, high, rate: Rate::of_flags(members().map(|pair| pair.1))? })
    };
    (0..parting.sizes.len()).filter_map(fifth).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::findings::tests::table;

    #[test]
    fn success_comes_first_and_what_does_not_vary_has_no_effect() {
        let found = Sensitivity::of(&table(120, |i| i < 60), "");
        assert_eq!(found.outputs, ["captured", "peak_contact_force_n"]);
        assert_eq!(found.effects.len(), 4);
        let force = found.effect("a_deg", "peak_contact_force_n").unwrap();
        assert!((force.spearman.unwrap() - 1.0).abs() < 1e-12 && force.first_order.unwrap() > 0.95 && force.is_clear);
        assert!(force.classes == 10 && force.noise.unwrap() < 0.2);
    }

    #[test]
    fn fifths_show_the_threshold() {
        let found = Sensitivity::of(&table(100, |i| i < 60), "");
        let rates: Vec<f64> = found.ranking[0].by_fifth.iter().map(|f| f.rate.value).collect();
        assert_eq!(rates, [1.0, 1.0, 1.0, 0.0, 0.0]);
        assert_eq!((found.ranking[0].by_fifth[0].low, found.ranking[0].by_fifth[0].high), (0.0, 19.0));
        assert_eq!(found.ranking[0].ks, Some(1.0));
    }

    #[test]
    fn where_all_succeed_inputs_are_ranked_by_the_metric() {
        let found = Sensitivity::of(&table(100, |_| true), "peak_contact_force_n");
        assert_eq!(found.ranked_by.as_deref(), Some("peak_contact_force_n"));
        assert_eq!(found.ranking[0].input, "a_deg");
        assert_eq!(found.ranking[0].ks, None);
    }

    #[test]
    fn a_metric_that_some_runs_lack_is_judged_on_the_others() {
        let mut table = table(100, |i| i < 60);
        for column in table.columns.iter_mut().filter(|c| c.name == "empty_s") {
            column.cells = Cells::Numbers((0..100).map(|i| (i % 2 == 0).then_some(f64::from(i * i))).collect());
        }
        let effect = Sensitivity::of(&table, "").effect("a_deg", "empty_s").cloned().unwrap();
        assert!(effect.runs == 50 && (effect.spearman.unwrap() - 1.0).abs() < 1e-12);
    }
}
