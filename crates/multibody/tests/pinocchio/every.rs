//! Every URDF of PyPI's example-robot-data and pybullet_data that Pinocchio loads, loads here and agrees with it: masses, frames,
//! Jacobians, RNEA, ABA, mass matrix, momenta and energies, in five random states, with fixed and free base, all mimic
//! joints freed on both sides.
//!
//! The reference is made on the spot by tests/pinocchio/every_robot.py, in the Python environment whose site-packages folder
//! SOFTDOCK_THIRD_PARTY_ROBOTS names; .ci/run makes one. Where that environment or its Pinocchio is missing, the test says
//! SKIPPED, past the capture of test output.

use crate::fixture::{self, Model, third_party};
use crate::load;
use crate::{Worst, assert_same_freedoms, compare_model};
use multibody::{LoadedUrdf, SearchPaths, UrdfErrors, load_urdf};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Largest |ours − Pinocchio's| over the sum of the magnitudes of the projected terms. Rounding of a mass matrix whose
/// scaled eigenvalues span four decades (the nearly parallel axes of a humanoid's waist) comes to 1e-12.
const LARGEST_DIFFERENCE: f64 = 1e-9;

/// The collections, with how many of their URDFs Pinocchio 4.1 loads in the versions that .ci/run installs.
const COLLECTIONS: [(&str, usize); 2] = [("example-robot-data", 68), ("pybullet_data", 88)];

/// Past the capture of test output: a test that did not run must not look like one that passed.
fn tell(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// The folder with the reference values, or why there is none.
fn make_reference() -> Result<PathBuf, String> {
    let site = third_party().ok_or("SOFTDOCK_THIRD_PARTY_ROBOTS is not set")?;
    let python = site.ancestors().nth(3).map(|venv| venv.join("bin/python3")).filter(|python| python.exists());
    let python = python.ok_or_else(|| format!("{} is not in a Python environment", site.display()))?;
    let import = Command::new(&python).args(["-c", "import pinocchio"]).output();
    if !import.is_ok_and(|done| done.status.success()) {
        return Err(format!("{} cannot import pinocchio (pip install pin==4.1.0)", python.display()));
    }
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("every_robot");
    std::fs::create_dir_all(&out).map_err(|e| e.to_string())?;
    let script = fixture::repository().join("tests/pinocchio/every_robot.py");
    let done = Command::new(&python).arg(script).arg(&site).arg(&out).output().map_err(|e| e.to_string())?;
    assert!(done.status.success(), "every_robot.py failed:\n{}", String::from_utf8_lossy(&done.stderr));
    Ok(out)
}

#[test]
fn every_urdf_that_pinocchio_loads_is_as_in_pinocchio() {
    let folder = match make_reference() {
        Ok(folder) => folder,
        Err(reason) => {
            tell(&format!("SKIPPED every URDF that Pinocchio loads: {reason}; see .ci/run"));
            return;
        }
    };
    let set = fixture::load_from(&folder, "every").unwrap();
    let mut tally = Tally::default();
    for model in &set.models {
        let Some(loaded) = tally.load(model) else { continue };
        let tree = load::freed(model, loaded.robot.clone());
        assert_same_freedoms(model, &tree);
        let mut worst = Worst::new();
        compare_model(&set, model, &tree, &mut worst);
        tally.note(model, worst);
    }
    let refused = fixture::read_index(&folder, "every")["refused"].as_array().map_or(0, Vec::len);
    tell(&tally.report(refused));
    assert!(tally.faults.is_empty(), "\n{}", tally.faults.join("\n"));
    for (collection, least) in COLLECTIONS {
        let found = tally.robots.keys().filter(|path| collection_of(path) == collection).count();
        assert!(found >= least, "{collection}: Pinocchio loads {found} URDFs, {least} were expected");
    }
}

/// What became of all robots.
#[derive(Default)]
struct Tally {
    /// By name; each is loaded once for its two bases.
    robots: BTreeMap<String, Result<LoadedUrdf, UrdfErrors>>,
    largest: (f64, String),
    with_armature: Vec<String>,
    faults: Vec<String>,
}

fn collection_of(name: &str) -> &str {
    name.split('/').next().unwrap_or(name)
}

impl Tally {
    fn load(&mut self, model: &Model) -> Option<&LoadedUrdf> {
        if !self.robots.contains_key(&model.name) {
            let loaded = load_urdf(&model.urdf, &SearchPaths::default());
            if let Err(errors) = &loaded {
                self.faults.push(format!("{} does not load:\n{errors}", model.name));
            }
            if model.armature > 0.0 {
                self.with_armature.push(model.name.clone());
            }
            self.robots.insert(model.name.clone(), loaded);
        }
        self.robots[&model.name].as_ref().ok()
    }

    fn note(&mut self, model: &Model, worst: Worst) {
        for (quantity, (difference, place)) in worst {
            let base = if model.base_free { "free" } else { "fixed" };
            let said = format!("{quantity} of {place}, {base} base");
            if difference > LARGEST_DIFFERENCE {
                self.faults.push(format!("{said}: differs by {difference:.1e}"));
            }
            if difference > self.largest.0 {
                self.largest = (difference, said);
            }
        }
    }

    fn report(&self, refused: usize) -> String {
        let counts = COLLECTIONS.map(|(collection, _)| {
            let of = || self.robots.iter().filter(|(name, _)| collection_of(name) == collection);
            let loaded = of().filter(|(_, loaded)| loaded.is_ok()).count();
            format!("{collection}: {loaded} of the {} URDFs that Pinocchio loads, load", of().count())
        });
        let doubtful = self.robots.values().flatten().filter(|loaded| loaded.warnings.count() > 0).count();
        format!(
            "\n{}; {doubtful} of them with warnings; Pinocchio refuses {refused} others\n\
             largest difference from Pinocchio: {:.1e} ({})\nwith an armature on both sides: {}\n",
            counts.join("; "),
            self.largest.0,
            self.largest.1,
            self.with_armature.join(", ")
        )
    }
}
