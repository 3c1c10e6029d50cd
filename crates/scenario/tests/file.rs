//! The file as a whole: the starter, the round trip, places, and arbitrary text.

use proptest::prelude::*;
use scenario::spec::{ActuatorKind, Environment, FrictionLaw, IntegratorKind};
use scenario::{Place, Scenario, parse, starter, to_toml};
use std::path::Path;

/// A scenario in which every table and nearly every key occurs.
const FULL: &str = include_str!("full.toml");

fn full() -> Scenario {
    parse(FULL, "dir/full.toml", &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

#[test]
fn starter_loads_and_says_so() {
    let scenario = parse(&starter("my first one"), "scenarios/x.toml", &[]).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(scenario.name, "my-first-one");
    assert_eq!(scenario.vehicles.len(), 2);
    assert_eq!(scenario.resolve(&scenario.vehicles[0].urdf), Path::new("scenarios/../robots/servicer/servicer.urdf"));
}

#[test]
fn starter_loads_with_every_commented_section_uncommented() {
    let code = |line: &str| {
        line.starts_with("# [")
            || line.split(" = ").next().is_some_and(|key| {
                key.len() > 2
                    && line.contains(" = ")
                    && key[2..].chars().all(|c| c.is_ascii_lowercase() || "_0123456789".contains(c))
            })
    };
    let text: Vec<String> = starter("x")
        .lines()
        .map(|line| match line.strip_prefix("# ") {
            Some(rest) if code(line) => rest.to_owned(),
            _ => line.to_owned(),
        })
        .collect();
    let scenario = parse(&text.join("\n"), "x.toml", &[]).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!((scenario.shapes.len(), scenario.actuators.len(), scenario.effects.len()), (1, 3, 1));
    assert_eq!(scenario.contact_default.friction, FrictionLaw::None);
}

#[test]
fn what_is_written_is_read_again() {
    for scenario in [full(), parse(&starter("x"), "x.toml", &[]).expect("starter")] {
        let text = to_toml(&scenario);
        let again = parse(&text, "y.toml", &[]).unwrap_or_else(|errors| panic!("{errors}\n{text}"));
        assert_eq!(scenario, again);
        assert_eq!(text, to_toml(&again));
    }
}

#[test]
fn defaults_are_those_of_the_documentation() {
    let text = "name = \"t\"\nseed = 1\nduration_s = 1\n[[vehicle]]\nname = \"a\"\nurdf = \"a.urdf\"\n";
    let scenario = parse(text, "t.toml", &[]).expect("minimal");
    assert_eq!((scenario.integrator.kind, scenario.integrator.step_s), (IntegratorKind::ImplicitEuler, 1e-3));
    assert_eq!(scenario.environment, Environment::DeepSpace);
    assert!(scenario.vehicles[0].base.is_free());
    assert_eq!(scenario.output.log_rate_hz, 100.0);
}

#[test]
fn last_matching_rule_decides_and_leaves_the_rest_to_the_default() {
    let scenario = full();
    assert!(!scenario.contact_law(&["servicer/elbow"], &["servicer/base"]).enabled);
    let pads = scenario.contact_law(&["client/bar"], &["servicer/pad", "servicer/finger_left"]);
    let FrictionLaw::Bristle(friction) = pads.friction else { panic!("pads have friction") };
    assert_eq!((friction.mu, friction.mu_static), (0.35, Some(0.5)));
    let rest = scenario.contact_law(&["client/bar"], &["world/floor"]);
    assert_eq!(rest, scenario.contact_default);
}

#[test]
fn spec_values_are_si() {
    let scenario = full();
    let servicer = &scenario.vehicles[0];
    assert!((servicer.joints["elbow"].position() - 40.0_f64.to_radians()).abs() < 1e-15);
    assert_eq!(servicer.joints["finger_left"].position(), 0.03);
    assert_eq!(servicer.joints["finger_left"].is_linear(), Some(true));
    let jet = scenario.actuators.iter().find(|a| matches!(a.kind, ActuatorKind::Thruster { .. })).expect("a thruster");
    assert_eq!(jet.kind.axis(), Some(spatial::Vec3::new(0.0, 0.0, -1.0)));
    assert_eq!(scenario.shapes[0].place(), "client/bumper");
}

#[test]
fn places_lead_back_into_the_file_or_to_the_override() {
    let overrides = ["integrator.step_s=1e-4".to_owned()];
    let scenario = parse(FULL, "dir/full.toml", &overrides).expect("full");
    let line = |needle: &str| FULL.lines().position(|l| l.starts_with(needle)).expect(needle) + 1;
    for (path, needle) in [
        ("vehicle.client.urdf", "urdf = \"../robots/client"),
        ("effect[0].c", "c = 0.8"),
        ("contact[0].normal", "[[contact]]"),
    ] {
        let place = scenario.place(path);
        assert!(matches!(&place, Place::File { line: at, .. } if *at == line(needle)), "{path}: {place}");
    }
    assert_eq!(scenario.place("integrator.step_s"), Place::Override { text: overrides[0].clone() });
    let said = scenario.unknown_name("effect[0].place", ("joint", "elbo"), ["elbow", "wrist"]).to_string();
    assert!(said.ends_with("`effect[0].place`: no joint \"elbo\"; did you mean \"elbow\"?"), "{said}");
}

proptest! {
    #[test]
    fn arbitrary_text_is_refused_without_panic(text in any::<String>(), set in any::<String>()) {
        let _ = parse(&text, "x.toml", &[set]);
    }

    #[test]
    fn mutilated_scenarios_never_panic(at in 0..FULL.len(), len in 0..40_usize, put in "[\\[\\]{}=.,\"a-z0-9\n*é-]{0,6}") {
        let end = (at + len).min(FULL.len());
        let text = match (FULL.get(..at), FULL.get(end..)) {
            (Some(before), Some(after)) => format!("{before}{put}{after}"),
            _ => put,
        };
        if let Ok(scenario) = parse(&text, "x.toml", &[]) {
            let again = parse(&to_toml(&scenario), "x.toml", &[]).unwrap_or_else(|errors| panic!("{errors}"));
            prop_assert_eq!(scenario, again);
        }
    }

    #[test]
    fn arbitrary_overrides_never_panic(path in "(vehicle|contact|strategy|effect|output|campaign|\\*)(\\.[a-z_*\"]{1,10}|\\[[0-9*]{0,2}\\]){0,4}", value in ".{0,12}") {
        let _ = parse(FULL, "x.toml", &[format!("{path}={value}")]);
    }
}
