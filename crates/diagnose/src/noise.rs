//! The noise of the sensors, as the samples themselves tell it; a data sheet's figure is only where one begins.
//!
//! Before anything is fitted, samples that no sensor meant are left out: readings that stand alone (spikes) and stretches in which a channel
//! stood still at one value (stuck, or clipped at a limit). A channel without a stated σ has that of its own differences.
//!
//! After the nominal model was fitted in windows, what its residuals r hold of white noise is known far better than from the raw samples: a
//! wrong model leaves what is smooth from one sample to the next, which differences of second to sixth order take away,
//!
//!   s² = min over k of ⟨(Δᵏ r)²⟩ / (2k choose k),      σ ← s σ
//!
//! with the mean over the smaller three fifths (impacts do not count). A stated σ is believed within [`SURE`], and left by more than
//! [`FARTHEST`] only where all that is left is white, or the last orders agree about s: else it is not the noise that differs.

use crate::error::DiagnoseError;
use crate::fit::Fit;
use crate::linear::Stage;
use crate::reading::Reading;
use crate::tape::Tape;
use rayon::prelude::*;
use record::inspect::{Spike, Stuck, spikes, stuck, white_noise, white_variance};
use record::{RecordedRun, RecordingSet, Role, Series, median_step};
use std::collections::BTreeMap;

/// Relative difference from a stated σ that the samples must show to be believed against it: an estimate is sure to some per cent.
/// At half of it estimates would replace σ that are right, at twice σ that are wrong by 5 % would stay.
const SURE: f64 = 0.03;
/// Factor by which samples may differ from a stated σ. Twice the prior's ±20 % at five standard deviations.
const FARTHEST: f64 = 2.0;
/// The same where residuals have a white floor beside what a wrong model leaves in them. Data sheets are off by less.
const FARTHEST_FLOOR: f64 = 5.0;
/// Factor below which it is no noise that is seen but a coarse encoder at rest.
const AT_REST: f64 = 0.1;
/// Share of a channel's samples that may be left out as spikes; where more stand alone, standing alone is how the channel is.
const SPIKES: f64 = 0.02;
/// Share of a component's samples from which on it is left out whole rather than sample by sample with the others of its sensor.
const DEAD: f64 = 0.2;
/// Samples left out beside a clipped stretch: the way into the limit is bent too.
const MARGIN: usize = 2;
/// Cost per scalar that a stated σ does not vouch for: what data sheets round.
pub(crate) const STATED: f64 = 0.03;
/// Relative standard deviation of a variance told from n differences is this over √n: √2 of white numbers, as much again for the
/// overlap of differences and for the trimmed mean.
const SPREAD: f64 = 2.8;
/// Standard deviations of an estimated noise level that are not told from a mismatch.
const DOUBT: f64 = 3.0;
/// Pauses of more than so many median steps end a stretch of neighbours.
const PAUSE: f64 = 1.6;

/// White noise of the components of one reading, from their raw samples; zero where it is below the rounding.
pub(crate) fn raw_sigma(parts: &[&Series], is_orientation: bool) -> Option<f64> {
    if is_orientation {
        return white_noise(parts);
    }
    let mut each: Vec<f64> = parts.iter().filter_map(|s| white_noise(&[s])).collect();
    each.sort_by(f64::total_cmp);
    each.get(each.len() / 2).copied()
}

/// The runs without the samples that no sensor meant, and what was left out, in words.
pub(crate) fn clean(set: &RecordingSet, tapes: Vec<Tape>) -> (Vec<Tape>, Vec<String>) {
    let mut said = LeftOut::default();
    let cleaned = tapes.into_iter().map(|tape| match set.runs.get(tape.index) {
        Some(run) => clean_run(run, tape, &mut said),
        None => tape,
    });
    (cleaned.collect(), said.words())
}

/// Samples that were left out of all runs, by channel.
#[derive(Default)]
struct LeftOut {
    alone: BTreeMap<String, usize>,
    still: BTreeMap<String, (usize, bool)>,
}

impl LeftOut {
    fn add(&mut self, channel: &str, bad: &Bad) {
        *self.alone.entry(channel.to_owned()).or_default() += bad.alone;
        let known = self.still.entry(channel.to_owned()).or_default();
        (known.0, known.1) = (known.0 + bad.still, known.1 || bad.at_limit);
    }

