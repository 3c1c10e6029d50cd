//! The catalogue: every robot loads, every scenario runs, the captures end as they should.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod support;

use softdock::multibody::{SearchPaths, load_urdf};
use softdock::scenario;
use std::fs;
use support::{files, load, root, run};

#[test]
fn every_robot_loads_without_a_doubt() {
    let robots = files("robots", "urdf");
    assert!(robots.len() >= 3, "the walk found only {robots:?}");
    for robot in robots {
        match load_urdf(&robot, &SearchPaths::default()) {
            Ok(loaded) => assert_eq!(loaded.warnings.count(), 0, "{}", loaded.warnings),
            Err(errors) => panic!("{}: {errors}", robot.display()),
        }
        assert!(robot.with_file_name("NOTICE").exists(), "{} has no NOTICE beside it", robot.display());
    }
}

#[test]
fn every_scenario_runs_a_hundred_steps() {
    let scenarios = files("scenarios", "toml");
    assert!(scenarios.len() >= 3, "the walk found only {scenarios:?}");
    for file in scenarios {
        let spec = scenario::load(&file, &[]).unwrap_or_else(|e| panic!("{e}"));
        let mut mission = scenario::build(&spec).unwrap_or_else(|e| panic!("{e}"));
        mission.world.run(100, &*mission.controller, &mut []).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    }
}

#[test]
fn every_scenario_ends_as_its_file_expects() {
    for file in files("scenarios", "toml") {
        let spec = scenario::load(&file, &[]).unwrap_or_else(|e| panic!("{e}"));
        let (_, outcome) = run(&spec);
        for verdict in scenario::outcome::check_expectations(&spec.expects, &outcome) {
            assert!(verdict.met, "{}: {} ({}: {})", file.display(), verdict.text, outcome.outcome, outcome.reason);
        }
    }
}

/// The numerical loss of a scenario at a step, J, and what the scenario handles, J.
fn calc_loss(file: &std::path::Path, step_s: f64) -> (f64, f64) {
    let spec = scenario::load(file, &[format!("integrator.step_s={step_s}")]).unwrap_or_else(|e| panic!("{e}"));
    let (_, outcome) = run(&spec);
    let figure = |name: &str| outcome.metric(name).and_then(serde_json::Value::as_f64).unwrap_or(0.0);
    let works = ["actuator", "drive", "environment", "effect"].map(|by| figure(&format!("{by}_work_j")).abs());
    let size = works.iter().sum::<f64>() + figure("contact_intake_j") + figure("kinetic_energy_j");
    (figure("numerical_loss_j"), size)
}

#[test]
fn numerical_loss_of_every_scenario_falls_with_the_step() {
    for file in files("scenarios", "toml") {
        let step = scenario::load(&file, &[]).unwrap_or_else(|e| panic!("{e}")).integrator.step_s;
        let [(coarse, _), (fine, size)] = [step, 0.25 * step].map(|h| calc_loss(&file, h));
        let [before, after] = [coarse, fine].map(|loss| loss.abs() / size.max(f64::MIN_POSITIVE));
        println!("{}: {before:.1e} {after:.1e} of {size:.2e} J", file.display());
        // First order gives 4; events that move with the step take some of it. Below a millionth corners decide.
        assert!(after < 1e-6 || after < before / 2.0, "{}: {coarse:e} J, {fine:e} J of {size:e} J", file.display());
    }
}

#[test]
fn capture_without_friction_to_speak_of_is_lost_and_says_so() {
    let (_, outcome) = run(&load("tumbling-capture", &["contact[0].friction.mu=0.02"]));
    assert_eq!(outcome.outcome, "lost");
    assert!(outcome.reason.contains("in the fingers"), "{}", outcome.reason);
}

/// Integrator, step in s and duration in s of a capture: the explicit ones need steps that resolve the pads.
const OTHER_INTEGRATORS: [(&str, &str, &str); 3] =
    [("implicit-midpoint", "1e-3", "40"), ("semi-implicit-euler", "2e-4", "20"), ("rk4", "1e-4", "13")];

