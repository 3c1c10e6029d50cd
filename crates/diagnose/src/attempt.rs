//! What was tried, and what came of it: what the report tells of the search.

use crate::effect_set::EffectSet;
use crate::fit::Fit;
use crate::hypothesis::Hypothesis;
use crate::screen::{Score, Shown};
use crate::standing::criterion;

/// What happened to one hypothesis in one round.
#[derive(Clone, Debug)]
pub struct Attempt {
    /// Round, from 0.
    pub round: usize,
    /// Name and place.
    pub name: String,
    /// Place.
    pub place: String,
    /// Promised fall of the cost.
    pub score: f64,
    /// Share of the excess that it promises, or has brought where it was refitted; along whole runs what it has brought is a share of the missing force.
    pub share: f64,
    /// Fall of the cost after the refit; `None` where none was made.
    pub fall: Option<f64>,
    /// Numbers it fits.
    pub parameters: usize,
    /// Fall of the criterion; positive is better.
    pub gain: Option<f64>,
    /// Fall of the criterion by all that was kept with it, where that was more than one.
    pub together: Option<f64>,
    /// Whether it was kept.
    pub kept: bool,
    /// Coordinates after the refit.
    pub found: Vec<f64>,
    /// The set that it was refitted in; empty where none was.
    pub set: EffectSet,
    /// How well the data show it.
    pub shown: Shown,
}

impl Attempt {
    /// What it brings beside others that were fitted with it.
    pub(crate) fn tell_part(&mut self, before: &Fit, after: &Fit, part: f64) {
        if self.fall.is_some_and(|fall| fall >= part) {
            return;
        }
        self.fall = Some(part);
        self.share = (part / before.excess().max(0.2 * before.noise)).clamp(0.0, 1.0);
        self.gain = Some(part - self.parameters as f64 * (before.count as f64).ln());
        let is_this = |m: &&(Hypothesis, Vec<f64>)| m.0.name == self.name && m.0.place == self.place;
        self.found = after.set.members.iter().find(is_this).map(|m| m.1.clone()).unwrap_or_default();
        self.set = after.set.clone();
    }

    /// Name and place, as a hypothesis has them.
    pub(crate) fn title(&self) -> String {
        format!("{} at {}", self.name, self.place)
    }

    /// Whether it is one of the effects that a round has added, and what these have brought together.
    pub(crate) fn keep(&mut self, added: &[String], together: Option<f64>) {
        self.kept = added.contains(&self.title());
        self.together = together.filter(|_| self.kept);
    }

    /// Nothing but promised yet.
    pub(crate) fn new(round: usize, h: &Hypothesis, score: &Score, beside: &Fit) -> Self {
        Self {
            round,
            name: h.name.to_owned(),
            place: h.place.clone(),
            score: score.score,
            share: score.score / beside.excess().max(0.2 * beside.noise),
            fall: None,
            parameters: score.rank,
            gain: None,
            together: None,
            kept: false,
            found: score.start.clone(),
            set: EffectSet::default(),
            shown: score.shown.clone(),
        }
    }

    /// What came of it.
    pub(crate) fn tell(&mut self, before: &Fit, after: &Fit) {
        self.fall = Some(before.cost - after.cost);
        self.share = ((before.cost - after.cost) / before.excess().max(0.2 * before.noise)).clamp(0.0, 1.0);
        self.gain = Some(criterion(before) - criterion(after));
        self.found = after.set.members.last().map(|m| m.1.clone()).unwrap_or_default();
        self.set = after.set.clone();
    }
}
