//! Shards → one table, the same to the byte as that of an undivided campaign.

use crate::error::CampaignError;
use crate::row::Row;
use crate::table_file::{TABLE_FILE, read_table, rows_of, write_table};
use std::path::{Path, PathBuf};

/// What a merge found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Merged {
    /// Runs in the table.
    pub runs: usize,
    /// Runs below the highest one that no shard has, and those up to the number wanted.
    pub missing: Vec<u64>,
    /// Runs that stood in several shards, all alike.
    pub repeated: usize,
    /// Where the table is.
    pub table: PathBuf,
}

/// Joins the tables of shards (folders or files) into `out`/table.parquet. Runs that several have must be alike.
pub fn merge(shards: &[PathBuf], runs: Option<u64>, out: &Path) -> Result<Merged, CampaignError> {
    let mut header = None;
    let mut rows: Vec<(Row, &PathBuf)> = Vec::new();
    for path in shards {
        let table = read_table(path)?;
        let first = header.get_or_insert_with(|| table.header.clone());
        if *first != table.header {
            let what = difference(&first.scenario, &table.header.scenario);
            return Err(CampaignError::NotOneCampaign { a: shards[0].clone(), b: path.clone(), what });
        }
        rows.extend(rows_of(&table).into_iter().map(|row| (row, path)));
    }
    rows.sort_by_key(|(row, _)| row.run);
    let before = rows.len();
    if let Some(pair) = rows.windows(2).find(|pair| pair[0].0.run == pair[1].0.run && pair[0].0 != pair[1].0) {
        let what = format!("run {} came out differently", pair[0].0.run);
        return Err(CampaignError::NotOneCampaign { a: pair[0].1.clone(), b: pair[1].1.clone(), what });
    }
    rows.dedup_by_key(|(row, _)| row.run);
    let (Some(header), Some(last)) = (header, rows.last().map(|(row, _)| row.run)) else {
        return Err(CampaignError::table(out, "there is nothing to merge: no shard has a run"));
    };
    let wanted = runs.unwrap_or(last + 1).max(last + 1);
    let has = |run: &u64| rows.binary_search_by_key(run, |(row, _)| row.run).is_ok();
    let missing: Vec<u64> = (0..wanted).filter(|run| !has(run)).collect();
    std::fs::create_dir_all(out).map_err(CampaignError::write(out))?;
    let table = out.join(TABLE_FILE);
    write_table(&table, &header, || Ok(rows.iter().map(|(row, _)| Ok(row.clone()))))?;
    Ok(Merged { runs: rows.len(), missing, repeated: before - rows.len(), table })
}

fn difference(a: &str, b: &str) -> String {
    if a == b {
        return "the scenario, its robots, its overrides or softdock's version differ".to_owned();
    }
    format!("\"{a}\" and \"{b}\"")
}