    fn words(&self) -> Vec<String> {
        let samples = |n: usize| if n == 1 { "1 reading".to_owned() } else { format!("{n} readings") };
        let alone = self.alone.iter().filter(|(_, n)| **n > 0);
        let alone = alone.map(|(channel, n)| format!("{channel}: left out {} that stand alone.", samples(*n)));
        let still = self.still.iter().filter(|(_, (n, _))| *n > 0).map(|(channel, (n, at_limit))| {
            let how = if *at_limit { "at its limit, clipped" } else { "while it stood still" };
            format!("{channel}: left out {} {how}.", samples(*n))
        });
        alone.chain(still).collect()
    }
}

fn clean_run(run: &RecordedRun, tape: Tape, said: &mut LeftOut) -> Tape {
    let cleaned: Vec<Option<Reading>> = tape.readings.iter().map(|r| clean_reading(run, r, said)).collect();
    if cleaned.iter().all(Option::is_none) {
        return tape;
    }
    let readings = tape.readings.iter().zip(cleaned).map(|(old, new)| new.unwrap_or_else(|| old.clone()));
    tape.with_readings(readings.collect())
}

/// A reading without what no sensor meant; none where nothing is left out, or nothing would be left.
fn clean_reading(run: &RecordedRun, reading: &Reading, said: &mut LeftOut) -> Option<Reading> {
    let is_orientation = reading.is_orientation();
    let parts: Vec<usize> = if is_orientation { (0..4).collect() } else { reading.axes.clone() };
    let series_of = |axis: &usize| {
        let part = if is_orientation { ["w", "x", "y", "z"][*axis] } else { ["x", "y", "z"][*axis] };
        let series = run.series(&reading.channel).or_else(|| run.series(&format!("{}.{part}", reading.channel)));
        series.filter(|s| s.times[..] == reading.times[..])
    };
    let series: Vec<&Series> = parts.iter().map(series_of).collect::<Option<_>>()?;
    // About an axis a turn is twice as large as it is in the quaternion.
    let noise = if is_orientation { 0.5 * reading.sigma } else { reading.sigma };
    let groups = series.chunks(if is_orientation { series.len() } else { 1 });
    // What stands alone in a group is told with its first component.
    let of_group = |group: &[&Series]| {
        let mut alone = find_alone(group, noise);
        group.iter().map(|s| find_bad(s, std::mem::take(&mut alone), noise)).collect::<Vec<Bad>>()
    };
    let found: Vec<Bad> = groups.flat_map(of_group).collect();
    // Of an orientation a component that stands still is none that fails: a body in the plane turns about one axis.
    let is_dead = |bad: &Bad| bad.share() > DEAD;
    let axes: Vec<usize> = if is_orientation {
        reading.axes.clone()
    } else {
        parts.iter().zip(&found).filter(|(_, b)| !is_dead(b)).map(|p| *p.0).collect()
    };
    let is_bad = |i: usize| found.iter().any(|b| !is_dead(b) && b.samples[i]);
    let kept: Vec<usize> = (0..reading.times.len()).filter(|i| !is_bad(*i)).collect();
    if axes.is_empty() || kept.is_empty() || (kept.len(), axes.len()) == (reading.times.len(), reading.axes.len()) {
        return None;
    }
    found.iter().filter(|b| !(is_orientation && is_dead(b))).for_each(|b| said.add(&reading.channel, b));
    Some(Reading { axes, ..reading.of_samples(&kept) })
}

/// What is wrong with the samples of one component.
struct Bad {
    samples: Vec<bool>,
    alone: usize,
    still: usize,
    at_limit: bool,
}

impl Bad {
    fn share(&self) -> f64 {
        self.samples.iter().filter(|b| **b).count() as f64 / self.samples.len().max(1) as f64
    }
}

/// Readings that stand alone in components that share their faults; none where so many do that it is how the channel is.
fn find_alone(group: &[&Series], noise: f64) -> Vec<Spike> {
    let found = spikes(group, noise);
    let most = SPIKES * group.first().map_or(0.0, |s| s.len() as f64);
    if found.len() as f64 <= most { found } else { Vec::new() }
}

