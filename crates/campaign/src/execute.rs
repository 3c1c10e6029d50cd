//! The runs of a campaign in parallel.
//!
//! Threads take the next run that is missing, in the order of runs, and hand what they made to one journal. Nothing of a run depends on
//! another, so that neither the threads nor an interruption show in the table.

use crate::error::CampaignError;
use crate::folder::Folder;
use crate::plan::Plan;
use crate::row::Row;
use crate::run::{Finished, Keep, make};
use crate::shard::Shard;
use crate::table_file::{TABLE_FILE, write_table};
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Instant;

/// Who wants to know how it goes.
pub trait Watch: Sync {
    /// Before the first run: how many are done already, and how many are to be made.
    fn begin(&self, done: usize, missing: usize);
    /// A run is over.
    fn finished(&self, row: &Row);
    /// Whether to stop after the runs that are on.
    fn is_cancelled(&self) -> bool {
        false
    }
}

/// What came of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Summary {
    /// Runs that were made now.
    pub made: usize,
    /// Runs in the folder, now all of the shard's, unless it was cancelled.
    pub done: usize,
    /// Of all of them: without a result.
    pub failed: usize,
    /// Of all of them: not as the scenario expects.
    pub unexpected: usize,
    /// Whether runs are still missing.
    pub is_cut_short: bool,
    /// Wall-clock time of the runs made now, s.
    pub wall_s: f64,
    /// Sum of the times of the single runs, s: simulation and building, and the building alone.
    pub runs_s: f64,
    /// Building alone, s.
    pub building_s: f64,
}

/// What all threads share.
struct Shared<'a> {
    folder: Mutex<(&'a mut Folder, fs::File)>,
    times: Mutex<[f64; 2]>,
    next: AtomicUsize,
    stop: AtomicBool,
    error: Mutex<Option<CampaignError>>,
}

/// Makes the missing runs of a shard and writes its table.
pub fn execute(
    plan: &Plan,
    folder: &mut Folder,
    (shard, threads): (Shard, usize),
    watch: &dyn Watch,
) -> Result<Summary, CampaignError> {
    let missing = folder.missing(plan.runs(), shard);
    watch.begin(folder.journal.len(), missing.len());
    let started = Instant::now();
    let path = folder.path.clone();
    let signals = prepare_signals(plan, &path)?;
    let clock = open_clock(&path)?;
    let shared = Shared {
        folder: Mutex::new((folder, clock)),
        times: Mutex::new([0.0; 2]),
        next: AtomicUsize::new(0),
        stop: AtomicBool::new(false),
        error: Mutex::new(None),
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|e| CampaignError::Threads { threads, reason: e.to_string() })?;
    pool.broadcast(|_| work(plan, &missing, (&path, signals), &shared, watch));
    let wall_s = started.elapsed().as_secs_f64();
    let Shared { folder, times, error, .. } = shared;
    let (folder, _) = folder.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    folder.journal.sync()?;
    if let Some(error) = error.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner) {
        return Err(error);
    }
    let [runs_s, building_s] = times.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    let left = folder.missing(plan.runs(), shard).len();
    let mut summary = Summary {
        made: missing.len() - left,
        is_cut_short: left > 0,
        wall_s,
        runs_s,
        building_s,
        ..Default::default()
    };
    conclude(plan, folder, &mut summary)?;
    Ok(summary)
}

/// Counts what is there, and writes the table where nothing is missing.
fn conclude(plan: &Plan, folder: &Folder, summary: &mut Summary) -> Result<(), CampaignError> {
    for row in folder.journal.rows()? {
        let row = row?;
        summary.done += 1;
        summary.failed += usize::from(row.has_failed());
        summary.unexpected += usize::from(!row.unmet.is_empty());
    }
    if !summary.is_cut_short {
        write_table(&folder.path.join(TABLE_FILE), &plan.header, || folder.journal.rows())?;
    }
    Ok(())
}

/// One thread: run after run until none is left.
fn work(plan: &Plan, missing: &[u64], (path, signals): (&Path, Keep), shared: &Shared<'_>, watch: &dyn Watch) {
    while !shared.stop.load(Ordering::Relaxed) && !watch.is_cancelled() {
        let Some(run) = missing.get(shared.next.fetch_add(1, Ordering::Relaxed)) else { return };
        let finished = make(plan, *run, signals);
        match keep(path, &finished, shared) {
            Ok(()) => watch.finished(&finished.row),
            Err(error) => {
                shared.stop.store(true, Ordering::Relaxed);
                if let Ok(mut first) = shared.error.lock() {
                    first.get_or_insert(error);
                }
            }
        }
    }
}

/// Signals first, then the journal: a run that stands in the journal has its signals.
fn keep(path: &Path, finished: &Finished, shared: &Shared<'_>) -> Result<(), CampaignError> {
    if let Some(log) = &finished.log {
        let file = path.join("signals").join(format!("{:06}.parquet", finished.row.run));
        let partial = file.with_extension("partial");
        record::write_parquet(&partial, &log.meta, &log.signals)?;
        fs::rename(&partial, &file).map_err(CampaignError::write(&file))?;
    }
    let [wall, building] = finished.wall_s;
    if let Ok(mut times) = shared.times.lock() {
        times[0] += wall;
        times[1] += building;
    }
    let Ok(mut guard) = shared.folder.lock() else { return Ok(()) };
    let (folder, clock) = &mut *guard;
    folder.journal.push(&finished.row)?;
    let line = format!("{},{wall:.6},{building:.6}\n", finished.row.run);
    clock.write_all(line.as_bytes()).map_err(CampaignError::write(&path.join("clock.csv")))
}

fn prepare_signals(plan: &Plan, path: &Path) -> Result<Keep, CampaignError> {
    if plan.campaign.signals.is_empty() {
        return Ok(Keep::Nothing);
    }
    let folder = path.join("signals");
    fs::create_dir_all(&folder).map_err(CampaignError::write(&folder))?;
    Ok(Keep::Signals)
}

/// Wall-clock figures stand apart from every result.
fn open_clock(path: &Path) -> Result<fs::File, CampaignError> {
    let path = path.join("clock.csv");
    let is_new = !path.exists();
    let file = OpenOptions::new().append(true).create(true).open(&path);
    let mut file = file.map_err(CampaignError::write(&path))?;
    if is_new {
        file.write_all(b"run,wall_s,building_s\n").map_err(CampaignError::write(&path))?;
    }
    Ok(file)
}
