//! Outcomes as bars with their intervals, and the reasons of those that failed.

use super::colours::Colours;
use super::runs::link;
use crate::findings::{Findings, OutcomeTally};
use record::page::number::rate;
use record::page::{bar_row, escape, header, name, table};

/// The section.
pub(super) fn section(findings: &Findings, links: &[(u32, String)]) -> String {
    if findings.outcomes.is_empty() {
        return String::new();
    }
    let colours = Colours::of(findings);
    let mut text = String::from("<p>Share of all runs by outcome, with its 95 % interval (Wilson).</p>\n");
    for tally in &findings.outcomes {
        let interval = tally.rate.interval;
        let low = rate(interval.low);
        let after = format!(
            "{}: {}<br>{} … {}",
            tally.rate.count,
            rate(tally.rate.value),
            low.trim_end_matches(" %"),
            rate(interval.high)
        );
        text += &bar_row(&name(&tally.outcome), colours.class(&tally.outcome), tally.rate.value, None, &after);
    }
    let rows: Vec<Vec<String>> = findings.outcomes.iter().flat_map(|tally| reasons(tally, links)).collect();
    if !rows.is_empty() {
        text += "<h3>Why</h3><p>Reasons that differ in their numbers only are one reason; “…” stands for the \
                numbers.</p>\n";
        text += &table("reasons", &header(["outcome", "#runs", "#example", "reason"]), &rows);
    }
    for tally in findings.outcomes.iter().filter(|tally| tally.reason_count > tally.reasons.len()) {
        let more = tally.reason_count - tally.reasons.len();
        text += &format!("<p>{}: {more} rarer reasons are not listed.</p>\n", escape(&tally.outcome));
    }
    text
}

fn reasons(tally: &OutcomeTally, links: &[(u32, String)]) -> Vec<Vec<String>> {
    let row = |reason: &crate::findings::Reason| {
        let example = if reason.pattern == reason.example {
            String::new()
        } else {
            format!("<small>run {}: {}</small>", reason.example_run, escape(&reason.example))
        };
        vec![
            name(&tally.outcome),
            reason.runs.to_string(),
            link(reason.example_run, links),
            format!("{}{example}", escape(&reason.pattern)),
        ]
    };
    tally.reasons.iter().map(row).collect()
}