fn find_bad(series: &Series, alone: Vec<Spike>, noise: f64) -> Bad {
    let mut samples = vec![false; series.len()];
    let at = |t: f64| series.times.partition_point(|s| *s < t);
    alone.iter().for_each(|s| samples[at(s.t)] = true);
    let still: Vec<Stuck> = stuck(series, noise);
    for one in &still {
        let margin = if one.at_limit { MARGIN } else { 0 };
        let end = (at(one.to_s) + 1 + margin).min(samples.len());
        samples[at(one.from_s).saturating_sub(margin)..end].fill(true);
    }
    Bad {
        samples,
        alone: alone.len(),
        still: still.iter().map(|s| s.samples).sum(),
        at_limit: still.iter().any(|s| s.at_limit),
    }
}

/// What the residuals of a model say of the noise.
#[derive(Clone, Debug)]
pub(crate) struct Noise {
    /// By channel: factor of its σ, where that is another.
    pub factors: BTreeMap<String, f64>,
    /// Cost per scalar that is not told from a wrong noise level.
    pub doubt: f64,
}

impl Noise {
    /// From the residuals of a model's windows.
    pub fn estimate(stage: &Stage<'_>, nominal: &Fit, set: &RecordingSet) -> Self {
        let residuals: Vec<Vec<Stretch>> =
            nominal.segments.par_iter().map(|s| stretches_of(stage, nominal, s)).collect();
        let mut by_channel: BTreeMap<String, Vec<Vec<f64>>> = BTreeMap::new();
        for stretch in residuals.into_iter().flatten() {
            by_channel.entry(stretch.channel).or_default().push(stretch.values);
        }
        let (mut factors, mut variance, mut all) = (BTreeMap::new(), 0.0, 0.0);
        for (channel, stretches) in &by_channel {
            let samples: f64 = stretches.iter().map(|s| s.len() as f64).sum();
            all += samples;
            let slices: Vec<&[f64]> = stretches.iter().map(Vec::as_slice).collect();
            let Some(part) = white_variance(&slices) else { continue };
            let is_stated = set.runs.iter().flat_map(|r| &r.series).any(|s| {
                s.channel.strip_prefix(channel.as_str()).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
                    && (set.sigma(&s.channel).or_else(|| set.sigma(channel))).is_some()
            });
            let whole = typical_rms(&slices);
            let found =
                Found { white: part.variance.sqrt(), is_floor: part.is_floor, whole, forgets: forgets(&slices) };
            let Some(factor) = factor_of(found, is_stated).filter(|f| *f > AT_REST) else { continue };
            // What a coarse encoder reads of a slow motion stays the same from sample to sample, and is wrong by its rounding.
            let factor = factor.max(least_factor(stage.tapes, channel));
            if (factor - 1.0).abs() < SURE {
                continue;
            }
            variance += (samples * SPREAD).powi(2) / part.differences as f64;
            factors.insert(channel.clone(), factor);
        }
        let doubt = STATED + if factors.is_empty() { 0.0 } else { DOUBT * variance.sqrt() / f64::max(all, 1.0) };
        Self { factors, doubt }
    }

    /// The runs with the noise that was found.
    pub fn applied(&self, tapes: &[Tape]) -> Vec<Tape> {
        let of = |tape: &Tape| {
            let mut tape = tape.clone();
            for reading in &mut tape.readings {
                reading.sigma *= self.factors.get(&reading.channel).copied().unwrap_or(1.0);
            }
            tape
        };
        tapes.iter().map(of).collect()
    }

    /// What was found, in words: of what is louder, and of what is quieter.
    pub fn words(&self) -> Vec<String> {
        let (louder, quieter): (Vec<_>, Vec<_>) = self.factors.iter().partition(|(_, factor)| **factor > 1.0);
        [louder, quieter].iter().filter_map(|own| said_of(own)).collect()
    }
}

/// Channels whose noise is not the stated one, in words.
fn said_of(own: &[(&String, &f64)]) -> Option<String> {
    const STATED: &str = "times what was stated or its raw samples show";
    let factors = own.iter().map(|(_, factor)| **factor);
    let [least, most] = [factors.clone().reduce(f64::min)?, factors.reduce(f64::max)?];
    let names: Vec<&str> = own.iter().map(|(channel, _)| channel.as_str()).collect();
    Some(match names.as_slice() {
        [one] => format!("{one}: its noise is {least:.2} {STATED}; that figure was used."),
        _ => format!("{}: their noise is {least:.2} to {most:.2} {STATED}; those figures were used.", names.join(", ")),
    })
}

