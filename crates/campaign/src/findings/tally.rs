//! Outcomes with intervals, and why the failures failed: reasons that differ in their numbers only are one reason.

use crate::stats::Rate;
use crate::table::Table;
use serde::Serialize;
use std::collections::BTreeMap;

/// Most reasons listed of an outcome.
const MOST: usize = 6;

/// Runs of one outcome.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OutcomeTally {
    /// The outcome's word.
    pub outcome: String,
    /// How many of all runs.
    pub rate: Rate,
    /// How many of them count as success.
    pub successes: usize,
    /// Whether runs of it failed: by the flag of success, and without one, where it says `diverged`.
    pub is_failure: bool,
    /// Its most frequent reasons.
    pub reasons: Vec<Reason>,
    /// Different reasons in all.
    pub reason_count: usize,
}

/// Runs of one reason.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reason {
    /// The sentence with its numbers taken out.
    pub pattern: String,
    /// How many runs.
    pub runs: usize,
    /// The first of them.
    pub example_run: u32,
    /// Its sentence.
    pub example: String,
}

pub(super) fn outcomes(table: &Table) -> Vec<OutcomeTally> {
    let mut rows: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for row in 0..table.len() {
        rows.entry(table.text("outcome", row)).or_default().push(row);
    }
    if rows.keys().all(|outcome| outcome.is_empty()) {
        return Vec::new();
    }
    let successes = table.successes();
    let mut outcomes: Vec<OutcomeTally> =
        rows.into_iter().filter_map(|(outcome, rows)| one(table, outcome, &rows, successes.as_deref())).collect();
    outcomes.sort_by_key(|tally| std::cmp::Reverse(tally.rate.count));
    outcomes
}

fn one(table: &Table, outcome: &str, rows: &[usize], successes: Option<&[bool]>) -> Option<OutcomeTally> {
    let is_success = |row: &&usize| successes.is_some_and(|flags| flags.get(**row).copied().unwrap_or(false));
    let count = rows.iter().filter(is_success).count();
    let is_failure = if successes.is_some() { count < rows.len() } else { outcome == "diverged" };
    // Why a success succeeded is no news.
    let explained: Vec<usize> = rows.iter().filter(|row| !is_success(row)).copied().collect();
    let reasons = reasons(table, &explained);
    Some(OutcomeTally {
        outcome: if outcome.is_empty() { "(none)".to_owned() } else { outcome.to_owned() },
        rate: Rate::new(rows.len(), table.len())?,
        successes: count,
        is_failure,
        reason_count: reasons.len(),
        reasons: reasons.into_iter().take(MOST).collect(),
    })
}

/// Reasons of some rows, the most frequent first.
fn reasons(table: &Table, rows: &[usize]) -> Vec<Reason> {
    let mut groups: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for row in rows.iter().filter(|row| !table.text("reason", **row).is_empty()) {
        groups.entry(pattern(table.text("reason", *row))).or_default().push(*row);
    }
    let mut reasons: Vec<Reason> = groups
        .into_iter()
        .map(|(pattern, rows)| Reason {
            pattern,
            runs: rows.len(),
            example_run: table.run(rows[0]),
            example: table.text("reason", rows[0]).to_owned(),
        })
        .collect();
    reasons.sort_by_key(|reason| std::cmp::Reverse(reason.runs));
    reasons
}

/// A sentence with `…` for every number; digits of names (`pad_1`, `link2`) stay.
pub fn pattern(sentence: &str) -> String {
    let signs: Vec<char> = sentence.chars().collect();
    let (mut text, mut i) = (String::new(), 0);
    while i < signs.len() {
        let is_word = |k: usize| signs[k].is_alphanumeric() || signs[k] == '_';
        let is_name = i > 0 && (is_word(i - 1) || (signs[i - 1] == '.' && i > 1 && is_word(i - 2)));
        let length = if is_name { 0 } else { number_length(&signs[i..]) };
        if length > 0 {
            text.push('…');
        } else {
            text.push(signs[i]);
        }
        i += length.max(1);
    }
    text
}

/// Signs of the number that opens a text: sign, digits, fraction, power; nought where it opens with none.
fn number_length(signs: &[char]) -> usize {
    let digits = |from: usize| signs.iter().skip(from).take_while(|sign| sign.is_ascii_digit()).count();
    let sign = usize::from(matches!(signs.first(), Some('-' | '−' | '+')));
    let whole = digits(sign);
    if whole == 0 {
        return 0;
    }
    let mut end = sign + whole;
    if signs.get(end) == Some(&'.') && digits(end + 1) > 0 {
        end += 1 + digits(end + 1);
    }
    if matches!(signs.get(end), Some('e' | 'E')) {
        let sign = usize::from(matches!(signs.get(end + 1), Some('-' | '+')));
        let power = digits(end + 1 + sign);
        end += if power > 0 { 1 + sign + power } else { 0 };
    }
    end
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::tests::table;

    #[test]
    fn numbers_go_and_names_stay() {
        let cases = [
            ("slipped 12.5 mm in pad_1 at t = 3.25 s", "slipped … mm in pad_1 at t = … s"),
            ("step 1e-3, force -2.5E+6 N, link2, v2.1", "step …, force … N, link2, v2.1"),
            ("at 5.", "at …."),
            ("−3 and 4…", "… and ……"),
            ("", ""),
        ];
        for (sentence, expected) in cases {
            assert_eq!(pattern(sentence), expected);
        }
    }

    #[test]
    fn failures_are_grouped_by_reason() {
        let outcomes = outcomes(&table(30, |i| i < 20));
        assert_eq!(
            (outcomes[0].outcome.as_str(), outcomes[0].rate.count, outcomes[0].is_failure),
            ("captured", 20, false)
        );
        let lost = &outcomes[1];
        assert!(lost.is_failure && lost.reasons.len() == 1 && outcomes[0].reasons.is_empty());
        assert_eq!((lost.reasons[0].runs, lost.reasons[0].example_run), (10, 20));
        assert_eq!(lost.reasons[0].pattern, "slipped … mm in pad_1");
        assert_eq!(lost.reasons[0].example, "slipped 20.5 mm in pad_1");
    }
}
