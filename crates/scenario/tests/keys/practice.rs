//! Where the practice recordings and their answer keys are.

use std::path::{Path, PathBuf};

/// Their folder: `$SOFTDOCK_RECORDINGS` or `../shared/recordings` beside the checkout; without either the test says that it
/// shows nothing.
pub fn practice() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/recordings");
    let named = std::env::var_os("SOFTDOCK_RECORDINGS").filter(|folder| !folder.is_empty());
    let folder = named.map_or(beside, PathBuf::from);
    // The variable may also name what stands beside `practice`: `real`.
    let found = [folder.join("practice"), folder.join("../practice")].into_iter().find(|dir| dir.is_dir());
    if found.is_none() {
        println!("SKIPPED: no recordings; set SOFTDOCK_RECORDINGS to the folder that holds practice/");
    }
    found
}
