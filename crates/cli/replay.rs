//! `softdock replay TABLE RUN`: a run of a campaign again, to the bit, with everything recorded.

use crate::Status;
use anyhow::Context;
use softdock::campaign::{self, Plan};
use softdock::record::{self, OutputFolder};
use softdock::scenario::{self, recording};
use std::path::{Path, PathBuf};

/// Arguments of `softdock replay`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The table, or the folder of the campaign
    table: PathBuf,
    /// Index of the run
    run: u64,
    /// The scenario, where it is no longer where the campaign found it
    #[arg(long)]
    scenario: Option<PathBuf>,
    /// Overrides that the campaign was made with, with --scenario (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE", requires = "scenario")]
    set: Vec<String>,
    /// Variant of the campaign, with --scenario
    #[arg(long, requires = "scenario")]
    variant: Option<String>,
    /// Folder for run.rrd, signals.parquet and summary.json [default: out/replay/NAME-RUN]
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Makes the run again and says by the status whether it is the same.
pub(crate) fn main(arguments: &Arguments) -> anyhow::Result<Status> {
    let table = campaign::read_table(&arguments.table)?;
    let (scenario, variant) = load(arguments)?;
    let plan = Plan::new(scenario, variant.as_deref(), Some(1))?;
    let replayed = campaign::replay(&plan, (&arguments.table, &table), arguments.run)?;
    let row = &replayed.finished.row;
    let name = format!("{}-{:06}", table.header.scenario, arguments.run);
    let target = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out/replay").join(name));
    let folder = OutputFolder::create(&target)?;
    write(&plan, &folder, &replayed)?;
    let summary = serde_json::to_value(row)?;
    let place = folder.finish(summary.as_object().context("a row is a table")?)?;
    println!("run {}: {}: {}", row.run, row.outcome, row.reason);
    for (input, value) in plan.header.inputs.iter().zip(&row.inputs) {
        println!("  {} = {value}", input.name);
    }
    println!("The results are in {}", place.display());
    if replayed.differences.is_empty() {
        println!("identical to the table, bit for bit");
        return Ok(Status::AsExpected);
    }
    println!("NOT identical to the table:");
    for (name, then, now) in &replayed.differences {
        println!("  {name}: {then} in the table, {now} now");
    }
    Ok(Status::NotAsExpected)
}

fn write(plan: &Plan, folder: &OutputFolder, replayed: &campaign::Replayed) -> anyhow::Result<()> {
    let Some(log) = &replayed.finished.log else { return Ok(()) };
    record::write_parquet(&folder.file("signals.parquet"), &log.meta, &log.signals)?;
    record::write_file(&folder.file("signals.svg"), record::plot::plot_svg(log).as_bytes())?;
    write_rrd(plan, &folder.file("run.rrd"), (&replayed.finished.row, log))
}

/// Writes the recording of a run for the viewer; nothing without the feature.
pub(crate) fn write_rrd(plan: &Plan, path: &Path, (row, log): (&campaign::Row, &record::Log)) -> anyhow::Result<()> {
    #[cfg(feature = "rerun")]
    {
        let (scenario, _) = plan.scenario_of(row.run)?;
        let mission = scenario::build(&scenario)?;
        let mut text =
            format!("# {}, run {}\n\n**{}**: {}\n\n", plan.header.scenario, row.run, row.outcome, row.reason);
        for (input, value) in plan.header.inputs.iter().zip(&row.inputs) {
            text += &format!("- {} = {value}\n", input.name);
        }
        record::rerun_sink::write_rrd(path, log, &recording::scene(&mission), &text)?;
    }
    #[cfg(not(feature = "rerun"))]
    let _ = (plan, path, row, log, scenario::build, recording::scene);
    Ok(())
}

/// The scenario as the campaign had it.
fn load(arguments: &Arguments) -> anyhow::Result<(scenario::Scenario, Option<String>)> {
    if let Some(file) = &arguments.scenario {
        return Ok((scenario::load(file, &arguments.set)?, arguments.variant.clone()));
    }
    let folder = if arguments.table.is_dir() { Some(arguments.table.as_path()) } else { arguments.table.parent() };
    let identity = folder.map(campaign::read_identity).transpose()?.flatten();
    let identity = identity.with_context(|| {
        format!(
            "no campaign.json stands beside {}; say with --scenario which scenario it is of",
            arguments.table.display()
        )
    })?;
    Ok((scenario::load(&identity.file, &identity.overrides)?, identity.variant))
}
