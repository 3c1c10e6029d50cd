//! One run of a campaign, from its index to its row.

use crate::error::CampaignError;
use crate::plan::Plan;
use crate::row::Row;
use record::{Log, Recorder};
use scenario::recording::{recorder_plan, scene};
use scenario::{Mission, glob_matches};
use serde_json::{Map, Value, json};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

/// A finished run.
#[derive(Debug)]
pub struct Finished {
    /// Its row.
    pub row: Row,
    /// Its selected signals, where any were wanted.
    pub log: Option<Log>,
    /// Time that it took, s, and the part of it before the first step.
    pub wall_s: [f64; 2],
}

/// What is recorded of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keep {
    /// Metrics only.
    Nothing,
    /// The campaign's `signals`.
    Signals,
    /// Everything, for a viewer.
    All,
}

/// Makes run `run`. Whatever goes wrong in it stands in its row; nothing of it stops the campaign.
pub fn make(plan: &Plan, run: u64, keep: Keep) -> Finished {
    let started = Instant::now();
    let result = catch_unwind(AssertUnwindSafe(|| attempt(plan, run, keep, started)));
    let mut finished = result.unwrap_or_else(|_| {
        let reason = "the program panicked in this run; please report it, with the scenario";
        Finished { row: failed(plan, run, "panicked", reason.to_owned()), log: None, wall_s: [0.0; 2] }
    });
    finished.wall_s[0] = started.elapsed().as_secs_f64();
    finished
}

fn attempt(plan: &Plan, run: u64, keep: Keep, started: Instant) -> Finished {
    let built = plan.scenario_of(run).and_then(|(s, drawn)| {
        let mission = plan.build(&s)?;
        scenario::check_start(&mission)?;
        let recorder = (keep != Keep::Nothing).then(|| recorder_of(plan, &mission, keep)).transpose()?;
        Ok((mission, drawn, recorder))
    });
    let (mission, drawn, recorder) = match built {
        Ok(built) => built,
        Err(error) => {
            let row = failed(plan, run, "unbuildable", one_line(&error));
            return Finished { row, log: None, wall_s: [0.0; 2] };
        }
    };
    let applied = plan.read_back(&mission);
    let before = started.elapsed().as_secs_f64();
    match scenario::run(mission, recorder, &mut []) {
        Ok(done) => {
            let row = row_of(&done, (run, drawn, applied));
            Finished { row, log: done.log, wall_s: [0.0, before] }
        }
        Err(error) => {
            let row = failed(plan, run, "unrecorded", error.to_string());
            Finished { row, log: None, wall_s: [0.0, before] }
        }
    }
}

fn recorder_of(plan: &Plan, mission: &Mission, keep: Keep) -> Result<Recorder<'static>, CampaignError> {
    let mut recording = recorder_plan(mission, &scene(mission))?;
    if keep == Keep::Signals {
        let patterns = plan.campaign.signals.clone();
        recording.keep = Box::new(move |name| patterns.iter().any(|p| glob_matches(p, name)));
        recording.links = Vec::new();
    }
    Ok(Recorder::new(&mission.world, recording, None))
}

fn row_of(done: &scenario::Finished, (run, inputs, applied): (u64, Vec<f64>, Vec<Option<f64>>)) -> Row {
    let work = done.work();
    let counters = json!({
        "steps": work.steps,
        "rate_evaluations": work.rate_evaluations,
        "contact_queries": work.contact_queries,
        "solves": work.solves,
        "unconverged_steps": work.unconverged_steps,
    });
    Row {
        run,
        seed: done.mission.scenario.seed,
        inputs,
        applied,
        outcome: done.outcome.outcome.to_owned(),
        reason: done.outcome.reason.clone(),
        unmet: done.verdicts.iter().filter(|v| !v.met).map(|v| v.text.clone()).collect(),
        metrics: done.outcome.metrics_json(),
        work: counters.as_object().cloned().unwrap_or_default(),
    }
}

fn failed(plan: &Plan, run: u64, outcome: &str, reason: String) -> Row {
    let inputs = plan.design.draw(run);
    let applied = vec![None; inputs.len()];
    let seed = crate::chance::run_seed(plan.scenario.seed, run);
    let unmet = vec![reason.clone()];
    let (metrics, work): (Map<String, Value>, Map<String, Value>) = Default::default();
    Row { run, seed, inputs, applied, outcome: outcome.to_owned(), reason, unmet, metrics, work }
}

/// An error of several lines in one, without the file's place, which is that of the nominal scenario.
fn one_line(error: &CampaignError) -> String {
    error.to_string().lines().map(str::trim).collect::<Vec<_>>().join("; ")
}
