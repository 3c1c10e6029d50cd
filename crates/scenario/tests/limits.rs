//! What a file says of limits acts in the run, or the file is refused: wheels, joints, friction along a grain.
#![allow(clippy::unwrap_used)]

use scenario::outcome::Judge;
use scenario::{Mission, build, parse};
use serde_json::Value;
use sim::{Observer, World};

/// A block of 1 kg with an inertia of 0.00667 kg·m² about z, and a wheel along it; the first line of `rest` is 5.
const HEAD: &str = "name = \"t\"\nseed = 1\nduration_s = 4.0\n\
[[vehicle]]\nname = \"sat\"\nurdf = \"robots/bench/peer-block.urdf\"\n";

fn wheel(keys: &str) -> String {
    format!(
        "[[actuator]]\nname = \"rw\"\nkind = \"reaction-wheel\"\nlink = \"sat/block\"\naxis = [0, 0, 1]\n\
         inertia_kg_m2 = 1e-4\ntorque_limit_n_m = 0.01\nspeed_limit_rad_per_s = 50.0\n{keys}\n"
    )
}

fn built(rest: &str) -> Result<Mission, String> {
    let file = format!("{}/../../s.toml", env!("CARGO_MANIFEST_DIR"));
    let scenario = parse(&format!("{HEAD}{rest}"), &file, &[]).map_err(|e| e.to_string())?;
    build(&scenario).map_err(|e| e.to_string())
}

/// Runs a mission with its judge, looking at every step; metrics by name and the events' texts.
fn run(mut mission: Mission, mut look: impl FnMut(&World)) -> (serde_json::Map<String, Value>, Vec<String>) {
    let mut judge = Judge::new(&mission);
    let mut watch = |world: &World| {
        look(world);
        sim::Flow::Continue
    };
    let observers: &mut [&mut dyn Observer] = &mut [&mut judge, &mut watch];
    let ended = mission.world.run(mission.steps, &*mission.controller, observers);
    let outcome = judge.conclude(&mission.world, &ended);
    let metrics = outcome.metrics.iter().map(|m| (m.name.to_string(), m.value.clone())).collect();
    (metrics, outcome.events.iter().map(|e| e.text.clone()).collect())
}

#[test]
fn wheel_saturates_at_its_speed_limit_and_the_run_says_when_and_which() {
    // 0.02 N·m are asked, 0.01 given: 1e-4 kg·m² · 50 rad/s on 0.01 N·m is 0.5 s, the block's turning 1.5 % less.
    let commands = "[strategy]\nkind = \"schedule\"\ncommands = [{ actuator = \"rw\", points = [[0, 0.02], [2, 0.02], [2.001, -0.02]] }]\n";
    let (mut fastest, mut at_two) = (0.0_f64, 0.0);
    let (metrics, events) = run(built(&format!("{}{commands}", wheel(""))).unwrap(), |world| {
        let speed = world.state().v[0];
        fastest = fastest.max(speed);
        if world.state().time < 1.9995 {
            at_two = speed;
        }
    });
    assert!(fastest <= 50.0 * (1.0 + 1e-12) && at_two > 50.0 * (1.0 - 2e-6), "{fastest} {at_two}");
    let number = |name: &str| metrics[name].as_f64().unwrap_or_else(|| panic!("{name}: {}", metrics[name]));
    let expected = 1e-4 / (1.0 + 1e-4 / 0.006_666_67) * 50.0 / 0.01;
    assert!((number("actuator.rw.speed_limited_s") - expected).abs() < 1.5e-3, "{metrics:?}");
    assert!(number("actuator.rw.torque_limited_s") < 1.5e-3, "in the first step");
    assert_eq!(number("actuator.rw.peak_speed_rad_per_s"), fastest);
    // It comes off, and is at its limit in the other direction a second later: told twice.
    let told: Vec<&String> = events.iter().filter(|e| e.contains("rw is at its speed limit of 50 rad/s")).collect();
    assert_eq!(told.len(), 2, "{events:?}");
}

#[test]
fn wheel_that_never_saturates_says_so() {
    let commands = "[strategy]\nkind = \"schedule\"\ncommands = [{ actuator = \"rw\", points = [[0, 0.001]] }]\n";
    let (metrics, events) = run(built(&format!("{}{commands}", wheel(""))).unwrap(), |_| ());
    assert_eq!(metrics["actuator.rw.speed_limited_s"], Value::Null);
    assert_eq!(metrics["actuator.rw.torque_limited_s"], Value::Null);
    assert!(events.is_empty(), "{events:?}");
}

