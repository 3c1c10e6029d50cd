//! Where the time of a diagnosis goes.

use crate::evidence::Stage;
use crate::work::Work;
use std::time::Instant;

/// Stages and what each of them took.
pub(crate) struct Clock<'a> {
    begun: Instant,
    /// Wall time and simulated time at the begin of the present stage, s.
    last: (f64, f64),
    /// What is counted.
    pub work: &'a Work<'a>,
    /// The stages, the last one still under way.
    pub timings: Vec<Stage>,
}

impl<'a> Clock<'a> {
    /// Begins now.
    pub(crate) fn new(work: &'a Work<'a>) -> Self {
        Self { begun: Instant::now(), last: (0.0, work.total().simulated), work, timings: Vec::new() }
    }

    /// Ends the last stage and begins one.
    pub(crate) fn stage(&mut self, name: &str, share: f64) {
        let total = self.work.total();
        let now = (self.begun.elapsed().as_secs_f64(), total.simulated);
        if let Some(last) = self.timings.last_mut() {
            (last.wall_s, last.simulated_s) = (now.0 - self.last.0, now.1 - self.last.1);
        }
        let speed = (now.1 - self.last.1) / (now.0 - self.last.0);
        self.work.watch.step(&format!(
            "{:.1} s simulated, {speed:.0} times real time; {} replays, {:.1} million evaluations so far",
            now.1 - self.last.1,
            total.replays,
            1e-6 * total.evaluations as f64
        ));
        self.last = now;
        self.timings.push(Stage { name: name.to_owned(), wall_s: 0.0, simulated_s: 0.0 });
        self.work.watch.stage(name, share);
    }
}
