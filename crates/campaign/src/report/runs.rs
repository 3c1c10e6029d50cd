//! The table of runs, runs worth a look, and how to see any of them again.

use super::distributions::chosen;
use crate::findings::{Findings, NotableRun};
use crate::table::{INPUT, Table};
use record::page::number::short;
use record::page::unit::label;
use record::page::{attribute, escape, header, name, table};

/// All runs are listed up to this number.
const ALL: usize = 2000;
/// Most failures listed beyond it, and most columns of inputs and of metrics.
const MOST: usize = 1000;
const COLUMNS: (usize, usize) = (4, 5);

/// A run's index, as a link where there is a recording.
pub(super) fn link(run: u32, links: &[(u32, String)]) -> String {
    match links.iter().find(|(linked, _)| *linked == run) {
        Some((_, address)) => format!("<a href=\"{}\">{run}</a>", attribute(address)),
        None => run.to_string(),
    }
}

/// Notable runs, then all.
pub(super) fn section(table: &Table, findings: &Findings, links: &[(u32, String)]) -> String {
    if table.is_empty() {
        return String::new();
    }
    let rows = listed(table, findings, links);
    let mut text = notable(findings, links);
    text += "<h3>All runs</h3><p>";
    if rows.len() < table.len() {
        text = text.replace("<h3>All runs</h3>", "<h3>Failures and extremes</h3>");
        text += &format!(
            "{} of {} runs: failures (the first {MOST} at most), runs with the smallest or largest value of a metric, \
             and runs with a recording. ",
            rows.len(),
            table.len()
        );
    }
    text += "A click on a head sorts.";
    text += if links.is_empty() { "</p>\n" } else { " A run that is a link has a recording.</p>\n" };
    text + &list(table, findings, links, &rows)
}

/// Rows of the list.
fn listed(table: &Table, findings: &Findings, links: &[(u32, String)]) -> Vec<usize> {
    if table.len() <= ALL {
        return (0..table.len()).collect();
    }
    let mut extremes: Vec<u32> = findings.metrics.iter().flat_map(|metric| [metric.min_run, metric.max_run]).collect();
    extremes.extend(links.iter().map(|(run, _)| *run));
    extremes.sort_unstable();
    let successes = table.successes();
    let mut failures = 0;
    let mut is_listed = |row: usize| {
        let has_failed = match &successes {
            Some(flags) => flags.get(row) != Some(&true),
            None => table.text("outcome", row) == "diverged",
        };
        failures += usize::from(has_failed);
        (has_failed && failures <= MOST) || extremes.binary_search(&table.run(row)).is_ok()
    };
    (0..table.len()).filter(|row| is_listed(*row)).collect()
}

fn list(table_of: &Table, findings: &Findings, links: &[(u32, String)], rows: &[usize]) -> String {
    let ranked = findings.sensitivity.ranking.iter().map(|driver| driver.input.as_str());
    let others = findings.inputs.iter().map(|input| input.name.as_str());
    let mut inputs: Vec<&str> = Vec::new();
    ranked.chain(others).for_each(|name| {
        if !inputs.contains(&name) {
            inputs.push(name)
        }
    });
    let metrics: Vec<&str> = chosen(findings).into_iter().map(|metric| metric.name.as_str()).take(COLUMNS.1).collect();
    let mut columns = header(["#run", "outcome"]);
    let mut cells: Vec<Vec<Option<f64>>> = Vec::new();
    for input in inputs.iter().take(COLUMNS.0) {
        columns.push(format!("#{}", label(input)));
        cells.push(table_of.numbers(&format!("{INPUT}{input}")).unwrap_or_default());
    }
    for metric in metrics {
        columns.push(format!("#{}", label(metric)));
        cells.push(table_of.numbers(metric).unwrap_or_default());
    }
    columns.push("reason".to_owned());
    let row = |row: &usize| {
        let number =
            |column: &Vec<Option<f64>>| column.get(*row).copied().flatten().map_or_else(|| "–".to_owned(), short);
        let mut line = vec![link(table_of.run(*row), links), name(table_of.text("outcome", *row))];
        line.extend(cells.iter().map(number));
        line.push(escape(table_of.text("reason", *row)));
        line
    };
    let rows: Vec<Vec<String>> = rows.iter().map(row).collect();
    // A page of hundreds of runs opens with a look at them, not with all of them.
    let list = table("wrap sortable runs", &columns, &rows);
    if rows.len() > 60 { format!("<details><summary>{} runs</summary>{list}</details>\n", rows.len()) } else { list }
}

