//! Overrides: what they reach, what they put in, and what they refuse.

use scenario::{Scenario, parse};

const TEXT: &str = r#"
name = "t"
seed = 1
duration_s = 10.0
[environment]
kind = "orbit"
mean_motion_rad_per_s = 1e-3
[[vehicle]]
name = "servicer"
urdf = "s.urdf"
[[vehicle]]
name = "target"
urdf = "t.urdf"
twist = { angular_deg_per_s = [0.5, 1.0, -0.3] }
[[contact]]
between = ["servicer/*", "servicer/*"]
enabled = false
[[contact]]
between = ["servicer/a", "target/*"]
friction = { law = "bristle", mu = 0.3, stiffness_n_per_m = 1e5 }
[[contact]]
between = ["servicer/b", "target/*"]
friction = { law = "none" }
[[contact]]
between = ["servicer/c", "target/*"]
friction = { law = "bristle", mu = 0.4, stiffness_n_per_m = 1e5 }
[strategy]
kind = "track-and-grasp"
servicer = "servicer"
target = "target"
tool_frame = "servicer/tool"
grapple_frame = "target/bar"
gripper = "fingers"
[[effect]]
name = "joint-viscous-friction"
place = "joint:servicer/a"
b = 0.1
[[effect]]
name = "joint-viscous-friction"
place = "joint:servicer/b"
b = 0.2
"#;

fn with(overrides: &[&str]) -> Result<Scenario, String> {
    let overrides: Vec<String> = overrides.iter().map(ToString::to_string).collect();
    parse(TEXT, "s.toml", &overrides).map_err(|errors| errors.to_string())
}

#[test]
fn what_is_set_can_be_read_back() {
    for (set, path, values) in [
        ("duration_s=3", "duration_s", "3.0"),
        ("integrator.step_s=5e-4", "integrator.step_s", "0.0005"),
        ("integrator.kind=rk4", "integrator.kind", "\"rk4\""),
        ("vehicle.target.twist.angular_deg_per_s[2]=1.5", "vehicle.target.twist.angular_deg_per_s", "[0.5, 1.0, 1.5]"),
        ("vehicle.target.twist.angular_deg_per_s[*]=2", "vehicle.target.twist.angular_deg_per_s", "[2.0, 2.0, 2.0]"),
        ("vehicle[0].pose.position_m=[1, 2, 3]", "vehicle.servicer.pose.position_m", "[1.0, 2.0, 3.0]"),
        ("vehicle.target.joints.hinge.position_deg=10", "vehicle.target.joints.hinge.position_deg", "10.0"),
        ("vehicle.*.base=fixed", "vehicle[*].base", "\"fixed\" \"fixed\""),
        ("vehicle.target.base={ free = [\"x\"] }", "vehicle.target.base.free[0]", "\"x\""),
        ("contact[*].friction.mu=0.02", "contact[*].friction.mu", "0.02 0.02"),
        ("contact[1].friction.damping_n_s_per_m=7", "contact[1].friction.damping_n_s_per_m", "7.0"),
        ("contact[0].enabled=true", "contact[0].enabled", "true"),
        ("contact_default.enabled=false", "contact_default.enabled", "false"),
        ("contact_default.friction.mu=0.1", "contact_default.friction.mu", "0.1"),
        ("vehicle[*].pose.position_m[2]=4", "vehicle[*].pose.position_m", "[0.0, 0.0, 4.0] [0.0, 0.0, 4.0]"),
        (
            "vehicle[*].twist.angular_deg_per_s[0]=4",
            "vehicle[*].twist.angular_deg_per_s[*]",
            "4.0 0.0 0.0 4.0 1.0 -0.3",
        ),
        ("strategy.prediction=false", "strategy.prediction", "false"),
        ("strategy.kind=none", "strategy", "{ kind = \"none\" }"),
        ("environment.kind=deep-space", "environment", "{ kind = \"deep-space\" }"),
        ("contact[*].friction.law=none", "contact[*].friction.law", "\"none\" \"none\" \"none\""),
        ("effect[1].b=0.5", "effect[*].b", "0.1 0.5"),
        ("effect[*].b=0", "effect[*].b", "0.0 0.0"),
        ("effect[0].d=inf", "effect[0].d", "inf"),
        ("output.channels=[\"joint.*\"]", "output.channels[0]", "\"joint.*\""),
        ("campaign={ runs = 5 }", "campaign.runs", "5"),
        ("description=a bare = word", "description", "\"a bare = word\""),
    ] {
        let scenario = with(&[set]).unwrap_or_else(|said| panic!("{set}: {said}"));
        let found = scenario.value_at(path).unwrap_or_else(|said| panic!("{path}: {said}"));
        let read: Vec<String> = found.iter().map(|(_, value)| value.to_string()).collect();
        assert_eq!(read.join(" "), values, "{set}");
    }
}

