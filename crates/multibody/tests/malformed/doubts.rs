//! Odd robots that are no impossible ones: each loads with a warning that names file, place and subject, and says what was
//! assumed. Published robots have every one of these; the module's names say which where it is not plain.

use crate::physics::inertial;
use crate::table::{Case, SOUND_INERTIAL, check_doubts, joint, link, robot, robot_with_joint};
use multibody::{Freedom, SearchPaths, Tree, find_singular_freedoms, find_singular_freedoms_at, parse_urdf};
use std::path::Path;

const FIXED: [bool; 6] = [false; 6];
const FREE: [bool; 6] = [true; 6];

fn tree(text: &str) -> Tree {
    let loaded = parse_urdf(text, Path::new("odd.urdf"), Path::new("."), &SearchPaths::default());
    Tree::from_description(&loaded.unwrap_or_else(|e| panic!("{e}")).robot)
}

fn fixed(name: &str, a: &str, b: &str) -> String {
    format!("<joint name=\"{name}\" type=\"fixed\"><parent link=\"{a}\"/><child link=\"{b}\"/></joint>")
}

/// A link with a mass and a tensor of its own, in a line of its own.
fn body(name: &str, mass: &str, tensor: &str) -> String {
    format!("<link name=\"{name}\">\n<inertial><mass value=\"{mass}\"/><inertia {tensor}/></inertial></link>")
}

