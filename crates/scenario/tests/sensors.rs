//! Sensors of a run against what was asked of them: noise, bias, walk, rate, delay, dropout, scale and limits; and against closed forms.
#![allow(clippy::unwrap_used)]

use record::{Format, RecordingSet, Role};
use scenario::measure::Meter;
use scenario::{Mission, RigLog};
use sim::Observer;
use spatial::Vec3;
use std::path::Path;

/// A body of 4 kg with its centre of mass off its origin, that spins about a principal axis and is pushed through its centre of mass.
const BODY: &str = r#"<robot name="body"><link name="hull">
<inertial><origin xyz="0.1 0.05 0"/><mass value="4"/><inertia ixx="0.3" iyy="0.4" izz="0.5" ixy="0" ixz="0" iyz="0"/></inertial>
</link></robot>"#;
/// A table that slides along x and turns about z, each by a drive.
const TABLE: &str = r#"<robot name="table"><link name="base"/><link name="cart"><inertial><mass value="2"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link><link name="plate"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="slide" type="prismatic"><parent link="base"/><child link="cart"/><axis xyz="1 0 0"/><limit lower="-9" upper="9" effort="99" velocity="9"/></joint>
<joint name="turn" type="continuous"><parent link="cart"/><child link="plate"/><axis xyz="0 0 1"/></joint></robot>"#;

fn scenario(rest: &str) -> String {
    format!(
        r#"name = "bench"
seed = 3
{rest}
[integrator]
kind = "rk4"
step_s = 0.01
[[vehicle]]
name = "body"
urdf = "body.urdf"
base = "free"
twist = {{ linear_m_per_s = [0.1, -0.2, 0.3], angular_deg_per_s = [0.0, 0.0, 30.0] }}
[[actuator]]
name = "jet"
kind = "thruster"
link = "body/hull"
position_m = [0.1, 0.05, 0.0]
direction = [1.0, 0.0, 0.0]
max_force_n = 2.0
"#
    )
}

fn mission(text: &str) -> Mission {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("body.urdf"), BODY).unwrap();
    std::fs::write(folder.path().join("table.urdf"), TABLE).unwrap();
    let file = folder.path().join("bench.toml");
    std::fs::write(&file, text).unwrap();
    scenario::build(&scenario::load(&file, &[]).unwrap_or_else(|e| panic!("{e}"))).unwrap_or_else(|e| panic!("{e}"))
}

/// What a rig would have recorded of it.
fn recorded(text: &str) -> RecordingSet {
    let mut mission = mission(text);
    let mut log = RigLog::new(&mission).unwrap();
    mission.world.run(mission.steps, &*mission.controller, &mut [&mut log as &mut dyn Observer]).unwrap();
    log.finish("run.csv", (Role::Fit, ""))
}

