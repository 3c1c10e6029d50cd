//! `softdock run FILE`: the main job.

use crate::Status;
use crate::progress::Progress;
use crate::summary::{self, Clock};
use anyhow::Context;
use softdock::record::{Meta, OutputFolder, Probe, Recorder, RecorderPlan, Scene, SceneVehicle};
use softdock::record::{ChannelSpec, Log, Plot};
use softdock::scenario::outcome::{Judge, Outcome, check_expectations};
use softdock::scenario::spec::Strategy;
use softdock::scenario::{self, Mission};
use softdock::sim::{Observer, StepError, World};
use std::path::PathBuf;
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
    /// Write no run.rrd
    #[arg(long)]
    no_rrd: bool,
    /// Stream to a running Rerun viewer as the run goes
    #[cfg(feature = "rerun")]
    #[arg(long)]
    live: bool,
    /// Open a Rerun viewer and stream to it
    #[cfg(feature = "rerun")]
    #[arg(long)]
    spawn: bool,
    /// No progress bar and no table
    #[arg(long, short)]
    quiet: bool,
}

/// Runs, writes, judges.
pub(crate) fn main(arguments: &Arguments) -> anyhow::Result<Status> {
    let mut mission = load(arguments)?;
    let target = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out").join(&mission.scenario.name));
    let folder = OutputFolder::create(&target)?;
    let scene = scene(&mission);
    let plan = recorder_plan(&mission, &scene);
    let mut sink = live_sink(arguments, &mission, &scene)?;
    let mut recorder = Recorder::new(&mission.world, plan, sink.as_mut().map(|s| s.as_sample_sink()));
    let mut judge = Judge::new(&mission);
    let mut progress = Progress::new(mission.steps, arguments.quiet);
    let started = Instant::now();
    let ended = {
        let observers: &mut [&mut dyn Observer] = &mut [&mut judge, &mut recorder, &mut progress];
        mission.world.run(mission.steps, &*mission.controller, observers)
    };
    let clock = Clock { wall_s: started.elapsed().as_secs_f64() };
    progress.finish();
    if let Some(error) = recorder.error.take() {
        return Err(error.into());
    }
    let log = std::mem::take(&mut recorder.log);
    drop(recorder);
    conclude(arguments, &Finished { mission: &mission, folder, scene, clock }, log, judge, &ended)
}

/// A run that is over.
struct Finished<'a> {
    mission: &'a Mission,
    folder: OutputFolder,
    scene: Scene,
    clock: Clock,
}

fn conclude(
    arguments: &Arguments,
    run: &Finished<'_>,
    mut log: Log,
    judge: Judge,
    ended: &Result<(), StepError>,
) -> anyhow::Result<Status> {
    let outcome = judge.conclude(&run.mission.world, ended);
    let verdicts = check_expectations(&run.mission.scenario.expects, &outcome);
    log.events.clone_from(&outcome.events);
    write_files(arguments, run, &log, &outcome)?;
    let document = summary::document(run.mission, &outcome, &verdicts);
    if !arguments.quiet {
        summary::print(run.mission, &outcome, &verdicts, run.clock);
    }
    let place = run.folder.finish(&document)?;
    if !arguments.quiet {
        println!("\n  {}: run.rrd (rerun {0}/run.rrd), signals.parquet, signals.svg, summary.json", place.display());
    }
    if ended.is_err() {
        return Ok(Status::Diverged);
    }
    Ok(if verdicts.iter().all(|v| v.met) { Status::AsExpected } else { Status::NotAsExpected })
}
