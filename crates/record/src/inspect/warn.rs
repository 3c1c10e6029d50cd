//! Sentences about what was measured: each names its run, its channel, a figure, and what to look at.

use super::jitter::duration;
use super::quality::{at_limit, clock, spikes, stuck};
use super::{ChannelReport, is_orientation, sigma_of};
use crate::consistency::Consistency;
use crate::recording::{Remark, Severity};
use crate::{ChannelName, RecordedRun, RecordingSet, Series};

/// Factor between measured and stated noise from which it is said. The estimate is sure to some per cent.
const NOISE: f64 = 1.3;
/// Jitter, share of the step, from which it is said.
const JITTER: f64 = 0.02;
/// Clock step, s, from which whole numbers look like milliseconds.
const MILLISECONDS: f64 = 0.999;

/// Noise against the data sheet, once per sensor.
pub(super) fn of_channels(set: &RecordingSet, channels: &[ChannelReport]) -> Vec<Remark> {
    let mut remarks = Vec::new();
    for report in channels {
        remarks.extend(noise(report));
        if let Some(jitter) = report.jitter_s {
            let what =
                format!("its noise grows with its speed, as by stamps that jitter by {} (1 sigma)", duration(jitter));
            remarks.push(Remark::new(Severity::Note, what).of_channel(&report.channel));
        }
        if report.runs < set.runs.len() {
            let what = format!("is in {} of {} runs only", report.runs, set.runs.len());
            remarks.push(Remark::new(Severity::Note, what).of_channel(&report.channel));
        }
        if report.low == report.high {
            let what = format!("never changes: {} in all {} samples", report.low, report.samples);
            remarks.push(Remark::new(Severity::Note, what).of_channel(&report.channel));
        }
    }
    remarks
}

fn noise(report: &ChannelReport) -> Option<Remark> {
    // An orientation's four components share one figure.
    let name = ChannelName::parse(&report.channel)?;
    let subject = match is_orientation(&report.channel) {
        true if name.component != "w" => return None,
        true => name.prefix,
        false => &report.channel,
    };
    let (found, stated) = (report.noise?, report.stated?);
    let rounding = report.rounding / 12.0_f64.sqrt();
    let factor = found / stated;
    if stated <= 0.0 || (1.0 / NOISE..NOISE).contains(&factor) || (factor < 1.0 && rounding > stated) {
        return None;
    }
    let what = format!(
        "its white noise is {found:.3e}, {factor:.2} times the stated {stated:.3e}{}",
        if factor < 1.0 { ": is the data sheet's figure pessimistic, or the channel filtered?" } else { "" }
    );
    Some(Remark::new(Severity::Warning, what).of_channel(subject))
}

/// What is wrong in single runs.
pub(super) fn of_runs(set: &RecordingSet, channels: &[ChannelReport]) -> Vec<Remark> {
    let mut remarks = Vec::new();
    for run in &set.runs {
        let mut found = clocks(run);
        for series in &run.series {
            let at = channels.binary_search_by(|c| c.channel.as_str().cmp(&series.channel)).ok();
            found.extend(values(series, at.and_then(|at| channels.get(at))));
        }
        remarks.extend(found.into_iter().map(|remark| remark.of_run(&run.file)));
    }
    remarks
}

/// Clocks, said once for all channels that share one.
fn clocks(run: &RecordedRun) -> Vec<Remark> {
    let mut remarks = Vec::new();
    let mut seen: Vec<&[f64]> = Vec::new();
    for series in &run.series {
        if seen.contains(&&series.times[..]) {
            continue;
        }
        seen.push(&series.times);
        let sharing: Vec<&str> =
            run.series.iter().filter(|s| s.times == series.times).map(|s| s.channel.as_str()).collect();
        let subject = match sharing.as_slice() {
            [one] => (*one).to_owned(),
            [first, ..] => format!("{first} and {} more", sharing.len() - 1),
            [] => String::new(),
        };
        remarks.extend(one_clock(series).into_iter().map(|remark| remark.of_channel(&subject)));
    }
    remarks
}

