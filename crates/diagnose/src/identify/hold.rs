//! Runs through touches: what holds is handed on, and no step goes further than it helps.
//!
//! A touch is linear only nearby: a state a tenth of a millimetre off starts it with another force. What bristles and latches remember is no coordinate of a
//! state, so that it comes from the interval before, and a state that was led astray is found again from there, too.

use super::track::{Base, Frame, Interval, Track};
use crate::guess::guess;
use crate::held::holds;
use crate::start::Start;
use nalgebra::DVector;

/// Mean square, units of noise, that a step may leave whatever was before, and shares of a step that are tried, each a quarter of the last.
const LOOSE: f64 = 4.0;
const SHARES: i32 = 4;
/// Root mean square, units of noise, from which on an interval is lost.
const LOST: f64 = 1e3;

impl Frame<'_> {
    /// What the present model reads in every interval of a run, with what holds handed on from interval to interval.
    pub fn hand_on(&self, track: &mut Track) -> Option<Vec<Base>> {
        if !holds(self.built) {
            return self.exact(track);
        }
        let mut bases: Vec<Base> = Vec::with_capacity(track.intervals.len());
        for interval in &mut track.intervals {
            if let Some((_, end)) = bases.last() {
                interval.start.held.clone_from(&end.held);
            }
            let own = self.shoot(self.built, track.run, interval, &interval.start);
            let before = bases.last().map(|(_, end)| end);
            bases.push(match own {
                Some(base) if miss(&base) < LOST => base,
                own => self.found_again(track.run, interval, (before, own))?,
            });
        }
        Some(bases)
    }

    /// A lost interval begun where the one before ends, or from what its samples say, where that is nearer to them.
    fn found_again(
        &self,
        run: usize,
        interval: &mut Interval,
        (before, own): (Option<&Start>, Option<Base>),
    ) -> Option<Base> {
        let held = interval.start.held.clone();
        let guessed = guess(self.built, &self.stage.tapes[run], interval.span.from);
        let guessed = Start { held, bristles: Vec::new(), ..guessed.fitted_to(self.built) };
        let quiet = Interval { force: DVector::zeros(interval.force.len()), ..interval.clone() };
        let from = |start: &Start| Some((self.shoot(self.built, run, &quiet, start)?, start.clone()));
        let others = before.into_iter().chain([&guessed]).filter_map(from);
        let best = others.min_by(|a, b| miss(&a.0).total_cmp(&miss(&b.0)));
        match (own, best) {
            (Some(own), Some((base, _))) if miss(&own) <= miss(&base) => Some(own),
            (_, Some((base, start))) => {
                *interval = Interval { start, ..quiet };
                Some(base)
            }
            (own, None) => own,
        }
    }

    /// Share of a step of an interval's state and force that leaves its residuals no worse than they were, or than noise: what touches is linear only nearby.
    pub(super) fn share_that_helps(
        &self,
        (run, interval): (usize, &Interval),
        (r, factors): (&DVector<f64>, &DVector<f64>),
        (state, force): (&DVector<f64>, &DVector<f64>),
    ) -> f64 {
        let most = r.component_div(factors).norm_squared().max(LOOSE * r.len() as f64);
        let is_no_worse = |share: &f64| {
            let start = self.retract(&interval.start, (state * *share).as_slice());
            let pushed = Interval { force: &interval.force + force * *share, ..interval.clone() };
            let shot = self.shoot(self.built, run, &pushed, &start);
            shot.is_some_and(|(q, _)| q.component_div(factors).norm_squared() <= most)
        };
        (0..SHARES).map(|k| 0.25f64.powi(k)).find(is_no_worse).unwrap_or(0.0)
    }
}

