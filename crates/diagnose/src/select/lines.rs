//! Lines in what a model leaves: frequencies at which something swings.
//!
//! No grid of frequencies is fine enough for a run of minutes: what swings for T seconds is seen within 1/T of its frequency. So the data say where to
//! look. Of the residuals of every channel, and of the unknown forces, which take what is slower than an interval, the periodogram of all runs
//!
//!   S(f) = Σ_runs |Σ_k x_k e^(−2πi f t_k)|² / Σ_k x_k²        (Schuster 1898)
//!
//! is held against the median of its surroundings, so that the colour of noise does not count. Of white noise it has a gamma distribution with as many
//! degrees as there are runs. A peak's frequency is that of the parabola through the logarithms of three bins.

use super::gamma_quantile_over_mean;
use crate::error::DiagnoseError;
use crate::identify::fit::{Fitted, Problem};
use crate::identify::track::{Base, Interval, Link, Track};
use crate::work::Watch;
use record::median_step;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;
use std::collections::BTreeMap;

/// Lines at most.
const MOST: usize = 4;
/// Normal score of what white noise exceeds once in a million bins.
const ONE_IN_MILLION: f64 = 4.75;
/// Zeros behind a series, in its own lengths, so that a peak has bins on both sides.
const PADDED: usize = 4;
/// Cycles in a run that make a line, samples that make a series, and the longest one.
const CYCLES: usize = 3;
const FEWEST: usize = 32;
const LONGEST: usize = 1 << 17;
/// Bins of an unpadded periodogram whose median stands for the noise among them.
const SURROUNDINGS: usize = 64;
/// Share of a step by which the clocks of two runs may differ.
const ALIKE: f64 = 0.01;

/// Even samples of one quantity along one run; zero where there was none.
struct Series {
    step: f64,
    values: Vec<f64>,
}

/// A peak and how far it is above what white noise reaches.
#[derive(Clone, Copy)]
struct Peak {
    frequency: f64,
    height: f64,
}

/// Frequencies at which what a fit leaves swings, Hz, the loudest first.
pub fn lines(problem: &Problem<'_>, now: &Fitted) -> Result<Vec<f64>, DiagnoseError> {
    let mut all: BTreeMap<(usize, usize, usize), Vec<Series>> = BTreeMap::new();
    for (k, track) in now.tracks.iter().enumerate() {
        let bases = problem.frame(now).exact(track).ok_or_else(|| problem.lost())?;
        for (key, series) in residuals_of(problem, track, &bases) {
            all.entry(key).or_default().push(series);
        }
        let links = now.links.get(k).map_or(&[][..], |links| links.as_slice());
        for (force, series) in forces_of(track).into_iter().enumerate().filter(|(j, _)| is_felt(track, links, *j)) {
            all.entry((usize::MAX, force, 0)).or_default().push(series);
        }
    }
    let mut planner = FftPlanner::new();
    let mut peaks: Vec<Peak> = all.values().flat_map(|runs| peaks_of(&mut planner, runs)).collect();
    peaks.sort_by(|a, b| b.height.total_cmp(&a.height));
    let longest = now.tracks.iter().map(length).fold(0.0, f64::max);
    Ok(told_apart(peaks.into_iter().map(|p| p.frequency), longest, MOST))
}

/// Points of a spectrum on a grid that are higher than their neighbours and `loud` times the median of so many points around them, and how high they are.
pub(crate) fn standing_out(grid: &[f64], power: &[f64], around: usize, loud: f64) -> Vec<(f64, f64)> {
    let height = |i: usize| {
        let mut near: Vec<f64> = power[i.saturating_sub(around)..(i + around).min(power.len())].to_vec();
        near.sort_by(f64::total_cmp);
        power[i] / near[near.len() / 2].max(f64::MIN_POSITIVE)
    };
    let is_peak = |i: &usize| power[*i] > power[*i - 1] && power[*i] >= power[*i + 1];
    let inner = 1..power.len().saturating_sub(1).max(1);
    inner.filter(is_peak).filter(|i| height(*i) > loud).map(|i| (grid[i], power[i])).collect()
}

