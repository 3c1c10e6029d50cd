//! What a diagnosis is doing: for who waits for it, and for its account of time.

use std::sync::atomic::{AtomicU64, Ordering};

/// Hears how a diagnosis goes.
pub trait Watch: Sync {
    /// A stage begins; `share` of the whole is done.
    fn stage(&self, _name: &str, _share: f64) {}
    /// A step of the search, in words.
    fn step(&self, _what: &str) {}
}

/// Nobody watches.
impl Watch for () {}

/// Counts of replays, and who watches.
pub struct Work<'a> {
    replays: AtomicU64,
    microseconds: AtomicU64,
    /// Who hears of it.
    pub watch: &'a dyn Watch,
}

impl<'a> Work<'a> {
    /// Nothing done yet.
    pub fn new(watch: &'a dyn Watch) -> Self {
        Self { replays: AtomicU64::new(0), microseconds: AtomicU64::new(0), watch }
    }

    /// Replays so far, and the time that they simulated, s.
    pub fn total(&self) -> (u64, f64) {
        (self.replays.load(Ordering::Relaxed), self.microseconds.load(Ordering::Relaxed) as f64 * 1e-6)
    }

    pub(crate) fn add(&self, simulated: f64) {
        self.replays.fetch_add(1, Ordering::Relaxed);
        self.microseconds.fetch_add((simulated * 1e6) as u64, Ordering::Relaxed);
    }
}

impl std::fmt::Debug for Work<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Work").field("total", &self.total()).finish_non_exhaustive()
    }
}
