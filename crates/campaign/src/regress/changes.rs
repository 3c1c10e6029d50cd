//! What differs between a baseline and now, in sentences.

use super::baseline::{Baseline, CampaignBaseline, Curves};
use super::margin::{FALSE_ALARM, WORK, of_curve, of_metric};
use crate::stats::kolmogorov_smirnov;
use scenario::Scenario;
use serde_json::{Map, Value};

/// What a change is of: a test case of its own for a CI.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// The run as a whole.
    Outcome,
    /// Its metrics.
    Metrics,
    /// Its curves.
    Signals,
    /// Its work counters.
    Work,
    /// What its mutations end in.
    Mutations,
    /// Its campaign.
    Campaign,
}

impl Group {
    /// All, in the order of a report.
    pub const ALL: [Self; 6] =
        [Self::Outcome, Self::Metrics, Self::Signals, Self::Work, Self::Mutations, Self::Campaign];

    /// One word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Outcome => "outcome",
            Self::Metrics => "metrics",
            Self::Signals => "signals",
            Self::Work => "work",
            Self::Mutations => "mutations",
            Self::Campaign => "campaign",
        }
    }
}

/// Something that is not as the baseline has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// What it is of.
    pub group: Group,
    /// What, from what to what, and what was allowed.
    pub text: String,
}

/// Everything that differs beyond its tolerance, and mutations that do not end as the scenario says they must.
pub fn find_changes(scenario: &Scenario, then: &Baseline, now: &Baseline) -> Vec<Change> {
    let mut changes = Vec::new();
    let mut add = |group, text: String| changes.push(Change { group, text });
    if then.outcome != now.outcome {
        add(Group::Outcome, format!("outcome: {} → {}", then.outcome, now.outcome));
    }
    for (name, a, b) in paired(&then.metrics, &now.metrics) {
        if let Some(text) = metric_change(scenario, name, a, b) {
            add(Group::Metrics, text);
        }
    }
    curve_changes(scenario, &then.curves, &now.curves).into_iter().for_each(|text| add(Group::Signals, text));
    for (name, a, b) in paired(&then.work, &now.work) {
        if let Some(text) = work_change(name, a, b) {
            add(Group::Work, text);
        }
    }
    for (name, a, b) in paired(&then.mutations, &now.mutations) {
        if a != b {
            add(Group::Mutations, format!("mutation {name}: {} → {}", shown(a), shown(b)));
        }
    }
    for mutation in &scenario.mutations {
        let ends = now.mutations.get(&mutation.name).and_then(Value::as_str);
        if let Some(ends) = ends.filter(|ends| *ends != mutation.outcome) {
            add(Group::Mutations, format!("mutation {}: must end {}, ends {ends}", mutation.name, mutation.outcome));
        }
    }
    if let (Some(a), Some(b)) = (&then.campaign, &now.campaign) {
        campaign_changes(a, b).into_iter().for_each(|text| add(Group::Campaign, text));
    }
    changes
}

/// The values of two maps by name: those of the first in its order, then what only the second has.
fn paired<'a>(
    a: &'a Map<String, Value>,
    b: &'a Map<String, Value>,
) -> Vec<(&'a str, Option<&'a Value>, Option<&'a Value>)> {
    let first = a.iter().map(|(name, value)| (name.as_str(), Some(value), b.get(name)));
    let only =
        b.iter().filter(|(name, _)| !a.contains_key(*name)).map(|(name, value)| (name.as_str(), None, Some(value)));
    first.chain(only).collect()
}

fn shown(value: Option<&Value>) -> String {
    match value {
        None => "not there".to_owned(),
        Some(Value::Null) => "none".to_owned(),
        Some(value) => value.as_f64().map_or_else(|| value.to_string(), |x| format!("{x:.6e}")),
    }
}