/// The first frequencies, at most so many, that a run of some length tells apart, Hz; or orders that a travel does, in turns.
pub(crate) fn told_apart(all: impl Iterator<Item = f64>, longest: f64, most: usize) -> Vec<f64> {
    let mut found: Vec<f64> = Vec::new();
    for frequency in all {
        if found.len() < most && found.iter().all(|f| (f - frequency).abs() > 1.0 / longest) {
            found.push(frequency);
        }
    }
    found
}

/// Says at which frequencies or orders there is something, with their unit.
pub(crate) fn say(watch: &dyn Watch, what: &str, found: &[f64], unit: &str) {
    if !found.is_empty() {
        let list: Vec<String> = found.iter().map(|f| format!("{f:.4}{unit}")).collect();
        watch.step(&format!("{what} at {}", list.join(", ")));
    }
}

fn length(track: &Track) -> f64 {
    let ends = track.intervals.first().zip(track.intervals.last());
    ends.map_or(0.0, |(first, last)| last.span.to - first.span.from)
}

/// Residuals by reading and component.
fn residuals_of(problem: &Problem<'_>, track: &Track, bases: &[Base]) -> Vec<((usize, usize, usize), Series)> {
    let tape = &problem.stage.tapes[track.run];
    let mut samples: BTreeMap<(usize, usize), Vec<(f64, f64)>> = BTreeMap::new();
    for (interval, (residuals, _)) in track.intervals.iter().zip(bases) {
        let mut values = residuals.iter();
        for member in &interval.members {
            let event = &tape.events[*member as usize];
            let reading = event.reading as usize;
            for (component, value) in values.by_ref().take(tape.readings[reading].width()).enumerate() {
                samples.entry((reading, component)).or_default().push((event.time, *value));
            }
        }
    }
    samples.into_iter().filter_map(|((r, c), s)| Some(((0, r, c), even(&s)?))).collect()
}

/// Samples on the even clock that most of them keep.
fn even(samples: &[(f64, f64)]) -> Option<Series> {
    let step = median_step(&samples.iter().map(|s| s.0).collect::<Vec<f64>>())?;
    let (from, to) = (samples.first()?.0, samples.last()?.0);
    let count = ((to - from) / step).round() as usize + 1;
    if samples.len() < FEWEST || count > LONGEST {
        return None;
    }
    let mut values = vec![0.0; count];
    for (t, x) in samples {
        values[((t - from) / step).round() as usize] = *x;
    }
    Some(Series { step, values })
}

/// Whether an unknown force does more to the readings than the noise of one of them in every interval; what is next to nothing has lines of its own.
pub(super) fn is_felt(track: &Track, links: &[Link], force: usize) -> bool {
    let own =
        |(interval, link): (&Interval, &Link)| interval.force[force].powi(2) * link.f.column(force).norm_squared();
    track.intervals.iter().zip(links).map(own).sum::<f64>() > links.len() as f64
}

/// The unknown forces of a run, one after the other, each held over its interval.
fn forces_of(track: &Track) -> Vec<Series> {
    let shortest = track.intervals.iter().map(|i| i.span.to - i.span.from).fold(f64::INFINITY, f64::min);
    let count = (length(track) / shortest).round() as usize;
    let Some(first) = track.intervals.first().filter(|_| (FEWEST..LONGEST).contains(&count)) else { return Vec::new() };
    let at = |k: usize| first.span.from + (k as f64 + 0.5) * shortest;
    let of = |force: usize| {
        let mut interval = 0;
        let value = |k: usize| {
            while interval + 1 < track.intervals.len() && track.intervals[interval].span.to < at(k) {
                interval += 1;
            }
            track.intervals[interval].force[force]
        };
        Series { step: shortest, values: (0..count).map(value).collect() }
    };
    (0..first.force.len()).map(of).collect()
}

