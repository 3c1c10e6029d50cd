//! Where a scenario came from: the file, its lines, the overrides, and the tree after them.

use super::{Node, Origin};
use crate::error::Place;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The text behind a scenario, kept so that later complaints still have a line, and relative paths a folder.
#[derive(Debug, Clone, Default)]
pub struct Source {
    pub(crate) file: String,
    pub(crate) text: Arc<str>,
    pub(crate) overrides: Vec<String>,
    pub(crate) root: Option<Arc<Node>>,
}

/// Where a value was written is no part of what the scenario is: two that say the same are equal.
impl PartialEq for Source {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Source {
    /// Adds an override that was made in the program, and gives it back.
    pub(crate) fn overridden(&mut self, text: String) -> String {
        self.overrides.push(text.clone());
        text
    }

    /// Name of the file, as it was given.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// The text of the file, before the overrides.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The overrides, as they were given.
    pub fn overrides(&self) -> &[String] {
        &self.overrides
    }

    /// The folder that relative paths start from.
    pub fn file_dir(&self) -> PathBuf {
        match Path::new(&self.file).parent() {
            Some(dir) if !dir.as_os_str().is_empty() => dir.to_owned(),
            _ => PathBuf::from("."),
        }
    }

    /// The place of an origin.
    pub(crate) fn place(&self, origin: Origin) -> Place {
        match origin {
            Origin::File(at) => self.file_place(at),
            Origin::Override(index) => Place::Override { text: self.overrides.get(index).cloned().unwrap_or_default() },
        }
    }

    /// The whole file, for what has no better place.
    pub(crate) fn whole(&self) -> Place {
        Place::Whole { file: self.file.clone() }
    }

    /// Line and column of a byte.
    fn file_place(&self, at: usize) -> Place {
        let at = (0..=at.min(self.text.len())).rev().find(|i| self.text.is_char_boundary(*i)).unwrap_or(0);
        let before = &self.text[..at];
        let start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line_text = self.text[start..].lines().next().unwrap_or("");
        Place::File {
            file: self.file.clone(),
            line: before.matches('\n').count() + 1,
            column: self.text[start..at].chars().count() + 1,
            excerpt: super::shortened(line_text.trim()),
        }
    }
}
