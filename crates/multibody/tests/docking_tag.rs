//! `<softdock_shape>`: what it says, what is wrong with it, and that other geometry stays as it was.
#![allow(clippy::unwrap_used)]

use multibody::{DockingGeometry, Geometry, SearchPaths, parse_urdf};
use std::path::Path;

/// A port whose collisions hold these tags, each in a line of its own from line 3 on.
fn port(tags: &[&str]) -> String {
    let collision =
        |tag: &&str| format!("<collision><geometry><sphere radius=\"0.001\"/></geometry>{tag}</collision>\n");
    let collisions: String = tags.iter().map(collision).collect();
    format!(
        "<robot name=\"r\"><link name=\"base\"/><joint name=\"j\" type=\"fixed\"><parent link=\"base\"/><child link=\"port\"/></joint>\n<link name=\"port\">\n{collisions}</link></robot>"
    )
}

fn said(tag: &str) -> String {
    let result = parse_urdf(&port(&["", tag]), Path::new("port.urdf"), Path::new("."), &SearchPaths::default());
    result.map_or_else(|e| e.to_string(), |_| "it loads".to_owned())
}

#[test]
fn docking_shapes_stand_in_for_the_geometry_of_their_collision() {
    let text = port(&[
        "<softdock_shape><inner_cone half_angle=\"0.7\" depth=\"0.14\" throat_radius=\"0.02\" wall=\"0.012\"/></softdock_shape>",
        "",
        "<softdock_shape>\n<inner_cylinder radius=\"0.05\" depth=\"0.1\" floor=\"true\"/></softdock_shape>",
        "<softdock_shape><ring major_radius=\"0.6\" minor_radius=\"0.02\"/></softdock_shape>",
        "<softdock_shape><petal base_radius=\"0.2\" tip_radius=\"0.08\" height=\"0.12\" half_sector=\"0.6\" thickness=\"0.012\"/></softdock_shape>",
    ]);
    let robot = parse_urdf(&text, Path::new("port.urdf"), Path::new("."), &SearchPaths::default()).unwrap().robot;
    let found: Vec<&Geometry> = robot.links[1].collisions.iter().map(|c| &c.geometry).collect();
    let docking = |i: usize| match found[i] {
        Geometry::Docking(docking) => *docking,
        other => panic!("{other:?}"),
    };
    assert_eq!(
        docking(0),
        DockingGeometry::InnerCone { half_angle: 0.7, depth: 0.14, throat_radius: 0.02, wall: 0.012 }
    );
    assert!(matches!(found[1], Geometry::Sphere { radius: 0.001 }));
    assert_eq!(docking(2), DockingGeometry::InnerCylinder { radius: 0.05, depth: 0.1, wall: 0.01, floor: true });
    assert_eq!(docking(3), DockingGeometry::Ring { major_radius: 0.6, minor_radius: 0.02 });
    let petal =
        DockingGeometry::Petal { base_radius: 0.2, tip_radius: 0.08, height: 0.12, half_sector: 0.6, thickness: 0.012 };
    assert_eq!(docking(4), petal);
}

#[test]
fn slips_are_told_with_their_place_and_a_way_out() {
    let cone = |attributes: &str| format!("<softdock_shape><inner_cone {attributes}/></softdock_shape>");
    for (tag, fragments) in [
        (
            "<softdock_shap><ring/></softdock_shap>".to_owned(),
            ["port.urdf:4:", "link \"port\"", "did you mean <softdock_shape>?"].as_slice(),
        ),
        (
            "<softdock_shape><inner_kone/></softdock_shape>".into(),
            &["port.urdf:4:", "<inner_kone> in <softdock_shape>; did you mean <inner_cone>?"],
        ),
        ("<softdock_shape/>".into(), &["port.urdf:4:", "<softdock_shape> holds no shape; put one of <inner_cone>"]),
        (
            "<softdock_shape><ring major_radius=\"1\" minor_radius=\"0.1\"/><petal/></softdock_shape>".into(),
            &["holds several shapes"],
        ),
        (
            "<inner_cone half_angle=\"0.7\" depth=\"1\"/>".into(),
            &["<inner_cone> does not belong in <collision>; move it into <softdock_shape>"],
        ),
        (cone("half_angle=\"0.7\""), &["port.urdf:4:", "<inner_cone> has no attribute depth; add depth=\"1.0\""]),
        (cone("half_angel=\"0.7\" depth=\"1\""), &["has no attribute half_angel; did you mean half_angle?"]),
        (
            cone("half_angle=\"45\" depth=\"1\""),
            &["inner_cone half_angle \"45\" is not between 0 and π/2; give an angle in rad"],
        ),
        (cone("half_angle=\"0.7\" depth=\"-1\""), &["inner_cone depth \"-1\" is not positive"]),
        (
            "<softdock_shape><inner_cylinder radius=\"1\" depth=\"1\" floor=\"yes\"/></softdock_shape>".into(),
            &["floor \"yes\" is neither true nor false"],
        ),
    ] {
        let said = said(&tag);
        assert!(fragments.iter().all(|f| said.contains(f)), "{fragments:?} not in:\n{said}");
    }
}