#[test]
fn several_apply_in_order() {
    let scenario = with(&["environment.kind=lab", "environment.gravity_m_per_s2=[0,0,-1.62]", "seed=2", "seed=3"]);
    let scenario = scenario.expect("all are right");
    assert_eq!(scenario.seed, 3);
    assert_eq!(scenario.environment, scenario::spec::Environment::Lab { gravity_m_per_s2: [0.0, 0.0, -1.62] });
}

#[test]
fn what_leads_nowhere_is_refused_with_the_nearest_spelling() {
    for (set, fragments) in [
        ("duration=3", ["--set 'duration=3': unknown key `duration`", "did you mean `duration_s`?"].as_slice()),
        ("strategy.predicton=false", &["unknown key `strategy.predicton`; did you mean `prediction`?"]),
        (
            "vehicle.traget.base=fixed",
            &[
                "`vehicle.traget.base` matches nothing: at `vehicle`, none is named \"traget\"; did you mean \"target\"?",
            ],
        ),
        ("vehicle[2].base=fixed", &["at `vehicle`, it has 2 entries, counted from 0"]),
        ("vehicle.target.twist.angular_deg_per_s[3]=1", &["it has 3 entries"]),
        ("contact.pads.enabled=true", &["its 4 entries have no names; write [0] … or [*]"]),
        ("contact[2].friction.mu=0.1", &["unknown key `contact[2].friction.mu`"]),
        ("shape[*].radius_m=1", &["matches nothing"]),
        (
            "effect.joint-viscous-friction.b=1",
            &["several are named \"joint-viscous-friction\"; write [0], [1] … or [*]"],
        ),
        ("duration_s.x=1", &["it holds the number 10.0, which has no parts"]),
        ("vehicle.target[0]=1", &["it is a table, which has keys and no [0]"]),
        ("seed", &["there is no `=`", "write path=value"]),
        ("=3", &["the path is empty"]),
        ("seed=", &["the value is empty"]),
        ("seed=[1", &["the value is not valid TOML"]),
        ("a..b=1", &["the path `a..b` cannot be read"]),
        ("duration_s=-1", &["--set 'duration_s=-1': `duration_s` = -1 must be greater than 0"]),
        ("integrator.step_s=fast", &["--set", "must be a number, not the text \"fast\""]),
        ("integrator.kind=euler", &["no kind \"euler\"", "implicit-euler"]),
        ("vehicle.target.name=servicer", &["the name \"servicer\" is taken at s.toml:9:8"]),
        ("environment.kind=orbital", &["--set", "did you mean \"orbit\"?"]),
        (
            "vehicle.target.pose.rpy_deg[2]=1",
            &[
                "at `vehicle.target.pose.rpy_deg`, the file says nothing; set all of it, `vehicle.target.pose.rpy_deg=…`",
            ],
        ),
        ("contact[0].friction.mu=0.1", &["`contact[0].friction` lacks `law`: one of bristle, regularised-coulomb"]),
    ] {
        let said = with(&[set]).expect_err(set);
        for fragment in fragments {
            assert!(said.contains(fragment), "for {set}\nexpected: {fragment}\nsaid: {said}");
        }
    }
}

#[test]
fn all_wrong_overrides_are_told_at_once() {
    let said = with(&["sede=1", "seed=2", "duration_s=0", "vehicle.x.base=free"]).expect_err("three are wrong");
    assert_eq!(said.lines().count(), 3, "{said}");
}
