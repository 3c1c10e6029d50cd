//! `[[effect]]` entries: what each is checked for, where it lands, and that it is nothing at its neutral parameters.
#![allow(clippy::unwrap_used)]

use scenario::effects::{self, Neutral, UNKNOWN, catalogue};
use scenario::{Mission, ScenarioErrors};
use std::fs;
use std::path::Path;

const ARM: &str = "
name = \"two arms\"
seed = 1
duration_s = 1.0
[integrator]
kind = \"rk4\"
[environment]
kind = \"lab\"
[[vehicle]]
name = \"left\"
urdf = \"arm.urdf\"
base = \"fixed\"
[[vehicle]]
name = \"right\"
urdf = \"arm.urdf\"
base = \"fixed\"
pose = { position_m = [0, 5, 0] }
[[actuator]]
name = \"shoulder\"
kind = \"joint-torque\"
joint = \"left/joint_2\"
reflected_inertia_kg_m2 = 0.45
[[actuator]]
name = \"jet\"
kind = \"thruster\"
link = \"left/link_7\"
position_m = [0, 0, 0]
direction = [1, 0, 0]
max_force_n = 5
[strategy]
kind = \"schedule\"
commands = [{ actuator = \"shoulder\", points = [[0, 1], [1, 9]] }, { actuator = \"jet\", points = [[0, 0], [1, 5]] }]
";

fn build(effects: &str) -> Result<Mission, ScenarioErrors> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let dir = tempfile::tempdir().unwrap();
    fs::copy(root.join("robots/arm-bench/arm-bench.urdf"), dir.path().join("arm.urdf")).unwrap();
    let file = dir.path().join("arms.toml");
    fs::write(&file, format!("{ARM}{effects}")).unwrap();
    scenario::build(&scenario::load(&file, &[])?)
}

fn effect(name: &str, place: &str, params: &str) -> String {
    format!("[[effect]]\nname = \"{name}\"\nplace = \"{place}\"\n{params}\n")
}

fn fault(name: &str, place: &str, params: &str) -> String {
    build(&effect(name, place, params)).map(|_| ()).unwrap_err().to_string()
}

/// Joint positions after 50 steps.
fn run(effects: &str) -> Vec<u64> {
    let mut mission = build(effects).unwrap_or_else(|e| panic!("{effects}: {e}"));
    mission.world.run(50, &*mission.controller, &mut []).unwrap();
    mission.world.state().q.iter().map(|q| q.to_bits()).collect()
}

#[test]
fn neutral_entry_changes_no_bit_and_a_millionth_beside_it_does() {
    let bare = run("");
    let entries = [
        ("joint-viscous-friction", "joint:left/joint_2", "b = 0.0", "b = 1e-6"),
        ("joint-coulomb-friction", "joint:left/joint_2", "c = 0.0", "c = 1e-6"),
        ("joint-stribeck-friction", "joint:left/joint_2", "c = 0\ns = 0\nv_s = 0.1", "c = 0\ns = 1e-6\nv_s = 0.1"),
        ("joint-friction-asymmetry", "joint:left/joint_2", "c_plus = 0\nc_minus = 0", "c_plus = 1e-6\nc_minus = 1e-6"),
        ("joint-viscous-asymmetry", "joint:left/joint_2", "b_plus = 0\nb_minus = 0", "b_plus = 1e-6\nb_minus = 1e-6"),
        ("joint-quadratic-friction", "joint:left/joint_2", "b_2 = 0.0", "b_2 = 1e-6"),
        ("joint-offset", "joint:left/joint_2", "effort = 0.0", "effort = 1e-6"),
        ("joint-backlash", "joint:left/joint_2", "gap = 0\nk = inf", "gap = 1e-6\nk = 1e4"),
        ("joint-elasticity", "joint:left/joint_2", "k = inf\nd = 3", "k = 1e4\nd = 3"),
        (
            "joint-torque-ripple",
            "joint:left/joint_2",
            "amplitude = 0\norder = 6",
            "amplitude = 1e-6\norder = 6\nphase = 1",
        ),
        ("joint-cable-stiffness", "joint:left/joint_2", "k = 0\nq_rest = 1", "k = 1e-6\nq_rest = 1"),
        ("joint-armature", "joint:left/joint_2", "i_rotor = 0", "i_rotor = 1e-6"),
        (
            "periodic-disturbance",
            "joint:left/joint_2",
            "amplitude = 0\nfrequency = 2",
            "amplitude = 1e-6\nfrequency = 2",
        ),
        ("actuator-gain", "joint:left/joint_2", "gain = 1", "gain = 1.000001"),
        ("actuator-gain", "actuator:jet", "gain = 1", "gain = 1.000001"),
        ("actuator-delay", "actuator:*", "delay = 0", "delay = 1e-6"),
        ("actuator-lag", "actuator:shoulder", "time_constant = 0", "time_constant = 1e-6"),
        ("actuator-saturation", "actuator:shoulder", "limit = inf", "limit = 1.0"),
        ("actuator-misalignment", "actuator:jet", "angle_y = 0\nangle_z = 0", "angle_y = 1e-6"),
        ("payload", "link:left/link_7", "mass = 0\ncom = [0.1, 0, 0]", "mass = 1e-6\ncom = [0.1, 0, 0]"),
    ];
    for (name, place, neutral, near) in entries {
        assert!(run(&effect(name, place, neutral)) == bare, "{name} at {neutral}");
        assert!(run(&effect(name, place, near)) != bare, "{name} at {near}");
    }
}

#[test]
fn payload_is_a_point_mass_on_its_link() {
    let plain = build("").unwrap();
    let loaded = build(&effect("payload", "link:left/link_7", "mass = 0.35\ncom = [0.02, -0.01, 0.08]")).unwrap();
    let inertia = |m: &Mission| {
        let tree = &m.world.model().vehicles[0].tree;
        tree.links[tree.link("link_7").unwrap()].inertia
    };
    let at = spatial::Vec3::new(0.02, -0.01, 0.08);
    let expected = inertia(&plain) + spatial::Inertia::from_com(0.35, &at, &spatial::Mat3::zeros());
    let got = inertia(&loaded);
    assert!((got.mass - expected.mass).abs() < 1e-15 && (got.mc - expected.mc).norm() < 1e-15);
    assert!((got.rot - expected.rot).norm() < 1e-15, "about the link's origin");
}

#[test]
fn reflected_inertia_is_that_of_drive_and_effect_together_and_moves_behind_a_gear() {
    let armature = |effects: &str| {
        let mission = build(effects).unwrap();
        let tree = &mission.world.model().vehicles[0].tree;
        tree.joints[tree.joint("joint_2").unwrap()].armature
    };
    assert_eq!(armature(""), 0.45);
    assert_eq!(armature(&effect("joint-armature", "joint:left/joint_2", "i_rotor = 0.05")), 0.5);
    let both = effect("joint-elasticity", "joint:left/joint_2", "k = 7000")
        + &effect("joint-armature", "joint:left/joint_2", "i_rotor = 0.05");
    assert_eq!(armature(&both), 0.0);
    let mission = build(&both).unwrap();
    let sim::EffectKind::Series(series) = mission.world.model().effects()[0].kind else { panic!("a gear") };
    assert_eq!((series.rotor, series.stiffness), (0.5, 7000.0));
}

#[test]
fn what_is_wrong_is_said_with_the_way_out() {
    let cases = [
        (fault("joint-viscous-frction", "joint:left/joint_2", "b = 1"), "did you mean \"joint-viscous-friction\""),
        (fault("joint-viscous-friction", "joint:left/joint_22", "b = 1"), "did you mean \"left/joint_2\""),
        (fault("joint-viscous-friction", "joint:joint_2", "b = 1"), "left/joint_2, right/joint_2"),
        (fault("joint-viscous-friction", "link:left/link_2", "b = 1"), "acts at a joint"),
        (
            fault("joint-viscous-friction", "joint:left/joint_2", "c = 1"),
            "no parameter of joint-viscous-friction \"c\"",
        ),
        (fault("joint-viscous-friction", "joint:left/joint_2", ""), "`effect[0].b`: is missing"),
        (fault("joint-viscous-friction", "joint:left/joint_2", "b = -1.0"), "at least zero"),
        (fault("joint-viscous-friction", "joint:left/joint_2", "b = inf"), "finite"),
        (fault("joint-viscous-friction", "joint:left/joint_2", "b = [1, 2]"), "must be a number"),
        (fault("joint-elasticity", "joint:left/joint_3", "k = 7000"), "reflected_inertia_kg_m2"),
        (fault("joint-backlash", "joint:left/joint_2", "gap = 0.01\nk = inf"), "teeth"),
        (fault("joint-armature", "joint:left/joint_2", "i_rotor = -1"), "more than the joint has"),
        (fault("actuator-gain", "joint:left/joint_3", "gain = 0.9"), "without an actuator"),
        (fault("actuator-misalignment", "actuator:shoulder", "angle_y = 0.1"), "turns thrusters"),
        (fault("payload", "link:left/link_7", "mass = -2.0"), "more than the link has"),
        (fault("unknown", "world", ""), "without a model"),
    ];
    for (said, expected) in cases {
        assert!(said.contains(expected), "{said}\n   should say: {expected}");
        assert!(said.contains("arms.toml:"), "{said}: names no line");
    }
}

#[test]
fn the_catalogue_names_every_effect_once_with_a_place_and_a_neutral_point() {
    let mut names: Vec<&str> = catalogue().map(|e| e.name).collect();
    assert_eq!(names.len(), effects::ALL.len());
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), effects::ALL.len());
    for effect in catalogue().filter(|e| *e != &UNKNOWN) {
        assert!(!effect.places.is_empty() && !effect.parameters.is_empty(), "{effect}");
        assert!(effect.parameters.iter().any(|p| p.neutral != Neutral::Shape), "{effect} is never neutral");
        assert_eq!(effects::find(effect.name), Some(effect));
    }
}
