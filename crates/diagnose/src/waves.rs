//! What swings in the missing force of windows: frequencies at which a wave is worth a look.
//!
//! A window tells of a force at a place its mean and half a wave each, e ± A⁻¹, wherever it is told at all: where friction holds A is next to nothing. A wave of any
//! frequency f is, within a window, nearly a sum of those three, p cos and p sin by least squares in time, so that over the windows of a run
//!
//!   S(f) = max over a of Σ_windows 2 gᵀ A e − gᵀ A g,      g = Σ_axes a₁ p_cos + a₂ p_sin
//!
//! is the periodogram of what was told (Lomb 1976; Scargle 1982), of all runs the sum. Its peaks stand out of their surroundings; what they are worth is for the
//! screen to say.

use crate::fit::pseudo_inverse;
use crate::locate::{Located, WindowForce};
use crate::replay::Span;
use crate::select::lines::{standing_out, told_apart};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// Waves at most.
const MOST: usize = 3;
/// Cycles in a run that make a wave, and in a window up to which the three functions follow it.
const CYCLES: f64 = 3.0;
const FOLLOWED: f64 = 1.5;
/// Frequencies by bin of a run's length, and bins whose median stands for the surroundings.
const BY_BIN: f64 = 4.0;
const SURROUNDINGS: usize = 16;
/// Times its surroundings that a peak is.
const LOUD: f64 = 3.0;
/// Instants of a window at which functions are compared.
const INSTANTS: usize = 12;

/// Frequencies of waves in the missing force of some windows, each with its run, of so many seconds; Hz, the loudest first.
pub(crate) fn waves(located: &Located, windows: &[(usize, Span)], window: f64) -> Vec<f64> {
    let runs: BTreeSet<usize> = windows.iter().map(|w| w.0).collect();
    let length = |run: usize| {
        let own = || windows.iter().filter(move |w| w.0 == run).map(|w| w.1);
        own().map(|s| s.to).fold(f64::NEG_INFINITY, f64::max) - own().map(|s| s.from).fold(f64::INFINITY, f64::min)
    };
    let longest = runs.iter().map(|run| length(*run)).fold(0.0, f64::max);
    if longest <= 0.0 {
        return Vec::new();
    }
    let grid: Vec<f64> =
        (1..).map(|k| (CYCLES + f64::from(k) / BY_BIN) / longest).take_while(|f| *f < FOLLOWED / window).collect();
    let places = (0..located.places.len()).filter(|p| located.places[*p].is_told_in_waves());
    let mut peaks: Vec<(f64, f64)> = places
        .flat_map(|place| {
            let told: Vec<Vec<Told<'_>>> = runs.iter().map(|run| told(located, windows, (*run, place))).collect();
            let score = |f: &f64| told.iter().map(|run| gain(run, *f, window)).sum::<f64>();
            let power: Vec<f64> = grid.par_iter().map(score).collect();
            // Where samples are missing at a beat, a wave has lesser ones beside it.
            standing_out(&grid, &power, SURROUNDINGS * BY_BIN as usize / 2, LOUD)
        })
        .collect();
    peaks.sort_by(|a, b| b.1.total_cmp(&a.1));
    told_apart(peaks.into_iter().map(|p| p.0), longest, MOST)
}

/// What one window tells of a place.
struct Told<'a> {
    span: Span,
    information: &'a DMatrix<f64>,
    /// A e.
    pull: DVector<f64>,
}

fn told<'a>(located: &'a Located, windows: &[(usize, Span)], (run, place): (usize, usize)) -> Vec<Told<'a>> {
    let of = |((own, span), forces): (&(usize, Span), &'a Vec<WindowForce>)| {
        let WindowForce { information, estimate, .. } = &forces[place];
        let pull = information * DVector::from_column_slice(estimate);
        let is_told = *own == run && pull.iter().all(|x| x.is_finite());
        is_told.then_some(Told { span: *span, information, pull })
    };
    windows.iter().zip(&located.windows).filter_map(of).collect()
}

/// What a wave takes off the cost of the windows of a run.
fn gain(run: &[Told<'_>], f: f64, window: f64) -> f64 {
    let Some(first) = run.first() else { return 0.0 };
    let axes = first.pull.len() / 3;
    let (mut a, mut b) = (DMatrix::zeros(2 * axes, 2 * axes), DVector::zeros(2 * axes));
    for told in run {
        let parts = parts_of(told.span, f, window);
        let mut p = DMatrix::zeros(3 * axes, 2 * axes);
        (0..axes).for_each(|k| {
            parts.iter().enumerate().for_each(|(c, part)| p.view_mut((3 * k, 2 * k + c), (3, 1)).copy_from(part))
        });
        a += p.transpose() * told.information * &p;
        b += p.transpose() * &told.pull;
    }
    b.dot(&(pseudo_inverse(&a) * &b))
}

/// A cosine and a sine as sums of the three functions of a window.
fn parts_of(span: Span, f: f64, window: f64) -> [Vector3<f64>; 2] {
    let half = 0.5 / window;
    let (mut gram, mut of) = (Matrix3::zeros(), [Vector3::zeros(); 2]);
    for i in 0..INSTANTS {
        let t = span.from + (span.to - span.from) * (i as f64 + 0.5) / INSTANTS as f64;
        let own = Vector3::new(1.0, (TAU * half * t).cos(), (TAU * half * t).sin());
        gram += own * own.transpose();
        let (sine, cosine) = (TAU * f * t).sin_cos();
        of[0] += own * cosine;
        of[1] += own * sine;
    }
    let inverse = gram.try_inverse().unwrap_or_else(Matrix3::zeros);
    of.map(|x| inverse * x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facts::Facts;
    use crate::locate::places;

    const WINDOW: f64 = 0.25;

    /// Windows of three runs of 12 s at a joint that is held by friction two thirds of the time, and swings at 3.1 Hz by so much.
    fn seen(amplitude: f64) -> Vec<f64> {
        let (mut spans, mut windows) = (Vec::new(), Vec::new());
        let mut state = 7u64;
        let mut noise = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        for run in 0..3 {
            for k in 0..48 {
                let span = Span { from: WINDOW * f64::from(k), to: WINDOW * f64::from(k + 1) };
                let is_held = (k / 3 + run as i32) % 3 != 0;
                let [_, sine] = parts_of(span, 3.1, WINDOW);
                let estimate: Vec<f64> = (0..3).map(|c| amplitude * sine[c] + noise()).collect();
                let information = DMatrix::identity(3, 3) * if is_held { 1e-6 } else { 1.0 };
                windows.push(vec![WindowForce { score: 0.0, rank: 3, estimate, error: vec![1.0; 3], information }]);
                spans.push((run, span));
            }
        }
        let places = places(&Facts::of_joints(1), WINDOW);
        waves(&Located { places, windows, together: Vec::new() }, &spans, WINDOW)
    }

    #[test]
    fn a_wave_is_seen_through_what_holds_two_thirds_of_the_time() {
        let loudest = seen(3.0).first().copied().unwrap_or(f64::NAN);
        assert!((loudest - 3.1).abs() < 0.5 / 12.0, "{loudest}");
    }

    #[test]
    fn a_window_follows_a_wave_of_its_own_length() {
        // Of a wave whose half is the window all is followed.
        let [cosine, sine] = parts_of(Span { from: 1.0, to: 1.25 }, 0.5 / WINDOW, WINDOW);
        assert!(
            (cosine - Vector3::new(0.0, 1.0, 0.0)).norm() < 1e-9 && (sine - Vector3::new(0.0, 0.0, 1.0)).norm() < 1e-9
        );
    }
}
