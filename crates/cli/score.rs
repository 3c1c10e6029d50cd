//! `softdock score DIAGNOSES KEYS`: judges diagnoses against answer keys.

use crate::Status;
use softdock::score::score_folders;
use std::path::PathBuf;

/// Arguments of `softdock score`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Folder of diagnoses: <set>/diagnosis.json, or <set>.json
    diagnoses: PathBuf,
    /// Folder of answer keys: <set>.json
    keys: PathBuf,
    /// Print everything as JSON
    #[arg(long)]
    json: bool,
    /// Print the table as Markdown
    #[arg(long, conflicts_with = "json")]
    markdown: bool,
    /// Leave out sets without a diagnosis, instead of counting them as wrong
    #[arg(long)]
    present: bool,
}

/// Judges, prints, and says by the status whether all requirements are met.
pub(crate) fn main(arguments: &Arguments) -> anyhow::Result<Status> {
    let table = score_folders(&arguments.diagnoses, &arguments.keys, arguments.present)?;
    match (arguments.json, arguments.markdown) {
        (true, _) => println!("{}", serde_json::to_string_pretty(&table.json())?),
        (_, true) => print!("{}", table.markdown()),
        _ => print!("{}", table.text()),
    }
    Ok(if table.holds() { Status::AsExpected } else { Status::NotAsExpected })
}
