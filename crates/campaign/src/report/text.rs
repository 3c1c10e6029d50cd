//! The report for a terminal, a pull request or a program: Markdown and JSON.

use crate::findings::Findings;
use record::page::number::{digits, p_value, percent, rate, short};
use serde::Serialize;
use std::fmt::Write;

/// Format of the JSON report.
pub const JSON_FORMAT: &str = "softdock-campaign-report-1";
/// Most inputs of the ranking.
const MOST: usize = 10;

/// Findings with the name of their format in front.
#[derive(Serialize)]
struct Tagged<'a, T> {
    format: &'a str,
    #[serde(flatten)]
    content: &'a T,
}

/// Pretty JSON of anything, its format in front; an empty object where it cannot be written, which no plain data brings
/// about.
pub(crate) fn tagged_json<T: Serialize>(format: &str, content: &T) -> String {
    serde_json::to_string_pretty(&Tagged { format, content }).unwrap_or_else(|_| "{}".to_owned()) + "\n"
}

/// The findings as JSON.
pub fn report_json(findings: &Findings) -> String {
    tagged_json(JSON_FORMAT, findings)
}

/// A cell of a Markdown table.
pub(crate) fn cell(text: &str) -> String {
    text.replace('\\', "\\\\").replace('|', "\\|").replace('<', "&lt;").replace(['\n', '\r'], " ")
}

/// A Markdown table.
pub(crate) fn markdown_table(header: &[&str], rows: &[Vec<String>]) -> String {
    let mut text = format!("| {} |\n|{}\n", header.join(" | "), " --- |".repeat(header.len()));
    for row in rows {
        let _ = writeln!(text, "| {} |", row.iter().map(|c| cell(c)).collect::<Vec<_>>().join(" | "));
    }
    text + "\n"
}

/// The report as Markdown.
pub fn report_markdown(findings: &Findings) -> String {
    let mut text = format!("# {}\n\n{}\n\n", cell(&findings.scenario), cell(&findings.verdict));
    findings.remarks.iter().for_each(|remark| text += &format!("> {}\n\n", cell(remark)));
    text += &outcomes(findings);
    text += &ranking(findings);
    text += &metrics(findings);
    text += &inputs(findings);
    let notable = &findings.notable;
    let example = notable.first_failures.first().or(notable.worst.first()).map_or(0, |run| run.run);
    let _ = write!(
        text,
        "## How to reproduce\n\n    softdock replay TABLE {example}\n\nseed {}, {} runs, softdock {}, fingerprint {}\n",
        findings.seed,
        findings.runs,
        cell(&findings.version),
        cell(&findings.fingerprint)
    );
    text
}

fn outcomes(findings: &Findings) -> String {
    let mut rows = Vec::new();
    for tally in &findings.outcomes {
        let low = rate(tally.rate.interval.low);
        let interval = format!("{} … {}", low.trim_end_matches(" %"), rate(tally.rate.interval.high));
        let reason = tally.reasons.first().map_or_else(String::new, |r| format!("{} ({})", r.pattern, r.runs));
        rows.push(vec![tally.outcome.clone(), tally.rate.count.to_string(), rate(tally.rate.value), interval, reason]);
    }
    section("Outcomes", &["outcome", "runs", "rate", "95 % interval", "most frequent reason"], &rows)
}

fn ranking(findings: &Findings) -> String {
    let number = |value: Option<f64>, write: fn(f64) -> String| value.map_or_else(|| "–".to_owned(), write);
    let share = |s: f64| percent(s.clamp(0.0, 1.0));
    let row = |driver: &crate::findings::Driver| {
        vec![
            driver.input.clone(),
            number(driver.first_order, share),
            number(driver.noise, share),
            number(driver.spearman, |rho| digits(rho, 2)),
            number(driver.p, p_value),
            if driver.is_clear { "clear" } else { "not told from chance" }.to_owned(),
        ]
    };
    let rows: Vec<Vec<String>> = findings.sensitivity.ranking.iter().take(MOST).map(row).collect();
    let of = findings.sensitivity.ranked_by.as_deref().unwrap_or("success");
    section(
        &format!("What drives {}", cell(of)),
        &["input", "explains alone", "noise level", "ρ", "p", "influence"],
        &rows,
    )
}

fn metrics(findings: &Findings) -> String {
    let row = |m: &crate::findings::MetricSummary| {
        let numbers = [m.mean, m.p05, m.p50, m.p95, m.max].map(short);
        let mut row = vec![m.name.clone(), m.count.to_string()];
        row.extend(numbers);
        row.push(m.max_run.to_string());
        row
    };
    let rows: Vec<Vec<String>> = findings.metrics.iter().map(row).collect();
    section("Metrics", &["metric", "runs", "mean", "5 %", "median", "95 %", "max", "run of max"], &rows)
}

fn inputs(findings: &Findings) -> String {
    let row = |i: &crate::findings::InputSummary| {
        let deviation = i.largest_deviation.map_or_else(|| "not read back".to_owned(), short);
        vec![
            i.name.clone(),
            format!("{} … {}", short(i.min), short(i.max)),
            short(i.mean),
            i.std.map_or_else(|| "–".to_owned(), short),
            deviation,
        ]
    };
    let rows: Vec<Vec<String>> = findings.inputs.iter().map(row).collect();
    section("Inputs", &["input", "drawn", "mean", "std", "largest abs(applied − drawn)"], &rows)
}

fn section(title: &str, header: &[&str], rows: &[Vec<String>]) -> String {
    if rows.is_empty() { String::new() } else { format!("## {title}\n\n{}", markdown_table(header, rows)) }
}
