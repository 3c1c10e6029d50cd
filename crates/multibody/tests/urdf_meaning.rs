//! What a URDF says is what the description holds: frames, tensors, mimics, limits, colours, meshes.

use multibody::{Geometry, JointKind, Mesh, RobotDescription, SearchPaths, load_mesh, parse_urdf};
use spatial::{Mat3, Vec3, rotation_about};
use std::f64::consts::FRAC_PI_2;
use std::path::{Path, PathBuf};

// Round-off of a few products of numbers near one.
const ROUND_OFF: f64 = 2e-15;
const UNIT_INERTIAL: &str = r#"<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>"#;

fn load(text: &str) -> RobotDescription {
    parse_urdf(text, Path::new("good.urdf"), Path::new("."), &SearchPaths::default())
        .unwrap_or_else(|errors| panic!("must load:\n{errors}"))
        .robot
}

/// Links `a`, `b`, `c`, … in a chain; of each joint its attributes and what is inside it.
fn chain(attributes: &str, joints: &[(&str, &str)]) -> RobotDescription {
    let names: Vec<char> = ('a'..='z').take(joints.len() + 1).collect();
    let links = names.iter().map(|n| format!("<link name=\"{n}\">{UNIT_INERTIAL}</link>"));
    let joints = joints.iter().zip(names.windows(2)).map(|((attributes, inside), pair)| {
        let (parent, child) = (pair[0], pair[1]);
        format!("<joint {attributes}><parent link=\"{parent}\"/><child link=\"{child}\"/>{inside}</joint>")
    });
    let tags: String = links.chain(joints).collect();
    load(&format!("<robot name=\"chain\" {attributes}>{tags}</robot>"))
}

#[test]
fn inertia_is_turned_from_the_inertial_frame_into_the_links_axes() {
    let robot = load(
        r#"<robot name="r"><link name="a"><inertial><origin xyz="1 2 3" rpy="0 0 1.5707963267948966"/>
        <mass value="2"/><inertia ixx="0.4" ixy="0.01" iyy="0.5" izz="0.6"/></inertial></link></robot>"#,
    );
    let inertial = robot.links[0].inertial.expect("it has mass");
    // A quarter turn about z: x of the inertial frame is y of the link.
    let expected = Mat3::new(0.5, -0.01, 0.0, -0.01, 0.4, 0.0, 0.0, 0.0, 0.6);
    assert!((inertial.tensor_com - expected).norm() < ROUND_OFF, "{}", inertial.tensor_com);
    assert_eq!(inertial.com, Vec3::new(1.0, 2.0, 3.0));
}

