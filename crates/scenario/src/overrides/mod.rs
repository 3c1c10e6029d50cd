//! Overrides: `path=value` from the command line, applied to the tree before it is checked.
//!
//! A path is keys joined by dots. Tables with a name are addressed by it (`vehicle.target`), elements of other lists by
//! `[i]` from zero (`contact[0]`, `rpy_deg[2]`); `*` or `[*]` stands for every element, or every key. A key that the
//! schema knows and the file leaves out is put in, beside the defaults of its table. Behind a `*`, branches that have no
//! such place are passed over. A path that leads nowhere is an error, never silence.
//!
//! Setting the kind of a table (`environment.kind=deep-space`, `contact[*].friction.law=none`) drops the keys that the
//! new kind does not have.

mod assign;
mod path;
mod select;

pub(crate) use path::parse_path;
pub(crate) use select::{check_number_path, select};

use crate::document::{Node, Origin, Value, read_value};
use crate::error::Problem;
use crate::schema::scenario_schema;

/// Applies override `index`, whose text is `path=value`.
pub(crate) fn apply(root: &mut Node, text: &str, index: usize) -> Result<(), Problem> {
    let (path, value) = split(text)?;
    let steps = parse_path(path)?;
    let node = value_of(value, index)?;
    assign::assign(root, scenario_schema(), &steps, &node)
}

/// Splits at the first `=` outside quotes.
fn split(text: &str) -> Result<(&str, &str), Problem> {
    let mut quoted = false;
    let equals = text.char_indices().find(|(_, c)| {
        quoted ^= *c == '"';
        *c == '=' && !quoted
    });
    match equals {
        Some((at, _)) if !text[..at].trim().is_empty() => Ok((text[..at].trim(), text[at + 1..].trim())),
        Some(_) => Err(Problem::BadOverride { what: "the path is empty".to_owned() }),
        None => Err(Problem::BadOverride { what: "there is no `=`".to_owned() }),
    }
}

/// A TOML value; a bare word, which TOML has not, is a text.
fn value_of(text: &str, index: usize) -> Result<Node, Problem> {
    if text.is_empty() {
        return Err(Problem::BadOverride { what: "the value is empty (an empty text is \"\")".to_owned() });
    }
    match read_value(text, index) {
        Ok(node) => Ok(node),
        Err(_) if is_bare(text) => Ok(Node { value: Value::Text(text.to_owned()), origin: Origin::Override(index) }),
        Err(what) => Err(Problem::BadOverride { what: format!("the value is not valid TOML: {what}") }),
    }
}

/// Whether a text is meant as one, without quotes: it has nothing that TOML would read as structure.
fn is_bare(text: &str) -> bool {
    !text.contains(['"', '\'', '[', ']', '{', '}', '#', '\n', '\r', '\t'])
}
