//! `softdock lab`: small experiments on contact and friction, each figure beside its closed form.

use crate::Status;
use anyhow::anyhow;
use softdock::lab::report::{self, Answer};
use softdock::lab::{self, Experiment, LabError, Options, Outcome};
use softdock::record::{self, OutputFolder};
use std::path::PathBuf;
use std::time::Instant;

/// Arguments of `softdock lab`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The experiment; without it, all are listed with their questions
    name: Option<String>,
    /// Run all, print one table and write report.md and report.html with all charts
    #[arg(long, conflicts_with = "name")]
    report: bool,
    /// Folder for figures.json, charts.svg and run.rrd, or for the report [default: out/lab/NAME, out/lab-report]
    #[arg(long)]
    out: Option<PathBuf>,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
    /// Step of the integrator, s, in place of the experiment's own
    #[arg(long, value_name = "SECONDS", value_parser = parse_step)]
    step_s: Option<f64>,
    /// Shorter runs and coarser grids, for a first look
    #[arg(long)]
    quick: bool,
    /// Folder of the recordings of real things [default: $SOFTDOCK_RECORDINGS]
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Fit parameters to the recordings anew (minutes) in place of judging the committed ones
    #[arg(long)]
    refit: bool,
}

fn parse_step(text: &str) -> Result<f64, String> {
    let step: f64 = text.parse().map_err(|_| format!("\"{text}\" is not a number"))?;
    if step > 0.0 && step <= 0.1 { Ok(step) } else { Err("the step must be above 0 and at most 0.1 s".to_owned()) }
}

/// Lists, runs one, or reports on all.
pub(crate) fn main(arguments: &Arguments) -> anyhow::Result<Status> {
    let (step, quick, data, refit) = (arguments.step_s, arguments.quick, arguments.data.clone(), arguments.refit);
    let options = Options { step, quick, data, refit };
    if arguments.report {
        return report_on_all(arguments, &options);
    }
    let Some(name) = &arguments.name else {
        list(arguments.json);
        return Ok(Status::AsExpected);
    };
    let experiment = lab::find(name).ok_or_else(|| {
        let names: Vec<&str> = lab::catalogue().iter().map(|e| e.name).collect();
        anyhow!("there is no experiment \"{name}\"; the experiments are {}", names.join(", "))
    })?;
    run_one(arguments, experiment, &options)
}

fn list(as_json: bool) {
    let all = lab::catalogue();
    if as_json {
        let rows = all.iter().map(|e| serde_json::json!({ "experiment": e.name, "question": e.question }));
        println!("{:#}", serde_json::Value::Array(rows.collect()));
        return;
    }
    let width = all.iter().map(|e| e.name.len()).max().unwrap_or(0);
    println!("Experiments; softdock lab NAME runs one, softdock lab --report all:\n");
    for experiment in all {
        println!("  {:width$}  {}", experiment.name, experiment.question);
    }
}

/// `None` where the run diverged, which has been said.
fn answer(experiment: Experiment, options: &Options) -> anyhow::Result<Option<Answer>> {
    match (experiment.run)(options) {
        Ok(outcome) => Ok(Some((experiment, outcome))),
        Err(error @ LabError::Step { .. }) => {
            eprintln!("error: {error}");
            Ok(None)
        }
        Err(error) => Err(error.into()),
    }
}

/// Says of an experiment that cannot be part of a report that its recordings are not here.
fn lacks_recordings(experiment: Experiment, options: &Options) -> bool {
    let lacks = lab::real::lacks_recordings(&experiment, options.data.as_deref());
    if lacks {
        eprintln!("{} SKIPPED: {}", experiment.name, lab::real::RealError::NoFolder);
    }
    lacks
}

