//! What a controller is told through sensors: the readings that a recording holds, and a world that is the true one to what its sensors are worth.
#![allow(clippy::unwrap_used)]

use record::{Role, Series};
use scenario::{Mission, RigLog};
use sim::{Command, Controller, Known, Observer, State, World};
use spatial::{Pose, log_rotation};
use std::sync::Mutex;

/// A servicer with an arm of one joint that swings; a target that tumbles before its camera.
const SERVICER: &str = r#"<robot name="servicer">
<link name="bus"><inertial><mass value="200"/><inertia ixx="40" iyy="50" izz="60" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="arm"><inertial><origin xyz="0.5 0 0"/><mass value="20"/><inertia ixx="0.1" iyy="2" izz="2" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="shoulder" type="continuous"><parent link="bus"/><child link="arm"/><axis xyz="0 0 1"/></joint></robot>"#;
const TARGET: &str = r#"<robot name="target"><link name="hull">
<inertial><origin xyz="0.05 0 -0.1"/><mass value="100"/><inertia ixx="20" iyy="30" izz="35" ixy="1" ixz="-2" iyz="0"/></inertial></link></robot>"#;

/// Its text: with what its sensors are told to be worth, what more there is, and what is known.
fn text(camera: &str, sensors: &str, navigation: &str) -> String {
    format!(
        r#"name = "sight"
seed = 5
duration_s = 6.0
[integrator]
kind = "rk4"
step_s = 0.005
[[vehicle]]
name = "servicer"
urdf = "servicer.urdf"
base = "free"
twist = {{ linear_m_per_s = [0.01, 0.0, -0.02], angular_deg_per_s = [0.2, -0.3, 0.1] }}
[[vehicle]]
name = "target"
urdf = "target.urdf"
base = "free"
pose = {{ position_m = [3.0, 0.2, 0.1] }}
twist = {{ linear_m_per_s = [0.0, 0.03, 0.0], angular_deg_per_s = [3.0, -2.0, 1.5] }}
[[actuator]]
name = "shoulder"
kind = "joint-drive"
joint = "servicer/shoulder"
stiffness_n_m_per_rad = 400.0
damping_n_m_s_per_rad = 300.0
[strategy]
kind = "schedule"
commands = [{{ actuator = "shoulder", points = [[0.0, 0.0], [5.0, 1.0]] }}]
[[sensor]]
name = "camera"
kind = "pose"
link = "target/hull"
relative_to = "servicer/bus"
pose = {{ position_m = [0.4, 0.0, 0.1], rpy_deg = [-90.0, 0.0, -90.0] }}
rate_hz = 10.0
delay_s = 0.1
{camera}
{sensors}
[navigation]
{navigation}
"#
    )
}

const ENCODER: &str =
    "[[sensor]]\nname = \"encoder\"\nkind = \"joint-encoder\"\njoint = \"servicer/shoulder\"\nrate_hz = 200.0\n";
const GYRO: &str = "[[sensor]]\nname = \"gyro\"\nkind = \"imu\"\nlink = \"servicer/bus\"\nrate_hz = 200.0\n";
const SELFISH: &str =
    "[[sensor]]\nname = \"mirror\"\nkind = \"pose\"\nlink = \"servicer/arm\"\nrelative_to = \"servicer/bus\"\n";
const KNOWN: &str = "camera = \"camera\"\ngyro = \"gyro\"\n";

fn load(text: &str) -> Result<Mission, scenario::ScenarioErrors> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("servicer.urdf"), SERVICER).unwrap();
    std::fs::write(folder.path().join("target.urdf"), TARGET).unwrap();
    let file = folder.path().join("sight.toml");
    std::fs::write(&file, text).unwrap();
    scenario::build(&scenario::load(&file, &[])?)
}

fn mission(text: &str) -> Mission {
    load(text).unwrap_or_else(|e| panic!("{e}"))
}

/// A controller that does as another, and takes down what it is told.
struct Listener<'a> {
    strategy: &'a dyn Controller,
    told: Mutex<Told>,
}

#[derive(Clone, Debug, Default)]
struct Told {
    /// Arrival, stamp and x of the camera's positions.
    seen: Vec<(f64, f64, f64)>,
    /// The target from the own base, and whether that will do.
    target: Vec<(Pose, bool)>,
    /// The own joint: position and rate.
    joint: Vec<(f64, f64)>,
}

impl Controller for Listener<'_> {
    fn command(&self, known: &Known<'_>, memory: &mut Vec<f64>, commands: &mut [Command]) {
        self.strategy.command(known, memory, commands);
        let mut told = self.told.lock().unwrap();
        if let Some(said) = known.find("sensor.camera.position")
            && told.seen.last().is_none_or(|(arrived, ..)| *arrived < said.arrived)
        {
            told.seen.push((said.arrived, said.taken, said.value[0]));
        }
        let state = known.world.state();
        told.target.push((state.bases[0].inverse() * state.bases[1], known.is_ready));
        told.joint.push((state.q[0], state.v[0]));
    }
}

/// Runs to the end; what was told, what a rig recorded, and the true target from the own base at every command.
fn run(mission: &mut Mission) -> (Told, record::RecordingSet, Vec<Pose>) {
    let mut log = RigLog::new(mission).unwrap();
    let mut truth = Vec::new();
    let mut look = |world: &World| {
        truth.push(world.state().bases[0].inverse() * world.state().bases[1]);
        sim::Flow::Continue
    };
    let listener = Listener { strategy: &*mission.controller, told: Mutex::default() };
    mission.world.run(mission.steps, &listener, &mut [&mut log as &mut dyn Observer, &mut look]).unwrap();
    (listener.told.into_inner().unwrap(), log.finish("run.csv", (Role::Fit, "")), truth)
}

