//! One run of a pair: positions, rates, and the rates' smoothed values and slopes.
//!
//! What multiplies a fitted figure (the rate for a scale, its slope for a delay) is taken from a local parabola (Savitzky
//! and Golay 1964), not from the readings: their own noise would correlate with the position error that it causes, and a
//! joint at rest would seem to have a delay of half a sample. The parabola spans 15 samples, or more where the motion is
//! so slow that a longer one leaves no more than the noise.

use spatial::{Rot, Vec3};

/// Samples on either side of the local parabola, shortest first.
const HALVES: [usize; 4] = [7, 14, 28, 56];
/// Mean square distance of the readings from a parabola, in units of their noise, that is noise alone.
const SMOOTH: f64 = 1.05;
/// A pause longer than this many median steps ends what can be integrated.
const PAUSE: f64 = 4.5;

/// What was measured of the position.
#[derive(Clone, Debug)]
pub(super) enum Measured {
    /// Components; unused ones are 0.
    Vector(Vec<Vec3>),
    /// Body to world.
    Rotation(Vec<Rot>),
}

/// A run.
#[derive(Clone, Debug)]
pub(super) struct Track {
    pub(super) times: Vec<f64>,
    pub(super) measured: Measured,
    pub(super) rate_times: Vec<f64>,
    pub(super) rates: Vec<Vec3>,
    pub(super) smooth: Vec<Vec3>,
    pub(super) slopes: Vec<Vec3>,
    /// Error of the trapezoid from here to the next sample beyond noise, in units of rate: bends of the rate.
    pub(super) bends: Vec<Vec3>,
    /// Median time between rates, s.
    pub(super) step: f64,
    /// Samples on either side of the parabola.
    half: usize,
}

impl Track {
    /// A run with enough rates to smooth; none otherwise.
    pub(super) fn new(
        times: Vec<f64>,
        measured: Measured,
        rate_times: Vec<f64>,
        rates: Vec<Vec3>,
        rate_noise: f64,
    ) -> Option<Self> {
        if rates.len() < 2 * HALVES[0] + 1 || times.len() < 3 {
            return None;
        }
        let mut steps: Vec<f64> = rate_times.windows(2).map(|t| t[1] - t[0]).collect();
        let middle = steps.len() / 2;
        let step = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
        let (half, smooth, slopes) = smoothed(&rate_times, &rates, rate_noise);
        let bends = (0..rates.len()).map(|i| bend(&rates, i, rate_noise)).collect();
        Some(Self { times, measured, rate_times, rates, smooth, slopes, bends, step, half })
    }

    /// Standard deviation of a smoothed rate: √(3(3m² + 3m − 1) / ((2m−1)(2m+1)(2m+3))) σ, m = half.
    pub(super) fn value_noise(&self, rate_noise: f64) -> f64 {
        let m = self.half as f64;
        rate_noise
            * (3.0 * (3.0 * m * m + 3.0 * m - 1.0) / ((2.0 * m - 1.0) * (2.0 * m + 1.0) * (2.0 * m + 3.0))).sqrt()
    }

    /// Standard deviation of a slope: σ / (dt √Σk²), k = −m … m.
    pub(super) fn slope_noise(&self, rate_noise: f64) -> f64 {
        let m = self.half as f64;
        rate_noise / (self.step * (m * (m + 1.0) * (2.0 * m + 1.0) / 3.0).sqrt())
    }

    /// Index of the last rate at or before `t`, if the next one follows without a pause.
    pub(super) fn interval(&self, t: f64) -> Option<usize> {
        let after = self.rate_times.partition_point(|time| *time <= t);
        let (at, next) = (after.checked_sub(1)?, after.min(self.rate_times.len() - 1));
        let pause = self.rate_times[next] - self.rate_times[at];
        (pause <= PAUSE * self.step && (next > at || t == self.rate_times[at])).then_some(at)
    }

    /// Values of one of the rate's arrays at `t` in interval `i`, linear in between.
    pub(super) fn at(&self, values: &[Vec3], i: usize, t: f64) -> Vec3 {
        let Some(next) = values.get(i + 1) else { return values[i] };
        let width = self.rate_times[i + 1] - self.rate_times[i];
        let share = ((t - self.rate_times[i]) / width).clamp(0.0, 1.0);
        values[i] + (next - values[i]) * share
    }
}

/// The longest parabola that leaves no more than noise, its values and slopes.
fn smoothed(times: &[f64], rates: &[Vec3], noise: f64) -> (usize, Vec<Vec3>, Vec<Vec3>) {
    let with =
        |half: usize| -> (Vec<Vec3>, Vec<Vec3>) { (0..rates.len()).map(|i| parabola(times, rates, i, half)).unzip() };
    let (mut half, (mut values, mut slopes)) = (HALVES[0], with(HALVES[0]));
    for longer in HALVES.into_iter().skip(1).filter(|longer| rates.len() > 4 * longer) {
        let (smoother, flatter) = with(longer);
        let square = |axis: usize| rates.iter().zip(&smoother).map(|(r, s)| (r[axis] - s[axis]).powi(2)).sum::<f64>();
        let worst = (0..3).map(square).fold(0.0, f64::max) / rates.len() as f64;
        if worst > SMOOTH * noise * noise {
            break;
        }
        (half, values, slopes) = (longer, smoother, flatter);
    }
    (half, values, slopes)
}

/// Value and slope at sample `i` of the parabola through its neighbourhood, shifted inwards at the ends.
fn parabola(times: &[f64], rates: &[Vec3], i: usize, half: usize) -> (Vec3, Vec3) {
    let start = i.saturating_sub(half).min(rates.len() - 2 * half - 1);
    let window = start..start + 2 * half + 1;
    let scale = (times[window.end - 1] - times[start]).max(f64::MIN_POSITIVE);
    let mut sums = [0.0; 5];
    let mut moments = [Vec3::zeros(); 3];
    for k in window {
        let x = (times[k] - times[i]) / scale;
        let powers = [1.0, x, x * x, x * x * x, x * x * x * x];
        sums.iter_mut().zip(powers).for_each(|(sum, power)| *sum += power);
        moments.iter_mut().zip(powers).for_each(|(moment, power)| *moment += rates[k] * power);
    }
    let normal = spatial::Mat3::new(sums[0], sums[1], sums[2], sums[1], sums[2], sums[3], sums[2], sums[3], sums[4]);
    let Some(inverse) = normal.try_inverse() else { return (rates[i], Vec3::zeros()) };
    let row = |r: usize| moments[0] * inverse[(r, 0)] + moments[1] * inverse[(r, 1)] + moments[2] * inverse[(r, 2)];
    (row(0), row(1) / scale)
}

/// Second difference beyond six standard deviations of its noise, √6 σ: an impact between two samples.
fn bend(rates: &[Vec3], i: usize, noise: f64) -> Vec3 {
    let (before, after) = (rates[i.saturating_sub(1)], rates[(i + 1).min(rates.len() - 1)]);
    let second = before - rates[i] * 2.0 + after;
    second.map(|x| (x.abs() - 6.0 * 6.0_f64.sqrt() * noise).max(0.0))
}
