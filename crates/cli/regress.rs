//! `softdock regress`: the catalogue against its baselines.

use crate::Status;
use crate::campaign::{Progress, threads};
use anyhow::{Context, bail};
use softdock::campaign::regress::{
    Baseline, Change, Entry, baseline_path, find_changes, junit_xml, measure, measure_campaign,
};
use softdock::record::write_file;
use softdock::scenario::{self, Scenario};
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};

/// Arguments of `softdock regress`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Scenarios, or folders of them
    #[arg(default_value = "scenarios")]
    paths: Vec<PathBuf>,
    /// Folder of the baselines
    #[arg(long, default_value = "tests/baselines")]
    baselines: PathBuf,
    /// Override a key in every scenario (repeatable); to see what would change
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Write the result as JUnit XML
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Make what is found now the baseline
    #[arg(long)]
    bless: bool,
    /// Why the baseline moves; it is kept with it
    #[arg(long, requires = "bless")]
    reason: Option<String>,
    /// With --bless: keep the first so many runs of each campaign in the baseline (then they are always checked)
    #[arg(long, requires = "bless", value_name = "N")]
    campaign_runs: Option<u32>,
    /// Threads for campaigns
    #[arg(long)]
    threads: Option<usize>,
    /// Only what changed
    #[arg(long, short)]
    quiet: bool,
}

/// A scenario and what became of it.
type Checked = (String, Result<Vec<Change>, String>);

/// Checks or blesses every scenario; status 1 where something changed, 3 where something could not be read.
pub(crate) fn main(arguments: &Arguments) -> anyhow::Result<Status> {
    let files = scenarios(&arguments.paths)?;
    if arguments.bless {
        return bless(arguments, &files);
    }
    let mut results: Vec<Checked> = Vec::new();
    for file in &files {
        let checked = check(arguments, file);
        tell(arguments, &checked);
        results.push(checked);
    }
    if let Some(file) = &arguments.junit {
        write_file(file, junit_xml(&results)?.as_bytes())?;
    }
    let changed = results.iter().filter(|(_, r)| r.as_ref().is_ok_and(|c| !c.is_empty())).count();
    let failed = results.iter().filter(|(_, r)| r.is_err()).count();
    println!(
        "{} scenarios: {} as their baselines, {changed} changed, {failed} failed",
        files.len(),
        files.len() - changed - failed
    );
    if failed > 0 {
        bail!("{failed} scenarios could not be held against a baseline");
    }
    Ok(if changed == 0 { Status::AsExpected } else { Status::NotAsExpected })
}

fn tell(arguments: &Arguments, (name, result): &Checked) {
    match result {
        Ok(changes) if changes.is_empty() => {
            if !arguments.quiet {
                println!("as before  {name}");
            }
        }
        Ok(changes) => {
            println!("CHANGED    {name}");
            changes.iter().for_each(|change| println!("             {}: {}", change.group.word(), change.text));
        }
        Err(reason) => println!("FAILED     {name}: {reason}"),
    }
}

fn check(arguments: &Arguments, file: &Path) -> Checked {
    let own_name = file.display().to_string();
    let result = (|| -> anyhow::Result<(String, Vec<Change>)> {
        let scenario = scenario::load(file, &arguments.set)?;
        let path = baseline_path(&arguments.baselines, &scenario);
        let then = Baseline::read(&path)?
            .with_context(|| format!("there is no baseline {}; make it with --bless --reason \"…\"", path.display()))?;
        let runs = then.campaign.as_ref().map(|c| c.runs);
        let now = now(arguments, &scenario, runs)?;
        Ok((scenario.name.clone(), find_changes(&scenario, &then, &now)))
    })();
    match result {
        Ok((name, changes)) => (name, Ok(changes)),
        Err(error) => (own_name, Err(format!("{error:#}"))),
    }
}

/// What a scenario shows now, its campaign's first runs included where they are wanted.
fn now(arguments: &Arguments, scenario: &Scenario, runs: Option<u32>) -> anyhow::Result<Baseline> {
    let mut now = measure(scenario)?;
    if let Some(runs) = runs.filter(|_| scenario.campaign.is_some()) {
        let progress = Progress::new(arguments.quiet);
        now.campaign = Some(measure_campaign(scenario, runs, threads(arguments.threads), &progress)?);
        progress.bar.finish_and_clear();
    }
    Ok(now)
}

fn bless(arguments: &Arguments, files: &[PathBuf]) -> anyhow::Result<Status> {
    let reason = reason(arguments)?;
    for file in files {
        let scenario = scenario::load(file, &arguments.set)?;
        let path = baseline_path(&arguments.baselines, &scenario);
        let then = Baseline::read(&path)?;
        let runs = arguments.campaign_runs.or(then.as_ref().and_then(|t| t.campaign.as_ref()).map(|c| c.runs));
        let now = now(arguments, &scenario, runs)?;
        let changes = then.as_ref().map(|then| find_changes(&scenario, then, &now)).unwrap_or_default();
        let has_moved = then.is_none()
            || !changes.is_empty()
            || then.as_ref().is_some_and(|t| t.campaign.is_some() != now.campaign.is_some());
        if !has_moved {
            println!("as before  {}", scenario.name);
            continue;
        }
        let moved: Vec<String> = changes.iter().map(|c| c.text.clone()).collect();
        moved.iter().for_each(|text| println!("             {text}"));
        let entry = Entry { version: env!("CARGO_PKG_VERSION").to_owned(), reason: reason.clone(), moved };
        now.bless(&path, then.as_ref(), entry)?;
        println!("blessed    {}", scenario.name);
    }
    Ok(Status::AsExpected)
}

/// The reason as given, or asked for.
fn reason(arguments: &Arguments) -> anyhow::Result<String> {
    let given = match &arguments.reason {
        Some(reason) => reason.clone(),
        None if std::io::stdin().is_terminal() => {
            print!("Why do the baselines move? ");
            std::io::stdout().flush()?;
            let mut line = String::new();
            std::io::stdin().read_line(&mut line)?;
            line
        }
        None => String::new(),
    };
    let reason = given.trim().to_owned();
    if reason.is_empty() {
        bail!("a baseline moves for a reason; give it with --reason \"…\"");
    }
    Ok(reason)
}

/// Scenario files of paths, folders walked, in order.
fn scenarios(paths: &[PathBuf]) -> anyhow::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for path in paths {
        if path.is_dir() {
            walk(path, &mut found)?;
        } else {
            found.push(path.clone());
        }
    }
    found.sort();
    if found.is_empty() {
        bail!("no scenario in {paths:?}");
    }
    Ok(found)
}

fn walk(folder: &Path, found: &mut Vec<PathBuf>) -> anyhow::Result<()> {
    let entries = std::fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    for entry in entries {
        let path = entry?.path();
        if path.is_dir() {
            walk(&path, found)?;
        } else if path.extension().is_some_and(|e| e == "toml") {
            found.push(path);
        }
    }
    Ok(())
}
