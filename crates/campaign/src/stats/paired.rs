//! Two designs on the same draws: McNemar's exact test, an interval for the difference of two paired rates, how many
//! runs it would take to see a difference, and Holm's correction for many metrics.
//!
//! The 2×2 table of pairs, with B the second design:
//!
//! |              | B succeeds | B fails |
//! | ---          | ---        | ---     |
//! | **A succeeds** | both     | only_a  |
//! | **A fails**    | only_b   | neither |

use super::{Interval, normal_quantile, wilson};
use serde::Serialize;
use statrs::distribution::{Binomial, DiscreteCDF};

/// Pairs of runs by who succeeds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct McNemar {
    /// Both succeed.
    pub both: usize,
    /// Only the first.
    pub only_a: usize,
    /// Only the second.
    pub only_b: usize,
    /// Neither.
    pub neither: usize,
}

impl McNemar {
    /// Counts pairs (A succeeds, B succeeds).
    pub fn of(pairs: impl Iterator<Item = (bool, bool)>) -> Self {
        pairs.fold(Self::default(), |mut table, pair| {
            match pair {
                (true, true) => table.both += 1,
                (true, false) => table.only_a += 1,
                (false, true) => table.only_b += 1,
                (false, false) => table.neither += 1,
            }
            table
        })
    }

    /// All pairs.
    pub fn pairs(&self) -> usize {
        self.both + self.only_a + self.only_b + self.neither
    }

    /// Two-sided exact p-value that neither design is better: of the pairs that disagree, each side gets a fair coin's
    /// half,
    ///
    ///   p = min(1, 2 P(X ≤ min(only_a, only_b))),  X ~ Binomial(only_a + only_b, ½)
    ///
    /// (McNemar, Q. (1947): Note on the sampling error of the difference between correlated proportions or percentages.
    /// Psychometrika 12(2), 153–157, whose χ² is the limit of this for many pairs).
    pub fn p(&self) -> f64 {
        let apart = (self.only_a + self.only_b) as u64;
        let less = self.only_a.min(self.only_b) as u64;
        Binomial::new(0.5, apart).map_or(1.0, |coin| (2.0 * coin.cdf(less)).min(1.0))
    }
}

/// Difference of the rates, B − A, with a 95 % interval; none of no pairs.
///
/// Method 10 of Newcombe, R. G. (1998): Improved confidence intervals for the difference between binomial proportions
/// based on paired data. Statistics in Medicine 17(22), 2635–2650: the distances from each rate to the ends of its
/// Wilson interval are added as squares, with the correlation φ of the pairs between them,
///
///   δ = √(dl² − 2 φ dl du + du²)
///
/// where φ's numerator is brought towards zero by n/2 where it is positive.
pub fn difference_of_paired_rates(table: &McNemar) -> Option<(f64, Interval)> {
    let pairs = table.pairs();
    if pairs == 0 {
        return None;
    }
    let (count_a, count_b) = (table.both + table.only_a, table.both + table.only_b);
    let (rate_a, rate_b) = (count_a as f64 / pairs as f64, count_b as f64 / pairs as f64);
    let (a, b) = (wilson(count_a, pairs), wilson(count_b, pairs));
    let phi = correlation(table);
    let add = |x: f64, y: f64| (x * x - 2.0 * phi * x * y + y * y).max(0.0).sqrt();
    let value = rate_b - rate_a;
    let low = value - add(rate_b - b.low, a.high - rate_a);
    let high = value + add(b.high - rate_b, rate_a - a.low);
    Some((value, Interval { low: low.max(-1.0), high: high.min(1.0) }))
}

fn correlation(table: &McNemar) -> f64 {
    let [both, only_a, only_b, neither] =
        [table.both, table.only_a, table.only_b, table.neither].map(|count| count as f64);
    let margins = (both + only_a) * (only_b + neither) * (both + only_b) * (only_a + neither);
    if margins <= 0.0 {
        return 0.0;
    }
    let pairs = both + only_a + only_b + neither;
    let product = both * neither - only_a * only_b;
    let corrected = if product > 0.0 { (product - 0.5 * pairs).max(0.0) } else { product };
    corrected / margins.sqrt()
}

