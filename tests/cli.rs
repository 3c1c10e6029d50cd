//! The command as a user meets it: exit status, files, messages.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn softdock(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_softdock"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap()
}

fn error_of(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn place(dir: &tempfile::TempDir, name: &str) -> PathBuf {
    dir.path().join(name)
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn a_run_writes_a_whole_folder_and_says_so() {
    let dir = tempfile::tempdir().unwrap();
    let out = place(&dir, "run");
    let output = softdock(&["run", "scenarios/peer-grasp.toml", "--out", text(&out), "--set", "duration_s=10.0"]);
    assert_eq!(output.status.code(), Some(0), "{}", error_of(&output));
    for file in ["signals.parquet", "signals.svg", "summary.json"] {
        assert!(fs::metadata(out.join(file)).unwrap().len() > 100, "{file} is empty");
    }
    #[cfg(feature = "rerun")]
    assert!(fs::metadata(out.join("run.rrd")).unwrap().len() > 10_000);
    let summary: serde_json::Value = serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    assert_eq!(summary["outcome"], "completed");
    assert!(summary["work"]["steps"] == 10_000 && summary["metrics"]["momentum_drift_linear"].as_f64().unwrap() < 1e-9);
    assert!(summary["inputs"].as_str().unwrap().contains("peer-servicer.urdf"));
    let (_, signals) = softdock::record::read_parquet(&out.join("signals.parquet")).unwrap();
    assert_eq!(signals.times.len(), 1001);
    let left: Vec<_> = fs::read_dir(dir.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(left, ["run"], "something half-written stays behind");
}

#[test]
fn no_rrd_writes_none() {
    let dir = tempfile::tempdir().unwrap();
    let out = place(&dir, "run");
    let output = softdock(&["run", "scenarios/peer-free-arm.toml", "--no-rrd", "-q", "--out", text(&out)]);
    assert_eq!(output.status.code(), Some(0), "{}", error_of(&output));
    assert!(!out.join("run.rrd").exists() && out.join("signals.parquet").exists());
}

#[test]
fn an_expectation_that_fails_is_status_1() {
    let dir = tempfile::tempdir().unwrap();
    let out = place(&dir, "run");
    let slippery = [
        "run",
        "scenarios/tumbling-capture.toml",
        "--no-rrd",
        "--set",
        "contact[0].friction.mu=0.02",
        "--out",
        text(&out),
    ];
    let output = softdock(&slippery);
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("LOST") && said.contains("NOT AS EXPECTED: captured should be true"), "{said}");
}

#[test]
fn usage_is_status_2_and_bad_input_3() {
    assert_eq!(softdock(&["run"]).status.code(), Some(2));
    assert_eq!(softdock(&["run", "scenarios/nothing.toml"]).status.code(), Some(3));
    let output = softdock(&["run", "scenarios/peer-grasp.toml", "--set", "integrator.stepp_s=1e-3"]);
    assert_eq!(output.status.code(), Some(3));
    assert!(error_of(&output).contains("step_s"), "{}", error_of(&output));
}

#[test]
fn divergence_is_status_4_with_time_and_body() {
    let dir = tempfile::tempdir().unwrap();
    let out = place(&dir, "run");
    // Explicit forces at a step far beyond the stability limit of the pads.
    let wild = [
        "run",
        "scenarios/peer-grasp.toml",
        "--no-rrd",
        "--out",
        text(&out),
        "--set",
        "integrator.kind=rk4",
        "--set",
        "integrator.step_s=0.01",
    ];
    let output = softdock(&wild);
    assert_eq!(output.status.code(), Some(4), "{}", error_of(&output));
    let summary = fs::read_to_string(out.join("summary.json")).unwrap();
    assert!(summary.contains("diverged at t =") && summary.contains("last good state"), "{summary}");
}

#[test]
fn names_that_do_not_exist_are_told_with_line_and_nearest_spelling() {
    let dir = tempfile::tempdir().unwrap();
    let servicer = format!("{}/robots/servicer/servicer.urdf", env!("CARGO_MANIFEST_DIR"));
    let head = format!(
        "name = \"bad\"\nseed = 1\nduration_s = 1.0\n[[vehicle]]\nname = \"servicer\"\nurdf = \"{servicer}\"\n"
    );
    let cases = [
        ("[vehicle.joints]\nelbow_pich = { position_deg = 3.0 }\n", "elbow_pitch"),
        ("[vehicle.joints]\nelbow_pitch = { position_deg = 300.0 }\n", "range"),
        ("[vehicle.joints]\nelbow_pitch = { position_m = 0.1 }\n", "position_deg"),
        ("[[actuator]]\nname = \"a\"\nkind = \"joint-torque\"\njoint = \"servicer/wrist_rol\"\n", "wrist_roll"),
        ("[[contact]]\nbetween = [\"servicer/pad_lft\", \"servicer/palm\"]\n", "pad_left"),
        ("[[shape]]\nname = \"s\"\non = \"servicer/buss\"\nkind = \"sphere\"\nradius_m = 0.1\n", "bus"),
        ("[[effect]]\nname = \"payloat\"\nplace = \"link:servicer/palm\"\nmass = 1.0\n", "did you mean \"payload\""),
        ("[vehicle.end_effector_pose]\nframe = \"grasp_frame\"\nposition_m = [9.0, 0.0, 0.0]\n", "cannot reach"),
    ];
    for (tail, expected) in cases {
        let file = place(&dir, "bad.toml");
        fs::write(&file, format!("{head}{tail}")).unwrap();
        let output = softdock(&["check", text(&file)]);
        let said = error_of(&output);
        assert_eq!(output.status.code(), Some(3), "{tail}: {said}");
        assert!(said.contains(expected) && said.contains("bad.toml:"), "{tail}: {said}");
    }
}

#[test]
fn check_tells_every_fault_of_a_robot() {
    let dir = tempfile::tempdir().unwrap();
    let file = place(&dir, "bad.urdf");
    let robot = "<robot name='r'><link name='a'><inertial><mass value='nan'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' \
                 iyz='0' izz='9'/></inertial></link><link name='a'/></robot>";
    fs::write(&file, robot).unwrap();
    let output = softdock(&["check", text(&file)]);
    let said = error_of(&output);
    assert_eq!(output.status.code(), Some(3));
    assert!(said.contains("nan") && said.contains("bad.urdf") && said.matches("bad.urdf:").count() >= 2, "{said}");
}

#[test]
fn check_tells_each_doubt_once_and_strict_refuses_it() {
    let dir = tempfile::tempdir().unwrap();
    let (robot, scenario) = (place(&dir, "odd.urdf"), place(&dir, "odd.toml"));
    let body = "<inertial><mass value='1'/><inertia ixx='0.1' iyy='0.1' izz='0.31'/></inertial>";
    fs::write(&robot, format!("<robot name='r'><link name='a'>{body}</link></robot>")).unwrap();
    let vehicle = |name: &str| format!("[[vehicle]]\nname = \"{name}\"\nurdf = \"odd.urdf\"\n");
    let head = "name = \"odd\"\nseed = 1\nduration_s = 1.0\n";
    fs::write(&scenario, format!("{head}{}{}", vehicle("a"), vehicle("b"))).unwrap();
    for file in [&robot, &scenario] {
        let output = softdock(&["check", text(file)]);
        let (out, said) = (String::from_utf8_lossy(&output.stdout).into_owned(), error_of(&output));
        assert_eq!(output.status.code(), Some(0), "{said}");
        assert_eq!((said.matches("warning: ").count(), said.matches("odd.urdf:1:").count()), (1, 1), "{said}");
        assert!(out.contains("loads, with 1 warning."), "{out}");
        let strict = softdock(&["check", "--strict", text(file)]);
        assert_eq!(strict.status.code(), Some(3));
        assert!(error_of(&strict).contains("--strict refuses"), "{}", error_of(&strict));
    }
    let sound = softdock(&["check", "--strict", "robots/servicer/servicer.urdf"]);
    assert_eq!(sound.status.code(), Some(0), "{}", error_of(&sound));
}

#[test]
fn packages_are_found_by_option_and_by_the_search_paths_of_ros() {
    let dir = tempfile::tempdir().unwrap();
    let (robot, share) = (place(&dir, "robot/arm.urdf"), place(&dir, "ros/share"));
    fs::create_dir_all(robot.parent().unwrap()).unwrap();
    fs::create_dir_all(share.join("arm_meshes")).unwrap();
    fs::write(share.join("arm_meshes/palm.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let shape = "<visual><geometry><mesh filename='package://arm_meshes/palm.obj'/></geometry></visual>";
    fs::write(&robot, format!("<robot name='r'><link name='a'>{shape}</link></robot>")).unwrap();
    let check = |option: &[&str], variable: Option<(&str, &Path)>| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_softdock"));
        command.args(["check", "--strict", text(&robot)]).args(option);
        command.env_remove("ROS_PACKAGE_PATH").env_remove("AMENT_PREFIX_PATH").envs(variable);
        let output = command.output().unwrap();
        (output.status.code(), error_of(&output))
    };
    let (status, said) = check(&[], None);
    assert!(
        status == Some(3) && said.contains("package \"arm_meshes\" is not found") && said.contains("--package-path")
    );
    let (parent, package) = (share.parent().unwrap(), share.join("arm_meshes"));
    let found = [
        check(&["--package-path", text(&share)], None),
        check(&["--package-path", text(&package)], None),
        check(&[], Some(("ROS_PACKAGE_PATH", &share))),
        check(&[], Some(("AMENT_PREFIX_PATH", parent))),
    ];
    assert!(found.iter().all(|(status, _)| *status == Some(0)), "{found:?}");
}

#[test]
fn check_tells_a_xacro_source_how_to_become_a_urdf() {
    let dir = tempfile::tempdir().unwrap();
    let file = place(&dir, "arm.urdf.xacro");
    fs::write(&file, "<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'><xacro:arm/></robot>").unwrap();
    let output = softdock(&["check", text(&file)]);
    let said = error_of(&output);
    assert_eq!(output.status.code(), Some(3));
    assert!(said.contains("xacro") && said.contains("arm.urdf`") && said.matches("<xacro:arm>").count() == 1, "{said}");
}

#[test]
fn new_writes_a_scenario_that_captures_and_never_overwrites() {
    let output = softdock(&["new", "a/b"]);
    assert_eq!(output.status.code(), Some(3));
    let dir = tempfile::tempdir().unwrap();
    fs::create_dir(place(&dir, "scenarios")).unwrap();
    std::os::unix::fs::symlink(Path::new(env!("CARGO_MANIFEST_DIR")).join("robots"), place(&dir, "robots")).unwrap();
    let folder = place(&dir, "scenarios");
    let output = softdock(&["new", "mine", "--dir", text(&folder)]);
    assert_eq!(output.status.code(), Some(0), "{}", error_of(&output));
    let mine = folder.join("mine.toml");
    let output = softdock(&["check", text(&mine)]);
    assert_eq!(output.status.code(), Some(0), "{}", error_of(&output));
    let output = softdock(&["run", text(&mine), "--no-rrd", "--out", text(&place(&dir, "out"))]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stdout));
    assert_eq!(softdock(&["new", "mine", "--dir", text(&folder)]).status.code(), Some(3));
}

#[test]
fn a_folder_that_softdock_did_not_write_is_left_alone() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(place(&dir, "thesis.txt"), "years of work").unwrap();
    let output = softdock(&["run", "scenarios/peer-free-arm.toml", "--no-rrd", "--out", text(dir.path())]);
    assert_eq!(output.status.code(), Some(3));
    assert!(place(&dir, "thesis.txt").exists());
}

#[test]
fn schema_is_json() {
    let output = softdock(&["schema"]);
    let schema: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(schema["properties"]["vehicle"].is_object());
}

#[test]
#[cfg(feature = "rerun")]
fn view_shows_a_robot_and_a_scenario() {
    let dir = tempfile::tempdir().unwrap();
    for (file, name) in [("robots/servicer/servicer.urdf", "robot"), ("scenarios/tumbling-capture.toml", "scenario")] {
        let out = place(&dir, name);
        let output = softdock(&["view", file, "--out", text(&out)]);
        assert_eq!(output.status.code(), Some(0), "{}", error_of(&output));
        assert!(fs::metadata(out.join("view.rrd")).unwrap().len() > 10_000);
    }
}

#[test]
fn score_judges_a_folder_and_its_status_says_whether_all_is_met() {
    let dir = tempfile::tempdir().unwrap();
    let (keys, diagnoses) = (place(&dir, "keys"), place(&dir, "out"));
    fs::create_dir_all(&keys).unwrap();
    fs::create_dir_all(diagnoses.join("a")).unwrap();
    fs::write(keys.join("a.json"), r#"{"effects": [], "oracle": {"true": 1.0}}"#).unwrap();
    let error = r#"{"before": 1.0, "after": 1.0}"#;
    let diagnosis = |verdict: &str| {
        format!(
            r#"{{"verdict": "{verdict}", "located": [], "effects": [],
                "error": {{"fit": {error}, "holdout": {error}, "window_s": 1, "windowed": {error}, "runs": []}}}}"#
        )
    };
    for (verdict, status) in [("no-mismatch", 0), ("unknown", 1)] {
        fs::write(diagnoses.join("a/diagnosis.json"), diagnosis(verdict)).unwrap();
        let output = softdock(&["score", text(&diagnoses), text(&keys)]);
        assert_eq!(output.status.code(), Some(status), "{}", error_of(&output));
        assert!(String::from_utf8_lossy(&output.stdout).contains(verdict));
    }
    let json = softdock(&["score", text(&diagnoses), text(&keys), "--json"]).stdout;
    assert_eq!(serde_json::from_slice::<serde_json::Value>(&json).unwrap()["holds"], false);
    assert_eq!(softdock(&["score", text(&diagnoses), text(&place(&dir, "nowhere"))]).status.code(), Some(3));
    let schema = softdock(&["schema", "--diagnosis"]).stdout;
    let schema: serde_json::Value = serde_json::from_slice(&schema).unwrap();
    assert!(schema["properties"]["verdict"].is_object());
}