#[test]
fn limits_that_could_not_act_are_refused_with_their_line() {
    let said = built(&wheel("speed_rad_per_s = -60.0")).unwrap_err();
    assert!(said.contains(":15:") && said.contains("starts at -60 rad/s, beyond its limit of 50"), "{said}");
    assert!(built(&wheel("speed_rad_per_s = -50.0")).is_ok());
}

/// An arm of one turning and one sliding joint, each with the effort limit 0 and a velocity limit.
fn arm(rest: &str) -> Result<Mission, String> {
    let dir = tempfile::tempdir().unwrap();
    let link = |name: &str| {
        format!(
            "<link name=\"{name}\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/>\
             </inertial></link>"
        )
    };
    let joint = |name: &str, kind: &str, parent: &str, child: &str| {
        format!(
            "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/><axis xyz=\"0 0 1\"/>\
             <limit lower=\"-9\" upper=\"9\" effort=\"0\" velocity=\"0.5\"/></joint>"
        )
    };
    let links: String = ["base", "a", "b"].map(link).concat();
    let joints = joint("turn", "revolute", "base", "a") + &joint("slide", "prismatic", "a", "b");
    std::fs::write(dir.path().join("arm.urdf"), format!("<robot name=\"arm\">{links}{joints}</robot>")).unwrap();
    let text = format!(
        "name = \"t\"\nseed = 1\nduration_s = 2.0\n[[vehicle]]\nname = \"arm\"\nurdf = \"arm.urdf\"\nbase = \"fixed\"\n{rest}"
    );
    let scenario = parse(&text, &dir.path().join("s.toml").display().to_string(), &[]).map_err(|e| e.to_string())?;
    build(&scenario).map_err(|e| e.to_string())
}

#[test]
fn an_actuators_limit_is_one_that_fits_its_joint_and_can_act() {
    let torque = |joint: &str, keys: &str| {
        format!("[[actuator]]\nname = \"m\"\nkind = \"joint-torque\"\njoint = \"arm/{joint}\"\n{keys}\n")
    };
    let drive = |joint: &str, keys: &str| torque(joint, keys).replace("joint-torque", "joint-drive");
    for (rest, fragments) in [
        (torque("turn", ""), ["\"turn\" has the effort limit 0", "give limit_n_m here"]),
        (torque("slide", ""), ["\"slide\" has the effort limit 0", "give limit_n here"]),
        (torque("turn", "limit_n = 3.0"), [":12:11:", "joint \"turn\" turns; give limit_n_m instead"]),
        (torque("slide", "limit_n_m = 3.0"), [":12:13:", "joint \"slide\" slides; give limit_n instead"]),
        (drive("slide", "stiffness_n_per_m = 3.0\nlimit_n_m = 3.0"), [":13:13:", "give limit_n instead"]),
        (
            drive("slide", "stiffness_n_per_m = 3.0\ndamping_n_m_s_per_rad = 3.0\nlimit_n = 1.0"),
            ["joint \"slide\" is prismatic", "damping_n_s_per_m"],
        ),
    ] {
        let said = arm(&rest).err().unwrap_or_default();
        assert!(fragments.iter().all(|f| said.contains(f)), "{fragments:?} not in:\n{said}");
    }
    assert!(arm(&torque("turn", "limit_n_m = 3.0")).is_ok());
}

#[test]
fn a_joints_velocity_limit_stops_its_motor_and_the_run_says_so() {
    let rest = "[[actuator]]\nname = \"m\"\nkind = \"joint-torque\"\njoint = \"arm/turn\"\nlimit_n_m = 3.0\n\
                [strategy]\nkind = \"schedule\"\ncommands = [{ actuator = \"m\", points = [[0, 2.0]] }]\n";
    let (metrics, events) = run(arm(rest).unwrap(), |world| assert!(world.state().v[0] <= 0.5 * (1.0 + 1e-12)));
    // 1 kg·m² each of two links on one axis: 0.5 s.
    assert!((metrics["actuator.m.speed_limited_s"].as_f64().unwrap() - 0.5).abs() < 1.5e-3, "{metrics:?}");
    assert!(events.iter().any(|e| e.contains("m is at its speed limit")), "{events:?}");
}

#[test]
fn a_rate_loop_follows_a_scheduled_rate() {
    let rest = "[[actuator]]\nname = \"m\"\nkind = \"joint-drive\"\njoint = \"arm/turn\"\nstiffness_n_m_per_rad = 0.0\n\
                damping_n_m_s_per_rad = 100.0\nlimit_n_m = 30.0\n\
                [strategy]\nkind = \"schedule\"\ncommands = [{ actuator = \"m\", points = [[0, 0.3]] }]\n";
    let mission = arm(rest).unwrap();
    let mut last = 0.0;
    run(mission, |world| last = world.state().v[0]);
    // exp(−2 s · 100/2 /s)
    assert!((last - 0.3).abs() < 1e-9, "{last}");
}

