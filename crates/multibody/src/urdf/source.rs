//! The URDF's text as XML, with byte offsets into the text as it was given.
//!
//! Undeclared prefixes (`<drake:…>` without `xmlns:drake`) are an XML error, but common in URDF files and harmless to
//! those who pass over vendor tags. They are declared in a copy of the text, and offsets are taken back to the original.
//! A byte order mark, and blanks before an XML declaration, are cut off.

use crate::mesh::markup::{MarkupError, parse_bounded};
use roxmltree::Document;
use std::borrow::Cow;

/// Undeclared prefixes mended in one file.
const MOST_PREFIXES: usize = 32;

/// The text with its undeclared prefixes declared.
pub(crate) struct Source<'a> {
    /// Bytes cut off at the start.
    cut: usize,
    /// Whether there were blanks among them.
    pub(crate) begins_with_blanks: bool,
    text: Cow<'a, str>,
    inserted_at: usize,
    inserted: usize,
}

impl<'a> Source<'a> {
    /// Tries the text, declaring prefixes until it parses or is wrong in another way.
    pub(crate) fn mended(whole: &'a str) -> Self {
        let marked = whole.strip_prefix('\u{feff}').unwrap_or(whole);
        let begins_with_blanks = marked.trim_start().starts_with("<?xml") && !marked.starts_with("<?xml");
        let text = if begins_with_blanks { marked.trim_start() } else { marked };
        let cut = whole.len() - text.len();
        let mut declarations = String::new();
        let mut source = Source { cut, begins_with_blanks, text: Cow::Borrowed(text), inserted_at: 0, inserted: 0 };
        let Some(inserted_at) = find_root_name_end(text) else { return source };
        for _ in 0..MOST_PREFIXES {
            let Some(prefix) = source.parse().err().and_then(|e| e.unknown_prefix) else { break };
            declarations.push_str(&format!(" xmlns:{prefix}=\"undeclared:{prefix}\""));
            let mended = [&text[..inserted_at], &declarations, &text[inserted_at..]].concat();
            source = Source { text: Cow::Owned(mended), inserted_at, inserted: declarations.len(), ..source };
        }
        source
    }

    /// The XML tree.
    pub(crate) fn parse(&self) -> Result<Document<'_>, MarkupError> {
        parse_bounded(&self.text)
    }

    /// Offset in the text as it was given.
    pub(crate) fn original_offset(&self, offset: usize) -> usize {
        let in_text = if offset >= self.inserted_at + self.inserted {
            offset - self.inserted
        } else {
            offset.min(self.inserted_at)
        };
        self.cut + in_text
    }
}

/// End of the outermost tag's name: where a declaration can be inserted.
fn find_root_name_end(text: &str) -> Option<usize> {
    let mut at = 0;
    loop {
        at += text[at..].find('<')?;
        let rest = &text[at..];
        at += if rest.starts_with("<!--") {
            rest.find("-->")?
        } else if rest.starts_with("<?") {
            rest.find("?>")?
        } else {
            return rest.find(|c: char| c.is_whitespace() || c == '>' || c == '/').map(|end| at + end);
        };
    }
}
