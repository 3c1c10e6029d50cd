//! File and overrides → checked [`Scenario`]; and back.

use crate::document::{Node, Origin, Source, read_document};
use crate::error::{MOST_ERRORS, Place, Problem, ScenarioError, ScenarioErrors};
use crate::overrides;
use crate::schema::check;
use crate::spec::{ActuatorKind, Scenario};
use crate::spelling::hint_for_name;
use serde::Deserialize;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Largest scenario file that is read, bytes; more is a recording or a mistake.
const LARGEST_FILE: u64 = 16 << 20;

/// Loads a scenario file and applies `overrides` (`path=value`) in order.
///
/// Either everything is right, or every fault is told at once.
pub fn load(path: &Path, overrides: &[String]) -> Result<Scenario, ScenarioErrors> {
    let file = path.display().to_string();
    let unreadable = |reason: String| {
        let place = Place::Whole { file: file.clone() };
        ScenarioErrors::from(ScenarioError { place, problem: Problem::Unreadable { reason } })
    };
    let size = std::fs::metadata(path).map_err(|e| unreadable(e.to_string()))?.len();
    if size > LARGEST_FILE {
        return Err(unreadable(format!("it has {size} bytes, more than any scenario")));
    }
    let text = std::fs::read_to_string(path).map_err(|e| unreadable(e.to_string()))?;
    parse(&text, &file, overrides)
}

/// Parses the text of a scenario; `file_name` names it in errors, and its folder is where relative paths start.
pub fn parse(text: &str, file_name: &str, overrides: &[String]) -> Result<Scenario, ScenarioErrors> {
    let source = Source { file: file_name.to_owned(), text: text.into(), overrides: overrides.to_vec(), root: None };
    let (mut root, faults) = read_document(text);
    if !faults.is_empty() {
        let error = |fault: crate::document::SyntaxFault| ScenarioError {
            place: source.place(Origin::File(fault.at)),
            problem: Problem::Syntax { what: fault.what },
        };
        return Err(all_of(faults.into_iter().take(MOST_ERRORS + 1).map(error).collect(), &source));
    }
    let errors = apply_all(&mut root, &source);
    finish(root, source, errors)
}

/// The scenario of a tree, checked as a whole.
fn finish(root: Node, mut source: Source, mut errors: Vec<ScenarioError>) -> Result<Scenario, ScenarioErrors> {
    errors.extend(check(&root, &source));
    if !errors.is_empty() {
        return Err(all_of(errors, &source));
    }
    let mut scenario = deserialise(&root, &source)?;
    source.root = Some(Arc::new(root));
    scenario.source = source;
    Ok(scenario)
}

/// The errors in order; of very many the first, and that there are more.
fn all_of(errors: Vec<ScenarioError>, source: &Source) -> ScenarioErrors {
    let mut all = ScenarioErrors::new(errors);
    if all.errors.len() > MOST_ERRORS {
        all.errors.truncate(MOST_ERRORS);
        all.errors.push(ScenarioError { place: source.whole(), problem: Problem::TooMany });
    }
    all
}

/// Applies the overrides one after the other; one that fails changes nothing.
fn apply_all(root: &mut Node, source: &Source) -> Vec<ScenarioError> {
    let mut errors = Vec::new();
    for (index, text) in source.overrides.iter().enumerate() {
        let mut changed = root.clone();
        match overrides::apply(&mut changed, text, index) {
            Ok(()) => *root = changed,
            Err(problem) => errors.push(ScenarioError { place: source.place(Origin::Override(index)), problem }),
        }
    }
    errors
}

/// The typed scenario. What the schema has passed the types take; should they ever not, the message says where.
fn deserialise(root: &Node, source: &Source) -> Result<Scenario, ScenarioErrors> {
    Scenario::deserialize(root.to_toml()).map_err(|error| {
        let what = error.to_string().trim().replace('\n', "; ");
        ScenarioErrors::from(ScenarioError { place: source.whole(), problem: Problem::Syntax { what } })
    })
}

/// The scenario as TOML, with every default written out and every override in it: the exact inputs of a run.
///
/// Relative paths stay as they are, relative to the folder of the original file.
pub fn to_toml(scenario: &Scenario) -> String {
    // Every type of the specification has a TOML form, so the fallback is never taken.
    toml::to_string(scenario).unwrap_or_default()
}

impl Scenario {
    /// A path of the file, relative to the file's folder, as one that can be opened.
    pub fn resolve(&self, path: &str) -> PathBuf {
        self.source.file_dir().join(path)
    }

