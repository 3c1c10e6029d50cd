//! What can go wrong with a campaign, as sentences with a way out.

use record::RecordError;
use scenario::ScenarioErrors;
use std::io;
use std::path::{Path, PathBuf};

/// An error of a campaign.
#[derive(Debug, thiserror::Error)]
pub enum CampaignError {
    /// The scenario cannot be used.
    #[error("{0}")]
    Scenario(#[from] ScenarioErrors),
    /// A file of another crate's format failed.
    #[error("{0}")]
    Record(#[from] RecordError),
    /// The scenario disperses nothing and says no number of runs.
    #[error("{file} has no [campaign]; give one with its [[campaign.disperse]] entries, or --runs for identical runs")]
    NoCampaign {
        /// The scenario.
        file: String,
    },
    /// A variant that the file does not have.
    #[error("the scenario's campaign has no variant \"{name}\"; it has {have}")]
    NoVariant {
        /// As given.
        name: String,
        /// Those that there are.
        have: String,
    },
    /// A dispersion makes no sense.
    #[error("campaign.disperse[{entry}] ({paths}): {reason}")]
    Dispersion {
        /// Index of the entry.
        entry: usize,
        /// Its paths.
        paths: String,
        /// What is wrong and the way out.
        reason: String,
    },
    /// One path in two entries.
    #[error(
        "`{path}` is dispersed by two entries of campaign.disperse; the second would undo the first, so remove one"
    )]
    DispersedTwice {
        /// The path.
        path: String,
    },
    /// One column name for two inputs.
    #[error("two entries of campaign.disperse have the name \"{name}\"; give them different names")]
    NamedTwice {
        /// The name.
        name: String,
    },
    /// A correlation names something that cannot be correlated.
    #[error("campaign.correlate: \"{name}\": {reason}")]
    Correlation {
        /// What is named.
        name: String,
        /// Why not.
        reason: String,
    },
    /// The correlations contradict each other.
    #[error(
        "campaign.correlate: the correlations of {names} contradict each other (their matrix is not positive definite)"
    )]
    NotACorrelation {
        /// The entries.
        names: String,
    },
    /// More uniform numbers than the Sobol' generator has dimensions.
    #[error("sampling \"sobol\" has {most} dimensions and the campaign wants {wanted}; use \"latin-hypercube\"")]
    TooManyDimensions {
        /// How many are wanted.
        wanted: usize,
        /// How many there are.
        most: usize,
    },
    /// The grids multiply to more than can be counted.
    #[error("the grids of the campaign have more combinations than can be counted; make them coarser")]
    TooManyCombinations,
    /// A dispersed number that nothing reads.
    #[error(
        "campaign.disperse: nothing in the built model changes with `{path}`, so dispersing it would change no run; {hint}"
    )]
    Unheard {
        /// The path.
        path: String,
        /// What may be meant.
        hint: String,
    },
    /// A folder that holds a campaign already.
    #[error("{} holds a campaign with {done} of {runs} runs; continue it with --resume, or choose another folder", path.display())]
    Unfinished {
        /// The folder.
        path: PathBuf,
        /// Runs that are there.
        done: usize,
        /// Runs that it was to have.
        runs: u64,
    },
    /// A folder of another campaign.
    #[error("{} holds another campaign ({what}); choose another folder, or move it away", path.display())]
    OtherCampaign {
        /// The folder.
        path: PathBuf,
        /// What differs.
        what: String,
    },
    /// A folder with files that are not ours.
    #[error("{} holds \"{entry}\" and no campaign; choose an empty or a new folder", path.display())]
    ForeignFolder {
        /// The folder.
        path: PathBuf,
        /// The first entry.
        entry: String,
    },
    /// Another process writes there.
    #[error("{} is being written by another campaign; wait for it, or choose another folder", path.display())]
    Busy {
        /// The folder.
        path: PathBuf,
    },
    /// A file could not be written.
    #[error("cannot write {}: {source}; {}", path.display(), way_out(source))]
    Write {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A file could not be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A journal with a line that is no run.
    #[error("{}:{line}: {problem}; delete the line to have its run made again", path.display())]
    Journal {
        /// The journal.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong.
        problem: String,
    },
    /// A table that cannot be used.
    #[error("{}: {problem}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// What is wrong and the way out.
        problem: String,
    },
    /// A shard that does not exist.
    #[error("shard {text}: {reason}")]
    Shard {
        /// As given.
        text: String,
        /// What is wrong.
        reason: String,
    },
    /// Tables that do not belong together.
    #[error("{} and {} are of different campaigns: {what}", a.display(), b.display())]
    NotOneCampaign {
        /// The first.
        a: PathBuf,
        /// The other.
        b: PathBuf,
        /// What differs.
        what: String,
    },
    /// A run that the table does not have.
    #[error("{} has no run {run}; it has {have}", path.display())]
    NoSuchRun {
        /// The table.
        path: PathBuf,
        /// The run.
        run: u64,
        /// Which runs it has, in words.
        have: String,
    },
    /// The thread pool could not be made.
    #[error("cannot start {threads} threads: {reason}; give a smaller --threads")]
    Threads {
        /// How many.
        threads: usize,
        /// The system's reason.
        reason: String,
    },
}

impl CampaignError {
    pub(crate) fn write(path: &Path) -> impl FnOnce(io::Error) -> Self + '_ {
        move |source| Self::Write { path: path.to_owned(), source }
    }

    pub(crate) fn read(path: &Path) -> impl FnOnce(io::Error) -> Self + '_ {
        move |source| Self::Read { path: path.to_owned(), source }
    }

    pub(crate) fn table(path: &Path, problem: impl ToString) -> Self {
        Self::Table { path: path.to_owned(), problem: problem.to_string() }
    }
}

fn way_out(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded | io::ErrorKind::FileTooLarge => {
            "every finished run is kept: free some space and go on with --resume"
        }
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "check its permissions or choose another folder"
        }
        _ => "finished runs are kept; go on with --resume when this is mended",
    }
}