fn notable(findings: &Findings, links: &[(u32, String)]) -> String {
    let notable = &findings.notable;
    let mut rows = Vec::new();
    let metric = notable.metric.as_deref().unwrap_or("");
    let mut add = |what: &str, run: &NotableRun| {
        let value = run.value.map_or_else(|| "–".to_owned(), short);
        rows.push(vec![what.to_owned(), link(run.run, links), name(&run.outcome), value, escape(&run.reason)]);
    };
    notable.worst.iter().for_each(|run| add("largest value", run));
    notable.median.iter().for_each(|run| add("median", run));
    notable.first_failures.iter().for_each(|run| add("among the first failures", run));
    if rows.is_empty() {
        return String::new();
    }
    let value = if metric.is_empty() { "#value".to_owned() } else { format!("#{}", label(metric)) };
    let columns = vec!["why".to_owned(), "#run".to_owned(), "outcome".to_owned(), value, "reason".to_owned()];
    "<h3>Worth a look</h3>\n".to_owned() + &table("wrap notable", &columns, &rows)
}

/// How to run one of them again, and what the campaign was of.
pub(super) fn reproduce(table_of: &Table, findings: &Findings, links: &[(u32, String)]) -> String {
    let notable = &findings.notable;
    let example = notable.first_failures.first().or(notable.worst.first()).map_or(0, |run| run.run);
    let mut text = format!(
        "<p>Every run has its own seed, mixed from the campaign’s seed and its index: each can be run alone, on any \
         machine of the same kind \
         with the same bits. TABLE is the file of this campaign.</p>\n<pre>softdock replay TABLE {example}</pre>\n"
    );
    if !links.is_empty() {
        let linked: Vec<String> = links.iter().map(|(run, _)| link(*run, links)).collect();
        let shown = linked.len().min(40);
        let more = if linked.len() > shown { format!(" and {} more", linked.len() - shown) } else { String::new() };
        text += &format!("<p>Recorded runs: {}{more}.</p>\n", linked[..shown].join(", "));
    }
    let facts = [
        ("scenario", &findings.scenario),
        ("seed", &findings.seed.to_string()),
        ("sampling", &findings.sampling),
        ("softdock", &findings.version),
        ("fingerprint", &findings.fingerprint),
    ];
    let facts = facts.iter().filter(|(_, value)| !value.is_empty());
    let rows: Vec<Vec<String>> = facts.map(|(what, value)| vec![(*what).to_owned(), name(value)]).collect();
    text += &table("wrap", &header(["what", "of this campaign"]), &rows);
    let toml = &table_of.header.toml;
    if !toml.is_empty() {
        text += &format!(
            "<details><summary>Scenario <span>with all defaults, before any \
             dispersion</span></summary><pre>{}</pre></details>\n",
            escape(toml)
        );
    }
    text
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::findings::{Findings, Options, tests::table};

    #[test]
    fn a_large_campaign_lists_failures_extremes_and_recordings() {
        let table = table(3000, |i| i % 100 != 99);
        let findings = Findings::of(&table, &Options::default());
        let rows = listed(&table, &findings, &[(7, "7.rrd".into())]);
        assert_eq!((rows.len(), rows[0], rows[1], *rows.last().unwrap()), (32, 0, 7, 2999));
        let text = section(&table, &findings, &[]);
        assert!(text.contains("Failures and extremes") && text.contains("31 of 3000 runs"), "{}", &text[..900]);
    }

    #[test]
    fn links_are_attributes() {
        let links = [(3, "a\"b<c&d.rrd".to_owned())];
        assert_eq!(link(3, &links), "<a href=\"a&quot;b&lt;c&amp;d.rrd\">3</a>");
        assert_eq!(link(4, &links), "4");
    }
}
