//! What a campaign's table says: outcomes and their reasons, figures of every metric, which inputs drive what, where it
//! succeeds.
//!
//! Everything is a function of the table and the [`Options`]; serialised, the field names below are those of the JSON
//! report.

mod envelope;
mod inputs;
mod metrics;
mod sensitivity;
mod tally;
mod verdict;

pub use envelope::{Cell, Envelope};
pub use inputs::InputSummary;
pub use metrics::{FlagSummary, MetricSummary, Notable, NotableRun};
pub use sensitivity::{Driver, Effect, Fifth, Sensitivity};
pub use tally::{OutcomeTally, Reason, pattern};

use crate::stats::Rate;
use crate::table::{Cells, Table, WORK};
use serde::Serialize;

/// The metric whose largest values are notable, where the table has it and nothing else is asked for.
pub const WORST_METRIC: &str = "peak_contact_force_n";

/// What to look at.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// The metric whose largest values are notable; [`WORST_METRIC`] where absent.
    pub worst_metric: Option<String>,
    /// The two inputs of the envelope map, across and up; the two of greatest influence where absent.
    pub envelope: Option<(String, String)>,
}

/// What the table says.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Findings {
    /// Name of the scenario.
    pub scenario: String,
    /// Version of softdock that ran it.
    pub version: String,
    /// Seed of the campaign.
    pub seed: u64,
    /// How the inputs were drawn.
    pub sampling: String,
    /// Digest of everything that the runs depend on.
    pub fingerprint: String,
    /// Number of runs.
    pub runs: usize,
    /// All of it in a few sentences.
    pub verdict: String,
    /// What a reader should know beside.
    pub remarks: Vec<String>,
    /// How often it succeeded; absent where the table has no flag of success, or no run.
    pub success: Option<Success>,
    /// Outcomes, the most frequent first.
    pub outcomes: Vec<OutcomeTally>,
    /// Metrics that are numbers, in the order of the table.
    pub metrics: Vec<MetricSummary>,
    /// Metrics that are flags, in the order of the table.
    pub flags: Vec<FlagSummary>,
    /// Work counters.
    pub work: Vec<MetricSummary>,
    /// Dispersed inputs: as drawn, and what the built model says.
    pub inputs: Vec<InputSummary>,
    /// Runs worth a look.
    pub notable: Notable,
    /// What drives what.
    pub sensitivity: Sensitivity,
    /// Success over two inputs; absent where there are none or no flag of success.
    pub envelope: Option<Envelope>,
}

/// How often it succeeded.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Success {
    /// The flag that counts.
    pub flag: String,
    /// Its rate; an empty cell counts as no success.
    pub rate: Rate,
    /// Runs whose cell is empty.
    pub undecided: usize,
}

impl Findings {
    /// Reads a table.
    pub fn of(table: &Table, options: &Options) -> Self {
        let sensitivity = Sensitivity::of(table, &worst_metric(table, options));
        let (metrics, flags) = (metrics::numbers(table), metrics::flags(table));
        let header = &table.header;
        let mut findings = Self {
            scenario: header.scenario.clone(),
            version: header.version.clone(),
            seed: header.seed,
            sampling: header.sampling.clone(),
            fingerprint: header.fingerprint.clone(),
            runs: table.len(),
            verdict: String::new(),
            remarks: remarks(table, options),
            success: success(table),
            outcomes: tally::outcomes(table),
            metrics,
            flags,
            work: metrics::work(table),
            inputs: inputs::summaries(table),
            notable: metrics::notable(table, &worst_metric(table, options)),
            envelope: envelope::map(table, options, &sensitivity),
            sensitivity,
        };
        findings.verdict = verdict::paragraph(&findings);
        findings
    }
}

fn success(table: &Table) -> Option<Success> {
    let flag = table.header.success.clone();
    let rate = Rate::of_flags(table.successes()?.into_iter())?;
    let undecided = match &table.column(&flag)?.cells {
        Cells::Flags(cells) => cells.iter().filter(|cell| cell.is_none()).count(),
        _ => 0,
    };
    Some(Success { flag, rate, undecided })
}

/// The metric whose largest values are notable: what was asked for, the usual one, or the first that varies; empty
/// where none is.
fn worst_metric(table: &Table, options: &Options) -> String {
    let varies = |name: &str| {
        let values = || table.numbers(name).into_iter().flatten().flatten();
        values().next().is_some_and(|first| values().any(|value| value != first))
    };
    let asked = options.worst_metric.iter().map(String::as_str).chain([WORST_METRIC]);
    let mut candidates =
        asked.filter(|name| table.numbers(name).is_some()).chain(table.metrics().map(|c| c.name.as_str()));
    candidates.find(|name| varies(name)).unwrap_or_default().to_owned()
}

fn remarks(table: &Table, options: &Options) -> Vec<String> {
    let mut remarks = Vec::new();
    if let Some(name) = options.worst_metric.as_ref().filter(|name| table.numbers(name).is_none()) {
        remarks.push(format!("The table has no numbers under “{name}”; runs were ranked by another metric."));
    }
    let names = table.input_names();
    let asked = options.envelope.iter().flat_map(|(a, b)| [a, b]);
    for name in asked.filter(|name| !names.contains(name)) {
        remarks.push(format!("The table has no input “{name}”; the map shows the two inputs of greatest influence."));
    }
    let flag = &table.header.success;
    if !flag.is_empty() && !table.is_empty() && table.successes().is_none() {
        remarks.push(format!("The table has no flag “{flag}”, so nothing says which runs succeeded."));
    }
    if let Some(success) = success(table).filter(|success| success.undecided > 0) {
        let (count, flag) = (success.undecided, &success.flag);
        remarks.push(format!("{count} runs have no value of “{flag}”; they count as failures."));
    }
    let counters = table.columns.iter().filter(|column| column.name.starts_with(WORK)).count();
    if counters < table.columns.len() && table.columns.iter().any(|column| column.cells.len() != table.len()) {
        remarks.push("The columns differ in length; what is missing counts as empty.".to_owned());
    }
    remarks
}