fn series(set: &RecordingSet, channel: &str) -> (Vec<f64>, Vec<f64>) {
    let series = set.runs[0].series(channel).unwrap_or_else(|| panic!("{channel} is not recorded"));
    (series.times.to_vec(), series.values.clone())
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn deviation(values: &[f64]) -> f64 {
    let mean = mean(values);
    (values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (values.len() - 1) as f64).sqrt()
}

/// Allan deviation at a time of so many samples.
fn allan(values: &[f64], samples: usize) -> f64 {
    let means: Vec<f64> = values.chunks_exact(samples).map(mean).collect();
    let squares: Vec<f64> = means.windows(2).map(|w| (w[1] - w[0]).powi(2)).collect();
    (0.5 * mean(&squares)).sqrt()
}

#[track_caller]
fn near(value: f64, asked: f64, share: f64) {
    assert!((value - asked).abs() <= share * asked.abs(), "{value} is not within {share} of {asked}");
}

const AXES: [&str; 3] = ["x", "y", "z"];

#[test]
fn an_accelerometer_off_the_axis_of_a_body_that_turns_and_is_pushed_feels_the_closed_form() {
    let imu = r#"
[environment]
kind = "lab"
gravity_m_per_s2 = [0.0, 0.0, -9.81]
[strategy]
kind = "schedule"
commands = [{ actuator = "jet", points = [[0.0, 1.5]] }]
[[sensor]]
name = "imu"
kind = "imu"
link = "body/hull"
pose = { position_m = [0.4, -0.3, 0.2], rpy_deg = [0.0, 0.0, 90.0] }
rate_hz = 20.0
"#;
    let mut mission = mission(&(scenario("duration_s = 1.0") + imu));
    let meter = |channel: &str| {
        Meter::resolve(&mission.scenario, mission.world.model(), &format!("sensor.imu.{channel}")).unwrap()
    };
    let felt = AXES.map(|k| meter(&format!("specific_force.{k}")));
    let turned = AXES.map(|k| meter(&format!("angular_velocity.{k}")));
    mission.world.run(50, &*mission.controller, &mut []).unwrap();
    // Gravity is not felt; push and centripetal acceleration are, in body axes constant; the sensor's x is the body's y.
    let rate = 30f64.to_radians();
    let arm = Vec3::new(0.4 - 0.1, -0.3 - 0.05, 0.2);
    let body = Vec3::new(1.5 / 4.0 - rate * rate * arm.x, -rate * rate * arm.y, 0.0);
    let sensor = Vec3::new(body.y, -body.x, body.z);
    for k in 0..3 {
        let read = felt[k].read(&mission.world);
        assert!((read - sensor[k]).abs() < 1e-9, "{}: {read} for {}", AXES[k], sensor[k]);
    }
    assert!((turned[2].read(&mission.world) - rate).abs() < 1e-9);
}

#[test]
fn an_accelerometer_at_rest_in_a_laboratory_feels_the_table() {
    let text = r#"
name = "table"
seed = 1
duration_s = 1.0
[integrator]
kind = "rk4"
step_s = 0.01
[environment]
kind = "lab"
gravity_m_per_s2 = [0.0, 0.0, -9.81]
[[vehicle]]
name = "body"
urdf = "body.urdf"
base = "fixed"
[[sensor]]
name = "imu"
kind = "imu"
link = "body/hull"
rate_hz = 10.0
"#;
    let set = recorded(text);
    let (_, z) = series(&set, "sensor.imu.specific_force.z");
    assert!(z.iter().all(|z| (z - 9.81).abs() < 1e-12), "{z:?}");
}

/// 200 s of a body that is not pushed.
fn long(sensors: &str) -> RecordingSet {
    recorded(&(scenario("duration_s = 200.0") + sensors))
}

#[test]
fn noise_bias_and_walk_are_those_that_were_asked_for() {
    let set = long(
        r#"
[[sensor]]
name = "imu"
kind = "imu"
link = "body/hull"
rate_hz = 100.0
gyro_noise_rad_per_s = 2e-3
gyro_bias_rad_per_s = [0.01, 0.02, -0.03]
[[sensor]]
name = "walking"
kind = "imu"
link = "body/hull"
rate_hz = 100.0
gyro_walk_rad_per_s_sqrt_s = 5e-4
accelerometer_walk_m_per_s2_sqrt_s = 3e-3
"#,
    );
    let of = |channel: &str| AXES.map(|k| series(&set, &format!("sensor.{channel}.{k}")).1);
    let gyro = of("imu.angular_velocity");
    near((gyro.iter().map(|v| deviation(v).powi(2)).sum::<f64>() / 3.0).sqrt(), 2e-3, 0.03);
    near(mean(&gyro[2]), 30f64.to_radians() - 0.03, 3e-4);
    near(mean(&gyro[0]), 0.01, 0.01);
    near(set.noise["sensor.imu.angular_velocity"], 2e-3, 1e-12);
    // A random walk of s √dt a sample: σ²(m) = s² dt (2 m² + 1)/(6 m) (Allan variance of means of m samples).
    for (channel, asked) in [("walking.angular_velocity", 5e-4), ("walking.specific_force", 3e-3)] {
        let samples = 10;
        let m = samples as f64;
        let factor = (0.01 * (2.0 * m * m + 1.0) / (6.0 * m)).sqrt();
        let square = of(channel).iter().map(|v| allan(v, samples).powi(2)).sum::<f64>() / 3.0;
        near(square.sqrt() / factor, asked, 0.03);
    }
}

#[test]
fn readings_come_at_their_rate_as_late_as_was_asked_and_as_often() {
    let set = long(
        r#"
[[sensor]]
name = "mocap"
kind = "pose"
link = "body/hull"
rate_hz = 50.0
delay_s = 0.1
dropout = 0.3
attitude_noise_deg = 0.2
"#,
    );
    let (times, x) = series(&set, "body.body.position.z");
    assert!(
        times.iter().all(|t| ((t - 0.1) * 50.0 - ((t - 0.1) * 50.0).round()).abs() < 1e-6),
        "instants of its clock"
    );
    // Straight and uniform along z: what arrives is as old as the delay.
    assert!(times.iter().zip(&x).all(|(t, z)| (z - 0.3 * (t - 0.1)).abs() < 1e-10));
    near(1.0 - x.len() as f64 / (50.0 * (200.0 - 0.1)), 0.3, 0.03);
    assert_eq!(times, series(&set, "body.body.orientation.w").0, "a message comes whole or not at all");
    // Attitude noise about each axis: of a body that turns about z, x and y of the quaternion are half of it, turned.
    let orientation = ["x", "y"].map(|k| series(&set, &format!("body.body.orientation.{k}")).1);
    let square = orientation.iter().map(|v| mean(&v.iter().map(|x| x * x).collect::<Vec<_>>())).sum::<f64>() / 2.0;
    near(2.0 * square.sqrt(), 0.2f64.to_radians(), 0.03);
}

/// A table, and a body that a spring ties.
const STAND: &str = r#"
[[vehicle]]
name = "table"
urdf = "table.urdf"
base = "fixed"
[[vehicle]]
name = "tied"
urdf = "body.urdf"
base = "free"
pose = { position_m = [0.0, 5.0, 0.0] }
[[mechanism]]
name = "tie"
kind = "bushing"
a = { on = "world", position_m = [0.0, 5.0, 0.0] }
b = { on = "tied/hull" }
stiffness_n_per_m = 1.0
"#;

/// Sensors of every kind on it: name, the rest of the entry, and each quantity with the noise that is asked for; of an angle in degrees.
type Asked = (&'static str, &'static str, &'static [(&'static str, f64)]);
const ASKED: [Asked; 8] = [
    (
        "encoder",
        "kind = 'joint-encoder'\njoint = 'table/turn'\nnoise_deg = 0.1",
        &[("joint.table/turn.position", 0.1 / DEGREES)],
    ),
    (
        "linear",
        "kind = 'joint-encoder'\njoint = 'table/slide'\nnoise_m = 2e-4",
        &[("joint.table/slide.position", 2e-4)],
    ),
    (
        "tachometer",
        "kind = 'tachometer'\njoint = 'table/turn'\nnoise_rad_per_s = 4e-3",
        &[("joint.table/turn.velocity", 4e-3)],
    ),
    (
        "imu",
        "kind = 'imu'\nlink = 'tied/hull'\naccelerometer_noise_m_per_s2 = 5e-3",
        &[("sensor.imu.specific_force", 5e-3)],
    ),
    (
        "camera",
        "kind = 'pose'\nlink = 'table/plate'\nrelative_to = 'table/base'\nposition_noise_m = 3e-3",
        &[("sensor.camera.position", 3e-3)],
    ),
    (
        "wrist",
        "kind = 'force-torque'\njoint = 'table/turn'\nforce_noise_n = 0.2\ntorque_noise_n_m = 0.03",
        &[("sensor.wrist.force", 0.2), ("sensor.wrist.torque", 0.03)],
    ),
    (
        "skin",
        "kind = 'contact-force'\npart = 'table/plate'\nlink = 'table/plate'\nforce_noise_n = 0.4\ntorque_noise_n_m = 0.05",
        &[("sensor.skin.force", 0.4), ("sensor.skin.torque", 0.05)],
    ),
    (
        "pull",
        "kind = 'mechanism-force'\nmechanism = 'tie'\nforce_noise_n = 0.6\ntorque_noise_n_m = 0.07",
        &[("sensor.pull.force", 0.6), ("sensor.pull.torque", 0.07)],
    ),
];
/// In a radian.
const DEGREES: f64 = 180.0 / std::f64::consts::PI;

