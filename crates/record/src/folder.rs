//! The output folder of a run, written beside its place and moved there when it is complete.
//!
//! ```text
//! out/.run-1.partial-x7Kd/   while the run is on      (summary.json is written last)
//! out/run-1/                 after one rename         (an older run of that name goes only now)
//! ```
//!
//! A killed run leaves at most the hidden partial folder: nothing that looks finished. `summary.json` lists the
//! entries of the folder, and a folder that holds anything else is never replaced.

use crate::RecordError;
use serde_json::{Map, Value};
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Value of the key `format` in `summary.json`.
pub const SUMMARY_FORMAT: &str = "softdock-run-1";

/// An output folder that is being written.
#[derive(Debug)]
pub struct OutputFolder {
    target: PathBuf,
    partial: TempDir,
}

impl OutputFolder {
    /// Starts writing a folder that will stand at `target`. Fails now rather than after the run if the place is
    /// taken by something that softdock did not write.
    pub fn create(target: &Path) -> Result<Self, RecordError> {
        let target = resolve(target)?;
        check_replaceable(&target)?;
        let (parent, name) = parts(&target)?;
        fs::create_dir_all(parent).map_err(RecordError::write(parent))?;
        let partial = tempfile::Builder::new()
            .prefix(&format!(".{name}.partial-"))
            .tempdir_in(parent)
            .map_err(RecordError::write(&target))?;
        open_to_readers(partial.path()).map_err(RecordError::write(partial.path()))?;
        Ok(Self { target, partial })
    }

    /// Where a file of this name is to be written while the run is on.
    pub fn file(&self, name: &str) -> PathBuf {
        self.partial.path().join(name)
    }

    /// Where the folder will stand.
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Writes `summary.json` (with `format` and the list of `files`), puts all on disk and moves the folder to its
    /// place, where it replaces an older run. Returns that place.
    pub fn finish(self, summary: &Map<String, Value>) -> Result<PathBuf, RecordError> {
        let partial = self.partial.path();
        let mut files = entries(partial)?;
        files.push("summary.json".into());
        let mut document = Map::new();
        document.insert("format".into(), SUMMARY_FORMAT.into());
        document.extend(summary.clone());
        document.insert("files".into(), files.into());
        let text = format!("{:#}\n", Value::Object(document));
        write_file(&partial.join("summary.json"), text.as_bytes())?;
        sync_folder(partial);
        self.put_in_place()
    }

    fn put_in_place(self) -> Result<PathBuf, RecordError> {
        check_replaceable(&self.target)?; // again: something may have come in the meantime
        let (parent, name) = parts(&self.target)?;
        let older = if self.target.exists() {
            let older = tempfile::Builder::new()
                .prefix(&format!(".{name}.old-"))
                .tempdir_in(parent)
                .map_err(RecordError::write(&self.target))?;
            fs::rename(&self.target, older.path().join(name)).map_err(RecordError::write(&self.target))?;
            Some(older)
        } else {
            None
        };
        if let Err(error) = fs::rename(self.partial.path(), &self.target) {
            if let Some(older) = &older {
                fs::rename(older.path().join(name), &self.target).map_err(RecordError::write(&self.target))?;
            }
            return Err(RecordError::write(&self.target)(error));
        }
        let _moved = self.partial.keep();
        sync_folder(parent);
        Ok(self.target)
    }
}

/// Writes a whole file and waits until it is on disk.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), RecordError> {
    let write = || -> io::Result<()> {
        let mut file = File::create(path)?;
        file.write_all(bytes)?;
        match file.sync_all() {
            Err(error) if error.kind() == io::ErrorKind::InvalidInput => Ok(()), // pipes and devices cannot sync
            other => other,
        }
    };
    write().map_err(RecordError::write(path))
}

/// The absolute path, through links if it exists, so that the partial folder is on the same disk.
fn resolve(target: &Path) -> Result<PathBuf, RecordError> {
    if target.exists() {
        return target.canonicalize().map_err(RecordError::read(target));
    }
    std::path::absolute(target).map_err(|_| RecordError::NamelessFolder { path: target.to_owned() })
}

fn parts(target: &Path) -> Result<(&Path, &str), RecordError> {
    let name = target.file_name().and_then(|name| name.to_str());
    target.parent().zip(name).ok_or_else(|| RecordError::NamelessFolder { path: target.to_owned() })
}

/// Free, empty, or an older run and nothing else.
fn check_replaceable(target: &Path) -> Result<(), RecordError> {
    if !target.exists() {
        return Ok(());
    }
    if !target.is_dir() {
        return Err(RecordError::NotAFolder { path: target.to_owned() });
    }
    let ours = files_of_run(target);
    match entries(target)?.into_iter().find(|entry| !ours.contains(entry)) {
        Some(entry) => Err(RecordError::ForeignFolder { path: target.to_owned(), entry }),
        None => Ok(()),
    }
}

