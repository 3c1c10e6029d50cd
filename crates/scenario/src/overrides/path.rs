//! The grammar of paths: `key.key[3]."odd key".*[*]`.

use crate::document::shortened;
use crate::error::Problem;

/// One step of a path.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Step {
    /// A key of a table, or the name of a table in a list.
    Key(String),
    /// An element of a list.
    Index(usize),
    /// All of them.
    Any,
}

/// Reads a path.
pub(crate) fn parse_path(path: &str) -> Result<Vec<Step>, Problem> {
    let mut steps = Vec::new();
    let mut rest = path.trim();
    loop {
        rest = match rest.strip_prefix('[') {
            Some(inside) => read_index(inside, path, &mut steps)?,
            None => read_key(rest, path, &mut steps)?,
        };
        rest = match rest.strip_prefix('.') {
            Some(next) if !next.starts_with('[') => next,
            _ if rest.is_empty() => return Ok(steps),
            _ if rest.starts_with('[') => rest,
            _ => return Err(bad(path, rest)),
        };
    }
}

/// Reads `3]` or `*]`.
fn read_index<'t>(inside: &'t str, path: &str, steps: &mut Vec<Step>) -> Result<&'t str, Problem> {
    let (index, rest) = inside.split_once(']').ok_or_else(|| bad(path, inside))?;
    let step = match index.trim() {
        "*" => Step::Any,
        number => Step::Index(number.parse().map_err(|_| bad(path, inside))?),
    };
    steps.push(step);
    Ok(rest)
}

/// Reads a key, `*` or a key in quotes.
fn read_key<'t>(text: &'t str, path: &str, steps: &mut Vec<Step>) -> Result<&'t str, Problem> {
    if let Some(inside) = text.strip_prefix('"') {
        let (key, rest) = inside.split_once('"').ok_or_else(|| bad(path, text))?;
        steps.push(Step::Key(key.to_owned()));
        return Ok(rest);
    }
    let end = text.find(['.', '[', ']', '"', ' ', '=']).unwrap_or(text.len());
    let step = match &text[..end] {
        "" => return Err(bad(path, text)),
        "*" => Step::Any,
        key => Step::Key(key.to_owned()),
    };
    steps.push(step);
    Ok(&text[end..])
}

/// A path that is none.
fn bad(path: &str, at: &str) -> Problem {
    let at = if at.is_empty() { "its end".to_owned() } else { format!("\"{}\"", shortened(at)) };
    Problem::BadOverride { what: format!("the path `{}` cannot be read from {at} on", shortened(path)) }
}

/// A path as text again.
pub(crate) fn path_text(steps: &[Step]) -> String {
    let mut text = String::new();
    for step in steps {
        match step {
            Step::Index(i) => text.push_str(&format!("[{i}]")),
            Step::Any => text = crate::schema::join_raw(&text, "*"),
            Step::Key(key) => text = crate::schema::join(&text, key),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn paths_are_keys_indices_stars_and_quoted_keys() {
        let key = |k: &str| Step::Key(k.to_owned());
        for (text, steps) in [
            ("seed", vec![key("seed")]),
            ("a.b-c[2]", vec![key("a"), key("b-c"), Step::Index(2)]),
            ("contact[*].friction.mu", vec![key("contact"), Step::Any, key("friction"), key("mu")]),
            ("vehicle.*.pose", vec![key("vehicle"), Step::Any, key("pose")]),
            ("a.\"x.y\"[0][1]", vec![key("a"), key("x.y"), Step::Index(0), Step::Index(1)]),
        ] {
            assert_eq!(parse_path(text).unwrap(), steps, "{text}");
        }
    }

    #[test]
    fn broken_paths_are_refused() {
        for text in ["", ".", "a.", "a..b", "a[", "a[x]", "a[-1]", "a]", "a.[1]", "a b", "a.\"b", "a[1]b"] {
            assert!(parse_path(text).is_err(), "{text}");
        }
    }
}
