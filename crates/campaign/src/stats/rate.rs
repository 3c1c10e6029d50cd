//! A rate with its interval.
//!
//! Wilson, E. B. (1927): Probable inference, the law of succession, and statistical inference. Journal of the American
//! Statistical Association 22(158), 209–212: the rates p that a count k of n does not contradict at the level of z,
//!
//!   |k/n − p| ≤ z √(p (1 − p) / n)
//!
//! solved for p. It stays within [0, 1], and says something where k is 0 or n.

use super::{Interval, LEVEL, normal_quantile};
use serde::Serialize;

/// A count out of a number of runs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rate {
    /// Runs that count.
    pub count: usize,
    /// All runs, at least one.
    pub of: usize,
    /// The quotient.
    pub value: f64,
    /// Wilson's 95 % interval.
    pub interval: Interval,
}

impl Rate {
    /// The rate; none of no runs.
    pub fn new(count: usize, of: usize) -> Option<Self> {
        let count = count.min(of);
        (of > 0).then(|| Self { count, of, value: count as f64 / of as f64, interval: wilson(count, of) })
    }

    /// The rate of true ones.
    pub fn of_flags(flags: impl Iterator<Item = bool>) -> Option<Self> {
        let (count, of) = flags.fold((0, 0), |(count, of), flag| (count + usize::from(flag), of + 1));
        Self::new(count, of)
    }
}

/// Wilson's 95 % interval of `count` out of `of`; all of [0, 1] where there is no run.
pub fn wilson(count: usize, of: usize) -> Interval {
    if of == 0 {
        return Interval { low: 0.0, high: 1.0 };
    }
    let (n, count_is_all, count_is_none) = (of as f64, count >= of, count == 0);
    let z = normal_quantile(0.5 + 0.5 * LEVEL).unwrap_or(f64::INFINITY);
    let p = count.min(of) as f64 / n;
    let middle = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
    let half = z / (1.0 + z * z / n) * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
    Interval {
        low: if count_is_none { 0.0 } else { (middle - half).max(0.0) },
        high: if count_is_all { 1.0 } else { (middle + half).min(1.0) },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_solve_wilsons_equation() {
        let z = 1.959_963_984_540_054_f64;
        for (count, of) in [(1, 7), (463, 500), (15, 148)] {
            let Interval { low, high } = wilson(count, of);
            for p in [low, high] {
                let (share, n) = (count as f64 / of as f64, of as f64);
                assert!(((share - p).powi(2) - z * z * p * (1.0 - p) / n).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn none_and_all_have_one_sided_intervals_with_closed_forms() {
        // k = 0: p ≤ z² / (n + z²).
        let z2 = 1.959_963_984_540_054_f64.powi(2);
        assert!((wilson(0, 20).high - z2 / (20.0 + z2)).abs() < 1e-9);
        assert_eq!((wilson(0, 20).low, wilson(20, 20).high), (0.0, 1.0));
        assert_eq!(wilson(0, 0), Interval { low: 0.0, high: 1.0 });
        assert_eq!(Rate::new(0, 0), None);
    }

    #[test]
    fn newcombes_example_of_a_single_proportion() {
        // 15 of 148: 0.0624 … 0.1605 (Newcombe, R. G. (1998), Statistics in Medicine 17(8), 857–872).
        let Interval { low, high } = wilson(15, 148);
        assert!((low - 0.0624).abs() < 5e-5 && (high - 0.1605).abs() < 5e-5);
    }
}
