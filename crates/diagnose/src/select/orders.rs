//! Waves over place in what a model leaves: orders of a force that is periodic in where a joint is.
//!
//! A joint that goes far goes through many waves of a cogging, and no grid of orders is fine enough for that: a travel L tells orders that are 2π/L apart. So the
//! missing force f of a joint's coordinate says where to look. Over where the joint was, q, all runs together,
//!
//!   S(n) = what p₀ + p₁ q + a cos n q + b sin n q takes of Σ f² beyond p₀ + p₁ q      (Lomb 1976; floating mean: Zechmeister and Kürster 2009)
//!
//! has peaks that stand out of their surroundings. What swings within an interval of the missing force is not seen in it.

use super::lines::{is_felt, standing_out, told_apart};
use crate::facts::Facts;
use crate::identify::fit::{Fitted, Problem};
use crate::identify::track::{Interval, Track};
use crate::reading::{Reading, Value};
use nalgebra::{Matrix2, Matrix4, Vector2, Vector4};
use rayon::prelude::*;
use scenario::measure::Quantity;
use std::f64::consts::TAU;

/// Orders of a joint at most.
const MOST: usize = 2;
/// Waves in a joint's travel from which one is looked for here, and points of the grid by what the travel tells apart.
const WAVES: f64 = 1.0;
const BY_ORDER: f64 = 6.0;
/// Orders on both sides, in what the travel tells apart, whose median stands for the surroundings, and times it that a peak is.
const SURROUNDINGS: f64 = 8.0;
const LOUD: f64 = 10.0;
/// Samples that make a spectrum.
const FEWEST: usize = 32;
/// Points of the grid at most.
const LONGEST: usize = 4096;

/// Where a joint was, and the force that was missing there.
type Sample = (f64, f64);

/// Gives joints the orders at which what a fit leaves swings over their places, the loudest first.
pub fn give_orders(facts: &mut Facts, problem: &Problem<'_>, now: &Fitted) {
    for joint in &mut facts.joints {
        let Some(force) = problem.forces.iter().position(|f| f.acts_on(joint.coordinate)) else { continue };
        let of_run = |(k, track): (usize, &Track)| {
            let links = now.links.get(k).map_or(&[][..], |links| links.as_slice());
            let readings = &problem.stage.tapes[track.run].readings;
            let places = readings.iter().find(|r| r.quantity == Quantity::JointPosition(joint.coordinate));
            let places = places.filter(|_| is_felt(track, links, force));
            places.map_or_else(Vec::new, |places| samples(track, places, force))
        };
        let samples: Vec<Vec<Sample>> = now.tracks.iter().enumerate().map(of_run).collect();
        joint.orders = orders(&samples);
    }
}

/// Where a joint was in the middle of every interval, and the force there.
fn samples(track: &Track, places: &Reading, force: usize) -> Vec<Sample> {
    let of = |interval: &Interval| {
        let middle = 0.5 * (interval.span.from + interval.span.to);
        let after = places.times.partition_point(|t| *t < middle);
        let place = |k: usize| places.values.get(k).map(Value::scalar).filter(|x| x.is_finite());
        let (t, x) = (&places.times, [place(after.checked_sub(1)?)?, place(after)?]);
        let share = (middle - t[after - 1]) / (t[after] - t[after - 1]);
        Some((x[0] + share * (x[1] - x[0]), interval.force[force]))
    };
    track.intervals.iter().filter_map(of).collect()
}

/// Orders of waves in forces over places, of some runs, the loudest first.
fn orders(runs: &[Vec<Sample>]) -> Vec<f64> {
    let all: Vec<Sample> = runs.concat();
    let [low, high] =
        all.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], s| [low.min(s.0), high.max(s.0)]);
    let travel = high - low;
    let Some(fastest) = step(runs).filter(|s| *s > 0.0 && all.len() >= FEWEST && travel > 0.0) else {
        return Vec::new();
    };
    let apart = TAU / travel;
    // Half a wave in a step of the faster ones is the last that they show. Before the first point there is none, so that it may be a peak.
    let count = ((0.5 * TAU / fastest / apart - WAVES) * BY_ORDER).clamp(0.0, LONGEST as f64) as usize;
    let waves: Vec<f64> = (0..=count).map(|k| WAVES + (k as f64 - 1.0) / BY_ORDER).collect();
    let centred: Vec<Sample> = all.iter().map(|(q, f)| ((q - low) / travel - 0.5, *f)).collect();
    let line = taken_by_line(&centred);
    let taken = |n: &f64| (taken_with_wave(&centred, TAU * n) - line).max(0.0);
    let mut power: Vec<f64> = waves.par_iter().map(taken).collect();
    power[0] = 0.0;
    let mut peaks = standing_out(&waves, &power, (SURROUNDINGS * BY_ORDER) as usize, LOUD);
    peaks.sort_by(|a, b| b.1.total_cmp(&a.1));
    // Within twice what the travel tells apart is the foot of a peak.
    told_apart(peaks.into_iter().map(|p| p.0 * apart), 0.5 / apart, MOST)
}

/// How far a joint goes from one sample to the next, as nine of ten do not exceed.
fn step(runs: &[Vec<Sample>]) -> Option<f64> {
    let mut steps: Vec<f64> = runs.iter().flat_map(|r| r.windows(2).map(|w| (w[1].0 - w[0].0).abs())).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() * 9 / 10).copied()
}

/// What a line takes of the squares of some forces.
fn taken_by_line(samples: &[Sample]) -> f64 {
    let (mut a, mut b) = (Matrix2::zeros(), Vector2::zeros());
    for (q, f) in samples {
        let row = Vector2::new(1.0, *q);
        a += row * row.transpose();
        b += row * *f;
    }
    a.try_inverse().map_or(0.0, |inverse| b.dot(&(inverse * b)))
}

/// What a line and a wave take of them.
fn taken_with_wave(samples: &[Sample], order: f64) -> f64 {
    let (mut a, mut b) = (Matrix4::zeros(), Vector4::zeros());
    for (q, f) in samples {
        let (sine, cosine) = (order * q).sin_cos();
        let row = Vector4::new(1.0, *q, cosine, sine);
        a += row * row.transpose();
        b += row * *f;
    }
    a.try_inverse().map_or(0.0, |inverse| b.dot(&(inverse * b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    /// Three runs of a joint that swings to and fro, with a spring, and a wave of so much and of such an order over its place.
    fn seen(travel: f64, amplitude: f64, order: f64) -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let mut run = |rate: f64| -> Vec<Sample> {
            let mut sample = |k: usize| {
                let q = 0.3 + 0.5 * travel * (rate * 0.02 * k as f64).sin();
                let noise: f64 = StandardNormal.sample(&mut random);
                (q, 5.0 - 2.0 * q / travel + amplitude * (order * q + 0.7).sin() + 0.2 * noise)
            };
            (0..400).map(&mut sample).collect()
        };
        let runs = [run(0.9), run(1.3), run(0.7)];
        orders(&runs)
    }

    #[test]
    fn a_wave_over_place_is_seen_where_a_joint_goes_through_few_of_them_and_through_many() {
        for (travel, order) in [(0.63, 12.0), (0.5, 196.0)] {
            let loudest = seen(travel, 1.0, order).first().copied().unwrap_or(f64::NAN);
            assert!((loudest - order).abs() < 0.25 * TAU / travel, "{loudest} for {order}");
        }
    }

    #[test]
    fn a_spring_and_noise_have_no_waves() {
        assert!(seen(0.63, 0.0, 1.0).is_empty());
    }
}
