//! White noise of a channel, from its own samples.
//!
//! The k-th difference of neighbouring samples lets slow motion vanish and multiplies white noise of variance σ² to
//! (2k choose k) σ². The mean of the smaller three fifths of its squares is taken (impacts and spikes do not count, and a
//! mean, unlike a median, does not jump on a lattice of rounded values), for k = 2 … 6: what motion is left falls with k,
//! so the smallest is the estimate. Rounding's q²/12 is taken off. An orientation's components share
//! one figure: the squares of their differences add to (2k choose k) σ²/4 · χ²(3), σ in rad about each axis; where only one axis turns, χ²(1).

use crate::Series;

/// Fewest samples for an estimate.
const FEWEST: usize = 40;
/// Orders of difference.
const ORDERS: std::ops::RangeInclusive<usize> = 2..=6;
/// Share of the squares that is taken.
const SMALLER: f64 = 0.6;
/// Mean of the smaller three fifths of χ² with one and with three degrees of freedom: k F(k+2)(x) / 0.6, F(k)(x) = 0.6.
const TRIMMED: [f64; 2] = [0.214_453, 1.458_254];
/// Relative difference up to which variances told from three orders are one, and standard deviations of their spread beside it.
const EVEN: f64 = 0.05;
const DOUBT: f64 = 6.0;
/// A pause this many median steps long is no neighbourhood.
const PAUSE: f64 = 1.6;

/// Standard deviation of the white noise without rounding, of a channel or of the components of one orientation.
///
/// None: too few samples. 0: no more than the rounding.
pub fn white_noise(series: &[&Series]) -> Option<f64> {
    let first = series.first()?;
    let is_orientation = series.len() > 1;
    // About one of its own axes: the components along the other two never change, and have no noise.
    let is_planar = is_orientation && series.iter().filter(|s| s.values.iter().any(|v| *v != s.values[0])).count() == 2;
    let pause = PAUSE * first.median_step();
    let estimate = |order: usize| -> Option<f64> {
        let squares: Vec<f64> = (0..first.len().saturating_sub(order))
            .filter(|i| first.times[*i + order] - first.times[*i] <= pause * order as f64)
            .map(|i| series.iter().map(|s| difference(&s.values[i..=i + order]).powi(2)).sum())
            .collect();
        let mean = trimmed_mean(squares)?;
        Some(mean / (binomial(2 * order, order) * TRIMMED[usize::from(is_orientation && !is_planar)]))
    };
    let variance = ORDERS.filter_map(estimate).reduce(f64::min)?;
    let (factor, q) = if is_orientation { (4.0, first.quantum() * 2.0) } else { (1.0, first.quantum()) };
    Some((factor * variance - q * q / 12.0).max(0.0).sqrt())
}

/// The white part of some stretches of one scalar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct White {
    /// Its variance, the square of the scalar's unit.
    pub variance: f64,
    /// Differences that it was told from.
    pub differences: usize,
    /// Whether differences of fourth to sixth order agree about it: what is white is the same for all of them, while what moves fast falls
    /// from one order to the next.
    pub is_floor: bool,
}

/// White part of some evenly sampled stretches of one scalar, such as the residuals of a model: what is smooth in them does
/// not count, nor do single spikes. None: too few samples.
pub fn white_variance(stretches: &[&[f64]]) -> Option<White> {
    let estimate = |order: usize| -> Option<(f64, usize)> {
        let of = |s: &&[f64]| s.windows(order + 1).map(|w| difference(w).powi(2)).collect::<Vec<f64>>();
        let squares: Vec<f64> = stretches.iter().flat_map(of).filter(|d| d.is_finite()).collect();
        let count = squares.len();
        Some((trimmed_mean(squares)? / (binomial(2 * order, order) * TRIMMED[0]), count))
    };
    let orders: Vec<(f64, usize)> = ORDERS.filter_map(estimate).collect();
    let (variance, differences) = orders.iter().copied().min_by(|a, b| a.0.total_cmp(&b.0))?;
    let (least, most) = orders.iter().rev().take(3).fold((f64::INFINITY, 0.0_f64), |m, o| (m.0.min(o.0), m.1.max(o.0)));
    let is_floor = orders.len() >= 3 && most <= (1.0 + EVEN + DOUBT / (differences as f64).sqrt()) * least;
    Some(White { variance, differences, is_floor })
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

fn trimmed_mean(mut squares: Vec<f64>) -> Option<f64> {
    if squares.len() < FEWEST {
        return None;
    }
    let count = (SMALLER * squares.len() as f64) as usize;
    squares.select_nth_unstable_by(count, f64::total_cmp);
    Some(squares[..count].iter().sum::<f64>() / count as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Next to normal numbers of unit variance: sums of twelve uniform ones (Irwin-Hall).
    fn noise(count: usize) -> Vec<f64> {
        let mut state = 0x9E37_79B9_7F4A_7C15_u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        (0..count).map(|_| (0..12).map(|_| uniform()).sum::<f64>() - 6.0).collect()
    }

    fn beside(motion: impl Fn(f64) -> f64) -> Option<White> {
        let values: Vec<f64> = noise(4000).iter().enumerate().map(|(i, w)| w + motion(i as f64)).collect();
        white_variance(&[&values])
    }

    #[test]
    fn white_noise_has_a_floor_beside_slow_motion_and_none_beside_fast() {
        let is_right = |w: Option<White>| w.is_some_and(|w| w.is_floor && (w.variance - 1.0).abs() < 0.1);
        assert!(is_right(beside(|_| 0.0)));
        assert!(is_right(beside(|i| 100.0 * (0.02 * i).sin())), "slow");
        // A period of five samples.
        assert!(beside(|i| 10.0 * (1.2566 * i).sin()).is_some_and(|w| !w.is_floor), "fast");
        assert_eq!(beside(|_| f64::NAN), None);
    }
}
