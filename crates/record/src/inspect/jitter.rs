//! Stamps that are not when the sample was taken: noise that grows with speed.
//!
//! A sample that is stamped δt late reads y(t) + ẏ δt. Where δt is as good as white with standard deviation τ, the white noise of a channel is
//!
//!   σ²(t) = σ₀² + τ² ẏ²(t)
//!
//! Each sample is told from its neighbours on both sides (Lagrange's polynomial through them), which motion passes and noise does not; the mean squares
//! of what is off, in groups of like speed, are a line over the squares of the speeds. What motion leaves of itself falls with the order of the
//! polynomial and white noise does not, so that both orders have to agree.

use crate::recording::median_step;

/// Neighbours on each side.
const SIDES: [usize; 2] = [2, 3];
/// Groups of like speed, and samples that each has at least.
const GROUPS: usize = 8;
const FEWEST: usize = 40;
/// Factor by which both orders may differ.
const ALIKE: f64 = 1.4;
/// Ratio of the variances of the fastest group and the slowest from which on the noise is not one figure.
const UNEVEN: f64 = 3.0;
/// Share of the scatter about the mean of the groups that the line may leave.
const STRAIGHT: f64 = 0.2;
/// Share of the squares of a group that is taken, and the mean of that share of χ² with one degree of freedom: k F(k+2)(x)/0.9, F(k)(x) = 0.9.
const SMALLER: (f64, f64) = (0.9, 0.623015);
/// A pause this many median steps long is no neighbourhood.
const PAUSE: f64 = 1.6;

/// Standard deviation of the stamps of one scalar of some runs (instants, values), s. None: the noise does not grow with the speed, or it is not told.
#[must_use]
pub fn stamp_jitter(runs: &[(&[f64], &[f64])]) -> Option<f64> {
    let [few, more] = SIDES.map(|sides| told(runs, sides));
    let (few, more) = (few?, more?);
    (few.max(more) < ALIKE * few.min(more)).then_some(more)
}

/// The same by polynomials through so many neighbours on each side.
fn told(runs: &[(&[f64], &[f64])], sides: usize) -> Option<f64> {
    let mut seen: Vec<[f64; 2]> =
        runs.iter().flat_map(|run| off(*run, sides)).filter(|s| s[0].is_finite() && s[1].is_finite()).collect();
    if seen.len() < GROUPS * FEWEST {
        return None;
    }
    seen.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let size = seen.len().div_ceil(GROUPS);
    let groups: Vec<[f64; 2]> =
        seen.chunks(size).map(|group| [mean(group.iter().map(|s| s[0])), smaller(group)]).collect();
    let line = |weights: &[f64]| {
        let sum = |f: &dyn Fn(&[f64; 2]) -> f64| groups.iter().zip(weights).map(|(g, w)| w * f(g)).sum::<f64>();
        let all = sum(&|_| 1.0);
        let (x, y) = (sum(&|g| g[0]) / all, sum(&|g| g[1]) / all);
        let slope = sum(&|g| (g[0] - x) * (g[1] - y)) / sum(&|g| (g[0] - x).powi(2));
        (y - slope * x, slope)
    };
    // A mean square is known to a share of itself.
    let even = vec![1.0; groups.len()];
    let (at, slope) = line(&even);
    let most = groups.iter().map(|g| g[1]).fold(0.0, f64::max);
    let weight = |g: &[f64; 2]| (at + slope * g[0]).max(0.01 * most).powi(-2);
    let weights: Vec<f64> = groups.iter().map(weight).collect();
    let (at, slope) = line(&weights);
    let middle = mean(groups.iter().map(|g| g[1]));
    let off = |f: &dyn Fn(&[f64; 2]) -> f64| groups.iter().map(|g| (g[1] - f(g)).powi(2)).sum::<f64>();
    let is_straight = off(&|g| at + slope * g[0]) < STRAIGHT * off(&|_| middle);
    let (slowest, fastest) = (at + slope * groups[0][0], at + slope * groups[groups.len() - 1][0]);
    (slope > 0.0 && is_straight && fastest > UNEVEN * slowest.max(0.0)).then(|| slope.sqrt())
}

