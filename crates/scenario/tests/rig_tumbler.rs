//! The rig tumbler against recordings of an independent simulator.
//!
//! With the effects and the initial states of a practice set's key, the rig's nominal scenario must predict 300 s of
//! attitude and gyro to within the sensors' noise, as the key says that the true model does. What moves inside a body
//! starts somehow, which the keys do not tell: it is fitted, six numbers a run. Recordings are looked for
//! in `$SOFTDOCK_RECORDINGS`, or in `../shared/recordings` beside the checkout; where there are none, the test says so and passes.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

#[path = "keys/effects.rs"]
mod effects;
#[path = "keys/practice.rs"]
mod practice;

use effects::effects_toml;
use practice::practice;
use scenario::Mission;
use serde_json::Value;
use spatial::{Rot, Twist, Vec3, log_rotation, nalgebra};
use std::path::{Path, PathBuf};

/// 1 σ of attitude (rad, per axis) and gyro (rad/s), from the rig's card.
const NOISE: [f64; 2] = [5e-4, 2e-4];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The rig with effects, in steps of `step` s.
fn mission(effects: &str, step: f64) -> Mission {
    let file = root().join("scenarios/rigs/tumbler.toml");
    let text = std::fs::read_to_string(&file).unwrap() + effects;
    let overrides = [format!("integrator.step_s={step}")];
    let spec = scenario::parse(&text, &file.display().to_string(), &overrides).unwrap_or_else(|e| panic!("{e}"));
    scenario::build(&spec).unwrap_or_else(|e| panic!("{e}"))
}

/// Attitude and gyro every 20 ms for 300 s from an initial state: w, x, y, z, then ω in body axes, then the memory of the
/// effects as `sim::memory_layout` has it (none: at rest with the body).
fn simulate(effects: &str, start: &[f64], step: f64) -> Vec<(Rot, Vec3)> {
    let mut world = mission(effects, step).world;
    let rotation = nalgebra::Quaternion::new(start[0], start[1], start[2], start[3]);
    let rotation = nalgebra::UnitQuaternion::from_quaternion(rotation);
    world.state_mut().bases[0].rotation = rotation;
    world.set_base_twists(&[Twist::new(rotation * Vec3::new(start[4], start[5], start[6]), Vec3::zeros())]);
    world.set_effect_memory(&start[7..]);
    let per_sample = (0.02 / step).round() as usize;
    let mut samples = Vec::with_capacity(15_001);
    loop {
        let attitude = world.state().bases[0].rotation;
        samples.push((attitude, attitude.inverse() * world.kinematics(0).vel[0].ang));
        if samples.len() == 15_001 {
            return samples;
        }
        (0..per_sample).for_each(|_| world.advance().unwrap());
    }
}

/// Rows of a run: sample, attitude where it was taken, gyro.
type Row = (usize, Option<Rot>, Vec3);

fn read(path: &Path) -> Vec<Row> {
    let text = std::fs::read_to_string(path).unwrap();
    let row = |line: &str| {
        let x: Vec<Option<f64>> = line.split(',').map(|cell| cell.trim().parse().ok()).collect();
        let quaternion = x[1].map(|w| nalgebra::Quaternion::new(w, x[2].unwrap(), x[3].unwrap(), x[4].unwrap()));
        let attitude = quaternion.map(nalgebra::UnitQuaternion::from_quaternion);
        ((x[0].unwrap() / 0.02).round() as usize, attitude, Vec3::new(x[5].unwrap(), x[6].unwrap(), x[7].unwrap()))
    };
    text.lines().skip(1).map(row).collect()
}

/// Residuals of a run in units of noise: attitude, gyro; by component.
fn calc_residuals(rows: &[Row], samples: &[(Rot, Vec3)]) -> [Vec<f64>; 2] {
    let (mut attitudes, mut gyros) = (Vec::new(), Vec::new());
    for (k, attitude, gyro) in rows {
        let (rotation, omega) = &samples[*k];
        if let Some(attitude) = attitude {
            attitudes.extend((log_rotation(&(rotation.inverse() * attitude)) / NOISE[0]).iter());
        }
        gyros.extend(((gyro - omega) / NOISE[1]).iter());
    }
    [attitudes, gyros]
}

/// RMS of the residuals: attitude, gyro.
fn calc_rms(rows: &[Row], samples: &[(Rot, Vec3)]) -> [f64; 2] {
    calc_residuals(rows, samples).map(|r| (r.iter().map(|x| x * x).sum::<f64>() / r.len() as f64).sqrt())
}

