//! The file as a whole: the starter, the round trip, the schema, places, and arbitrary text.

use proptest::prelude::*;
use scenario::spec::{ActuatorKind, Environment, FrictionLaw, IntegratorKind};
use scenario::{Place, Scenario, json_schema, parse, starter, to_toml};
use serde_json::Value;
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
    assert_eq!((scenario.shapes.len(), scenario.actuators.len(), scenario.effects.len()), (1, 1, 1));
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

/// Every key of every table in a schema, with the tables that alternatives describe.
fn schema_keys(schema: &Value, keys: &mut Vec<String>) {
    match schema {
        Value::Object(map) => {
            if let Some(Value::Object(properties)) = map.get("properties") {
                keys.extend(properties.keys().cloned());
            }
            map.values().for_each(|value| schema_keys(value, keys));
        }
        Value::Array(values) => values.iter().for_each(|value| schema_keys(value, keys)),
        _ => {}
    }
}

/// Every key of a TOML value, without those of free tables (joint names, parameters).
fn file_keys(value: &toml::Value, keys: &mut Vec<String>) {
    match value {
        toml::Value::Table(table) => {
            for (key, value) in table {
                keys.push(key.clone());
                match key.as_str() {
                    "joints" | "mapping" if value.is_table() => {
                        value.as_table().into_iter().flat_map(|t| t.values()).for_each(|v| file_keys(v, keys));
                    }
                    _ => file_keys(value, keys),
                }
            }
        }
        toml::Value::Array(values) => values.iter().for_each(|value| file_keys(value, keys)),
        _ => {}
    }
}

#[test]
fn schema_names_every_key_of_a_full_scenario() {
    let (mut known, mut used) = (Vec::new(), Vec::new());
    schema_keys(&json_schema(), &mut known);
    let value: toml::Table = to_toml(&full()).parse().expect("own output");
    file_keys(&toml::Value::Table(value), &mut used);
    for key in used.iter().filter(|key| !["c", "vector", "gain", "frame"].contains(&key.as_str())) {
        assert!(known.contains(key), "the schema lacks {key}");
    }
}

/// The alternatives and tables of a schema that take a table.
fn tables<'s>(schema: &'s Value, found: &mut Vec<&'s serde_json::Map<String, Value>>) {
    match schema {
        Value::Object(map) => {
            if map.contains_key("properties") {
                found.push(map);
            }
            map.values().for_each(|value| tables(value, found));
        }
        Value::Array(values) => values.iter().for_each(|value| tables(value, found)),
        _ => {}
    }
}

#[test]
fn every_key_of_the_schema_is_described_and_tables_are_closed() {
    let schema = json_schema();
    assert_eq!(schema["additionalProperties"], false);
    let mut found = Vec::new();
    tables(&schema, &mut found);
    assert!(found.len() > 40, "{} tables", found.len());
    for map in found {
        for (key, value) in map["properties"].as_object().into_iter().flatten() {
            assert!(value.get("description").is_some() || value.get("const").is_some(), "{key} is not described");
        }
    }
}

#[test]
fn schema_has_no_null() {
    assert!(!json_schema().to_string().contains("null"));
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
