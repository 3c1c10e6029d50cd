//! The JSON Schema of a scenario file, derived from the types, and how it reads on a given table.
//!
//! The schema that `softdock schema` prints, that the parser checks against and that overrides find their way by is one
//! and the same value: none of them can know a key that another does not.

mod check;
mod effects;
mod number;
mod refers;
mod rules;

pub(crate) use check::{check, join, join_raw};

use crate::document::{Node, Table, Value as Tree};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// The JSON Schema of a scenario file (draft 2020-12), for editors and for `softdock schema`.
pub fn json_schema() -> Value {
    scenario_schema().clone()
}

/// The schema, made once.
pub(crate) fn scenario_schema() -> &'static Value {
    static SCHEMA: LazyLock<Value> = LazyLock::new(|| {
        let settings = schemars::generate::SchemaSettings::draft2020_12().with(|s| s.inline_subschemas = true);
        let mut schema = settings.into_generator().into_root_schema_for::<crate::Scenario>().to_value();
        tidy(&mut schema);
        effects::describe(&mut schema);
        schema
    });
    &SCHEMA
}

/// Takes out what TOML cannot say (null), and closes every table that names its keys.
fn tidy(schema: &mut Value) {
    match schema {
        Value::Object(map) => {
            drop_null(map);
            let open = map.contains_key("additionalProperties");
            if map.contains_key("properties") && map.contains_key("oneOf") && !open {
                map.insert("unevaluatedProperties".into(), json!(false));
                map.values_mut().for_each(tidy_part);
                return;
            }
            if map.contains_key("properties") && !open {
                map.insert("additionalProperties".into(), json!(false));
            }
            map.values_mut().for_each(tidy);
        }
        Value::Array(values) => values.iter_mut().for_each(tidy),
        _ => {}
    }
}

/// As [`tidy`], for the alternatives inside a table that is closed as a whole: each knows only its own keys.
fn tidy_part(schema: &mut Value) {
    match schema {
        Value::Object(map) if map.contains_key("properties") => {
            map.remove("additionalProperties");
            map.values_mut().for_each(tidy);
        }
        Value::Array(values) => values.iter_mut().for_each(tidy_part),
        other => tidy(other),
    }
}

/// `["number", "null"]` → `"number"`; an alternative `{"type": "null"}` goes, and what is left alone moves up.
fn drop_null(map: &mut Map<String, Value>) {
    if let Some(Value::Array(types)) = map.get_mut("type") {
        types.retain(|t| t != "null");
        if let [only] = types.as_slice() {
            let only = only.clone();
            map.insert("type".into(), only);
        }
    }
    if map.get("default") == Some(&Value::Null) {
        map.remove("default");
    }
    let Some(Value::Array(parts)) = map.get_mut("anyOf") else { return };
    parts.retain(|part| part.get("type").is_none_or(|t| t != "null"));
    if let [Value::Object(only)] = parts.as_slice() {
        let only = only.clone();
        map.remove("anyOf");
        for (key, value) in only {
            map.entry(key).or_insert(value);
        }
    }
}

/// The alternatives of a schema, or the schema itself.
pub(crate) fn alternatives(schema: &Value) -> Vec<&Value> {
    for key in ["anyOf", "oneOf"] {
        if let Some(Value::Array(parts)) = schema.get(key)
            && schema.get("properties").is_none()
        {
            return parts.iter().flat_map(alternatives).collect();
        }
    }
    vec![schema]
}

/// The TOML type that one alternative takes.
pub(crate) fn type_name(schema: &Value) -> &str {
    match schema.get("type").and_then(Value::as_str) {
        Some(name) => name,
        None if schema.get("const").is_some() || schema.get("enum").is_some() => "string",
        None if schema.get("properties").is_some() => "object",
        None => "any",
    }
}

/// Whether a value has the type of an alternative.
pub(crate) fn takes(schema: &Value, tree: &Tree) -> bool {
    match type_name(schema) {
        "string" => matches!(tree, Tree::Text(_)),
        "number" => matches!(tree, Tree::Integer(_) | Tree::Float(_)),
        "integer" => matches!(tree, Tree::Integer(_)),
        "boolean" => matches!(tree, Tree::Flag(_)),
        "array" => matches!(tree, Tree::List(_)),
        "object" => matches!(tree, Tree::Table(_)),
        _ => true,
    }
}

/// The alternative that takes tables, if any.
pub(crate) fn table_schema(schema: &Value) -> Option<&Value> {
    // A tagged union is many alternatives of one type: it is read as a whole, by its tag.
    let tables = |s: &&Value| type_name(s) == "object";
    match alternatives(schema).into_iter().filter(tables).collect::<Vec<_>>().as_slice() {
        [] => None,
        [only] => Some(only),
        _ => Some(schema),
    }
}

/// The schema of the elements, where it takes lists.
pub(crate) fn item_schema(schema: &Value) -> Option<&Value> {
    alternatives(schema).into_iter().find(|s| type_name(s) == "array")?.get("items")
}

/// What a schema says of one table, its kind taken into account.
#[derive(Debug, Default)]
pub(crate) struct TableView<'s> {
    /// The keys that may be there.
    pub(crate) keys: BTreeMap<&'s str, &'s Value>,
    /// Those that must be.
    pub(crate) required: Vec<&'s str>,
    /// What any other key may hold, in a table with free keys.
    pub(crate) others: Option<&'s Value>,
    /// The schemas that apply, for their rules.
    pub(crate) parts: Vec<&'s Value>,
    /// A kind that is missing or unknown.
    pub(crate) tag: Option<Tag<'s>>,
}

