//! Loading and running scenarios in tests.
#![allow(dead_code, clippy::unwrap_used)]

use softdock::scenario::outcome::Outcome;
use softdock::scenario::{self, Mission, Scenario};
use std::fs;
use std::path::{Path, PathBuf};

/// The repository.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// All files of an extension in a folder and below, in order.
pub fn files(dir: &str, extension: &str) -> Vec<PathBuf> {
    fn walk(dir: &Path, extension: &str, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(dir).unwrap().map(Result::unwrap) {
            if entry.path().is_dir() {
                walk(&entry.path(), extension, found);
            } else if entry.path().extension().is_some_and(|e| e == extension) {
                found.push(entry.path());
            }
        }
    }
    let mut found = Vec::new();
    walk(&root().join(dir), extension, &mut found);
    found.sort();
    found
}

/// A scenario of the catalogue with overrides.
pub fn load(name: &str, overrides: &[&str]) -> Scenario {
    let overrides: Vec<String> = overrides.iter().map(|s| (*s).to_owned()).collect();
    let file = root().join("scenarios").join(format!("{name}.toml"));
    scenario::load(&file, &overrides).unwrap_or_else(|e| panic!("{e}"))
}

/// Runs a scenario to its end.
pub fn run(spec: &Scenario) -> (Mission, Outcome) {
    let mission = scenario::build(spec).unwrap_or_else(|e| panic!("{e}"));
    let done = scenario::run(mission, None, &mut []).unwrap_or_else(|e| panic!("{e}"));
    (done.mission, done.outcome)
}

/// SplitMix64: the same draws on every machine.
pub struct Draws(u64);

impl Draws {
    /// From a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    /// Uniform between two numbers.
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        low + (high - low) * ((z >> 11) as f64 / (1_u64 << 53) as f64)
    }

    /// A size between two numbers with a random sign.
    pub fn signed(&mut self, low: f64, high: f64) -> f64 {
        let size = self.uniform(low, high);
        if self.uniform(0.0, 1.0) < 0.5 { size } else { -size }
    }
}
