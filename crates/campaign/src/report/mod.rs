//! The report of a campaign: one self-contained page, a Markdown summary, and the findings as JSON.
//!
//! All three are functions of the table and its [`Findings`]; nothing is computed here that a reader could not find in
//! the JSON.

mod colours;
pub(crate) mod distributions;
mod drivers;
mod effects;
mod maps;
mod outcomes;
mod runs;
mod tables;
pub(crate) mod text;

pub use text::{JSON_FORMAT, report_json, report_markdown};

use crate::findings::Findings;
use crate::table::Table;
use record::page::number::{digits, grouped, percent, rate};
use record::page::{self, Section, escape, page_html, tiles};

/// Name of the page's file.
pub const FILE: &str = "report.html";

/// The page; `links` are addresses of recordings of some runs.
pub fn report_html(table: &Table, findings: &Findings, links: &[(u32, String)]) -> String {
    let sections = [
        Section { id: "outcomes", title: "Outcomes", body: outcomes::section(findings, links) },
        Section { id: "drivers", title: drivers::title(findings), body: drivers::section(findings) },
        Section { id: "envelope", title: "Where it succeeds", body: maps::envelope(table, findings) },
        Section {
            id: "distributions",
            title: "Loads, times and motions",
            body: distributions::section(table, findings),
        },
        Section { id: "pairs", title: "Strongest dependencies", body: maps::pairs(table, findings) },
        Section { id: "sensitivity", title: "What drives what", body: effects::section(findings) },
        Section { id: "inputs", title: "Inputs: drawn and applied", body: tables::inputs(findings) },
        Section { id: "metrics", title: "Metrics", body: tables::metrics(findings) },
        Section { id: "runs", title: "Runs", body: runs::section(table, findings, links) },
        Section { id: "reproduce", title: "How to reproduce", body: runs::reproduce(table, findings, links) },
    ];
    let title = format!("{}: {} runs", findings.scenario, findings.runs);
    let footer = format!(
        "softdock {}, <code>campaign</code>. Intervals hold with 95 %; rates have Wilson's. Sobol' indices are of \
         first order, from \
         the runs as they were drawn; an effect is called clear where chance would show one as large among all inputs \
         in about one \
         campaign in twenty.",
        escape(&findings.version)
    );
    page_html(&title, &head(table, findings), &sections, &footer)
}

fn head(table: &Table, findings: &Findings) -> String {
    let mut text = format!(
        "<p class=\"over\">Campaign of <b>{}</b> {}, seed {}</p><h1>{}</h1>\n",
        grouped(findings.runs as u64),
        if findings.runs == 1 { "run" } else { "runs" },
        findings.seed,
        if findings.scenario.is_empty() { "Campaign".to_owned() } else { page::name(&findings.scenario) }
    );
    if !table.header.description.is_empty() {
        text += &format!("<p>{}</p>\n", escape(&table.header.description));
    }
    text += &format!("<p class=\"verdict\">{}{}</p>\n", pill(findings), page::sentence(&findings.verdict));
    text += &tiles(&tile_list(findings));
    for remark in &findings.remarks {
        text += &format!("<p class=\"remark\">{}</p>\n", page::sentence(remark));
    }
    text
}

/// The rate as a badge: green where it is certainly above 95 %, red where it is certainly below 75 %.
fn pill(findings: &Findings) -> String {
    let Some(success) = &findings.success else { return String::new() };
    let interval = success.rate.interval;
    let class = match (interval.low, interval.high) {
        (low, _) if low >= 0.95 => "good",
        (_, high) if high < 0.75 => "bad",
        _ => "fair",
    };
    format!("<span class=\"pill {class}\">{}</span> ", rate(success.rate.value))
}

fn tile_list(findings: &Findings) -> Vec<(String, String, String)> {
    let mut tiles = Vec::new();
    let mut add = |label: &str, value: String, below: String| tiles.push((label.to_owned(), value, below));
    if let Some(success) = &findings.success {
        let (low, high) = (rate(success.rate.interval.low), rate(success.rate.interval.high));
        let value = format!("{} of {}", success.rate.count, success.rate.of);
        add(&success.flag.replace('_', " "), value, format!("95 % interval {} … {high}", low.trim_end_matches(" %")));
    }
    if let Some(worst) = findings.outcomes.iter().find(|tally| tally.is_failure) {
        add(
            "most frequent failure",
            worst.outcome.clone(),
            format!("{} runs, {}", worst.rate.count, percent(worst.rate.value)),
        );
    }
    let clear = findings.sensitivity.ranking.first().filter(|driver| driver.is_clear);
    if let (Some(driver), Some(output)) = (clear, &findings.sensitivity.ranked_by) {
        let share = driver.first_order.map_or_else(|| "–".to_owned(), |s| percent(s.clamp(0.0, 1.0)));
        add("strongest input", driver.input.clone(), format!("explains {share} of {} alone", output.replace('_', " ")));
    }
    let named = |name: &str| findings.metrics.iter().find(|metric| metric.name == name);
    if let Some(metric) = findings.notable.metric.as_deref().and_then(named) {
        let unit = page::unit::unit(&metric.name).map_or_else(String::new, |unit| format!(" {unit}"));
        let below = format!("95 % stay below; largest {}{unit} in run {}", digits(metric.max, 3), metric.max_run);
        add(&page::unit::words(&metric.name), format!("{}{unit}", digits(metric.p95, 3)), below);
    }
    tiles
}

#[cfg(test)]
mod tests;
