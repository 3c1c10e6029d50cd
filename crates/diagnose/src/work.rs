//! What a diagnosis is doing: for who waits for it, for its account of time, and for its end.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Hears how a diagnosis goes.
pub trait Watch: Sync {
    /// A stage begins; `share` of the whole is done.
    fn stage(&self, _name: &str, _share: f64) {}
    /// A step of the search, in words.
    fn step(&self, _what: &str) {}
}

/// Nobody watches.
impl Watch for () {}

/// What a search may do, in evaluations of the motion of one body: two to four minutes on two cores.
const USUAL: f64 = 4.5e8;
/// What testing two shapes for contact costs, in such evaluations, and what evaluating a model costs beside its bodies, in halves of one.
const QUERY: u64 = 2;
const BESIDE: u64 = 3;

/// Counts of replays, how much may be done, and who watches.
pub struct Work<'a> {
    replays: AtomicU64,
    microseconds: AtomicU64,
    evaluations: AtomicU64,
    limit: u64,
    prepared: AtomicU64,
    was_ended: AtomicBool,
    /// Who hears of it.
    pub watch: &'a dyn Watch,
}

/// What was done so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Total {
    /// Replays.
    pub replays: u64,
    /// Time that they simulated, s.
    pub simulated: f64,
    /// Evaluations of the motion of one body, tests for contact among them.
    pub evaluations: u64,
}

/// How far into what may be done something is still begun.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Until {
    /// Looking for further effects.
    Search,
    /// Trying whether less does as well.
    Prune,
    /// Improving what was found.
    Fit,
}

impl Until {
    fn share(self) -> f64 {
        match self {
            Self::Search => 0.7,
            Self::Prune => 0.85,
            Self::Fit => 1.0,
        }
    }
}

impl<'a> Work<'a> {
    /// Nothing done yet; `effort`: how much may be done, relative to the usual.
    ///
    /// The limit is one of counts, not of time: a diagnosis ends alike on any machine, with any number of threads, as long as it is asked for only
    /// where no replay is under way.
    pub fn new(watch: &'a dyn Watch, effort: f64) -> Self {
        Self {
            replays: AtomicU64::new(0),
            microseconds: AtomicU64::new(0),
            evaluations: AtomicU64::new(0),
            limit: (effort * USUAL) as u64,
            prepared: AtomicU64::new(0),
            was_ended: AtomicBool::new(false),
            watch,
        }
    }

    /// Nothing done yet, and as much may be done again.
    pub(crate) fn anew(&self) -> Self {
        Self { limit: self.limit, ..Self::new(self.watch, 0.0) }
    }

    /// The same with so many times as much.
    pub(crate) fn anew_times(&self, times: f64) -> Self {
        Self { limit: (self.limit as f64 * times) as u64, ..self.anew() }
    }

    /// What was done so far.
    pub fn total(&self) -> Total {
        Total {
            replays: self.replays.load(Ordering::Relaxed),
            simulated: self.microseconds.load(Ordering::Relaxed) as f64 * 1e-6,
            evaluations: self.evaluations.load(Ordering::Relaxed),
        }
    }

    /// What was done so far was to begin with: a search has its whole limit still, however short the steps are that a recording asks for.
    pub(crate) fn begin_to_count(&self) {
        self.prepared.store(self.total().evaluations, Ordering::Relaxed);
    }

    /// Whether so much was done that what would be begun now is left; that it was is remembered.
    pub(crate) fn is_spent(&self, until: Until) -> bool {
        let done = self.total().evaluations - self.prepared.load(Ordering::Relaxed);
        let is_spent = done as f64 > until.share() * self.limit as f64;
        self.was_ended.fetch_or(is_spent, Ordering::Relaxed);
        is_spent
    }

    /// Whether anything was left because of the limit.
    pub(crate) fn was_ended(&self) -> bool {
        self.was_ended.load(Ordering::Relaxed)
    }

    /// Adds a replay of a model of so many bodies over a time, s.
    pub(crate) fn add(&self, simulated: f64, bodies: usize, work: &sim::Work) {
        self.replays.fetch_add(1, Ordering::Relaxed);
        self.microseconds.fetch_add((simulated * 1e6) as u64, Ordering::Relaxed);
        let evaluations = work.rate_evaluations * (2 * bodies as u64 + BESIDE) / 2 + QUERY * work.contact_queries;
        self.evaluations.fetch_add(evaluations, Ordering::Relaxed);
    }
}

impl std::fmt::Debug for Work<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Work").field("total", &self.total()).field("limit", &self.limit).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_search_ends_before_its_fits_do_and_both_by_counts() {
        let work = Work::new(&(), 1e-6);
        assert_eq!(work.limit, 450);
        let of =
            |rate_evaluations, contact_queries| sim::Work { rate_evaluations, contact_queries, ..Default::default() };
        work.add(0.5, 7, &of(30, 0));
        assert!(!work.is_spent(Until::Search) && !work.was_ended());
        work.add(0.25, 7, &of(0, 40));
        assert!(work.is_spent(Until::Search) && !work.is_spent(Until::Fit) && work.was_ended());
        assert_eq!(work.total(), Total { replays: 2, simulated: 0.75, evaluations: 335 });
        work.add(0.0, 1, &of(101, 0));
        assert!(work.is_spent(Until::Fit));
        work.begin_to_count();
        assert!(!work.is_spent(Until::Search));
        let anew = work.anew();
        assert!(!anew.is_spent(Until::Search) && anew.limit == work.limit && anew.total().evaluations == 0);
    }
}