    /// The values at a path, as for `--set`, each with its own full path; defaults included.
    pub fn value_at(&self, path: &str) -> Result<Vec<(String, toml::Value)>, Problem> {
        let (root, _) = read_document(&to_toml(self));
        let found = overrides::select(&root, path)?;
        Ok(found.into_iter().map(|(path, node)| (path, node.to_toml())).collect())
    }

    /// The scenario with numbers put at paths and another seed, checked as a whole again: a run of a campaign.
    pub fn with_numbers(&self, numbers: &[(&str, f64)], seed: u64) -> Result<Self, ScenarioErrors> {
        let mut source = self.source.clone();
        let Some(root) = source.root.take() else {
            return Err(ScenarioErrors::from(self.complaint("", "it was made by a program, not read from a file")));
        };
        let (mut root, mut errors) = ((*root).clone(), Vec::new());
        let seed = ("seed", format!("{seed}"));
        for (path, text) in numbers.iter().map(|(path, value)| (*path, format!("{value:?}"))).chain([seed]) {
            let index = source.overrides.len();
            source.overrides.push(format!("{path}={text}"));
            // What fails leaves a tree that nobody will see.
            if let Err(problem) = overrides::apply(&mut root, &source.overrides[index], index) {
                errors.push(ScenarioError { place: source.place(Origin::Override(index)), problem });
            }
        }
        finish(root, source, errors)
    }

    /// Sets the speed at which an actuator no longer pushes its joints on, rad/s or m/s, and gives the override that does the same.
    ///
    /// Other kinds of actuators have no such key: none.
    pub fn set_speed_limit(&mut self, actuator: usize, (limit, slides): (f64, bool)) -> Option<String> {
        let key = if slides { "speed_limit_m_per_s" } else { "speed_limit_rad_per_s" };
        self.set_limit((actuator, key), limit, |kind| kind.joint_speed_limit_mut(slides))
    }

    /// Sets what an actuator delivers at most to its joints, N·m or N, and gives the override that does the same.
    ///
    /// Other kinds of actuators have no such key: none.
    pub fn set_effort_limit(&mut self, actuator: usize, (limit, slides): (f64, bool)) -> Option<String> {
        let key = if slides { "limit_n" } else { "limit_n_m" };
        self.set_limit((actuator, key), limit, |kind| kind.joint_effort_limit_mut(slides))
    }

    /// Takes the stops from a joint of a vehicle, and gives the override that does the same.
    pub fn lift_stops(&mut self, vehicle: usize, joint: &str) -> Option<String> {
        let list = &mut self.vehicles.get_mut(vehicle)?.unstopped_joints;
        list.push(joint.to_owned());
        let text = format!("vehicle[{vehicle}].unstopped_joints={list:?}");
        Some(self.source.overridden(text))
    }

    /// Sets a limit of an actuator where it has that key.
    fn set_limit(
        &mut self,
        (actuator, key): (usize, &str),
        limit: f64,
        of: impl FnOnce(&mut ActuatorKind) -> Option<&mut Option<f64>>,
    ) -> Option<String> {
        of(&mut self.actuators.get_mut(actuator)?.kind)?.replace(limit);
        Some(self.source.overridden(format!("actuator[{actuator}].{key}={limit:?}")))
    }

    /// Where a value was written: the nearest place in the file, or the override that set it.
    ///
    /// `path` is as for `--set`. Of a path that the file leaves out, the innermost table that is there is given.
    pub fn place(&self, path: &str) -> Place {
        let Some(root) = &self.source.root else { return self.source.whole() };
        let mut path = path;
        loop {
            if let Ok(found) = overrides::select(root, path)
                && let Some((_, node)) = found.first()
            {
                return self.source.place(node.origin);
            }
            match path.rfind(['.', '[']) {
                Some(end) => path = &path[..end],
                None => return self.source.whole(),
            }
        }
    }

    /// A complaint about the value at `path`, for whoever builds the model and finds it cannot.
    pub fn complaint(&self, path: &str, reason: impl Into<String>) -> ScenarioError {
        let problem = Problem::Unbuildable { key: path.to_owned(), reason: reason.into() };
        ScenarioError { place: self.place(path), problem }
    }

    /// A complaint that the value at `path` names no `what` (link, joint, …); `valid` are those that exist.
    pub fn unknown_name<'n>(
        &self,
        path: &str,
        (what, name): (&str, &str),
        valid: impl IntoIterator<Item = &'n str> + Clone,
    ) -> ScenarioError {
        let hint = hint_for_name(name, valid);
        let problem = Problem::UnknownName { key: path.to_owned(), what: what.to_owned(), name: name.to_owned(), hint };
        ScenarioError { place: self.place(path), problem }
    }
}