#[test]
fn bodies_that_are_not_rigid_are_simulated_as_written() {
    let palm = |name, text, fault| Case::new(name, text, &["bad.urdf:3:1", "link \"palm\"", fault]);
    let antenna = body("antenna", "0.001", r#"ixx="4e-8" ixy="7e-8" iyy="3e-8" izz="6e-8""#);
    let tip = body("tip", "0", r#"ixx="0.1" iyy="0.1" izz="0.1""#);
    check_doubts(
        vec![
            palm(
                "triangle inequality",
                inertial("1", r#"ixx="0.10" iyy="0.10" izz="0.31""#),
                "inertia violates Ixx + Iyy ≥ Izz (0.1 + 0.1 < 0.31), which no rigid body does: it is simulated as written",
            ),
            palm("triangle, turned", inertial("1", r#"ixx="0.2" ixy="0.105" iyy="0.2" izz="0.08""#), "I1 + I2 ≥ I3"),
            palm("point mass", inertial("3", r#"ixx="0" iyy="0" izz="0""#), "a mass of 3 kg but no inertia"),
            Case::new(
                "negative moment on a body that makes up for it",
                robot(&[link("base"), antenna, fixed("mount", "base", "antenna")].concat()),
                &["bad.urdf:3", "link \"antenna\"", "not positive definite", "simulated as written"],
            ),
            Case::new(
                "inertia without mass",
                robot(&[link("base"), tip, joint("elbow", "base", "tip")].concat()),
                &["bad.urdf:3", "link \"tip\"", "an inertia but mass 0", "simulated as written"],
            ),
        ],
        Path::new("."),
    );
}

#[test]
fn point_masses_and_frames_on_a_body_are_no_doubt() {
    let text = robot(
        &[
            link("base"),
            body("imu", "0.01", r#"ixx="0" iyy="0" izz="0""#),
            body("frame", "0", r#"ixx="0" iyy="0" izz="0""#),
            fixed("a", "base", "imu"),
            fixed("b", "imu", "frame"),
        ]
        .concat(),
    );
    let loaded = parse_urdf(&text, Path::new("odd.urdf"), Path::new("."), &SearchPaths::default()).expect("it loads");
    assert_eq!(loaded.warnings.to_string(), "");
    assert_eq!(Tree::from_description(&loaded.robot).mass(), 1.01);
}

/// Romeo's grippers; and a chain of two coincident axes with nothing between.
#[test]
fn joints_that_nothing_resists_load_and_are_told() {
    let massless_tip = robot(&format!("{}<link name=\"tip\"/>\n{}", link("base"), joint("elbow", "base", "tip")));
    let far_mass = robot(&format!(
        "{}<link name=\"mid\"/>\n{}{}\n{}",
        link("base"),
        joint("elbow", "base", "mid"),
        link("tip"),
        joint("wrist", "mid", "tip"),
    ));
    let singular = |text: &str| find_singular_freedoms(&tree(text), FIXED);
    assert_eq!(singular(&massless_tip), [Freedom::Joint(0)]);
    assert_eq!(singular(&far_mass), [Freedom::Joint(0)], "the inner of two");
    let apart = far_mass.replacen("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 1 0\"/>", 1);
    assert_eq!(singular(&apart), [], "a massless link between two axes is a universal joint");
    let mut geared = tree(&massless_tip);
    geared.joints[0].armature = 1e-4;
    assert_eq!(find_singular_freedoms(&geared, FREE), [], "a rotor resists");
    let told = &["bad.urdf:3:1", "joint \"elbow\"", "cannot be simulated while it moves freely", "armature"];
    let nothing = |name, text: &str, fault: &str| Case::new(name, text, &[told.as_slice(), &[fault]].concat());
    check_doubts(
        vec![
            nothing("massless tip", &massless_tip, "neither link \"tip\" nor anything beyond has mass"),
            nothing("coincident axes", &far_mass, "resists it with no inertia"),
        ],
        Path::new("."),
    );
}

/// A point mass on three axes that meet: iCub's head.
#[test]
fn a_point_mass_in_line_with_its_axis_is_singular_there_alone() {
    let tip = "<link name=\"tip\"><inertial><origin xyz=\"0 0 1\"/><mass value=\"1\"/><inertia ixx=\"0\" iyy=\"0\" izz=\"0\"/></inertial></link>";
    let yaw = joint("yaw", "base", "mid");
    let pitch = joint("pitch", "mid", "tip").replace("0 0 1", "0 1 0");
    let tree =
        tree(&robot(&[&link("base"), "<link name=\"mid\"/>", tip, &yaw, &pitch].map(ToString::to_string).concat()));
    assert_eq!(find_singular_freedoms(&tree, FIXED), []);
    assert_eq!(find_singular_freedoms_at(&tree, FIXED, &[0.3, 0.0]), [Freedom::Joint(0)], "it stands on the yaw axis");
    assert_eq!(find_singular_freedoms_at(&tree, FIXED, &[0.3, 0.1]), []);
}

#[test]
fn a_free_base_needs_inertia_of_its_own_or_of_its_tree() {
    let point = inertial("3", r#"ixx="0" iyy="0" izz="0""#);
    assert_eq!(find_singular_freedoms(&tree(&point), FREE), [Freedom::Base], "a point mass spins as it likes");
    assert_eq!(find_singular_freedoms(&tree(&point), [false, false, false, true, true, true]), []);
    let rail = robot(&[String::from("<link name=\"rail\"/>"), link("cart"), joint("slide", "rail", "cart")].concat());
    assert_eq!(find_singular_freedoms(&tree(&rail), FREE), [Freedom::Base], "a massless rail turns under its cart");
    assert_eq!(find_singular_freedoms(&tree(&rail), FIXED), []);
}

#[test]
fn limits_and_leaders_that_are_not_there_leave_the_joint_free() {
    let limit = r#"<limit lower="-1" upper="1" effort="1" velocity="1"/>"#;
    let elbow = |name, kind, inside: &str, faults: &[&str]| {
        let mut case = Case::new(name, robot_with_joint(kind, inside), faults);
        case.expected.extend(["bad.urdf:".into(), "joint \"elbow\"".into()]);
        case
    };
    check_doubts(
        vec![
            elbow("no limit", "revolute", "", &["a revolute joint without <limit>: it has none", "continuous"]),
            elbow("no limit, sliding", "prismatic", "", &["a prismatic joint without <limit>: it has none"]),
            elbow(
                "empty limit",
                "revolute",
                "<limit effort=\"1\" velocity=\"1\"/>",
                &["neither lower nor upper", "no stops"],
            ),
            elbow(
                "crossed limits",
                "revolute",
                "<limit lower=\"1\" upper=\"-1\"/>",
                &["lower 1 is not below upper -1"],
            ),
            elbow("equal limits", "prismatic", "<limit lower=\"0\" upper=\"0\"/>", &["lower 0 is not below upper 0"]),
            elbow("no effort", "revolute", &limit.replace("effort=\"1\"", "effort=\"0\""), &["effort 0"]),
            elbow(
                "follows nobody",
                "revolute",
                &format!("{limit}<mimic joint=\"elbwo\"/>"),
                &["does not exist, did you mean"],
            ),
            elbow("fixed and follows", "fixed", "<mimic joint=\"elbow\"/>", &["a fixed joint cannot follow"]),
            elbow("axis twice", "revolute", &format!("<axis xyz=\"0 0 1\"/>{limit}<axis xyz=\"0 0 1\"/>"), &["agree"]),
        ],
        Path::new("."),
    );
    let free = robot_with_joint("revolute", "<limit lower=\"1\" upper=\"-1\"/>");
    assert_eq!(tree(&free).joints[0].position_limits, None);
    let limited = robot_with_joint("revolute", "<limit lower=\"-1e16\" upper=\"1e16\" effort=\"1e300\"/>");
    assert_eq!(
        (tree(&limited).joints[0].position_limits, tree(&limited).joints[0].effort_limit),
        (None, f64::INFINITY)
    );
}

#[test]
fn odd_texts_are_read() {
    let sound = robot(&link("a"));
    let shape = "<collision>\n<geometry><cdf filename=\"a.cdf\"/></geometry></collision>";
    check_doubts(
        vec![
            Case::new("late declaration", format!("\n\n<?xml version=\"1.0\"?>\n{sound}"), &["bad.urdf:1:1", "blanks"]),
            Case::new("no UTF-8", sound.replace("<link", "<!-- p\u{fffd}lm --><link"), &["bad.urdf:2:7", "not UTF-8"]),
            Case::new(
                "others' shape",
                robot(&format!("<link name=\"a\">{shape}</link>")),
                &["bad.urdf:3:", "<cdf>", "not felt"],
            ),
            Case::new(
                "four scales",
                robot(&format!(
                    "<link name=\"a\">{SOUND_INERTIAL}<visual>\n<geometry><mesh filename=\"{}\" scale=\"1 1 1 1\"/></geometry></visual></link>",
                    triangle()
                )),
                &["bad.urdf:3:", "more than 3 numbers", "the first three"],
            ),
        ],
        Path::new("."),
    );
    let late = format!("\u{feff}\n\n<?xml version=\"1.0\"?>\n{}", robot("<lnik/>"));
    let errors = parse_urdf(&late, Path::new("f"), Path::new("."), &SearchPaths::default()).expect_err("misspelt");
    assert!(errors.to_string().contains("f:5:1: robot: unknown tag <lnik>"), "{errors}");
}

fn triangle() -> String {
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("doubts.obj");
    std::fs::write(&file, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2\n").expect("the mesh can be written");
    file.display().to_string()
}

#[test]
fn xacro_is_told_once_with_the_way_to_a_urdf() {
    let source = "<robot name=\"r\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\"><xacro:arg name=\"a\"/><link name=\"${a}\"/></robot>";
    let substituted = robot("<link name=\"a\"/><joint name=\"${prefix}_j\" type=\"fixed\"/>");
    let expanded =
        "<robot name=\"r\" xmlns:xacro=\"u\"><!-- ${a} --><gazebo reference=\"${b}\"/><link name=\"a\"/></robot>";
    let load = |text: &str, file: &str| parse_urdf(text, Path::new(file), Path::new("."), &SearchPaths::default());
    for (text, found) in [(source, "<xacro:arg>"), (&substituted, "name=\"${prefix}_j\"")] {
        let errors = load(text, "arm.urdf.xacro").expect_err("it is no URDF yet");
        let said = errors.to_string();
        assert_eq!(errors.iter().count(), 1, "{said}");
        assert!(said.contains(found) && said.contains("`xacro arm.urdf.xacro > arm.urdf`"), "{said}");
    }
    assert!(load(expanded, "arm.urdf").is_ok(), "comments and vendors' tags mean nothing");
}

#[test]
fn warnings_come_in_the_order_of_the_file_and_always_the_same() {
    let text = robot(
        &[
            &joint("elbow", "a", "tip"),
            "\n<link name=\"tip\"/>\n",
            &body("a", "0", r#"ixx="1" iyy="1" izz="1""#),
            "\n",
            "<link name=\"b\"><visual><geometry><plane/></geometry></visual></link>\n",
            &fixed("f", "a", "b").replace("</joint>", "<mimic joint=\"x\"/></joint>"),
        ]
        .concat(),
    );
    let load = || parse_urdf(&text, Path::new("odd.urdf"), Path::new("."), &SearchPaths::default()).expect("it loads");
    let (first, again) = (load(), load());
    let lines: Vec<usize> = first.warnings.iter().filter_map(|w| w.place.map(|p| p.line)).collect();
    assert_eq!(lines, [2, 5, 6, 7], "{}", first.warnings);
    assert_eq!(first.warnings, again.warnings);
    assert_eq!(format!("{:?}", first.robot), format!("{:?}", again.robot));
}
