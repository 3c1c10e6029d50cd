//! How far what may be from its baseline.

use scenario::glob_matches;
use scenario::spec::Margin;

/// Differences allowed where no `[[margin]]` says otherwise: (name, absolute, relative); the last that matches decides.
///
/// On one machine runs repeat to the bit. Between machines the last bits of elementary functions differ, and contact makes them
/// larger; these bounds leave room for that and for nothing else.
const METRICS: [(&str, f64, f64); 6] = [
    ("*", 1e-9, 1e-5),
    // Round-off and what is beyond all digits: only its size counts.
    ("momentum_drift_*", 1e-10, 0.0),
    ("numerical_loss*", 1e-6, 1e-3),
    ("creep_*", 1e-9, 1e-3),
    ("held_*", 1e-9, 1e-4),
    // An event may move by a step.
    ("*_s", 5e-3, 1e-5),
];
/// The same of a curve, relative to its own range.
const CURVE: (f64, f64) = (1e-9, 1e-4);
/// Relative difference of a work counter.
pub(super) const WORK: f64 = 5e-3;
/// Chance of calling two samples of one distribution different, over all metrics of a campaign.
pub(super) const FALSE_ALARM: f64 = 1e-3;

/// Absolute and relative difference that a metric may have.
pub(super) fn of_metric(name: &str, own: &[Margin]) -> (f64, f64) {
    let matches = |pattern: &Option<String>| pattern.as_ref().is_some_and(|p| glob_matches(p, name));
    if let Some(t) = own.iter().rev().find(|t| matches(&t.metric)) {
        return (t.absolute, t.relative);
    }
    let default = METRICS.iter().rev().find(|(pattern, ..)| glob_matches(pattern, name) && !is_impulse(pattern, name));
    default.map_or((0.0, 0.0), |(_, absolute, relative)| (*absolute, *relative))
}

/// Names that end in `_s` for another reason than that they are times.
fn is_impulse(pattern: &str, name: &str) -> bool {
    pattern == "*_s" && ["_n_s", "_per_s", "_m_s"].iter().any(|unit| name.ends_with(unit))
}

/// Absolute difference that a curve of this range may have.
pub(super) fn of_curve(name: &str, range: f64, own: &[Margin]) -> f64 {
    let matches = |pattern: &Option<String>| pattern.as_ref().is_some_and(|p| glob_matches(p, name));
    let (absolute, relative) =
        own.iter().rev().find(|t| matches(&t.signal)).map_or(CURVE, |t| (t.absolute, t.relative));
    absolute + relative * range
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_may_move_by_a_step_and_impulses_may_not() {
        assert_eq!(of_metric("capture_time_s", &[]).0, 5e-3);
        assert_eq!(of_metric("contact_impulse_n_s", &[]).0, 1e-9);
        assert_eq!(of_metric("residual_speed_m_per_s", &[]).0, 1e-9);
    }

    #[test]
    fn the_files_own_word_comes_first_and_its_last_one_counts() {
        let own =
            |metric: &str, absolute| Margin { metric: Some(metric.to_owned()), signal: None, absolute, relative: 0.0 };
        let list = [own("peak_*", 1.0), own("peak_contact_force_n", 2.0)];
        assert_eq!(of_metric("peak_contact_force_n", &list), (2.0, 0.0));
        assert_eq!(of_metric("peak_hold_force_n", &list), (1.0, 0.0));
        assert_eq!(of_metric("nearest_m", &list), (1e-9, 1e-5));
    }
}
