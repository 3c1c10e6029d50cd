//! Plant and recover: a recording made by the scenario with an effect in it is diagnosed with that effect at that place.
//!
//! The recordings are noisy and rounded, their initial states are not told, and the runs that judge are not those that were fitted.
#![allow(clippy::unwrap_used)]

mod planted;

use diagnose::diagnosis::{Diagnosis, Verdict};
use diagnose::plant::Plant;
use diagnose::start::Start;
use planted::{effect, root};
use record::RecordingSet;
use scenario::measure::{Gauge, Reading};
use scenario::spec::{Effect, ParamValue};
use spatial::{Twist, Vec3, exp_rotation};
use std::fmt::Write as _;
use std::path::Path;

/// White noise that depends on seed and place alone (SplitMix64, Box–Muller).
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn draw(&mut self, sigma: f64) -> f64 {
        let (u, v) = (1.0 - self.uniform(), self.uniform());
        sigma * (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
    }

    fn vector(&mut self, sigma: f64) -> Vec3 {
        Vec3::from_fn(|_, _| self.draw(sigma))
    }
}

const ATTITUDE: f64 = 5e-4;
const GYRO: f64 = 2e-4;

fn tumbler() -> Plant {
    Plant::new(scenario::load(&root().join("scenarios/rigs/tumbler.toml"), &[]).unwrap())
}

/// Three runs of 120 s at 5 Hz: two to fit, one to judge.
fn record_tumbler(effects: &[Effect], folder: &Path) -> RecordingSet {
    let mut plant = tumbler();
    plant.channels = vec!["body.target.orientation".into(), "body.target.angular_velocity".into()];
    let built = plant.build(effects).unwrap();
    let gauge = |channel: &str| -> (Gauge, scenario::measure::SensorModel) { built.sensor(channel).unwrap() };
    let (attitude, gyro) = (gauge("body.target.orientation"), gauge("body.target.angular_velocity"));
    let spins = [Vec3::new(0.01, 0.09, -0.02), Vec3::new(-0.07, 0.02, 0.05), Vec3::new(0.03, -0.04, 0.09)];
    let mut index = String::from("format = 1\nrig = \"tumbler\"\ntitle = \"planted\"\n\n[noise]\n");
    let _ = writeln!(index, "\"body.target.orientation\" = {ATTITUDE}\n\"body.target.angular_velocity\" = {GYRO}");
    for (run, spin) in spins.into_iter().enumerate() {
        let mut noise = Noise(17 + run as u64);
        let mut start = Start::nominal(&built);
        start.twists[0] = Twist::new(spin, Vec3::zeros());
        let mut world = start.world(&built, run);
        let mut text = String::from("t");
        for name in ["orientation.w", "orientation.x", "orientation.y", "orientation.z"] {
            let _ = write!(text, ",body.target.{name}");
        }
        text.push_str(
            ",body.target.angular_velocity.x,body.target.angular_velocity.y,body.target.angular_velocity.z\n",
        );
        for i in 0..=600 {
            let (Reading::Rotation(q), Reading::Vector(w)) =
                (attitude.1.apply(&attitude.0.read(&world)), gyro.1.apply(&gyro.0.read(&world)))
            else {
                unreachable!()
            };
            let q = q * exp_rotation(&noise.vector(ATTITUDE));
            let w = w + noise.vector(GYRO);
            let _ = writeln!(
                text,
                "{:.1},{:.5},{:.5},{:.5},{:.5},{:.5},{:.5},{:.5}",
                f64::from(i) * 0.2,
                q.w,
                q.i,
                q.j,
                q.k,
                w.x,
                w.y,
                w.z
            );
            (0..4).for_each(|_| world.advance_by(0.05).unwrap());
        }
        std::fs::write(folder.join(format!("run-{run}.csv")), text).unwrap();
        let role = if run < 2 { "fit" } else { "holdout" };
        let _ = write!(index, "\n[[run]]\nfile = \"run-{run}.csv\"\nrole = \"{role}\"\n");
    }
    std::fs::write(folder.join("recording.toml"), index).unwrap();
    RecordingSet::load(folder).unwrap()
}

fn diagnose_planted(effects: &[Effect]) -> Diagnosis {
    let folder = tempfile::tempdir().unwrap();
    let set = record_tumbler(effects, folder.path());
    diagnose::diagnose(tumbler().scenario, &set, &()).unwrap().0
}

fn value(diagnosis: &Diagnosis, parameter: &str, k: usize) -> f64 {
    diagnosis.effects[0].params[parameter].numbers().unwrap()[k]
}

/// A limit that ends the search in its midst, relative to the usual.
const LITTLE: f64 = 1e-3;

#[test]
fn a_search_that_its_limit_ends_ends_alike_with_any_number_of_threads() {
    let set = RecordingSet::load(&root().join("tests/recordings/tumble-inertia")).unwrap();
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| diagnose::run::diagnose_with(tumbler().scenario, &set, (LITTLE, &())).unwrap().0)
    };
    let one = of(1);
    assert!(one.remarks.iter().any(|r| r.contains("limit of work")), "{:?}", one.remarks);
    assert_eq!(one.to_json().unwrap(), of(3).to_json().unwrap());
    let whole = diagnose::diagnose(tumbler().scenario, &set, &()).unwrap().0;
    assert!(!whole.remarks.iter().any(|r| r.contains("limit of work")), "{:?}", whole.remarks);
}

