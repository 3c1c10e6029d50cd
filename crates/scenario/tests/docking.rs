//! Docking shapes of a scenario and of a URDF become the same contact shapes, and can be seen.
#![allow(clippy::unwrap_used)]

use contact::{Docking, Shape};
use scenario::{build, docking_visuals, parse, shape_of_geometry};
use std::path::Path;

const PORT: &str = r#"<robot name="port"><link name="port">
<inertial><mass value="10"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision name="socket"><geometry><sphere radius="0.001"/></geometry>
<softdock_shape><inner_cylinder radius="0.05" depth="0.1"/></softdock_shape></collision></link></robot>"#;

const SCENARIO: &str = r#"
name = "docking-shapes"
seed = 1
duration_s = 0.1
[environment]
kind = "lab"
[strategy]
kind = "none"
[contact_default]
enabled = false
[[vehicle]]
name = "client"
urdf = "port.urdf"
base = "free"
[[shape]]
name = "drogue"
on = "client/port"
kind = "inner-cone"
half_angle_deg = 45.0
depth_m = 0.14
[[shape]]
name = "bore"
kind = "inner-cylinder"
radius_m = 0.05
depth_m = 0.1
wall_m = 0.02
floor = true
[[shape]]
name = "ring"
kind = "ring"
major_radius_m = 0.6
minor_radius_m = 0.02
[[shape]]
name = "petal"
kind = "petal"
base_radius_m = 0.2
tip_radius_m = 0.08
height_m = 0.12
half_sector_deg = 30.0
thickness_m = 0.012
"#;

/// The scenario of this text, built in a folder of its own.
fn written(folder: &str, text: &str) -> Result<scenario::Mission, String> {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join(folder);
    std::fs::create_dir_all(&dir).unwrap();
    std::fs::write(dir.join("port.urdf"), PORT).unwrap();
    let file = dir.join("docking.toml").display().to_string();
    let scenario = parse(text, &file, &[]).map_err(|e| e.to_string())?;
    build(&scenario).map_err(|e| e.to_string())
}

#[test]
fn all_kinds_reach_the_scene_with_their_sizes() {
    let mission = written("sound", SCENARIO).unwrap_or_else(|said| panic!("{said}"));
    let shapes: Vec<&Shape> = mission.world.model().scene.colliders().iter().map(|c| &c.shape).collect();
    let is_close = |a: f64, b: f64| (a - b).abs() < 1e-15;
    assert_eq!(shapes.len(), 5);
    assert_eq!(
        *shapes[0],
        Shape::Docking(Docking::InnerCylinder { radius: 0.05, depth: 0.1, wall: 0.01, floor: false })
    );
    assert!(
        matches!(shapes[1], Shape::Docking(Docking::InnerCone { half_angle, depth: 0.14, throat_radius: 0.0, wall: 0.01 })
        if is_close(*half_angle, std::f64::consts::FRAC_PI_4))
    );
    assert_eq!(
        *shapes[2],
        Shape::Docking(Docking::InnerCylinder { radius: 0.05, depth: 0.1, wall: 0.02, floor: true })
    );
    assert_eq!(*shapes[3], Shape::Docking(Docking::Ring { major_radius: 0.6, minor_radius: 0.02 }));
    assert!(matches!(shapes[4], Shape::Docking(Docking::Petal { half_sector, .. })
        if is_close(*half_sector, std::f64::consts::FRAC_PI_6)));
    let visuals = docking_visuals(&mission.scenario);
    assert_eq!(visuals.iter().map(|(on, _)| *on).collect::<Vec<_>>(), ["client/port", "world", "world", "world"]);
    assert_eq!(shape_of_geometry(&visuals[2].1.geometry), *shapes[3]);
}

#[test]
fn sizes_out_of_range_and_unknown_keys_are_told_with_their_line() {
    for (from, to, fragments) in [
        ("half_angle_deg = 45.0", "half_angle_deg = 95.0", ["`shape.drogue.half_angle_deg` = 95", "less than 90"]),
        ("depth_m = 0.14", "depth_m = 0.14\nlenght_m = 1.0", ["lenght_m", "docking.toml:21"]),
        ("kind = \"inner-cone\"", "kind = \"inner-kone\"", ["inner-kone", "inner-cone"]),
    ] {
        let said = written("broken", &SCENARIO.replacen(from, to, 1)).err().unwrap_or_default();
        assert!(fragments.iter().all(|f| said.contains(f)), "{fragments:?} not in:\n{said}");
    }
}
