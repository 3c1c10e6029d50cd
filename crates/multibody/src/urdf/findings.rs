//! What was found in a URDF file: each thing once, with its place, in the order of the file.

use super::doubts::UrdfDoubt;
use super::errors::UrdfProblem;
use super::source::Source;
use crate::mesh::markup::{TextPlace, place_of};
use std::path::{Path, PathBuf};

/// No file needs more of a sort to be mended; the rest is counted.
const MOST_KEPT: usize = 100;

/// One thing that was found: `file:line:column: subject: what`.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}{}: {subject}: {what}", .file.display(), written(.place))]
pub struct UrdfFinding<W> {
    /// The file, as the caller named it.
    pub file: PathBuf,
    /// Where in the file; `None` if it is about the whole file.
    pub place: Option<TextPlace>,
    /// What it is about: `link "palm"`, `joint "elbow"`.
    pub subject: String,
    /// What was found, and a way out.
    pub what: W,
}

/// One thing that is wrong.
pub type UrdfError = UrdfFinding<UrdfProblem>;
/// One thing that is doubtful.
pub type UrdfWarning = UrdfFinding<UrdfDoubt>;

fn written(place: &Option<TextPlace>) -> String {
    place.map_or_else(String::new, |p| format!(":{}:{}", p.line, p.column))
}

/// Findings of one sort, in the order of the file; long lists are cut.
#[derive(Clone, Debug, PartialEq)]
pub struct UrdfFindings<W> {
    found: Vec<UrdfFinding<W>>,
    more: usize,
}

/// All that is doubtful in a URDF that loads.
pub type UrdfWarnings = UrdfFindings<UrdfDoubt>;

impl<W> UrdfFindings<W> {
    /// In the order of the file.
    pub fn iter(&self) -> std::slice::Iter<'_, UrdfFinding<W>> {
        self.found.iter()
    }

    /// How many more there are than [`Self::iter`] gives.
    pub fn more(&self) -> usize {
        self.more
    }

    /// All of them.
    pub fn count(&self) -> usize {
        self.found.len() + self.more
    }
}

impl<W> Default for UrdfFindings<W> {
    fn default() -> Self {
        Self { found: Vec::new(), more: 0 }
    }
}

impl<W: std::fmt::Display> std::fmt::Display for UrdfFindings<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (i, finding) in self.found.iter().enumerate() {
            let newline = if i == 0 { "" } else { "\n" };
            write!(f, "{newline}{finding}")?;
        }
        if self.more > 0 {
            write!(f, "\n… and {} more", self.more)?;
        }
        Ok(())
    }
}

/// Why a URDF does not load: at least one error; and what is doubtful beside it.
#[derive(Debug)]
pub struct UrdfErrors {
    errors: UrdfFindings<UrdfProblem>,
    warnings: UrdfWarnings,
}

impl UrdfErrors {
    /// The errors, in the order of the file.
    pub fn iter(&self) -> std::slice::Iter<'_, UrdfError> {
        self.errors.iter()
    }

    /// How many more there are than [`Self::iter`] gives (long lists are cut).
    pub fn more(&self) -> usize {
        self.errors.more
    }

    /// What is doubtful in the same file.
    pub fn warnings(&self) -> &UrdfWarnings {
        &self.warnings
    }

    pub(crate) fn of_file(file: &Path, problem: UrdfProblem) -> Self {
        let error = UrdfError { file: file.into(), place: None, subject: "URDF".into(), what: problem };
        Self { errors: UrdfFindings { found: vec![error], more: 0 }, warnings: UrdfWarnings::default() }
    }
}

impl std::fmt::Display for UrdfErrors {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.errors.fmt(f)
    }
}

impl std::error::Error for UrdfErrors {}

/// Findings of one sort with their byte offsets, while a file is checked.
struct Kept<W> {
    found: Vec<(usize, UrdfFinding<W>)>,
    more: usize,
}

impl<W> Kept<W> {
    fn is_full(&self) -> bool {
        self.found.len() >= MOST_KEPT
    }

    fn in_order(mut self) -> UrdfFindings<W> {
        self.found.sort_by_key(|(offset, _)| *offset);
        UrdfFindings { found: self.found.into_iter().map(|(_, finding)| finding).collect(), more: self.more }
    }
}

/// Collects what is found in one file while it is checked.
pub(crate) struct Findings<'a> {
    file: &'a Path,
    text: &'a str,
    source: &'a Source<'a>,
    errors: Kept<UrdfProblem>,
    doubts: Kept<UrdfDoubt>,
}

impl<'a> Findings<'a> {
    pub(crate) fn new(file: &'a Path, text: &'a str, source: &'a Source<'a>) -> Self {
        let (errors, doubts) = (Kept { found: Vec::new(), more: 0 }, Kept { found: Vec::new(), more: 0 });
        Self { file, text, source, errors, doubts }
    }

    /// Notes a problem at a byte offset of the XML tree.
    pub(crate) fn add(&mut self, offset: usize, subject: impl Into<String>, problem: UrdfProblem) {
        if self.errors.is_full() {
            self.errors.more += 1;
            return;
        }
        let at = self.source.original_offset(offset);
        let error = self.finding(at, subject.into(), problem);
        self.errors.found.push((at, error));
    }

    /// Notes a doubt at a byte offset of the XML tree.
    pub(crate) fn doubt(&mut self, offset: usize, subject: impl Into<String>, doubt: UrdfDoubt) {
        self.doubt_at(self.source.original_offset(offset), subject.into(), doubt);
    }

    fn doubt_at(&mut self, at: usize, subject: String, doubt: UrdfDoubt) {
        if self.doubts.is_full() {
            self.doubts.more += 1;
            return;
        }
        let warning = self.finding(at, subject, doubt);
        self.doubts.found.push((at, warning));
    }

    /// Doubts about the text itself.
    pub(crate) fn doubt_text(&mut self) {
        if let Some(at) = self.text.find(char::REPLACEMENT_CHARACTER) {
            self.doubt_at(at, "URDF".into(), UrdfDoubt::NotUtf8);
        }
        if self.source.begins_with_blanks {
            self.doubt_at(0, "URDF".into(), UrdfDoubt::BlanksFirst);
        }
    }

    /// At a byte offset of the text as it was given.
    fn finding<W>(&self, at: usize, subject: String, what: W) -> UrdfFinding<W> {
        let place = Some(place_of(self.text, at));
        UrdfFinding { file: self.file.into(), place, subject, what }
    }

    /// Whether further problems are only counted: no need to word them well.
    pub(crate) fn is_full(&self) -> bool {
        self.errors.is_full()
    }

    /// Line of a byte offset, for texts that name a second place.
    pub(crate) fn line_of(&self, offset: usize) -> usize {
        if self.is_full() { 0 } else { place_of(self.text, self.source.original_offset(offset)).line }
    }

    /// Whether nothing is wrong so far.
    pub(crate) fn is_sound(&self) -> bool {
        self.errors.found.is_empty()
    }

    /// All that is wrong, and what is doubtful.
    pub(crate) fn into_errors(self) -> UrdfErrors {
        UrdfErrors { errors: self.errors.in_order(), warnings: self.doubts.in_order() }
    }

    /// All that is doubtful.
    pub(crate) fn into_warnings(self) -> UrdfWarnings {
        self.doubts.in_order()
    }
}