#[test]
fn every_kind_has_the_noise_the_rate_and_the_delay_that_were_asked_for() {
    let entry =
        |(name, rest, _): &Asked| format!("[[sensor]]\nname = '{name}'\nrate_hz = 50.0\ndelay_s = 0.03\n{rest}\n");
    let set = long(&(STAND.to_owned() + &ASKED.iter().map(entry).collect::<String>()));
    for (quantity, asked) in ASKED.iter().flat_map(|(_, _, quantities)| *quantities) {
        let is_scalar = quantity.starts_with("joint");
        let channels: Vec<String> = match is_scalar {
            true => vec![(*quantity).to_owned()],
            false => AXES.iter().map(|k| format!("{quantity}.{k}")).collect(),
        };
        let square = |channel: &String| deviation(&series(&set, channel).1).powi(2);
        let sigma = (channels.iter().map(square).sum::<f64>() / channels.len() as f64).sqrt();
        near(sigma, *asked, 0.03);
        let (times, _) = series(&set, &channels[0]);
        assert!((times[0] - 0.03).abs() < 1e-9, "{quantity}: the first comes at {} s", times[0]);
        near((times.len() - 1) as f64 / (times[times.len() - 1] - times[0]), 50.0, 1e-3);
    }
}

#[test]
fn scales_end_and_have_steps_and_a_camera_sees_what_is_before_it() {
    let text = r#"
[[vehicle]]
name = "table"
urdf = "table.urdf"
base = "fixed"
joints = { slide = { position_m = 0.5, velocity_m_per_s = 0.01 }, turn = { velocity_deg_per_s = 10.0 } }
[[sensor]]
name = "scales"
kind = "joint-encoder"
joint = "table/*"
rate_hz = 100.0
resolution_deg = 0.5
resolution_m = 1e-3
bias_m = 2e-3
[[sensor]]
name = "gyro"
kind = "imu"
link = "body/hull"
rate_hz = 100.0
gyro_limit_rad_per_s = 0.5
[[sensor]]
name = "camera"
kind = "pose"
link = "table/plate"
relative_to = "table/base"
pose = { rpy_deg = [0.0, 90.0, 0.0] }
range_m = 0.55
field_of_view_deg = 10.0
rate_hz = 10.0
"#;
    let set = recorded(&(scenario("duration_s = 10.0") + text));
    let of = |channel: &str| series(&set, channel);
    let (times, slide) = of("joint.table/slide.position");
    let off = |(t, x): (&f64, &f64)| x - (0.502 + 0.01 * t);
    assert!(slide.iter().all(|x| (x * 1e3 - (x * 1e3).round()).abs() < 1e-9), "steps of a millimetre");
    assert!(times.iter().zip(&slide).map(off).all(|e| e.abs() <= 0.5e-3 + 1e-9));
    let (_, turn) = of("joint.table/turn.position");
    let step = 0.5f64.to_radians();
    assert!(turn.iter().all(|x| (x / step - (x / step).round()).abs() < 1e-9), "steps of half a degree");
    let (_, rate) = of("sensor.gyro.angular_velocity.z");
    assert!(rate.iter().all(|w| *w == 0.5), "a gyro that ends at 0.5 rad/s");
    // The camera looks along the table's x; the plate leaves its range after 5 s.
    let (seen, z) = of("sensor.camera.position.z");
    assert!(z.iter().zip(&seen).all(|(z, t)| (z - (0.5 + 0.01 * t)).abs() < 1e-9));
    assert!((seen.last().unwrap() - 5.0).abs() < 0.11, "{:?}", seen.last());
}

