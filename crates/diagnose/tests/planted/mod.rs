//! What tests that plant effects share.

#![allow(dead_code)] // Each test takes what it needs.

use diagnose::diagnosis::{Diagnosis, Verdict};
use scenario::spec::{Effect, ParamValue};
use std::path::{Path, PathBuf};

/// The repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// An `[[effect]]` entry.
pub fn effect(name: &str, place: &str, params: &[(&str, ParamValue)]) -> Effect {
    let params = params.iter().map(|(k, v)| ((*k).to_owned(), v.clone())).collect();
    Effect { name: name.to_owned(), place: place.to_owned(), params }
}

/// A number.
pub fn number(x: f64) -> ParamValue {
    ParamValue::Number(x)
}

/// Right name and place, and predictions of the unseen run that noise alone limits.
pub fn check(diagnosis: &Diagnosis, planted: &Effect) {
    let found: Vec<(&str, &str)> = diagnosis.effects.iter().map(|e| (e.name.as_str(), e.place.as_str())).collect();
    assert_eq!(diagnosis.verdict, Verdict::Explained, "{planted:?}: {found:?} {:?}", diagnosis.error);
    assert_eq!(found, [(planted.name.as_str(), planted.place.as_str())], "{:?}", diagnosis.effects);
    let holdout = diagnosis.error.holdout.unwrap();
    // Nothing restores a hinge: where it sticks and slips, free runs go apart under the true model too, and windows judge.
    let after = holdout.after.min(diagnosis.error.windowed.after);
    assert!(after < 1.06 && holdout.before > 1.15 * holdout.after, "{planted:?}: {:?}", diagnosis.error);
}

/// The number that was planted comes back within a tenth.
pub fn check_number(diagnosis: &Diagnosis, key: &str, planted: f64) {
    let found = diagnosis.effects[0].params[key].numbers().unwrap()[0];
    assert!((found / planted - 1.0).abs() < 0.1, "{key}: {found}, planted {planted}");
}