/// Square of the speed at each sample, and of what it is off its neighbours by, in units of the variance of one sample.
fn off((times, values): (&[f64], &[f64]), sides: usize) -> Vec<[f64; 2]> {
    let pause = PAUSE * median_step(times).unwrap_or(f64::INFINITY);
    let of = |i: usize| {
        let near: Vec<usize> = (i - sides..=i + sides).filter(|k| *k != i).collect();
        let is_whole = (i - sides..i + sides).all(|k| times[k + 1] - times[k] <= pause);
        // What stands still for a coarse encoder says nothing of how it reads what moves.
        let moves = near.iter().any(|k| values[*k] != values[i]);
        let dt: Vec<f64> = near.iter().map(|k| times[*k] - times[i]).collect();
        let weight = |a: usize| (0..dt.len()).filter(|b| *b != a).map(|b| -dt[b] / (dt[a] - dt[b])).product::<f64>();
        let weights: Vec<f64> = (0..dt.len()).map(weight).collect();
        let told: f64 = near.iter().zip(&weights).map(|(k, w)| w * values[*k]).sum();
        let noise = 1.0 + weights.iter().map(|w| w * w).sum::<f64>();
        (is_whole && moves).then(|| [speed(times, values, i, sides).powi(2), (values[i] - told).powi(2) / noise])
    };
    (sides..times.len().saturating_sub(sides)).filter_map(of).collect()
}

/// Slope of a straight line through a sample and its neighbours.
fn speed(times: &[f64], values: &[f64], i: usize, sides: usize) -> f64 {
    let near = i.saturating_sub(sides)..(i + sides + 1).min(times.len());
    let (t, y) = (mean(times[near.clone()].iter().copied()), mean(values[near.clone()].iter().copied()));
    let sum = |f: &dyn Fn(usize) -> f64| near.clone().map(f).sum::<f64>();
    sum(&|k| (times[k] - t) * (values[k] - y)) / sum(&|k| (times[k] - t).powi(2))
}

/// Speeds at all samples of a run, by which [`stamp_jitter`] judges.
#[must_use]
pub fn speeds(times: &[f64], values: &[f64]) -> Vec<f64> {
    (0..times.len()).map(|i| speed(times, values, i, SIDES[1])).map(|v| if v.is_finite() { v } else { 0.0 }).collect()
}

/// A short time in words: `0.54 ms`, `29 µs`.
#[must_use]
pub fn duration(seconds: f64) -> String {
    if seconds < 1e-4 { format!("{:.0} µs", 1e6 * seconds) } else { format!("{:.2} ms", 1e3 * seconds) }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0usize), |(s, n), x| (s + x, n + 1));
    sum / count.max(1) as f64
}

/// Mean of the smaller nine tenths of the squares of a group, as a variance: impacts and spikes do not count, and rounding is not normal.
fn smaller(group: &[[f64; 2]]) -> f64 {
    let mut squares: Vec<f64> = group.iter().map(|s| s[1]).collect();
    squares.sort_by(f64::total_cmp);
    let count = (SMALLER.0 * squares.len() as f64) as usize;
    mean(squares[..count].iter().copied()) / SMALLER.1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Normal numbers of unit variance, nearly: sums of twelve uniform ones (Irwin-Hall).
    fn dice() -> impl FnMut() -> f64 {
        let mut state = 0x9E37_79B9_7F4A_7C15_u64;
        let mut uniform = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        move || (0..12).map(|_| uniform()).sum::<f64>() - 6.0
    }

    /// A swing of 1 rad at 1 Hz that dies away, read at 200 Hz for 10 s with so much noise, rad, and so much jitter, s.
    fn swing(noise: f64, jitter: f64) -> (Vec<f64>, Vec<f64>) {
        let mut dice = dice();
        let times: Vec<f64> = (0..2000).map(|i| 0.005 * f64::from(i)).collect();
        let y = |t: f64| (-0.3 * t).exp() * (std::f64::consts::TAU * t).sin();
        let values = times.iter().map(|t| y(t + jitter * dice()) + noise * dice()).collect();
        (times, values)
    }

    fn found(noise: f64, jitter: f64) -> Option<f64> {
        let (times, values) = swing(noise, jitter);
        stamp_jitter(&[(&times, &values)])
    }

    #[test]
    fn jitter_is_told_from_noise_that_is_the_same_at_rest() {
        let told = found(2e-4, 3e-4);
        assert!(told.is_some_and(|s| (s / 3e-4 - 1.0).abs() < 0.1), "{told:?}");
        assert_eq!(found(2e-4, 0.0), None);
        assert_eq!(found(1e-2, 3e-4), None, "far below the noise");
    }

    #[test]
    fn what_moves_too_fast_for_its_rate_is_no_jitter() {
        let times: Vec<f64> = (0..2000).map(|i| 0.05 * f64::from(i)).collect();
        let values: Vec<f64> = times.iter().map(|t| (-0.01 * t).exp() * (14.0 * t).sin()).collect();
        assert_eq!(stamp_jitter(&[(&times, &values)]), None);
    }

    #[test]
    fn a_few_samples_and_what_stands_still_tell_nothing() {
        assert_eq!(stamp_jitter(&[(&[0.0, 1.0], &[0.0, 1.0])]), None);
        let times: Vec<f64> = (0..2000).map(f64::from).collect();
        assert_eq!(stamp_jitter(&[(&times, &vec![0.5; 2000])]), None);
    }
}
