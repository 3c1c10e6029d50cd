//! Shapes that stand inside each other at t = 0 are refused, with the pair, the depth, the energy and a way out; what lies
//! or is pressed at rest is not.
#![allow(clippy::unwrap_used)]

use scenario::{build, parse};

const STIFFNESS: f64 = 1e5;
const WEIGHT: f64 = 9.81;

fn said(text: &str) -> String {
    let file = format!("{}/../../s.toml", env!("CARGO_MANIFEST_DIR"));
    let scenario = parse(text, &file, &[]).unwrap_or_else(|e| panic!("{e}"));
    build(&scenario).err().map_or(String::new(), |e| e.to_string())
}

fn head(environment: &str) -> String {
    let gravity = if environment == "lab" { format!("gravity_m_per_s2 = [0, 0, -{WEIGHT}]\n") } else { String::new() };
    format!(
        "name = \"t\"\nseed = 1\nduration_s = 1.0\n[environment]\nkind = \"{environment}\"\n{gravity}\
         [contact_default]\nnormal = {{ law = \"linear\", stiffness_n_per_m = {STIFFNESS} }}\nfriction = {{ law = \"none\" }}\n"
    )
}

fn block(name: &str, position: [f64; 3]) -> String {
    format!(
        "[[vehicle]]\nname = \"{name}\"\nurdf = \"robots/bench/peer-block.urdf\"\npose = {{ position_m = {position:?} }}\n"
    )
}

/// A block of 1 kg, 0.1 m high, `depth` deep in the floor.
fn on_the_floor(environment: &str, depth: f64) -> String {
    let floor = "[[shape]]\nname = \"floor\"\nkind = \"half-space\"\n";
    said(&format!("{}{}{floor}", head(environment), block("box", [0.0, 0.0, 0.05 - depth])))
}

#[test]
fn a_block_in_the_floor_is_refused_with_its_depth_energy_and_speed() {
    let said = on_the_floor("lab", 5e-3);
    // Four corners: 4 k δ²/2 = 5 J and 2,000 N, of which the weight holds 9.81 N; what is left of 5 J, 4.951 J, parts 1 kg.
    let speed = (2.0_f64 * (5.0 - WEIGHT * 5e-3)).sqrt();
    for fragment in [
        "\"box/block\" and \"world/floor\" overlap by 5.000 mm at t = 0",
        "presses with 2000.000 N",
        "9.810 N hold",
        "stores 5.000 J",
        "Move \"box\" by its pose",
        "between = [\"box/block\", \"world/floor\"], enabled = false",
        "s.toml:13:",
    ] {
        assert!(said.contains(fragment), "{fragment} is not in:\n{said}");
    }
    let told: f64 = said.split("the lighter at ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    // Told to a millimetre per second.
    assert!((told - speed).abs() < 1e-3, "{told} m/s against {speed} m/s");
}

#[test]
fn what_its_load_would_press_in_by_itself_is_sound() {
    // At rest four corners give way by m g/4k; let go at the first touch the block would swing to twice that.
    let rest = WEIGHT / (4.0 * STIFFNESS);
    for (depth, is_sound) in [(0.0, true), (rest, true), (1.9 * rest, true), (2.2 * rest, false), (4.0 * rest, false)] {
        let said = on_the_floor("lab", depth);
        assert_eq!(said.is_empty(), is_sound, "{} of the depth at rest: {said}", depth / rest);
    }
    assert!(!on_the_floor("deep-space", 1.9 * rest).is_empty(), "nothing presses there");
}

#[test]
fn rounding_is_no_overlap() {
    // 0.1 µm of a file's last digit: 1 kg on 4e5 N/m parts at 63 µm/s.
    assert_eq!(on_the_floor("deep-space", 1e-7), "");
    let said = on_the_floor("deep-space", 1e-5);
    assert!(said.contains("overlap by 0.010 mm") && said.contains("0.006 m/s"), "{said}");
}

#[test]
fn what_is_held_from_both_sides_presses_for_ever_and_is_refused() {
    let walls = "[[shape]]\nname = \"left\"\nkind = \"half-space\"\npose = { position_m = [-0.099, 0, 0], rpy_deg = [0, 90, 0] }\n\
                 [[shape]]\nname = \"right\"\nkind = \"half-space\"\npose = { position_m = [0.099, 0, 0], rpy_deg = [0, -90, 0] }\n";
    let between = said(&format!("{}{}{walls}", head("deep-space"), block("box", [0.0; 3])));
    assert!(between.contains("\"box/block\" and \"world/left\"") && between.contains("\"world/right\""), "{between}");
    let three = [block("a", [-0.198, 0.0, 0.0]), block("b", [0.0; 3]), block("c", [0.198, 0.0, 0.0])].concat();
    let said = said(&format!("{}{three}", head("deep-space")));
    assert!(said.contains("\"a/block\" and \"b/block\"") && said.contains("\"b/block\" and \"c/block\""), "{said}");
    assert!(said.contains("overlap by 2.000 mm"), "{said}");
}

#[test]
fn a_stack_is_held_by_all_of_its_weight() {
    let rest = |blocks: f64| blocks * WEIGHT / (4.0 * STIFFNESS);
    let floor = "[[shape]]\nname = \"floor\"\nkind = \"half-space\"\n";
    let stack = |factor: f64| {
        let lower = 0.05 - factor * rest(2.0);
        let upper = lower + 0.1 - factor * rest(1.0);
        said(&format!("{}{}{}{floor}", head("lab"), block("low", [0.0, 0.0, lower]), block("top", [0.0, 0.0, upper])))
    };
    assert_eq!(stack(1.0), "");
    assert_eq!(stack(1.5), "");
    let deep = stack(5.0);
    assert!(
        deep.contains("\"low/block\" and \"top/block\"") || deep.contains("\"low/block\" and \"world/floor\""),
        "{deep}"
    );
}

/// Three boxes in a row, 0.1 m apart and 0.12 m long: neighbours overlap by 20 mm, and the third leans on the first.
const ARM: &str = r#"<robot name="arm">
<link name="base"><inertial><mass value="5"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision name="base_box"><geometry><box size="0.12 0.05 0.05"/></geometry></collision></link>
<link name="upper"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision name="upper_box"><geometry><box size="0.12 0.05 0.05"/></geometry></collision></link>
<link name="fore"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision name="fore_box"><geometry><box size="0.12 0.05 0.05"/></geometry></collision></link>
<joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/><origin xyz="0.1 0 0"/><axis xyz="0 0 1"/></joint>
<joint name="elbow" type="prismatic"><parent link="upper"/><child link="fore"/><origin xyz="0.1 0 0"/><axis xyz="1 0 0"/>
<limit lower="-0.2" upper="0.2" effort="10" velocity="1"/></joint>
</robot>"#;

fn arm(elbow: f64, contact: &str) -> Result<usize, String> {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("arm.urdf"), ARM).unwrap();
    let vehicle = "[[vehicle]]\nname = \"arm\"\nurdf = \"arm.urdf\"\n";
    let text = format!("{}{vehicle}joints = {{ elbow = {{ position_m = {elbow} }} }}\n{contact}", head("deep-space"));
    let file = dir.path().join("s.toml").display().to_string();
    let mission = build(&parse(&text, &file, &[]).unwrap_or_else(|e| panic!("{e}"))).map_err(|e| e.to_string())?;
    Ok(mission.world.model().scene.pairs().len())
}