/// Pairs that McNemar's test needs to see a difference of rates in four campaigns of five, at a level of 5 %, where a
/// share `apart` of pairs disagrees; none where the difference is nought, or larger than what disagrees.
///
///   n = (z₀.₉₇₅ √ψ + z₀.₈ √(ψ − δ²))² / δ²
///
/// Connor, R. J. (1987): Sample size for testing differences in proportions for the paired-sample design. Biometrics
/// 43(1), 207–211.
pub fn runs_needed(difference: f64, apart: f64) -> Option<u64> {
    let (level, power) = (normal_quantile(0.975)?, normal_quantile(0.8)?);
    let squared = difference * difference;
    let is_usable = squared > 0.0 && difference.abs() <= apart + 1e-12 && apart <= 1.0;
    is_usable.then(|| {
        let root = level * apart.sqrt() + power * (apart - squared).max(0.0).sqrt();
        (root * root / squared).ceil() as u64
    })
}

/// p-values after Holm's correction, in the order given: the k-th smallest of m is multiplied by m − k + 1, and none is
/// smaller than one before it. All that stay below 5 % can be called real with one false call in twenty campaigns at
/// most.
///
/// Holm, S. (1979): A simple sequentially rejective multiple test procedure. Scandinavian Journal of Statistics 6(2),
/// 65–70.
pub fn holm(p: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|a, b| p[*a].total_cmp(&p[*b]));
    let mut corrected = vec![1.0; p.len()];
    let mut largest = 0.0_f64;
    for (k, i) in order.into_iter().enumerate() {
        largest = largest.max((p[i] * (p.len() - k) as f64).min(1.0));
        corrected[i] = largest;
    }
    corrected
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn mcnemar_is_a_coin() {
        let table = McNemar { both: 50, only_a: 1, only_b: 9, neither: 3 };
        // 2 (1 + 10) / 2¹⁰.
        assert!((table.p() - 22.0 / 1024.0).abs() < 1e-12);
        assert_eq!(McNemar { both: 9, ..McNemar::default() }.p(), 1.0);
        assert_eq!(McNemar { only_a: 4, only_b: 4, ..McNemar::default() }.p(), 1.0);
        let of = McNemar::of([(true, false), (false, true), (true, true), (false, false)].into_iter());
        assert_eq!(of, McNemar { both: 1, only_a: 1, only_b: 1, neither: 1 });
    }

    #[test]
    fn newcombes_interval_of_a_published_table() {
        // Cavo et al. (2012), n = (59, 6; 16, 80), A − B = −0.0621, −0.1186 … −0.0046: the tests of the R package
        // contingencytables to Fagerland, Lydersen & Laake, Statistical Analysis of Contingency Tables, chapter 8.
        let table = McNemar { both: 59, only_a: 6, only_b: 16, neither: 80 };
        let (value, Interval { low, high }) = difference_of_paired_rates(&table).unwrap();
        assert!((value - 0.0621).abs() < 5e-5 && (low - 0.0046).abs() < 5e-5 && (high - 0.1186).abs() < 5e-5);
    }

    #[test]
    fn swapping_the_designs_flips_the_difference() {
        let table = McNemar { both: 30, only_a: 3, only_b: 11, neither: 6 };
        let swapped = McNemar { only_a: 11, only_b: 3, ..table };
        let ((ab, x), (ba, y)) =
            (difference_of_paired_rates(&table).unwrap(), difference_of_paired_rates(&swapped).unwrap());
        assert!(ab == -ba && (x.low + y.high).abs() < 1e-15 && (x.high + y.low).abs() < 1e-15);
        assert_eq!(difference_of_paired_rates(&McNemar::default()), None);
    }

    #[test]
    fn equal_perfect_rates_leave_wilsons_room() {
        let all = McNemar { both: 40, ..McNemar::default() };
        let (value, interval) = difference_of_paired_rates(&all).unwrap();
        let room = 1.0 - wilson(40, 40).low;
        assert!(value == 0.0 && (interval.high - room).abs() < 1e-12 && (interval.low + room).abs() < 1e-12);
    }

    #[test]
    fn runs_needed_grow_with_the_inverse_square() {
        // ψ ≫ δ²: n → (1.96 + 0.8416)² ψ / δ².
        let needed = runs_needed(1e-3, 0.1).unwrap() as f64;
        assert!((needed / ((1.959_964_f64 + 0.841_621).powi(2) * 0.1 / 1e-6) - 1.0).abs() < 1e-4);
        assert_eq!((runs_needed(0.0, 0.1), runs_needed(0.2, 0.1)), (None, None));
    }

    #[test]
    fn holm_multiplies_by_what_is_left() {
        let corrected = holm(&[0.01, 0.04, 0.03, 0.005]);
        let expected = [0.03, 0.06, 0.06, 0.02];
        assert!(corrected.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{corrected:?}");
        assert_eq!(holm(&[]), Vec::<f64>::new());
    }
}