fn apart(told: &Pose, truth: &Pose) -> (f64, f64) {
    let turn = log_rotation(&(told.rotation.inverse() * truth.rotation)).norm();
    ((told.translation.vector - truth.translation.vector).norm(), turn)
}

const NOISE: &str = "position_noise_m = 0.01\nattitude_noise_deg = 0.5\ndropout = 0.1";

#[test]
fn a_controller_is_told_what_a_recording_holds() {
    let mut mission = mission(&text(NOISE, &format!("{ENCODER}noise_deg = 0.01\n{GYRO}"), KNOWN));
    let (told, set, _) = run(&mut mission);
    let series: &Series = set.runs[0].series("sensor.camera.position.x").unwrap();
    assert!(told.seen.len() > 45, "{}", told.seen.len());
    for ((arrived, taken, x), (time, value)) in told.seen.iter().zip(series.times.iter().zip(&series.values)) {
        assert_eq!((arrived, x), (time, value));
        assert!((arrived - taken - 0.1).abs() < 1e-12, "taken at {taken}, arrived at {arrived}");
    }
}

#[test]
fn by_sensors_without_errors_the_world_that_is_made_out_is_the_true_one() {
    // Without a gyro the base turns with the arm as smoothed differences of its encoder say, which come 50 ms late.
    let cases = [(format!("{ENCODER}{GYRO}"), KNOWN, 1.0), (ENCODER.to_owned(), "camera = \"camera\"\n", 10.0)];
    for (sensors, known, loose) in cases {
        let mut mission = mission(&text("", &sensors, known));
        let (told, _, truth) = run(&mut mission);
        let late = told.target.iter().zip(&truth).skip(400);
        for ((pose, is_ready), is) in late {
            let (shift, turn) = apart(pose, is);
            assert!(*is_ready);
            assert!(shift < loose * 5e-4 && turn < loose * 1e-4, "{shift} m and {turn} rad off with {known}");
        }
        let (told, is) = (told.joint.last().unwrap(), mission.world.state());
        assert!(
            (told.0 - is.q[0]).abs() < 1e-3 && (told.1 - is.v[0]).abs() < 5e-3,
            "{told:?} for {:?}",
            (is.q[0], is.v[0])
        );
    }
}

#[test]
fn a_filter_is_worth_more_than_the_camera_that_it_reads() {
    let worst = |known: &str| {
        let mut mission = mission(&text(NOISE, &format!("{ENCODER}{GYRO}"), known));
        let (told, _, truth) = run(&mut mission);
        let errors: Vec<(f64, f64)> =
            told.target.iter().zip(&truth).skip(800).map(|((pose, _), is)| apart(pose, is)).collect();
        let rms = |of: fn(&(f64, f64)) -> f64| {
            (errors.iter().map(|e| of(e).powi(2)).sum::<f64>() / errors.len() as f64).sqrt()
        };
        (rms(|e| e.0), rms(|e| e.1))
    };
    let (filtered, as_it_is) = (worst(KNOWN), worst(&format!("{KNOWN}filter = false\n")));
    assert!(3.0 * filtered.0 < as_it_is.0 && 3.0 * filtered.1 < as_it_is.1, "{filtered:?} beside {as_it_is:?}");
}

#[test]
fn a_camera_that_is_later_than_it_says_shows_the_target_where_it_was() {
    let late = "[[effect]]\nname = \"sensor-delay\"\nplace = \"sensor:sensor.camera.position\"\ndelay = 0.2\n\
                [[effect]]\nname = \"sensor-delay\"\nplace = \"sensor:sensor.camera.orientation\"\ndelay = 0.2\n";
    let mut mission = mission(&text("", &format!("{ENCODER}{GYRO}{late}"), KNOWN));
    let (told, _, truth) = run(&mut mission);
    // Steps of 5 ms: 40 of them are the delay that it does not know. That the own base turns counts as a turn of the target, and is predicted.
    for k in [800, 1000, 1150] {
        let (_, behind) = apart(&told.target[k].0, &truth[k]);
        let (_, then) = apart(&truth[k - 40], &truth[k]);
        assert!((behind / then - 1.0).abs() < 0.15, "{behind} rad behind, {then} rad in 0.2 s");
    }
}

#[test]
fn a_snapshot_in_a_file_continues_to_the_same_bits() {
    let mut mission = mission(&text(NOISE, &format!("{ENCODER}{GYRO}gyro_noise_rad_per_s = 1e-4\n"), KNOWN));
    mission.world.run(333, &*mission.controller, &mut []).unwrap();
    let snapshot: State = serde_json::from_str(&serde_json::to_string(mission.world.state()).unwrap()).unwrap();
    mission.world.run(900, &*mission.controller, &mut []).unwrap();
    let mut resumed = World::new(mission.world.model().clone(), snapshot);
    resumed.perceive(mission.perception());
    resumed.run(900, &*mission.controller, &mut []).unwrap();
    assert_eq!(resumed.state(), mission.world.state());
}

#[test]
fn what_is_missing_is_told_with_the_way_out() {
    for (sensors, known, says) in [
        (GYRO, KNOWN, "needs a [[sensor]] of kind joint-encoder at \"servicer/shoulder\""),
        (
            ENCODER,
            "camera = \"camera\"\ngyro = \"encoder\"\n",
            "\"encoder\" is no sensor of kind imu on the base of \"servicer\"",
        ),
        (ENCODER, "camera = \"encoder\"\n", "\"encoder\" is no sensor of kind pose that sees from a link"),
        (ENCODER, "camera = \"camra\"\n", "camera"),
        (SELFISH, "camera = \"mirror\"\n", "\"mirror\" sees the vehicle that carries it"),
    ] {
        let error = load(&text("", sensors, known)).map(|_| ()).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
}