/// Root mean square that half of the samples are in windows of no more than: coloured noise is in all windows, what a model misses may be in some.
fn typical_rms(stretches: &[&[f64]]) -> f64 {
    let square = |s: &&[f64]| s.iter().map(|r| r * r).sum::<f64>() / s.len().max(1) as f64;
    let mut each: Vec<(f64, usize)> = stretches.iter().map(|s| (square(s), s.len())).collect();
    each.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = each.iter().map(|s| s.1).sum::<usize>().div_ceil(2);
    let mut before = 0;
    let is_middle = |s: &&(f64, usize)| {
        before += s.1;
        before >= half
    };
    each.iter().find(is_middle).map_or(f64::NAN, |s| s.0.sqrt())
}

/// Factor at which the noise of a channel is its rounding.
fn least_factor(tapes: &[Tape], channel: &str) -> f64 {
    let own = tapes.iter().flat_map(|t| &t.readings).filter(|r| r.channel == channel && r.sigma > 0.0);
    own.map(|r| r.rounding / r.sigma).fold(0.0, f64::max)
}

/// Root mean squares of a channel's residuals, units of the σ in use.
#[derive(Clone, Copy, Debug)]
struct Found {
    /// Of what is white in them.
    white: f64,
    /// Whether all orders of difference agree about it.
    is_floor: bool,
    /// Of all of them, in the typical window.
    whole: f64,
    /// Whether they are those of a noise that soon forgets.
    forgets: bool,
}

/// Whether what is left is coloured as the noise of a filtered sensor is: alike from sample to sample, ever less so, and nowhere opposite, as what swings is.
fn forgets(stretches: &[&[f64]]) -> bool {
    let product = |s: &&[f64], lag: usize| s.iter().zip(s.iter().skip(lag)).map(|(a, b)| a * b).sum::<f64>();
    let pairs = |s: &&[f64], lag: usize| s.len().saturating_sub(lag) as f64;
    let of = |lag: usize| {
        let [all, count] = [product, pairs].map(|f| stretches.iter().map(|s| f(s, lag)).sum::<f64>());
        all / count.max(1.0)
    };
    let alike: Vec<f64> = (1..=MEMORY).map(|lag| of(lag) / of(0)).collect();
    alike.iter().all(|r| *r > -FORGOTTEN) && alike[MEMORY / 2..].iter().all(|r| *r < FORGOTTEN)
}

/// Samples over which noise is alike less and less, from half of which on it has forgotten what it was; and correlation that is none.
const MEMORY: usize = 24;
const FORGOTTEN: f64 = 0.1;

/// The factor of a channel's σ; none where the samples do not speak against it.
fn factor_of(Found { white, is_floor, whole, forgets }: Found, is_stated: bool) -> Option<f64> {
    let s = match is_stated {
        // Noise that is less than stated from one sample to the next may be coloured: only what is less as a whole is less.
        true if forgets => white.max(whole),
        true => white.max(whole.min(1.0)),
        // Raw samples bound the noise from above.
        false => white.min(1.0),
    };
    // More than twice the stated noise from one sample to the next may be a mismatch that is fast, but where all that is left is white, or
    // what is left has a white floor: what moves fast falls from one order of difference to the next.
    let is_white = whole <= (1.0 + SURE) * white || is_floor && (1.0..=FARTHEST_FLOOR).contains(&s);
    let is_beyond = is_stated && !is_white && !(1.0 / FARTHEST..=FARTHEST).contains(&s);
    (s.is_finite() && s > 0.0 && (s - 1.0).abs() >= SURE && !is_beyond).then_some(s)
}

/// Neighbouring residuals of one component.
struct Stretch {
    channel: String,
    values: Vec<f64>,
}

