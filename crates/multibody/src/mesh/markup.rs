//! XML from strangers: URDF and COLLADA files parsed within bounds of time and memory.
//!
//! The parser itself does not recurse. It is given no DTD (entities expand without bound) and, as it compares each
//! attribute and each namespace with all its neighbours, no crowd of either.

use roxmltree::{Document, Error, ParsingOptions};

/// A bound on memory, above what the largest robots and meshes have.
const MOST_NODES: u32 = 4_000_000;
/// Attributes of one tag.
const MOST_ATTRIBUTES: usize = 1000;
/// Declarations of namespaces in a file.
const MOST_NAMESPACES: usize = 1000;

/// A place in a text file; both count from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextPlace {
    /// Line.
    pub line: usize,
    /// Column, in characters.
    pub column: usize,
}

/// Why a text is not XML that can be used.
pub(crate) struct MarkupError {
    /// Byte offset in the text.
    pub(crate) offset: usize,
    /// A sentence without a place.
    pub(crate) said: String,
    /// The prefix that is not declared, if that is the reason.
    pub(crate) unknown_prefix: Option<String>,
}

/// The XML tree of a text.
pub(crate) fn parse_bounded(text: &str) -> Result<Document<'_>, MarkupError> {
    if let Some((offset, said)) = find_crowd(text) {
        return Err(MarkupError { offset, said, unknown_prefix: None });
    }
    let options = ParsingOptions { allow_dtd: false, nodes_limit: MOST_NODES, ..Default::default() };
    Document::parse_with_options(text, options).map_err(|error| explain(text, &error))
}

fn find_crowd(text: &str) -> Option<(usize, String)> {
    if text.match_indices("xmlns").nth(MOST_NAMESPACES).is_some() {
        return Some((0, format!("it declares more than {MOST_NAMESPACES} namespaces")));
    }
    let (mut at, mut in_tag) = (0, 0);
    while let Some(found) = text[at..].find(['<', '=']) {
        at += found;
        if text[at..].starts_with("<!--") {
            at += text[at..].find("-->").unwrap_or(text.len() - at);
            continue;
        }
        in_tag = if text[at..].starts_with('<') { 0 } else { in_tag + 1 };
        if in_tag > MOST_ATTRIBUTES {
            return Some((at, format!("a tag has more than {MOST_ATTRIBUTES} attributes")));
        }
        at += 1;
    }
    None
}

fn explain(text: &str, error: &Error) -> MarkupError {
    let (offset, said) = match error {
        Error::DtdDetected => {
            let said = "it has a <!DOCTYPE>, which is not needed and not read; delete it";
            (text.find("<!DOCTYPE").unwrap_or(0), said.to_owned())
        }
        Error::NodesLimitReached => (0, format!("it has more than {MOST_NODES} tags and texts")),
        Error::UnclosedRootNode | Error::UnexpectedEndOfStream => {
            (text.trim_end().len(), "it ends before every tag is closed".to_owned())
        }
        Error::NoRootNode => (0, "it has no tag at all".to_owned()),
        other => (offset_of(text, other.pos()), without_place(&other.to_string())),
    };
    let unknown_prefix = if let Error::UnknownNamespace(prefix, _) = error { Some(prefix.clone()) } else { None };
    MarkupError { offset, said, unknown_prefix }
}

fn offset_of(text: &str, place: roxmltree::TextPos) -> usize {
    let lines_before = place.row.saturating_sub(1) as usize;
    let line_start: usize = text.split_inclusive('\n').take(lines_before).map(str::len).sum();
    let in_line = text[line_start..].chars().take(place.col.saturating_sub(1) as usize);
    line_start + in_line.map(char::len_utf8).sum::<usize>()
}

/// The parser ends its sentences with "at 3:14"; ours begin with the place.
fn without_place(said: &str) -> String {
    said.rsplit_once(" at ").map_or(said, |(sentence, _)| sentence).to_owned()
}

/// Line and column of a byte offset.
pub(crate) fn place_of(text: &str, offset: usize) -> TextPlace {
    let mut end = offset.min(text.len());
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    let before = &text[..end];
    let line_start = before.rfind('\n').map_or(0, |i| i + 1);
    TextPlace { line: before.matches('\n').count() + 1, column: before[line_start..].chars().count() + 1 }
}
