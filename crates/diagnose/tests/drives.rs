//! What moves a driven part in a diagnosis: the channel that the scenario names for it, or else the scenario's own motion.
#![allow(clippy::unwrap_used)]

use diagnose::plant::Built;
use diagnose::start::Start;
use diagnose::synthesise;
use diagnose::tape::Tape;
use record::{RecordedRun, RecordingSet, Role, Series};

/// A slider behind a spring on a stage that turns about an axis 0.3 m aside.
const TURNING: &str = r#"
name = "turning"
seed = 1
duration_s = 1.0
[integrator]
kind = "rk4"
[[vehicle]]
name = "slider"
urdf = "robots/stick-slip/slider.urdf"
[[vehicle]]
name = "stage"
urdf = "robots/stick-slip/stage.urdf"
base = "fixed"
[[mechanism]]
name = "spring"
kind = "bushing"
a = { on = "stage/stage" }
b = { on = "slider/slider" }
stiffness_n_per_m = 800.0
damping_n_s_per_m = 30.0
[[drive]]
name = "stage"
vehicle = "stage"
pose = { position_m = [0.3, 0.0, 0.0] }
"#;

/// Turn of the stage, rad.
fn turn(t: f64) -> f64 {
    0.05 * (3.0 * t).sin()
}

/// A run of a second: where the slider is (nobody has looked yet), and how far the stage has turned.
fn recording(channel: Option<&str>) -> RecordingSet {
    let times: Vec<f64> = (0..=100).map(|k| 0.01 * f64::from(k)).collect();
    let series = |name: &str, values: Vec<f64>| Series::with_quantum(name, times.clone(), values, 0.0);
    let mut all = vec![series("body.slider.position.y", vec![0.0; times.len()])];
    all.extend(channel.map(|name| series(name, times.iter().map(|t| turn(*t)).collect())));
    all.sort_by(|a, b| a.channel.cmp(&b.channel));
    let run = RecordedRun { file: "run.csv".to_owned(), role: Role::Fit, note: String::new(), series: all };
    let noise = [("body.slider.position".to_owned(), 1e-9)].into();
    RecordingSet { runs: vec![run], noise, ..RecordingSet::default() }
}

/// Where the slider is at the end, m.
fn slider(motion: &str, like: &RecordingSet) -> Result<f64, String> {
    let file = format!("{}/../../turning.toml", env!("CARGO_MANIFEST_DIR"));
    let scenario = scenario::parse(&format!("{TURNING}{motion}"), &file, &[]).unwrap_or_else(|e| panic!("{e}"));
    let at_rest = |built: &Built, _: &Tape| Start::nominal(built);
    let set = synthesise(scenario, like, &at_rest, 1).map_err(|e| e.to_string())?;
    Ok(*set.runs[0].series("body.slider.position.y").unwrap().values.last().unwrap())
}

/// The spring follows at 25 rad/s; its lag behind a turn of 3 rad/s is a few per cent of the way of 0.3 m · 7 mrad.
const FOLLOWED: f64 = 5e-4;

#[test]
fn a_drive_follows_the_channel_that_the_scenario_names() {
    let motion = "kind = \"recording\"\nchannels = { yaw = \"drive.turntable.angle\" }\n";
    let end = slider(motion, &recording(Some("drive.turntable.angle"))).unwrap();
    let expected = -0.3 * turn(1.0).sin();
    assert!(expected.abs() > 2e-3 && (end - expected).abs() < FOLLOWED, "{end} m, by the turn {expected} m");
    let missing = slider(motion, &recording(Some("drive.stage.angle"))).unwrap_err();
    assert!(missing.contains("drive.turntable.angle"), "{missing}");
}

#[test]
fn a_drive_with_a_motion_of_its_own_needs_no_channel_and_follows_one_that_is_there() {
    let still = "kind = \"sine\"\namplitude_deg = 0.0\nfrequency_hz = 1.0\n";
    assert!(slider(still, &recording(None)).unwrap().abs() < 1e-6);
    let measured = slider(still, &recording(Some("drive.stage.angle"))).unwrap();
    assert!((measured + 0.3 * turn(1.0).sin()).abs() < FOLLOWED, "{measured}");
}
