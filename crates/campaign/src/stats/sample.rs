//! One sample of numbers: moments, the interval of its mean, its quantiles.

use super::{Interval, LEVEL, t_quantile};

/// Mean and standard deviation of finite numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// How many.
    pub count: usize,
    /// Mean.
    pub mean: f64,
    /// Standard deviation with n − 1; none of a single number.
    pub std: Option<f64>,
}

impl Moments {
    /// Moments of numbers; none of none. Two passes: no cancellation where the mean is large against the deviation.
    pub fn of(values: &[f64]) -> Option<Self> {
        let count = values.len();
        if count == 0 {
            return None;
        }
        if values.iter().all(|v| *v == values[0]) {
            // Exactly, whatever the rounding of a sum: a constant has no spread.
            return Some(Self { count, mean: values[0], std: (count > 1).then_some(0.0) });
        }
        let mean = values.iter().map(|v| v / count as f64).sum::<f64>();
        let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        Some(Self { count, mean, std: (count > 1).then(|| (squares / (count - 1) as f64).sqrt()) })
    }
}

/// Student's 95 % interval of the mean: mean ± t₀.₉₇₅,ₙ₋₁ s / √n. None of fewer than two numbers.
pub fn mean_interval(values: &[f64]) -> Option<Interval> {
    let Moments { count, mean, std } = Moments::of(values)?;
    let t = t_quantile(0.5 + 0.5 * LEVEL, count as f64 - 1.0)?;
    let half = t * std? / (count as f64).sqrt();
    Some(Interval { low: mean - half, high: mean + half })
}

/// The values in ascending order.
pub fn sorted(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    values
}

/// The quantile of ascending numbers: linear between order statistics, so that the first is the 0 and the last the 1
/// quantile.
///
/// Type 7 of Hyndman, R. J. & Fan, Y. (1996): Sample quantiles in statistical packages. The American Statistician
/// 50(4), 361–365.
pub fn quantile(ascending: &[f64], probability: f64) -> Option<f64> {
    let last = ascending.len().checked_sub(1)?;
    let place = probability.clamp(0.0, 1.0) * last as f64;
    let below = place.floor() as usize;
    let (low, high) = (*ascending.get(below)?, *ascending.get((below + 1).min(last))?);
    Some(low + (place - below as f64) * (high - low))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn moments_of_one_to_five() {
        let moments = Moments::of(&[1.0, 2.0, 3.0, 4.0, 5.0]).unwrap();
        assert!((moments.mean - 3.0).abs() < 1e-15 && (moments.std.unwrap() - 2.5_f64.sqrt()).abs() < 1e-15);
        assert_eq!(Moments::of(&[0.1; 7]).unwrap().std, Some(0.0));
        assert_eq!((Moments::of(&[]), Moments::of(&[4.0]).unwrap().std), (None, None));
    }

    #[test]
    fn the_interval_of_two_numbers_follows_from_the_tangent() {
        // n = 2: mean ± tan(0.475 π) |a − b| / 2.
        let Interval { low, high } = mean_interval(&[1.0, 3.0]).unwrap();
        let half = (0.475 * std::f64::consts::PI).tan();
        assert!((low - (2.0 - half)).abs() < 1e-8 && (high - (2.0 + half)).abs() < 1e-8);
        assert_eq!(mean_interval(&[1.0]), None);
    }

    #[test]
    fn quantiles_are_linear_between_order_statistics() {
        let values = sorted(vec![4.0, 1.0, 3.0, 2.0]);
        assert_eq!(quantile(&values, 0.5), Some(2.5));
        assert_eq!((quantile(&values, 0.0), quantile(&values, 1.0)), (Some(1.0), Some(4.0)));
        assert!((quantile(&values, 0.1).unwrap() - 1.3).abs() < 1e-15);
        assert_eq!(quantile(&[], 0.5), None);
    }
}
