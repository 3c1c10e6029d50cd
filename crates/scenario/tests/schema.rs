//! The schema and the parser know the same keys, and say what each means.

use scenario::{Scenario, json_schema, to_toml};
use serde_json::{Map, Value};

/// Tables of a schema with named keys.
fn tables<'s>(schema: &'s Value, found: &mut Vec<&'s Map<String, Value>>) {
    match schema {
        Value::Object(map) => {
            found.extend(map.contains_key("properties").then_some(map));
            map.values().for_each(|value| tables(value, found));
        }
        Value::Array(values) => values.iter().for_each(|value| tables(value, found)),
        _ => {}
    }
}

#[test]
fn every_key_is_described() {
    let schema = json_schema();
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
fn tables_are_closed_and_null_is_unknown() {
    let schema = json_schema();
    assert_eq!(schema["additionalProperties"], false);
    assert_eq!(schema["properties"]["vehicle"]["items"]["additionalProperties"], false);
    assert_eq!(schema["properties"]["actuator"]["items"]["unevaluatedProperties"], false);
    assert!(!schema.to_string().contains("null"));
}

/// A value that a schema takes, with every key that it names; of alternatives the one of index `k`, counted round.
fn sample(schema: &Value, k: usize) -> toml::Value {
    let mut table = toml::Table::new();
    for group in ["oneOf", "anyOf"] {
        let Some(parts) = schema.get(group).and_then(Value::as_array) else { continue };
        match sample(&parts[k % parts.len()], k) {
            toml::Value::Table(more) => table.extend(more),
            other => return other,
        }
    }
    if let Some(text) = schema.get("const").or_else(|| Some(&schema.get("enum")?[0])).and_then(Value::as_str) {
        return toml::Value::String(text.to_owned());
    }
    match schema.get("type").and_then(Value::as_str) {
        Some("string") => toml::Value::String("text".to_owned()),
        Some("number") => toml::Value::Float(0.5),
        Some("integer") => toml::Value::Integer(3),
        Some("boolean") => toml::Value::Boolean(true),
        Some("array") => {
            // At least as many elements as the largest set of alternatives, so that each occurs in a list of tables.
            let exact = schema.get("maxItems").and_then(Value::as_u64).map_or(6, |n| n as usize);
            toml::Value::Array((0..exact).map(|i| sample(&schema["items"], k + i)).collect())
        }
        _ => {
            if let Some(others) = schema.get("additionalProperties").filter(|others| others.is_object()) {
                table.insert("anything".to_owned(), sample(others, k));
            }
            for (key, value) in schema.get("properties").and_then(Value::as_object).into_iter().flatten() {
                table.insert(key.clone(), sample(value, k));
            }
            toml::Value::Table(table)
        }
    }
}

/// Every key of `part` is in `whole`, at the same place.
fn assert_within(part: &toml::Value, whole: &toml::Value, path: &str) {
    match part {
        toml::Value::Table(table) => {
            for (key, value) in table {
                let path = format!("{path}.{key}");
                assert_within(value, whole.get(key).unwrap_or_else(|| panic!("{path} was dropped")), &path);
            }
        }
        toml::Value::Array(values) => {
            for (i, value) in values.iter().enumerate() {
                assert_within(value, &whole[i], &format!("{path}[{i}]"));
            }
        }
        _ => {}
    }
}

#[test]
fn types_take_and_keep_every_key_that_the_schema_names() {
    let schema = json_schema();
    for k in 0..6 {
        let sampled = sample(&schema, k);
        let scenario: Scenario = sampled.clone().try_into().unwrap_or_else(|error| panic!("{error}"));
        let written: toml::Table = to_toml(&scenario).parse().expect("own output");
        assert_within(&sampled, &toml::Value::Table(written), "");
    }
}
