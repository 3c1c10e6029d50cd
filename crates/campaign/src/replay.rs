//! Any run of a table again, and whether it came out the same to the bit.

use crate::error::CampaignError;
use crate::plan::Plan;
use crate::row::Row;
use crate::run::{Finished, Keep, make};
use crate::table::Table;
use crate::table_file::rows_of;
use std::path::Path;

/// A run that was made again.
#[derive(Debug)]
pub struct Replayed {
    /// What came now.
    pub finished: Finished,
    /// Columns in which it differs from the table: name, then, now. Empty: identical to the bit.
    pub differences: Vec<(String, String, String)>,
}

/// Makes run `run` of a table again.
pub fn replay(plan: &Plan, (path, table): (&Path, &Table), run: u64) -> Result<Replayed, CampaignError> {
    if plan.header.fingerprint != table.header.fingerprint {
        return Err(CampaignError::table(
            path,
            "was made of another scenario, other robots, other overrides or another version of softdock than what is here now; \
             go back to those, or make the campaign anew",
        ));
    }
    let rows = rows_of(table);
    let Some(then) = rows.iter().find(|row| row.run == run) else {
        let have = match (rows.first(), rows.last()) {
            (Some(first), Some(last)) => format!("{} runs from {} to {}", rows.len(), first.run, last.run),
            _ => "none".to_owned(),
        };
        return Err(CampaignError::NoSuchRun { path: path.to_owned(), run, have });
    };
    let finished = make(plan, run, Keep::All);
    let differences = compare(then, &finished.row, plan);
    Ok(Replayed { finished, differences })
}

fn compare(then: &Row, now: &Row, plan: &Plan) -> Vec<(String, String, String)> {
    let mut found = Vec::new();
    let mut check = |name: String, a: String, b: String| {
        if a != b {
            found.push((name, a, b));
        }
    };
    check("seed".into(), then.seed.to_string(), now.seed.to_string());
    check("outcome".into(), then.outcome.clone(), now.outcome.clone());
    check("reason".into(), then.reason.clone(), now.reason.clone());
    for (k, input) in plan.header.inputs.iter().enumerate() {
        let bits = |values: &[f64]| values.get(k).map_or("–".to_owned(), |x| format!("{x:?}"));
        check(format!("input.{}", input.name), bits(&then.inputs), bits(&now.inputs));
        let bits =
            |values: &[Option<f64>]| values.get(k).copied().flatten().map_or("–".to_owned(), |x| format!("{x:?}"));
        check(format!("applied.{}", input.name), bits(&then.applied), bits(&now.applied));
    }
    let names: Vec<&String> = then.metrics.keys().chain(now.metrics.keys()).collect();
    for name in names {
        // Numbers print with as many digits as tell their bits apart; a whole number stands as a number in the table.
        let shown = |row: &Row| match row.metrics.get(name) {
            Some(serde_json::Value::Null) | None => "–".to_owned(),
            Some(value) => value.as_f64().map_or_else(|| value.to_string(), |x| format!("{x:?}")),
        };
        check(name.clone(), shown(then), shown(now));
    }
    found.dedup();
    found
}
