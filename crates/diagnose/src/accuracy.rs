//! Prediction errors by role, run and channel, as a diagnosis tells them.

use crate::curves::unit_of_channel;
use crate::diagnosis::{BeforeAfter, ChannelError, Errors, RunError};
use crate::judge::Prediction;
use crate::linear::Stage;
use crate::reading::Reading;
use crate::run::Findings;
use crate::tape::{Tape, judging};
use crate::tell::role;
use std::collections::BTreeMap;

/// All of them.
pub(crate) fn errors(findings: &Findings, stage: &Stage<'_>) -> Errors {
    let judgement = &findings.judgement;
    let pair = |[before, after]: [f64; 2]| BeforeAfter { before, after };
    let of_role = |windowed: bool, role: record::Role| judgement.rms_of(stage.tapes, windowed, role).map(pair);
    let run = |(i, tape): (usize, &Tape)| {
        let [before, after] = judgement.rms(false, |r| r == i);
        let [windowed_before, windowed_after] = judgement.rms(true, |r| r == i);
        RunError { file: tape.file.clone(), role: role(tape.role), before, after, windowed_before, windowed_after }
    };
    let none = BeforeAfter { before: f64::NAN, after: f64::NAN };
    Errors {
        fit: of_role(false, record::Role::Fit).unwrap_or(none),
        holdout: of_role(false, record::Role::Holdout),
        window_s: findings.window,
        windowed: of_role(true, judging(stage.tapes)).unwrap_or(none),
        within_tolerance: judgement.tolerated.as_ref().map(|[windows, _]| {
            let judging = judging(stage.tapes);
            windows.rms(|run| stage.tapes[run].role == judging)
        }),
        runs: stage.tapes.iter().enumerate().map(run).collect(),
        channels: channel_errors(findings, stage),
    }
}

/// Errors in the channels' own units, the most wrong channel first.
fn channel_errors(findings: &Findings, stage: &Stage<'_>) -> Vec<ChannelError> {
    let judging = judging(stage.tapes);
    let tapes: Vec<&Tape> = stage.tapes.iter().filter(|t| t.role == judging).collect();
    let pairs = |[before, after]: &[Prediction; 2]| [rms_by_channel(before, &tapes), rms_by_channel(after, &tapes)];
    let (free, windowed) = (pairs(&findings.judgement.whole), pairs(&findings.judgement.windowed));
    let model = &findings.nominal.built.model;
    let mut readings: Vec<&Reading> = tapes.iter().flat_map(|t| &t.readings).collect();
    readings.sort_by(|a, b| a.channel.cmp(&b.channel));
    readings.dedup_by(|b, a| a.channel == b.channel);
    let of = |reading: &Reading| {
        let at = |[before, after]: &[BTreeMap<&str, f64>; 2]| {
            let of = |by: &BTreeMap<&str, f64>| by.get(reading.channel.as_str()).copied().unwrap_or(f64::NAN);
            BeforeAfter { before: of(before), after: of(after) }
        };
        let unit = match reading.is_orientation() {
            true => "rad",
            false => unit_of_channel(model, reading.quantity, &reading.component(0)),
        };
        let (channel, unit) = (reading.channel.clone(), unit.to_owned());
        ChannelError { channel, unit, sigma: reading.sigma, free: at(&free), windowed: at(&windowed) }
    };
    let mut all: Vec<ChannelError> = readings.into_iter().map(of).collect();
    let wrong = |c: &ChannelError| c.windowed.before / c.sigma;
    all.sort_by(|a, b| wrong(b).total_cmp(&wrong(a)));
    all
}

/// Root mean square of what is predicted wrong in some runs, by channel, in its unit.
fn rms_by_channel<'a>(prediction: &Prediction, tapes: &[&'a Tape]) -> BTreeMap<&'a str, f64> {
    let mut sums: BTreeMap<&str, (f64, f64)> = BTreeMap::new();
    for tape in tapes {
        for scalar in prediction.scalars(tape) {
            let reading = &tape.readings[scalar.reading];
            let sum = sums.entry(&reading.channel).or_default();
            (sum.0, sum.1) = (sum.0 + (scalar.residual * reading.sigma).powi(2), sum.1 + 1.0);
        }
    }
    sums.into_iter().map(|(channel, (squares, count))| (channel, (squares / count).sqrt())).collect()
}
