//! The `softdock` command: one file per subcommand.
//!
//! Exit status: 0 as expected; 1 an expectation failed; 2 usage; 3 bad input; 4 diverged; 130 stopped by Ctrl-C.

#![allow(clippy::print_stdout)] // a command prints

mod campaign;
mod campaign_report;
mod check;
mod compare;
mod diagnose;
mod emit;
mod inspect;
mod lab;
mod live;
mod merge;
mod new;
mod plant;
mod progress;
mod regress;
mod replay;
mod run;
mod schema;
mod score;
mod summary;
mod view;

use clap::{Parser, Subcommand};
use mimalloc::MiMalloc;
use std::process::ExitCode;

/// A diagnosis asks for many small matrices: with this allocator it takes an eighth less time.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

/// Spacecraft docking and grasp scenarios: free-flying robots, tumbling targets, contact with bristle friction.
#[derive(Debug, Parser)]
#[command(
    version,
    max_term_width = 100,
    after_help = "\
A first run:
  softdock run scenarios/tumbling-capture.toml --out out/capture
  rerun out/capture/run.rrd            the recording, in the Rerun viewer
  out/capture/signals.svg              the signals, without a viewer

The viewer is the program `rerun` of the same version as this command's `rerun` crate (0.36): `pip install
rerun-sdk==0.36.3` or `cargo install rerun-cli --version 0.36.3 --locked`. With it, `--spawn` opens a run as it goes.

Exit status: 0 as expected; 1 an expectation failed; 2 usage; 3 bad input; 4 diverged; 130 stopped by Ctrl-C."
)]
struct Arguments {
    #[command(subcommand)]
    command: Subcommands,
}

#[derive(Debug, Subcommand)]
enum Subcommands {
    /// Run a scenario: recording, signals, summary, verdict
    Run(run::Arguments),
    /// Check a scenario or a URDF and say everything that is wrong
    Check(check::Arguments),
    /// Write a commented starter scenario
    New(new::Arguments),
    /// Show a URDF, or a scenario at t = 0
    View(view::Arguments),
    /// Small experiments on contact and friction, each figure beside its closed form
    Lab(lab::Arguments),
    /// Dispersed runs in parallel: table, report, recordings of the notable ones
    Campaign(Box<campaign::Arguments>),
    /// Two strategies, settings or versions on the same draws: which is better, by how much, how sure
    Compare(compare::Arguments),
    /// Join the tables of a campaign's shards
    Merge(merge::Arguments),
    /// The catalogue of scenarios against its baselines
    Regress(regress::Arguments),
    /// Make one run of a campaign again, bit for bit, and record it
    Replay(replay::Arguments),
    /// Where a scenario and a recording differ, what was left out, and how much better it predicts with it
    Diagnose(diagnose::Arguments),
    /// Write the recording that a rig would make if it were the scenario, to plan a test or to try a diagnosis
    Plant(plant::Arguments),
    /// Judge a folder of diagnoses against answer keys
    Score(score::Arguments),
    /// Print the JSON Schema of the scenario file, or of diagnosis.json
    Schema(schema::Arguments),
    /// Show what is in a recording: channels, rates, gaps, noise, and what is wrong with it
    Inspect(inspect::Arguments),
}

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Status {
    AsExpected,
    NotAsExpected,
    Diverged,
    Stopped,
}

/// Status of a bad input: a file that is missing, broken or contradicts itself.
const BAD_INPUT: u8 = 3;
/// Status of a command that a signal has stopped, as shells have it.
const STOPPED: u8 = 130;

fn main() -> ExitCode {
    // A reader that has seen enough (`| head`) ends the command quietly, as it ends any other.
    sigpipe::reset();
    let result = match Arguments::parse().command {
        Subcommands::Run(arguments) => run::main(&arguments),
        Subcommands::Check(arguments) => check::main(&arguments),
        Subcommands::New(arguments) => new::main(&arguments),
        Subcommands::View(arguments) => view::main(&arguments),
        Subcommands::Lab(arguments) => lab::main(&arguments),
        Subcommands::Campaign(arguments) => campaign::main(&arguments),
        Subcommands::Compare(arguments) => compare::main(&arguments),
        Subcommands::Merge(arguments) => merge::main(&arguments),
        Subcommands::Regress(arguments) => regress::main(&arguments),
        Subcommands::Replay(arguments) => replay::main(&arguments),
        Subcommands::Diagnose(arguments) => diagnose::main(&arguments),
        Subcommands::Plant(arguments) => plant::main(&arguments),
        Subcommands::Score(arguments) => score::main(&arguments),
        Subcommands::Schema(arguments) => schema::main(&arguments),
        Subcommands::Inspect(arguments) => inspect::main(&arguments),
    };
    match result {
        Ok(Status::AsExpected) => ExitCode::SUCCESS,
        Ok(Status::NotAsExpected) => ExitCode::from(1),
        Ok(Status::Diverged) => ExitCode::from(4),
        Ok(Status::Stopped) => ExitCode::from(STOPPED),
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(BAD_INPUT)
        }
    }
}
