//! A scenario that is run, recorded as its sensors read it, and diagnosed: what was planted is found, and nothing where nothing was.
#![allow(clippy::unwrap_used)]

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

/// Rigs of which a day is recorded, each with what differs between its runs.
#[derive(Clone, Copy)]
enum Rig {
    /// A pendulum whose motor follows a course.
    Pendulum,
    /// A platform on struts that is kicked.
    Struts,
}

impl Rig {
    fn scenario(self) -> &'static str {
        match self {
            Self::Pendulum => "scenarios/rigs/driven-pendulum.toml",
            Self::Struts => "scenarios/rigs/strut-bench.toml",
        }
    }

    /// What is set in a run.
    fn of_run(self, run: usize) -> Vec<String> {
        match self {
            Self::Pendulum => vec![course(run)],
            Self::Struts => {
                let [u, v, w, p, q, r] = KICKS[run - 1];
                let twist = |key: &str, [x, y, z]: [f64; 3]| format!("vehicle.platform.twist.{key}=[{x}, {y}, {z}]");
                vec![twist("linear_m_per_s", [u, v, w]), twist("angular_deg_per_s", [p, q, r])]
            }
        }
    }
}

/// Velocities, m/s, and rates, deg/s, that the platform starts with.
const KICKS: [[f64; 6]; RUNS] = [
    [0.05, -0.03, 0.08, 6.0, -4.0, 5.0],
    [-0.06, 0.05, 0.05, -5.0, 7.0, -3.0],
    [0.02, 0.08, -0.07, 8.0, 2.0, -6.0],
    [0.07, 0.02, 0.06, -3.0, -8.0, 4.0],
    [-0.03, -0.07, 0.09, 5.0, 5.0, 7.0],
];
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
fn record(rig: Rig, set: &Path, effect: Option<&str>, format: &str) {
    let out = set.join("run").display().to_string();
    let folder = set.join("day").display().to_string();
    for run in 1..=RUNS {
        let (changes, seed) = (rig.of_run(run), run.to_string());
        let role = if run + HELD_OUT > RUNS { "holdout" } else { "fit" };
        let mut arguments = vec!["run", rig.scenario(), "--no-rrd", "--quiet", "--out", &out, "--seed", &seed];
        arguments.extend(changes.iter().flat_map(|change| ["--set", change]));
        arguments.extend(["--record", &folder, "--role", role, "--format", format]);
        let planted = effect.map(|effect| format!("effect=[{{ {effect} }}]"));
        arguments.extend(planted.as_deref().into_iter().flat_map(|planted| ["--set", planted]));
        softdock(&arguments);
    }
}

/// The verdict, and the effects with their places and first parameters.
fn diagnose(rig: Rig, set: &Path) -> (String, Vec<(String, String, f64)>) {
    let out = set.join("diagnosis");
    softdock(&[
        "diagnose",
        rig.scenario(),
        set.join("day").to_str().unwrap(),
        "--quiet",
        "--out",
        out.to_str().unwrap(),
    ]);
    let diagnosis: Value = serde_json::from_slice(&std::fs::read(out.join("diagnosis.json")).unwrap()).unwrap();
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    let effect = |effect: &Value| {
        let first = effect["params"].as_object().unwrap().values().next().and_then(Value::as_f64).unwrap();
        (text(&effect["name"]), text(&effect["place"]), first)
    };
    (text(&diagnosis["verdict"]), diagnosis["effects"].as_array().unwrap().iter().map(effect).collect())
}

#[track_caller]
fn is_found(rig: Rig, effect: &str, planted: &[(&str, &str, f64)]) {
    let home = tempfile::tempdir().unwrap();
    record(rig, home.path(), Some(effect), "csv");
    let (verdict, effects) = diagnose(rig, home.path());
    assert_eq!(verdict, "explained", "{effects:?}");
    assert_eq!(effects.len(), planted.len(), "{effects:?}");
    for (name, place, value) in planted {
        let found = effects.iter().find(|found| found.0 == *name && found.1 == *place);
        let found = found.unwrap_or_else(|| panic!("{name} at {place}: {effects:?}"));
        assert!((found.2 / value - 1.0).abs() < 0.03, "{} for {value}", found.2);
    }
}

#[test]
fn nothing_is_found_where_nothing_was_planted() {
    for rig in [Rig::Pendulum, Rig::Struts] {
        let home = tempfile::tempdir().unwrap();
        record(rig, home.path(), None, "csv");
        assert_eq!(diagnose(rig, home.path()), ("no-mismatch".to_owned(), Vec::new()));
    }
}

#[test]
fn a_weak_strut_is_found() {
    let planted = r#"name = "mechanism-stiffness", place = "mechanism:strut_1", factor = 0.8"#;
    is_found(Rig::Struts, planted, &[("mechanism-stiffness", "mechanism:strut_1", 0.8)]);
}

#[test]
fn a_strut_that_damps_too_little_is_found() {
    let planted = r#"name = "mechanism-damping", place = "mechanism:strut_2", factor = 0.5"#;
    is_found(Rig::Struts, planted, &[("mechanism-damping", "mechanism:strut_2", 0.5)]);
}

#[test]
fn a_stiff_mount_beside_a_strut_that_damps_too_little_is_found() {
    let planted = r#"name = "mechanism-stiffness", place = "mechanism:mount", factor = 1.6 },
        { name = "mechanism-damping", place = "mechanism:strut_3", factor = 0.3"#;
    let found = [("mechanism-stiffness", "mechanism:mount", 1.6), ("mechanism-damping", "mechanism:strut_3", 0.3)];
    is_found(Rig::Struts, &planted.replace('\n', " "), &found);
}

#[test]
fn a_wrong_mass_on_struts_is_none_of_the_struts() {
    let planted = r#"name = "body-mass", place = "body:platform/plate", mass = 12.6"#;
    is_found(Rig::Struts, planted, &[("body-mass", "body:plate", 12.6)]);
}

#[test]
fn viscous_friction_behind_a_loop_is_found() {
    let planted = r#"name = "joint-viscous-friction", place = "joint:pendulum/swing", b = 0.005"#;
    is_found(Rig::Pendulum, planted, &[("joint-viscous-friction", "joint:swing", 0.005)]);
}

#[test]
fn dry_friction_behind_a_loop_is_found() {
    let planted = r#"name = "joint-coulomb-friction", place = "joint:pendulum/swing", c = 0.01"#;
    is_found(Rig::Pendulum, planted, &[("joint-coulomb-friction", "joint:swing", 0.01)]);
}

#[test]
fn a_late_encoder_is_found() {
    let planted = r#"name = "sensor-delay", place = "sensor:joint.pendulum/swing.position", delay = 0.01"#;
    is_found(Rig::Pendulum, planted, &[("sensor-delay", "sensor:joint.pendulum/swing.position", 0.01)]);
}

#[test]
fn csv_parquet_and_mcap_are_diagnosed_alike_to_the_byte() {
    let of = |format: &str| {
        let home = tempfile::tempdir().unwrap();
        let planted = r#"name = "joint-viscous-friction", place = "joint:pendulum/swing", b = 0.005"#;
        record(Rig::Pendulum, home.path(), Some(planted), format);
        diagnose(Rig::Pendulum, home.path());
        let text = std::fs::read_to_string(home.path().join("diagnosis/diagnosis.json")).unwrap();
        let place = home.path().display().to_string();
        text.replace(&format!(".{format}"), ".csv").replace(&place, "")
    };
    let csv = of("csv");
    for format in ["parquet", "mcap"] {
        assert!(of(format) == csv, "{format}");
    }
}
