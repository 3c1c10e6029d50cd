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
    /// How far from its neighbours, in the channel's unit; of several components the length of all.
    pub size: f64,
}

/// Standard deviations of the residual from which a reading may be a spike.
const FAR: f64 = 8.0;
/// What one lone reading leaves in the differences of its neighbourhood from the cubics through theirs.
const LONE: [f64; 5] = [1.0 / 6.0, -2.0 / 3.0, 1.0, -2.0 / 3.0, 1.0 / 6.0];
/// How well the neighbourhood must show that: squares that are left, in variances of a difference (white noise leaves more than 17 of these once in a
/// thousand), but never more than a share of all, whatever the noise: a step leaves 0.13 of them, and a blow of two samples more. Of a force nothing
/// is put down to noise.
const BY_NOISE: f64 = 17.0;
const PATTERN: [f64; 2] = [0.02, 0.06];

/// Readings that stand alone: each differs from the cubic through its four neighbours, and so do these, by −2/3 and
/// 1/6 of it, as they must if one reading is wrong and the motion is smooth. A step or an impact leaves another pattern.
///
/// `parts`: the components that one reading has in common, at the same times: one, or the four of an orientation, which share what is wrong with one
/// of them since they are normalised. `noise` is that of a component.
pub fn spikes(parts: &[&Series], noise: f64) -> Vec<Spike> {
    let Some(first) = parts.first() else { return Vec::new() };
    let cubic = |v: &[f64], i: usize| v[i] - (4.0 * (v[i - 1] + v[i + 1]) - v[i - 2] - v[i + 2]) / 6.0;
    // Σ LONE² is the variance of such a difference, in units of σ², too.
    let squares: f64 = LONE.iter().map(|x| x * x).sum();
    let quantum = parts.iter().map(|s| s.quantum()).fold(0.0, f64::max);
    let variance = squares * (noise * noise + quantum * quantum);
    if variance <= 0.0 || first.len() < 9 {
        return Vec::new();
    }
    let is_force = ChannelName::parse(&first.channel).is_some_and(|name| name.quantity.is_force());
    let by_noise = if is_force { 0.0 } else { BY_NOISE * parts.len() as f64 * variance };
    // The first and last two have no cubic; of the next ones what is left of their neighbourhood tells.
    let places = 2..first.len() - 2;
    let is_far = |i: &usize| parts.iter().map(|s| cubic(&s.values, *i).powi(2)).sum::<f64>() > FAR * FAR * variance;
    let spike_at = |i: usize, other: Option<usize>| {
        let (mut size, mut all, mut left) = (0.0, 0.0, 0.0);
        let reach = if places.contains(&i) { 2 } else { 3 };
        for part in parts {
            let told = told_by(|k| places.contains(&k).then(|| cubic(&part.values, k)), (i, other), reach);
            size = if parts.len() == 1 { told.size } else { told.size.hypot(size) };
            (all, left) = (all + told.squares, left + told.left);
        }
        let is_alone = left < by_noise.max(PATTERN[0] * all).min(PATTERN[1] * all);
        let is_large = size * size > FAR * FAR * variance / squares;
        (is_alone && is_large).then_some(Spike { t: first.times[i], size })
    };
    let far: Vec<usize> = places.clone().filter(is_far).collect();
    // The first two and the last two readings have none of their own: a logger's first record, or its last, may be empty.
    let last = first.len() - 1;
    let ends = [0, 1, last - 1, last].into_iter().filter(|i| far.contains(&(*i).clamp(2, last - 2)));
    let mut found: Vec<(usize, Spike)> =
        far.iter().copied().chain(ends).filter_map(|i| Some((i, spike_at(i, None)?))).collect();
    // Two near by hide each other; the neighbours of one are far for its sake.
    let open = far.iter().filter(|i| found.iter().all(|(at, _)| at.abs_diff(**i) > 1));
    let with_another = |i: &usize| {
        let others =
            PAIR.iter().flat_map(|d| [i.checked_sub(*d), Some(i + d)]).flatten().filter(|j| places.contains(j));
        others.filter_map(|j| spike_at(*i, Some(j))).next().map(|spike| (*i, spike))
    };
    let paired: Vec<(usize, Spike)> = open.filter_map(with_another).collect();
    found.extend(paired);
    found.sort_by_key(|(i, _)| *i);
    found.into_iter().map(|(_, spike)| spike).collect()
}

/// Distances at which a second lone reading is looked for; neighbours are a bump.
const PAIR: [usize; 3] = [2, 3, 4];