/// The peaks of the periodogram of some runs.
fn peaks_of(planner: &mut FftPlanner<f64>, runs: &[Series]) -> Vec<Peak> {
    let Some(first) = runs.first() else { return Vec::new() };
    let alike: Vec<&Series> = runs.iter().filter(|r| (r.step / first.step - 1.0).abs() < ALIKE).collect();
    let longest = alike.iter().map(|r| r.values.len()).max().unwrap_or(0);
    let bins = (PADDED * longest).next_power_of_two();
    let fft = planner.plan_fft_forward(bins);
    let mut power = vec![0.0; bins / 2];
    let mut degrees = 0.0;
    for run in alike {
        let total: f64 = run.values.iter().map(|x| x * x).sum();
        if total == 0.0 {
            continue;
        }
        degrees += 1.0;
        let mut wave: Vec<Complex<f64>> = run.values.iter().map(|x| Complex::new(*x, 0.0)).collect();
        wave.resize(bins, Complex::new(0.0, 0.0));
        fft.process(&mut wave);
        power.iter_mut().zip(&wave).for_each(|(p, w)| *p += w.norm_sqr() / total);
    }
    let own = bins / longest.max(1);
    let frequency = |bin: f64| bin / (bins as f64 * first.step);
    let mut found = Vec::new();
    for (block, of_block) in power.chunks(SURROUNDINGS * own).enumerate() {
        let mut sorted = of_block.to_vec();
        sorted.sort_by(f64::total_cmp);
        let noise = sorted[sorted.len() / 2] / (degrees * gamma_quantile_over_mean(degrees, 0.0));
        for i in 0..of_block.len() {
            let bin = block * SURROUNDINGS * own + i;
            if bin < CYCLES * own || bin + own >= power.len() {
                continue;
            }
            let is_highest = power[bin - own..=bin + own].iter().all(|p| *p <= power[bin]);
            let height = power[bin] / (noise * degrees * gamma_quantile_over_mean(degrees, ONE_IN_MILLION));
            if is_highest && height > 1.0 {
                let aside = vertex([power[bin - 1], power[bin], power[bin + 1]].map(f64::ln));
                found.push(Peak { frequency: frequency(bin as f64 + aside), height });
            }
        }
    }
    found
}

/// Where the parabola through three values at −1, 0 and 1 is highest.
fn vertex([before, at, after]: [f64; 3]) -> f64 {
    let bend = before - 2.0 * at + after;
    if bend < 0.0 { 0.5 * (before - after) / bend } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    /// Coloured noise (AR(1)) with a wave in it, of some runs.
    fn runs(amplitude: f64, frequency: f64) -> Vec<Series> {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let one = |run: usize| {
            let mut state = 0.0;
            let mut value = |k: usize| {
                let white: f64 = StandardNormal.sample(&mut random);
                state = 0.7 * state + white;
                let phase = std::f64::consts::TAU * frequency * 0.1 * k as f64 + run as f64;
                state + amplitude * phase.sin()
            };
            Series { step: 0.1, values: (0..3000).map(&mut value).collect() }
        };
        [0, 1, 2].map(one).into()
    }

    #[test]
    fn a_weak_wave_in_coloured_noise_is_seen_where_it_is() {
        let peaks = peaks_of(&mut FftPlanner::new(), &runs(0.4, 0.4321));
        let loudest = peaks.iter().max_by(|a, b| a.height.total_cmp(&b.height)).map_or(0.0, |p| p.frequency);
        // A tenth of what a run of 300 s tells apart.
        assert!((loudest - 0.4321).abs() < 0.1 / 300.0, "{loudest}");
    }

    #[test]
    fn noise_alone_has_no_lines() {
        assert!(peaks_of(&mut FftPlanner::new(), &runs(0.0, 1.0)).is_empty());
    }
}
