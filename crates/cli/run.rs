//! `softdock run FILE`: the main job.

use crate::progress::Progress;
use crate::summary::{self, Clock};
use crate::{Status, check, live};
use anyhow::Context;
use softdock::record::{self, Log, OutputFolder, Recorder, SampleSink, Scene};
use softdock::scenario::recording::{recorder_plan, scene};
use softdock::scenario::spec::{IntegratorKind, Strategy};
use softdock::scenario::{self, Finished, Mission, RigLog};
use softdock::sim::Observer;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Arguments of `softdock run`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The scenario
    file: PathBuf,
    /// Folder for run.rrd, signals.parquet, signals.svg and summary.json [default: out/NAME]
    #[arg(long)]
    out: Option<PathBuf>,
    /// Override a key of the scenario, `path=value`, e.g. contact[0].friction.mu=0.02 (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Seed of every random number, instead of the scenario's
    #[arg(long)]
    seed: Option<u64>,
    /// Replay recorded commands (CSV or Parquet; columns command.ACTUATOR or actuator.ACTUATOR.command)
    #[arg(long, value_name = "RECORDING")]
    commands: Option<PathBuf>,
    /// Also write what the sensors and controllers say as a recording of a rig: a run more in this folder, which `diagnose` reads
    #[arg(long, value_name = "FOLDER")]
    record: Option<PathBuf>,
    /// What the recorded run is for
    #[arg(long, value_enum, default_value_t = Role::Fit, requires = "record")]
    role: Role,
    /// How its file is written
    #[arg(long, value_enum, default_value_t = Format::Csv, requires = "record")]
    format: Format,
    /// Write no run.rrd
    #[arg(long)]
    no_rrd: bool,
    /// Stream to a running Rerun viewer as the run goes
    #[cfg(feature = "rerun")]
    #[arg(long, value_name = "URL", num_args = 0..=1, default_missing_value = "rerun+http://127.0.0.1:9876/proxy")]
    pub(crate) live: Option<String>,
    /// Open a Rerun viewer and stream to it
    #[cfg(feature = "rerun")]
    #[arg(long, conflicts_with = "live")]
    pub(crate) spawn: bool,
    /// No progress bar and no table
    #[arg(long, short)]
    quiet: bool,
}

/// What a recorded run may be used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Role {
    /// To find and fit a model
    Fit,
    /// Only to judge it
    Holdout,
}

/// How the file of a recorded run is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    Csv,
    Parquet,
    Mcap,
}

/// Runs, writes, judges.
pub(crate) fn main(arguments: &Arguments) -> anyhow::Result<Status> {
    let mission = load(arguments)?;
    if !arguments.quiet {
        check::hints(&mission);
        hint_at_loss(arguments, &mission);
    }
    let target = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out").join(&mission.scenario.name));
    let folder = OutputFolder::create(&target)?;
    let scene = scene(&mission);
    let plan = recorder_plan(&mission, &scene)?;
    let mut viewer = live::open(arguments, &plan, &mission, &scene)?;
    let recorder = Recorder::new(&mission.world, plan, viewer.as_mut().map(|v| v as &mut dyn SampleSink));
    let mut rig = arguments.record.is_some().then(|| RigLog::new(&mission)).transpose()?;
    let mut progress = Progress::new(mission.steps, arguments.quiet);
    let started = Instant::now();
    let done = {
        let mut observers: Vec<&mut dyn Observer> = vec![&mut progress];
        observers.extend(rig.as_mut().map(|rig| rig as &mut dyn Observer));
        scenario::run(mission, Some(recorder), &mut observers)?
    };
    let clock = Clock { wall_s: started.elapsed().as_secs_f64() };
    progress.finish();
    match (&arguments.record, rig) {
        (Some(folder), Some(rig)) if done.ended.is_ok() => append(arguments, folder, rig)?,
        (Some(folder), _) => eprintln!("not recorded in {}: the run did not come to its end", folder.display()),
        (None, _) => {}
    }
    conclude(arguments, done, Place { folder, scene, clock }, viewer)
}

