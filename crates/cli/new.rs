//! `softdock new NAME`: a commented starter scenario.

use crate::Status;
use anyhow::{Context, bail};
use std::path::PathBuf;

/// Arguments of `softdock new`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Name of the scenario; also of its file
    name: String,
    /// Folder to write it in
    #[arg(long, default_value = "scenarios")]
    dir: PathBuf,
}

/// Writes the file; never over another.
pub(crate) fn main(arguments: &Arguments) -> anyhow::Result<Status> {
    let name = arguments.name.trim_end_matches(".toml");
    if name.is_empty() || name.contains(['/', '\\', '"']) {
        bail!("\"{}\" is not a name; give a word such as my-capture, and --dir for the folder", arguments.name);
    }
    let path = arguments.dir.join(format!("{name}.toml"));
    if path.exists() {
        bail!("{} exists; choose another name or remove it", path.display());
    }
    std::fs::create_dir_all(&arguments.dir).with_context(|| format!("cannot make {}", arguments.dir.display()))?;
    std::fs::write(&path, softdock::scenario::starter(name))
        .with_context(|| format!("cannot write {}", path.display()))?;
    println!("{} is written. Next: softdock check {0}, then softdock run {0}", path.display());
    Ok(Status::AsExpected)
}