#[test]
fn a_glob_leaves_out_links_that_one_joint_holds_together() {
    let all = "[[contact]]\nbetween = [\"*\", \"*\"]\n";
    assert_eq!(arm(0.0, ""), Ok(0), "links of one vehicle touch where a rule names them");
    assert_eq!(arm(0.0, all), Ok(1), "base and fore");
    assert_eq!(arm(0.0, "[[contact]]\nbetween = [\"arm/upper\", \"arm/*\"]\n"), Ok(0));
}

#[test]
fn neighbours_that_are_named_and_overlap_are_refused_with_the_joint_between_them() {
    let said = arm(0.0, "[[contact]]\nbetween = [\"arm/base\", \"arm/upper\"]\n").unwrap_err();
    // A face of 0.05 m by 0.05 m in another, 20 mm deep: four points of 20 J.
    for fragment in
        ["\"arm/base_box\" and \"arm/upper_box\"", "20.000 mm", "80.000 J", "joint \"shoulder\"", "enabled = false"]
    {
        assert!(said.contains(fragment), "{fragment} is not in:\n{said}");
    }
    let apart = "[[contact]]\nbetween = [\"arm/upper\", \"arm/fore\"]\n";
    assert_eq!(arm(0.1, apart), Ok(1), "named and apart, they may touch: a slide against its stop");
}

#[test]
fn links_that_no_joint_holds_together_and_overlap_are_refused_with_their_joints_as_the_way_out() {
    let said = arm(-0.15, "[[contact]]\nbetween = [\"*\", \"*\"]\n").unwrap_err();
    for fragment in ["\"arm/base_box\" and \"arm/fore_box\"", "Start with other joint positions", "s.toml:12:"] {
        assert!(said.contains(fragment), "{fragment} is not in:\n{said}");
    }
    assert!(!said.contains("holds them together"), "{said}");
}

#[test]
fn a_finger_that_its_motor_presses_on_a_wall_is_held_by_that() {
    let pressed = |depth: f64| {
        let wall = format!(
            "[[shape]]\nname = \"wall\"\nkind = \"half-space\"\npose = {{ position_m = [{}, 0, 0], rpy_deg = [0, -90, 0] }}\n",
            0.31 - depth
        );
        let motor = "[[actuator]]\nname = \"m\"\nkind = \"joint-torque\"\njoint = \"arm/elbow\"\nlimit_n = 100.0\n\
                     [strategy]\nkind = \"schedule\"\ncommands = [{ actuator = \"m\", points = [[0, 80.0]] }]\n";
        arm(0.05, &format!("{wall}{motor}").replace("[[shape]]", "[[shape]]")).map(|_| ())
    };
    // The base floats: of 80 N the wall bears what does not go into moving 7 kg: a finger of 1 kg against 6 kg, held by nothing.
    assert!(pressed(0.0).is_ok());
    let held = pressed(1e-4);
    assert!(held.is_ok(), "40 N on four corners of 1e5 N/m, below 80 N: {held:?}");
    assert!(pressed(1e-3).is_err(), "400 N against 80 N");
}

#[test]
fn very_many_pairs_are_told_in_short() {
    let blocks: String = (0..6).map(|k| block(&format!("b{k}"), [0.001 * f64::from(k), 0.0, 0.0])).collect();
    let said = said(&format!("{}{blocks}", head("deep-space")));
    assert_eq!(said.matches(" overlap by ").count(), 8, "{said}");
    assert!(said.contains("7 more pairs of shapes overlap"), "{said}");
}
