//! Which channels belong together, and their samples.

use super::track::{Measured, Track};
use crate::{ChannelName, Quantity, RecordedRun, RecordingSet, Series};
use rayon::prelude::*;
use spatial::nalgebra::Quaternion;
use spatial::{Rot, Vec3};
use std::collections::BTreeSet;

/// A position and the rate that should be its derivative.
#[derive(Clone, Debug)]
pub(super) struct Pair {
    pub(super) position: String,
    pub(super) rate: String,
    /// Channels of the position; of an orientation w, x, y, z.
    pub(super) position_channels: Vec<String>,
    pub(super) rate_channels: Vec<String>,
    pub(super) axes: usize,
    pub(super) is_rotation: bool,
}

/// Standard deviations of a pair.
#[derive(Clone, Copy, Debug)]
pub(super) struct Noise {
    /// Of the position about each axis.
    pub(super) position: f64,
    /// Of the rate.
    pub(super) rate: f64,
}

/// All pairs of a set, sorted.
pub(super) fn find(set: &RecordingSet) -> Vec<Pair> {
    let channels: BTreeSet<&str> = set.runs.iter().flat_map(|run| &run.series).map(|s| s.channel.as_str()).collect();
    let mut pairs = Vec::new();
    for channel in &channels {
        let Some(name) = ChannelName::parse(channel).filter(|name| matches!(name.component, "" | "x")) else {
            continue;
        };
        let subject = |quantity: &str| format!("{}.{}.{quantity}", name.family(), name.subject);
        let named = |prefix: &str, parts: &[&str]| parts.iter().map(|c| format!("{prefix}{c}")).collect::<Vec<_>>();
        let (position, parts, is_rotation): (String, &[&str], bool) = match name.quantity {
            Quantity::JointVelocity => (subject("position"), &[""], false),
            Quantity::JointLinkVelocity => (subject("link_position"), &[""], false),
            Quantity::BodyLinearVelocity => (subject("position"), &[".x", ".y", ".z"], false),
            Quantity::BodyAngularVelocity => (subject("orientation"), &[".x", ".y", ".z"], true),
            _ => continue,
        };
        let present = |name: &String| channels.contains(name.as_str());
        let rate_channels: Vec<String> = named(name.prefix, parts).into_iter().filter(present).collect();
        let wanted = if is_rotation { named(&position, &[".w", ".x", ".y", ".z"]) } else { named(&position, parts) };
        let position_channels: Vec<String> = wanted.into_iter().filter(present).collect();
        let axes = rate_channels.len();
        if position_channels.len() == axes + usize::from(is_rotation) && (!is_rotation || axes == 3) {
            let rate = name.prefix.to_owned();
            pairs.push(Pair { position, rate, position_channels, rate_channels, axes, is_rotation });
        }
    }
    pairs
}

/// Noise of a pair; the components of one sensor share theirs.
pub(super) fn noise(pair: &Pair, sigma: &super::Sigma<'_>) -> Option<Noise> {
    let mean_square = |channels: &[String]| {
        let squares: Option<Vec<f64>> = channels.iter().map(|c| sigma(c).map(|s| s * s)).collect();
        squares.map(|s| (s.iter().sum::<f64>() / s.len() as f64).sqrt())
    };
    let (position, rate) = (mean_square(&pair.position_channels)?, mean_square(&pair.rate_channels)?);
    (position > 0.0 && rate > 0.0).then_some(Noise { position, rate })
}

/// The samples of a pair, run by run.
pub(super) fn tracks(set: &RecordingSet, pair: &Pair, noise: &Noise) -> Vec<Track> {
    set.runs.par_iter().filter_map(|run| track(run, pair, noise)).collect()
}

fn track(run: &RecordedRun, pair: &Pair, noise: &Noise) -> Option<Track> {
    let (times, positions) = together(run, &pair.position_channels)?;
    let (rate_times, rates) = together(run, &pair.rate_channels)?;
    let vector = |row: &[f64; 4]| Vec3::new(row[0], row[1], row[2]);
    let measured = match pair.is_rotation {
        true => Measured::Rotation(
            positions.iter().map(|q| Rot::new_normalize(Quaternion::new(q[0], q[1], q[2], q[3]))).collect(),
        ),
        false => Measured::Vector(positions.iter().map(vector).collect()),
    };
    Track::new(times, measured, rate_times, rates.iter().map(vector).collect(), noise.rate)
}

/// Instants at which all of these channels were sampled, and their values.
fn together(run: &RecordedRun, channels: &[String]) -> Option<(Vec<f64>, Vec<[f64; 4]>)> {
    let series: Option<Vec<&Series>> = channels.iter().map(|c| run.series(c)).collect();
    let series = series?;
    let first = series.first()?;
    let mut at = vec![0_usize; series.len()];
    let (mut times, mut rows) = (Vec::new(), Vec::new());
    for t in first.times.iter() {
        let mut row = [0.0; 4];
        let mut whole = true;
        for ((one, at), cell) in series.iter().zip(&mut at).zip(&mut row) {
            while one.times.get(*at).is_some_and(|other| other < t) {
                *at += 1;
            }
            match one.times.get(*at) == Some(t) {
                true => *cell = one.values[*at],
                false => whole = false,
            }
        }
        if whole {
            times.push(*t);
            rows.push(row);
        }
    }
    Some((times, rows))
}
