//! An answer key: what a recording set conceals.

use diagnose::diagnosis::{Found, ParamValue, Verdict};
use diagnose::place::same_place;
use scenario::effects::{self, Corrects, UNKNOWN};
use serde::Deserialize;
use std::collections::BTreeMap;

/// An answer key.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
pub struct Key {
    /// What is concealed; empty: a null.
    pub effects: Vec<KeyEffect>,
    /// Other answers that count.
    #[serde(default)]
    pub accept: Vec<Accepted>,
    /// Numbers that the rig's card states slightly wrong, by what they are.
    #[serde(default)]
    pub nominal_errors: BTreeMap<String, serde_json::Value>,
    /// What the true model reaches.
    pub oracle: Oracle,
}

/// A concealed effect.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
pub struct KeyEffect {
    /// Name; "unknown" for a law outside the table.
    pub name: String,
    /// Place.
    pub place: String,
    /// True parameters.
    #[serde(default)]
    pub params: BTreeMap<String, ParamValue>,
    /// What an unknown is.
    #[serde(default)]
    pub kind: Option<String>,
}

/// Another answer that counts.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
pub struct Accepted {
    /// Name of the key's effect that it stands for.
    #[serde(rename = "for")]
    pub stands_for: String,
    /// Its name.
    pub name: String,
    /// Its place.
    pub place: String,
}

/// RMS errors on the holdout runs, in units of noise.
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize)]
pub struct Oracle {
    /// Of the true model from the true state.
    #[serde(rename = "true")]
    pub true_model: f64,
    /// Of the nominal model in windows; zero where the key does not say.
    #[serde(default)]
    pub nominal_windowed: f64,
}

/// Words by which `nominal_errors` speaks of contact numbers.
const CONTACT_WORDS: [&str; 5] = ["contact", "friction", "stiffness", "mu", "bristle"];
/// A gain farther from 1 than this is no small correction.
const SMALL_GAIN: f64 = 0.03;

impl KeyEffect {
    /// Whether the table of effects has it.
    pub fn is_named(&self) -> bool {
        self.name != UNKNOWN.name
    }
}

impl Key {
    /// The effects that can be named.
    pub fn named(&self) -> Vec<&KeyEffect> {
        self.effects.iter().filter(|e| e.is_named()).collect()
    }

    /// The one that cannot.
    pub fn unknown(&self) -> Option<&KeyEffect> {
        self.effects.iter().find(|e| !e.is_named())
    }

    /// The verdict that is right.
    pub fn verdict(&self) -> Verdict {
        match (self.named().is_empty(), self.unknown().is_some()) {
            (true, false) => Verdict::NoMismatch,
            (false, false) => Verdict::Explained,
            (false, true) => Verdict::PartlyExplained,
            (true, true) => Verdict::Unknown,
        }
    }

    /// Whether an effect that was found is the key's `i`-th, or counts for it.
    pub(super) fn takes(&self, i: usize, found: &Found) -> bool {
        let effect = &self.effects[i];
        let is = |name: &str, place: &str| found.name == name && same_place(&found.place, place);
        let accepted = || self.accept.iter().filter(|a| a.stands_for == effect.name);
        effect.is_named() && (is(&effect.name, &effect.place) || accepted().any(|a| is(&a.name, &a.place)))
    }

    /// Whether an effect that was found is a small correction of a number that the card states wrong.
    pub(super) fn allows_correction(&self, found: &Found) -> bool {
        let said = |what: &String| CONTACT_WORDS.iter().any(|w| what.to_lowercase().split(' ').any(|s| s == *w));
        let is_excused = match effects::find(&found.name).map_or(Corrects::Nothing, |effect| effect.corrects) {
            Corrects::DataSheet => true,
            Corrects::ContactLaw => self.nominal_errors.keys().any(said),
            Corrects::Nothing => false,
        };
        let gain = found.params.get("gain").and_then(ParamValue::number);
        let is_small = gain.is_none_or(|gain| (gain - 1.0).abs() <= SMALL_GAIN);
        !self.nominal_errors.is_empty() && is_small && is_excused
    }
}