/// A recording is as exact as its integrator.
fn hint_at_loss(arguments: &Arguments, mission: &Mission) {
    let kind = mission.scenario.integrator.kind;
    if arguments.record.is_some() && matches!(kind, IntegratorKind::ImplicitEuler | IntegratorKind::SemiImplicitEuler) {
        eprintln!(
            "hint: a scheme of first order makes the recording; what it loses at {} s is no physics, and a diagnosis will find it: \
             --set 'integrator.kind=\"rk4\"' or a shorter step",
            mission.scenario.integrator.step_s
        );
    }
}

/// Adds a run to the recordings in a folder.
fn append(arguments: &Arguments, folder: &Path, rig: RigLog) -> anyhow::Result<()> {
    let role = match arguments.role {
        Role::Fit => record::Role::Fit,
        Role::Holdout => record::Role::Holdout,
    };
    let mut words = arguments.set.clone();
    words.extend(arguments.seed.map(|seed| format!("seed={seed}")));
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
    let format = match arguments.format {
        Format::Csv => record::Format::Csv,
        Format::Parquet => record::Format::Parquet,
        Format::Mcap => record::Format::Mcap,
    };
    let added = rig.finish("", (role, &words.join(" "))).append_to(folder, format)?;
    if !arguments.quiet {
        println!("  Recorded as {} in {}", added.join(", "), folder.display());
    }
    Ok(())
}

/// Where a run's files go, and what is seen in them.
struct Place {
    folder: OutputFolder,
    scene: Scene,
    clock: Clock,
}

fn conclude(
    arguments: &Arguments,
    mut done: Finished,
    place: Place,
    viewer: Option<live::Viewer>,
) -> anyhow::Result<Status> {
    let log = done.log.take().unwrap_or_default();
    let text = summary::markdown(&done);
    live::finish(viewer, &done.outcome, &text)?;
    write_files(arguments, &place, &log, &text)?;
    let document = summary::document(&done);
    if !arguments.quiet {
        summary::print(&done, place.clock);
    }
    let place = place.folder.finish(&document)?;
    if !arguments.quiet {
        let viewer = if place.join("run.rrd").exists() {
            format!("; see it with: rerun {}/run.rrd", place.display())
        } else {
            String::new()
        };
        println!("\n  The results are in {}{viewer}", place.display());
    }
    Ok(match &done.ended {
        Err(_) => Status::Diverged,
        Ok(()) if done.is_as_expected() => Status::AsExpected,
        Ok(()) => Status::NotAsExpected,
    })
}

fn write_files(arguments: &Arguments, place: &Place, log: &Log, text: &str) -> anyhow::Result<()> {
    let folder = &place.folder;
    record::write_parquet(&folder.file("signals.parquet"), &log.meta, &log.signals)?;
    record::write_file(&folder.file("signals.svg"), record::plot::plot_svg(log).as_bytes())?;
    #[cfg(feature = "rerun")]
    if !arguments.no_rrd {
        record::rerun_sink::write_rrd(&folder.file("run.rrd"), log, &place.scene, text)?;
    }
    let _ = (arguments, &place.scene, text);
    Ok(())
}

fn load(arguments: &Arguments) -> anyhow::Result<Mission> {
    let mut overrides = arguments.set.clone();
    overrides.extend(arguments.seed.map(|seed| format!("seed={seed}")));
    let mut scenario = scenario::load(&arguments.file, &overrides)?;
    if let Some(file) = &arguments.commands {
        let file = std::path::absolute(file).with_context(|| format!("cannot find {}", file.display()))?;
        let mapping = std::collections::BTreeMap::new();
        scenario.strategy = Strategy::Replay(scenario::spec::Replay { file: file.display().to_string(), mapping });
    }
    Ok(scenario::build(&scenario)?)
}