/// Right name and place, and predictions of the unseen run that the noise alone limits.
fn check(diagnosis: &Diagnosis, name: &str, place: &str) {
    assert_eq!(diagnosis.verdict, Verdict::Explained, "{:?}", diagnosis.effects);
    assert_eq!(diagnosis.effects.len(), 1, "{:?}", diagnosis.effects);
    assert_eq!((diagnosis.effects[0].name.as_str(), diagnosis.effects[0].place.as_str()), (name, place));
    let holdout = diagnosis.error.holdout.unwrap();
    // A run has 3,606 scalars: its RMS is 1 ± 0.012.
    assert!(holdout.after < 1.05 && holdout.before > holdout.after, "{holdout:?}");
}

#[test]
fn nothing_is_found_where_nothing_was_planted() {
    let diagnosis = diagnose_planted(&[]);
    assert_eq!(diagnosis.verdict, Verdict::NoMismatch, "{:?}", diagnosis.effects);
    assert!(diagnosis.effects.is_empty() && diagnosis.located.is_empty());
}

fn wrong_inertia() -> Effect {
    let inertia = vec![95.0, 160.0, 215.0, 1.5, -2.0, 0.8];
    effect("body-inertia", "body:target", &[("inertia", ParamValue::Numbers(inertia))])
}

/// The recording that the README diagnoses; `SOFTDOCK_WRITE=1` writes it anew.
#[test]
fn the_shipped_recording_is_what_its_generator_makes() {
    let shipped = root().join("tests/recordings/tumble-inertia");
    let temporary = tempfile::tempdir().unwrap();
    let folder = if std::env::var_os("SOFTDOCK_WRITE").is_some() { shipped.clone() } else { temporary.path().into() };
    std::fs::create_dir_all(&folder).unwrap();
    record_tumbler(&[wrong_inertia()], &folder);
    for file in ["recording.toml", "run-0.csv", "run-1.csv", "run-2.csv"] {
        let read = |folder: &Path| std::fs::read_to_string(folder.join(file)).unwrap();
        assert_eq!(read(&folder).replace('\r', ""), read(&shipped).replace('\r', ""), "{file}");
    }
}

#[test]
fn a_wrong_inertia_is_found_again() {
    let diagnosis = diagnose_planted(&[wrong_inertia()]);
    check(&diagnosis, "body-inertia", "body:target");
    for (k, truth) in [(1, 160.0), (2, 215.0), (3, 1.5), (4, -2.0), (5, 0.8)] {
        let found = value(&diagnosis, "inertia", k);
        assert!((found - truth).abs() < 0.02 * 2.0, "inertia[{k}] = {found}, planted {truth}");
    }
}

#[test]
fn eddy_currents_are_found_again() {
    let diagnosis = diagnose_planted(&[effect("angular-damping", "body:target", &[("c", ParamValue::Number(0.05))])]);
    check(&diagnosis, "angular-damping", "body:target");
    assert!((value(&diagnosis, "c", 0) / 0.05 - 1.0).abs() < 0.05);
}

#[test]
fn a_fault_of_the_gyro_is_no_physics() {
    let place = "sensor:body.target.angular_velocity";
    let bias = ParamValue::Numbers(vec![4e-4, -3e-4, 2e-4]);
    let diagnosis = diagnose_planted(&[effect("sensor-bias", place, &[("bias", bias)])]);
    check(&diagnosis, "sensor-bias", place);
    assert!((value(&diagnosis, "bias", 0) - 4e-4).abs() < 4e-5);
}

/// A recording whose files were changed line by line, header first.
fn changed(change: impl Fn(usize, &str) -> String) -> (tempfile::TempDir, RecordingSet) {
    let folder = tempfile::tempdir().unwrap();
    record_tumbler(&[], folder.path());
    for run in 0..3 {
        let path = folder.path().join(format!("run-{run}.csv"));
        let text = std::fs::read_to_string(&path).unwrap();
        let lines: Vec<String> = text.lines().enumerate().map(|(i, line)| change(i, line)).collect();
        std::fs::write(&path, lines.join("\n") + "\n").unwrap();
    }
    let set = RecordingSet::load(folder.path()).unwrap();
    (folder, set)
}

/// The columns from `first` to `last` of a line, times a factor.
fn scaled(line: &str, (first, last): (usize, usize), factor: f64) -> String {
    let of = |(k, cell): (usize, &str)| match cell.parse::<f64>() {
        Ok(x) if (first..=last).contains(&k) => format!("{:.6}", factor * x),
        _ => cell.to_owned(),
    };
    line.split(',').enumerate().map(of).collect::<Vec<_>>().join(",")
}

#[test]
fn a_recording_that_cannot_belong_to_the_scenario_is_said_to_be_foreign() {
    let refusal = |set: &RecordingSet| diagnose::diagnose(tumbler().scenario, set, &()).err().map(|e| e.to_string());
    let cases: [(&str, (usize, usize), f64); 4] = [
        ("unit = \"ms\"", (0, 0), 1000.0),
        ("deg/s", (5, 7), 57.295_779_5),
        ("mirror image", (6, 6), -1.0),
        ("is not the derivative", (3, 3), -1.0),
    ];
    for (said, columns, factor) in cases {
        let (_folder, set) = changed(|i, line| if i == 0 { line.to_owned() } else { scaled(line, columns, factor) });
        let refused = refusal(&set).unwrap_or_default();
        assert!(refused.contains("cannot belong") && refused.contains(said), "columns {columns:?}: {refused:?}");
    }
    let (_folder, set) = changed(|_, line| line.replace("body.target", "body.chaser"));
    let refused = refusal(&set).unwrap_or_default();
    assert!(refused.contains("chaser") && refused.contains("run-0.csv"), "{refused:?}");
}
