//! The guard of what a step costs: its arithmetic, its reading of profiles, and that Changes tells why a figure moved.
//!
//! The counting itself is `cargo bench --profile dev --no-default-features --bench instructions`, with valgrind, in CI.
#![allow(clippy::unwrap_used, dead_code)]

#[path = "../benches/instructions/callgrind.rs"]
mod callgrind;
#[path = "../benches/instructions/table.rs"]
mod table;

use std::fs;
use std::path::Path;
use table::{Row, Verdict, bless, compare, parse, print};

fn read(path: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

fn row(case: &str, instructions: u64) -> Row {
    Row { case: case.to_owned(), instructions, reason: String::new() }
}

fn counted(figures: &[(&str, u64)]) -> Vec<(String, u64)> {
    figures.iter().map(|(case, n)| ((*case).to_owned(), *n)).collect()
}

/// Words, however lines are broken.
fn words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn five_per_cent_more_of_one_figure_fails_and_two_do_not() {
    let committed = parse(&read("tests/tables/instructions.md"));
    assert!(committed.len() > 20, "the committed table has {} rows", committed.len());
    for planted in &committed {
        let with = |factor: f64| -> Vec<(String, u64)> {
            let figure = |r: &Row| if r == planted { (r.instructions as f64 * factor) as u64 } else { r.instructions };
            committed.iter().map(|r| (r.case.clone(), figure(r))).collect()
        };
        let bad = |factor| compare(&committed, &with(factor)).iter().filter(|(_, v, _)| !v.is_good()).count();
        assert_eq!((bad(1.05), bad(1.02), bad(0.9)), (1, 0, 0), "{}", planted.case);
    }
}

#[test]
fn a_case_without_a_row_and_a_row_without_a_case_fail() {
    let verdicts = compare(&[row("step", 100), row("old", 7)], &counted(&[("step", 100), ("new", 5)]));
    let verdicts: Vec<Verdict> = verdicts.into_iter().map(|v| v.1).collect();
    assert_eq!(verdicts, [Verdict::Same, Verdict::New, Verdict::Gone]);
    assert!(!Verdict::New.is_good() && !Verdict::Gone.is_good());
}

#[test]
fn a_blessing_moves_what_left_the_margin_and_says_why() {
    let committed = [row("grown", 100), row("crept", 100), row("fallen", 100)];
    let now = counted(&[("grown", 104), ("crept", 103), ("fallen", 90), ("new", 5)]);
    let blessed = bless(&committed, &now, "why");
    let expected = [
        Row { reason: "why".into(), ..row("grown", 104) },
        row("crept", 100),
        Row { reason: "why".into(), ..row("fallen", 90) },
        row("new", 5),
    ];
    assert_eq!(blessed, expected);
    assert_eq!(parse(&print(&blessed)), expected, "what is written is read again");
}

/// Two functions of the binary, one of a library; what a call cost in all is not counted twice.
#[test]
fn of_a_profile_only_the_binarys_own_lines_count() {
    let profile = "events: Ir\n\nob=(2) /lib/libc.so.6\nfn=(1) memcpy\n0 1000\n\nob=(5) /somewhere/bench-1f\nfn=(2) step\n\
                   0 30\ncob=(2)\ncfn=(1)\ncalls=3 0 \n0 1000\n+4 2\n\nob=(5)\nfn=(3) solve\n* 10\n\nob=(2)\nfn=(4) sin\n0 500\n";
    assert_eq!(callgrind::sum_of_object(profile, "bench-1f"), 42);
    assert_eq!(callgrind::sum_of_object(profile, "bench"), 0);
}

#[test]
fn what_moved_a_figure_stands_in_changes() {
    let readme = read("README.md");
    let changes = words(readme.split_once("\n## Changes").expect("README has Changes").1);
    let earlier = words(&read("crates/cli/guide/changes.md"));
    for row in parse(&read("tests/tables/instructions.md")).iter().filter(|r| !r.reason.is_empty()) {
        let reason = words(&row.reason);
        let is_told = changes.contains(&reason) || earlier.contains(&reason);
        assert!(is_told, "{:?} moved because \"{reason}\", which README's Changes does not tell", row.case);
    }
}
