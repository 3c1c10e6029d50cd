//! `softdock plant`: the recording that a rig would make if it were the scenario.

use crate::Status;
use anyhow::{Context, anyhow};
use serde_json::{Map, json};
use softdock::diagnose::{self, synthetic};
use softdock::record::{self, OutputFolder, RecordingSet};
use softdock::scenario::spec::Effect;
use std::path::PathBuf;

/// Arguments of `softdock plant`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The runs have the commands, instants, noise figures and roundings of the recording that is given, and start where it says
they did. Would the rig show weak eddy currents? Plant them, and diagnose with the scenario that does not have them:
  softdock plant scenarios/rigs/tumbler.toml --like tests/recordings/tumble-inertia --out out/planted \\
      --effect 'name = \"angular-damping\", place = \"body:target\", c = 0.01' --key out/keys/planted.json
  softdock diagnose scenarios/rigs/tumbler.toml out/planted")]
pub(crate) struct Arguments {
    /// The scenario that models the rig; its own effects act
    scenario: PathBuf,
    /// The recording whose commands, sensors and starts are taken
    #[arg(long, value_name = "RECORDING")]
    like: PathBuf,
    /// Folder for recording.toml and the runs
    #[arg(long)]
    out: PathBuf,
    /// An effect that acts as well, written like an entry of the scenario in one line
    #[arg(long = "effect", value_name = "TOML")]
    effects: Vec<String>,
    /// Changes a value of the scenario first
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Seed of the sensors' noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Also writes what was planted, as a key for `softdock score`
    #[arg(long, value_name = "FILE")]
    key: Option<PathBuf>,
}

/// Replays, disturbs, writes.
pub(crate) fn main(arguments: &Arguments) -> anyhow::Result<Status> {
    let mut scenario = softdock::scenario::load(&arguments.scenario, &arguments.set)?;
    for text in &arguments.effects {
        scenario.effects.push(effect(text)?);
    }
    let like = RecordingSet::load(&arguments.like)?;
    let folder = OutputFolder::create(&arguments.out)?;
    let effects = scenario.effects.clone();
    let set = diagnose::synthesise(scenario, &like, &synthetic::as_recorded, arguments.seed)?;
    set.save(&folder.file(""))?;
    let summary = Map::from_iter([
        ("scenario".to_owned(), json!(arguments.scenario)),
        ("like".to_owned(), json!(arguments.like)),
        ("seed".to_owned(), json!(arguments.seed)),
    ]);
    let place = folder.finish(&summary)?;
    if let Some(file) = &arguments.key {
        let concealed = |e: &Effect| json!({ "name": e.name, "place": e.place, "params": e.params });
        let concealed: Vec<_> = effects.iter().map(concealed).collect();
        let key = json!({ "rig": set.rig, "effects": concealed, "oracle": { "true": 1.0 } });
        if let Some(parent) = file.parent() {
            std::fs::create_dir_all(parent).with_context(|| format!("{}", parent.display()))?;
        }
        record::write_file(file, format!("{key:#}\n").as_bytes())?;
    }
    println!("{} runs are in {}", set.runs.len(), place.display());
    Ok(Status::AsExpected)
}

/// An entry in one line.
fn effect(text: &str) -> anyhow::Result<Effect> {
    let wrapped = format!("effect = {{ {} }}", text.trim());
    let table: toml::Table = wrapped.parse().with_context(|| format!("--effect '{text}'"))?;
    let entry = table.get("effect").cloned().ok_or_else(|| anyhow!("--effect '{text}' is no entry"))?;
    entry.try_into().with_context(|| format!("--effect '{text}'"))
}
