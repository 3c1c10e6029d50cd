//! The table of a score and what it must reach.

use crate::SetScore;
use diagnose::diagnosis::Verdict;
use serde::Serialize;
use std::fmt::Write;

/// All sets that were judged.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct ScoreTable {
    /// Set by set.
    pub sets: Vec<SetScore>,
}

/// One requirement on all sets together.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Criterion {
    /// What is asked.
    pub text: &'static str,
    /// Sets that are right.
    pub right: usize,
    /// Sets that it applies to.
    pub of: usize,
    /// Share that must be right.
    pub needed: f64,
}

impl Criterion {
    /// Whether it is met; what applies to no set is.
    pub fn holds(&self) -> bool {
        self.right as f64 >= self.needed * self.of as f64 - 1e-9
    }
}

const COLUMNS: [&str; 8] = ["set", "verdict", "name, place", "both", "parameters", "holdout", "located", "all"];

impl ScoreTable {
    /// The requirements of a diagnosis, counted.
    pub fn criteria(&self) -> Vec<Criterion> {
        let count = |text, needed, applies: &dyn Fn(&SetScore) -> Option<bool>| {
            let marks: Vec<bool> = self.sets.iter().filter_map(applies).collect();
            Criterion { text, right: marks.iter().filter(|m| **m).count(), of: marks.len(), needed }
        };
        let is_null = |s: &SetScore| s.expected == Verdict::NoMismatch;
        vec![
            count("verdict on the nulls", 1.0, &|s| is_null(s).then_some(s.verdict)),
            count("name and place at the first rank", 0.9, &|s| s.name),
            count("both members of the sets with two effects", 0.7, &|s| s.both),
            count("parameters, where the name is right", 1.0, &|s| s.parameters.filter(|_| s.name == Some(true))),
            count("holdout error after the correction", 1.0, &|s| s.holdout),
            count("verdict and place of the unknown", 1.0, &|s| s.located.map(|located| located && s.verdict)),
        ]
    }

    /// Whether all requirements are met; by no set none is.
    pub fn holds(&self) -> bool {
        !self.sets.is_empty() && self.criteria().iter().all(Criterion::holds)
    }

    /// The table as Markdown, for a README: sets, then requirements, then what is wrong.
    pub fn markdown(&self) -> String {
        let mut text = format!("| {} |\n|{}\n", COLUMNS.join(" | "), " --- |".repeat(COLUMNS.len()));
        for set in &self.sets {
            let _ = writeln!(text, "| {} |", row(set).join(" | "));
        }
        text.push_str("\n| requirement | right | needed | met |\n| --- | --- | --- | --- |\n");
        for c in self.criteria() {
            let met = match (c.of, c.holds()) {
                (0, _) => "–",
                (_, true) => "yes",
                (_, false) => "NO",
            };
            let _ = writeln!(text, "| {} | {} of {} | {:.0} % | {met} |", c.text, c.right, c.of, 100.0 * c.needed);
        }
        for (set, note) in self.notes() {
            let _ = write!(text, "\n- {set}: {}", note.replace('|', "\\|"));
        }
        text + "\n"
    }

    /// The table for a terminal.
    pub fn text(&self) -> String {
        let mut rows: Vec<Vec<String>> = vec![COLUMNS.map(str::to_owned).to_vec()];
        rows.extend(self.sets.iter().map(row));
        let mut text = diagnose::aligned(&rows);
        text.push('\n');
        for c in self.criteria() {
            let mark = match (c.of, c.holds()) {
                (0, _) => "–      ",
                (_, true) => "met    ",
                (_, false) => "NOT MET",
            };
            let _ = writeln!(text, "  {mark}  {} of {} {} (needed: {:.0} %)", c.right, c.of, c.text, 100.0 * c.needed);
        }
        if self.notes().next().is_some() {
            text.push('\n');
        }
        for (set, note) in self.notes() {
            let _ = writeln!(text, "  {set}: {note}");
        }
        text
    }

    fn notes(&self) -> impl Iterator<Item = (&str, &str)> {
        self.sets.iter().flat_map(|s| s.notes.iter().map(|note| (s.set.as_str(), note.as_str())))
    }

    /// Everything, for programs.
    pub fn json(&self) -> serde_json::Value {
        let criterion = |c: &Criterion| serde_json::json!({ "text": c.text, "right": c.right, "of": c.of, "needed": c.needed, "holds": c.holds() });
        let criteria: Vec<_> = self.criteria().iter().map(criterion).collect();
        let sets = serde_json::to_value(&self.sets).unwrap_or_default();
        serde_json::json!({ "sets": sets, "criteria": criteria, "holds": self.holds() })
    }
}

fn row(set: &SetScore) -> Vec<String> {
    let mark = |m: Option<bool>| m.map_or("", |right| if right { "yes" } else { "NO" }).to_owned();
    let verdict = match (set.given, set.verdict) {
        (None, _) => "missing".to_owned(),
        (Some(given), true) => given.word().to_owned(),
        (Some(given), false) => format!("{} NO", given.word()),
    };
    let holdout = match (set.holdout, set.holdout_after) {
        (Some(right), Some(after)) => format!("{after:.3}{}", if right { "" } else { " NO" }),
        (right, _) => mark(right),
    };
    vec![
        set.set.clone(),
        verdict,
        mark(set.name),
        mark(set.both),
        mark(set.parameters),
        holdout,
        mark(set.located),
        mark(Some(set.all())),
    ]
}
