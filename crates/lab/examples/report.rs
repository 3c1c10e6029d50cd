//! Writes the report of all experiments, or of those named, without the command: `cargo run --example report -- FOLDER [NAME …]`.
#![allow(clippy::print_stdout)]

use lab::{LabError, Options, report};
use std::path::PathBuf;

fn main() -> Result<(), LabError> {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().unwrap_or_else(|| "out/lab-report".to_owned()));
    let names: Vec<String> = arguments.collect();
    let mut answers = Vec::new();
    for experiment in lab::catalogue().into_iter().filter(|e| names.is_empty() || names.iter().any(|n| n == e.name)) {
        if lab::real::lacks_recordings(&experiment, None) {
            eprintln!("{} SKIPPED: {}", experiment.name, lab::real::RealError::NoFolder);
            continue;
        }
        let started = std::time::Instant::now();
        answers.push((experiment, (experiment.run)(&Options::default())?));
        eprintln!("{} ({:.1} s)", experiment.name, started.elapsed().as_secs_f64());
    }
    let folder = record::OutputFolder::create(&folder)?;
    record::write_file(
        &folder.file("report.md"),
        (report::markdown(&answers) + &report::notes_markdown(&answers)).as_bytes(),
    )?;
    record::write_file(&folder.file("report.html"), report::html(&answers).as_bytes())?;
    folder.finish(&report::summary(&answers))?;
    println!("{}\n{}", report::markdown(&answers), report::count(&answers));
    Ok(())
}
