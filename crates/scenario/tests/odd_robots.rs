//! A robot that loads with doubts runs as far as a scenario does not need what it lacks; what it does need is refused, with
//! the way out.
#![allow(clippy::unwrap_used)]

use scenario::{Mission, build, parse};
use std::path::PathBuf;

const BODY: &str = r#"<inertial><mass value="10"/><inertia ixx="1" iyy="1" izz="1"/></inertial>"#;

/// A scenario that begins with these vehicles' lines, in a folder of its own with these robots.
struct Rig {
    dir: tempfile::TempDir,
}

impl Rig {
    fn new(robots: &[(&str, String)]) -> Self {
        let dir = tempfile::tempdir().unwrap();
        for (name, tags) in robots {
            let text = format!("<robot name=\"{name}\">\n{tags}\n</robot>");
            std::fs::write(dir.path().join(format!("{name}.urdf")), text).unwrap();
        }
        Self { dir }
    }

    fn build(&self, tail: &str) -> Result<Mission, String> {
        let file: PathBuf = self.dir.path().join("odd.toml");
        let text = format!("name = \"odd\"\nseed = 1\nduration_s = 0.1\n[strategy]\nkind = \"none\"\n{tail}");
        let scenario = parse(&text, &file.display().to_string(), &[]).map_err(|e| e.to_string())?;
        build(&scenario).map_err(|e| e.to_string())
    }

    fn refusal(&self, tail: &str) -> String {
        self.build(tail).map_or_else(|said| said, |_| panic!("it is to be refused:\n{tail}"))
    }
}

fn vehicle(name: &str, robot: &str, more: &str) -> String {
    format!("[[vehicle]]\nname = \"{name}\"\nurdf = \"{robot}.urdf\"\n{more}\n")
}

/// An arm whose tip, beyond its one joint, is what these tags say.
fn arm(tip: &str) -> String {
    format!(
        "<link name=\"base\">{BODY}</link>\n<link name=\"tip\">{tip}</link>\n<joint name=\"elbow\" type=\"continuous\">\
         <parent link=\"base\"/><child link=\"tip\"/><origin xyz=\"0 0 1\"/><axis xyz=\"0 1 0\"/></joint>"
    )
}

#[test]
fn a_joint_that_nothing_resists_is_refused_until_it_has_an_armature() {
    let rig = Rig::new(&[("arm", arm(""))]);
    let arm = vehicle("arm", "arm", "");
    let said = rig.refusal(&arm);
    assert!(
        said.contains("odd.toml:") && said.contains("arm.urdf:4:1: joint \"elbow\"") && said.contains("armature"),
        "{said}"
    );
    let armature = "[[effect]]\nname = \"joint-armature\"\nplace = \"joint:arm/elbow\"\ni_rotor = 1e-3\n";
    let mut mission = rig.build(&format!("{arm}{armature}")).unwrap_or_else(|e| panic!("{e}"));
    mission.world.run(mission.steps, &*mission.controller, &mut []).unwrap();
    assert_eq!(mission.robot_warnings[0].count(), 1);
}

#[test]
fn a_point_mass_on_the_axis_is_refused_at_the_start_alone() {
    let point = r#"<inertial><mass value="1"/><inertia ixx="0" iyy="0" izz="0"/></inertial>"#;
    let spun = arm(&point.replace("<mass", "<origin xyz=\"0 0.5 0\"/><mass"));
    let swung = arm(&point.replace("<mass", "<origin xyz=\"0.5 0 0\"/><mass"));
    let rig = Rig::new(&[("spun", spun), ("swung", swung)]);
    assert!(rig.refusal(&vehicle("spun", "spun", "")).contains("spun.urdf:4:1: joint \"elbow\""));
    rig.build(&vehicle("swung", "swung", "")).unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn a_free_base_without_inertia_is_refused_and_a_fixed_one_is_not() {
    let rail = arm(BODY).replacen(BODY, "", 1);
    let rig = Rig::new(&[("rail", rail)]);
    let said = rig.refusal(&vehicle("rail", "rail", "base = \"free\""));
    assert!(said.contains("the base moves freely") && said.contains("base = \"fixed\""), "{said}");
    rig.build(&vehicle("rail", "rail", "base = \"fixed\"")).unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn a_missing_collision_mesh_is_refused_only_where_it_may_touch() {
    let lost = format!(
        "<link name=\"palm\">{BODY}<collision><geometry><mesh filename=\"lost.stl\"/></geometry></collision></link>"
    );
    let ball = format!(
        "<link name=\"ball\">{BODY}<collision><geometry><sphere radius=\"0.1\"/></geometry></collision></link>"
    );
    let rig = Rig::new(&[("hand", lost), ("ball", ball)]);
    let (hand, ball) =
        (vehicle("hand", "hand", ""), vehicle("ball", "ball", "pose = { position_m = [5.0, 0.0, 0.0] }"));
    rig.build(&hand).unwrap_or_else(|e| panic!("alone it touches nothing: {e}"));
    let said = rig.refusal(&format!("{hand}{ball}"));
    assert!(said.contains("lost.stl is not found") && said.contains("enabled = false"), "{said}");
    let kept_off = "[[contact]]\nbetween = [\"hand/palm\", \"*\"]\nenabled = false\n";
    rig.build(&format!("{hand}{ball}{kept_off}")).unwrap_or_else(|e| panic!("kept from touching: {e}"));
}

#[test]
fn a_robot_that_is_refused_is_told_once_however_many_vehicles_are_of_it() {
    let rig = Rig::new(&[("bad", "<link name=\"a\"><inertail/></link>".to_owned())]);
    let said = rig.refusal(&["a", "b", "c"].map(|name| vehicle(name, "bad", "")).concat());
    assert_eq!(said.matches("<inertail>").count(), 1, "{said}");
}
