//! Paired differences of every metric that both tables have.
//!
//! The interval of the mean difference is Student's over the pairs. Whether a difference is clear is decided over all
//! metrics together (Holm), since of twenty metrics without any difference one would show one at 5 %. The standardised
//! difference is in units of the metric's own spread over the runs, √((s²_A + s²_B)/2) (d_av of Cumming, G. (2012):
//! Understanding the New Statistics), so that metrics of different units can stand on one axis.

use super::{LEVEL, Pair};
use crate::stats::{Interval, Moments, holm, kolmogorov_smirnov, mean_interval, quantile, sorted, two_sided_t};
use crate::table::Table;
use serde::Serialize;

/// A metric of two designs on the same draws; differences are B − A.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PairedMetric {
    /// Its name.
    pub name: String,
    /// Pairs in which both have it; all figures are of these.
    pub pairs: usize,
    /// Mean of A.
    pub mean_a: f64,
    /// Mean of B.
    pub mean_b: f64,
    /// Mean of the differences.
    pub mean_difference: f64,
    /// Student's 95 % interval of it; absent of a single pair.
    pub interval: Option<Interval>,
    /// Median of the differences.
    pub median_difference: f64,
    /// Standard deviation of the differences; absent of a single pair.
    pub std_difference: Option<f64>,
    /// Share of pairs in which B is larger.
    pub share_b_larger: f64,
    /// Share of pairs in which B is smaller.
    pub share_b_smaller: f64,
    /// Mean difference over the spread of the metric; absent where it has none.
    pub standardised: Option<f64>,
    /// Its interval.
    pub standardised_interval: Option<Interval>,
    /// Kolmogorov–Smirnov distance between the distributions of A and B, 0 … 1.
    pub ks_distance: Option<f64>,
    /// Two-sided p-value of no mean difference, for itself; absent of a single pair.
    pub p: Option<f64>,
    /// The same, corrected for the number of metrics.
    pub holm_p: Option<f64>,
    /// Whether the difference is not zero, over all metrics together.
    pub is_clear: bool,
}

/// Both values of the pairs that have them, with their place among the pairs.
pub(super) fn values(a: &Table, b: &Table, name: &str, pairs: &[Pair]) -> Vec<(usize, f64, f64)> {
    let (of_a, of_b) = (a.numbers(name).unwrap_or_default(), b.numbers(name).unwrap_or_default());
    let at = |cells: &[Option<f64>], row: usize| cells.get(row).copied().flatten();
    let both = |(k, pair): (usize, &Pair)| Some((k, at(&of_a, pair.row_a)?, at(&of_b, pair.row_b)?));
    pairs.iter().enumerate().filter_map(both).collect()
}

pub(super) fn all(a: &Table, b: &Table, pairs: &[Pair]) -> Vec<PairedMetric> {
    let names = a.metrics().map(|column| column.name.as_str());
    let common = names.filter(|name| a.numbers(name).is_some() && b.numbers(name).is_some());
    let mut metrics: Vec<PairedMetric> = common.filter_map(|name| one(name, &values(a, b, name, pairs))).collect();
    let p: Vec<f64> = metrics.iter().filter_map(|metric| metric.p).collect();
    let tested = metrics.iter_mut().filter(|metric| metric.p.is_some());
    tested.zip(holm(&p)).for_each(|(metric, p)| {
        metric.holm_p = Some(p);
        metric.is_clear = p < LEVEL;
    });
    metrics
}

fn one(name: &str, values: &[(usize, f64, f64)]) -> Option<PairedMetric> {
    let differences: Vec<f64> = values.iter().map(|(_, x, y)| y - x).collect();
    let (x, y): (Vec<f64>, Vec<f64>) = values.iter().map(|v| (v.1, v.2)).unzip();
    let (moments, of_a, of_b) = (Moments::of(&differences)?, Moments::of(&x)?, Moments::of(&y)?);
    let share = |is: fn(&f64) -> bool| differences.iter().filter(|d| is(d)).count() as f64 / moments.count as f64;
    let spread = of_a.std.zip(of_b.std).map(|(s, t)| (0.5 * (s * s + t * t)).sqrt()).filter(|s| *s > 0.0);
    let interval = mean_interval(&differences);
    Some(PairedMetric {
        name: name.to_owned(),
        pairs: moments.count,
        mean_a: of_a.mean,
        mean_b: of_b.mean,
        mean_difference: moments.mean,
        interval,
        median_difference: quantile(&sorted(differences.clone()), 0.5)?,
        std_difference: moments.std,
        share_b_larger: share(|d| *d > 0.0),
        share_b_smaller: share(|d| *d < 0.0),
        standardised: spread.map(|s| moments.mean / s),
        standardised_interval: spread.zip(interval).map(|(s, i)| Interval { low: i.low / s, high: i.high / s }),
        ks_distance: kolmogorov_smirnov(&x, &y).map(|distance| distance.value),
        p: p_value(&moments),
        holm_p: None,
        is_clear: false,
    })
}

/// Student's paired test; a difference that is the same in all pairs is sure, unless it is nought.
fn p_value(differences: &Moments) -> Option<f64> {
    let std = differences.std?;
    if std == 0.0 {
        return Some(if differences.mean == 0.0 { 1.0 } else { 0.0 });
    }
    let t = differences.mean / (std / (differences.count as f64).sqrt());
    two_sided_t(t, differences.count as f64 - 1.0)
}
