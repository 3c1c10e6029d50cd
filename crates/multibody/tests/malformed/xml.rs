//! Broken XML and broken URDF: each is told with file, line, column and subject.

use crate::table::{Case, check, joint, link, robot, robot_with_inertial, robot_with_joint};
use std::path::Path;

#[test]
fn broken_xml_is_told_with_its_place() {
    let nested = format!("<robot name=\"deep\"><link name=\"a\">{}</link></robot>", "<x>".repeat(200_000));
    let laughs = "<!DOCTYPE r [<!ENTITY a \"ha\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">]>\n<robot name=\"&b;\"/>";
    let many_attributes = (0..200_000).map(|i| format!(" a{i}=\"\"")).collect::<String>();
    let many_namespaces = (0..5_000).map(|i| format!(" xmlns:n{i}=\"u{i}\"")).collect::<String>();
    check(
        vec![
            Case::new("nothing", "", &["bad.urdf:1:1", "URDF", "no tag at all"]),
            Case::new("no XML", "link palm mass 3", &["bad.urdf:1:1", "not well-formed XML"]),
            Case::new("unclosed tag", "<robot name=\"r\">\n<link name=\"a\">\n", &["bad.urdf:2:16", "ends before"]),
            Case::new("crossed tags", "<robot name=\"r\">\n<link name=\"a\"></robot></link>", &["bad.urdf:2", "XML"]),
            Case::new("unquoted attribute", "<robot name=\"r\">\n<link name=a/></robot>", &["bad.urdf:2:12", "XML"]),
            Case::new("attribute twice", "<robot name=\"r\"\n name=\"s\"/>", &["bad.urdf:2:2", "name"]),
            Case::new("unknown entity", "<robot name=\"&amor;\"/>", &["bad.urdf:1", "amor"]),
            Case::new("stray control character", "<robot name=\"r\">\n\u{1}</robot>", &["bad.urdf:2:1", "XML"]),
            Case::new("billion laughs", laughs, &["bad.urdf:1:1", "<!DOCTYPE"]),
            Case::new("nested without end", nested, &["bad.urdf:1:6000", "not well-formed XML"]),
            Case::new("crowd of attributes", format!("<robot{many_attributes}/>"), &["bad.urdf:1", "1000 attributes"]),
            Case::new("crowd of namespaces", format!("<robot{many_namespaces}/>"), &["bad.urdf:1", "namespaces"]),
            Case::new("two roots", "<robot name=\"r\"/>\n<robot name=\"s\"/>", &["bad.urdf:2:1", "XML"]),
            Case::new("another format", "\n<sdf version=\"1.6\"/>", &["bad.urdf:2:1", "<sdf>", "<robot>"]),
        ],
        Path::new("."),
    );
}

#[test]
fn deep_nesting_that_is_well_formed_does_not_overflow_the_stack() {
    let (open, close) = ("<x>".repeat(300_000), "</x>".repeat(300_000));
    let text = format!(
        "<robot name=\"deep\">{}<link name=\"a\"><visual>{open}{close}</visual></link></robot>",
        open.clone() + &close
    );
    check(vec![Case::new("deep", text, &["link \"a\"", "<visual> has no <geometry>"])], Path::new("."));
}

