//! Families of contacts and thrusters: one effect each, planted by the scenario into short recordings that softdock makes itself, is found
//! again at its place; and wrong masses are no exotic effect there.
//!
//! Noise and rounding are those of the practice rigs; runs last a few seconds.
#![allow(clippy::unwrap_used)]

mod planted;

use diagnose::diagnosis::{Diagnosis, Verdict};
use diagnose::start::Start;
use diagnose::synthesise;
use planted::{check, check_number, effect, number, root};
use record::{RecordedRun, RecordingSet, Role, Series};
use scenario::spec::Effect;
use std::f64::consts::PI;

/// A diagnosis of what a rig would have recorded with an effect, from the start that its scenario states.
fn diagnosed(rig: &str, like: &RecordingSet, planted: &Effect, seed: u64) -> Diagnosis {
    let scenario = scenario::load(&root().join(format!("scenarios/rigs/{rig}.toml")), &[]).unwrap();
    let mut with = scenario.clone();
    with.effects.push(planted.clone());
    let as_stated = |built: &diagnose::plant::Built, _: &diagnose::tape::Tape| Start::nominal(built);
    let set = synthesise(with, like, &as_stated, seed).unwrap();
    diagnose::diagnose(scenario, &set, &()).unwrap().0
}

fn set(rig: &str, noise: &[(&str, f64)], runs: Vec<Vec<Series>>) -> RecordingSet {
    let run = |(k, mut series): (usize, Vec<Series>)| {
        series.sort_by(|a, b| a.channel.cmp(&b.channel));
        let role = if k < 2 { Role::Fit } else { Role::Holdout };
        RecordedRun { file: format!("run-{k}.csv"), role, note: String::new(), series }
    };
    RecordingSet {
        rig: rig.to_owned(),
        window_s: None,
        title: "planted".to_owned(),
        noise: noise.iter().map(|(channel, sigma)| ((*channel).to_owned(), *sigma)).collect(),
        runs: runs.into_iter().enumerate().map(run).collect(),
        ..RecordingSet::default()
    }
}

/// Instants from zero, both ends included.
fn instants(duration: f64, rate: f64) -> Vec<f64> {
    (0..=(duration * rate).round() as u32).map(|i| f64::from(i) / rate).collect()
}

fn still(channel: &str, times: &[f64], quantum: f64) -> Series {
    Series::with_quantum(channel, times.to_vec(), vec![0.0; times.len()], quantum)
}

/// The stage of the slider goes along a line and back, round a curve and to and fro across; four seconds each.
fn pulls() -> RecordingSet {
    let times = instants(4.0, 250.0);
    let paths: [fn(f64) -> (f64, f64); 3] = [
        |t| (0.03 * (1.0 - (0.5 * PI * t).cos()), 0.0),
        |t| (0.02 * (1.0 - (0.7 * PI * t).cos()), 0.015 * (PI * t).sin() * (t / 4.0)),
        |t| (0.012 * (0.9 * PI * t).sin() * (t / 4.0), 0.025 * (1.0 - (0.6 * PI * t).cos())),
    ];
    let run = |path: &fn(f64) -> (f64, f64)| {
        let drive = |axis: &str, of: &dyn Fn(f64) -> f64| {
            Series::new(format!("drive.stage.position.{axis}"), times.clone(), times.iter().map(|t| of(*t)).collect())
        };
        let mut series = vec![drive("x", &|t| path(t).0), drive("y", &|t| path(t).1)];
        for axis in ["x", "y"] {
            series.push(still(&format!("body.slider.position.{axis}"), &times, 1e-6));
            series.push(still(&format!("sensor.spring.force.{axis}"), &times, 1e-3));
        }
        series
    };
    let noise = [("drive.stage.position", 0.0), ("body.slider.position", 5e-6), ("sensor.spring.force", 0.02)];
    set("stick-slip", &noise, paths.iter().map(run).collect())
}