#[test]
fn capture_keeps_momentum_with_every_integrator() {
    for (kind, step, duration) in OTHER_INTEGRATORS {
        let overrides =
            [format!("integrator.kind={kind}"), format!("integrator.step_s={step}"), format!("duration_s={duration}")];
        let (_, outcome) = run(&load("tumbling-capture", &overrides.each_ref().map(String::as_str)));
        let drift = |name: &str| outcome.metric(name).unwrap().as_f64().unwrap();
        assert!(outcome.metric("first_contact_s").unwrap().is_number(), "{kind} never touched");
        assert!(drift("momentum_drift_linear") < 1e-9 && drift("momentum_drift_angular") < 1e-9, "{kind}");
    }
}

#[test]
fn replayed_commands_repeat_the_run() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("commands.csv");
    let mut text = "t,command.finger_a,command.finger_b\n".to_owned();
    for k in 0..=1000 {
        let t = f64::from(k) * 1e-3;
        text += &format!("{t},{},{}\n", 0.005 * t, 80.0 * t);
    }
    fs::write(&file, text).unwrap();
    let mut spec = load("peer-grasp", &["duration_s=1.0"]);
    let (scheduled, _) = run(&spec);
    let mapping = std::collections::BTreeMap::new();
    let file = file.display().to_string();
    spec.strategy = scenario::spec::Strategy::Replay(scenario::spec::Replay { file, mapping });
    let (replayed, _) = run(&spec);
    let gap = scheduled.world.state().q.iter().zip(&replayed.world.state().q).map(|(a, b)| (a - b).abs());
    // The table holds the course's own values at every step; its decimals round the last bit.
    assert!(gap.fold(0.0, f64::max) < 1e-12);
}

#[test]
fn third_party_robots_run_in_a_scenario() {
    let Ok(packages) = std::env::var("SOFTDOCK_THIRD_PARTY_ROBOTS") else {
        eprintln!(
            "SKIPPED: set SOFTDOCK_THIRD_PARTY_ROBOTS to a site-packages folder with example-robot-data and pybullet"
        );
        return;
    };
    let data = format!("{packages}/cmeel.prefix/share/example-robot-data/robots");
    let robots = [
        format!("{data}/panda_description/urdf/panda.urdf"),
        format!("{data}/ur_description/urdf/ur5_robot.urdf"),
        format!("{packages}/pybullet_data/kuka_iiwa/model.urdf"),
    ];
    let share = format!("{packages}/cmeel.prefix/share");
    for robot in robots {
        let text = format!(
            "name = \"third-party\"\nseed = 1\nduration_s = 1.0\n[environment]\nkind = \"lab\"\n[[vehicle]]\nname = \"arm\"\n\
             urdf = \"{robot}\"\npackage_paths = [\"{share}\"]\nbase = \"fixed\"\n[[actuator]]\nname = \"hold\"\n\
             kind = \"joint-drive\"\njoints = [\"arm/*joint*\"]\nstiffness_n_m_per_rad = 2000.0\ndamping_n_m_s_per_rad = 100.0\n"
        );
        // The Panda's fingers slide; its arm is named by number.
        let text = text
            .replace("arm/*joint*\"]", if robot.contains("panda") { "arm/panda_joint?\"]" } else { "arm/*joint*\"]" });
        let text = if robot.contains("kuka") { text.replace("arm/*joint*", "arm/lbr_iiwa_joint_*") } else { text };
        let spec = scenario::parse(&text, &root().join("third-party.toml").display().to_string(), &[])
            .unwrap_or_else(|e| panic!("{e}"));
        let (mission, outcome) = run(&spec);
        assert_eq!(outcome.outcome, "completed", "{robot}: {}", outcome.reason);
        assert!(mission.world.state().v.iter().all(|v| v.abs() < 1.0), "{robot} does not hold still");
    }
}
