//! What there is to see of a scenario: its run, its recording, its verdicts, its campaign, its regression.
//!
//! Everything but the text of the file itself, which a recording carries along: with it every key would change something.

use campaign::findings::{Findings, Options};
use campaign::regress::{Baseline, find_changes, measure};
use campaign::{Folder, Plan, Row, Shard, TABLE_FILE, Watch, check_demands, execute, read_table};
use record::{Log, Recorder};
use scenario::Scenario;
use scenario::recording::{recorder_plan, scene};
use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};

/// Digests of what there is to see, by name.
pub type Look = BTreeMap<&'static str, u64>;

/// Everything that a scenario shows, or why it cannot be used.
pub fn look(scenario: &Scenario) -> Result<Look, String> {
    let mut look = Look::new();
    run(scenario, &mut look)?;
    if !scenario.mutations.is_empty() || !scenario.margins.is_empty() {
        look.insert("regression", digest(&regression(scenario)?));
    }
    if let Some(own) = &scenario.campaign {
        let variants = own.variants.iter().map(|v| Some(v.name.as_str()));
        let texts: Result<Vec<String>, String> = variants.chain([None]).map(|v| campaign(scenario, v)).collect();
        look.insert("campaign", digest(&texts?));
    }
    Ok(look)
}

fn digest(value: &impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    value.hash(&mut hasher);
    hasher.finish()
}

fn said(error: impl std::fmt::Display) -> String {
    error.to_string()
}

fn run(scenario: &Scenario, look: &mut Look) -> Result<(), String> {
    let mission = scenario::build(scenario).map_err(said)?;
    let plan = recorder_plan(&mission, &scene(&mission)).map_err(said)?;
    let recorder = Recorder::new(&mission.world, plan, None);
    let done = scenario::run(mission, Some(recorder), &mut []).map_err(said)?;
    look.insert("state", digest(&format!("{:?}", done.mission.world.state())));
    look.insert("recording", digest(&done.log.as_ref().map(recorded)));
    look.insert("outcome", digest(&format!("{:?}", done.outcome)));
    look.insert("verdicts", digest(&format!("{:?}", done.verdicts)));
    Ok(())
}

/// Name, channels and samples, to the bit.
fn recorded(log: &Log) -> (String, Vec<u64>) {
    let numbers = log.signals.channels.iter().flat_map(|c| &c.values).chain(&log.signals.times);
    let names: Vec<&str> = log.signals.channels.iter().map(|c| c.spec.name.as_str()).collect();
    (format!("{} {names:?} {:?}", log.meta.scenario, log.contacts), numbers.map(|x| x.to_bits()).collect())
}

/// What differs from a baseline that is a little off everywhere.
fn regression(scenario: &Scenario) -> Result<String, String> {
    let now = measure(scenario).map_err(said)?;
    let mut then = Baseline { mutations: Default::default(), ..now.clone() };
    for value in then.metrics.values_mut() {
        if let Some(x) = value.as_f64() {
            *value = (x * (1.0 + OFF)).into();
        }
    }
    for x in then.curves.channels.values_mut().flatten().flatten() {
        *x *= 1.0 + OFF;
    }
    Ok(format!("{:?}", find_changes(scenario, &then, &now)))
}

/// Share by which the baseline is off.
const OFF: f64 = 0.01;

/// The campaign's table, findings, demands and kept signals.
fn campaign(scenario: &Scenario, variant: Option<&str>) -> Result<String, String> {
    let plan = Plan::new(scenario.clone(), variant, None).map_err(said)?;
    let dir = tempfile::tempdir().map_err(said)?;
    let place = dir.path().join("c");
    let mut folder = Folder::open(&place, &plan, Shard::WHOLE, false).map_err(said)?;
    execute(&plan, &mut folder, (Shard::WHOLE, 1), &Nobody).map_err(said)?;
    let table = read_table(&place.join(TABLE_FILE)).map_err(said)?;
    let findings = Findings::of(&table, &Options::default());
    let demands = check_demands(&plan.campaign.expects, &table);
    let draws: Vec<Vec<f64>> = (0..plan.runs()).map(|run| plan.design.draw(run)).collect();
    let (words, header) = (plan.design.words(), (&plan.header.scenario, &plan.header.description, &plan.header.inputs));
    let report = campaign::report::report_markdown(&findings);
    Ok(format!("{variant:?} {draws:?} {words} {header:?} {demands:?} {report} {:?}", kept(&place.join("signals"))?))
}

/// Channels and numbers that were kept of every run.
fn kept(folder: &std::path::Path) -> Result<Vec<String>, String> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Ok(Vec::new()) };
    let mut files: Vec<_> = entries.filter_map(|e| Some(e.ok()?.path())).collect();
    files.sort();
    let text = |file: &std::path::PathBuf| Ok(format!("{:?}", record::read_parquet(file).map_err(said)?.1));
    files.iter().map(text).collect()
}

/// Nobody watches.
struct Nobody;

impl Watch for Nobody {
    fn begin(&self, _: usize, _: usize) {}
    fn finished(&self, _: &Row) {}
}
