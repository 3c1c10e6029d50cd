//! Under which conditions a mismatch lives: when, and on what the missing force depends.
//!
//! When: from the first to the last window that the nominal model misses by more than noise. On what: the missing force of a place, window by
//! window with its error, against one quantity at a time (time, places, speeds, ways gone), by weighted least squares; the quantity that
//! explains most of its variance is named where that is most of it.

use crate::fit::Fit;
use crate::linear::Stage;
use crate::locate::{Located, WindowForce};
use crate::reading::{Reading, Value};
use crate::replay::Span;
use crate::stretches::is_missed;
use crate::tape::Tape;
use scenario::measure::Quantity;
use spatial::Vec3;

/// Share of the variance that a quantity must explain to be named.
const NAMED: f64 = 0.6;
/// Windows that a regression wants at least.
const WINDOWS: usize = 8;
/// Parts of a window in which samples are averaged before a way is measured: noise shall not count as way.
const PARTS: usize = 8;

/// First and last instant that the nominal model misses in any run, s; the whole span where no window stands out.
pub(crate) fn when(stage: &Stage<'_>, nominal: &Fit) -> (f64, f64) {
    let end = stage.tapes.iter().map(|t| t.span.1).fold(0.0, f64::max);
    let missed = nominal.segments.iter().filter(|s| {
        let r = stage.residuals(&nominal.built, s);
        is_missed(r.norm_squared(), r.len())
    });
    let (from, to) =
        missed.fold((f64::INFINITY, 0.0), |(from, to): (f64, f64), s| (from.min(s.span.from), to.max(s.span.to)));
    if from < to { (from, to) } else { (0.0, end) }
}

/// What a place's missing force depends on, in words with the share of its variance; none where nothing stands out.
pub(crate) fn dependence(stage: &Stage<'_>, nominal: &Fit, located: &Located, place: &str) -> Option<String> {
    let at = located.places.iter().position(|p| p.name == place)?;
    let all: Vec<Vec<(String, f64)>> = nominal.segments.iter().map(|s| features(&stage.tapes[s.run], s.span)).collect();
    let share_of = |k: usize| {
        let point = |(features, windows): (&Vec<(String, f64)>, &Vec<WindowForce>)| {
            let (force, (_, feature)) = (&windows[at], features.get(k)?);
            let (estimate, error) = (*force.estimate.first()?, *force.error.first()?);
            (error > 0.0 && feature.is_finite()).then_some((*feature, estimate, error.powi(-2)))
        };
        calc_share(&mut all.iter().zip(&located.windows).filter_map(point).collect::<Vec<_>>())
    };
    let names = all.first()?.iter().map(|(name, _)| name);
    let (share, name) = names.enumerate().map(|(k, name)| (share_of(k), name)).max_by(|a, b| a.0.total_cmp(&b.0))?;
    (share > NAMED).then(|| format!("changes with {name} (R² {share:.2})"))
}

/// Weighted share of the variance that a straight line explains. No window outvotes all others: weights are bounded by ten times their median.
fn calc_share(points: &mut [(f64, f64, f64)]) -> f64 {
    if points.len() < WINDOWS {
        return 0.0;
    }
    points.sort_by(|a, b| a.2.total_cmp(&b.2));
    let most = 10.0 * points[points.len() / 2].2;
    points.iter_mut().for_each(|p| p.2 = p.2.min(most));
    let sum = |f: &dyn Fn(&(f64, f64, f64)) -> f64| points.iter().map(f).sum::<f64>();
    let all = sum(&|p| p.2);
    let (x, y) = (sum(&|p| p.2 * p.0) / all, sum(&|p| p.2 * p.1) / all);
    let xx = sum(&|p| p.2 * (p.0 - x).powi(2));
    let yy = sum(&|p| p.2 * (p.1 - y).powi(2));
    let xy = sum(&|p| p.2 * (p.0 - x) * (p.1 - y));
    if xx > 0.0 && yy > 0.0 { xy * xy / (xx * yy) } else { 0.0 }
}

/// Quantities of a window that a missing force may depend on: name and value.
fn features(tape: &Tape, span: Span) -> Vec<(String, f64)> {
    let mut all = vec![("time".to_owned(), 0.5 * (span.from + span.to) - tape.span.0)];
    for reading in &tape.readings {
        let is_place = matches!(reading.quantity, Quantity::Position(..) | Quantity::JointPosition(_));
        if !is_place {
            continue;
        }
        let mean = mean_of(reading, span);
        all.extend(
            reading
                .axes
                .iter()
                .enumerate()
                .map(|(k, axis)| (reading.component(k), mean.map_or(f64::NAN, |m| m[*axis]))),
        );
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
        let mut line: Vec<(f64, f64, f64)> = (0..20).map(|i| (f64::from(i), 3.0 + 0.5 * f64::from(i), 1.0)).collect();
        assert!((calc_share(&mut line) - 1.0).abs() < 1e-12);
        let mut saw: Vec<(f64, f64, f64)> = (0..20).map(|i| (f64::from(i), f64::from(i % 2), 1.0)).collect();
        assert!(calc_share(&mut saw) < 0.05);
        assert_eq!(calc_share(&mut line[..3]), 0.0);
    }
}
