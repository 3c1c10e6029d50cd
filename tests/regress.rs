//! Baselines: silent on a re-run, awake at a change of one per cent, moved only for a reason.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::io::BufReader;
use std::path::Path;
use std::process::{Command, Output};

/// A scenario of two seconds whose slip depends on friction, and its baselines' folder.
const SCENARIO: [&str; 2] = ["regress", "scenarios/tumbling-capture.toml"];

fn softdock(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_softdock"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap()
}

fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn the_catalogue_is_as_its_baselines() {
    let output = softdock(&["regress", "scenarios"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
}

#[test]
fn one_per_cent_of_friction_is_noticed_and_junit_says_so() {
    let home = tempfile::tempdir().unwrap();
    let junit = home.path().join("junit.xml");
    let more = ["--set", "contact[0].friction.mu=0.505", "--junit", text(&junit)];
    let output = softdock(&[&SCENARIO[..], &more].concat());
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    assert!(said(&output).contains("grasp_rotation_deg") && said(&output).contains("leaves the baseline at t ="));
    let report = junit_parser::from_reader(BufReader::new(fs::File::open(&junit).unwrap())).unwrap();
    let suite = &report.suites[0];
    assert_eq!((suite.name.as_str(), suite.cases.len()), ("tumbling-capture", 6));
    let failed: Vec<&str> =
        suite.cases.iter().filter(|c| c.status.is_failure()).map(|c| c.original_name.as_str()).collect();
    assert!(failed.contains(&"metrics") && failed.contains(&"signals") && !failed.contains(&"outcome"), "{failed:?}");
}

#[test]
fn a_re_run_is_silent_and_its_junit_has_no_failure() {
    let home = tempfile::tempdir().unwrap();
    let junit = home.path().join("junit.xml");
    let output = softdock(&["regress", "scenarios/soft-capture-ring.toml", "--junit", text(&junit)]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let report = junit_parser::from_reader(BufReader::new(fs::File::open(&junit).unwrap())).unwrap();
    assert!(report.suites.iter().all(|s| s.cases.iter().all(|c| c.status.is_success())));
}

#[test]
fn a_baseline_moves_only_for_a_reason_and_keeps_it() {
    let home = tempfile::tempdir().unwrap();
    let baselines = ["--baselines", text(home.path())];
    let regress =
        |more: &[&str]| softdock(&[&["regress", "scenarios/peer-free-arm.toml"], &baselines[..], more].concat());
    let none = regress(&[]);
    assert_eq!(none.status.code(), Some(3));
    assert!(said(&none).contains("there is no baseline"), "{}", said(&none));
    let mute = regress(&["--bless"]);
    assert_eq!(mute.status.code(), Some(3));
    assert!(said(&mute).contains("give it with --reason"), "{}", said(&mute));

    assert_eq!(regress(&["--bless", "--reason", "first"]).status.code(), Some(0));
    assert_eq!(regress(&[]).status.code(), Some(0));
    let finer = ["--set", "integrator.step_s=5e-4"];
    let changed = regress(&finer);
    assert_eq!(changed.status.code(), Some(1));
    assert!(said(&changed).contains("work: steps: 4000 → 8000 (+100.00 %)"), "{}", said(&changed));
    assert_eq!(regress(&[&["--bless", "--reason", "half the step"], &finer[..]].concat()).status.code(), Some(0));
    let file = fs::read_to_string(home.path().join("peer-free-arm.json")).unwrap();
    let baseline: serde_json::Value = serde_json::from_str(&file).unwrap();
    let reasons: Vec<&str> =
        baseline["history"].as_array().unwrap().iter().map(|e| e["reason"].as_str().unwrap()).collect();
    assert_eq!(reasons, ["first", "half the step"]);
    assert!(baseline["history"][1]["moved"][0].is_string());
}
