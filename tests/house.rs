//! The house keeps its order: crates use only what is to their left, files stay short, the top level stays bare.
#![allow(clippy::unwrap_used)]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The one total order.
const ORDER: [&str; 11] = [
    "spatial",
    "friction",
    "contact",
    "multibody",
    "sim",
    "record",
    "lab",
    "scenario",
    "campaign",
    "diagnose",
    "score",
];

/// Modules of `sim` in layers: each uses only itself and what is to its left.
const SIM: [&str; 10] =
    ["error", "parts", "model", "state", "workspace", "forces", "books", "solve", "schemes", "world"];

/// Crates some of whose top-level modules still use each other in circles, with how many do; none may be added.
const IN_CIRCLES: [(&str, usize); 3] = [("contact", 10), ("scenario", 9), ("diagnose", 29)];

/// The wall.
const LONGEST_FILE: usize = 600;

/// What a newcomer reads in one go.
const LONGEST_README: usize = 200;

/// Files that the documents tell a reader to write.
const WRITTEN_BY_THE_READER: [&str; 2] = ["scenarios/my-capture.toml", "scenarios/guide.toml"];

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

/// Per top-level module of a crate the others that it names, by `crate::…` or, at the top, `super::…`.
fn module_uses(name: &str) -> BTreeMap<String, BTreeSet<String>> {
    let src = root().join("crates").join(name).join("src");
    let mut files = Vec::new();
    sources(&src, &mut files);
    let top =
        |file: &Path| file.strip_prefix(&src).unwrap().iter().next().unwrap().to_string_lossy().replace(".rs", "");
    let names: BTreeSet<String> = files.iter().map(|f| top(f)).filter(|n| n != "lib").collect();
    let mut uses: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for file in files.iter().filter(|f| top(f) != "lib") {
        let own = top(file);
        let text = code(&fs::read_to_string(file).unwrap());
        let is_at_the_top = file.parent() == Some(&src);
        let found = uses.entry(own.clone()).or_default();
        for prefix in if is_at_the_top { &["crate::", "super::"][..] } else { &["crate::"] } {
            for after in text.split(prefix).skip(1) {
                // One path, or the first names of a group of paths.
                let group = after.strip_prefix('{').map(|g| g.split('}').next().unwrap_or_default());
                for path in group.map_or(vec![after], |g| g.split(',').map(str::trim).collect()) {
                    let first: String = path.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
                    if first != own && names.contains(&first) {
                        found.insert(first);
                    }
                }
            }
        }
    }
    uses
}

#[test]
fn modules_of_sim_use_only_what_is_to_their_left() {
    let uses = module_uses("sim");
    assert_eq!(uses.keys().map(String::as_str).collect::<BTreeSet<_>>(), SIM.into_iter().collect(), "a layer each");
    let place = |name: &str| SIM.iter().position(|n| *n == name).unwrap();
    for (name, used) in &uses {
        for other in used {
            assert!(place(other) < place(name), "sim's {name} uses {other}, which stands to its right");
        }
    }
}