/// The initial memory that fits a run best, by Gauss and Newton from rest: keys tell where the body starts, and not what
/// moves inside it.
fn fit_memory(effects: &str, start: &[f64], rows: &[Row]) -> Vec<f64> {
    let slots = sim::memory_layout(mission(effects, 0.02).world.model());
    let of = |start: &[f64]| calc_residuals(rows, &simulate(effects, start, 0.02)).concat();
    let mut all = start.to_vec();
    all.resize(7 + slots.len(), 0.0);
    for _ in 0..if slots.is_empty() { 0 } else { 3 } {
        let base = nalgebra::DVector::from_vec(of(&all));
        let columns: Vec<_> = slots
            .iter()
            .map(|slot| {
                let (mut other, d) = (all.clone(), 1e-3 * slot.scale);
                other[7 + slot.offset] += d;
                (nalgebra::DVector::from_vec(of(&other)) - &base) / d
            })
            .collect();
        let jacobian = nalgebra::DMatrix::from_columns(&columns);
        let normal = (jacobian.transpose() * &jacobian).cholesky().unwrap();
        let gain = normal.solve(&(jacobian.transpose() * &base));
        slots.iter().zip(gain.iter()).for_each(|(slot, gain)| all[7 + slot.offset] -= gain);
    }
    all
}

/// Largest difference of two runs in units of noise: attitude, gyro.
fn calc_gap(a: &[(Rot, Vec3)], b: &[(Rot, Vec3)]) -> [f64; 2] {
    a.iter().zip(b).fold([0.0; 2], |[q, w], ((qa, wa), (qb, wb))| {
        let turned = log_rotation(&(qa.inverse() * qb)).norm() / NOISE[0];
        [q.max(turned), w.max((wa - wb).norm() / NOISE[1])]
    })
}

