//! What a campaign leaves for people: the report in three forms, and recordings of the notable runs.

use crate::replay::write_rrd;
use indicatif::ProgressBar;
use softdock::campaign::findings::{Findings, Options};
use softdock::campaign::report::{report_html, report_json, report_markdown};
use softdock::campaign::table::Table;
use softdock::campaign::{Keep, Plan, make};
use softdock::record::write_file;
use std::fs;
use std::path::Path;

/// How many of the worst runs, and of those that failed, are recorded.
const WORST: usize = 3;
const FAILURES: usize = 3;

/// Writes `report.html`, `report.json` and `report.md` into a campaign's folder.
pub(crate) fn write(target: &Path, table: &Table, findings: &Findings) -> anyhow::Result<()> {
    let recordings = target.join("recordings");
    let link = |run: u32| {
        let name = format!("{run:06}.rrd");
        recordings.join(&name).exists().then(|| (run, format!("recordings/{name}")))
    };
    let links: Vec<(u32, String)> = (0..table.len()).map(|row| table.run(row)).filter_map(link).collect();
    write_file(&target.join("report.html"), report_html(table, findings, &links).as_bytes())?;
    write_file(&target.join("report.json"), report_json(findings).as_bytes())?;
    write_file(&target.join("report.md"), report_markdown(findings).as_bytes())?;
    Ok(())
}

/// The findings of a table.
pub(crate) fn find(table: &Table, map: Option<(String, String)>) -> Findings {
    Findings::of(table, &Options { envelope: map, ..Options::default() })
}

/// Makes the notable runs again and records them for the viewer; those that are there already stay.
pub(crate) fn record_notable(plan: &Plan, target: &Path, findings: &Findings, quiet: bool) -> anyhow::Result<()> {
    let folder = target.join("recordings");
    fs::create_dir_all(&folder)?;
    let notable = &findings.notable;
    let mut runs: Vec<u32> = notable
        .worst
        .iter()
        .take(WORST)
        .chain(&notable.median)
        .chain(notable.first_failures.iter().take(FAILURES))
        .map(|n| n.run)
        .collect();
    runs.sort_unstable();
    runs.dedup();
    let bar = if quiet { ProgressBar::hidden() } else { ProgressBar::new(runs.len() as u64) };
    for run in runs {
        let file = folder.join(format!("{run:06}.rrd"));
        bar.set_message(format!("recording run {run}"));
        if !file.exists() {
            let finished = make(plan, u64::from(run), Keep::All);
            if let Some(log) = &finished.log {
                let partial = file.with_extension("partial");
                write_rrd(plan, &partial, (&finished.row, log))?;
                if partial.exists() {
                    fs::rename(&partial, &file)?;
                }
            }
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(())
}