#[test]
fn roll_pitch_yaw_turn_about_fixed_axes_in_that_order() {
    let robot = chain("", &[(r#"name="j" type="fixed""#, r#"<origin rpy="0.3 -0.7 1.1" xyz="1 0 0"/>"#)]);
    let expected = rotation_about(&Vec3::z(), 1.1) * rotation_about(&Vec3::y(), -0.7) * rotation_about(&Vec3::x(), 0.3);
    let found = robot.joints[0].pose_pj.rotation.to_rotation_matrix().into_inner();
    assert!((found - expected).norm() < ROUND_OFF, "{found}");
}

#[test]
fn quaternions_of_version_1_1_are_read() {
    let joint = (r#"name="j" type="fixed""#, r#"<origin quat_xyzw="0 0 1 1"/>"#);
    let robot = chain("version=\"1.1\"", &[joint]);
    let turned = robot.joints[0].pose_pj.rotation * Vec3::x();
    assert!((turned - Vec3::y()).norm() < ROUND_OFF, "{turned}");
}

#[test]
fn chains_of_mimics_lead_to_the_one_that_is_driven() {
    let limit = r#"<limit lower="-1" upper="1"/>"#;
    let follows =
        |leader: &str, m: f64, o: f64| format!("{limit}<mimic joint=\"{leader}\" multiplier=\"{m}\" offset=\"{o}\"/>");
    let robot = chain(
        "",
        &[
            (r#"name="j" type="revolute""#, &follows("k", 2.0, 0.5)),
            (r#"name="k" type="revolute""#, &follows("l", -3.0, 0.25)),
            (r#"name="l" type="revolute""#, limit),
        ],
    );
    // q_j = 2 q_k + 0.5,  q_k = −3 q_l + 0.25.
    let mimic = robot.joints[0].mimic.expect("j follows");
    assert_eq!((mimic.joint, mimic.multiplier, mimic.offset), (2, -6.0, 1.0));
    assert_eq!(robot.joints[1].mimic.map(|m| m.joint), Some(2));
    assert_eq!(robot.joints[2].mimic, None);
}

#[test]
fn limits_that_are_not_given_are_none() {
    let robot = chain(
        "",
        &[
            (r#"name="j" type="continuous""#, r#"<axis xyz="0 3 4"/>"#),
            (r#"name="k" type="prismatic""#, r#"<limit upper="0.04"/><dynamics damping="2" friction="0.5"/>"#),
            (r#"name="l" type="floating""#, ""),
            (r#"name="m" type="planar""#, r#"<axis xyz="0 0 1"/><limit lower="0" upper="0" effort="3" velocity="4"/>"#),
        ],
    );
    let [j, k, l, m] = &robot.joints[..] else { panic!("four joints") };
    assert_eq!((j.kind, j.position_limits, j.effort_limit), (JointKind::Revolute, None, f64::INFINITY));
    assert!((j.axis - Vec3::new(0.0, 0.6, 0.8)).norm() < ROUND_OFF);
    assert_eq!((k.position_limits, k.velocity_limit), (Some([0.0, 0.04]), f64::INFINITY));
    assert_eq!((k.damping, k.friction, k.axis), (2.0, 0.5, Vec3::x()));
    assert_eq!((l.kind, l.position_limits), (JointKind::Floating, None));
    assert_eq!((m.kind, m.position_limits, m.effort_limit), (JointKind::Planar, None, 3.0));
}

#[test]
fn vendors_tags_pass_declared_or_not() {
    let robot = load(
        r#"<robot name="r"><transmission name="t"><joint name="x"/></transmission><gazebo reference="a"/>
        <link name="a"><contact><lateral_friction value="1"/></contact><drake:thing><mass/></drake:thing>
        <collision><geometry><drake:ellipsoid a="1"/><capsule radius="0.1" length="0.5"/></geometry>
        <drake:proximity_properties/><material name="m"/></collision></link></robot>"#,
    );
    let collision = &robot.links[0].collisions[0];
    assert_eq!(collision.name, "a");
    assert!(matches!(collision.geometry, Geometry::Capsule { radius, length } if (radius, length) == (0.1, 0.5)));
}

#[test]
fn columns_are_those_of_the_file_though_prefixes_are_undeclared() {
    let text = r#"<robot name="r"><drake:x/><lnik/></robot>"#;
    let errors = parse_urdf(text, Path::new("f"), Path::new("."), &SearchPaths::default()).expect_err("misspelt");
    assert!(errors.to_string().contains("f:1:27: robot: unknown tag <lnik>"), "{errors}");
}

#[test]
fn named_colours_are_found_wherever_they_are_defined() {
    let visual = |material: &str| format!("<visual><geometry><sphere radius=\"1\"/></geometry>{material}</visual>");
    let red = r#"<material name="red"><color rgba="1 0 0 1"/></material>"#;
    let (here, named) = (visual(red), visual(r#"<material name="red"/>"#));
    let (blue, plain) = (visual(r#"<material name="blue"/>"#), visual(""));
    let robot = load(&format!(
        "<robot name=\"r\"><link name=\"a\">{named}{here}{blue}{plain}</link>{}</robot>",
        red.replace("red", "blue").replace("1 0 0", "0 0 1")
    ));
    let colours: Vec<_> = robot.links[0].visuals.iter().map(|v| v.rgba).collect();
    let (red, blue) = (Some([1.0, 0.0, 0.0, 1.0]), Some([0.0, 0.0, 1.0, 1.0]));
    assert_eq!(colours, [red, red, blue, None]);
    assert_eq!(robot.links[0].visuals[2].name, "a_visual_2");
}

fn write(name: &str, content: &str) -> PathBuf {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join("urdf_meaning");
    std::fs::create_dir_all(&dir).expect("a temporary directory can be made");
    std::fs::write(dir.join(name), content).expect("the mesh can be written");
    dir.join(name)
}

/// Six times the volume that the triangles enclose, m³: positive if they are counter-clockwise from outside.
fn six_volumes(mesh: &Mesh) -> f64 {
    let at = |i: u32| Vec3::from(mesh.vertices[i as usize]);
    mesh.triangles.iter().map(|[a, b, c]| at(*a).dot(&at(*b).cross(&at(*c)))).sum()
}

const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1/1 2/1 4/1\nf 1//1 4//1 3//1\nf -3 -2 -1\n";

#[test]
fn a_mirroring_scale_keeps_the_outside_outside() {
    let file = write("tetrahedron.obj", TETRAHEDRON);
    for (scale, volume) in [([1.0; 3], 1.0), ([-2.0, 1.0, 1.0], 2.0), ([-1.0, -1.0, 3.0], 3.0), ([-1.0; 3], 1.0)] {
        let mesh = load_mesh(&file, scale).expect("it is sound");
        assert!((six_volumes(&mesh) - volume).abs() < ROUND_OFF, "scale {scale:?}");
    }
}

/// The tetrahedron in COLLADA, 1 unit = 1 cm, with this up axis and node transform; its faces in all forms but one.
fn tetrahedron_dae(up: &str, transform: &str) -> String {
    let input =
        r##"<input semantic="NORMAL" source="#none" offset="1"/><input semantic="VERTEX" source="#v" offset="0"/>"##;
    format!(
        r##"<COLLADA xmlns="x" version="1.4.1"><asset><unit meter="0.01"/><up_axis>{up}</up_axis></asset>
        <library_effects><effect id="e"><profile_COMMON><technique><lambert><diffuse><color>0.1 0.2 0.3 1</color>
        </diffuse></lambert></technique></profile_COMMON></effect></library_effects>
        <library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
        <library_geometries><geometry id="g"><mesh>
        <source id="s"><float_array id="f">0 0 0 1 0 0 0 1 0 0 0 1</float_array></source>
        <vertices id="v"><input semantic="POSITION" source="#s"/></vertices>
        <triangles material="sym">{input}<p>0 9 2 9 1 9</p></triangles>
        <polylist material="sym">{input}<vcount>3</vcount><p>0 9 1 9 3 9</p></polylist>
        <polygons material="sym">{input}<p>0 9 3 9 2 9</p></polygons>
        <tristrips>{input}<p>1 9 2 9 3 9</p></tristrips><lines><p>0 1</p></lines>
        </mesh></geometry></library_geometries>
        <library_visual_scenes><visual_scene id="w"><node>{transform}<node><instance_geometry url="#g"><bind_material>
        <technique_common><instance_material symbol="sym" target="#m"/></technique_common></bind_material>
        </instance_geometry></node></node></visual_scene></library_visual_scenes>
        <scene><instance_visual_scene url="#w"/></scene></COLLADA>"##
    )
}

#[test]
fn collada_is_placed_in_metres_with_z_up_and_coloured() {
    let mesh = load_mesh(&write("z.dae", &tetrahedron_dae("Z_UP", "")), [1.0; 3]).expect("it is sound");
    assert_eq!(mesh.triangles.len(), 4);
    assert!((six_volumes(&mesh) - 1e-6).abs() < 1e-6 * ROUND_OFF);
    assert_eq!(mesh.vertex_rgba.len(), mesh.vertices.len());
    assert_eq!(mesh.vertex_rgba[0], [0.1, 0.2, 0.3, 1.0]);
    assert_eq!(mesh.vertex_rgba[mesh.vertices.len() - 1], [0.8, 0.8, 0.8, 1.0], "the part without material");
}

#[test]
fn collada_up_axes_turn_up_to_z() {
    // Where the file's up unit vector goes, and its right one: x stays right for Y_UP, −y is right for X_UP.
    for (up, file_up, file_right) in
        [("Y_UP", 2, [1.0, 0.0, 0.0]), ("X_UP", 1, [0.0, -1.0, 0.0]), ("Z_UP", 3, [1.0, 0.0, 0.0])]
    {
        let mesh = load_mesh(&write(&format!("{up}.dae"), &tetrahedron_dae(up, "")), [100.0; 3]).expect("it is sound");
        // The vertices in the order of first use: 0, 2, 1, then again per primitive.
        let corner = |file_index: usize| {
            let used = [0, 2, 1].iter().position(|i| *i == file_index);
            used.map_or_else(|| Vec3::from(mesh.vertices[5]), |i| Vec3::from(mesh.vertices[i]))
        };
        assert!((corner(file_up) - Vec3::z()).norm() < ROUND_OFF, "{up}: {:?}", mesh.vertices);
        let right = corner(1) * file_right[0] + corner(2) * file_right[1];
        assert!((right - Vec3::x()).norm() < ROUND_OFF, "{up}: {:?}", mesh.vertices);
    }
}

#[test]
fn collada_transforms_apply_in_their_order() {
    let transform = "<translate>1 0 0</translate><rotate>0 0 1 90</rotate><scale>2 2 -2</scale>";
    let mesh = load_mesh(&write("t.dae", &tetrahedron_dae("Z_UP", transform)), [100.0; 3]).expect("it is sound");
    // The file's (1, 0, 0) is scaled to 2, turned to y, and moved by x; the third vertex used.
    let placed = rotation_about(&Vec3::z(), FRAC_PI_2) * Vec3::new(2.0, 0.0, 0.0) + Vec3::x();
    assert!((Vec3::from(mesh.vertices[2]) - placed).norm() < ROUND_OFF, "{:?}", mesh.vertices);
    let origin = Vec3::from(mesh.vertices[0]);
    let volume: f64 = mesh
        .triangles
        .iter()
        .map(|t| t.map(|i| Vec3::from(mesh.vertices[i as usize]) - origin))
        .map(|[a, b, c]| a.dot(&b.cross(&c)))
        .sum();
    assert!((volume - 8.0).abs() < 8.0 * ROUND_OFF, "mirrored by the scale, but turned back: {volume}");
}