/// Root mean square of an interval's residuals, units of noise.
fn miss((r, _): &Base) -> f64 {
    (r.norm_squared() / r.len().max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facts::Facts;
    use crate::identify::coarse::Coarse;
    use crate::identify::forces::forces;
    use crate::identify::track::coordinates;
    use crate::linear::Stage;
    use crate::noise;
    use crate::reading::{Reading, Value};
    use crate::replay::tests::docking;
    use crate::replay::{Pace, readings};
    use crate::start::Freedom;
    use crate::tape::Tape;
    use crate::work::Work;
    use record::Role;
    use scenario::measure::Reading as Measured;

    const PACE: f64 = 2.5e-4;

    /// What a run through a touch reads of the chaser's place and the force, as a recording of it, and a frame of its model.
    fn with_frame(check: impl Fn(&Frame<'_>, Track)) {
        let (built, tape, start) = docking();
        let span = crate::replay::Span { from: 0.0, to: 0.7 };
        let read = readings(&built, &tape, &tape, &start, span, Pace::even(PACE)).expect("it runs").values;
        let of = |(r, own): (usize, &Reading)| {
            let all = read.iter().zip(&tape.events).filter(|(_, e)| e.reading as usize == r);
            let value = |m: &Measured| if let Measured::Vector(x) = m { Value::Vector(*x) } else { panic!("vectors") };
            let values: Vec<Value> = all.map(|(m, _)| value(m)).collect();
            let times = own.times[..values.len()].to_vec();
            Reading { times, values, sigma: [1e-4, 0.2][r], ..own.clone() }
        };
        let tape =
            Tape::assemble(("docking", Role::Fit), Vec::new(), tape.readings.iter().enumerate().map(of).collect());
        let tapes = vec![tape];
        let work = Work::new(&(), 1.0);
        let stage = Stage { tapes: &tapes, pace: Pace::even(PACE), work: &work, doubt: noise::STATED, hears: None };
        let forces = forces(&Facts::new(&built, &tapes));
        let coarse = vec![Coarse::new(&tapes[0], PACE, None)];
        let mut track = Track::cut((&stage, &coarse), (&built, forces.len()), 0, 14).expect("it is sampled");
        track.intervals[0].start = start;
        let freedoms: Vec<Freedom> = coordinates(&built, &track.intervals[0].start);
        let frame = Frame { stage: &stage, coarse: &coarse, built: &built, freedoms: &freedoms, forces: &forces };
        // Every interval from where the one before ends.
        for i in 1..track.intervals.len() {
            let before = &track.intervals[i - 1];
            track.intervals[i].start = frame.shoot(&built, 0, before, &before.start).expect("it runs").1;
        }
        check(&frame, track);
    }

    #[test]
    fn a_state_that_is_lost_is_found_again_from_the_interval_before() {
        with_frame(|frame, mut track| {
            assert!(frame.hand_on(&mut track).expect("it runs").iter().all(|base| miss(base) < 1e-3));
            let mut astray = track.clone();
            // Metres beside where it is.
            astray.intervals[7].start = astray.intervals[7].start.moved(Freedom::Place(0, 0), 5.0);
            let bases = frame.hand_on(&mut astray).expect("it runs");
            assert!(bases.iter().all(|base| miss(base) < 1e-3), "{:?}", bases.iter().map(miss).collect::<Vec<_>>());
            assert_eq!(astray.intervals[7].start.bases, track.intervals[7].start.bases);
        });
    }

    #[test]
    fn a_step_goes_as_far_as_it_helps() {
        with_frame(|frame, track| {
            let interval = &track.intervals[7];
            let (r, _) = frame.shoot(frame.built, 0, interval, &interval.start).expect("it runs");
            let ones = DVector::from_element(r.len(), 1.0);
            let force = DVector::zeros(frame.forces.len());
            let share = |by: f64| {
                let k = frame.freedoms.iter().position(|f| *f == Freedom::Place(0, 0)).expect("it flies");
                let mut state = DVector::zeros(frame.freedoms.len());
                state[k] = by;
                frame.share_that_helps((0, interval), (&r, &ones), (&state, &force))
            };
            assert_eq!(share(1e-9), 1.0);
            assert_eq!(share(10.0), 0.0, "no part of ten metres");
        });
    }
}
