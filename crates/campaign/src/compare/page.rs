//! The page of a comparison.

use super::changes::changes;
use super::drawings;
use super::verdict::{clear, metric_words, points, with_unit};
use super::{Comparison, LEVEL, PairedMetric, PairedSuccess, pairs};
use crate::stats::Interval;
use crate::table::Table;
use record::page::number::{grouped, p_value, p_words, percent, rate, short};
use record::page::unit::unit;
use record::page::{
    Axis, Section, escape, header, interval_row, legend, name, page_html, sentence, table, ticks_row, tiles,
};

/// Most disagreements and changed lines listed.
const MOST: (usize, usize) = (500, 60);

/// The page; the tables are those that were compared.
pub fn comparison_html(comparison: &Comparison, a: &Table, b: &Table) -> String {
    let names = (comparison.name_a.as_str(), comparison.name_b.as_str());
    let pairs = pairs(a, b, names).unwrap_or_default();
    let sections = [
        Section { id: "success", title: "Success", body: success(comparison) },
        Section { id: "changes", title: "What was changed", body: changed(comparison, a, b) },
        Section { id: "metrics", title: "Metrics: B less A, run by run", body: forest(comparison) },
        Section { id: "pairs", title: "Pair by pair", body: drawings::section(comparison, a, b, &pairs) },
        Section { id: "disagreements", title: "Runs in which they disagree", body: disagreements(comparison) },
        Section { id: "campaigns", title: "The two campaigns", body: campaigns(comparison, a, b) },
    ];
    let footer = format!(
        "softdock {}, <code>compare</code>. Runs are paired by index and have the same draws; differences are B − A. \
         A difference is called clear \
         at 5 %, over all metrics together (Holm).",
        escape(&b.header.version)
    );
    let title = format!("{} against {}", names.0, names.1);
    page_html(&title, &head(comparison), &sections, &footer)
}

fn head(comparison: &Comparison) -> String {
    let (name_a, name_b) = (name(&comparison.name_a), name(&comparison.name_b));
    let pill = match &comparison.success {
        Some(success) if success.p < LEVEL => "<span class=\"pill good\">clear difference</span> ",
        Some(_) => "<span class=\"pill fair\">cannot be told apart</span> ",
        None => "",
    };
    let mut text = format!(
        "<p class=\"over\">Comparison of two campaigns on the same draws, {} common runs</p><h1>A: {name_a} — B: \
         {name_b}</h1>\n\
         <p class=\"verdict\">{pill}{}</p>\n",
        grouped(comparison.pairs as u64),
        sentence(&comparison.verdict)
    );
    let clear = clear(comparison);
    if comparison.success.is_some() && !clear.is_empty() {
        let words: Vec<String> = clear.iter().take(3).map(|m| sentence(&metric_words(m, "B"))).collect();
        text += &format!(
            "<p>Beyond success, {} of {} metrics differ clearly: {}.</p>\n",
            clear.len(),
            comparison.metrics.len(),
            words.join("; ")
        );
    }
    text += &tiles(&tile_list(comparison));
    for remark in &comparison.remarks {
        text += &format!("<p class=\"remark\">{}</p>\n", sentence(remark));
    }
    text
}

fn tile_list(comparison: &Comparison) -> Vec<(String, String, String)> {
    let mut tiles = Vec::new();
    if let Some(success) = &comparison.success {
        for (label, of, campaign) in
            [("A", &success.rate_a, &comparison.name_a), ("B", &success.rate_b, &comparison.name_b)]
        {
            let label = format!("{label}: {}", success.flag_a.replace('_', " "));
            tiles.push((label, rate(of.value), format!("{} of {}, {campaign}", of.count, of.of)));
        }
        let Interval { low, high } = success.interval;
        let below = format!("95 % interval {} … {}", points(low), points(high));
        tiles.push(("B − A".to_owned(), format!("{} points", points(success.difference)), below));
        tiles.push(("exact McNemar".to_owned(), p_words(success.p), "of no difference".to_owned()));
    }
    tiles
}