#[test]
fn the_true_model_predicts_every_practice_run_to_the_noise() {
    let Some(folder) = practice() else { return };
    for set in 1..=5 {
        let key = std::fs::read_to_string(folder.join(format!("keys/tumbler-0{set}.json"))).unwrap();
        let key: Value = serde_json::from_str(&key).unwrap();
        let effects = effects_toml(&key);
        for entry in key["runs"].as_array().unwrap() {
            let file = entry["run"].as_str().unwrap();
            let start: Vec<f64> =
                entry["true_initial_state"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
            let rows = read(&folder.join(format!("tumbler-0{set}/{file}")));
            let start = fit_memory(&effects, &start, &rows);
            let samples = simulate(&effects, &start, 0.02);
            let [attitude, gyro] = calc_rms(&rows, &samples);
            println!(
                "tumbler-0{set} {file}: attitude {attitude:.4}, gyro {gyro:.4} of the noise; memory {:.5?}",
                &start[7..]
            );
            // 9,000 and 45,000 samples: four standard deviations of the RMS.
            assert!((attitude - 1.0).abs() < 0.03 && (gyro - 1.0).abs() < 0.0135);
            let holdout = key["oracle"]["holdout"].as_array().unwrap().iter().find(|h| h["run"] == file);
            if let Some(truth) = holdout.map(|h| &h["true"]) {
                // The key's figures have three decimals; its true model and ours differ by less.
                let off =
                    [(attitude, &truth["attitude"]), (gyro, &truth["gyro"])].map(|(a, b)| a - b.as_f64().unwrap());
                assert!(off.iter().all(|x| x.abs() < 1.5e-3), "key: {truth}");
            }
        }
    }
}

/// Effects of the kinds that a tumble can show, all at once.
const EVERYTHING: &str = r#"
[[effect]]
name = "body-inertia"
place = "body:target"
inertia = [95.0, 160.0, 215.0, 1.1, -1.8, 0.7]
[[effect]]
name = "slosh"
place = "body:target"
mass = 14.0
frequency = 0.11
damping = 0.02
position = [0.25, 0.15, 0.45]
[[effect]]
name = "flexible-appendage"
place = "body:target"
frequency = 0.25
damping = 0.005
coupling = [2.0, 3.0, 4.0]
[[effect]]
name = "internal-dissipation"
place = "body:target"
i_damper = 5.0
c = 0.5
[[effect]]
name = "angular-damping"
place = "body:target"
c = 0.012
[[effect]]
name = "gravity-gradient"
place = "body:target"
mean_motion = 1.11e-3
[[effect]]
name = "periodic-disturbance"
place = "body:target"
amplitude = [0.02, 0.01, 0.0]
frequency = 0.4
"#;

#[test]
fn the_rigs_step_is_fine_enough_whatever_the_effects() {
    // 7 deg/s about every kind of axis: the middle one, where a tumble is least forgiving, the smallest and the largest.
    for (what, start) in
        [("middle", [0.01, 0.122, 0.01]), ("smallest", [0.12, 0.02, 0.01]), ("largest", [0.02, 0.01, 0.12])]
    {
        let start: Vec<f64> = [1.0, 0.0, 0.0, 0.0].into_iter().chain(start).collect();
        for effects in ["", EVERYTHING] {
            let reference = simulate(effects, &start, 5e-3);
            let gap = |step: f64| calc_gap(&simulate(effects, &start, step), &reference);
            let [q, w] = gap(0.02);
            let all = if effects.is_empty() { "nominal" } else { "with all effects" };
            println!("spin near the {what} axis, {all}: step error at 20 ms {q:.1e} σ in attitude, {w:.1e} σ in gyro");
            assert!(q < 0.01 && w < 0.01);
        }
    }
}

#[test]
fn corrections_at_their_nominal_values_and_parts_of_nothing_change_no_bit() {
    let neutral = r#"
[[effect]]
name = "body-mass"
place = "body:target"
mass = 450.0
[[effect]]
name = "body-com"
place = "body:target"
com = [0.0, 0.0, 0.0]
[[effect]]
name = "body-inertia"
place = "body:target/target"
inertia = [95, 160, 215, 0, 0, 0]
[[effect]]
name = "slosh"
place = "body:target"
mass = 0.0
frequency = 0.11
damping = 0.02
position = [0.25, 0.15, 0.45]
[[effect]]
name = "flexible-appendage"
place = "body:target"
frequency = 0.25
coupling = [0.0, 0.0, 0.0]
[[effect]]
name = "internal-dissipation"
place = "body:target"
i_damper = 0.0
c = 0.5
[[effect]]
name = "tilt"
place = "world"
vector = [0.0, 0.0, 0.0]
"#;
    let end = |effects: &str| {
        let mut world = mission(effects, 0.02).world;
        let spin = world.kinematics(0).vel[0].ang;
        world.set_base_twists(&[Twist::new(spin, Vec3::new(0.1, 0.2, 0.3))]);
        (0..500).for_each(|_| world.advance().unwrap());
        format!("{:?}", (world.state().bases[0], world.state().momentum[0], world.kinematics(0).vel[0]))
    };
    let nominal = end("");
    assert_eq!(end(neutral), nominal);
    for (from, to) in [
        ("mass = 450.0", "mass = 450.0005"),
        ("com = [0.0, 0.0, 0.0]", "com = [1e-6, 0.0, 0.0]"),
        ("inertia = [95, 160,", "inertia = [95, 160.0002,"),
        ("mass = 0.0", "mass = 1e-6"),
        ("coupling = [0.0,", "coupling = [1e-6,"),
        ("i_damper = 0.0", "i_damper = 1e-2"),
        ("vector = [0.0,", "vector = [1e-6,"),
    ] {
        assert!(neutral.contains(from));
        assert_ne!(end(&neutral.replacen(from, to, 1)), nominal, "{to}");
    }
}

#[test]
fn slosh_counts_from_the_nominal_centre_of_mass_whatever_the_order_in_the_file() {
    let com = "[[effect]]\nname = \"body-com\"\nplace = \"body:target\"\ncom = [0.1, 0.0, 0.0]\n";
    let slosh = "[[effect]]\nname = \"slosh\"\nplace = \"body:target\"\nmass = 14.0\nfrequency = 0.1\n\
                 position = [0.25, 0.15, 0.45]\n";
    let momentum = |effects: &str| mission(effects, 0.02).world.state().momentum[0];
    let (one, other) = (momentum(&format!("{com}{slosh}")), momentum(&format!("{slosh}{com}")));
    assert!((one.moment - other.moment).norm() < 1e-12 && (one.force - other.force).norm() < 1e-12);
    // Locked at the start, the whole moves as the corrected body alone would.
    let locked = momentum(com);
    assert!((one.moment - locked.moment).norm() < 1e-12 && (one.force - locked.force).norm() < 1e-12);
}

#[test]
fn what_a_body_cannot_give_is_refused_with_a_way_out() {
    let build = |effect: &str| {
        let file = root().join("scenarios/rigs/tumbler.toml");
        let text = std::fs::read_to_string(&file).unwrap() + "\n[[effect]]\nplace = \"body:target\"\n" + effect;
        let spec = scenario::parse(&text, &file.display().to_string(), &[]).map_err(|e| e.to_string())?;
        scenario::build(&spec).map(|_| ()).map_err(|e| e.to_string())
    };
    for (effect, fragment) in [
        ("name = \"slosh\"\nmass = 450.0\nfrequency = 0.1\n", "takes more than the link has"),
        (
            "name = \"flexible-appendage\"\nfrequency = 0.1\ncoupling = [10.0, 0.0, 0.0]\n",
            "takes more than the link has",
        ),
        ("name = \"internal-dissipation\"\ni_damper = 95.0\nc = 1.0\n", "takes more than the link has"),
        ("name = \"internal-dissipation\"\ni_damper = 1e-3\nc = 1.0\n", "shorten the step"),
        ("name = \"slosh\"\nmass = 4.0\nfrequency = 20.0\n", "shorten the step"),
        ("name = \"body-inertia\"\ninertia = [95, 95, 215, 0, 0, 0]\n", "violates the triangle inequality"),
        ("name = \"periodic-disturbance\"\namplitude = 1.0\nfrequency = 0.1\n", "three numbers at a body"),
        ("name = \"body-mass\"\nmass = -1.0\n", "above zero"),
    ] {
        let error = build(effect).unwrap_err();
        assert!(error.contains(fragment), "{effect}: {error}");
    }
}
