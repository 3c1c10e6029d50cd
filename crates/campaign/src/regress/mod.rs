//! The catalogue against its baselines: what changed, by how much, from when on.
//!
//! A baseline is a JSON file that a person can read and a diff can show: outcome, metrics, work counters, curves at a few dozen
//! instants, what the mutations end in, and for a campaign the values that its metrics took. It moves only when it is blessed, with
//! a reason that is kept in it.

mod baseline;
mod changes;
mod junit;
mod margin;

pub use baseline::{Baseline, CampaignBaseline, Curves, Entry};
pub use changes::{Change, Group, find_changes};
pub use junit::junit_xml;

use crate::error::CampaignError;
use crate::execute::Watch;
use crate::plan::Plan;
use crate::row::Row;
use crate::run::{Keep, make};
use record::Recorder;
use scenario::recording::{recorder_plan, scene};
use scenario::{Mission, Scenario};
use serde_json::{Map, Value};
use std::path::Path;
use std::sync::Mutex;

/// Instants at which curves are kept, about.
const INSTANTS: u64 = 60;
/// Curves that are kept: where things are and how they touch.
const CURVES: [&str; 5] =
    ["body.*.position.*", "body.*.angular_velocity.*", "joint.*.position", "contact.*_force", "relative.*"];

/// Runs a scenario and says what it shows now, in the form of a baseline without history.
pub fn measure(scenario: &Scenario) -> Result<Baseline, CampaignError> {
    let mission = scenario::build(scenario)?;
    let recorder = recorder(&mission)?;
    let done = scenario::run(mission, Some(recorder), &mut [])?;
    let work = done.work();
    let counters = [
        ("steps", work.steps),
        ("rate_evaluations", work.rate_evaluations),
        ("contact_queries", work.contact_queries),
        ("solves", work.solves),
    ];
    let mut mutations = Map::new();
    for mutation in &scenario.mutations {
        mutations.insert(mutation.name.clone(), Value::from(mutated(scenario, &mutation.set)?));
    }
    Ok(Baseline {
        scenario: scenario.name.clone(),
        outcome: done.outcome.outcome.to_owned(),
        metrics: done.outcome.metrics_json(),
        work: counters.into_iter().map(|(name, n)| (name.to_owned(), Value::from(n))).collect(),
        mutations,
        curves: done.log.as_ref().map(Curves::of).unwrap_or_default(),
        ..Baseline::default()
    })
}

/// Outcome of a scenario with overrides.
fn mutated(scenario: &Scenario, set: &[String]) -> Result<String, CampaignError> {
    let source = &scenario.source;
    let overrides: Vec<String> = source.overrides().iter().chain(set).cloned().collect();
    let changed = scenario::parse(source.text(), source.file(), &overrides)?;
    let done = scenario::run(scenario::build(&changed)?, None, &mut [])?;
    Ok(done.outcome.outcome.to_owned())
}

fn recorder(mission: &Mission) -> Result<Recorder<'static>, CampaignError> {
    let mut plan = recorder_plan(mission, &scene(mission))?;
    plan.every = (mission.steps / INSTANTS).max(1);
    plan.keep = Box::new(|name| CURVES.iter().any(|pattern| scenario::glob_matches(pattern, name)));
    plan.links = Vec::new();
    Ok(Recorder::new(&mission.world, plan, None))
}

/// Makes the first runs of a scenario's campaign and keeps the values that its metrics took.
pub fn measure_campaign(
    scenario: &Scenario,
    runs: u32,
    threads: usize,
    watch: &dyn Watch,
) -> Result<CampaignBaseline, CampaignError> {
    let plan = Plan::new(scenario.clone(), None, Some(runs))?;
    let rows: Mutex<Vec<Row>> = Mutex::new(Vec::new());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|e| CampaignError::Threads { threads, reason: e.to_string() })?;
    let next = std::sync::atomic::AtomicU64::new(0);
    watch.begin(0, runs as usize);
    pool.broadcast(|_| {
        loop {
            let run = next.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            if run >= u64::from(runs) {
                return;
            }
            let row = make(&plan, run, Keep::Nothing).row;
            watch.finished(&row);
            rows.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push(row);
        }
    });
    let mut rows = rows.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    rows.sort_by_key(|row| row.run);
    Ok(CampaignBaseline::of(&rows))
}

/// Where the baseline of a scenario stands in a folder of baselines.
pub fn baseline_path(folder: &Path, scenario: &Scenario) -> std::path::PathBuf {
    folder.join(format!("{}.json", scenario.name))
}
