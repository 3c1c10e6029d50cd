//! The arm-bench rig against recordings of it, whose hidden effects and true initial states their keys tell: with these,
//! the simulation must leave the sensors' noise and nothing else.
//!
//! The recordings were made by another simulator, with its own integration. They are not part of the repository:
//! `SOFTDOCK_RECORDINGS` names their folder, `../shared/recordings` beside the checkout by default.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

#[path = "keys/effects.rs"]
mod effects;
#[path = "keys/practice.rs"]
mod practice;

use effects::effects_toml;
use practice::practice;
use record::{RecordedRun, RecordingSet};
use scenario::Mission;
use serde_json::Value;
use sim::World;
use std::fs;
use std::path::{Path, PathBuf};

const JOINTS: usize = 7;
/// Step of the replays, s.
const STEP: f64 = 1e-3;
/// Noise of the encoders (rad) and tachometers (rad/s).
const NOISE: [f64; 2] = [2e-5, 1e-3];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The rig's scenario with the effects of a key.
fn mission(key: &Value, step: f64) -> Mission {
    let dir = tempfile::tempdir().unwrap();
    let mut text = fs::read_to_string(root().join("scenarios/rigs/arm-bench.toml")).unwrap();
    let urdf = dir.path().join("arm.urdf");
    fs::write(&urdf, true_urdf(key)).unwrap();
    text = text.replace("../../robots/arm-bench/arm-bench.urdf", urdf.to_str().unwrap());
    text += &effects_toml(key);
    let file = dir.path().join("arm.toml");
    fs::write(&file, text).unwrap();
    let spec = scenario::load(&file, &[format!("integrator.step_s={step}")]).unwrap_or_else(|e| panic!("{e}"));
    scenario::build(&spec).unwrap_or_else(|e| panic!("{e}"))
}

/// The robot with the small errors of masses and centres that a key tells.
fn true_urdf(key: &Value) -> String {
    let text = fs::read_to_string(root().join("robots/arm-bench/arm-bench.urdf")).unwrap();
    let errors = &key["nominal_errors"];
    let list = |name: &str| {
        errors.get(name).and_then(Value::as_array).map(|a| a.iter().map(|x| x.as_f64().unwrap()).collect())
    };
    let scales: Vec<f64> = list("link mass scale (inertia with it) link_1..7").unwrap_or(vec![1.0; JOINTS]);
    let shifts: Vec<f64> = list("link com shift z m link_1..7").unwrap_or(vec![0.0; JOINTS]);
    let (mut link, mut lines) = (0, Vec::new());
    let mut in_inertial = false;
    for line in text.lines() {
        if line.contains("<link name=\"link_") {
            link += 1;
        }
        in_inertial = (in_inertial || line.contains("<inertial>")) && !line.contains("</inertial>");
        let edit = |k: usize, x: f64| match line.trim() {
            l if l.starts_with("<mass") || l.starts_with("<inertia ") => x * scales[link - 1],
            _ if k == 2 => x + shifts[link - 1],
            _ => x,
        };
        lines.push(if in_inertial && !line.contains("<inertial>") {
            edit_numbers(line, edit)
        } else {
            line.to_owned()
        });
    }
    lines.join("\n")
}

/// A line with its quoted numbers changed, counted from zero.
fn edit_numbers(line: &str, edit: impl Fn(usize, f64) -> f64) -> String {
    let mut count = 0;
    let mut change = |text: &str| {
        let numbers = text.split(' ').map(|x| {
            count += 1;
            format!("{:?}", edit(count - 1, x.parse().unwrap()))
        });
        numbers.collect::<Vec<_>>().join(" ")
    };
    let parts = line.split('"').enumerate();
    parts.map(|(i, part)| if i % 2 == 1 { change(part) } else { part.to_owned() }).collect::<Vec<_>>().join("\"")
}

/// A channel of every joint.
fn channels<'a>(run: &'a RecordedRun, what: &str) -> Vec<&'a record::Series> {
    (1..=JOINTS).map(|i| run.series(&format!("joint.joint_{i}.{what}")).unwrap()).collect()
}

