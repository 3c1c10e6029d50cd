//! Curves of the evidence: channels that matter, and the missing force over time.

use crate::evidence::{Curve, MissingForce};
use crate::judge::Scalar;
use crate::linear::Stage;
use crate::reading::Value;
use crate::run::Findings;
use crate::tape::Tape;
use crate::tell::role;
use record::{ChannelName, Role};

/// Most channels drawn.
const CHANNELS: usize = 6;

/// The channels of one run that differ most, measured and predicted in windows.
pub(crate) fn curves(findings: &Findings, stage: &Stage<'_>) -> Vec<Curve> {
    let Some(run) = stage.tapes.iter().position(|t| t.role == Role::Holdout).or((!stage.tapes.is_empty()).then_some(0))
    else {
        return Vec::new();
    };
    let tape = &stage.tapes[run];
    let [nominal, corrected] = findings.judgement.windowed.each_ref().map(|p| {
        let drawn = p.scalars(tape).into_iter().filter_map(|s| measured(tape, &s).map(|m| (s, m)));
        drawn.collect::<Vec<(Scalar, f64)>>()
    });
    let mut channels: Vec<((usize, usize), f64)> = Vec::new();
    for (scalar, _) in &nominal {
        let own = (scalar.reading, scalar.component);
        match channels.iter_mut().find(|c| c.0 == own) {
            Some(channel) => channel.1 += scalar.residual.powi(2),
            None => channels.push((own, scalar.residual.powi(2))),
        }
    }
    channels.sort_by(|a, b| b.1.total_cmp(&a.1));
    let curve = |(r, k): (usize, usize)| {
        let reading = &tape.readings[r];
        let of = |all: &[(Scalar, f64)], f: &dyn Fn(&(Scalar, f64)) -> f64| -> Vec<f64> {
            all.iter().filter(|(s, _)| (s.reading, s.component) == (r, k)).map(f).collect()
        };
        let predicted = |(s, measured): &(Scalar, f64)| measured + s.residual * reading.sigma;
        let channel = reading.component(k);
        Curve {
            run: tape.file.clone(),
            role: role(tape.role),
            unit: ChannelName::parse(&channel).map_or_else(String::new, |name| name.quantity.unit().to_owned()),
            channel,
            sigma: reading.sigma,
            window_s: Some(findings.window),
            t: of(&nominal, &|s| s.0.time),
            measured: of(&nominal, &|s| s.1),
            nominal: of(&nominal, &predicted),
            corrected: if findings.found.set.members.is_empty() { Vec::new() } else { of(&corrected, &predicted) },
        }
    };
    channels.into_iter().take(CHANNELS).map(|(c, _)| curve(c)).collect()
}

/// What was measured; orientations have no curve.
fn measured(tape: &Tape, scalar: &Scalar) -> Option<f64> {
    let reading = &tape.readings[scalar.reading];
    match reading.values[scalar.sample] {
        Value::Vector(v) => Some(v[reading.axes[scalar.component]]),
        Value::Rotation(_) => None,
    }
}

/// Most places drawn.
const PLACES: usize = 2;

/// The missing force of the places where most of it acts: its mean over each window of the first run that was fitted.
pub(crate) fn forces(findings: &Findings, stage: &Stage<'_>) -> Vec<MissingForce> {
    let (located, segments) = (&findings.located, &findings.nominal.segments);
    let Some(run) = segments.first().map(|s| s.run) else { return Vec::new() };
    let windows: Vec<usize> = (0..segments.len()).filter(|i| segments[*i].run == run).collect();
    let mut all = Vec::new();
    for p in located.ranked().into_iter().filter(|p| located.share(*p) > 0.01).take(PLACES) {
        let place = &located.places[p];
        for (c, (label, ..)) in place.columns.iter().enumerate().filter(|(_, c)| c.0.ends_with("constant")) {
            let of = |f: &dyn Fn(&crate::locate::WindowForce) -> f64| -> Vec<f64> {
                windows.iter().map(|i| f(&located.windows[*i][p])).collect()
            };
            let std_err = of(&|w| w.error[c]);
            if std_err.iter().all(|e| *e == 0.0) {
                continue; // Nothing that was measured shows it.
            }
            all.push(MissingForce {
                place: place.name.clone(),
                freedom: label.trim_end_matches("constant").trim().to_owned(),
                unit: if label.starts_with("force") { "N".to_owned() } else { "N m".to_owned() },
                run: stage.tapes[run].file.clone(),
                t: windows.iter().map(|i| 0.5 * (segments[*i].span.from + segments[*i].span.to)).collect(),
                estimate: of(&|w| w.estimate[c]),
                std_err,
                law: None,
            });
        }
    }
    all
}
