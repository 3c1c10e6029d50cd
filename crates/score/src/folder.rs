//! Folders of diagnoses and keys.

use crate::{Key, ScoreTable, SetScore, score_set};
use diagnose::diagnosis::Diagnosis;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why a folder of keys cannot be used.
#[derive(Debug, Error)]
pub enum ScoreError {
    /// A folder or file cannot be read.
    #[error("{}: {reason}; the folder holds one <set>.json per set", path.display())]
    Unreadable {
        /// Which.
        path: PathBuf,
        /// What the system says.
        reason: String,
    },
    /// A key is not one.
    #[error("{}: no answer key ({reason}); it has `effects` and `oracle`", path.display())]
    NoKey {
        /// Which.
        path: PathBuf,
        /// What is missing.
        reason: String,
    },
    /// There is nothing to judge by.
    #[error("{}: no <set>.json in it; point KEYS to the folder of the answer keys", path.display())]
    NoKeys {
        /// Which.
        path: PathBuf,
    },
}

/// Judges DIAGNOSES (`<set>/diagnosis.json`, or `<set>.json`) by KEYS (`<set>.json`), set by set in the order of names.
///
/// A set without a readable diagnosis counts as wrong; with `only_present` one without any is left out.
pub fn score_folders(diagnoses: &Path, keys: &Path, only_present: bool) -> Result<ScoreTable, ScoreError> {
    let names = sets(keys)?;
    if names.is_empty() {
        return Err(ScoreError::NoKeys { path: keys.to_owned() });
    }
    let mut scores = Vec::new();
    for set in names {
        let key = load_key(&keys.join(format!("{set}.json")))?;
        match diagnosis_file(diagnoses, &set) {
            Some(file) => scores.push(score_file(&set, &file, &key)),
            None if only_present => {}
            None => scores.push(SetScore::missing(&set, &key, "no diagnosis".to_owned())),
        }
    }
    Ok(ScoreTable { sets: scores })
}

fn score_file(set: &str, file: &Path, key: &Key) -> SetScore {
    let read = || -> Result<Diagnosis, String> {
        let text = std::fs::read_to_string(file).map_err(|e| e.to_string())?;
        Diagnosis::from_json(&text).map_err(|e| e.to_string())
    };
    match read() {
        Ok(diagnosis) => score_set(set, &diagnosis, key),
        Err(reason) => SetScore::missing(set, key, format!("{} is no diagnosis: {reason}", file.display())),
    }
}

fn diagnosis_file(folder: &Path, set: &str) -> Option<PathBuf> {
    [folder.join(set).join("diagnosis.json"), folder.join(format!("{set}.json"))].into_iter().find(|f| f.is_file())
}

fn sets(keys: &Path) -> Result<BTreeSet<String>, ScoreError> {
    let unreadable = |e: std::io::Error| ScoreError::Unreadable { path: keys.to_owned(), reason: e.to_string() };
    let mut names = BTreeSet::new();
    for entry in std::fs::read_dir(keys).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        if path.extension().is_some_and(|e| e == "json") {
            names.extend(path.file_stem().map(|stem| stem.to_string_lossy().into_owned()));
        }
    }
    Ok(names)
}

fn load_key(path: &Path) -> Result<Key, ScoreError> {
    let text = std::fs::read_to_string(path)
        .map_err(|e| ScoreError::Unreadable { path: path.to_owned(), reason: e.to_string() })?;
    serde_json::from_str(&text).map_err(|e| ScoreError::NoKey { path: path.to_owned(), reason: e.to_string() })
}