/// Squares of the residuals over the noise, and how many; positions and velocities apart.
fn replay(mission: &mut Mission, run: &RecordedRun, start: &[f64]) -> [(f64, usize); 2] {
    let (measured, commands) =
        ([channels(run, "position"), channels(run, "velocity")], channels(run, "effort_command"));
    let world = &mut mission.world;
    world.state_mut().q.copy_from_slice(&start[..JOINTS]);
    world.state_mut().v.copy_from_slice(&start[JOINTS..]);
    let mut sums = [(0.0, 0); 2];
    let mut next = 0;
    for (k, time) in commands[0].times.iter().enumerate() {
        advance_to(world, *time);
        for (i, command) in commands.iter().enumerate() {
            world.commands_mut()[i].effort = command.values[k];
        }
        // The sensors read the motor side, which is loaded from the start.
        world.settle_effects();
        if measured[0][0].times.get(next).is_none_or(|t| (t - time).abs() > 1e-9) {
            continue;
        }
        for (kind, series) in measured.iter().enumerate() {
            for (i, joint) in series.iter().enumerate() {
                let (q, v) = world.motor_side(i);
                let miss = (joint.values[next] - [q, v][kind]) / NOISE[kind];
                sums[kind] = (sums[kind].0 + miss * miss, sums[kind].1 + 1);
            }
        }
        next += 1;
    }
    assert!(next == measured[0][0].len() && next > 1_000, "every sample was compared");
    sums
}

/// By the model's step, the last one as long as it takes.
fn advance_to(world: &mut World, time: f64) {
    let step = world.model().step;
    while time - world.state().time > 1e-9 {
        let left = time - world.state().time;
        world.advance_by(if left < 1.001 * step { left } else { step }).unwrap();
    }
}

fn rms(sums: &[(f64, usize)]) -> f64 {
    (sums.iter().map(|s| s.0).sum::<f64>() / sums.iter().map(|s| s.1).sum::<usize>() as f64).sqrt()
}

/// The sets in which nothing but their key's effects stands between the nominal model and the recording.
const SETS: [&str; 5] = ["arm-bench-01", "arm-bench-02", "arm-bench-03", "arm-bench-04", "arm-bench-05"];
/// Root mean square of all runs of a set in units of noise: the key's own is 1.000 to 1.009, with rounding and chance.
const PERFECT: f64 = 1.015;

/// All runs of a set at a step, told run by run.
fn replay_set(practice: &Path, name: &str, step: f64) -> (f64, f64) {
    let key = fs::read_to_string(practice.join(format!("keys/{name}.json"))).unwrap();
    let key: Value = serde_json::from_str(&key).unwrap();
    let set = RecordingSet::load(&practice.join(name)).unwrap();
    let mut all = Vec::new();
    for entry in key["runs"].as_array().unwrap() {
        let start: Vec<f64> = entry["true_initial_state"].as_array().unwrap().iter().flat_map(Value::as_f64).collect();
        let run = set.runs.iter().find(|r| entry["run"] == r.file.as_str()).unwrap();
        let sums = replay(&mut mission(&key, step), run, &start);
        let (position, velocity) = (rms(&sums[..1]), rms(&sums[1..]));
        println!("{name} {} at {step} s: position {position:.4}, velocity {velocity:.4}", run.file);
        all.extend(sums);
    }
    (rms(&all), key["oracle"]["true"].as_f64().unwrap())
}

#[test]
fn true_effects_leave_nothing_but_noise_in_every_recording() {
    let Some(practice) = practice() else { return };
    for name in SETS {
        let (found, oracle) = replay_set(&practice, name, STEP);
        println!("{name}: {found:.4} of the noise (its maker's own simulator: {oracle})");
        assert!(found < PERFECT, "{name}: {found}");
    }
}

/// The convergence behind [`STEP`]; `cargo test -p softdock-scenario --test arm_bench -- --ignored --nocapture`.
#[test]
#[ignore = "a table, not a check"]
fn table_of_steps() {
    let Some(practice) = practice() else { return };
    for name in SETS {
        for step in [2e-3, 1e-3, 5e-4, 2e-4] {
            println!("{name} {step:e} s: {:.4}", replay_set(&practice, name, step).0);
        }
    }
}