/// The chaser fires its thrusters in turn, far from the target; six seconds each.
fn firings() -> RecordingSet {
    let times = instants(6.0, 60.0);
    let run = |k: usize| {
        let ticks = instants(5.9, 10.0);
        let fires = |thruster: usize, t: f64| ((t / 0.6) as usize * (2 * k + 3) + 3 * k) % 8 == thruster;
        let command = |thruster: usize| {
            let on = ticks.iter().map(|t| if fires(thruster, *t) { 1.0 } else { 0.0 }).collect();
            Series::new(format!("actuator.thruster_{}.command", thruster + 1), ticks.clone(), on)
        };
        let mut series: Vec<Series> = (0..8).map(command).collect();
        for body in ["chaser", "target"] {
            series.extend(["x", "y"].map(|axis| still(&format!("body.{body}.position.{axis}"), &times, 1e-5)));
            let turn = |axis: &str, value: f64| {
                let values = vec![value; times.len()];
                Series::with_quantum(format!("body.{body}.orientation.{axis}"), times.clone(), values, 1e-6)
            };
            series.extend([turn("w", 1.0), turn("x", 0.0), turn("y", 0.0), turn("z", 0.0)]);
            series.push(still(&format!("body.{body}.angular_velocity.z"), &times, 1e-5));
        }
        series
    };
    let noise = [
        ("body.chaser.position", 2e-4),
        ("body.target.position", 2e-4),
        ("body.chaser.orientation", 5e-4),
        ("body.target.orientation", 5e-4),
        ("body.chaser.angular_velocity", 1e-3),
        ("body.target.angular_velocity", 1e-3),
    ];
    set("air-table", &noise, (0..3).map(run).collect())
}

/// A rig tells what was planted in it, and a number of that.
fn check_on(rig: &str, like: &RecordingSet, (planted, (key, value)): &(Effect, (&str, f64))) {
    let diagnosis = diagnosed(rig, like, planted, 7);
    check(&diagnosis, planted);
    check_number(&diagnosis, key, *value);
}

#[test]
fn laws_of_a_contact() {
    let plate = "contact:slider/plate";
    let stribeck = [("mu_s", number(0.29)), ("mu_d", number(0.24)), ("v_s", number(0.01))];
    let cases = [
        (effect("friction-viscous", plate, &[("b", number(9.0))]), ("b", 9.0)),
        (effect("friction-stribeck", plate, &stribeck), ("mu_d", 0.24)),
    ];
    cases.iter().for_each(|case| check_on("stick-slip", &pulls(), case));
}

#[test]
fn faults_of_thrusters() {
    let cases = [
        (effect("actuator-gain", "actuator:thruster_3", &[("gain", number(0.85))]), ("gain", 0.85)),
        (effect("actuator-misalignment", "actuator:thruster_6", &[("angle_z", number(0.2))]), ("angle_z", 0.2)),
        (effect("linear-drag", "body:chaser", &[("c", number(1.0))]), ("c", 1.0)),
    ];
    cases.iter().for_each(|case| check_on("air-table", &firings(), case));
}

/// Sliders whose card states the mass wrong by 0.3 to 1 %, otherwise as modelled.
#[test]
fn a_slightly_wrong_mass_is_no_exotic_effect() {
    for (k, size) in [0.003, -0.01].into_iter().enumerate() {
        let planted = effect("body-mass", "body:slider", &[("mass", number(1.2 * (1.0 + size)))]);
        let diagnosis = diagnosed("stick-slip", &pulls(), &planted, 60 + k as u64);
        assert!(
            matches!(diagnosis.verdict, Verdict::Explained | Verdict::NoMismatch),
            "{size}: {:?}",
            diagnosis.verdict
        );
        let names: Vec<&str> = diagnosis.effects.iter().map(|e| e.name.as_str()).collect();
        assert!(names.iter().all(|n| ["body-mass", "friction-coefficient"].contains(n)), "{size}: {names:?}");
    }
}
