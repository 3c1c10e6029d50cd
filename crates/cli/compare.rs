//! `softdock compare A B`: two strategies, settings or versions on the same draws.

use crate::Status;
use crate::campaign::{Progress, threads};
use anyhow::{Context, bail};
use softdock::campaign::compare::{Comparison, comparison_html, comparison_json, comparison_markdown};
use softdock::campaign::table::Table;
use softdock::campaign::{self, Folder, Plan, Shard};
use softdock::record::write_file;
use softdock::scenario;
use std::path::{Path, PathBuf};

/// Arguments of `softdock compare`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// First: the folder or table of a campaign, or a scenario whose campaign is run now
    a: PathBuf,
    /// Second, likewise
    b: PathBuf,
    /// Override a key of the first scenario (repeatable)
    #[arg(long, value_name = "PATH=VALUE")]
    set_a: Vec<String>,
    /// Override a key of the second scenario (repeatable)
    #[arg(long, value_name = "PATH=VALUE")]
    set_b: Vec<String>,
    /// Names of the two, in the report [default: their overrides, or their folders]
    #[arg(long, num_args = 2, value_names = ["A", "B"])]
    names: Option<Vec<String>>,
    /// Other dispersions of the scenario, by the name of the campaign's variant
    #[arg(long)]
    variant: Option<String>,
    /// How many runs, where scenarios are run
    #[arg(long)]
    runs: Option<u32>,
    /// Threads, where scenarios are run
    #[arg(long)]
    threads: Option<usize>,
    /// Folder for the report, and for the campaigns that are run [default: out/compare]
    #[arg(long, default_value = "out/compare")]
    out: PathBuf,
    /// No progress
    #[arg(long, short)]
    quiet: bool,
}

/// Runs what is to be run, pairs, writes, and says it in a sentence.
pub(crate) fn main(arguments: &Arguments) -> anyhow::Result<Status> {
    std::fs::create_dir_all(&arguments.out).with_context(|| format!("cannot make {}", arguments.out.display()))?;
    let a = table(arguments, (&arguments.a, &arguments.set_a), "a")?;
    let b = table(arguments, (&arguments.b, &arguments.set_b), "b")?;
    let names = names(arguments);
    let comparison = Comparison::of(&a, &b, (&names.0, &names.1))?;
    let file = |name: &str| arguments.out.join(name);
    write_file(&file("comparison.html"), comparison_html(&comparison, &a, &b).as_bytes())?;
    write_file(&file("comparison.json"), comparison_json(&comparison).as_bytes())?;
    write_file(&file("comparison.md"), comparison_markdown(&comparison).as_bytes())?;
    println!("{}\n\nThe report is {}", comparison.verdict, file("comparison.html").display());
    Ok(Status::AsExpected)
}

/// The table of a side: read, or made now in a folder of its own, where an interrupted one goes on.
fn table(arguments: &Arguments, (path, set): (&Path, &[String]), side: &str) -> anyhow::Result<Table> {
    if path.extension().is_none_or(|e| e != "toml") {
        if !set.is_empty() {
            bail!("--set-{side} needs a scenario; {} is a campaign that has been run", path.display());
        }
        return Ok(campaign::read_table(path)?);
    }
    let plan = Plan::new(scenario::load(path, set)?, arguments.variant.as_deref(), arguments.runs)?;
    let target = arguments.out.join(side);
    let mut folder = Folder::open(&target, &plan, Shard::WHOLE, true)?;
    let progress = Progress::new(arguments.quiet);
    campaign::execute(&plan, &mut folder, (Shard::WHOLE, threads(arguments.threads)), &progress)?;
    progress.bar.finish_and_clear();
    Ok(campaign::read_table(&target)?)
}

/// What the report calls the two.
fn names(arguments: &Arguments) -> (String, String) {
    if let Some([a, b]) = arguments.names.as_deref() {
        return (a.clone(), b.clone());
    }
    let own = |path: &Path, set: &[String]| match set.is_empty() {
        true => path.display().to_string(),
        false => set.join(", "),
    };
    let (a, b) = (own(&arguments.a, &arguments.set_a), own(&arguments.b, &arguments.set_b));
    if a == b { ("A".to_owned(), "B".to_owned()) } else { (a, b) }
}