/// What one lone reading, or two, make of a neighbourhood.
struct Told {
    /// Size of the first.
    size: f64,
    /// Sum of the squares of the differences, and what is left of them.
    squares: f64,
    left: f64,
}

/// Least squares of a lone reading at `i`, and at another place where one is given, in differences from cubics so far around where there are some.
fn told_by(difference: impl Fn(usize) -> Option<f64>, (i, other): (usize, Option<usize>), reach: usize) -> Told {
    let (low, high) = (i.min(other.unwrap_or(i)).saturating_sub(reach), i.max(other.unwrap_or(i)) + reach);
    let lone = |at: usize, k: usize| (k + 2).checked_sub(at).and_then(|n| LONE.get(n)).copied().unwrap_or(0.0);
    let (mut aa, mut ab, mut bb, mut ar, mut br, mut rr) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for (k, r) in (low..=high).filter_map(|k| Some((k, difference(k)?))) {
        let (a, b) = (lone(i, k), other.map_or(0.0, |j| lone(j, k)));
        (aa, ab, bb, ar, br, rr) = (aa + a * a, ab + a * b, bb + b * b, ar + a * r, br + b * r, rr + r * r);
    }
    if other.is_none() {
        return Told { size: ar / aa, squares: rr, left: rr - ar * ar / aa };
    }
    let determinant = aa * bb - ab * ab;
    let (x, y) = ((bb * ar - ab * br) / determinant, (aa * br - ab * ar) / determinant);
    Told { size: x, squares: rr, left: rr - x * ar - y * br }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A slow wave at 10 Hz with noise of ±σ that is no pattern, σ = 1, and something added.
    fn wave(phase: f64, added: impl Fn(usize) -> f64) -> Series {
        let times: Vec<f64> = (0..200).map(|i| f64::from(i) * 0.1).collect();
        let noise = |i: usize| [1.0, -0.4, -1.3, 0.7, 0.2, -0.9, 1.1][i * i % 7];
        let value = |(i, t): (usize, &f64)| 300.0 * (0.3 * t + phase).sin() + noise(i) + added(i);
        let values = times.iter().enumerate().map(value).collect();
        Series::with_quantum("joint.hinge.position", times, values, 0.01)
    }

    fn found(parts: &[&Series]) -> Vec<usize> {
        spikes(parts, 1.0).iter().map(|s| (s.t / 0.1).round() as usize).collect()
    }

    #[test]
    fn a_reading_alone_is_found_and_a_step_or_a_bump_is_not() {
        assert!(found(&[&wave(0.0, |_| 0.0)]).is_empty());
        let spike = |i: usize| match i {
            60 => 15.0,
            131 => -40.0,
            _ => 0.0,
        };
        assert_eq!(found(&[&wave(0.0, spike)]), [60, 131]);
        for ends in [[0, 199], [1, 198], [0, 198]] {
            let empty = |i: usize| if ends.contains(&i) { -300.0 } else { 0.0 };
            assert_eq!(found(&[&wave(0.0, empty)]), ends, "next to the ends");
        }
        assert!(found(&[&wave(0.0, |i| if i > 195 { 300.0 } else { 0.0 })]).is_empty(), "a step near the end");
        let pair = |i: usize| match i {
            60 => 25.0,
            62 => -20.0,
            _ => 0.0,
        };
        assert_eq!(found(&[&wave(0.0, pair)]), [60, 62]);
        for size in [10.0, 15.0, 30.0, 60.0, 300.0] {
            assert!(found(&[&wave(0.0, |i| if i < 60 { 0.0 } else { size })]).is_empty(), "a step of {size}");
            assert!(found(&[&wave(0.0, |i| if (60..63).contains(&i) { size } else { 0.0 })]).is_empty(), "a bump");
        }
    }

    #[test]
    fn numbers_whose_differences_none_can_hold_are_no_panic() {
        let wide = wave(0.0, |i| if (60..64).contains(&i) { f64::MAX * [1.0, -1.0][i % 2] } else { 0.0 });
        assert!(found(&[&wide]).len() < 10);
    }

    #[test]
    fn what_is_wrong_with_one_component_is_found_in_all_that_share_it() {
        // 8 σ in each of three: too little alone.
        let parts = [0.0, 1.0, 2.0].map(|phase| wave(phase, |i| if i == 90 { 8.0 } else { 0.0 }));
        assert!(parts.iter().all(|part| found(&[part]).is_empty()));
        assert_eq!(found(&parts.each_ref()), [90]);
    }
}
