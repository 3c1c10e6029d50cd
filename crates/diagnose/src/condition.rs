//! Under which conditions a mismatch lives: when, and on what the missing force depends.
//!
//! When: from the first to the last window that the nominal model misses by more than noise. On what: the missing force of a place, window by
//! window with its error, against one quantity at a time (time, places, speeds, ways gone), by weighted least squares; the quantity that
//! explains most of its variance is named where that is most of it.

use crate::fit::Fit;
use crate::linear::{Segment, Stage};
use crate::locate::{Located, WindowForce};
use crate::reading::{Reading, Value};
use crate::replay::Span;
use crate::stretches::is_missed;
use crate::tape::Tape;
use rayon::prelude::*;
use scenario::measure::Quantity;
use spatial::Vec3;

/// Share of the variance that a quantity must explain to be named.
const NAMED: f64 = 0.6;
/// Windows that a regression wants at least.
const WINDOWS: usize = 8;
/// Parts of a window in which samples are averaged before a way is measured: noise shall not count as way.
const PARTS: usize = 8;

/// First and last instant that a model misses in any run, s; the whole span where no window stands out, or those that do hold less than
/// most of what is amiss: a mismatch that is slow hides in every window.
pub(crate) fn when(stage: &Stage<'_>, fit: &Fit) -> (f64, f64) {
    let end = stage.tapes.iter().map(|t| t.span.1).fold(0.0, f64::max);
    let excess_of = |s: &Segment| {
        let r = stage.residuals(&fit.built, s);
        (r.norm_squared() - r.len() as f64, is_missed(r.norm_squared(), r.len()))
    };
    let all: Vec<(f64, bool)> = fit.segments.par_iter().map(excess_of).collect();
    let whole: f64 = all.iter().map(|w| w.0).sum();
    let missed = || fit.segments.iter().zip(&all).filter(|(_, w)| w.1);
    let held: f64 = missed().map(|(_, w)| w.0).sum();
    let (from, to) = missed()
        .fold((f64::INFINITY, 0.0), |(from, to): (f64, f64), (s, _)| (from.min(s.span.from), to.max(s.span.to)));
    if from < to && held > MOST * whole { (from, to) } else { (0.0, end) }
}

/// Share of what is amiss that makes most of it.
const MOST: f64 = 0.8;

/// What a place's missing force depends on, in words with the share of its variance; none where nothing stands out.
pub(crate) fn dependence(features: &Features, nominal: &Fit, located: &Located, place: &str) -> Option<String> {
    let at = located.places.iter().position(|p| p.name == place)?;
    let Dependence { name, share, .. } = find_dependence(features, nominal, located, (at, located.strongest(at)))?;
    (share > NAMED).then(|| format!("changes with {name} (R² {share:.2})"))
}

/// The quantity that explains most of a missing force.
pub(crate) struct Dependence {
    /// The quantity.
    pub name: String,
    /// Share of the force's variance that a straight line in it predicts in runs that the line was not fitted to.
    pub share: f64,
    /// Its value in each window; NaN where it was not measured.
    pub values: Vec<f64>,
}

/// By window: names and values of what a missing force may depend on.
pub(crate) type Features = Vec<Vec<(String, f64)>>;

/// Those of a fit's windows.
pub(crate) fn find_features(stage: &Stage<'_>, fit: &Fit) -> Features {
    fit.segments.iter().map(|s| features(&stage.tapes[s.run], s.span)).collect()
}

/// Looks for it among times, places, speeds and ways gone; `column` is the place and which of its numbers.
pub(crate) fn find_dependence(
    all: &Features,
    nominal: &Fit,
    located: &Located,
    (place, column): (usize, usize),
) -> Option<Dependence> {
    let of = |k: usize| {
        let values: Vec<f64> = all.iter().map(|f| f.get(k).map_or(f64::NAN, |f| f.1)).collect();
        let point = |(i, windows): (usize, &Vec<WindowForce>)| {
            let (y, error) = (*windows[place].estimate.get(column)?, *windows[place].error.get(column)?);
            let is_told = error > 0.0 && values[i].is_finite();
            is_told.then_some(Point { run: nominal.segments[i].run, x: values[i], y, weight: error.powi(-2) })
        };
        let mut points: Vec<Point> = located.windows.iter().enumerate().filter_map(point).collect();
        (calc_share(&mut points), values)
    };
    let names = all.first()?.iter().map(|(name, _)| name.clone());
    let told = names.enumerate().map(|(k, name)| {
        let (share, values) = of(k);
        Dependence { name, share, values }
    });
    told.max_by(|a, b| a.share.total_cmp(&b.share))
}

/// A window's missing force against a quantity.
#[derive(Clone, Copy)]
struct Point {
    run: usize,
    x: f64,
    y: f64,
    weight: f64,
}