/// The slider on its plate, pulled along its grain and across it by a jet each.
fn slid(contact: &str, effect: &str) -> Vec<[u64; 4]> {
    let jet = |name: &str, direction: &str| {
        format!(
            "[[actuator]]\nname = \"{name}\"\nkind = \"thruster\"\nlink = \"sat/block\"\nposition_m = [0, 0, 0]\n\
             direction = {direction}\nmax_force_n = 10\n"
        )
    };
    let text = format!(
        "pose = {{ position_m = [0, 0, 0.05] }}\nbase = {{ free = [\"x\", \"y\", \"z\"] }}\n\
         [environment]\nkind = \"lab\"\n[[shape]]\nname = \"floor\"\nkind = \"half-space\"\n\
         [[contact]]\nbetween = [\"world/floor\", \"sat/block\"]\n{contact}\n{effect}\n{}{}\
         [strategy]\nkind = \"schedule\"\ncommands = [{{ actuator = \"x\", points = [[0, 0], [1, 4], [2, 1], [4, 6]] }}, \
         {{ actuator = \"y\", points = [[0, 0], [1, 0.5], [2, 3], [4, 0]] }}]\n",
        jet("x", "[1, 0, 0]"),
        jet("y", "[0, 1, 0]")
    );
    let mut path = Vec::new();
    run(built(&text).unwrap(), |world| {
        let (at, p) = (world.state().bases[0].translation.vector, world.state().momentum[0].force);
        path.push([at.x, at.y, p.x, p.y].map(f64::to_bits));
    });
    path
}

#[test]
fn levels_along_and_across_a_grain_are_one_law_whichever_entry_gives_them() {
    let friction = |rest: &str| {
        format!("friction = {{ law = \"bristle\", mu = 0.3, stiffness_n_per_m = 2e4, damping_n_s_per_m = 10.0{rest} }}")
    };
    let grain = "grain = { on = \"sat/block\", axis = [1, 0, 0] }";
    let by_contact = slid(&format!("{}\n{grain}", friction(", across_ratio = 0.5")), "");
    let effect = "[[effect]]\nname = \"friction-anisotropy\"\nplace = \"contact:world/floor/sat/block\"\nmu_1 = 0.3\nmu_2 = 0.15\nangle = 0.0";
    let effect = effect.replace("world/floor/sat/block", "floor/block");
    let by_effect = slid(&friction(""), &effect);
    assert!(by_contact == by_effect, "the same numbers give the same run, to the bit");
    let even = slid(&friction(""), "");
    assert!(even != by_contact, "the levels matter");
    // It has slid, along and across.
    let end = by_contact.last().unwrap().map(f64::from_bits);
    assert!(end[0] > 0.1 && end[1] > 0.01, "{end:?}");
}

#[test]
fn a_ratio_without_a_grain_and_a_grain_without_a_ratio_are_refused() {
    let floor = "[[shape]]\nname = \"floor\"\nkind = \"half-space\"\npose = { position_m = [0, 0, -1] }\n\
                 [[contact]]\nbetween = [\"world/floor\", \"sat/block\"]\n";
    let ratio = "friction = { law = \"bristle\", mu = 0.3, across_ratio = 0.5, stiffness_n_per_m = 2e4 }\n";
    let grain = "grain = { on = \"sat/block\", axis = [1, 0, 0] }\n";
    let said = built(&format!("{floor}{ratio}")).unwrap_err();
    assert!(said.contains("across_ratio does nothing without a grain"), "{said}");
    let said = built(&format!("{floor}{grain}")).unwrap_err();
    assert!(said.contains("grain") && said.contains("give the friction an across_ratio"), "{said}");
    assert!(built(&format!("{floor}{ratio}{grain}")).is_ok());
}

#[test]
fn a_joint_whose_range_is_no_stop_goes_on_beyond_it_and_one_that_is_not_there_is_refused() {
    let file = format!("{}/../../crates/diagnose/tests/rigs/swing.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&file).unwrap();
    let of = |joint: &str| {
        let lifted = format!("vehicle[0].unstopped_joints=[\"{joint}\"]");
        build(&parse(&text, &file, &[lifted]).unwrap()).map_err(|e| e.to_string())
    };
    let range = |mission: &Mission| mission.world.model().coordinates[0].limits;
    assert_eq!(range(&build(&parse(&text, &file, &[]).unwrap()).unwrap()), Some([-100.0, 100.0]));
    assert_eq!(range(&of("hinge").unwrap()), None);
    let said = of("hing").err().unwrap();
    assert!(said.contains("vehicle[0].unstopped_joints[0]") && said.contains("did you mean \"hinge\"?"), "{said}");
}
