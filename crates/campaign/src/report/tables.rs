//! Tables of inputs and of metrics.

use crate::findings::{Findings, InputSummary, MetricSummary};
use record::page::number::{rate, short};
use record::page::unit::unit;
use record::page::{escape, header, name, table};

/// Inputs as drawn, and what the built model says.
pub(super) fn inputs(findings: &Findings) -> String {
    if findings.inputs.is_empty() {
        return String::new();
    }
    let columns = [
        "input",
        "unit",
        "#smallest",
        "#largest",
        "#mean",
        "#std",
        "#largest |applied − drawn|",
        "#read back in",
        "drawn as",
    ];
    let rows: Vec<Vec<String>> = findings.inputs.iter().map(input).collect();
    let sampling = if findings.sampling.is_empty() {
        String::new()
    } else {
        format!(" Sampling: {}.", escape(findings.sampling.trim_end_matches('.')))
    };
    let text = format!(
        "<p>Values as they were drawn, and how far the value read back from the built model lies from the draw at \
         most: nought means that \
         every draw arrived.{sampling}</p>\n"
    );
    text + &table("wrap sortable", &header(columns), &rows)
}

/// The unit of an input: of its name, else of its path in the scenario.
fn unit_of(input: &InputSummary) -> &'static str {
    unit(&input.name).or_else(|| unit(&input.path)).unwrap_or("")
}

fn input(input: &InputSummary) -> Vec<String> {
    let deviation = match (input.largest_deviation, input.deviation_run) {
        (Some(0.0), _) => "0".to_owned(),
        (Some(deviation), Some(run)) => format!("{}<small>run {run}</small>", short(deviation)),
        _ => "<em>not read back</em>".to_owned(),
    };
    let path = if input.path.is_empty() || input.path == input.name {
        String::new()
    } else {
        format!("<small>{}</small>", name(&input.path))
    };
    vec![
        format!("<b>{}</b>{path}", name(&input.name)),
        unit_of(input).to_owned(),
        short(input.min),
        short(input.max),
        short(input.mean),
        input.std.map_or_else(|| "–".to_owned(), short),
        deviation,
        format!("{} of {}", input.applied_count, input.count),
        escape(&input.distribution),
    ]
}

/// Every metric.
pub(super) fn metrics(findings: &Findings) -> String {
    let mut text = String::new();
    if !findings.metrics.is_empty() {
        text += "<p>Of the runs that have a value; below the smallest and the largest the run that has it.</p>\n";
        text +=
            &table("wrap sortable", &header(METRIC_COLUMNS), &findings.metrics.iter().map(metric).collect::<Vec<_>>());
    }
    if !findings.flags.is_empty() {
        let row = |flag: &crate::findings::FlagSummary| {
            let interval = flag.rate.interval;
            let low = rate(interval.low);
            vec![
                name(&flag.name),
                flag.rate.count.to_string(),
                flag.rate.of.to_string(),
                rate(flag.rate.value),
                format!("{} … {}", low.trim_end_matches(" %"), rate(interval.high)),
            ]
        };
        let rows: Vec<Vec<String>> = findings.flags.iter().map(row).collect();
        text += "<h3>Flags</h3>\n";
        text += &table("wrap", &header(["flag", "#true", "#of", "#rate", "#95 % interval"]), &rows);
    }
    if !findings.work.is_empty() {
        text += "<details><summary>Work counters</summary>\n";
        text += &table("wrap sortable", &header(METRIC_COLUMNS), &findings.work.iter().map(metric).collect::<Vec<_>>());
        text += "</details>\n";
    }
    text
}

const METRIC_COLUMNS: [&str; 11] =
    ["metric", "unit", "#runs", "#mean", "#std", "#min", "#5 %", "#median", "#95 %", "#99 %", "#max"];

fn metric(metric: &MetricSummary) -> Vec<String> {
    let end = |value: f64, run: u32| {
        if metric.varies() { format!("{}<small>run {run}</small>", short(value)) } else { short(value) }
    };
    vec![
        name(&metric.name),
        unit(&metric.name).unwrap_or("").to_owned(),
        metric.count.to_string(),
        short(metric.mean),
        metric.std.map_or_else(|| "–".to_owned(), short),
        end(metric.min, metric.min_run),
        short(metric.p05),
        short(metric.p50),
        short(metric.p95),
        short(metric.p99),
        end(metric.max, metric.max_run),
    ]
}
