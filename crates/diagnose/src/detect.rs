//! Mismatch or noise: a test that holds its rate of false alarms over a whole recording, and whether what is left is white.
//!
//! The mean square of n residuals of unit noise is χ²ₙ/n, whose cube root is normal to a few parts in a thousand from n = 4 on
//! (Wilson and Hilferty 1931):
//!
//!   z = ((χ²/n)^⅓ − (1 − 2/9n)) / √(2/9n)
//!
//! The statistic is the largest z of all windows and channels, and of each run's channels over all windows. With M of these, noise alone
//! exceeds u with a probability of M Q(u) at most, Q the normal distribution's upper tail, whatever their dependence (Bonferroni). The starts
//! that were fitted only lower the cost: the test errs towards calm.

use crate::evidence::{Detection, Whiteness, autocorrelation};
use crate::judge::{Prediction, Scalar};
use crate::linear::Stage;
use crate::run::Findings;
use record::Role;
use std::collections::BTreeMap;

/// Probability of a false alarm over the whole recording.
const FALSE_ALARM: f64 = 0.01;
/// Scalars that a group has at least.
const LEAST: usize = 4;

/// A model's windows against noise; none where nothing was measured. A noise level that is not better known is no mismatch.
pub(crate) fn detection(stage: &Stage<'_>, prediction: &Prediction) -> Option<Detection> {
    let mut groups: BTreeMap<(usize, usize, Option<usize>), (f64, usize)> = BTreeMap::new();
    for (run, tape) in stage.tapes.iter().enumerate().filter(|(_, t)| t.role == Role::Fit) {
        let windows: Vec<f64> = prediction.fit.segments.iter().filter(|s| s.run == run).map(|s| s.span.to).collect();
        for scalar in prediction.scalars(tape) {
            let window = windows.partition_point(|end| *end <= scalar.time);
            for key in [Some(window), None] {
                let group = groups.entry((run, scalar.reading, key)).or_insert((0.0, 0));
                (group.0, group.1) = (group.0 + scalar.residual.powi(2), group.1 + 1);
            }
        }
    }
    let tests = groups
        .iter()
        .filter(|(_, g)| g.1 >= LEAST)
        .map(|(key, (cost, n))| (key, normal_score(cost / (1.0 + stage.doubt), *n)));
    let count = tests.clone().count();
    let ((run, reading, window), value) = tests.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let tape = &stage.tapes[*run];
    let channel = &tape.readings[*reading].channel;
    let stretch = match window {
        Some(_) => "one window",
        None => "all windows together",
    };
    Some(Detection {
        statistic: format!(
            "largest score of {count} (windows, channels and runs): {channel} in {}, {stretch}",
            tape.file
        ),
        value,
        bound: upper_point(FALSE_ALARM / count as f64),
        false_alarm: FALSE_ALARM,
    })
}

/// Normal score of a sum of n squares of unit noise.
fn normal_score(cost: f64, n: usize) -> f64 {
    let width = 2.0 / (9.0 * n as f64);
    if cost.is_nan() { f64::INFINITY } else { ((cost / n as f64).cbrt() - (1.0 - width)) / width.sqrt() }
}

/// The point that a normal variable exceeds with a probability, by Newton's method on the logarithm of its tail.
fn upper_point(probability: f64) -> f64 {
    let tail = |u: f64| 0.5 * libm::erfc(u / std::f64::consts::SQRT_2);
    let density = |u: f64| (-0.5 * u * u).exp() / (2.0 * std::f64::consts::PI).sqrt();
    let mut u = 1.0;
    for _ in 0..STEPS {
        u += tail(u) / density(u) * (tail(u) / probability).ln();
    }
    u
}

const STEPS: usize = 30;

/// Lags of an autocorrelation, and most channels that it is told of.
const LAGS: usize = 20;
const CHANNELS: usize = 6;

/// Autocorrelation in windows of the channels of one run that differ most, before and after.
pub(crate) fn whiteness(findings: &Findings, stage: &Stage<'_>) -> Vec<Whiteness> {
    let held_out = stage.tapes.iter().position(|t| t.role == Role::Holdout);
    let Some(tape) = stage.tapes.get(held_out.unwrap_or(0)) else { return Vec::new() };
    let of = |scalars: Vec<Scalar>| {
        let mut series: BTreeMap<(usize, usize), Vec<(f64, f64)>> = BTreeMap::new();
        for s in scalars.into_iter().filter(|s| s.residual.is_finite()) {
            series.entry((s.reading, s.component)).or_default().push((s.time, s.residual));
        }
        series
    };
    let [before, after] = findings.judgement.windowed.each_ref().map(|p| of(p.scalars(tape)));
    let mut order: Vec<&(usize, usize)> = before.keys().collect();
    let size = |key: &(usize, usize)| before[key].iter().map(|(_, r)| r * r).sum::<f64>();
    order.sort_by(|a, b| size(b).total_cmp(&size(a)));
    let correlation = |series: &[(f64, f64)]| autocorrelation(&series.iter().map(|s| s.1).collect::<Vec<_>>(), LAGS);
    let channel = |key: &&(usize, usize)| {
        let series = &before[*key];
        let (first, last) = (series.first()?.0, series.last()?.0);
        let step = (last - first) / (series.len().max(2) - 1) as f64;
        let (correlation_before, bound) = correlation(series);
        let is_corrected = !findings.found.set.members.is_empty();
        Some(Whiteness {
            channel: tape.readings[key.0].component(key.1),
            lags_s: (1..=LAGS).map(|k| k as f64 * step).collect(),
            before: correlation_before,
            after: after.get(*key).filter(|_| is_corrected).map_or(Vec::new(), |s| correlation(s).0),
            bound,
        })
    };
    order.iter().take(CHANNELS).filter_map(channel).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_the_normal_distribution() {
        // Abramowitz and Stegun, table 26.5: Q(2.326348) = 0.01, Q(4.753424) = 1e-6.
        assert!((upper_point(0.01) - 2.326_348).abs() < 1e-6);
        assert!((upper_point(1e-6) - 4.753_424).abs() < 1e-6);
    }

    #[test]
    fn a_cube_root_makes_chi_square_normal() {
        // χ²₁₀ exceeds 23.209 with 1 %, χ²₁₀₀ 135.807 (tables): both are 2.326 standard deviations.
        for (cost, n) in [(23.209, 10), (135.807, 100)] {
            assert!((normal_score(cost, n) - 2.326).abs() < 0.02, "{}", normal_score(cost, n));
        }
        assert!(normal_score(f64::NAN, 3).is_infinite());
    }
}
