//! Judges a folder of diagnoses against answer keys. The diagnosis itself never reads a key.
//!
//! What is judged, per set:
//!
//! | column | right where |
//! | --- | --- |
//! | verdict | no effect in the key: `no-mismatch` (or `explained` by small corrections that the key's `nominal_errors` allow); all named: `explained`; an unknown among named ones: `partly-explained`; only an unknown: `unknown` |
//! | name, place | the first effect (corrections that the key allows apart) is one of the key's, or one it accepts, and no effect is there that the key does not have |
//! | both | in sets with two effects: both; of an unknown among them: its place comes first of those located |
//! | parameters | see `parameters` |
//! | holdout | error of the corrected model on the holdout runs ≤ 1.5 times that of the true model: of free runs; in windows where the diagnosis says that free runs are not predictable and windows tell a wrong model too |
//! | located | an unknown's place comes first |

mod folder;
mod key;
mod parameters;
mod table;

pub use folder::{ScoreError, score_folders};
pub use key::{Accepted, Key, KeyEffect, Oracle};
pub use parameters::Judged;
pub use table::{Criterion, ScoreTable};

use diagnose::diagnosis::{Diagnosis, Found, Verdict};
use diagnose::place::same_place;
use serde::Serialize;

/// How far the corrected model's error may exceed the true model's.
pub const HOLDOUT_FACTOR: f64 = 1.5;
/// How far the nominal model's error in windows must exceed the true model's for windows to tell a right model from a wrong one.
const TOLD_BY_WINDOWS: f64 = 10.0;

/// What was judged of one set; `None`: does not apply.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SetScore {
    /// Name of the set.
    pub set: String,
    /// The verdict that the key asks for.
    pub expected: Verdict,
    /// The verdict that was given; `None` where there is no diagnosis.
    pub given: Option<Verdict>,
    /// How many effects the key has, unknown ones among them.
    pub concealed: usize,
    /// Verdict right.
    pub verdict: bool,
    /// Name and place right at the first rank, nothing else named.
    pub name: Option<bool>,
    /// Both members found.
    pub both: Option<bool>,
    /// Parameters right, of the effects that were found.
    pub parameters: Option<bool>,
    /// Holdout error right.
    pub holdout: Option<bool>,
    /// Holdout error after the correction (in windows where free runs are not predictable), in units of noise; `null` where there is none.
    pub holdout_after: Option<f64>,
    /// An unknown's place right.
    pub located: Option<bool>,
    /// Each parameter.
    pub judged: Vec<Judged>,
    /// What is wrong, in words; for an unknown, the condition that was said.
    pub notes: Vec<String>,
}

impl SetScore {
    /// Whether everything that applies is right.
    pub fn all(&self) -> bool {
        let marks = [self.name, self.both, self.parameters, self.holdout, self.located];
        self.verdict && marks.iter().all(|mark| mark.unwrap_or(true))
    }

    /// A set without a readable diagnosis: everything that applies is wrong.
    pub fn missing(set: &str, key: &Key, why: String) -> Self {
        let named = !key.named().is_empty();
        Self {
            set: set.to_owned(),
            expected: key.verdict(),
            given: None,
            concealed: key.effects.len(),
            verdict: false,
            name: named.then_some(false),
            both: (key.effects.len() > 1).then_some(false),
            parameters: named.then_some(false),
            holdout: key.unknown().is_none().then_some(false),
            holdout_after: None,
            located: key.unknown().map(|_| false),
            judged: Vec::new(),
            notes: vec![why],
        }
    }
}

/// Judges one diagnosis.
pub fn score_set(set: &str, diagnosis: &Diagnosis, key: &Key) -> SetScore {
    let matched = Matched::new(diagnosis, key);
    let mut notes = matched.notes(key);
    let verdict = verdict_is_right(diagnosis, key, &matched);
    if !verdict {
        notes.insert(0, format!("verdict {} instead of {}", diagnosis.verdict.word(), key.verdict().word()));
    }
    let judged = matched.judge_parameters(key, diagnosis);
    notes.extend(judged.iter().filter(|j| !j.right).map(Judged::sentence));
    let located = located(diagnosis, key, &mut notes);
    let holdout_after = holdout_after(diagnosis, key);
    let holdout = holdout(key, holdout_after, &mut notes);
    let named = key.named().len();
    let found_all = matched.pairs.len() == named && located.unwrap_or(true);
    SetScore {
        set: set.to_owned(),
        expected: key.verdict(),
        given: Some(diagnosis.verdict),
        concealed: key.effects.len(),
        verdict,
        name: (named > 0).then_some(matched.first_is_right && matched.extra.is_empty()),
        both: (key.effects.len() > 1).then_some(found_all),
        parameters: (named > 0).then(|| !judged.is_empty() && judged.iter().all(|j| j.right)),
        holdout,
        holdout_after,
        located,
        judged,
        notes,
    }
}