/// The key that decides which keys a table has, when what stands there decides nothing.
#[derive(Debug)]
pub(crate) struct Tag<'s> {
    pub(crate) key: &'s str,
    pub(crate) valid: Vec<&'s str>,
}

impl<'s> TableView<'s> {
    /// Reads `schema` on a table.
    pub(crate) fn of(schema: &'s Value, table: &Table) -> Self {
        let mut view = Self::default();
        view.add(schema, table);
        view
    }

    /// The schema of a key, if the table may have it.
    pub(crate) fn key(&self, key: &str) -> Option<&'s Value> {
        self.keys.get(key).copied().or(self.others)
    }

    /// Adds what a schema says, then what the alternative that the table has chosen says.
    fn add(&mut self, schema: &'s Value, table: &Table) {
        self.parts.push(schema);
        self.add_own(schema);
        for group in ["oneOf", "anyOf", "allOf"] {
            let Some(Value::Array(parts)) = schema.get(group) else { continue };
            let tables: Vec<&Value> = parts.iter().filter(|part| type_name(part) == "object").collect();
            match (group, tag_of(&tables)) {
                ("allOf", _) | (_, None) => tables.iter().for_each(|part| self.add(part, table)),
                (_, Some(tag)) => self.add_tagged(tag, &tables, table),
            }
        }
    }

    /// Adds the keys that a schema names itself.
    fn add_own(&mut self, schema: &'s Value) {
        if let Some(Value::Object(properties)) = schema.get("properties") {
            self.keys.extend(properties.iter().map(|(key, value)| (key.as_str(), value)));
        }
        if let Some(Value::Array(required)) = schema.get("required") {
            self.required.extend(required.iter().filter_map(Value::as_str));
        }
        let others = schema.get("additionalProperties").filter(|others| **others != json!(false));
        self.others = self.others.or(others);
    }

    /// Adds the alternative that the tag names; all of them, none mandatory, where it names none.
    fn add_tagged(&mut self, tag: Tag<'s>, tables: &[&'s Value], table: &Table) {
        let written = table.get(tag.key).and_then(|entry| entry.node.text());
        let chosen = tables.iter().find(|part| tag_value(part, tag.key) == written && written.is_some());
        let tag_schema = tables.first().and_then(|part| part.get("properties")?.get(tag.key));
        match chosen {
            Some(part) => self.add(part, table),
            None => {
                let before = self.required.len();
                tables.iter().for_each(|part| self.add_own(part));
                self.required.truncate(before);
                self.tag = Some(tag);
                self.keys.extend(self.tag.iter().filter_map(|tag| Some((tag.key, tag_schema?))));
            }
        }
    }
}

/// The key that all alternatives give as a constant, and the constants.
fn tag_of<'s>(tables: &[&'s Value]) -> Option<Tag<'s>> {
    let properties = tables.first()?.get("properties")?.as_object()?;
    let key = properties.iter().find(|(_, schema)| schema.get("const").is_some())?.0;
    let valid = tables.iter().filter_map(|part| tag_value(part, key)).collect();
    Some(Tag { key, valid })
}

/// The constant of an alternative's tag.
fn tag_value<'s>(part: &'s Value, key: &str) -> Option<&'s str> {
    part.get("properties")?.get(key)?.get("const")?.as_str()
}

/// Whether a key of a table decides which others it has.
pub(crate) fn is_tag(schema: &Value, key: &str) -> bool {
    ["oneOf", "anyOf"].iter().any(|group| {
        let Some(Value::Array(parts)) = schema.get(*group) else { return false };
        let tables: Vec<&Value> = parts.iter().filter(|part| type_name(part) == "object").collect();
        tag_of(&tables).is_some_and(|tag| tag.key == key)
    })
}

/// The texts that a schema takes, where it takes only some.
pub(crate) fn choices(schema: &Value) -> Vec<&str> {
    alternatives(schema)
        .into_iter()
        .flat_map(|part| match (part.get("const"), part.get("enum")) {
            (Some(Value::String(one)), _) => vec![one.as_str()],
            (_, Some(Value::Array(many))) => many.iter().filter_map(Value::as_str).collect(),
            _ => vec![],
        })
        .collect()
}

/// What a schema takes, in words with an article.
pub(crate) fn expected(schema: &Value) -> String {
    let mut words: Vec<&str> = Vec::new();
    for part in alternatives(schema) {
        let word = match type_name(part) {
            "string" => "a text in quotes",
            "number" => "a number",
            "integer" => "a whole number",
            "boolean" => "true or false",
            "array" => "a list",
            "object" => "a table",
            _ => "a value",
        };
        if !words.contains(&word) {
            words.push(word);
        }
    }
    words.join(" or ")
}

/// The first sentence of a schema's description.
pub(crate) fn meaning(schema: &Value) -> String {
    let text = schema.get("description").and_then(Value::as_str).unwrap_or("it is mandatory");
    let line = text.split("\n\n").next().unwrap_or(text).replace('\n', " ");
    line.trim_end_matches('.').to_owned()
}

/// The entry of a list under the name that paths use for it: `name` where its tables have one, else `[i]`.
pub(crate) fn element_path(path: &str, index: usize, node: &Node, named: bool) -> String {
    match node.name().filter(|_| named) {
        Some(name) if is_plain(name) => format!("{path}.{name}"),
        _ => format!("{path}[{index}]"),
    }
}

/// Whether tables under this schema are known by a unique name.
pub(crate) fn is_named(item: &Value) -> bool {
    let name = item.get("properties").and_then(|properties| properties.get("name"));
    name.is_some_and(|schema| schema.get("x-name").is_some())
}

/// Whether a text can stand in a path without quotes.
pub(crate) fn is_plain(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-')
}