#[test]
fn tags_and_attributes_that_would_be_lost_in_silence_are_told() {
    let mass = r#"<mass value="1"/>"#;
    let tensor = r#"<inertia ixx="1" iyy="1" izz="1"/>"#;
    let sphere = r#"<geometry><sphere radius="1"/></geometry>"#;
    check(
        vec![
            Case::new(
                "misspelt inertial",
                robot("<link name=\"palm\">\n  <inertail><mass value=\"1\"/></inertail></link>"),
                &["bad.urdf:3:3", "link \"palm\"", "<inertail>", "<inertial>"],
            ),
            Case::new("misspelt link", robot("<lnik name=\"a\"/>"), &["bad.urdf:2:1", "<lnik>", "<link>"]),
            Case::new(
                "mass outside inertial",
                robot(&format!("<link name=\"palm\">{mass}</link>")),
                &["bad.urdf:2", "link \"palm\"", "<mass>", "move it into <inertial>"],
            ),
            Case::new(
                "misspelt attribute",
                robot_with_inertial(&format!("<inertial><origin xzy=\"0 0 1\"/>{mass}{tensor}</inertial>")),
                &["bad.urdf:3:19", "link \"palm\"", "xzy", "xyz"],
            ),
            Case::new(
                "missing attribute",
                robot_with_inertial(&format!("<inertial><mass/>{tensor}</inertial>")),
                &["bad.urdf:3:11", "link \"palm\"", "<mass> has no attribute value"],
            ),
            Case::new(
                "no mass tag",
                robot_with_inertial(&format!("<inertial>{tensor}</inertial>")),
                &["bad.urdf:3", "link \"palm\"", "<inertial> has no <mass>"],
            ),
            Case::new(
                "mass twice",
                robot_with_inertial(&format!("<inertial>{mass}{mass}{tensor}</inertial>")),
                &["bad.urdf:3:28", "link \"palm\"", "more than one <mass>"],
            ),
            Case::new(
                "nan",
                robot_with_inertial(&format!("<inertial><mass value=\"nan\"/>{tensor}</inertial>")),
                &["bad.urdf:3:17", "link \"palm\"", "\"nan\" is not a finite number"],
            ),
            Case::new(
                "vector with a word",
                robot_with_joint("revolute", r#"<origin xyz="0 0 zz 5"/><limit lower="0" upper="1"/>"#),
                &["bad.urdf:4:9", "joint \"elbow\"", "\"zz\""],
            ),
            Case::new(
                "vector of two",
                robot_with_joint("fixed", r#"<origin xyz="0 0"/>"#),
                &["bad.urdf:4:9", "joint \"elbow\"", "2 numbers instead of 3"],
            ),
            Case::new(
                "xacro",
                "<robot name=\"r\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\">\n<xacro:arm/><link name=\"a\"/></robot>",
                &["bad.urdf:2:1", "xacro", "expand"],
            ),
            Case::new(
                "no shape",
                robot("<link name=\"palm\"><visual><geometry></geometry></visual></link>"),
                &["bad.urdf:2", "link \"palm\"", "holds no shape"],
            ),
            Case::new(
                "two shapes",
                robot(&format!(
                    "<link name=\"p\"><visual>{}</visual></link>",
                    sphere.replace("/></", "/><box size=\"1 1 1\"/></")
                )),
                &["bad.urdf:2", "link \"p\"", "several shapes"],
            ),
            Case::new(
                "unknown joint type",
                robot_with_joint("revolut", ""),
                &["joint \"elbow\"", "\"revolut\"", "revolute"],
            ),
            Case::new("nameless link", robot("<link/>"), &["bad.urdf:2:1", "<link> has no attribute name"]),
            Case::new("no links", "<robot name=\"r\"></robot>", &["bad.urdf:1:1", "has no links"]),
        ],
        Path::new("."),
    );
}

#[test]
fn joints_that_form_no_tree_are_told() {
    let (a, b, c) = (link("a"), link("b"), link("c"));
    check(
        vec![
            Case::new("link twice", robot(&format!("{a}\n{a}")), &["bad.urdf:3:1", "link \"a\"", "twice", "line 2"]),
            Case::new(
                "joint twice",
                robot(
                    &[a.clone(), b.clone(), c.clone(), joint("j", "a", "b"), "\n".into(), joint("j", "b", "c")]
                        .concat(),
                ),
                &["bad.urdf:3:1", "joint \"j\"", "twice", "line 2"],
            ),
            Case::new(
                "unknown link",
                robot(&format!("{a}{}\n{}", link("gripper_palm"), joint("j", "a", "gripper_plam"))),
                &["bad.urdf:3", "joint \"j\"", "child link \"gripper_plam\"", "did you mean \"gripper_palm\"?"],
            ),
            Case::new(
                "two parents",
                robot(&format!("{a}{b}{c}{}{}\n{}", joint("j", "a", "b"), joint("k", "a", "c"), joint("l", "c", "b"))),
                &["bad.urdf:3", "link \"b\"", "two parents", "\"j\" (line 2)", "\"l\""],
            ),
            Case::new(
                "two trees",
                robot(&format!("{a}\n{b}")),
                &["bad.urdf:3:1", "link \"b\"", "\"a\" (line 2)", "two trees"],
            ),
            Case::new(
                "to itself",
                robot(&format!("{a}\n{}", joint("j", "a", "a"))),
                &["bad.urdf:3", "joint \"j\"", "itself"],
            ),
            Case::new(
                "only a cycle",
                robot(&format!("{a}{b}{}{}", joint("j", "a", "b"), joint("k", "b", "a"))),
                &["bad.urdf:2", "no root", "cycle"],
            ),
            Case::new(
                "a cycle beside the tree",
                robot(&format!("{a}\n{b}{c}{}{}", joint("j", "b", "c"), joint("k", "c", "b"))),
                &["bad.urdf:3", "link \"b\"", "not reachable", "b → c → b"],
            ),
        ],
        Path::new("."),
    );
}

#[test]
fn everything_wrong_is_told_at_once_and_in_the_order_of_the_file() {
    let text = robot(&format!("{}\n<link name=\"b\"><visaul/></link>\n{}\n<lnik/>", link("a"), joint("j", "a", "x")));
    let errors = multibody::parse_urdf(&text, Path::new("bad.urdf"), Path::new("."), &Default::default())
        .expect_err("it is broken three times");
    let lines: Vec<usize> = errors.iter().filter_map(|e| e.place.map(|p| p.line)).collect();
    assert_eq!(lines, [3, 4, 5], "{errors}");
}

#[test]
fn a_thousand_errors_are_cut_to_a_hundred() {
    let links: String = (0..1000).map(|i| format!("<link name=\"l{i}\"><visaul/></link>")).collect();
    let errors = multibody::parse_urdf(&robot(&links), Path::new("bad.urdf"), Path::new("."), &Default::default())
        .expect_err("it is broken a thousand times");
    assert_eq!(errors.iter().count(), 100);
    assert!(errors.to_string().ends_with("more"), "{errors}");
}