fn success(comparison: &Comparison) -> String {
    let Some(success) = &comparison.success else { return String::new() };
    let rates = [("A", &comparison.name_a, &success.rate_a, "o1"), ("B", &comparison.name_b, &success.rate_b, "o2")];
    let ends = rates.iter().flat_map(|r| [r.2.interval.low, r.2.interval.high]).map(|share| 100.0 * share);
    let (low, high) = ends.fold((100.0_f64, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
    let room = 0.15 * (high - low).max(2.0);
    let axis = Axis::between((low - room).max(0.0), (high + room).min(100.0), (0.0, 100.0));
    let mut text = String::from(
        "<p>Rates of success over the common runs with 95 % intervals (Wilson). Because the runs are paired, the \
         difference is known better than these intervals, which overlap easily, make it look.</p>\n",
    );
    for (letter, campaign, of, class) in rates {
        let at = |share: f64| axis.at(100.0 * share);
        let mark = (class, at(of.interval.low), at(of.value), at(of.interval.high));
        let head = format!("{letter}: {}", name(campaign));
        text += &interval_row(&head, &[mark], None, &format!("{}<br>{} of {}", rate(of.value), of.count, of.of));
    }
    text += &ticks_row(&axis.ticks().into_iter().map(|(v, l)| (axis.at(v), l)).collect::<Vec<_>>(), "%");
    text + &four(comparison, success)
}

/// The 2×2 table and the test.
fn four(comparison: &Comparison, success: &PairedSuccess) -> String {
    let (name_a, name_b) = (&comparison.name_a, &comparison.name_b);
    let of = &success.table;
    let columns = ["".to_owned(), "B succeeds".to_owned(), "B fails".to_owned()];
    let rows = [
        vec!["A succeeds".to_owned(), of.both.to_string(), format!("<b>{}</b>", of.only_a)],
        vec!["A fails".to_owned(), format!("<b>{}</b>", of.only_b), of.neither.to_string()],
    ];
    let needed = success.runs_needed.map_or_else(String::new, |runs| {
        format!(
            " To see a difference of this size in four campaigns of five takes about {} runs (Connor 1987).",
            grouped(runs)
        )
    });
    format!(
        "<h3>Pairs</h3>{}<p>Only the {} runs in which they disagree speak: {} for {}, {} for {}. Were neither better, \
         a split as uneven would \
         happen with {} (exact McNemar test). Difference of the rates {} points, 95 % interval {} … {} (Newcombe \
         1998, paired, method 10).{needed}</p>\n",
        table("square", &columns, &rows),
        of.only_a + of.only_b,
        of.only_a,
        name(name_a),
        of.only_b,
        name(name_b),
        escape(&p_words(success.p)),
        points(success.difference),
        points(success.interval.low),
        points(success.interval.high)
    )
}

fn changed(comparison: &Comparison, a: &Table, b: &Table) -> String {
    let changes = changes(&a.header.toml, &b.header.toml);
    if changes.is_empty() {
        return String::new();
    }
    let row = |change: &super::changes::Change| {
        let of = if change.is_new { ("B", &comparison.name_b) } else { ("A", &comparison.name_a) };
        vec![
            format!("{}: {}", of.0, name(of.1)),
            escape(&change.section),
            format!("<code>{}</code>", escape(&change.line)),
        ]
    };
    let rows: Vec<Vec<String>> = changes.iter().take(MOST.1).map(row).collect();
    let more = changes.len() - rows.len();
    let more = if more > 0 { format!("<p>{more} more lines differ.</p>\n") } else { String::new() };
    "<p>Lines of the scenarios, with all defaults written out, that are in one of them only.</p>\n".to_owned()
        + &table("wrap", &header(["only in", "table", "line"]), &rows)
        + &more
}

/// Standardised differences on one axis, then figures of all metrics.
fn forest(comparison: &Comparison) -> String {
    if comparison.metrics.is_empty() {
        return String::new();
    }
    let differs = |metric: &&PairedMetric| metric.share_b_larger + metric.share_b_smaller > 0.0;
    let drawn = || {
        let differing = comparison.metrics.iter().filter(differs);
        differing.filter_map(|m| Some((m, m.standardised?, m.standardised_interval?)))
    };
    let mut text = String::new();
    if drawn().next().is_some() {
        let largest = drawn().flat_map(|d| [d.2.low.abs(), d.2.high.abs()]).fold(0.02, f64::max);
        let axis = Axis::between(-1.08 * largest, 1.08 * largest, (0.0, 100.0));
        text += "<p>Mean difference of the pairs in units of the metric’s spread over the runs, with its 95 % \
                interval: left of the line B is smaller.</p>\n";
        text +=
            &legend(&[("o0", "clear, over all metrics together"), ("o5", "may be chance"), ("bound", "no difference")]);
        for (metric, value, interval) in drawn() {
            let class = if metric.is_clear { "o0" } else { "o5" };
            let mark = (class, axis.at(interval.low), axis.at(value), axis.at(interval.high));
            let mean = with_unit(metric.mean_difference, &metric.name);
            let after = format!("{mean}<br>p {}", escape(&metric.holm_p.map_or_else(String::new, p_value)));
            text += &interval_row(&name(&metric.name), &[mark], Some(axis.at(0.0)), &after);
        }
        text += &ticks_row(
            &axis.ticks().into_iter().map(|(v, l)| (axis.at(v), l)).collect::<Vec<_>>(),
            "standard deviations",
        );
    }
    let same: Vec<String> = comparison.metrics.iter().filter(|m| !differs(m)).map(|m| name(&m.name)).collect();
    if !same.is_empty() {
        text += &format!("<p>The same in every pair: {}.</p>\n", same.join(", "));
    }
    text + &figures(comparison)
}

fn figures(comparison: &Comparison) -> String {
    let columns = [
        "metric",
        "unit",
        "#pairs",
        "#mean A",
        "#mean B",
        "#mean B − A",
        "#95 % interval",
        "#median B − A",
        "#B larger in",
        "#p (Holm)",
        "clear",
    ];
    let row = |m: &PairedMetric| {
        vec![
            name(&m.name),
            unit(&m.name).unwrap_or("").to_owned(),
            m.pairs.to_string(),
            short(m.mean_a),
            short(m.mean_b),
            short(m.mean_difference),
            m.interval.map_or_else(|| "–".to_owned(), |i| format!("{} … {}", short(i.low), short(i.high))),
            short(m.median_difference),
            percent(m.share_b_larger),
            escape(&m.holm_p.map_or_else(|| "–".to_owned(), p_value)),
            if m.is_clear { "<b>yes</b>" } else { "no" }.to_owned(),
        ]
    };
    let rows: Vec<Vec<String>> = comparison.metrics.iter().map(row).collect();
    table("wrap sortable", &header(columns), &rows)
}

fn disagreements(comparison: &Comparison) -> String {
    if comparison.disagreements.is_empty() {
        return String::new();
    }
    let row = |d: &super::Disagreement| {
        let cell = |outcome: &str, reason: &str| format!("{}<small>{}</small>", name(outcome), escape(reason));
        vec![d.run.to_string(), name(&d.succeeds), cell(&d.outcome_a, &d.reason_a), cell(&d.outcome_b, &d.reason_b)]
    };
    let rows: Vec<Vec<String>> = comparison.disagreements.iter().take(MOST.0).map(row).collect();
    let more = comparison.disagreements.len() - rows.len();
    let more = if more > 0 { format!("<p>{more} more are in the JSON.</p>\n") } else { String::new() };
    let columns = [
        "#run".to_owned(),
        "succeeds".to_owned(),
        format!("A: {}", comparison.name_a),
        format!("B: {}", comparison.name_b),
    ];
    table("sortable disagreements", &columns, &rows) + &more
}

fn campaigns(comparison: &Comparison, a: &Table, b: &Table) -> String {
    let row = |what: &str, of: fn(&Table) -> String| vec![what.to_owned(), name(&of(a)), name(&of(b))];
    let rows = vec![
        row("scenario", |t| t.header.scenario.clone()),
        row("runs", |t| t.len().to_string()),
        row("seed", |t| t.header.seed.to_string()),
        row("sampling", |t| t.header.sampling.clone()),
        row("softdock", |t| t.header.version.clone()),
        row("fingerprint", |t| t.header.fingerprint.clone()),
    ];
    let columns = ["".to_owned(), format!("A: {}", comparison.name_a), format!("B: {}", comparison.name_b)];
    let inputs: Vec<String> = comparison.common_inputs.iter().map(|input| name(input)).collect();
    let shared = if inputs.is_empty() {
        String::new()
    } else {
        format!(
            "<p>Inputs in common, equal to the last bit in all {} pairs: {}.</p>\n",
            comparison.pairs,
            inputs.join(", ")
        )
    };
    table("wrap", &columns, &rows) + &shared
}