#[cfg(test)]
pub(crate) mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::table::{Column, Header, Input};

    /// A table of a few columns: draws `a` and `b`, success, outcome, reason and a force.
    pub(crate) fn table(count: usize, is_success: impl Fn(usize) -> bool) -> Table {
        let numbers = |name: &str, value: &dyn Fn(usize) -> f64| Column {
            name: name.to_owned(),
            cells: Cells::Numbers((0..count).map(|i| Some(value(i))).collect()),
        };
        let texts = |name: &str, text: &dyn Fn(usize) -> String| Column {
            name: name.to_owned(),
            cells: Cells::Texts((0..count).map(|i| Some(text(i))).collect()),
        };
        let input = |name: &str| Input { name: name.to_owned(), ..Input::default() };
        let header = Header {
            scenario: "test".into(),
            success: "captured".into(),
            inputs: vec![input("a_deg"), input("b_m")],
            ..Header::default()
        };
        let columns = vec![
            Column { name: "run".into(), cells: Cells::Integers((0..count).map(|i| Some(i as i64)).collect()) },
            numbers("input.a_deg", &|i| i as f64),
            numbers("applied.a_deg", &|i| i as f64 + if i == 3 { 1e-9 } else { 0.0 }),
            numbers("input.b_m", &|i| ((i * 37) % 101) as f64),
            texts("outcome", &|i| if is_success(i) { "captured" } else { "lost" }.to_owned()),
            texts("reason", &|i| format!("slipped {}.5 mm in pad_1", i)),
            Column { name: "captured".into(), cells: Cells::Flags((0..count).map(|i| Some(is_success(i))).collect()) },
            numbers("peak_contact_force_n", &|i| 10.0 + i as f64),
            numbers("constant_m", &|_| 0.1),
            Column { name: "empty_s".into(), cells: Cells::Numbers(vec![None; count]) },
            Column { name: "work.steps".into(), cells: Cells::Integers(vec![Some(7); count]) },
        ];
        Table { header, columns }
    }

    fn json(findings: &Findings) -> String {
        serde_json::to_string(findings).unwrap()
    }

    #[test]
    fn a_threshold_is_found_and_said() {
        let findings = Findings::of(&table(200, |i| i < 150), &Options::default());
        let success = findings.success.as_ref().unwrap();
        assert_eq!((success.rate.count, success.rate.of), (150, 200));
        let first = &findings.sensitivity.ranking[0];
        assert!(first.input == "a_deg" && first.is_clear && first.first_order.unwrap() > 0.9);
        assert!(!findings.sensitivity.ranking[1].is_clear);
        assert!(
            findings.verdict.starts_with("Captured in 150 of 200 runs: 75 % (95 % interval"),
            "{}",
            findings.verdict
        );
        assert!(findings.verdict.contains("a_deg"), "{}", findings.verdict);
        assert_eq!(findings.notable.worst[0].run, 199);
        assert_eq!(findings.notable.first_failures[0].run, 150);
        assert_eq!(findings.envelope.as_ref().unwrap().across, "a_deg");
    }

    #[test]
    fn edge_cases_have_findings_without_nan() {
        for (count, threshold) in [(0, 0), (1, 1), (1, 0), (2, 1), (12, 12), (12, 0), (60, 60), (60, 0)] {
            let findings = Findings::of(&table(count, |i| i < threshold), &Options::default());
            let text = json(&findings);
            assert!(!text.contains("NaN") && !findings.verdict.contains("NaN") && !findings.verdict.is_empty());
            assert_eq!(findings.runs, count);
        }
        let empty = Findings::of(&Table::default(), &Options::default());
        assert!(empty.success.is_none() && empty.verdict.contains("no run"), "{}", empty.verdict);
    }

    #[test]
    fn what_was_asked_for_and_is_not_there_is_said() {
        let options = Options { worst_metric: Some("nothing".into()), envelope: Some(("a_deg".into(), "c".into())) };
        let findings = Findings::of(&table(40, |i| i % 2 == 0), &options);
        assert_eq!(findings.remarks.len(), 2, "{:?}", findings.remarks);
        assert_eq!(findings.notable.metric.as_deref(), Some(WORST_METRIC));
    }

    #[test]
    fn a_table_without_inputs_or_flag_is_tallied() {
        let mut bare = table(20, |i| i < 15);
        bare.header.success.clear();
        bare.header.inputs.clear();
        bare.columns.retain(|c| !c.name.starts_with("input.") && !c.name.starts_with("applied."));
        let findings = Findings::of(&bare, &Options::default());
        assert!(findings.success.is_none() && findings.envelope.is_none() && findings.sensitivity.effects.is_empty());
        assert_eq!(findings.outcomes.len(), 2);
        assert!(findings.verdict.contains("captured 15"), "{}", findings.verdict);
    }
}