#[test]
fn what_was_commanded_is_recorded_as_it_changes_and_the_same_run_is_the_same_to_the_bit() {
    let text = scenario("duration_s = 1.0")
        + r#"
[strategy]
kind = "schedule"
commands = [{ actuator = "jet", points = [[0.0, 1.0], [0.499, 1.0], [0.5, 0.5]] }]
[[sensor]]
name = "mocap"
kind = "pose"
link = "body/hull"
rate_hz = 20.0
position_noise_m = 1e-3
"#;
    let (a, b) = (recorded(&text), recorded(&text));
    assert_eq!(a.runs[0].series, b.runs[0].series);
    let (times, values) = series(&a, "actuator.jet.command");
    assert_eq!(times.len(), 2, "{times:?}");
    assert!((times[1] - 0.5).abs() < 1e-9 && values == [0.5, 0.25], "{times:?} {values:?}: by the largest force");
    let folder = tempfile::tempdir().unwrap();
    a.append_to(folder.path(), Format::Csv).unwrap();
    b.append_to(folder.path(), Format::Parquet).unwrap();
    let read = RecordingSet::load(folder.path()).unwrap();
    assert_eq!(read.runs.iter().map(|r| r.file.as_str()).collect::<Vec<_>>(), ["run-01.csv", "run-02.parquet"]);
    assert_eq!(read.runs[0].series, read.runs[1].series);
    assert!(Path::new(&read.folder).ends_with(folder.path().file_name().unwrap()));
}

#[test]
fn two_sensors_of_one_quantity_and_one_of_none_are_refused() {
    let twice = r#"
[[sensor]]
name = "one"
kind = "pose"
link = "body/hull"
[[sensor]]
name = "two"
kind = "pose"
link = "body/hull"
"#;
    let refused = RigLog::new(&mission(&(scenario("duration_s = 1.0") + twice))).unwrap_err().to_string();
    assert!(refused.contains("sensor[1]") && refused.contains("as another sensor does"), "{refused}");
    let none = RigLog::new(&mission(&scenario("duration_s = 1.0"))).unwrap_err().to_string();
    assert!(none.contains("add a [[sensor]]"), "{none}");
}
