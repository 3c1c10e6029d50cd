//! TOML text → tree.

use super::{Entry, Node, Origin, Table, Value};
use std::borrow::Cow;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Error};

/// A fault of the text and the byte where it is.
pub(crate) struct SyntaxFault {
    pub(crate) at: usize,
    pub(crate) what: String,
}

/// Reads a document; with faults, the tree is what could be made of the rest.
pub(crate) fn read_document(text: &str) -> (Node, Vec<SyntaxFault>) {
    let (table, errors) = DeTable::parse_recoverable(text);
    let mut faults: Vec<SyntaxFault> = errors.iter().map(fault_of).collect();
    let table = read_table(table.get_ref(), None, &mut faults);
    (Node { value: Value::Table(table), origin: Origin::File(0) }, faults)
}

/// Reads one value, as it stands in override `index`.
pub(crate) fn read_value(text: &str, index: usize) -> Result<Node, String> {
    let value = DeValue::parse(text).map_err(|error| fault_of(&error).what)?;
    let mut faults = Vec::new();
    let node = read_node(&value, Some(Origin::Override(index)), &mut faults);
    match faults.into_iter().next() {
        Some(fault) => Err(fault.what),
        None => Ok(node),
    }
}

/// The parser's error without its rendering.
fn fault_of(error: &Error) -> SyntaxFault {
    SyntaxFault { at: error.span().map_or(0, |span| span.start), what: error.message().trim().replace('\n', "; ") }
}

/// A table; `origin` overrules the places in the text.
fn read_table(table: &DeTable<'_>, origin: Option<Origin>, faults: &mut Vec<SyntaxFault>) -> Table {
    let entry = |(key, value): (&Spanned<Cow<'_, str>>, &Spanned<DeValue<'_>>)| {
        let key_origin = origin.unwrap_or(Origin::File(key.span().start));
        (key.get_ref().to_string(), Entry { key_origin, node: read_node(value, origin, faults) })
    };
    table.iter().map(entry).collect()
}

/// A value; integers beyond 64 bits are faults.
fn read_node(value: &Spanned<DeValue<'_>>, origin: Option<Origin>, faults: &mut Vec<SyntaxFault>) -> Node {
    let at = value.span().start;
    let value = match value.get_ref() {
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Boolean(flag) => Value::Flag(*flag),
        DeValue::Datetime(date) => Value::Date(date.to_string()),
        DeValue::Integer(digits) => match i64::from_str_radix(digits.as_str(), digits.radix()) {
            Ok(number) => Value::Integer(number),
            Err(_) => {
                faults.push(SyntaxFault { at, what: format!("the whole number {digits} does not fit into 64 bits") });
                Value::Integer(0)
            }
        },
        DeValue::Float(digits) => Value::Float(digits.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Array(values) => Value::List(values.iter().map(|value| read_node(value, origin, faults)).collect()),
        DeValue::Table(table) => Value::Table(read_table(table, origin, faults)),
    };
    Node { value, origin: origin.unwrap_or(Origin::File(at)) }
}
