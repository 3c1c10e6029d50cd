//! The progress bar of a run.

use indicatif::{ProgressBar, ProgressStyle};
use softdock::sim::{Flow, Observer, World};

/// Steps between two looks at the bar.
const EVERY: u64 = 200;

/// An observer that moves a bar.
#[derive(Debug)]
pub(crate) struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// A bar for a run of so many steps; hidden where nobody watches.
    pub(crate) fn new(steps: u64, quiet: bool) -> Self {
        let bar = if quiet { ProgressBar::hidden() } else { ProgressBar::new(steps) };
        if let Ok(style) = ProgressStyle::with_template("{msg:>12} {wide_bar} {percent:>3} %  {elapsed} (left {eta})") {
            bar.set_style(style);
        }
        Self { bar }
    }

    /// Takes the bar away.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Observer for Progress {
    fn observe(&mut self, world: &World) -> Flow {
        if world.state().steps.is_multiple_of(EVERY) {
            self.bar.set_position(world.state().steps);
            self.bar.set_message(format!("t = {:.1} s", world.state().time));
        }
        Flow::Continue
    }
}
