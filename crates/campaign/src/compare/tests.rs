//! Comparisons of tables whose differences are known.

#![allow(clippy::unwrap_used)]

use super::*;
use crate::findings::tests::table;
use crate::table::{Cells, Column};

fn column<'t>(table: &'t mut Table, name: &str) -> &'t mut Column {
    table.columns.iter_mut().find(|column| column.name == name).unwrap()
}

/// Adds to every number of a column.
fn add(table: &mut Table, name: &str, of: impl Fn(usize) -> f64) {
    if let Cells::Numbers(cells) = &mut column(table, name).cells {
        cells.iter_mut().enumerate().for_each(|(row, cell)| *cell = cell.map(|x| x + of(row)));
    }
}

fn reports(a: &Table, b: &Table) -> (Comparison, String, String, String) {
    let comparison = Comparison::of(a, b, ("soft <1>", "stiff & 2")).unwrap();
    let html = comparison_html(&comparison, a, b);
    let (markdown, json) = (comparison_markdown(&comparison), comparison_json(&comparison));
    for text in [html.split("<script>").next().unwrap(), &markdown, &json] {
        assert!(!text.contains("NaN") && !text.contains(">inf"));
    }
    assert!(!html.contains("soft <1>") && json.starts_with("{\n  \"format\": \"softdock-comparison-1\""));
    (comparison, html, markdown, json)
}

#[test]
fn a_clear_winner_is_named() {
    let (comparison, ..) = reports(&table(200, |i| i < 150), &table(200, |i| i < 170));
    let success = comparison.success.as_ref().unwrap();
    assert_eq!((success.table.only_a, success.table.only_b, comparison.disagreements.len()), (0, 20, 20));
    assert!((success.difference - 0.1).abs() < 1e-15 && (success.p - 2.0 / f64::from(1 << 20)).abs() < 1e-12);
    assert!(
        comparison.verdict.starts_with(
            "stiff & 2 is better than soft <1>: captured in 85 % of the same 200 runs against 75 %, 10.0 points more"
        ),
        "{}",
        comparison.verdict
    );
    assert_eq!(comparison.disagreements[0].run, 150);
}

#[test]
fn swapping_the_tables_flips_every_difference() {
    let (a, mut b) = (table(100, |i| i < 60), table(100, |i| i > 20));
    add(&mut b, "peak_contact_force_n", |i| (i % 5) as f64);
    let (there, back) = (Comparison::of(&a, &b, ("a", "b")).unwrap(), Comparison::of(&b, &a, ("b", "a")).unwrap());
    for (x, y) in there.metrics.iter().zip(&back.metrics) {
        assert!((x.mean_difference + y.mean_difference).abs() < 1e-12 && x.share_b_larger == y.share_b_smaller);
    }
    let (x, y) = (there.success.unwrap(), back.success.unwrap());
    assert!(x.difference == -y.difference && x.p == y.p && (x.interval.low + y.interval.high).abs() < 1e-12);
}

#[test]
fn what_cannot_be_told_says_how_many_runs_it_would_take() {
    let (comparison, ..) = reports(&table(200, |i| i < 150), &table(200, |i| i < 152));
    assert!(
        comparison.verdict.contains("cannot tell which is better")
            && comparison.verdict.contains("runs would be needed"),
        "{}",
        comparison.verdict
    );
    let (same, ..) = reports(&table(200, |i| i < 150), &table(200, |i| i < 150));
    assert!(same.verdict.contains("agree on success in every one of the 200 common runs"), "{}", same.verdict);
}

#[test]
fn paired_metrics_see_what_the_spread_hides() {
    let (a, mut b) = (table(60, |_| true), table(60, |_| true));
    // The force runs from 10 to 69 N; the pairs differ by 0.4 … 0.6 N.
    add(&mut b, "peak_contact_force_n", |i| 0.4 + 0.1 * (i % 3) as f64);
    let (comparison, ..) = reports(&a, &b);
    let force = &comparison.metrics[0];
    assert!((force.mean_difference - 0.5).abs() < 1e-9 && (force.median_difference - 0.5).abs() < 1e-9);
    assert!(force.is_clear && force.share_b_larger == 1.0 && force.ks_distance.unwrap() < 0.05);
    let constant = &comparison.metrics[1];
    assert!(!constant.is_clear && constant.p == Some(1.0) && constant.standardised.is_none());
}

#[test]
fn runs_in_one_table_only_are_counted_and_said() {
    let (comparison, ..) = reports(&table(50, |i| i < 30), &table(40, |i| i < 30));
    assert_eq!((comparison.pairs, comparison.only_in_a, comparison.only_in_b), (40, 10, 0));
    assert!(comparison.remarks[0].starts_with("10 runs are in soft <1> only"), "{:?}", comparison.remarks);
}

#[test]
fn the_last_bit_of_an_input_counts() {
    let (a, mut b) = (table(50, |i| i < 30), table(50, |i| i < 30));
    add(&mut b, "input.a_deg", |i| if i >= 31 { f64::EPSILON * i as f64 } else { 0.0 });
    let error = Comparison::of(&a, &b, ("A", "B")).unwrap_err();
    assert_eq!(
        error.to_string(),
        "run 31: input \"a_deg\" is 31.0 in A and 31.000000000000007 in B, so the runs are no pairs; run both \
         campaigns with the same \
         seed, dispersions and sampling"
    );
}

#[test]
fn tables_that_are_no_pairs_are_refused() {
    let (a, mut b) = (table(3, |_| true), table(3, |_| true));
    column(&mut b, "run").cells = Cells::Integers(vec![Some(7), Some(8), Some(9)]);
    assert!(matches!(Comparison::of(&a, &b, ("A", "B")), Err(CompareError::NoCommonRun { runs_a: 3, .. })));
    column(&mut b, "run").cells = Cells::Integers(vec![Some(1), Some(2), Some(1)]);
    assert!(matches!(Comparison::of(&a, &b, ("A", "B")), Err(CompareError::RunTwice { run: 1, .. })));
}

#[test]
fn one_run_and_tables_without_success_have_pages() {
    let (comparison, ..) = reports(&table(1, |_| true), &table(1, |_| false));
    assert!(comparison.metrics.iter().all(|metric| metric.interval.is_none() && !metric.is_clear));
    let (mut a, b) = (table(30, |_| true), table(30, |_| true));
    a.header.success.clear();
    let (comparison, html, ..) = reports(&a, &b);
    assert!(comparison.success.is_none() && !html.contains("id=\"success\""));
    assert!(comparison.verdict.starts_with("Success cannot be compared"), "{}", comparison.verdict);
}

#[test]
fn changed_lines_of_the_scenario_are_shown() {
    let (mut a, mut b) = (table(20, |i| i < 10), table(20, |i| i < 12));
    a.header.toml = "[contact]\nmu = 0.3\n".into();
    b.header.toml = "[contact]\nmu = 0.4\n".into();
    let (_, html, ..) = reports(&a, &b);
    assert!(html.contains("<code>mu = 0.3</code>") && html.contains("<code>mu = 0.4</code>"));
}
