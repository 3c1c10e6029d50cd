//! A campaign's table: a row a run, in order of the runs, column by column.
//!
//! | column | holds |
//! | --- | --- |
//! | `run`, `seed` | index of the run, its seed |
//! | `input.<name>` | drawn value of a dispersed number, in the unit of its key |
//! | `applied.<name>` | the same, read back from the model that was built |
//! | `outcome`, `reason` | one word; a sentence |
//! | `work.<counter>` | steps, solves, contact queries |
//! | anything else | a metric, as `summary.json` names it |
//!
//! A cell is empty where the run has no such metric (nothing touched, nothing latched). Columns without a single value are left out.

use serde::{Deserialize, Serialize};

/// What the table is of. The same for all shards of a campaign, whatever the number of runs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// Name of the scenario.
    pub scenario: String,
    /// What it shows; may be empty.
    pub description: String,
    /// Version of softdock.
    pub version: String,
    /// Seed of the campaign.
    pub seed: u64,
    /// The flag among the metrics that counts as success; empty where there is none.
    pub success: String,
    /// How the inputs are drawn, in words.
    pub sampling: String,
    /// The dispersed inputs, in the order of the file.
    pub inputs: Vec<Input>,
    /// The scenario with all defaults, before any dispersion.
    pub toml: String,
    /// Digest of everything that the runs depend on.
    pub fingerprint: String,
}

/// A dispersed input.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Input {
    /// Name of its columns, without prefix.
    pub name: String,
    /// Path of the number in the scenario.
    pub path: String,
    /// Its distribution, in words.
    pub distribution: String,
    /// Where its applied value is read back from: the built model, or the scenario that it was built of.
    #[serde(default)]
    pub read_from: String,
}

/// The table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// What it is of.
    pub header: Header,
    /// Columns, all of the same length.
    pub columns: Vec<Column>,
}

/// One column.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Its cells.
    pub cells: Cells,
}

/// Cells of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Cells {
    /// Indices, seeds and counters.
    Integers(Vec<Option<i64>>),
    /// Numbers, finite.
    Numbers(Vec<Option<f64>>),
    /// Flags.
    Flags(Vec<Option<bool>>),
    /// Texts.
    Texts(Vec<Option<String>>),
}

/// Prefix of the columns of drawn values.
pub const INPUT: &str = "input.";
/// Prefix of the columns of values read back from the model.
pub const APPLIED: &str = "applied.";
/// Prefix of the columns of counters.
pub const WORK: &str = "work.";
/// Columns that are neither inputs nor metrics.
const OTHERS: [&str; 6] = ["run", "seed", "outcome", "reason", "as_expected", "not_as_expected"];

impl Table {
    /// Number of runs.
    pub fn len(&self) -> usize {
        self.columns.iter().map(|column| column.cells.len()).max().unwrap_or(0)
    }

    /// Whether there is no run.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A column.
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// A column's numbers.
    pub fn numbers(&self, name: &str) -> Option<Vec<Option<f64>>> {
        self.column(name)?.cells.numbers()
    }

    /// A text of a run; empty where there is none.
    pub fn text(&self, name: &str, row: usize) -> &str {
        match self.column(name).map(|column| &column.cells) {
            Some(Cells::Texts(texts)) => texts.get(row).and_then(Option::as_deref).unwrap_or(""),
            _ => "",
        }
    }

    /// Index of the run in a row.
    pub fn run(&self, row: usize) -> u32 {
        let index = match self.column("run").map(|column| &column.cells) {
            Some(Cells::Integers(runs)) => runs.get(row).copied().flatten(),
            _ => None,
        };
        index.and_then(|run| u32::try_from(run).ok()).unwrap_or(row as u32)
    }

    /// Columns that are metrics: all but inputs, counters, and what names the run and its outcome.
    pub fn metrics(&self) -> impl Iterator<Item = &Column> {
        let is_metric = |name: &str| ![INPUT, APPLIED, WORK].iter().any(|prefix| name.starts_with(prefix));
        self.columns.iter().filter(move |c| is_metric(&c.name) && !OTHERS.contains(&c.name.as_str()))
    }

    /// Names of the inputs: first those of the header, then any other that has a column.
    pub fn input_names(&self) -> Vec<String> {
        let mut names: Vec<String> = self.header.inputs.iter().map(|input| input.name.clone()).collect();
        let columns = self.columns.iter().filter_map(|column| column.name.strip_prefix(INPUT));
        for name in columns {
            if !names.iter().any(|known| known == name) {
                names.push(name.to_owned());
            }
        }
        names.retain(|name| self.numbers(&format!("{INPUT}{name}")).is_some());
        names
    }

    /// Whether each run was a success; none where the table has no such flag. An empty cell is no success.
    pub fn successes(&self) -> Option<Vec<bool>> {
        match &self.column(&self.header.success).filter(|_| !self.header.success.is_empty())?.cells {
            Cells::Flags(flags) => Some(flags.iter().map(|flag| flag.unwrap_or(false)).collect()),
            _ => None,
        }
    }
}

impl Cells {
    /// How many.
    pub fn len(&self) -> usize {
        match self {
            Self::Integers(cells) => cells.len(),
            Self::Numbers(cells) => cells.len(),
            Self::Flags(cells) => cells.len(),
            Self::Texts(cells) => cells.len(),
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Numbers and integers, finite ones only; none of flags and texts.
    pub fn numbers(&self) -> Option<Vec<Option<f64>>> {
        match self {
            Self::Integers(cells) => Some(cells.iter().map(|cell| cell.map(|i| i as f64)).collect()),
            Self::Numbers(cells) => Some(cells.iter().map(|cell| cell.filter(|x| x.is_finite())).collect()),
            Self::Flags(_) | Self::Texts(_) => None,
        }
    }
}
