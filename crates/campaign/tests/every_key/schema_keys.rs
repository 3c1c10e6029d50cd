//! The keys of a schema, and those of a document by the same names.
//!
//! | name | what it is |
//! | --- | --- |
//! | `vehicle.pose.position_m` | a key; lists of tables have no index |
//! | `shape<sphere>` | an alternative of a table that its `kind` or `law` chooses |
//! | `shape<sphere>.radius_m` | a key of that alternative alone |
//! | `integrator.kind=rk4` | one word of a few |
//! | `vehicle.joints.*.position_deg` | a key under any name |

use serde_json::{Map, Value};
use std::collections::{BTreeMap, BTreeSet};

/// Every key that a schema knows.
pub fn of_schema(schema: &Value) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    walk(schema, "", &mut found);
    found
}

fn walk(schema: &Value, path: &str, found: &mut BTreeSet<String>) {
    let parts = alternatives(schema);
    if !parts.is_empty() && properties(schema).is_none() {
        parts.into_iter().for_each(|part| walk_alternative(part, path, found));
    } else if is_table(schema) {
        walk_table(schema, path, found);
        parts.into_iter().for_each(|part| walk_alternative(part, path, found));
    } else if let Some(items) = schema.get("items") {
        walk(items, path, found);
    } else {
        let words = words(schema);
        found.extend(words.iter().map(|word| format!("{path}={word}")));
        found.extend(words.is_empty().then(|| path.to_owned()));
    }
}

fn walk_alternative(part: &Value, path: &str, found: &mut BTreeSet<String>) {
    let Some((_, kind)) = tag(part) else { return walk(part, path, found) };
    let path = format!("{path}<{kind}>");
    found.insert(path.clone());
    walk_table(part, &path, found);
}

fn walk_table(schema: &Value, path: &str, found: &mut BTreeSet<String>) {
    for (key, child) in properties(schema).into_iter().flatten() {
        if child.get("const").is_none() {
            walk(child, &join(path, key), found);
        }
    }
    if let Some(others) = schema.get("additionalProperties").filter(|others| others.is_object()) {
        // What stands under a free key is one thing, however many forms it has.
        if is_table(others) { walk(others, &join(path, "*"), found) } else { found.extend([join(path, "*")]) }
    }
}

/// A key of a document: its name, and where it stands.
type Place = (String, String);

/// Every key of a document, by its name in the schema, with its place and what stands there.
pub fn of_document(schema: &Value, document: &toml::Table) -> BTreeMap<Place, String> {
    let mut found = BTreeMap::new();
    read_table(schema, document, (String::new(), String::new()), &mut found);
    found
}

fn read(schema: &Value, value: &toml::Value, place: Place, found: &mut BTreeMap<Place, String>) {
    match value {
        toml::Value::Table(table) => read_table(schema, table, place, found),
        toml::Value::Array(values) if values.iter().any(toml::Value::is_table) || !all_words(schema).is_empty() => {
            for (i, value) in values.iter().enumerate() {
                let items = all(schema).into_iter().find_map(|s| s.get("items")).unwrap_or(&Value::Null);
                // Words of a list stand for themselves, wherever they are in it.
                let at = if value.is_table() { format!("{}[{i}]", place.1) } else { place.1.clone() };
                read(items, value, (place.0.clone(), at), found);
            }
        }
        toml::Value::String(word) if all(schema).iter().any(|s| words(s).contains(&word.as_str())) => {
            found.insert((format!("{}={word}", place.0), place.1), String::new());
        }
        other => {
            found.insert(place, other.to_string());
        }
    }
}

fn read_table(schema: &Value, table: &toml::Table, (name, at): Place, found: &mut BTreeMap<Place, String>) {
    let chosen = all(schema)
        .into_iter()
        .find(|part| tag(part).is_some_and(|(key, kind)| table.get(key).and_then(toml::Value::as_str) == Some(kind)));
    let kind = chosen.and_then(tag);
    let own = kind.map(|(_, kind)| format!("{name}<{kind}>"));
    found.extend(own.iter().map(|own| ((own.clone(), at.clone()), String::new())));
    let plain: Vec<&Value> = all(schema).into_iter().filter(|s| is_table(s) && tag(s).is_none()).collect();
    for (key, value) in table.iter().filter(|(key, _)| kind.is_none_or(|(tag, _)| tag != key.as_str())) {
        let at = join(&at, key);
        let of = |s: &'_ Value| properties(s).and_then(|p| p.get(key)).cloned();
        if let Some(child) = plain.iter().find_map(|s| of(s)) {
            read(&child, value, (join(&name, key), at), found);
        } else if let (Some(child), Some(own)) = (chosen.and_then(of), &own) {
            read(&child, value, (join(own, key), at), found);
        } else if let Some(child) = plain.iter().find_map(|s| s.get("additionalProperties")) {
            read(child, value, (join(&name, "*"), at), found);
        }
    }
}

/// A schema and the alternatives in it.
fn all(schema: &Value) -> Vec<&Value> {
    let inner = alternatives(schema).into_iter().flat_map(all);
    std::iter::once(schema).chain(inner).collect()
}

fn alternatives(schema: &Value) -> Vec<&Value> {
    ["oneOf", "anyOf"].iter().filter_map(|group| schema.get(*group)?.as_array()).flatten().collect()
}

fn properties(schema: &Value) -> Option<&Map<String, Value>> {
    schema.get("properties")?.as_object()
}

fn is_table(schema: &Value) -> bool {
    properties(schema).is_some() || schema.get("type").and_then(Value::as_str) == Some("object")
}

/// The key that chooses an alternative, and its word there.
fn tag(part: &Value) -> Option<(&str, &str)> {
    properties(part)?.iter().find_map(|(key, schema)| Some((key.as_str(), schema.get("const")?.as_str()?)))
}

/// The words that may stand there, where only some may.
fn words(schema: &Value) -> Vec<&str> {
    let one = schema.get("const").and_then(Value::as_str);
    let many = schema.get("enum").and_then(Value::as_array);
    one.into_iter().chain(many.into_iter().flatten().filter_map(Value::as_str)).collect()
}

/// The words that may stand in a list.
fn all_words(schema: &Value) -> Vec<&str> {
    let items = all(schema).into_iter().filter_map(|s| s.get("items"));
    items.flat_map(all).flat_map(words).collect()
}

fn join(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") }
}
