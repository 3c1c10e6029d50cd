//! What can go wrong between a run and its files, as sentences with a way out.

use std::io;
use std::path::{Path, PathBuf};

/// An error of reading or writing a recording.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// A file or folder could not be written.
    #[error("cannot write {}: {source}; {}", path.display(), way_out(source))]
    Write {
        /// What was being written.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A file or folder could not be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// What was being read.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The output path has no name of its own.
    #[error("output folder \"{}\" has no name of its own; give a folder such as \"out/run-1\"", path.display())]
    NamelessFolder {
        /// The path as given.
        path: PathBuf,
    },
    /// The output folder holds something that softdock did not write.
    #[error("output folder {} holds \"{entry}\", which softdock did not write, and would be replaced; move it away or choose another folder", path.display())]
    ForeignFolder {
        /// The folder.
        path: PathBuf,
        /// The first entry that is not ours.
        entry: String,
    },
    /// The output path is a file.
    #[error("output folder {} is a file; choose another folder", path.display())]
    NotAFolder {
        /// The path.
        path: PathBuf,
    },
    /// A table file does not hold what a recording needs.
    #[error("{}: {problem}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// What is wrong and how to mend it.
        problem: String,
    },
    /// A line of a CSV file is wrong.
    #[error("{}:{line}: {problem}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: usize,
        /// What is wrong and how to mend it.
        problem: String,
    },
    /// A log whose parts do not fit together: a mistake of the program that filled it.
    #[error("sample at t = {t} s has {got} {what}, the log was made for {expected}")]
    Sample {
        /// Time of the sample, s.
        t: f64,
        /// "values" or "poses".
        what: &'static str,
        /// How many came.
        got: usize,
        /// How many are wanted.
        expected: usize,
    },
    /// An encoder refused the data.
    #[error("cannot encode {what}: {reason}")]
    Encode {
        /// Which product.
        what: &'static str,
        /// The encoder's reason.
        reason: String,
    },
    /// No viewer answered.
    #[error(
        "no Rerun viewer at {url}: {reason}; start one with `rerun` (`pip install rerun-sdk=={version}` brings it), or let --spawn open one"
    )]
    Viewer {
        /// Where it was looked for.
        url: String,
        /// Why it failed.
        reason: String,
        /// The viewer version that fits.
        version: &'static str,
    },
}

impl RecordError {
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
            "free some space, log at a lower rate, or choose a folder on another disk"
        }
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "check its permissions or choose another folder"
        }
        io::ErrorKind::ResourceBusy => "it is in use or a mount point; choose a folder inside it",
        _ => "choose another folder if this cannot be mended",
    }
}
