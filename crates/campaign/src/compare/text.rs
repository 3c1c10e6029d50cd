//! The comparison as Markdown and as JSON.

use super::Comparison;
use super::verdict::points;
use crate::report::text::{cell, markdown_table, tagged_json};
use record::page::number::{p_value, percent, rate, short};

/// Format of the JSON comparison.
pub const JSON_FORMAT: &str = "softdock-comparison-1";
/// Most runs listed.
const MOST: usize = 20;

/// The comparison as JSON.
pub fn comparison_json(comparison: &Comparison) -> String {
    tagged_json(JSON_FORMAT, comparison)
}

/// The comparison as Markdown.
pub fn comparison_markdown(comparison: &Comparison) -> String {
    let (name_a, name_b) = (cell(&comparison.name_a), cell(&comparison.name_b));
    let mut text = format!("# {name_a} against {name_b}\n\n{}\n\n", cell(&comparison.verdict));
    comparison.remarks.iter().for_each(|remark| text += &format!("> {}\n\n", cell(remark)));
    text += &success(comparison);
    text += &metrics(comparison);
    text += &disagreements(comparison);
    text
}

fn success(comparison: &Comparison) -> String {
    let Some(success) = &comparison.success else { return String::new() };
    let row = |name: &str, of: &crate::stats::Rate| {
        let interval = format!("{} … {}", rate(of.interval.low), rate(of.interval.high));
        vec![name.to_owned(), of.count.to_string(), rate(of.value), interval]
    };
    let rows = [row(&comparison.name_a, &success.rate_a), row(&comparison.name_b, &success.rate_b)];
    let table = &success.table;
    format!(
        "## Success\n\n{}Both succeed in {} runs, only {} in {}, only {} in {}, neither in {}. Difference of the \
         rates, B − A: {} points, 95 % \
         interval {} … {} (Newcombe 1998, method 10); exact McNemar p {}.\n\n",
        markdown_table(&["campaign", "successes", "rate", "95 % interval"], &rows),
        table.both,
        cell(&comparison.name_a),
        table.only_a,
        cell(&comparison.name_b),
        table.only_b,
        table.neither,
        points(success.difference),
        points(success.interval.low),
        points(success.interval.high),
        cell(&p_value(success.p))
    )
}

fn metrics(comparison: &Comparison) -> String {
    if comparison.metrics.is_empty() {
        return String::new();
    }
    let row = |metric: &super::PairedMetric| {
        let interval =
            metric.interval.map_or_else(|| "–".to_owned(), |i| format!("{} … {}", short(i.low), short(i.high)));
        vec![
            metric.name.clone(),
            metric.pairs.to_string(),
            short(metric.mean_a),
            short(metric.mean_b),
            short(metric.mean_difference),
            interval,
            percent(metric.share_b_larger),
            metric.holm_p.map_or_else(|| "–".to_owned(), p_value),
        ]
    };
    let rows: Vec<Vec<String>> = comparison.metrics.iter().map(row).collect();
    let header = ["metric", "pairs", "mean A", "mean B", "mean B − A", "95 % interval", "B larger in", "p (Holm)"];
    format!("## Metrics\n\n{}", markdown_table(&header, &rows))
}

fn disagreements(comparison: &Comparison) -> String {
    if comparison.disagreements.is_empty() {
        return String::new();
    }
    let row = |d: &super::Disagreement| {
        vec![
            d.run.to_string(),
            d.succeeds.clone(),
            format!("{}: {}", d.outcome_a, d.reason_a),
            format!("{}: {}", d.outcome_b, d.reason_b),
        ]
    };
    let rows: Vec<Vec<String>> = comparison.disagreements.iter().take(MOST).map(row).collect();
    let more = comparison.disagreements.len() - rows.len();
    let more = if more > 0 { format!("{more} more are in the JSON.\n") } else { String::new() };
    format!("## Runs in which they disagree\n\n{}{more}", markdown_table(&["run", "succeeds", "A", "B"], &rows))
}