fn metric_change(scenario: &Scenario, name: &str, a: Option<&Value>, b: Option<&Value>) -> Option<String> {
    let numbers = a.and_then(Value::as_f64).zip(b.and_then(Value::as_f64));
    let Some((x, y)) = numbers else {
        return (a != b).then(|| format!("{name}: {} → {}", shown(a), shown(b)));
    };
    let (absolute, relative) = of_metric(name, &scenario.margins);
    let allowed = absolute + relative * x.abs();
    let share = if x == 0.0 { String::new() } else { format!(" ({:+.3} %)", 100.0 * (y - x) / x.abs()) };
    ((y - x).abs() > allowed).then(|| format!("{name}: {} → {}{share}, allowed ± {allowed:.2e}", shown(a), shown(b)))
}

fn work_change(name: &str, a: Option<&Value>, b: Option<&Value>) -> Option<String> {
    let (x, y) = (a.and_then(Value::as_f64)?, b.and_then(Value::as_f64)?);
    let share = (y - x) / x.max(1.0);
    (share.abs() > WORK)
        .then(|| format!("{name}: {x:.0} → {y:.0} ({:+.2} %), allowed ± {} %", 100.0 * share, 100.0 * WORK))
}

/// One sentence for every curve that leaves its baseline: when first, and how far at most.
fn curve_changes(scenario: &Scenario, then: &Curves, now: &Curves) -> Vec<String> {
    let mut texts = Vec::new();
    let steps = then.t.windows(2).next().map_or(0.0, |w| w[1] - w[0]);
    let together = then.t.iter().zip(&now.t).take_while(|(a, b)| (*a - *b).abs() <= 1e-6 * steps.max(1e-9)).count();
    for (name, a) in &then.channels {
        let Some(b) = now.channels.get(name) else {
            texts.push(format!("{name}: no longer there"));
            continue;
        };
        let finite = || a.iter().flatten();
        let (low, high) = finite().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
        let range = if high > low { high - low } else { 0.0 };
        let allowed = of_curve(name, range, &scenario.margins);
        let gaps: Vec<(f64, f64)> =
            (0..together.min(a.len()).min(b.len())).filter_map(|i| Some((then.t[i], (a[i]? - b[i]?).abs()))).collect();
        let Some((since, _)) = gaps.iter().find(|(_, gap)| *gap > allowed) else { continue };
        let (at, most) = gaps.iter().fold((0.0, 0.0), |best, gap| if gap.1 > best.1 { *gap } else { best });
        let share = if range > 0.0 { format!(", {:.2} % of its range", 100.0 * most / range) } else { String::new() };
        texts.push(format!("{name}: leaves the baseline at t = {since:.3} s; by {most:.3e} at t = {at:.3} s{share}"));
    }
    if then.t.len() != now.t.len() {
        let end = |t: &[f64]| t.last().copied().unwrap_or(0.0);
        texts.push(format!("the run ends at t = {:.3} s, before at {:.3} s", end(&now.t), end(&then.t)));
    }
    texts
}

/// Outcomes by counts, metrics by the two-sample test of Kolmogorov and Smirnov, all metrics together at one false-alarm rate.
fn campaign_changes(then: &CampaignBaseline, now: &CampaignBaseline) -> Vec<String> {
    let mut texts = Vec::new();
    if then.outcomes != now.outcomes {
        let words = |map: &std::collections::BTreeMap<String, u32>| {
            map.iter().map(|(outcome, n)| format!("{outcome} {n}")).collect::<Vec<_>>().join(", ")
        };
        texts.push(format!("of {} runs: {} → {}", then.runs, words(&then.outcomes), words(&now.outcomes)));
    }
    let level = FALSE_ALARM / then.values.len().max(1) as f64;
    for (name, a) in &then.values {
        let Some(b) = now.values.get(name) else {
            texts.push(format!("{name}: no run has it any more"));
            continue;
        };
        let Some(test) = kolmogorov_smirnov(a, b) else { continue };
        if test.p < level {
            let middle = |values: &[f64]| values.get(values.len() / 2).copied().unwrap_or(f64::NAN);
            texts.push(format!(
                "{name}: another distribution (Kolmogorov–Smirnov distance {:.2}, p = {:.1e}); median {:.4e} → {:.4e}",
                test.value,
                test.p,
                middle(a),
                middle(b)
            ));
        }
    }
    texts
}