/// Which effect of a diagnosis is which of the key.
struct Matched<'a> {
    /// (index of the key's effect, the effect found).
    pairs: Vec<(usize, &'a Found)>,
    /// Effects that the key does not have and does not allow.
    extra: Vec<&'a Found>,
    /// Whether the first effect, allowed corrections apart, is one of the key's.
    first_is_right: bool,
}

impl<'a> Matched<'a> {
    fn new(diagnosis: &'a Diagnosis, key: &Key) -> Self {
        let mut matched = Self { pairs: Vec::new(), extra: Vec::new(), first_is_right: false };
        let mut is_first = true;
        for found in &diagnosis.effects {
            let taken = |i: &usize| matched.pairs.iter().any(|pair| pair.0 == *i);
            let which = (0..key.effects.len()).find(|i| !taken(i) && key.takes(*i, found));
            if which.is_none() && key.allows_correction(found) {
                continue;
            }
            match which {
                Some(i) => matched.pairs.push((i, found)),
                None => matched.extra.push(found),
            }
            matched.first_is_right |= is_first && which.is_some();
            is_first = false;
        }
        matched
    }

    fn notes(&self, key: &Key) -> Vec<String> {
        let missing = |i: &usize| key.effects[*i].is_named() && !self.pairs.iter().any(|pair| pair.0 == *i);
        let missing = (0..key.effects.len()).filter(missing).map(|i| &key.effects[i]);
        let missing = missing.map(|e| format!("{} at {} not found", e.name, e.place));
        let extra = self.extra.iter().map(|e| format!("{} at {} is not in the key", e.name, e.place));
        missing.chain(extra).collect()
    }

    fn judge_parameters(&self, key: &Key, diagnosis: &Diagnosis) -> Vec<Judged> {
        let gauge = parameters::gauge(key, &diagnosis.effects);
        self.pairs.iter().flat_map(|(i, found)| parameters::judge(&key.effects[*i], found, gauge)).collect()
    }
}

fn verdict_is_right(diagnosis: &Diagnosis, key: &Key, matched: &Matched) -> bool {
    let only_corrections = key.effects.is_empty()
        && !key.nominal_errors.is_empty()
        && diagnosis.verdict == Verdict::Explained
        && matched.extra.is_empty();
    diagnosis.verdict == key.verdict() || only_corrections
}

fn located(diagnosis: &Diagnosis, key: &Key, notes: &mut Vec<String>) -> Option<bool> {
    let unknown = key.unknown()?;
    let Some(first) = diagnosis.located.first() else {
        notes.push(format!("nothing located; the unknown is at {}", unknown.place));
        return Some(false);
    };
    let right = same_place(&first.place, &unknown.place);
    if !right {
        notes.push(format!("located first at {} instead of {}", first.place, unknown.place));
    }
    let kind = unknown.kind.as_deref().unwrap_or("unknown");
    notes.push(format!("condition said: \"{}\" (the key: {kind})", first.condition));
    Some(right)
}

/// The figure that the holdout is judged by.
fn holdout_after(diagnosis: &Diagnosis, key: &Key) -> Option<f64> {
    let is_told_by_windows = key.oracle.nominal_windowed > TOLD_BY_WINDOWS * key.oracle.true_model;
    let after = match diagnosis.judged().window_s.is_some() && is_told_by_windows {
        true => diagnosis.error.windowed.after,
        false => diagnosis.error.holdout?.after,
    };
    after.is_finite().then_some(after)
}

/// Whether it is near enough to the true model's; where something unknown remains, there is nothing to hold.
fn holdout(key: &Key, after: Option<f64>, notes: &mut Vec<String>) -> Option<bool> {
    if key.unknown().is_some() {
        return None;
    }
    let bound = HOLDOUT_FACTOR * key.oracle.true_model;
    let right = after.is_some_and(|after| after <= bound);
    if !right {
        let after = after.map_or_else(|| "not given".to_owned(), |after| format!("{after:.3}"));
        notes.push(format!("holdout error {after}, above {bound:.3}"));
    }
    Some(right)
}

#[cfg(test)]
mod tests;
