//! A scenario as a tree of values that know where they were written: in the file, or in an override.
//!
//! Everything before the typed [`Scenario`](crate::Scenario) works on this tree: overrides change it, the schema
//! checks it, and only a tree without fault becomes a scenario. So every complaint has a place, and one fault hides no
//! other.

mod read;
mod source;

pub(crate) use read::{SyntaxFault, read_document, read_value};
pub use source::Source;

use std::collections::BTreeMap;

/// Where a value was written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Origin {
    /// At this byte of the file.
    File(usize),
    /// In the override of this index.
    Override(usize),
}

/// A value and where it was written.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Node {
    pub(crate) value: Value,
    pub(crate) origin: Origin,
}

/// A TOML value.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    Text(String),
    Integer(i64),
    Float(f64),
    Flag(bool),
    /// As written; no key of a scenario takes one.
    Date(String),
    List(Vec<Node>),
    Table(Table),
}

/// A table, by key; its order is alphabetical, which nothing depends on.
pub(crate) type Table = BTreeMap<String, Entry>;

/// A key's place and its value.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Entry {
    pub(crate) key_origin: Origin,
    pub(crate) node: Node,
}

impl Node {
    /// The table, where it is one.
    pub(crate) fn table(&self) -> Option<&Table> {
        match &self.value {
            Value::Table(table) => Some(table),
            _ => None,
        }
    }

    /// The elements; none where it is no list.
    pub(crate) fn list(&self) -> &[Node] {
        match &self.value {
            Value::List(nodes) => nodes,
            _ => &[],
        }
    }

    /// The text, where it is one.
    pub(crate) fn text(&self) -> Option<&str> {
        match &self.value {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The number, where it is one.
    pub(crate) fn number(&self) -> Option<f64> {
        match &self.value {
            Value::Integer(value) => Some(*value as f64),
            Value::Float(value) => Some(*value),
            _ => None,
        }
    }

    /// The value under a key, where it is a table that has it.
    pub(crate) fn child(&self, key: &str) -> Option<&Node> {
        self.table()?.get(key).map(|entry| &entry.node)
    }

    /// The `name` of a table that has one.
    pub(crate) fn name(&self) -> Option<&str> {
        self.child("name")?.text()
    }

    /// A default of the schema, as if written at `origin`.
    pub(crate) fn from_json(json: &serde_json::Value, origin: Origin) -> Self {
        let entry = |(key, value): (&String, &serde_json::Value)| {
            (key.clone(), Entry { key_origin: origin, node: Self::from_json(value, origin) })
        };
        let value = match json {
            serde_json::Value::String(text) => Value::Text(text.clone()),
            serde_json::Value::Bool(flag) => Value::Flag(*flag),
            serde_json::Value::Number(number) => match number.as_i64() {
                Some(whole) => Value::Integer(whole),
                None => Value::Float(number.as_f64().unwrap_or(f64::NAN)),
            },
            serde_json::Value::Array(values) => {
                Value::List(values.iter().map(|value| Self::from_json(value, origin)).collect())
            }
            serde_json::Value::Object(map) => Value::Table(map.iter().map(entry).collect()),
            serde_json::Value::Null => Value::Table(Table::new()), // no default is null: the schema drops those
        };
        Self { value, origin }
    }

    /// As a value of the `toml` crate, to deserialise or to hand out.
    pub(crate) fn to_toml(&self) -> toml::Value {
        match &self.value {
            Value::Text(text) | Value::Date(text) => toml::Value::String(text.clone()),
            Value::Integer(value) => toml::Value::Integer(*value),
            Value::Float(value) => toml::Value::Float(*value),
            Value::Flag(value) => toml::Value::Boolean(*value),
            Value::List(nodes) => toml::Value::Array(nodes.iter().map(Node::to_toml).collect()),
            Value::Table(table) => {
                toml::Value::Table(table.iter().map(|(key, entry)| (key.clone(), entry.node.to_toml())).collect())
            }
        }
    }

    /// The value itself where it is short, for a message: `[0, 0, 1]`, `"text"`.
    pub(crate) fn quote(&self) -> String {
        match &self.value {
            Value::Integer(value) => value.to_string(),
            Value::Float(value) => format!("{value:?}"),
            Value::Text(text) => format!("\"{}\"", shortened(text)),
            Value::List(nodes) if nodes.len() <= 6 && nodes.iter().all(|node| node.number().is_some()) => {
                format!("[{}]", nodes.iter().map(Node::quote).collect::<Vec<_>>().join(", "))
            }
            Value::List(nodes) if nodes.len() == 1 => "[1 element]".to_owned(),
            Value::List(nodes) => format!("[{} elements]", nodes.len()),
            _ => self.describe(),
        }
    }

    /// What it is, for a message: the text itself where it is short.
    pub(crate) fn describe(&self) -> String {
        match &self.value {
            Value::Text(text) => format!("the text \"{}\"", shortened(text)),
            Value::Integer(value) => format!("the whole number {value}"),
            Value::Float(value) => format!("the number {value:?}"),
            Value::Flag(value) => format!("{value}"),
            Value::Date(text) => format!("the date or time {text}"),
            Value::List(nodes) => format!("a list of {}", nodes.len()),
            Value::Table(_) => "a table".to_owned(),
        }
    }
}

/// At most 60 characters of a text.
pub(crate) fn shortened(text: &str) -> String {
    match text.char_indices().nth(60) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}