#[test]
fn modules_form_no_circles() {
    let mut debts = Vec::new();
    for name in ORDER {
        let uses = module_uses(name);
        let mut reached = uses.clone();
        for _ in 0..uses.len() {
            for (module, known) in &mut reached {
                let more = known.iter().filter(|o| *o != module).flat_map(|o| &uses[o]).cloned().collect::<Vec<_>>();
                known.extend(more);
            }
        }
        let circling = reached.iter().filter(|(module, reached)| reached.contains(*module)).count();
        if circling > 0 {
            debts.push((name, circling));
        }
    }
    assert_eq!(debts, IN_CIRCLES, "modules in circles: break a new one, and lower the figure where one is gone");
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

/// Lines of a function in `src`, its signature among them.
const LONGEST_FUNCTION: usize = 60;

#[test]
fn no_function_is_longer_than_a_page() {
    let mut files = Vec::new();
    sources(&root().join("crates"), &mut files);
    files.retain(|f| f.components().any(|c| c.as_os_str() == "src"));
    let mut seen = 0;
    for file in files {
        let text = fs::read_to_string(&file).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        for (at, line) in lines.iter().enumerate() {
            let code = line.trim_start();
            let is_function = ["fn ", "pub fn ", "pub(crate) fn ", "pub(super) fn ", "const fn ", "pub const fn "];
            if !is_function.iter().any(|f| code.starts_with(f)) {
                continue;
            }
            seen += 1;
            let margin = " ".repeat(line.len() - code.len());
            // A body ends by a brace at the margin, what a trait only declares by a semicolon there.
            let is_end = |l: &&str| match l.strip_prefix(&margin) {
                Some("}") => true,
                Some(rest) => rest.starts_with(')') && rest.ends_with(';'),
                None => false,
            };
            let is_one_line = line.ends_with('}') || line.ends_with(';');
            let length = if is_one_line { 1 } else { 1 + lines[at..].iter().position(is_end).unwrap_or(lines.len()) };
            assert!(length <= LONGEST_FUNCTION, "{}:{}: {length} lines", file.display(), at + 1);
        }
    }
    assert!(seen > 500, "only {seen} functions were seen");
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

#[test]
fn the_readme_is_short() {
    let lines = fs::read_to_string(root().join("README.md")).unwrap().lines().count();
    assert!(
        lines <= LONGEST_README,
        "README.md has {lines} lines; tables belong to tests/tables, how-tos to the guide"
    );
}

/// Files that still tell effects by their names: forces that a place could miss stand for effects there.
const TELL_BY_NAME: [&str; 1] = ["locate.rs"];

/// The product code of a file: without its tests and comments.
fn code(text: &str) -> String {
    let product = text.split("#[cfg(test)]").next().unwrap_or(text);
    product.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
}

/// An effect's name is in its definition; what else speaks of the effect does so by the definition, so that nothing can forget it.
#[test]
fn no_effect_is_told_by_its_name_outside_its_definition() {
    let mut files = Vec::new();
    sources(&root().join("crates"), &mut files);
    files.retain(|f| !f.components().any(|c| ["tests", "examples"].iter().any(|skipped| c.as_os_str() == *skipped)));
    files.retain(|f| !f.starts_with(root().join("crates/scenario/src/effects")) && !f.ends_with("tests.rs"));
    files.retain(|f| !TELL_BY_NAME.iter().any(|name| f.ends_with(name)));
    // A single word may be a word.
    let names: Vec<&str> = softdock::scenario::effects::models().map(|e| e.name).filter(|n| n.contains('-')).collect();
    assert!(names.len() > 40 && files.len() > 200);
    for file in files {
        let code = code(&fs::read_to_string(&file).unwrap());
        let told = names.iter().find(|name| code.contains(&format!("\"{name}\"")));
        assert!(
            told.is_none(),
            "{} tells an effect by its name, {told:?}; use its definition in scenario::effects",
            file.display()
        );
    }
}

/// The README, the tables of results and the guide.
fn documents() -> Vec<PathBuf> {
    let mut found = vec![root().join("README.md")];
    for folder in ["tests/tables", "crates/cli/guide"] {
        let entries = fs::read_dir(root().join(folder)).unwrap().map(|e| e.unwrap().path());
        found.extend(entries.filter(|p| p.extension().is_some_and(|e| e == "md")));
    }
    found
}

/// Words of a text that are paths from the repository's root.
fn paths_in(text: &str) -> impl Iterator<Item = &str> {
    let words = text.split(|c: char| c.is_whitespace() || "`()[]'\"<>,;|".contains(c));
    let folders = ["tests/", "scenarios/", "robots/", "crates/", "benches/", ".ci/"];
    let words = words.map(|word| word.trim_end_matches(['.', ':', '/']));
    words.filter(move |word| folders.iter().any(|folder| word.starts_with(folder)))
}

/// Targets of a text's links and pictures that are files.
fn links_in(text: &str) -> impl Iterator<Item = &str> {
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    // Of the guide, links to items (`crate::…`, `mod@…`) and to sections are the business of rustdoc.
    targets.filter(|target| !target.contains("::") && !target.starts_with(['#', '@']) && target.contains(['.', '/']))
}

#[test]
fn what_the_documents_name_exists() {
    let (mut paths, mut links) = (0, 0);
    for document in documents() {
        let text = fs::read_to_string(&document).unwrap();
        for path in paths_in(&text).filter(|path| !WRITTEN_BY_THE_READER.contains(path)) {
            assert!(root().join(path).exists(), "{} names {path}, which does not exist", document.display());
            paths += 1;
        }
        for link in links_in(&text).filter(|link| !link.contains("://")) {
            let target = document.with_file_name(link);
            assert!(target.exists(), "{} links to {link}, which does not exist", document.display());
            links += 1;
        }
    }
    assert!(paths > 50 && links > 10, "the walk found only {paths} paths and {links} links");
}
