//! Quantiles of the normal, Student's and the beta distribution, as p-values and intervals need them.
//!
//! Distribution functions are those of `statrs`; Student's and the beta quantile are found by bisection, whose number
//! of steps is known beforehand for every argument.

use statrs::distribution::{Beta, ContinuousCDF, Normal, StudentsT};

/// Halvings: the interval is then as small as a double can tell.
const HALVINGS: usize = 100;

/// The point below which a standard normal variable lies with a probability in (0, 1).
pub fn normal_quantile(probability: f64) -> Option<f64> {
    (probability > 0.0 && probability < 1.0).then(|| Normal::standard().inverse_cdf(probability))
}

/// The point below which Student's t with `freedom` degrees lies with a probability in (0, 1).
pub fn t_quantile(probability: f64, freedom: f64) -> Option<f64> {
    let t = students_t(freedom)?;
    if !(probability > 0.0 && probability < 1.0) {
        return None;
    }
    let tail = probability.min(1.0 - probability);
    let mut high = 2.0;
    while t.sf(high) > tail && high < 1e300 {
        high *= 2.0;
    }
    let x = bisect(0.0, high, |x| t.sf(x) > tail);
    Some(if probability < 0.5 { -x } else { x })
}

/// Two-sided p-value of Student's t.
pub fn two_sided_t(t: f64, freedom: f64) -> Option<f64> {
    (!t.is_nan()).then_some(())?;
    Some((2.0 * students_t(freedom)?.sf(t.abs())).min(1.0))
}

/// The point below which a beta variable lies with a probability in (0, 1).
pub fn beta_quantile(probability: f64, shape_a: f64, shape_b: f64) -> Option<f64> {
    if !(probability > 0.0 && probability < 1.0 && shape_a.is_finite() && shape_b.is_finite()) {
        return None;
    }
    let beta = Beta::new(shape_a, shape_b).ok()?;
    Some(bisect(0.0, 1.0, |x| beta.cdf(x) < probability))
}

fn students_t(freedom: f64) -> Option<StudentsT> {
    (freedom >= 1.0 && freedom.is_finite()).then(|| StudentsT::new(0.0, 1.0, freedom).ok()).flatten()
}

/// Where `is_below` turns from true to false.
fn bisect(mut low: f64, mut high: f64, is_below: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if is_below(middle) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn quantiles_of_students_t_with_one_and_two_degrees_have_closed_forms() {
        // One degree: tan(π (p − ½)); two degrees: (2p − 1) √(2 / (4 p (1 − p))).
        let one = (std::f64::consts::PI * 0.475).tan();
        assert!((t_quantile(0.975, 1.0).unwrap() - one).abs() < 1e-9);
        let two = 0.95 * (2.0 / (4.0 * 0.975 * 0.025_f64)).sqrt();
        assert!((t_quantile(0.975, 2.0).unwrap() - two).abs() < 1e-9);
        assert!((t_quantile(0.025, 2.0).unwrap() + two).abs() < 1e-9);
    }

    #[test]
    fn many_degrees_are_normal() {
        let normal = normal_quantile(0.975).unwrap();
        assert!((normal - 1.959_963_984_540_054).abs() < 1e-9);
        assert!((t_quantile(0.975, 1e6).unwrap() - normal).abs() < 1e-5);
        assert!((two_sided_t(normal, 1e6).unwrap() - 0.05).abs() < 1e-5);
    }

    #[test]
    fn the_beta_quantile_of_a_power_is_a_root() {
        // Beta(a, 1) has the distribution function xᵃ.
        assert!((beta_quantile(0.3, 4.0, 1.0).unwrap() - 0.3_f64.powf(0.25)).abs() < 1e-9);
    }

    #[test]
    fn what_has_no_quantile_has_none() {
        assert_eq!((normal_quantile(1.0), t_quantile(0.5, 0.0), beta_quantile(0.5, 0.0, 1.0)), (None, None, None));
        assert_eq!(two_sided_t(f64::NAN, 3.0), None);
    }
}
