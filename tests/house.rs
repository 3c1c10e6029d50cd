//! The house keeps its order: crates use only what is to their left, files stay short, the top level stays bare.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The one total order.
const ORDER: [&str; 10] =
    ["spatial", "friction", "contact", "multibody", "sim", "record", "lab", "scenario", "campaign", "diagnose"];

/// The wall.
const LONGEST_FILE: usize = 600;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn sources(dir: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(dir).unwrap().map(Result::unwrap) {
        let path = entry.path();
        if path.is_dir() && !path.ends_with("target") {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

/// Names of softdock's crates in a manifest's section.
fn uses(manifest: &str, section: &str) -> Vec<String> {
    let start = manifest.find(&format!("[{section}]")).map(|at| &manifest[at..]);
    let body = start.map_or("", |s| s[1..].split("\n[").next().unwrap_or(""));
    let name = |line: &str| line.split(['.', ' ', '=']).next().unwrap_or("").to_owned();
    body.lines().map(name).filter(|n| ORDER.contains(&n.as_str())).collect()
}

#[test]
fn crates_use_only_what_is_to_their_left() {
    for (place, name) in ORDER.iter().enumerate() {
        let manifest = fs::read_to_string(root().join("crates").join(name).join("Cargo.toml")).unwrap();
        for used in uses(&manifest, "dependencies").into_iter().chain(uses(&manifest, "dev-dependencies")) {
            let other = ORDER.iter().position(|o| *o == used).unwrap();
            assert!(other < place, "{name} uses {used}, which stands to its right");
        }
    }
}

#[test]
fn every_crate_is_in_the_order() {
    let on_disk: BTreeSet<String> = fs::read_dir(root().join("crates"))
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .filter(|n| n != "cli")
        .collect();
    assert_eq!(on_disk, ORDER.iter().map(|s| (*s).to_owned()).collect());
}

#[test]
fn no_file_is_longer_than_the_wall() {
    let mut files = Vec::new();
    for dir in ["crates", "tests", "benches"] {
        sources(&root().join(dir), &mut files);
    }
    assert!(files.len() > 50, "the walk found only {} files", files.len());
    for file in files {
        let lines = fs::read_to_string(&file).unwrap().lines().count();
        assert!(lines <= LONGEST_FILE, "{} has {lines} lines; find the seam", file.display());
    }
}

#[test]
fn the_top_level_is_bare() {
    let allowed = [
        "Cargo.toml",
        "Cargo.lock",
        "LICENSE-MIT",
        "LICENSE-APACHE",
        "README.md",
        "rust-toolchain.toml",
        "crates",
        "robots",
        "scenarios",
        "tests",
        "benches",
        "target",
        "out",
    ];
    for entry in fs::read_dir(root()).unwrap().map(Result::unwrap) {
        let name = entry.file_name().into_string().unwrap();
        assert!(name.starts_with('.') || allowed.contains(&name.as_str()), "{name} does not belong at the top level");
    }
}