/// Weighted share of the variance that a straight line predicts, each run by the line of the others. No window outvotes all others: weights
/// are bounded by ten times their median.
fn calc_share(points: &mut [Point]) -> f64 {
    if points.len() < WINDOWS {
        return 0.0;
    }
    points.sort_by(|a, b| a.weight.total_cmp(&b.weight));
    let most = 10.0 * points[points.len() / 2].weight;
    points.iter_mut().for_each(|p| p.weight = p.weight.min(most));
    let mut runs: Vec<usize> = points.iter().map(|p| p.run).collect();
    runs.sort_unstable();
    runs.dedup();
    let (_, mean, _) = line(points.iter());
    let left = |run: &usize| {
        let others = points.iter().filter(|p| p.run != *run || runs.len() == 1);
        let (x, y, slope) = line(others);
        let own = points.iter().filter(|p| p.run == *run);
        own.map(|p| p.weight * (p.y - y - slope * (p.x - x)).powi(2)).sum::<f64>()
    };
    let all: f64 = points.iter().map(|p| p.weight * (p.y - mean).powi(2)).sum();
    if all > 0.0 { (1.0 - runs.iter().map(left).sum::<f64>() / all).max(0.0) } else { 0.0 }
}

/// The weighted line of some points: its middle and its slope.
fn line<'a>(points: impl Iterator<Item = &'a Point> + Clone) -> (f64, f64, f64) {
    let sum = |f: &dyn Fn(&Point) -> f64| points.clone().map(|p| p.weight * f(p)).sum::<f64>();
    let all = sum(&|_| 1.0);
    let (x, y) = (sum(&|p| p.x) / all, sum(&|p| p.y) / all);
    let (xx, xy) = (sum(&|p| (p.x - x).powi(2)), sum(&|p| (p.x - x) * (p.y - y)));
    (x, y, if xx > 0.0 { xy / xx } else { 0.0 })
}

/// Quantities of a window that a missing force may depend on: name and value.
fn features(tape: &Tape, span: Span) -> Vec<(String, f64)> {
    let mut all = vec![("time".to_owned(), 0.5 * (span.from + span.to) - tape.span.0)];
    for reading in &tape.readings {
        let is_place = matches!(
            reading.quantity,
            Quantity::Position(..) | Quantity::JointPosition(_) | Quantity::JointLinkPosition(_)
        );
        let is_rate = matches!(
            reading.quantity,
            Quantity::LinearVelocity(..)
                | Quantity::AngularVelocity(..)
                | Quantity::JointVelocity(_)
                | Quantity::JointLinkVelocity(_)
        );
        if !is_place && !is_rate {
            continue;
        }
        let mean = mean_of(reading, span);
        let component = |(k, axis): (usize, &usize)| (reading.component(k), mean.map_or(f64::NAN, |m| m[*axis]));
        all.extend(reading.axes.iter().enumerate().map(component));
        if is_rate {
            continue;
        }
        let gone = way(reading, Span { from: tape.span.0, to: 0.5 * (span.from + span.to) }, span.to - span.from);
        let within = way(reading, span, span.to - span.from);
        all.push((format!("the way that {} has gone", reading.channel), gone));
        all.push((format!("the speed of {}", reading.channel), within / (span.to - span.from)));
    }
    all
}

fn mean_of(reading: &Reading, span: Span) -> Option<Vec3> {
    let range = reading.times.partition_point(|t| *t < span.from)..reading.times.partition_point(|t| *t < span.to);
    let vectors = reading.values[range].iter().filter_map(|v| match v {
        Value::Vector(v) => Some(*v),
        Value::Rotation(_) => None,
    });
    let (sum, count) = vectors.fold((Vec3::zeros(), 0), |(sum, n), v| (sum + v, n + 1));
    (count > 0).then(|| sum / f64::from(count))
}

/// Length of the way through the means of a stretch's parts, m or rad.
fn way(reading: &Reading, span: Span, window: f64) -> f64 {
    let count = (PARTS as f64 * (span.to - span.from) / window).round().max(1.0) as usize;
    let at = |i: usize| span.from + (span.to - span.from) * i as f64 / count as f64;
    let means: Vec<Vec3> = (0..count).filter_map(|i| mean_of(reading, Span { from: at(i), to: at(i + 1) })).collect();
    means.windows(2).map(|w| (w[1] - w[0]).norm()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_explains_all_of_its_variance_and_noise_little() {
        let points = |y: &dyn Fn(u32) -> f64| -> Vec<Point> {
            let of = |i: u32| Point { run: i as usize / 10, x: f64::from(i % 10), y: y(i), weight: 1.0 };
            (0..20).map(of).collect()
        };
        assert!((calc_share(&mut points(&|i| 3.0 + 0.5 * f64::from(i % 10))) - 1.0).abs() < 1e-12);
        assert!(calc_share(&mut points(&|i| f64::from(i % 2))) < 0.05);
        assert_eq!(calc_share(&mut points(&f64::from)[..3]), 0.0);
        // What goes up in one run and down in the other is not predicted.
        let sign = |i: u32| if i < 10 { 1.0 } else { -1.0 };
        assert_eq!(calc_share(&mut points(&|i| sign(i) * f64::from(i % 10))), 0.0);
    }
}
