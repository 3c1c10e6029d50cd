//! Broken mesh files: each is told with the URDF's place, the link, and the mesh file with what is wrong in it. They are
//! errors where a collision asks for them; where only a visual does, or the file is not there, the robot loads without.

use crate::table::{Case, check, check_doubts, robot};
use std::path::{Path, PathBuf};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// Writes a mesh file, and gives a URDF that asks for it and what must be said of it.
fn case(dir: &Path, name: &'static str, file: &str, content: impl AsRef<[u8]>, faults: &[&str]) -> Case {
    std::fs::write(dir.join(file), content).expect("the mesh file can be written");
    let mut case = Case::new(name, asking_for(file, ""), faults);
    case.expected.extend(["bad.urdf:3:".into(), "link \"palm\"".into(), file.into()]);
    case
}

fn asking_for(file: &str, scale: &str) -> String {
    robot(&format!(
        "<link name=\"palm\"><collision>\n<geometry><mesh filename=\"{file}\" {scale}/></geometry></collision></link>"
    ))
}

fn directory(name: &str) -> PathBuf {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&dir).expect("a temporary directory can be made");
    dir
}

/// A binary STL with one triangle that promises `count`.
fn binary_stl(count: u32, corners: [[f32; 3]; 3]) -> Vec<u8> {
    let mut bytes = b"solid is what some binary files begin with".to_vec();
    bytes.resize(80, b' ');
    bytes.extend(count.to_le_bytes());
    bytes.extend([0; 12]);
    corners.iter().flatten().for_each(|x| bytes.extend(x.to_le_bytes()));
    bytes.extend([0; 2]);
    bytes
}

/// A COLLADA file with these primitives over three positions.
fn collada(primitives: &str, scene: &str) -> String {
    format!(
        r##"<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<library_geometries><geometry id="g"><mesh>
<source id="s"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array></source>
<vertices id="v"><input semantic="POSITION" source="#s"/></vertices>
{primitives}
</mesh></geometry></library_geometries>
{scene}
</COLLADA>"##
    )
}

fn triangles(p: &str) -> String {
    format!("<triangles count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>{p}</p></triangles>")
}

#[test]
fn broken_stl_is_told() {
    let d = &directory("broken_stl");
    let flat = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
    let facet =
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    check(
        vec![
            case(d, "empty", "empty.stl", "", &["0 bytes are too few"]),
            case(d, "truncated", "cut.stl", binary_stl(7, flat), &["promises 7 triangles in 434 bytes", "134"]),
            case(d, "no triangles", "none.stl", &binary_stl(0, flat)[..84], &["has no triangles"]),
            case(d, "needle", "needle.stl", binary_stl(1, flat), &["all its 1 triangles are without area"]),
            case(
                d,
                "nan",
                "nan.stl",
                binary_stl(1, [[f32::NAN, 0.0, 0.0], [1.0; 3], [2.0; 3]]),
                &["vertex 0", "finite"],
            ),
            case(d, "text cut off", "text.stl", facet, &["is broken", "EOF"]),
            case(d, "text with a word", "word.stl", facet.replace("1 0 0", "1 0 x"), &["is broken", "invalid float"]),
        ],
        d,
    );
}

#[test]
fn broken_obj_is_told_with_its_line() {
    let d = &directory("broken_obj");
    check(
        vec![
            case(
                d,
                "index too large",
                "large.obj",
                TRIANGLE.replace("1 2 3", "1 2 9"),
                &["line 4", "vertex 9", "3 vert"],
            ),
            case(d, "index zero", "zero.obj", TRIANGLE.replace("1 2 3", "0 1 2"), &["line 4", "vertex 0"]),
            case(
                d,
                "index before the first",
                "before.obj",
                TRIANGLE.replace("1 2 3", "-4 -1 -2"),
                &["line 4", "vertex -4"],
            ),
            case(d, "no index", "word.obj", TRIANGLE.replace("1 2 3", "a b c"), &["line 4", "\"a\" is not a vertex"]),
            case(
                d,
                "nan",
                "nan.obj",
                TRIANGLE.replace("1 0 0", "nan 0 0"),
                &["line 2", "\"nan\" is not a finite number"],
            ),
            case(
                d,
                "two coordinates",
                "flat.obj",
                TRIANGLE.replace("0 1 0", "0 1"),
                &["line 3", "2 numbers instead of 3"],
            ),
            case(d, "points alone", "points.obj", "v 0 0 0\nv 1 0 0\n", &["has no triangles"]),
        ],
        d,
    );
}

