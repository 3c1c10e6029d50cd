//! Collects what cannot be built, each fault with its place in the file.

use crate::error::{Place, Problem, ScenarioError, ScenarioErrors};
use crate::overrides::select;
use crate::spec::Scenario;
use crate::spelling::hint_for_name;

/// The faults found so far.
#[derive(Debug)]
pub(crate) struct Faults<'a> {
    scenario: &'a Scenario,
    errors: Vec<ScenarioError>,
}

impl<'a> Faults<'a> {
    pub(crate) fn new(scenario: &'a Scenario) -> Self {
        Self { scenario, errors: Vec::new() }
    }

    /// Faults of the same scenario that nobody will be told.
    pub(crate) fn silent(of: &Self) -> Self {
        Self::new(of.scenario)
    }

    /// Something at the path of a key (`vehicle[0].urdf`, empty for the whole file) cannot be built.
    pub(crate) fn add(&mut self, key: &str, reason: impl Into<String>) {
        let problem = Problem::Unbuildable { key: key.to_owned(), reason: reason.into() };
        self.errors.push(ScenarioError { place: self.place(key), problem });
    }

    /// A name at the path of a key means nothing that exists.
    pub(crate) fn unknown<'n>(
        &mut self,
        key: &str,
        what: &str,
        name: &str,
        valid: impl IntoIterator<Item = &'n str> + Clone,
    ) {
        let hint = hint_for_name(name, valid);
        let problem = Problem::UnknownName { key: key.to_owned(), what: what.to_owned(), name: name.to_owned(), hint };
        self.errors.push(ScenarioError { place: self.place(key), problem });
    }

    /// A fault that another check has found.
    pub(crate) fn push(&mut self, error: ScenarioError) {
        self.errors.push(error);
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.errors.is_empty()
    }

    pub(crate) fn into_errors(self) -> ScenarioErrors {
        ScenarioErrors::new(self.errors)
    }

    /// The place of a key, or of the nearest table above it that the file has.
    fn place(&self, key: &str) -> Place {
        let source = &self.scenario.source;
        let mut path = key;
        while let Some(root) = source.root.as_deref().filter(|_| !path.is_empty()) {
            if let Ok(found) = select(root, path)
                && let Some((_, node)) = found.first()
            {
                return source.place(node.origin);
            }
            path = path.rfind(['.', '[']).map_or("", |at| &path[..at]);
        }
        source.whole()
    }
}
