//! One colour to an outcome, the same in all drawings: blue and green for those that succeed, warm ones for those that
//! fail.

use crate::findings::Findings;
use record::page::{escape, legend};

/// Classes of outcomes that succeed, of those that fail, and of what is left.
const GOOD: [&str; 2] = ["o0", "o2"];
const BAD: [&str; 4] = ["o1", "o3", "o4", "o6"];
const REST: &str = "o5";

/// The class of every outcome, the most frequent outcome first.
pub(super) struct Colours(Vec<(String, &'static str)>);

impl Colours {
    pub(super) fn of(findings: &Findings) -> Self {
        let (mut good, mut bad) = (GOOD.iter(), BAD.iter());
        let mut class = |is_failure| if is_failure { bad.next() } else { good.next() }.copied().unwrap_or(REST);
        Self(findings.outcomes.iter().map(|tally| (tally.outcome.clone(), class(tally.is_failure))).collect())
    }

    /// Classes in use with the place of their outcome; without outcomes one for all runs.
    pub(super) fn classes(&self) -> Vec<&'static str> {
        let mut classes: Vec<&'static str> = Vec::new();
        self.0.iter().for_each(|(_, class)| {
            if !classes.contains(class) {
                classes.push(class)
            }
        });
        if !classes.contains(&REST) && classes.is_empty() {
            classes.push(REST);
        }
        classes
    }

    /// The class of an outcome.
    pub(super) fn class(&self, outcome: &str) -> &'static str {
        self.0.iter().find(|(name, _)| name == outcome).map_or_else(|| self.fallback(outcome), |(_, class)| class)
    }

    /// An empty outcome is tallied under a name of its own.
    fn fallback(&self, outcome: &str) -> &'static str {
        let none = self.0.iter().find(|(name, _)| outcome.is_empty() && name == "(none)");
        none.map_or(REST, |(_, class)| class)
    }

    /// What the colours mean; empty where there is one outcome only.
    pub(super) fn legend(&self) -> String {
        if self.0.len() < 2 {
            return String::new();
        }
        let named: Vec<(&str, String)> =
            self.0.iter().filter(|(_, class)| *class != REST).map(|(name, class)| (*class, escape(name))).collect();
        let mut entries: Vec<(&str, &str)> = named.iter().map(|(class, name)| (*class, name.as_str())).collect();
        if named.len() < self.0.len() {
            entries.push((REST, "other outcomes"));
        }
        legend(&entries)
    }
}
