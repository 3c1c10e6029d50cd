//! What was checked before the fit: data quality, identifiability, the simulation's own error, the test for a mismatch, time.

use super::table;
use crate::evidence::{Evidence, Identifiable, Level, Remark, Stage};
use crate::number::{digits, short};
use record::plot::escape;
use std::fmt::Write;

/// Rows of the table of parameters that are shown without a click.
const ROWS: usize = 12;

/// The section.
pub(super) fn section(evidence: &Evidence) -> String {
    [detection(evidence), discretisation(evidence), quality(evidence), identifiability(evidence), timings(evidence)]
        .concat()
}

fn detection(evidence: &Evidence) -> String {
    let Some(test) = &evidence.detection else { return String::new() };
    let outcome = if test.value > test.bound { "beyond it: there is a mismatch" } else { "within it: no mismatch" };
    format!(
        "<p><b>Mismatch or noise?</b> {}: {}; noise alone would exceed {} with a probability of {} over the whole \
         recording, all channels and times together; this is {outcome}.</p>\n",
        escape(&test.statistic),
        short(test.value),
        short(test.bound),
        crate::number::percent(test.false_alarm)
    )
}

fn discretisation(evidence: &Evidence) -> String {
    let Some(d) = &evidence.discretisation else { return String::new() };
    let outcome = if d.error <= d.bound { "small enough" } else { "too large: take a finer step" };
    format!(
        "<p><b>The simulation's own error.</b> Step {} s; halving it changes the prediction over {} s by {} times the noise \
         (allowed: {}): {outcome}.</p>\n",
        short(d.step_s),
        short(d.window_s),
        digits(d.error, 2),
        short(d.bound)
    )
}

fn quality(evidence: &Evidence) -> String {
    let mut remarks: Vec<&Remark> = evidence.quality.iter().collect();
    remarks.sort_by_key(|r| std::cmp::Reverse(r.level));
    if remarks.is_empty() {
        return String::new();
    }
    let mut text = String::from("<h3>The recording</h3><ul class=\"remarks\">\n");
    for remark in remarks {
        let (class, word) = match remark.level {
            Level::Note => ("plain", "note"),
            Level::Warning => ("fair", "warning"),
            Level::Serious => ("bad", "serious"),
        };
        let subject =
            if remark.subject.is_empty() { String::new() } else { format!("<b>{}</b>: ", escape(&remark.subject)) };
        let _ = writeln!(text, "<li><span class=\"pill {class}\">{word}</span> {subject}{}</li>", escape(&remark.text));
    }
    text + "</ul>\n"
}

fn identifiability(evidence: &Evidence) -> String {
    if evidence.identifiability.is_empty() {
        return String::new();
    }
    let header = ["effect", "place", "parameter", "#standard error to expect", "unit", "#condition", "remark"];
    let rows: Vec<Vec<String>> = evidence.identifiability.iter().map(row).collect();
    let mut text = String::from(
        "<h3>What it can show</h3><p>Before anything was fitted: the standard error that each parameter would have (Fisher information, \
         initial states eliminated) and the condition of its information matrix; a large condition means that only combinations show.</p>\n",
    );
    text += &table("", &header, &rows[..rows.len().min(ROWS)]);
    if rows.len() > ROWS {
        let _ = writeln!(
            text,
            "<details><summary>{} more</summary>{}</details>",
            rows.len() - ROWS,
            table("", &header, &rows[ROWS..])
        );
    }
    text
}

fn row(i: &Identifiable) -> Vec<String> {
    let error = if i.std_err.is_finite() { digits(i.std_err, 2) } else { "not shown".to_owned() };
    vec![
        escape(&i.effect),
        escape(&i.place),
        escape(&i.parameter),
        error,
        escape(&i.unit),
        digits(i.condition, 2),
        escape(&i.remark),
    ]
}

fn timings(evidence: &Evidence) -> String {
    if evidence.timings.is_empty() {
        return String::new();
    }
    let total: f64 = evidence.timings.iter().map(|s| s.wall_s).sum();
    let row = |s: &Stage| {
        let share = if total > 0.0 { s.wall_s / total } else { 0.0 };
        vec![escape(&s.name), format!("{:.1}", s.wall_s), super::share_bar(share), short(s.simulated_s)]
    };
    let rows: Vec<Vec<String>> = evidence.timings.iter().map(row).collect();
    format!("<h3>Time</h3><p>{total:.0} s in all.</p>\n")
        + &table("", &["stage", "#time, s", "share", "#simulated, s"], &rows)
}
