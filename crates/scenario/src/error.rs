//! What can be wrong with a scenario, said as sentences with a place and a way out.

use std::fmt;

/// So many faults are told at once; a file with more is not a scenario gone wrong, but something else.
pub(crate) const MOST_ERRORS: usize = 1000;

/// Where in the input something is wrong.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// A position in the file.
    File {
        /// Name of the file, as given.
        file: String,
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// The line itself, trimmed.
        excerpt: String,
    },
    /// A value that came with `--set`.
    Override {
        /// The override, as given.
        text: String,
    },
    /// The file as a whole.
    Whole {
        /// Name of the file, as given.
        file: String,
    },
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File { file, line, column, .. } => write!(f, "{file}:{line}:{column}"),
            Self::Override { text } => write!(f, "--set '{text}'"),
            Self::Whole { file } => write!(f, "{file}"),
        }
    }
}

/// What is wrong.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Problem {
    /// The file cannot be read.
    #[error("cannot read the scenario: {reason}; give the path of a .toml file, or make one with `softdock new NAME`")]
    Unreadable {
        /// What the system says.
        reason: String,
    },
    /// Not TOML.
    #[error("not valid TOML: {what}")]
    Syntax {
        /// What was found and what was expected.
        what: String,
    },
    /// A key that does not exist there.
    #[error("unknown key `{key}`{hint}")]
    UnknownKey {
        /// The path of the key.
        key: String,
        /// The rest of the sentence.
        hint: String,
    },
    /// A key that must be there.
    #[error("{table} lacks `{key}`: {meaning}")]
    MissingKey {
        /// The table.
        table: String,
        /// The key.
        key: String,
        /// What the key means, or what may stand there.
        meaning: String,
    },
    /// A value of another type.
    #[error("`{key}` must be {expected}, not {found}")]
    WrongType {
        /// The path of the key.
        key: String,
        /// The expected type, with its article.
        expected: String,
        /// What stands there.
        found: String,
    },
    /// A number, text or list outside its range.
    #[error("`{key}` = {found} {demand}")]
    OutOfRange {
        /// The path of the key.
        key: String,
        /// What stands there.
        found: String,
        /// "must be greater than 0", …
        demand: String,
    },
    /// A name of nothing that exists.
    #[error("`{key}`: no {what} \"{name}\"{hint}")]
    UnknownName {
        /// The path of the key.
        key: String,
        /// What the name should be of: "vehicle", "link", "kind", …
        what: String,
        /// The offending text.
        name: String,
        /// The nearest valid name, or all of them.
        hint: String,
    },
    /// The same name twice.
    #[error("`{key}`: the name \"{name}\" is taken at {first}; rename one of them")]
    DuplicateName {
        /// The path of the key.
        key: String,
        /// The name.
        name: String,
        /// Where it stands first.
        first: String,
    },
    /// Keys that do not go together.
    #[error("{table}: {rule}")]
    Conflict {
        /// The table.
        table: String,
        /// Which keys, and what to do.
        rule: String,
    },
    /// An override that is not `path=value`.
    #[error("{what}; write path=value, e.g. vehicle.target.twist.angular_deg_per_s[2]=1.5")]
    BadOverride {
        /// What is wrong with it.
        what: String,
    },
    /// A path that leads nowhere.
    #[error("`{path}` matches nothing: {reason}")]
    NoMatch {
        /// The path.
        path: String,
        /// Where it ends, and what is there instead.
        reason: String,
    },
    /// More faults than anyone reads.
    #[error("has more than {MOST_ERRORS} faults, of which the first are listed; is it a scenario?")]
    TooMany,
    /// Well-formed, and yet the model cannot be built from it.
    #[error("`{key}`: {reason}")]
    Unbuildable {
        /// The path of the key.
        key: String,
        /// Why, and the way out.
        reason: String,
    },
}

/// One thing that is wrong, and where.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{place}: {problem}")]
pub struct ScenarioError {
    /// Where.
    pub place: Place,
    /// What.
    pub problem: Problem,
}

/// Everything that is wrong with a scenario, in the order of the file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub struct ScenarioErrors {
    /// At least one.
    pub errors: Vec<ScenarioError>,
}

impl ScenarioErrors {
    /// Sorted by place, each once.
    pub fn new(mut errors: Vec<ScenarioError>) -> Self {
        errors.sort_by(|a, b| a.place.cmp(&b.place));
        errors.dedup();
        Self { errors }
    }
}

impl From<ScenarioError> for ScenarioErrors {
    fn from(error: ScenarioError) -> Self {
        Self { errors: vec![error] }
    }
}

impl fmt::Display for ScenarioErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, error) in self.errors.iter().enumerate() {
            if i > 0 {
                writeln!(f)?;
            }
            write!(f, "{error}")?;
            if let Place::File { line, excerpt, .. } = &error.place
                && !excerpt.is_empty()
            {
                write!(f, "\n    {line} | {excerpt}")?;
            }
        }
        Ok(())
    }
}