fn stretches_of(stage: &Stage<'_>, fit: &Fit, segment: &crate::linear::Segment) -> Vec<Stretch> {
    let tape = &stage.tapes[segment.run];
    let r = stage.residuals(&fit.built, segment);
    if tape.role != Role::Fit || r.iter().any(|x| !x.is_finite()) {
        return Vec::new();
    }
    let range = tape.range(segment.span);
    let mut all = Vec::new();
    for (k, reading) in tape.readings.iter().enumerate() {
        let own: Vec<usize> = range.clone().filter(|i| tape.events[*i].reading as usize == k).collect();
        let times: Vec<f64> = own.iter().map(|i| tape.events[*i].time).collect();
        let pause = PAUSE * median_step(&times).unwrap_or(f64::INFINITY);
        let is_next = |a: &usize, b: &usize| tape.events[*b].time - tape.events[*a].time <= pause;
        for stretch in own.chunk_by(is_next) {
            for component in 0..reading.width() {
                let value = |i: &usize| r[tape.offsets[*i] - tape.offsets[range.start] + component];
                all.push(Stretch { channel: reading.channel.clone(), values: stretch.iter().map(value).collect() });
            }
        }
    }
    all
}

/// Refuses a channel whose noise neither the recording nor its samples tell.
pub(crate) fn refuse_silent(tapes: &[Tape]) -> Result<(), DiagnoseError> {
    for tape in tapes {
        if let Some(reading) = tape.readings.iter().find(|r| r.sigma <= 0.0 || r.sigma.is_nan()) {
            return Err(DiagnoseError::Channel {
                channel: reading.channel.clone(),
                file: tape.file.clone(),
                reason: "shows no noise at all, nor rounding, and none is stated; give it in [noise] of recording.toml"
                    .to_owned(),
            });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_model_misses_in_some_windows_is_no_noise() {
        let (quiet, loud) = ([0.7; 20], [9.0; 19]);
        assert!((typical_rms(&[&quiet, &loud]) - 0.7).abs() < 1e-12);
        assert!((typical_rms(&[&quiet, &loud, &loud]) - 9.0).abs() < 1e-12, "in most");
        assert!(typical_rms(&[]).is_nan());
    }

    #[test]
    fn coloured_noise_forgets_and_what_swings_or_drifts_does_not() {
        let mut state = 1u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let white: Vec<f64> = (0..4000).map(|_| uniform()).collect();
        let coloured = |by: f64| {
            let mut last = 0.0;
            white
                .iter()
                .map(|w| {
                    last = by * last + w;
                    last
                })
                .collect::<Vec<f64>>()
        };
        let beside =
            |motion: fn(f64) -> f64| white.iter().enumerate().map(|(i, w)| w + motion(i as f64)).collect::<Vec<f64>>();
        assert!([0.0, 0.5, 0.8].iter().all(|by| forgets(&[&coloured(*by)])));
        assert!(!forgets(&[&coloured(0.97)]), "slow");
        assert!(!forgets(&[&beside(|i| (0.3 * i).sin())]), "what swings");
        assert!(!forgets(&[&beside(|i| (0.003 * i).sin())]), "what drifts");
    }

    #[test]
    fn a_stated_figure_is_believed_within_some_per_cent_and_left_by_far_only_for_white_noise() {
        let factor =
            |white, whole, is_stated| factor_of(Found { white, is_floor: false, whole, forgets: false }, is_stated);
        let with_floor = |white, whole| factor_of(Found { white, is_floor: true, whole, forgets: false }, true);
        assert_eq!([with_floor(3.0, 40.0), with_floor(0.3, 1.0), with_floor(9.0, 40.0)], [Some(3.0), None, None]);
        assert_eq!(factor(1.02, 1.02, true), None);
        assert_eq!(factor(1.43, 1.43, true), Some(1.43));
        assert_eq!(factor(0.67, 0.67, true), Some(0.67));
        assert_eq!([factor(5.0, 6.0, true), factor(0.3, 1.0, true), factor(f64::NAN, 1.0, true)], [None; 3]);
        assert_eq!([factor(5.0, 5.0, true), factor(0.3, 0.3, true)], [Some(5.0), Some(0.3)], "white as a whole");
        // Coloured: less from one sample to the next, as much as a whole.
        assert_eq!(factor(0.45, 1.0, true), None);
        let coloured = |white, whole| factor_of(Found { white, is_floor: false, whole, forgets: true }, true);
        assert_eq!(
            [coloured(0.75, 1.25), coloured(0.75, 40.0)],
            [Some(1.25), None],
            "more than stated, and soon forgotten"
        );
        // Raw samples bound it from above.
        assert_eq!([factor(3.0, 3.0, false), factor(0.2, 9.0, false)], [None, Some(0.2)]);
    }
}
