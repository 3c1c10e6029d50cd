//! `softdock lab` as a user meets it: list, verdict, files, exit status.
#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::process::{Command, Output};

fn lab(arguments: &[&str], at: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_softdock")).arg("lab").args(arguments).current_dir(at).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
fn without_a_name_every_experiment_is_listed_with_its_question() {
    let dir = tempfile::tempdir().unwrap();
    let output = lab(&[], dir.path());
    assert_eq!(output.status.code(), Some(0));
    for experiment in softdock::lab::catalogue() {
        assert!(said(&output).contains(experiment.name) && said(&output).contains(experiment.question));
    }
}

#[test]
fn an_experiment_prints_its_verdict_and_writes_a_whole_folder() {
    let dir = tempfile::tempdir().unwrap();
    let output = lab(&["anisotropy", "--quick", "--json"], dir.path());
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let answer: serde_json::Value = serde_json::from_str(&said(&output)).unwrap();
    assert_eq!((&answer["experiment"], &answer["holds"]), (&"anisotropy".into(), &true.into()));
    let folder = dir.path().join("out/lab/anisotropy");
    let mut files = vec!["charts.svg", "figures.json", "signals.parquet", "summary.json"];
    if cfg!(feature = "rerun") {
        files.push("run.rrd");
    }
    for file in files {
        assert!(std::fs::metadata(folder.join(file)).unwrap().len() > 100, "{file}");
    }
}

#[test]
fn a_figure_that_does_not_hold_is_status_1() {
    let dir = tempfile::tempdir().unwrap();
    // Implicit Euler at ω h = 0.1 … 0.2 damps the swing by far more than half a per cent.
    let output = lab(&["stick-slip", "--quick", "--step-s", "0.01"], dir.path());
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    assert!(said(&output).contains("NO"));
}

#[test]
fn an_unknown_name_is_bad_input_and_names_those_that_are() {
    let dir = tempfile::tempdir().unwrap();
    let output = lab(&["stickslip"], dir.path());
    assert_eq!(output.status.code(), Some(3));
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(error.contains("no experiment \"stickslip\"") && error.contains("stick-slip"), "{error}");
    assert_eq!(lab(&["incline", "--step-s", "-1"], dir.path()).status.code(), Some(2));
}