#[test]
fn broken_collada_is_told_with_its_line() {
    let d = &directory("broken_collada");
    let circle = r##"<library_visual_scenes><visual_scene id="w"><node id="n"><instance_node url="#n"/></node></visual_scene></library_visual_scenes>"##;
    let lost = r##"<library_visual_scenes><visual_scene><node><instance_geometry url="#h"/></node></visual_scene></library_visual_scenes>"##;
    let polylist = r##"<polylist><input semantic="VERTEX" source="#v"/><vcount>4</vcount><p>0 1 2</p></polylist>"##;
    check(
        vec![
            case(d, "no XML", "a.dae", "solid nonsense", &["is broken in line 1", "XML"]),
            case(d, "another format", "b.dae", "<svg/>", &["outermost tag is <svg>"]),
            case(
                d,
                "index too large",
                "c.dae",
                collada(&triangles("0 1 7"), ""),
                &["line 6", "names vertex 7, but there are 3"],
            ),
            case(
                d,
                "negative index",
                "d.dae",
                collada(&triangles("0 1 -2"), ""),
                &["line 6", "\"-2\" is not an index"],
            ),
            case(
                d,
                "lines alone",
                "e.dae",
                collada("<lines count=\"1\"><p>0 1</p></lines>", ""),
                &["has no triangles"],
            ),
            case(d, "nodes in a circle", "f.dae", collada(&triangles("0 1 2"), circle), &["line 8", "in a circle"]),
            case(
                d,
                "lost geometry",
                "g.dae",
                collada(&triangles("0 1 2"), lost),
                &["line 8", "\"#h\", which does not exist"],
            ),
            case(d, "short list", "h.dae", collada(polylist, ""), &["line 6", "<vcount>"]),
            case(
                d,
                "truncated",
                "i.dae",
                &collada(&triangles("0 1 2"), "")[..300],
                &["is broken in line", "ends before"],
            ),
        ],
        d,
    );
}

#[test]
fn meshes_that_cannot_be_used_are_told() {
    let d = &directory("unusable_meshes");
    let fault = |name, file: &str, faults: &[&str]| Case::new(name, asking_for(file, ""), faults);
    check(
        vec![
            fault("scheme", "https://example.org/hand.stl", &["bad.urdf:3:", "link \"palm\"", "unknown form https://"]),
            fault("empty name", "", &["bad.urdf:3:", "link \"palm\"", "mesh filename \"\" is empty"]),
            case(d, "extension", "hand.step", "ISO-10303-21;", &["unknown extension \"step\"", "stl, obj or dae"]),
            Case::new("zero scale", asking_for("x.stl", "scale=\"1 0 1\""), &["link \"palm\"", "flattens the mesh"]),
        ],
        d,
    );
}

#[test]
fn meshes_that_are_not_there_leave_the_robot_without_them() {
    let d = &directory("missing_meshes");
    std::fs::create_dir_all(d.join("folder.stl")).expect("a folder can be made");
    let missing = |name, file: &str, faults: &[&str]| {
        let mut case = Case::new(name, asking_for(file, ""), faults);
        case.expected.extend([
            "bad.urdf:3:".into(),
            "link \"palm\"".into(),
            "contact that needs what is missing is refused".into(),
        ]);
        case
    };
    let hand = "<geometry><mesh filename=\"package://hand/a.stl\"/></geometry>";
    let other = hand.replace("a.stl", "b.stl");
    let two = robot(&format!(
        "<link name=\"palm\">\n<visual>{hand}</visual><collision>{hand}</collision><visual>{other}</visual></link>"
    ));
    let shape =
        |scale: &str| format!("<visual><geometry><mesh filename=\"lost.stl\" scale=\"{scale}\"/></geometry></visual>");
    let mirrored = robot(&format!("<link name=\"palm\">\n{}\n{}</link>", shape("1 1 1"), shape("1 -1 1")));
    check_doubts(
        vec![
            missing(
                "missing",
                "meshes/hand.stl",
                &["missing_meshes/meshes does not exist", "the mesh in it is not felt"],
            ),
            missing(
                "package",
                "package://arm_description/hand.stl",
                &["\"arm_description\" is not found", "missing_meshes"],
            ),
            missing("directory", "folder.stl", &["is not found"]),
            Case::new("at two scales", mirrored, &["bad.urdf:3:", "lost.stl is not found"]),
            Case::new(
                "package of two meshes",
                two,
                &["bad.urdf:3:", "the 2 meshes in it are neither drawn nor felt", "--package"],
            ),
        ],
        d,
    );
}

#[test]
fn what_spoils_only_the_looks_is_left_out() {
    let d = &directory("unseen");
    std::fs::write(d.join("cut.stl"), "").expect("the mesh file can be written");
    let seen = |file: &str, scale: &str| asking_for(file, scale).replace("collision", "visual");
    let shape = |geometry: &str| {
        robot(&format!("<link name=\"palm\"><visual>\n<geometry>{geometry}</geometry></visual></link>"))
    };
    let red = "<material name=\"red\">\n<color rgba=\"255 0 0 1\"/></material><link name=\"palm\"/>";
    check_doubts(
        vec![
            Case::new("broken", seen("cut.stl", ""), &["bad.urdf:3:", "link \"palm\"", "too few", "it is not drawn"]),
            Case::new(
                "flat",
                seen("cut.stl", "scale=\"1 0 1\""),
                &["bad.urdf:3:", "flattens", "the visual is left out"],
            ),
            Case::new("no radius", shape("<sphere radius=\"0.0\"/>"), &["bad.urdf:3:", "not positive", "is left out"]),
            Case::new("no shape", shape("<plane normal=\"0 0 1\"/>"), &["bad.urdf:3:", "<plane>", "it is not drawn"]),
            Case::new("no colour", robot(red), &["bad.urdf:3:", "rgba \"255 0 0 1\"", "the colour is passed over"]),
        ],
        d,
    );
}