/// What a run's summary says that it wrote; nothing for any other folder.
fn files_of_run(folder: &Path) -> Vec<String> {
    let Ok(text) = fs::read_to_string(folder.join("summary.json")) else { return Vec::new() };
    let Ok(summary) = serde_json::from_str::<Value>(&text) else { return Vec::new() };
    if summary["format"] != SUMMARY_FORMAT {
        return Vec::new();
    }
    let files = summary["files"].as_array();
    files.into_iter().flatten().filter_map(Value::as_str).map(String::from).collect()
}

/// Names in a folder, sorted.
fn entries(folder: &Path) -> Result<Vec<String>, RecordError> {
    let list = || -> io::Result<Vec<String>> {
        fs::read_dir(folder)?.map(|entry| Ok(entry?.file_name().to_string_lossy().into_owned())).collect()
    };
    let mut names = list().map_err(RecordError::read(folder))?;
    names.sort_unstable();
    Ok(names)
}

/// Temporary folders are private; a result is not.
#[cfg(unix)]
fn open_to_readers(folder: &Path) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    fs::set_permissions(folder, fs::Permissions::from_mode(0o755))
}

#[cfg(not(unix))]
fn open_to_readers(_folder: &Path) -> io::Result<()> {
    Ok(())
}

/// Makes renames durable. Best effort: some file systems cannot sync folders, and the data are safe without.
fn sync_folder(folder: &Path) {
    if let Ok(folder) = File::open(folder) {
        let _unsupported_here = folder.sync_all();
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn summary(outcome: &str) -> Map<String, Value> {
        Map::from_iter([("outcome".to_string(), outcome.into())])
    }

    fn run(target: &Path, outcome: &str) -> Result<PathBuf, RecordError> {
        let folder = OutputFolder::create(target)?;
        write_file(&folder.file("signals.parquet"), b"data")?;
        folder.finish(&summary(outcome))
    }

    #[test]
    fn folder_appears_only_when_it_is_complete() {
        let home = tempfile::tempdir().unwrap();
        let target = home.path().join("deep/run");
        let folder = OutputFolder::create(&target).unwrap();
        write_file(&folder.file("signals.parquet"), b"data").unwrap();
        assert!(!target.exists());
        folder.finish(&summary("captured")).unwrap();
        assert_eq!(entries(&target).unwrap(), ["signals.parquet", "summary.json"]);
        assert_eq!(entries(&home.path().join("deep")).unwrap(), ["run"]);
    }

    #[test]
    fn abandoned_run_leaves_nothing_and_the_older_run_stands() {
        let home = tempfile::tempdir().unwrap();
        let target = home.path().join("run");
        run(&target, "captured").unwrap();
        drop(OutputFolder::create(&target).unwrap());
        assert!(fs::read_to_string(target.join("summary.json")).unwrap().contains("captured"));
        assert_eq!(entries(home.path()).unwrap(), ["run"]);
    }

    #[test]
    fn newer_run_replaces_the_older_whole() {
        let home = tempfile::tempdir().unwrap();
        let target = home.path().join("run");
        let first = OutputFolder::create(&target).unwrap();
        write_file(&first.file("old.rrd"), b"data").unwrap();
        first.finish(&summary("lost")).unwrap();
        run(&target, "captured").unwrap();
        assert_eq!(entries(&target).unwrap(), ["signals.parquet", "summary.json"]);
        assert_eq!(entries(home.path()).unwrap(), ["run"]);
    }

    #[test]
    fn folder_with_foreign_files_is_never_replaced() {
        let home = tempfile::tempdir().unwrap();
        fs::write(home.path().join("thesis.tex"), "x").unwrap();
        let message = run(home.path(), "captured").unwrap_err().to_string();
        assert!(message.contains("holds \"thesis.tex\", which softdock did not write"), "{message}");

        let target = home.path().join("run");
        run(&target, "captured").unwrap();
        fs::write(target.join("notes.md"), "mine").unwrap();
        let message = run(&target, "captured").unwrap_err().to_string();
        assert!(message.contains("notes.md"), "{message}");
        assert!(target.join("notes.md").exists());
    }

    #[test]
    fn empty_folder_is_used_and_a_file_is_refused() {
        let home = tempfile::tempdir().unwrap();
        let empty = home.path().join("empty");
        fs::create_dir(&empty).unwrap();
        run(&empty, "captured").unwrap();
        let file = home.path().join("file");
        fs::write(&file, "x").unwrap();
        assert!(matches!(run(&file, "captured"), Err(RecordError::NotAFolder { .. })));
        assert!(matches!(
            OutputFolder::create(Path::new("/")),
            Err(RecordError::NamelessFolder { .. } | RecordError::ForeignFolder { .. })
        ));
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn full_disk_names_the_file_and_the_way_out() {
        let message = write_file(Path::new("/dev/full"), b"data").unwrap_err().to_string();
        assert!(message.contains("cannot write /dev/full"), "{message}");
        assert!(message.contains("free some space"), "{message}");
    }
}