fn one_clock(series: &Series) -> Vec<Remark> {
    let found = clock(series);
    let mut remarks = Vec::new();
    if found.gaps > 0 {
        let what = format!(
            "{} gaps at {:.4} Hz, {:.2} % of the samples missing; the longest is {:.4} s from {:.4} s on",
            found.gaps,
            found.rate,
            100.0 * found.missing,
            found.longest_gap,
            found.longest_gap_at
        );
        let severity = if found.missing > 0.05 { Severity::Warning } else { Severity::Note };
        remarks.push(Remark::new(severity, what));
    }
    if found.jitter > JITTER {
        let what = format!(
            "the clock jitters: steps vary by {:.1} % (1 sigma) about {:.4e} s",
            100.0 * found.jitter,
            1.0 / found.rate
        );
        let severity = if found.jitter > 0.2 { Severity::Warning } else { Severity::Note };
        remarks.push(Remark::new(severity, what));
    }
    let step = series.median_step();
    let is_whole = series.times.iter().all(|t| t.fract() == 0.0);
    if step >= MILLISECONDS && is_whole && series.len() > 100 {
        let what = format!(
            "times are whole numbers, {step} apart: at 1 Hz a rig shows little; if they are ms, say [time] unit = \"ms\""
        );
        remarks.push(Remark::new(Severity::Warning, what));
    }
    remarks
}

/// Stuck values, limits and spikes of one channel of one run.
fn values(series: &Series, report: Option<&ChannelReport>) -> Vec<Remark> {
    let mut remarks = Vec::new();
    let mut say = |severity, what: String| remarks.push(Remark::new(severity, what).of_channel(&series.channel));
    if let Some((limit, share)) = at_limit(series) {
        say(Severity::Note, format!("stands at its limit ±{limit} for {:.1} % of the time", 100.0 * share));
    }
    let Some(noise) = report.filter(|_| !is_orientation(&series.channel)).and_then(sigma_of) else { return remarks };
    let stuck = stuck(series, noise);
    if let Some(longest) = stuck.iter().max_by_key(|s| s.samples) {
        let what = if longest.at_limit { "clipped: it stands at its extreme" } else { "stuck: it stands at" };
        let more = if stuck.len() > 1 { format!(", and {} more stretches", stuck.len() - 1) } else { String::new() };
        say(
            Severity::Warning,
            format!(
                "{what} {} from {:.4} s to {:.4} s ({} samples), where its noise should move it{more}",
                longest.value, longest.from_s, longest.to_s, longest.samples
            ),
        );
    }
    let spikes = spikes(&[series], noise);
    if let Some(first) = spikes.first() {
        let what = format!("{} lone outliers, the first at {:.4} s by {:.3e}", spikes.len(), first.t, first.size);
        say(Severity::Warning, what);
    }
    remarks
}

/// Rates that are not the derivative of their position.
pub(super) fn of_consistency(all: &[Consistency]) -> Vec<Remark> {
    let mut remarks = Vec::new();
    for found in all {
        let severity = if found.is_fault { Severity::Fault } else { Severity::Warning };
        remarks.extend(found.findings.iter().map(|what| Remark::new(severity, what).of_channel(&found.rate)));
    }
    remarks.extend(all_by_a_thousand(all));
    remarks
}

/// Every rate a thousand times the derivative of its position: the clock, not the sensors.
fn all_by_a_thousand(all: &[Consistency]) -> Option<Remark> {
    let mut scales = all.iter().flat_map(|found| found.scale.iter().flatten()).map(|s| s.value).peekable();
    scales.peek()?;
    let what = "every rate is 1000 times the derivative of its position: the time is in ms; say [time] unit = \"ms\"";
    scales.all(|s| (s / 1000.0 - 1.0).abs() < 0.05).then(|| Remark::new(Severity::Fault, what))
}
