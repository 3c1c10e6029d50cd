//! The report of ordinary and of awkward tables.

#![allow(clippy::unwrap_used)]

use super::*;
use crate::findings::{Options, tests::table};
use crate::table::{Cells, Column, Input};

/// All three reports of a table.
fn reports(table: &Table) -> (String, String, String) {
    let findings = Findings::of(table, &Options::default());
    let links = [(1, "runs/1.rrd".to_owned())];
    (report_html(table, &findings, &links), report_markdown(&findings), report_json(&findings))
}

/// Whether every element that is opened is closed.
fn is_balanced(html: &str) -> bool {
    ["table", "div", "section", "svg", "figure", "tr", "td", "p", "details", "pre", "span", "b", "i", "u"].iter().all(
        |tag| {
            let opened = html.matches(&format!("<{tag}>")).count() + html.matches(&format!("<{tag} ")).count();
            opened == html.matches(&format!("</{tag}>")).count()
        },
    )
}

fn check(table: &Table) -> (String, String, String) {
    let (html, markdown, json) = reports(table);
    // The script that sorts asks whether something is NaN.
    let body = html.split("<script>").next().unwrap_or("");
    for text in [body, &markdown, &json] {
        let bad = ["NaN", ">inf", ">-inf"].iter().find(|bad| text.contains(**bad));
        assert!(bad.is_none(), "{bad:?} in a table of {} runs", table.len());
    }
    assert!(is_balanced(&html));
    assert!(json.starts_with("{\n  \"format\": \"softdock-campaign-report-1\""), "{json}");
    (html, markdown, json)
}

#[test]
fn a_campaign_has_all_its_sections() {
    let (html, markdown, _) = check(&table(300, |i| i % 7 != 0 && i < 280));
    for id in [
        "outcomes",
        "drivers",
        "envelope",
        "distributions",
        "pairs",
        "sensitivity",
        "inputs",
        "metrics",
        "runs",
        "reproduce",
    ] {
        assert!(html.contains(&format!("<section id=\"{id}\">")), "{id}");
    }
    assert!(html.contains("href=\"runs/1.rrd\"") && html.contains("softdock replay TABLE 0"));
    assert!(markdown.contains("## Outcomes") && markdown.contains("| captured |"));
}

#[test]
fn few_runs_all_captured_and_none_captured_have_pages() {
    for (count, threshold) in [(0, 0), (1, 1), (1, 0), (3, 2), (12, 12), (40, 40), (40, 0)] {
        check(&table(count, |i| i < threshold));
    }
    check(&Table::default());
}

#[test]
fn a_campaign_without_inputs_has_no_empty_panels() {
    let mut bare = table(50, |i| i < 30);
    bare.header.inputs.clear();
    bare.columns.retain(|c| !c.name.starts_with("input.") && !c.name.starts_with("applied."));
    let (html, _, _) = check(&bare);
    for id in ["drivers", "envelope", "pairs", "sensitivity", "inputs"] {
        assert!(!html.contains(&format!("<section id=\"{id}\">")), "{id}");
    }
}

#[test]
fn names_with_markup_are_text() {
    let mut odd = table(40, |i| i % 2 == 0);
    odd.header.scenario = "a <script>&\"b".into();
    odd.header.toml = "x = \"</pre><script>\"".into();
    odd.header.inputs[0].name = "a<b>&c_m".into();
    odd.header.inputs[0].distribution = "normal(<0>)".into();
    for column in &mut odd.columns {
        match column.name.as_str() {
            "input.a_deg" => column.name = "input.a<b>&c_m".into(),
            "peak_contact_force_n" => column.name = "peak<i>&_n".into(),
            _ => {}
        }
        if let Cells::Texts(texts) = &mut column.cells {
            texts.iter_mut().flatten().for_each(|text| *text = format!("<u>{text}</u> | & \"x\""));
        }
    }
    let (html, markdown, _) = check(&odd);
    assert_eq!(html.matches("<script>").count(), 1, "only the one that sorts");
    assert!(!html.contains("<u>") && !html.contains("a<b>") && !html.contains("normal(<0>)"));
    assert!(markdown.contains("\\|") && !markdown.contains("<u>"));
}

#[test]
fn a_hundred_inputs_fit() {
    let mut wide = table(200, |i| i < 150);
    for k in 0..100_u64 {
        let name = format!("a_rather_long_name_of_an_input_number_{k}_deg");
        let value = |i: usize| ((i as u64 * (2 * k + 37) + k * k) % 199) as f64;
        let cells = Cells::Numbers((0..200).map(|i| Some(value(i))).collect());
        wide.header.inputs.push(Input { name: name.clone(), ..Input::default() });
        wide.columns.push(Column { name: format!("input.{name}"), cells });
    }
    let (html, _, _) = check(&wide);
    assert!(html.contains("inputs and 0 outputs of weaker effect are left out"));
    assert!(html.len() < 600_000, "{}", html.len());
}

#[test]
fn long_tables_stay_below_a_few_megabytes() {
    let (html, _, _) = check(&table(12_000, |i| i % 3 != 0));
    assert!(html.len() < 3_000_000, "{}", html.len());
}

#[test]
fn the_same_table_gives_the_same_bits() {
    let table = table(120, |i| i < 90);
    assert_eq!(reports(&table), reports(&table));
}
