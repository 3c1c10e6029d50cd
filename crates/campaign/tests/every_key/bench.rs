//! Benches: scenarios in which keys matter, with the variations that show it in their comments.
//!
//! | line | says |
//! | --- | --- |
//! | `#~ path=value` | with this override something of the run differs |
//! | `#~ path=value & path=value \| path=value` | the same, after the overrides before the bar |
//! | `#! path=value -> words` | this override is refused, in these words |
//! | `{a\|b}` in such a line | one line for each |

use std::fs;
use std::path::{Path, PathBuf};

/// A scenario and its variations.
pub struct Bench {
    pub name: String,
    pub file: PathBuf,
    pub text: String,
    pub variations: Vec<Variation>,
}

/// A change of one key, or of two that exclude each other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Variation {
    /// Overrides before the comparison.
    pub given: Vec<String>,
    /// Overrides that must show.
    pub change: Vec<String>,
    /// What is said where they are refused.
    pub refusal: Option<String>,
}

/// The benches beside this file, in order.
pub fn all() -> Vec<Bench> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/every_key");
    let entries = fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut files: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).collect();
    files.retain(|file| file.extension().is_some_and(|e| e == "toml"));
    files.sort();
    files.into_iter().map(read).collect()
}

fn read(file: PathBuf) -> Bench {
    let text = fs::read_to_string(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    let name = file.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let variations = text.lines().flat_map(variations_of).collect();
    Bench { name, file, text, variations }
}

fn variations_of(line: &str) -> Vec<Variation> {
    let said = ["#~ ", "#! "].iter().find_map(|mark| Some((*mark == "#! ", line.split_once(mark)?.1)));
    let Some((is_refused, rest)) = said else { return Vec::new() };
    expanded(rest).iter().map(|rest| variation(rest, is_refused)).collect()
}

fn variation(rest: &str, is_refused: bool) -> Variation {
    let (change, refusal) = match rest.split_once(" -> ") {
        Some((change, words)) if is_refused => (change, Some(words.trim().to_owned())),
        _ => (rest, None),
    };
    let (given, change) = change.split_once(" | ").unwrap_or(("", change));
    let overrides =
        |text: &str| text.split(" & ").map(str::trim).filter(|t| !t.is_empty()).map(str::to_owned).collect();
    Variation { given: overrides(given), change: overrides(change), refusal }
}

/// `{a|b}.c` is `a.c` and `b.c`; tables of TOML have no bar.
fn expanded(text: &str) -> Vec<String> {
    let choice = text.match_indices('{').find_map(|(open, _)| {
        let close = open + text[open..].find(['}', '=', ' '])?;
        text[close..].starts_with('}').then_some((open, close)).filter(|_| text[open..close].contains('|'))
    });
    let Some((open, close)) = choice else { return vec![text.to_owned()] };
    // The same choice again in the line is the same word.
    let (choice, words) = (&text[open..=close], text[open + 1..close].split('|'));
    words.flat_map(|word| expanded(&text.replace(choice, word))).collect()
}

impl Bench {
    /// The scenario with overrides.
    pub fn with(&self, overrides: &[String]) -> Result<scenario::Scenario, String> {
        let file = self.file.display().to_string();
        scenario::parse(&self.text, &file, overrides).map_err(|e| e.to_string())
    }
}

#[test]
fn a_line_in_braces_is_one_for_each_word() {
    let of = |line: &str| -> Vec<String> { variations_of(line).into_iter().flat_map(|v| v.change).collect() };
    assert_eq!(of("x = 1 #~ {a|b}.c=1 | {a|b}.c={ d = 1 }"), ["a.c={ d = 1 }", "b.c={ d = 1 }"]);
    let line = variations_of("#! a=1 & b=2 | c=3 -> no such thing");
    let told = Variation {
        given: vec!["a=1".to_owned(), "b=2".to_owned()],
        change: vec!["c=3".to_owned()],
        refusal: Some("no such thing".to_owned()),
    };
    assert_eq!(line, [told]);
}