#[test]
fn inspect_prints_figures_writes_a_plot_and_ends_by_what_it_finds() {
    let dir = tempfile::tempdir().unwrap();
    let out = place(&dir, "inspection");
    let output = softdock(&["inspect", "tests/recordings/tumble", "--out", text(&out)]);
    assert_eq!(output.status.code(), Some(0), "{}", error_of(&output));
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(printed.contains("body.target.angular_velocity") && printed.contains("misfit"), "{printed}");
    let document: serde_json::Value = serde_json::from_slice(&fs::read(out.join("inspection.json")).unwrap()).unwrap();
    assert_eq!(document["format"], "softdock-inspection-1");
    assert!(fs::read_to_string(out.join("channels.svg")).unwrap().contains("<path"));
    let output = softdock(&["inspect", "tests/recordings/tumble-in-degrees", "--json"]);
    assert_eq!(output.status.code(), Some(1), "a gyro in deg/s contradicts its attitude");
    assert!(String::from_utf8_lossy(&output.stdout).contains("deg/s"));
    let output = softdock(&["inspect", "tests/recordings"]);
    assert_eq!(output.status.code(), Some(3));
    assert!(error_of(&output).contains("recording.toml"), "{}", error_of(&output));
}

#[test]
fn what_is_planted_is_written_as_a_recording_that_the_seed_decides() {
    let dir = tempfile::tempdir().unwrap();
    let plant = |name: &str, seed: &str, effect: &str| {
        let (out, key) = (place(&dir, name), place(&dir, &format!("keys/{name}.json")));
        let like = ["plant", "scenarios/rigs/tumbler.toml", "--like", "tests/recordings/tumble-inertia"];
        let rest = ["--seed", seed, "--effect", effect, "--out", text(&out), "--key", text(&key)];
        let output = softdock(&[&like[..], &rest[..]].concat());
        (output, out, key)
    };
    let damping = "name = \"angular-damping\", place = \"body:target\", c = 0.02";
    let [a, b, c] = [("a", "4"), ("b", "4"), ("c", "5")].map(|(name, seed)| plant(name, seed, damping));
    assert_eq!(a.0.status.code(), Some(0), "{}", error_of(&a.0));
    let run = |place: &Path| fs::read(place.join("run-02.csv")).unwrap();
    assert!(run(&a.1) == run(&b.1) && run(&a.1) != run(&c.1));
    let key: serde_json::Value = serde_json::from_slice(&fs::read(&a.2).unwrap()).unwrap();
    assert_eq!(key["effects"][0]["params"]["c"], 0.02);
    assert_eq!(softdock(&["inspect", text(&a.1)]).status.code(), Some(0));
    let wrong = plant("d", "1", "name = \"angular-dumping\", place = \"body:target\", c = 0.02").0;
    assert_eq!(wrong.status.code(), Some(3));
    assert!(error_of(&wrong).contains("angular-damping"), "{}", error_of(&wrong));
}
