//! The Kolmogorov–Smirnov distance of two samples: the largest difference of their distribution functions.
//!
//! Its p-value is the asymptotic one with Stephens' correction of the sample size: λ = (√n + 0.12 + 0.11/√n) D with n =
//! n₁ n₂ / (n₁ + n₂), p = 2 Σ (−1)^{j−1} exp(−2 j² λ²) (Stephens, M. A. (1970): Use of the Kolmogorov–Smirnov,
//! Cramér–von Mises and related statistics without extensive tables. Journal of the Royal Statistical Society B 32(1),
//! 115–122). With ties it is on the safe side: too large.

/// A distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Largest difference of the distribution functions, 0 … 1.
    pub value: f64,
    /// p-value of one common distribution.
    pub p: f64,
}

/// The distance of two samples in any order; none where one is empty.
pub fn kolmogorov_smirnov(a: &[f64], b: &[f64]) -> Option<Distance> {
    if a.is_empty() || b.is_empty() {
        return None;
    }
    let (a, b) = (super::sorted(a.to_vec()), super::sorted(b.to_vec()));
    let (n, m) = (a.len() as f64, b.len() as f64);
    let (mut i, mut j, mut value) = (0, 0, 0.0_f64);
    while i < a.len() && j < b.len() {
        let x = a[i].min(b[j]);
        i += a[i..].iter().take_while(|v| **v <= x).count();
        j += b[j..].iter().take_while(|v| **v <= x).count();
        value = value.max((i as f64 / n - j as f64 / m).abs());
    }
    let root = (n * m / (n + m)).sqrt();
    Some(Distance { value, p: tail((root + 0.12 + 0.11 / root) * value) })
}

/// Probability that Kolmogorov's variable exceeds λ.
fn tail(lambda: f64) -> f64 {
    // Below, the series converges slowly, and the tail is 1 to eight digits.
    if lambda < 0.25 {
        return 1.0;
    }
    let term = |j: i32| {
        let sign = if j % 2 == 1 { 2.0 } else { -2.0 };
        sign * (-2.0 * f64::from(j * j) * lambda * lambda).exp()
    };
    (1..=20).map(term).sum::<f64>().clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn samples_apart_are_at_distance_one_and_equal_ones_at_zero() {
        let a: Vec<f64> = (0..40).map(f64::from).collect();
        let b: Vec<f64> = a.iter().map(|x| x + 100.0).collect();
        let (apart, same) = (kolmogorov_smirnov(&a, &b).unwrap(), kolmogorov_smirnov(&a, &a).unwrap());
        assert!(apart.value == 1.0 && apart.p < 1e-15);
        assert_eq!((same.value, same.p), (0.0, 1.0));
        assert_eq!(kolmogorov_smirnov(&a, &[]), None);
    }

    #[test]
    fn ties_across_samples_step_together() {
        let found = kolmogorov_smirnov(&[1.0, 1.0, 2.0, 2.0], &[1.0, 2.0, 2.0, 2.0]).unwrap();
        assert!((found.value - 0.25).abs() < 1e-15);
    }

    #[test]
    fn the_tail_has_the_tabulated_critical_points() {
        // Kolmogorov's 5 % and 1 % points: 1.3581, 1.6276.
        assert!((tail(1.3581) - 0.05).abs() < 1e-5 && (tail(1.6276) - 0.01).abs() < 1e-5);
        assert!((tail(0.2501) - 1.0).abs() < 1e-6);
    }
}
