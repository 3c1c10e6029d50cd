//! Spearman's rank correlation with ties.
//!
//! ρ is Pearson's correlation of the ranks, tied values sharing the average of their ranks. Its p-value is that of t =
//! ρ √((n − 2) / (1 − ρ²)) with n − 2 degrees of freedom, and at least 2/n!, which is the smallest that n values can
//! give (Kendall, M. & Gibbons, J. D. (1990): Rank Correlation Methods).

use super::two_sided_t;

/// A correlation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correlation {
    /// ρ, −1 … 1.
    pub rho: f64,
    /// Two-sided p-value of no correlation.
    pub p: f64,
    /// Pairs of values.
    pub count: usize,
}

/// Ranks from one, in the order of the values; equal values share the average of their ranks.
pub fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0.0; values.len()];
    let mut first = 0;
    while first < order.len() {
        let tied = order[first..].iter().take_while(|i| values[**i] == values[order[first]]).count().max(1);
        let average = first as f64 + 0.5 * (tied + 1) as f64;
        order[first..first + tied].iter().for_each(|i| ranks[*i] = average);
        first += tied;
    }
    ranks
}

/// The correlation of pairs; none of fewer than three, or where either side does not vary.
pub fn spearman(x: &[f64], y: &[f64]) -> Option<Correlation> {
    let count = x.len().min(y.len());
    spearman_of_ranks(&ranks(&x[..count]), &ranks(&y[..count]))
}

/// The same from [`ranks`] of the values, as many of one as of the other.
pub fn spearman_of_ranks(x: &[f64], y: &[f64]) -> Option<Correlation> {
    let count = x.len();
    if count < 3 || y.len() != count {
        return None;
    }
    let middle = 0.5 * (count + 1) as f64;
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - middle) * (b - middle)).sum::<f64>();
    let (xx, yy) = (dot(x, x), dot(y, y));
    if xx <= 0.0 || yy <= 0.0 {
        return None;
    }
    let rho = (dot(x, y) / (xx * yy).sqrt()).clamp(-1.0, 1.0);
    Some(Correlation { rho, p: p_value(rho, count), count })
}

fn p_value(rho: f64, count: usize) -> f64 {
    let freedom = (count - 2) as f64;
    let t = rho * (freedom / (1.0 - rho * rho)).sqrt();
    let least = 2.0 / (1..=count.min(20)).map(|k| k as f64).product::<f64>();
    let p = if t.is_finite() { two_sided_t(t, freedom).unwrap_or(1.0) } else { 0.0 };
    if count <= 20 { p.max(least) } else { p }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn ties_share_their_average_rank() {
        assert_eq!(ranks(&[3.0, 1.0, 3.0, 2.0, 3.0]), [4.0, 1.0, 4.0, 2.0, 4.0]);
    }

    #[test]
    fn without_ties_it_is_one_minus_six_sums_of_squares() {
        // ρ = 1 − 6 Σ d² / (n (n² − 1)).
        let (x, y) = ([1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [10.0, 30.0, 20.0, 60.0, 40.0, 50.0]);
        let squares: f64 = [0.0, 1.0, 1.0, 4.0, 1.0, 1.0].iter().sum();
        let rho = 1.0 - 6.0 * squares / (6.0 * 35.0);
        let found = spearman(&x, &y).unwrap();
        assert!((found.rho - rho).abs() < 1e-14);
        // t with four degrees of freedom: F(t) = ½ + ¾ (s − s³/3), s = t / √(4 + t²), which here is ρ itself.
        let p = 1.0 - 1.5 * (rho - rho.powi(3) / 3.0);
        assert!((found.p - p).abs() < 1e-10, "{} {p}", found.p);
    }

    #[test]
    fn any_monotonic_function_correlates_fully_and_a_constant_not_at_all() {
        let x: Vec<f64> = (0..30).map(f64::from).collect();
        let y: Vec<f64> = x.iter().map(|x| -(0.3 * x).exp()).collect();
        assert_eq!(spearman(&x, &y).unwrap().rho, -1.0);
        assert!(spearman(&x, &y).unwrap().p < 1e-20);
        assert_eq!(spearman(&x, &[1.0; 30]), None);
        let three = spearman(&[1.0, 2.0, 3.0], &[1.0, 2.0, 3.0]).unwrap();
        assert!((three.p - 1.0 / 3.0).abs() < 1e-12, "three points prove nothing");
    }
}
