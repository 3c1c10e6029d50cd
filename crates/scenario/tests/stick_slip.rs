//! The rig stick-slip against practice recordings: the true model predicts position and force to within the sensors' noise.
//!
//! Recordings are looked for in `$SOFTDOCK_RECORDINGS` or in `../shared/recordings` beside the checkout; without them the test
//! says that it was skipped.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use record::Signals;
use scenario::measure::Meter;
use scenario::{Mission, build, load};
use std::path::{Path, PathBuf};

/// The true laws of the sets, and their step: the nominal step, but for the level that falls within 3 mm/s.
const SETS: [(&str, &str, &[&str]); 4] = [
    (
        "01",
        "csv",
        &[
            "contact[0].friction.mu=0.235",
            "contact[0].friction.mu_static=0.275",
            "contact[0].friction.stribeck_velocity_m_per_s=0.003",
            "integrator.step_s=1e-4",
        ],
    ),
    ("02", "csv", &["contact[0].friction.mu=0.243"]),
    ("03", "parquet", &["contact[0].friction.mu=0.258", "contact[0].friction.across_ratio=0.9224806201550387", GRAIN]),
    (
        "04",
        "parquet",
        &[
            "contact[0].friction.viscous_n_s_per_m=14",
            "contact[0].friction.stiffness_n_per_m=38000",
            "contact[0].friction.damping_n_s_per_m=30",
        ],
    ),
];
/// Brushed along 0.5 rad.
const GRAIN: &str = "contact[0].grain={ on = \"world/plate\", axis = [0.8775825618903728, 0.479425538604203, 0.0] }";
/// Channels with sensor noise and written rounding.
const CHANNELS: [(&str, f64, f64); 4] = [
    ("body.slider.position.x", 5e-6, 1e-6),
    ("body.slider.position.y", 5e-6, 1e-6),
    ("sensor.spring.force.x", 0.02, 1e-3),
    ("sensor.spring.force.y", 0.02, 1e-3),
];

/// The practice sets, if they are here.
fn practice() -> Option<PathBuf> {
    let beside = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/recordings");
    let named = std::env::var_os("SOFTDOCK_RECORDINGS").filter(|folder| !folder.is_empty());
    let folder = named.map_or_else(|| PathBuf::from(beside), PathBuf::from);
    // The variable may also name what stands beside `practice`: `real`.
    [folder.join("practice"), folder.join("../practice")].into_iter().find(|dir| dir.is_dir())
}

/// RMS over noise of position and of force.
fn replay(mut mission: Mission, recording: &Signals) -> [f64; 2] {
    let model = mission.world.model().clone();
    let meters = CHANNELS.map(|(name, ..)| Meter::resolve(&mission.scenario, &model, name).unwrap());
    let columns = CHANNELS.map(|(name, ..)| recording.values(name).unwrap());
    let every = (1e-3 / model.step).round() as usize;
    let mut sums = [0.0; 4];
    let rows = (0..recording.times.len()).map(|row| columns.map(|column| column[row]));
    for row in rows.clone() {
        for (k, (_, noise, quantum)) in CHANNELS.into_iter().enumerate() {
            let variance = noise * noise + quantum * quantum / 12.0;
            sums[k] += (meters[k].read(&mission.world) - row[k]).powi(2) / variance;
        }
        (0..every).for_each(|_| mission.world.advance().unwrap());
    }
    [sums[0] + sums[1], sums[2] + sums[3]].map(|sum: f64| (0.5 * sum / rows.len() as f64).sqrt())
}

#[test]
fn true_laws_predict_every_run_to_the_noise() {
    let Some(practice) = practice() else {
        println!("SKIPPED: no recordings; set SOFTDOCK_RECORDINGS to the folder that holds practice/stick-slip-02");
        return;
    };
    let rig = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/rigs/stick-slip.toml");
    for (set, kind, laws) in SETS {
        for run in [1, 5] {
            let file = practice.join(format!("stick-slip-{set}/run-0{run}.{kind}"));
            let recording = match kind {
                "csv" => record::read_csv(&file).unwrap(),
                _ => record::read_parquet(&file).unwrap().1,
            };
            let mut overrides: Vec<String> = laws.iter().map(|s| (*s).to_owned()).collect();
            overrides.push(format!("drive.stage.file={}", file.display()));
            let mission =
                build(&load(&rig, &overrides).unwrap_or_else(|e| panic!("{e}"))).unwrap_or_else(|e| panic!("{e}"));
            let started = std::time::Instant::now();
            let [position, force] = replay(mission, &recording);
            println!(
                "stick-slip-{set} run {run}: position {position:.4}, force {force:.4}, {:.2} s",
                started.elapsed().as_secs_f64()
            );
            // 20,000 samples each: 1 ± 0.005, and the keys' own figures are 0.99 to 1.02.
            assert!((0.98..1.03).contains(&position) && (0.98..1.03).contains(&force), "set {set}, run {run}");
        }
    }
}
