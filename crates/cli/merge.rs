//! `softdock merge SHARD… --out DIR`: the tables of shards as one, and which runs are missing.

use crate::Status;
use softdock::campaign;
use std::path::PathBuf;

/// Arguments of `softdock merge`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Folders (or table.parquet files) of the shards
    #[arg(required = true)]
    shards: Vec<PathBuf>,
    /// Folder for the joined table.parquet
    #[arg(long)]
    out: PathBuf,
    /// How many runs the campaign was to have [default: up to the highest that is there]
    #[arg(long)]
    runs: Option<u64>,
}

/// Joins, and says by the status whether all runs are there.
pub(crate) fn main(arguments: &Arguments) -> anyhow::Result<Status> {
    let merged = campaign::merge(&arguments.shards, arguments.runs, &arguments.out)?;
    println!("{} runs in {}", merged.runs, merged.table.display());
    if merged.repeated > 0 {
        println!("{} runs stood in several shards, alike in all", merged.repeated);
    }
    if merged.missing.is_empty() {
        return Ok(Status::AsExpected);
    }
    println!("{} runs are missing: {}", merged.missing.len(), ranges(&merged.missing));
    Ok(Status::NotAsExpected)
}

/// `0–3, 7, 9–12`.
fn ranges(runs: &[u64]) -> String {
    let mut parts: Vec<(u64, u64)> = Vec::new();
    for run in runs {
        match parts.last_mut() {
            Some((_, last)) if *last + 1 == *run => *last = *run,
            _ => parts.push((*run, *run)),
        }
    }
    let text = |(a, b): &(u64, u64)| if a == b { a.to_string() } else { format!("{a}–{b}") };
    parts.iter().map(text).collect::<Vec<_>>().join(", ")
}
