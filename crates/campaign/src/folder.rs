//! The folder of a campaign: who it is, what is done, what is left.
//!
//! | file | holds |
//! | --- | --- |
//! | `campaign.json` | which campaign it is: fingerprint, scenario, runs, shard |
//! | `runs.jsonl` | every finished run, the moment it is over |
//! | `clock.csv` | how long each took: no part of any result |
//! | `table.parquet` | all runs, when all are there |
//! | `signals/` | selected channels, a file a run |
//! | `recordings/` | runs worth seeing, for the Rerun viewer |
//! | `report.html`, `report.json`, `report.md` | what it all says |

use crate::error::CampaignError;
use crate::journal::Journal;
use crate::plan::Plan;
use crate::shard::Shard;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};

/// Value of the key `format` in `campaign.json`.
const FORMAT: &str = "softdock-campaign-folder-1";
/// Name of the file that says which campaign a folder holds.
const IDENTITY: &str = "campaign.json";

/// Which campaign a folder holds.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    format: String,
    /// Name of the scenario.
    pub scenario: String,
    /// Its file, absolute.
    pub file: PathBuf,
    /// Overrides that it was loaded with.
    pub overrides: Vec<String>,
    /// Variant of its campaign.
    pub variant: Option<String>,
    /// Digest of all that the runs depend on.
    pub fingerprint: String,
    /// Runs of the whole campaign.
    pub runs: u64,
    /// Shard that this folder is, and how many there are.
    pub shard: [u64; 2],
}

/// An open folder.
#[derive(Debug)]
pub struct Folder {
    /// Where it is.
    pub path: PathBuf,
    pub(crate) journal: Journal,
}

impl Folder {
    /// Opens the folder of a plan's shard: a new one, or, to resume, the one that is there.
    pub fn open(path: &Path, plan: &Plan, shard: Shard, resume: bool) -> Result<Self, CampaignError> {
        let identity = Identity {
            format: FORMAT.to_owned(),
            scenario: plan.header.scenario.clone(),
            file: std::path::absolute(plan.scenario.source.file()).map_err(CampaignError::read(path))?,
            overrides: plan.scenario.source.overrides().to_vec(),
            variant: plan.variant.clone(),
            fingerprint: plan.header.fingerprint.clone(),
            runs: plan.runs(),
            shard: [shard.index, shard.count],
        };
        let known = read_identity(path)?;
        match &known {
            Some(known) => check_same(path, known, &identity)?,
            None => check_free(path)?,
        }
        fs::create_dir_all(path).map_err(CampaignError::write(path))?;
        let journal = Journal::open(&path.join("runs.jsonl"))?;
        if let Some(known) = known.filter(|_| !resume) {
            return Err(CampaignError::Unfinished { path: path.to_owned(), done: journal.len(), runs: known.runs });
        }
        let text = serde_json::to_string_pretty(&identity).map_err(|e| CampaignError::table(path, e))?;
        record::write_file(&path.join(IDENTITY), format!("{text}\n").as_bytes())?;
        Ok(Self { path: path.to_owned(), journal })
    }

    /// Runs of a shard that are still to be made, ascending.
    pub fn missing(&self, runs: u64, shard: Shard) -> Vec<u64> {
        let mut done = self.journal.runs().peekable();
        (0..runs)
            .filter(|run| shard.has(*run))
            .filter(|run| {
                while done.next_if(|d| d < run).is_some() {}
                done.peek() != Some(run)
            })
            .collect()
    }
}

/// What a folder says that it holds; `None` where it says nothing.
pub fn read_identity(path: &Path) -> Result<Option<Identity>, CampaignError> {
    let file = path.join(IDENTITY);
    if !file.exists() {
        return Ok(None);
    }
    let text = fs::read_to_string(&file).map_err(CampaignError::read(&file))?;
    let identity: Identity = serde_json::from_str(&text).map_err(|e| CampaignError::table(&file, e))?;
    Ok(Some(identity))
}

fn check_same(path: &Path, known: &Identity, wanted: &Identity) -> Result<(), CampaignError> {
    let other = |what: String| Err(CampaignError::OtherCampaign { path: path.to_owned(), what });
    if known.scenario != wanted.scenario {
        return other(format!("of \"{}\", not \"{}\"", known.scenario, wanted.scenario));
    }
    if known.shard != wanted.shard {
        let words = |[i, n]: [u64; 2]| format!("shard {i}/{n}");
        return other(format!("{}, not {}", words(known.shard), words(wanted.shard)));
    }
    if known.fingerprint != wanted.fingerprint {
        return other("the scenario, its robots, its overrides or softdock's version have changed since".to_owned());
    }
    Ok(())
}

/// A folder without a campaign must be empty.
fn check_free(path: &Path) -> Result<(), CampaignError> {
    if !path.exists() {
        return Ok(());
    }
    let mut entries = fs::read_dir(path).map_err(CampaignError::read(path))?;
    match entries.next() {
        Some(Ok(entry)) => {
            let entry = entry.file_name().to_string_lossy().into_owned();
            Err(CampaignError::ForeignFolder { path: path.to_owned(), entry })
        }
        Some(Err(error)) => Err(CampaignError::read(path)(error)),
        None => Ok(()),
    }
}
