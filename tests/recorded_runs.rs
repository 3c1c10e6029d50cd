//! A scenario that is run, recorded as its sensors read it, and diagnosed: what was planted is found, and nothing where nothing was.
#![allow(clippy::unwrap_used)]

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

const SCENARIO: &str = "scenarios/rigs/driven-pendulum.toml";
const RUNS: usize = 5;
/// Runs that are left out of the fit.
const HELD_OUT: usize = 2;

fn softdock(arguments: &[&str]) -> Output {
    let output = Command::new(env!("CARGO_BIN_EXE_softdock"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    let said = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned()).concat();
    assert!(output.status.success(), "{arguments:?}: {said}");
    output
}

/// A course of the reference: two frequencies that differ from run to run.
fn course(run: usize) -> String {
    let corner = |i: usize| {
        let (t, run) = (0.02 * i as f64, run as f64);
        let slow = 0.6 * (std::f64::consts::TAU * (0.15 + 0.07 * run) * t).sin() * t.min(1.0);
        let fast = 0.2 * (std::f64::consts::TAU * (0.9 - 0.1 * run) * t).sin();
        format!("[{t:.2}, {:.6}]", slow + fast)
    };
    let corners: Vec<String> = (0..=400).map(corner).collect();
    format!("strategy.commands[0].points=[{}]", corners.join(", "))
}

/// A day on the rig with some effect in it.
fn record(set: &Path, effect: Option<&str>, format: &str) {
    let out = set.join("run").display().to_string();
    let folder = set.join("day").display().to_string();
    for run in 1..=RUNS {
        let (course, seed) = (course(run), run.to_string());
        let role = if run + HELD_OUT > RUNS { "holdout" } else { "fit" };
        let mut arguments =
            vec!["run", SCENARIO, "--no-rrd", "--quiet", "--out", &out, "--seed", &seed, "--set", &course];
        arguments.extend(["--record", &folder, "--role", role, "--format", format]);
        let planted = effect.map(|effect| format!("effect=[{{ {effect} }}]"));
        arguments.extend(planted.as_deref().into_iter().flat_map(|planted| ["--set", planted]));
        softdock(&arguments);
    }
}

/// The verdict, and the effects with their places and first parameters.
fn diagnose(set: &Path) -> (String, Vec<(String, String, f64)>) {
    let out = set.join("diagnosis");
    softdock(&["diagnose", SCENARIO, set.join("day").to_str().unwrap(), "--quiet", "--out", out.to_str().unwrap()]);
    let diagnosis: Value = serde_json::from_slice(&std::fs::read(out.join("diagnosis.json")).unwrap()).unwrap();
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    let effect = |effect: &Value| {
        let first = effect["params"].as_object().unwrap().values().next().and_then(Value::as_f64).unwrap();
        (text(&effect["name"]), text(&effect["place"]), first)
    };
    (text(&diagnosis["verdict"]), diagnosis["effects"].as_array().unwrap().iter().map(effect).collect())
}

#[track_caller]
fn is_found(effect: &str, (name, place, value): (&str, &str, f64)) {
    let home = tempfile::tempdir().unwrap();
    record(home.path(), Some(effect), "csv");
    let (verdict, effects) = diagnose(home.path());
    assert_eq!(verdict, "explained", "{effects:?}");
    let [found] = &effects[..] else { panic!("one effect: {effects:?}") };
    assert_eq!((found.0.as_str(), found.1.as_str()), (name, place));
    assert!((found.2 / value - 1.0).abs() < 0.02, "{} for {value}", found.2);
}

#[test]
fn nothing_is_found_where_nothing_was_planted() {
    let home = tempfile::tempdir().unwrap();
    record(home.path(), None, "csv");
    assert_eq!(diagnose(home.path()), ("no-mismatch".to_owned(), Vec::new()));
}

#[test]
fn viscous_friction_behind_a_loop_is_found() {
    let planted = r#"name = "joint-viscous-friction", place = "joint:pendulum/swing", b = 0.005"#;
    is_found(planted, ("joint-viscous-friction", "joint:swing", 0.005));
}

#[test]
fn dry_friction_behind_a_loop_is_found() {
    let planted = r#"name = "joint-coulomb-friction", place = "joint:pendulum/swing", c = 0.01"#;
    is_found(planted, ("joint-coulomb-friction", "joint:swing", 0.01));
}

#[test]
fn a_late_encoder_is_found() {
    let planted = r#"name = "sensor-delay", place = "sensor:joint.pendulum/swing.position", delay = 0.01"#;
    is_found(planted, ("sensor-delay", "sensor:joint.pendulum/swing.position", 0.01));
}

#[test]
fn csv_parquet_and_mcap_are_diagnosed_alike_to_the_byte() {
    let of = |format: &str| {
        let home = tempfile::tempdir().unwrap();
        let planted = r#"name = "joint-viscous-friction", place = "joint:pendulum/swing", b = 0.005"#;
        record(home.path(), Some(planted), format);
        diagnose(home.path());
        let text = std::fs::read_to_string(home.path().join("diagnosis/diagnosis.json")).unwrap();
        let place = home.path().display().to_string();
        text.replace(&format!(".{format}"), ".csv").replace(&place, "")
    };
    let csv = of("csv");
    for format in ["parquet", "mcap"] {
        assert!(of(format) == csv, "{format}");
    }
}
