//! What may be wrong with a channel by itself: gaps, an uneven clock, a value that stands still, a limit, spikes.

use crate::{ChannelName, Series};
use serde::Serialize;

/// Missing samples and the evenness of the clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Clock {
    /// Samples per second, from the median step.
    pub rate: f64,
    /// Pauses of more than one and a half median steps.
    pub gaps: usize,
    /// The longest pause, s, and when it begins.
    pub longest_gap: f64,
    /// Time at which the longest pause begins, s.
    pub longest_gap_at: f64,
    /// Share of the samples that are missing, by the median step.
    pub missing: f64,
    /// Standard deviation of the other steps, share of the median step.
    pub jitter: f64,
}

/// Steps from which a pause is a gap.
const GAP: f64 = 1.5;

/// The clock of a series.
pub fn clock(series: &Series) -> Clock {
    let step = series.median_step();
    if step <= 0.0 {
        return Clock::default();
    }
    let mut clock = Clock { rate: 1.0 / step, ..Clock::default() };
    let (mut square, mut even) = (0.0, 0_usize);
    for pair in series.times.windows(2) {
        let pause = pair[1] - pair[0];
        if pause > GAP * step {
            clock.gaps += 1;
            clock.missing += (pause / step).round() - 1.0;
            if pause > clock.longest_gap {
                (clock.longest_gap, clock.longest_gap_at) = (pause, pair[0]);
            }
        } else {
            square += (pause / step - 1.0).powi(2);
            even += 1;
        }
    }
    clock.jitter = (square / even.max(1) as f64).sqrt();
    clock.missing /= clock.missing + series.len() as f64;
    clock
}

/// A stretch over which a channel stood at one value though its noise should move it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Stuck {
    /// The value.
    pub value: f64,
    /// First and last instant, s.
    pub from_s: f64,
    /// Last instant, s.
    pub to_s: f64,
    /// Samples.
    pub samples: usize,
    /// Whether the value is the channel's largest or smallest: clipped at a limit.
    pub at_limit: bool,
}

/// Chance at which a stretch of equal values counts as stuck.
const CHANCE: f64 = 1e-9;
/// Shortest stretch that can be stuck.
const SHORTEST: usize = 6;

/// Stretches of equal values that noise of this size would not leave alone, rounding and all.
pub fn stuck(series: &Series, noise: f64) -> Vec<Stuck> {
    if series.len() < SHORTEST || noise <= 0.0 {
        return Vec::new();
    }
    // Two readings of one true value are equal with a chance of at most q / (2 σ √π); continuous ones never are.
    let equal = (series.quantum() / (2.0 * noise * std::f64::consts::PI.sqrt())).clamp(1e-6, 0.999);
    let high = series.values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let low = series.values.iter().copied().fold(f64::INFINITY, f64::min);
    let mut found = Vec::new();
    let mut start = 0;
    for i in 1..=series.len() {
        if series.values.get(i) == Some(&series.values[start]) {
            continue;
        }
        let samples = i - start;
        let chance = series.len() as f64 * equal.powi(samples.min(10_000) as i32 - 1);
        if samples >= SHORTEST && chance < CHANCE {
            let value = series.values[start];
            let at_limit = high > low && (value == high || value == low);
            found.push(Stuck { value, from_s: series.times[start], to_s: series.times[i - 1], samples, at_limit });
        }
        start = i;
    }
    found
}

/// A reading that stands alone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spike {
    /// When, s.
    pub t: f64,
    /// How far from its neighbours, in the channel's unit.
    pub size: f64,
}

/// Standard deviations of the residual from which a reading may be a spike.
const FAR: f64 = 8.0;
/// How well the neighbours must show the pattern that one lone reading leaves in them.
const PATTERN: f64 = 0.2;

/// Readings that stand alone: each differs from the cubic through its four neighbours, and so do these, by −2/3 and
/// 1/6 of it, as they must if one reading is wrong and the motion is smooth. A step or an impact leaves another pattern.
pub fn spikes(series: &Series, noise: f64) -> Vec<Spike> {
    let v = &series.values;
    let residual = |i: usize| v[i] - (4.0 * (v[i - 1] + v[i + 1]) - v[i - 2] - v[i + 2]) / 6.0;
    // Variance of the residual: σ² (1 + 2·16/36 + 2/36).
    let limit = FAR * noise.hypot(series.quantum()) * (70.0_f64 / 36.0).sqrt();
    let mut found = Vec::new();
    if limit <= 0.0 {
        return found;
    }
    for i in 4..series.len().saturating_sub(4) {
        let size = residual(i);
        let ratio = |k: usize| residual(k) / size;
        let alike = |k: usize, share: f64| (ratio(k) - share).abs() < PATTERN;
        let near = alike(i - 1, -2.0 / 3.0) && alike(i + 1, -2.0 / 3.0);
        if size.abs() > limit && near && alike(i - 2, 1.0 / 6.0) && alike(i + 2, 1.0 / 6.0) {
            found.push(Spike { t: series.times[i], size });
        }
    }
    found
}

/// Share of the samples at the largest size of a command, where that is a plateau and not a valve's 1.
pub fn at_limit(series: &Series) -> Option<(f64, f64)> {
    let is_command = ChannelName::parse(&series.channel).is_some_and(|name| name.quantity.is_command());
    let largest = series.values.iter().map(|v| v.abs()).fold(0.0, f64::max);
    let mut levels: Vec<f64> = series.values.iter().map(|v| v.abs()).collect();
    levels.sort_unstable_by(f64::total_cmp);
    levels.dedup();
    let count = series.values.iter().filter(|v| v.abs() == largest).count();
    let share = count as f64 / series.len().max(1) as f64;
    (is_command && levels.len() > 50 && count >= 5 && share > 0.002).then_some((largest, share))
}