fn run_one(arguments: &Arguments, experiment: Experiment, options: &Options) -> anyhow::Result<Status> {
    let target = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out/lab").join(experiment.name));
    let folder = OutputFolder::create(&target)?;
    let Some(answer) = answer(experiment, options)? else { return Ok(Status::Diverged) };
    let answers = [answer];
    let outcome = &answers[0].1;
    let figures = report::figures_json(&answers);
    record::write_file(&folder.file("figures.json"), format!("{:#}\n", figures[0]).as_bytes())?;
    if !outcome.charts.is_empty() {
        record::write_file(&folder.file("charts.svg"), report::charts_svg(outcome).as_bytes())?;
    }
    write_run(&folder, outcome, &report::markdown(&answers))?;
    let place = folder.finish(&report::summary(&answers))?;
    if arguments.json {
        println!("{:#}", figures[0]);
    } else {
        print(&answers[0]);
        println!("\n  The results are in {}", place.display());
    }
    Ok(status(&answers))
}

fn write_run(folder: &OutputFolder, outcome: &Outcome, text: &str) -> anyhow::Result<()> {
    if let Some((log, scene)) = &outcome.run {
        record::write_parquet(&folder.file("signals.parquet"), &log.meta, &log.signals)?;
        #[cfg(feature = "rerun")]
        record::rerun_sink::write_rrd(&folder.file("run.rrd"), log, scene, text)?;
        let _ = (scene, text);
    }
    Ok(())
}

fn status(answers: &[Answer]) -> Status {
    if answers.iter().all(|(_, o)| o.holds()) { Status::AsExpected } else { Status::NotAsExpected }
}

/// A table with columns as wide as they need.
fn print((experiment, outcome): &Answer) {
    println!("{}: {}\n", experiment.name, experiment.question);
    let mut rows = vec![["figure", "measured", "should be", "allowed", "holds"].map(str::to_owned)];
    rows.extend(report::rows(outcome));
    let width = |k: usize| rows.iter().map(|r| r[k].chars().count()).max().unwrap_or(0);
    let widths = [0, 1, 2, 3].map(width);
    for row in &rows {
        let cells: Vec<String> = row.iter().zip(widths).map(|(c, w)| format!("{c:w$}")).collect();
        println!("  {}  {}", cells.join("  "), row[4]);
    }
    for note in &outcome.notes {
        println!();
        note.lines().for_each(|line| println!("  {line}"));
    }
}

fn report_on_all(arguments: &Arguments, options: &Options) -> anyhow::Result<Status> {
    let target = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out/lab-report"));
    let folder = OutputFolder::create(&target)?;
    let (mut answers, mut first_failure, mut diverged) = (Vec::new(), None, false);
    for experiment in lab::catalogue().into_iter().filter(|e| !lacks_recordings(*e, options)) {
        let started = Instant::now();
        // One experiment that fails takes nothing from the report of the others.
        match answer(experiment, options) {
            Ok(Some(answer)) => answers.push(answer),
            Ok(None) => diverged = true,
            Err(error) => {
                eprintln!("error: {}: {error:#}", experiment.name);
                first_failure.get_or_insert(error.context(format!("{} could not be run", experiment.name)));
            }
        }
        eprintln!("{} ({:.1} s)", experiment.name, started.elapsed().as_secs_f64());
    }
    let (table, figures) = (report::markdown(&answers), report::figures_json(&answers));
    record::write_file(&folder.file("report.md"), (table.clone() + &report::notes_markdown(&answers)).as_bytes())?;
    record::write_file(&folder.file("report.html"), report::html(&answers).as_bytes())?;
    record::write_file(&folder.file("figures.json"), format!("{figures:#}\n").as_bytes())?;
    let place = folder.finish(&report::summary(&answers))?;
    if arguments.json {
        println!("{figures:#}");
    } else {
        println!("{table}\n{}\nThe charts are in {}/report.html", report::count(&answers), place.display());
    }
    match first_failure {
        Some(error) => Err(error),
        None if diverged => Ok(Status::Diverged),
        None => Ok(status(&answers)),
    }
}
