//! Steps that end where parts begin to touch.
//!
//! A damped normal force jumps at the first touch, by c u, and every other one has a corner there: a step across it is of first or second order, however high
//! the scheme's. So the instant is sought by Newton's rule on the gap, and the step made in three: up to just before it, across it in next to
//! no time, and on from there (Shampine and Thompson 2000, events as ends of steps). Where points part forces have gone to zero already.

use super::World;
use crate::error::StepError;
use crate::model::Integrator;
use crate::workspace::Workspace;

/// Part of a step by which the approach ends before a touch, and part of it that leads across.
const BEFORE: f64 = 1e-4;
const ACROSS: f64 = 4e-4;
/// Trials for one touch.
const TRIALS: u32 = 5;
/// Touches that are sought within one step: where a surface comes down with many points the last count for little.
const SOUGHT: u32 = 8;
/// Largest part of a trial that a new point is thought to have pressed for: it may have been slowed down since.
const OLDEST: f64 = 0.7;

impl World {
    /// Advances by `h` s as [`World::advance_by`], in parts where points begin to touch; under other integrators than Runge–Kutta in one.
    pub fn advance_meeting(&mut self, h: f64) -> Result<(), StepError> {
        if self.integrator != Integrator::RungeKutta4 || self.model().scene.pairs().is_empty() {
            return self.advance_by(h);
        }
        let mut left = h;
        for _ in 0..SOUGHT {
            let (part, is_before) = self.advance_up_to_a_touch(left, h)?;
            left -= part;
            let across = (ACROSS * h).min(left);
            if is_before && across > 0.0 {
                self.advance_by(across)?;
                left -= across;
            }
            if left <= 0.0 {
                return Ok(());
            }
        }
        self.advance_by(left)
    }

    /// Advances by what is left of a step of `h` s, or until just before a point begins to touch; how far, and whether one is about to.
    fn advance_up_to_a_touch(&mut self, left: f64, h: f64) -> Result<(f64, bool), StepError> {
        self.note_what_presses();
        let mut trial = left;
        for attempt in 0..TRIALS {
            self.advance_by(trial)?;
            let Some(age) = self.calc_age_of_new_touch(trial) else { return Ok((trial, trial < left)) };
            if trial <= ACROSS * h {
                return Ok((trial, false));
            }
            let work = self.state.work;
            self.return_to_backup();
            // What was computed for it stays counted.
            self.state.work = work;
            // A world that has made no step yet knows nothing of what presses in it already.
            if attempt == 0 && self.ws.pressing.is_empty() {
                self.refresh_touches();
                self.note_what_presses();
                if !self.ws.pressing.is_empty() {
                    continue;
                }
            }
            let before = trial - age - BEFORE * h;
            trial = if before > BEFORE * h { before } else { (ACROSS * h).min(left) };
        }
        self.advance_by(trial)?;
        Ok((trial, false))
    }

    /// Remembers the points that press by the last look at them.
    fn note_what_presses(&mut self) {
        let Workspace { touches, pressing, .. } = &mut self.ws;
        pressing.clear();
        pressing.extend(touches.iter().filter(|t| t.gap < 0.0).map(|t| (t.pair, t.feature)));
    }

    /// For how long the oldest of the points that a step has brought presses, s; none where it has brought none.
    fn calc_age_of_new_touch(&self, step: f64) -> Option<f64> {
        let (touches, before) = (&self.ws.touches, &self.ws.pressing);
        let count = |pair: u32| touches.iter().filter(|t| t.pair == pair && t.gap < 0.0).count();
        let count_before = |pair: u32| before.iter().filter(|(p, _)| *p == pair).count();
        // A surface may call a point by another name from step to step: it is new only where there are more.
        let is_new = |pair: u32, feature: u64| !before.contains(&(pair, feature)) && count(pair) > count_before(pair);
        let new = touches.iter().filter(|t| t.gap < 0.0 && is_new(t.pair, t.feature));
        let age = |approach: f64, gap: f64| if approach > 0.0 { -gap / approach } else { f64::INFINITY };
        new.map(|t| age(-t.normal.dot(&t.u), t.gap).min(OLDEST * step)).max_by(f64::total_cmp)
    }
}
