//! URDF that is sound XML but no possible mechanism.

use crate::table::{Case, SOUND_INERTIAL, check, joint, link, robot, robot_with_inertial, robot_with_joint};
use multibody::{SearchPaths, parse_urdf};
use std::path::Path;

fn inertial(mass: &str, tensor: &str) -> String {
    robot_with_inertial(&format!("<inertial><mass value=\"{mass}\"/><inertia {tensor}/></inertial>"))
}

fn shape(geometry: &str) -> String {
    robot(&format!("<link name=\"palm\"><collision>\n<geometry>{geometry}</geometry></collision></link>"))
}

#[test]
fn impossible_bodies_are_told() {
    let palm = &["bad.urdf:3:1", "link \"palm\"", "check units in bad.urdf"];
    let with = |fault: &str| palm.iter().copied().chain([fault]).map(str::to_owned).collect::<Vec<_>>();
    let case = |name, text, fault| Case { name, text, expected: with(fault) };
    check(
        vec![
            case("negative mass", inertial("-1", r#"ixx="1" iyy="1" izz="1""#), "mass -1 kg is not positive"),
            case(
                "triangle inequality",
                inertial("1", r#"ixx="0.10" iyy="0.10" izz="0.31""#),
                "inertia violates Ixx + Iyy ≥ Izz (0.1 + 0.1 < 0.31)",
            ),
            case(
                "triangle inequality, turned",
                inertial("1", r#"ixx="0.2" ixy="0.105" iyy="0.2" izz="0.08""#),
                "I1 + I2 ≥ I3",
            ),
            case("negative moment", inertial("1", r#"ixx="-0.1" iyy="0.1" izz="0.1""#), "not positive definite"),
            case(
                "products larger than moments",
                inertial("1", r#"ixx="1" ixy="2" iyy="1" izz="1""#),
                "not positive definite",
            ),
            case("mass without inertia", inertial("3", r#"ixx="0" iyy="0" izz="0""#), "not positive definite"),
        ],
        Path::new("."),
    );
}

#[test]
fn joints_that_move_nothing_are_told() {
    let tip_without_mass = robot(&format!("{}<link name=\"tip\"/>\n{}", link("base"), joint("elbow", "base", "tip")));
    let far_mass = robot(&format!(
        "{}<link name=\"mid\"/>{}\n{}{}",
        link("base"),
        link("tip"),
        joint("elbow", "base", "mid"),
        joint("wrist", "mid", "tip"),
    ));
    let ghost = SOUND_INERTIAL.replace("value=\"1\"", "value=\"0\"");
    let mass_forgotten =
        robot(&format!("{}\n<link name=\"tip\">{ghost}</link>{}", link("base"), joint("elbow", "base", "tip")));
    check(
        vec![
            Case::new(
                "massless tip",
                tip_without_mass,
                &["bad.urdf:3:1", "joint \"elbow\"", "link \"tip\"", "no mass"],
            ),
            Case::new("massless between", far_mass, &["bad.urdf:3:1", "joint \"elbow\"", "link \"mid\"", "no mass"]),
            Case::new("inertia without mass", mass_forgotten, &["bad.urdf:3", "link \"tip\"", "an inertia but mass 0"]),
        ],
        Path::new("."),
    );
}

#[test]
fn impossible_joints_are_told() {
    let limit = r#"<limit lower="-1" upper="1" effort="1" velocity="1"/>"#;
    let elbow = |name, kind, inside: &str, fault| {
        Case::new(name, robot_with_joint(kind, inside), &["bad.urdf:", "joint \"elbow\"", fault])
    };
    let follows = |j: String, leader: &str| j.replace("</joint>", &format!("<mimic joint=\"{leader}\"/></joint>"));
    let (j, k) = (follows(joint("j", "a", "b"), "k"), follows(joint("k", "b", "c"), "j"));
    let circle = robot(&[link("a"), link("b"), link("c"), j, k].concat());
    check(
        vec![
            elbow("zero axis", "revolute", &format!("<axis xyz=\"0 0 0\"/>{limit}"), "no direction"),
            elbow("no limit", "revolute", "", "a revolute joint needs a <limit>"),
            elbow("no limit, sliding", "prismatic", "", "a prismatic joint needs a <limit>"),
            elbow("empty limit", "revolute", "<limit effort=\"1\" velocity=\"1\"/>", "neither lower nor upper"),
            elbow("crossed limits", "revolute", "<limit lower=\"1\" upper=\"-1\"/>", "lower 1 is above upper -1"),
            elbow("negative effort", "revolute", "<limit lower=\"0\" upper=\"1\" effort=\"-3\"/>", "effort \"-3\""),
            elbow("negative damping", "revolute", &format!("{limit}<dynamics damping=\"-0.1\"/>"), "damping \"-0.1\""),
            elbow("infinite place", "fixed", "<origin xyz=\"0 0 1e999\"/>", "\"1e999\" is not a finite number"),
            elbow("absurd place", "fixed", "<origin xyz=\"0 0 1e30\"/>", "beyond 1e15"),
            elbow(
                "follows nobody",
                "revolute",
                &format!("{limit}<mimic joint=\"elbwo\"/>"),
                "\"elbwo\", which does not exist",
            ),
            elbow("follows itself", "revolute", &format!("{limit}<mimic joint=\"elbow\"/>"), "elbow → elbow"),
            elbow("fixed and follows", "fixed", "<mimic joint=\"elbow\"/>", "a fixed joint"),
            Case::new("circle of mimics", circle, &["bad.urdf:2", "joint \"j\"", "j → k → j"]),
        ],
        Path::new("."),
    );
}

#[test]
fn impossible_shapes_are_told() {
    let palm = |name, geometry: &str, fault| {
        Case::new(name, shape(geometry), &["bad.urdf:3:", "link \"palm\"", fault, "is not positive"])
    };
    check(
        vec![
            palm("negative radius", r#"<sphere radius="-0.1"/>"#, "sphere radius \"-0.1\""),
            palm("flat cylinder", r#"<cylinder radius="0.1" length="0"/>"#, "cylinder length \"0\""),
            palm("flat box", r#"<box size="1 0 1"/>"#, "box size \"1 0 1\" has an edge that"),
            palm("capsule without radius", r#"<capsule radius="0" length="1"/>"#, "capsule radius \"0\""),
        ],
        Path::new("."),
    );
}

#[test]
fn massless_links_are_legal_where_they_are_fixed() {
    let fixed = |name: &str, a: &str, b: &str| {
        format!("<joint name=\"{name}\" type=\"fixed\"><parent link=\"{a}\"/><child link=\"{b}\"/></joint>")
    };
    let text = robot(
        &[
            "<link name=\"tool\"/><link name=\"world\"/><link name=\"mount\"/>".to_owned(),
            link("arm"),
            fixed("a", "world", "mount"),
            joint("b", "mount", "arm"),
            fixed("c", "arm", "tool"),
        ]
        .concat(),
    );
    let robot = parse_urdf(&text, Path::new("good.urdf"), Path::new("."), &SearchPaths::default())
        .unwrap_or_else(|e| panic!("{e}"))
        .robot;
    let names: Vec<&str> = robot.links.iter().map(|l| l.name.as_str()).collect();
    assert_eq!(names, ["world", "mount", "arm", "tool"], "parents stand before children");
    assert!(!robot.root_has_mass());
}
