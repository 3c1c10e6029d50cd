//! `softdock diagnose`: where a scenario and a recording differ, what was left out, and how much better it predicts with it.

use crate::Status;
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;
use softdock::diagnose::{self, Watch, summary_text, write_diagnosis};
use softdock::record::{OutputFolder, RecordingSet};
use std::path::PathBuf;

/// Arguments of `softdock diagnose`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The scenario that models the rig
    scenario: PathBuf,
    /// The folder of the recording, with its recording.toml
    recording: PathBuf,
    /// Folder for report.html, diagnosis.json and patched.toml [default: out/diagnose/RECORDING]
    #[arg(long)]
    out: Option<PathBuf>,
    /// Changes a value of the scenario first, e.g. integrator.step_s=1e-4
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Print diagnosis.json instead of the summary
    #[arg(long)]
    json: bool,
    /// No progress bar
    #[arg(long)]
    quiet: bool,
    /// How much work a search may do, relative to the usual (minutes on two cores)
    #[arg(long, default_value_t = 1.0, value_name = "FACTOR")]
    effort: f64,
    /// Print what the search tries and where the time goes
    #[arg(long)]
    verbose: bool,
}

/// The progress bar.
struct Progress {
    bar: ProgressBar,
    is_verbose: bool,
}

impl Watch for Progress {
    fn stage(&self, name: &str, share: f64) {
        self.bar.set_message(name.to_owned());
        self.bar.set_position((1000.0 * share) as u64);
        self.step(name);
    }

    fn step(&self, what: &str) {
        if self.is_verbose {
            eprintln!("{:>7.1} s  {what}", self.bar.elapsed().as_secs_f64());
        }
    }
}

/// Diagnoses, writes the files, and says by the status whether the recording is explained.
pub(crate) fn main(arguments: &Arguments) -> anyhow::Result<Status> {
    let scenario = softdock::scenario::load(&arguments.scenario, &arguments.set)?;
    let set = RecordingSet::load(&arguments.recording)?;
    let name = arguments.recording.file_name().map_or_else(|| "recording".into(), |n| n.to_os_string());
    let target = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out/diagnose").join(name));
    let folder = OutputFolder::create(&target)?;
    let progress = Progress { bar: progress(arguments.quiet || arguments.verbose), is_verbose: arguments.verbose };
    let (diagnosis, evidence) = diagnose::run::diagnose_with(scenario.clone(), &set, (arguments.effort, &progress))?;
    progress.bar.finish_and_clear();
    for stage in evidence.timings.iter().filter(|_| arguments.verbose) {
        eprintln!("{:>7.1} s  {:<40} {:>9.1} s simulated", stage.wall_s, stage.name, stage.simulated_s);
    }
    let summary = serde_json::Map::from_iter([("verdict".to_owned(), json!(diagnosis.verdict.word()))]);
    write_diagnosis(&folder, &scenario, &diagnosis, &evidence)?;
    let place = folder.finish(&summary)?;
    if arguments.json {
        print!("{}", diagnosis.to_json()?);
    } else {
        println!("{}\nThe report is {}", summary_text(&diagnosis, &evidence), place.join("report.html").display());
    }
    Ok(if diagnosis.verdict.is_good() { Status::AsExpected } else { Status::NotAsExpected })
}

fn progress(quiet: bool) -> ProgressBar {
    let bar = if quiet { ProgressBar::hidden() } else { ProgressBar::new(1000) };
    if let Ok(style) = ProgressStyle::with_template("{msg:>36} {wide_bar} {percent:>3} %  {elapsed} (left {eta})") {
        bar.set_style(style);
    }
    bar
}
