//! The committed reference values; their format is described in tests/pinocchio/generate.py.

use serde_json::Value;
use spatial::Vec3;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Name of the base in keys and scales.
pub const BASE: &str = "base";

/// One robot with one kind of base.
pub struct Model {
    pub name: String,
    pub base_free: bool,
    pub urdf: PathBuf,
    pub links: Vec<String>,
    pub columns: Vec<String>,
    /// Mass and moments that the free root is given where its file has none.
    pub ballast: Option<(f64, Vec3)>,
    /// Inertia that every joint freedom is given on top of its bodies'.
    pub armature: f64,
    /// Per joint (and `BASE`): quantity → exponents of the typical sizes.
    pub scales: BTreeMap<String, BTreeMap<String, Vec<i32>>>,
    /// One per state.
    pub rows: Vec<Vec<f64>>,
}

/// A file of the index with its numbers.
pub struct Set {
    pub gravity: Vec3,
    pub models: Vec<Model>,
}

/// Folder of the fixtures.
fn folder() -> PathBuf {
    repository().join("tests/pinocchio")
}

pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Reads a set; `None`, loudly, if its robots are somebody else's and not on this machine.
pub fn load(set: &str) -> Option<Set> {
    load_from(&folder(), set)
}

/// As [`load`], from another folder than the committed one.
pub fn load_from(folder: &Path, set: &str) -> Option<Set> {
    let index = read_index(folder, set);
    let bytes = std::fs::read(folder.join(format!("{set}.f64"))).unwrap();
    let mut numbers = bytes.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap()));
    let states = index["states"].as_u64().unwrap() as usize;
    let mut models = Vec::new();
    for entry in index["models"].as_array().unwrap() {
        let mut model = read_model(entry)?;
        let width = 2 * model.links.len() + model.columns.len();
        model.rows = (0..states).map(|_| numbers.by_ref().take(width).collect()).collect();
        models.push(model);
    }
    assert_eq!(numbers.next(), None, "{set}.f64 and {set}.json do not belong together");
    Some(Set { gravity: vector(&index["gravity"]), models })
}

/// The index of a set.
pub fn read_index(folder: &Path, set: &str) -> Value {
    serde_json::from_str(&std::fs::read_to_string(folder.join(format!("{set}.json"))).unwrap()).unwrap()
}

fn read_model(entry: &Value) -> Option<Model> {
    let ballast = &entry["ballast"];
    Some(Model {
        name: entry["name"].as_str().unwrap().to_owned(),
        base_free: entry["base"] == "free",
        urdf: locate(entry)?,
        links: serde_json::from_value(entry["links"].clone()).unwrap(),
        columns: serde_json::from_value(entry["columns"].clone()).unwrap(),
        ballast: ballast["mass"].as_f64().map(|mass| (mass, vector(&ballast["tensor"]))),
        armature: entry["armature"].as_f64().unwrap_or(0.0),
        scales: serde_json::from_value(entry["scales"].clone()).unwrap(),
        rows: Vec::new(),
    })
}

fn locate(entry: &Value) -> Option<PathBuf> {
    let path = entry["urdf"].as_str().unwrap();
    if entry["from"] == "repository" {
        return Some(repository().join(path));
    }
    let Some(root) = third_party() else {
        eprintln!(
            "SKIPPED {}: SOFTDOCK_THIRD_PARTY_ROBOTS is not set; set it to a site-packages folder with \
             example-robot-data and pybullet (tests/pinocchio/generate.py says how)",
            entry["name"]
        );
        return None;
    };
    Some(root.join(path))
}

/// Site-packages folder of the third-party robots.
pub fn third_party() -> Option<PathBuf> {
    std::env::var_os("SOFTDOCK_THIRD_PARTY_ROBOTS").map(PathBuf::from)
}

fn vector(value: &Value) -> Vec3 {
    let [x, y, z]: [f64; 3] = serde_json::from_value(value.clone()).unwrap();
    Vec3::new(x, y, z)
}
