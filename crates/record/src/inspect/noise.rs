//! White noise of a channel, from its own samples.
//!
//! The k-th difference of neighbouring samples lets slow motion vanish and multiplies white noise of variance σ² to
//! (2k choose k) σ². Its median size is taken, so that impacts and spikes do not count, for k = 2 … 6: what motion is
//! left falls with k, so the smallest is the estimate. Rounding's q²/12 is taken off. An orientation's components share
//! one figure: the squares of their differences add to (2k choose k) σ²/4 · χ²(3), σ in rad about each axis.

use crate::Series;

/// Fewest samples for an estimate.
const FEWEST: usize = 40;
/// Orders of difference.
const ORDERS: std::ops::RangeInclusive<usize> = 2..=6;
/// Median of χ² with one and with three degrees of freedom.
const MEDIAN: [f64; 2] = [0.454_936, 2.365_974];
/// A pause this many median steps long is no neighbourhood.
const PAUSE: f64 = 1.6;

/// Standard deviation of the white noise without rounding, of a channel or of the components of one orientation.
///
/// None: too few samples. 0: no more than the rounding.
pub fn white_noise(series: &[&Series]) -> Option<f64> {
    let first = series.first()?;
    let is_orientation = series.len() > 1;
    let pause = PAUSE * first.median_step();
    let estimate = |order: usize| -> Option<f64> {
        let squares: Vec<f64> = (0..first.len().saturating_sub(order))
            .filter(|i| first.times[*i + order] - first.times[*i] <= pause * order as f64)
            .map(|i| series.iter().map(|s| difference(&s.values[i..=i + order]).powi(2)).sum())
            .collect();
        let median = median(squares)?;
        Some(median / (binomial(2 * order, order) * MEDIAN[usize::from(is_orientation)]))
    };
    let variance = ORDERS.filter_map(estimate).reduce(f64::min)?;
    let (factor, q) = if is_orientation { (4.0, first.quantum() * 2.0) } else { (1.0, first.quantum()) };
    Some((factor * variance - q * q / 12.0).max(0.0).sqrt())
}

/// Difference of the highest order that these values allow.
fn difference(values: &[f64]) -> f64 {
    let order = values.len() - 1;
    let sign = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    values.iter().enumerate().map(|(k, v)| sign(k) * binomial(order, k) * v).sum()
}

fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |product, i| product * (n - i) as f64 / (i + 1) as f64)
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    if values.len() < FEWEST {
        return None;
    }
    let middle = values.len() / 2;
    Some(*values.select_nth_unstable_by(middle, f64::total_cmp).1)
}
