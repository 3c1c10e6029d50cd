//! What tests that plant effects share.

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
