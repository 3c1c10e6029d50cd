//! A run cut at knots, simulated interval by interval from states of their own, and made linear.

use super::chain::{self, Node, Smoothed};
use super::coarse::{Coarse, Few};
use super::forces::{Force, has_memory, pushing};
use crate::error::DiagnoseError;
use crate::guess::guess;
use crate::held::holds;
use crate::linear::{Stage, Variation};
use crate::plant::Built;
use crate::replay::{Leg, Pace, Shot, Span, members_between, shoot};
use crate::start::{Freedom, Start, freedoms};
use crate::tape::Tape;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::sync::Arc;

/// An interval between two knots.
#[derive(Clone, Debug)]
pub struct Interval {
    /// When.
    pub span: Span,
    /// The events of the tape that tell of it.
    pub members: Vec<u32>,
    /// Those at which derivatives are taken.
    pub few: Arc<Few>,
    /// The state at its begin that is believed at present.
    pub start: Start,
    /// The unknown forces that push it from there, by their number.
    pub force: DVector<f64>,
}

/// What an interval reads, units of noise, and where it ends.
pub type Base = (DVector<f64>, Start);

/// What all intervals of a run read and where they end: as exactly as it is judged, and as derivatives are taken.
#[derive(Clone, Debug)]
pub struct Bases<'a> {
    /// For residuals.
    pub exact: &'a [Base],
    /// For difference quotients at the coarser clock, at few events.
    coarse: Vec<Base>,
}

/// Derivatives of an interval by its state and by forces.
#[derive(Clone, Debug)]
pub struct Link {
    /// ∂r/∂s.
    pub s: DMatrix<f64>,
    /// ∂r/∂f.
    pub f: DMatrix<f64>,
    /// ∂end/∂s.
    pub a: DMatrix<f64>,
    /// ∂end/∂f.
    pub b: DMatrix<f64>,
}

/// What an interval says of the numbers.
#[derive(Clone, Debug)]
pub struct Side {
    /// ∂r/∂θ, and the residual last.
    pub y: DMatrix<f64>,
    /// ∂end/∂θ, and last what the end exceeds the next interval's state by.
    pub d: DMatrix<f64>,
}

/// A run as intervals.
#[derive(Clone, Debug)]
pub struct Track {
    /// Index of the run.
    pub run: usize,
    /// The intervals, in order.
    pub intervals: Vec<Interval>,
}

/// What a run is made linear about and by.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Runs, steps and counts.
    pub stage: &'a Stage<'a>,
    /// The runs at coarser clocks.
    pub coarse: &'a [Coarse],
    /// The model at present.
    pub built: &'a Built,
    /// Coordinates of a state.
    pub freedoms: &'a [Freedom],
    /// An unknown force on each coordinate that moves.
    pub forces: &'a [Force],
}

/// Coordinates of a state that intervals hand on to each other.
pub fn coordinates(built: &Built, start: &Start) -> Vec<Freedom> {
    freedoms(built, start).into_iter().filter(|f| !matches!(f, Freedom::Bristle(..))).collect()
}

impl Interval {
    /// Its begin up to an instant, of which nothing is read.
    fn until(&self, to: f64) -> Self {
        Self { span: Span { to, ..self.span }, members: Vec::new(), few: Arc::default(), ..self.clone() }
    }

    /// The same with one unknown force larger by so much.
    fn pushed(&self, force: usize, by: f64) -> Self {
        let mut pushed = self.clone();
        pushed.force[force] += by;
        pushed
    }
}

impl Track {
    /// Cuts a run into so many intervals of one length, each with the state that its samples suggest.
    pub fn cut(
        (stage, coarse): (&Stage<'_>, &[Coarse]),
        (built, forces): (&Built, usize),
        run: usize,
        count: usize,
    ) -> Result<Self, DiagnoseError> {
        let tape = &stage.tapes[run];
        let (from, to) = tape.span;
        // Between samples: what a small delay makes of the first sample of an interval is not told from where that begins.
        let most = tape.readings.iter().map(|r| r.times.len()).max().unwrap_or(2).max(2);
        let aside = ASIDE * (to - from) / (most - 1).max(count) as f64;
        let knot = |i: usize| from + (to - from) * i as f64 / count as f64;
        let instants: Vec<f64> =
            (0..=count).map(|i| if i == 0 || i == count { knot(i) } else { knot(i) - aside }).collect();
        let members = told_by(built, tape, &instants)?;
        let interval = |(w, members): (&[f64], Vec<u32>)| {
            let span = Span { from: w[0], to: w[1] };
            let few = Arc::new(coarse[run].few(tape, &members));
            Interval { span, members, few, start: guess(built, tape, w[0]), force: DVector::zeros(forces) }
        };
        Ok(Self { run, intervals: instants.windows(2).zip(members).map(interval).collect() })
    }

    /// The same intervals with the events of another tape of the run.
    pub fn onto(&self, (stage, coarse): (&Stage<'_>, &[Coarse]), built: &Built) -> Result<Self, DiagnoseError> {
        let begins = self.intervals.iter().map(|i| i.span.from);
        let instants: Vec<f64> = begins.chain(self.intervals.last().map(|i| i.span.to)).collect();
        let mut onto = self.clone();
        let members = told_by(built, &stage.tapes[self.run], &instants)?;
        for (interval, own) in onto.intervals.iter_mut().zip(members) {
            if interval.members != own || interval.few.members.is_empty() {
                interval.few = Arc::new(coarse[self.run].few(&stage.tapes[self.run], &own));
                interval.members = own;
            }
        }
        Ok(onto)
    }
}

impl Frame<'_> {
    /// A state moved along its coordinates, as far as the model can be there.
    pub(super) fn retract(&self, state: &Start, by: &[f64]) -> Start {
        state.retract_within(self.built, self.freedoms, by)
    }

    pub(super) fn shoot(&self, built: &Built, run: usize, interval: &Interval, start: &Start) -> Option<Base> {
        let told = (interval.members.as_slice(), &self.stage.tapes[run]);
        self.shoot_at(self.stage.pace, built, (run, interval), start, told)
    }

    /// The same as derivatives are taken: models in which nothing touches at a coarser clock and few events, those without corners by the midpoint rule.
    pub(super) fn glance(&self, built: &Built, run: usize, interval: &Interval, start: &Start) -> Option<Base> {
        let Coarse { heard, longest, is_exact, .. } = &self.coarse[run];
        if holds(built) || *is_exact {
            return self.shoot(built, run, interval, start);
        }
        let pace = Pace { step: *longest, free: self.stage.pace.free.max(*longest), midpoint: true };
        self.shoot_at(pace, built, (run, interval), start, (&interval.few.members, heard))
    }

    fn shoot_at(
        &self,
        pace: Pace,
        built: &Built,
        (run, interval): (usize, &Interval),
        start: &Start,
        (members, heard): (&[u32], &Tape),
    ) -> Option<Base> {
        let tape = &self.stage.tapes[run];
        let push = pushing(self.forces, &interval.force);
        let found = shoot(built, tape, start, Leg { span: interval.span, members, push, heard }, pace);
        let work = found.as_ref().map_or_else(|_| sim::Work::default(), |s| s.work);
        self.stage.work.add(interval.span.to - interval.span.from, built.model.owners.len(), &work);
        let Shot { residuals, mut end, .. } = found.ok()?;
        end.bristles.clear();
        residuals.iter().all(|r| r.is_finite()).then(|| (DVector::from_vec(residuals), end))
    }

    /// Derivatives of an interval by its state and by forces; none where its replay left the range of numbers.
    pub fn link(&self, run: usize, interval: &Interval) -> Option<Link> {
        let n_x = self.freedoms.len();
        let glance = |interval: &Interval, start: &Start| self.glance(self.built, run, interval, start);
        let (r, end) = &glance(interval, &interval.start)?;
        let column = |moved: Option<Base>, step: f64| {
            let few = moved.as_ref().map_or_else(|| DVector::zeros(r.len()), |(q, _)| (q - r) / step);
            let by_end = |(_, e): &Base| DVector::from_vec(e.difference(end, self.freedoms)) / step;
            (told(!holds(self.built), interval, few), moved.as_ref().map_or_else(|| DVector::zeros(n_x), by_end))
        };
        let by_state = |freedom: &Freedom| {
            let step = freedom.first_step();
            column(glance(interval, &interval.start.moved(*freedom, step)), step)
        };
        let by_force = |j: usize| {
            let step = self.forces[j].size;
            column(glance(&interval.pushed(j, step), &interval.start), step)
        };
        let states: Vec<_> = self.freedoms.par_iter().map(by_state).collect();
        let forces: Vec<_> = (0..self.forces.len()).into_par_iter().map(by_force).collect();
        let rows = states.first().map_or(0, |c| c.0.len());
        let (s, a) = matrices(&states, rows, n_x);
        let (f, b) = matrices(&forces, rows, n_x);
        Some(Link { s, f, a, b })
    }

    /// Largest share of a derivative of some intervals by which those at a coarser clock differ from these: by states and forces, and by numbers.
    pub fn differs(&self, coarser: &Self, of: &[(usize, Interval)], variations: &[Variation]) -> [f64; 2] {
        let differ = |(run, interval): &(usize, Interval)| {
            let read = |frame: &Self| {
                let few = Arc::new(frame.coarse[*run].few(&self.stage.tapes[*run], &interval.members));
                let interval = Interval { few, ..interval.clone() };
                let Link { s, f, a, b } = frame.link(*run, &interval)?;
                let (rows, states) = (s.nrows(), a.nrows());
                let track = Track { run: *run, intervals: vec![interval] };
                let exact = frame.exact(&track)?;
                let bases = frame.bases(&track, &exact, variations)?;
                let numbers: Vec<Column> = variations.iter().flat_map(|v| frame.columns(&track, &bases, v)).collect();
                let (y, d) = matrices(&numbers, rows, states);
                Some([s, f, a, b, y, d])
            };
            let Some((ours, theirs)) = read(self).zip(read(coarser)) else { return [f64::INFINITY; 2] };
            let shares: Vec<f64> = ours.iter().zip(&theirs).map(share_of_change).collect();
            [&shares[..LINK], &shares[LINK..]].map(|part| part.iter().copied().fold(0.0, f64::max))
        };
        of.par_iter().map(differ).reduce(|| [0.0; 2], |a, b| [a[0].max(b[0]), a[1].max(b[1])])
    }

    /// How rates answer to unknown forces at once, in a model that an interval may not be of: ∂v/∂f over a short while, a row a rate.
    pub fn answer(&self, built: &Built, run: usize, interval: &Interval) -> Option<DMatrix<f64>> {
        let part = interval.until(interval.span.to.min(interval.span.from + self.stage.pace.step));
        let start = interval.start.fitted_to(built);
        let end = self.glance(built, run, &part, &start)?.1;
        let rates: Vec<usize> = (0..self.freedoms.len()).filter(|k| self.freedoms[*k].is_rate()).collect();
        let mut answer = DMatrix::zeros(rates.len(), self.forces.len());
        for (j, force) in self.forces.iter().enumerate() {
            let by = self.glance(built, run, &part.pushed(j, force.size), &start)?.1.difference(&end, self.freedoms);
            rates.iter().enumerate().for_each(|(i, k)| answer[(i, j)] = by[*k] / force.size);
        }
        Some(answer)
    }

    /// What an interval reads of unknown forces in a model that differs in how it is read: ∂r/∂f.
    pub fn read_of_forces(&self, built: &Built, run: usize, interval: &Interval) -> Option<DMatrix<f64>> {
        let own = self.glance(built, run, interval, &interval.start)?.0;
        let read = |(j, force): (usize, &Force)| {
            let pushed = self.glance(built, run, &interval.pushed(j, force.size), &interval.start)?.0;
            Some((pushed - &own) / force.size)
        };
        let columns: Option<Vec<DVector<f64>>> = self.forces.iter().enumerate().map(read).collect();
        columns.filter(|c| !c.is_empty()).map(|c| DMatrix::from_columns(&c))
    }

    /// Whether both ends of a difference quotient are replayed alike at the coarser clock: else both are as they are judged. By how much commands are late is
    /// less than a cell of theirs, of which only the mean is heard.
    fn is_coarse_with(&self, variation: &Variation) -> bool {
        let [here, there] = [self.built, &variation.built].map(|b| (!holds(b)).then(|| b.model.is_smooth()));
        here.is_some() && here == there && self.built.delays == variation.built.delays
    }

    /// Columns of a number along a run: ∂r/∂θ and ∂end/∂θ of each interval.
    pub fn columns(&self, track: &Track, bases: &Bases<'_>, variation: &Variation) -> Vec<Column> {
        let mut out = Vec::with_capacity(track.intervals.len());
        self.put_columns(track, bases, variation, |column| out.push(column));
        out
    }

    /// The same one after the other, carried from interval to interval as far as the number brings memory of its own.
    fn put_columns(&self, track: &Track, bases: &Bases<'_>, variation: &Variation, mut put: impl FnMut(Column)) {
        let brings = holds(self.built) || has_memory(&variation.built, self.built);
        let mut carried: Option<Start> = None;
        let is_coarse = self.is_coarse_with(variation);
        let bases = if is_coarse { &bases.coarse } else { bases.exact };
        for (interval, (r, end)) in track.intervals.iter().zip(bases) {
            let mut start = interval.start.fitted_to(&variation.built);
            if let Some(before) = carried.as_ref().filter(|_| brings) {
                start.remember(before, self.built);
            }
            let replay = if is_coarse { Self::glance } else { Self::shoot };
            let Some((q, e)) = replay(self, &variation.built, track.run, interval, &start) else {
                put((told(is_coarse, interval, DVector::zeros(r.len())), DVector::zeros(self.freedoms.len())));
                continue;
            };
            let by = DVector::from_vec(e.difference(end, self.freedoms)) / variation.step;
            put((told(is_coarse, interval, (q - r) / variation.step), by));
            carried = Some(e);
        }
    }

    /// The same run with the memory that the model has beside another's carried along from interval to interval.
    pub fn carried(&self, track: &Track, known: &Built) -> Track {
        let mut carried = track.clone();
        for interval in &mut carried.intervals {
            interval.start = interval.start.fitted_to(self.built);
        }
        if !has_memory(self.built, known) {
            return carried;
        }
        for i in 1..carried.intervals.len() {
            let before = &carried.intervals[i - 1];
            let Some((_, end)) = self.shoot(self.built, track.run, before, &before.start) else { break };
            carried.intervals[i].start.remember(&end, known);
        }
        carried
    }

    /// What the present model reads in every interval, as exactly as it is judged.
    pub fn exact(&self, track: &Track) -> Option<Vec<Base>> {
        track.intervals.par_iter().map(|i| self.shoot(self.built, track.run, i, &i.start)).collect()
    }

    /// The same beside what derivatives by some variations are taken from; none where a replay left the range of numbers.
    pub fn bases<'b>(&self, track: &Track, exact: &'b [Base], variations: &[Variation]) -> Option<Bases<'b>> {
        let glance = |i: &Interval| self.glance(self.built, track.run, i, &i.start);
        let coarse = if variations.iter().any(|v| self.is_coarse_with(v)) {
            track.intervals.par_iter().map(glance).collect()
        } else {
            Some(Vec::new())
        };
        Some(Bases { exact, coarse: coarse? })
    }

    /// Follows a run from its first state by what its samples say (extended Kalman filter, each interval about its own estimate), and leaves the states there; the derivatives
    /// on the way, or none where a replay left the range of numbers.
    pub fn follow(&self, track: &mut Track, told: Told<'_>, known: Option<&[Link]>) -> Option<Vec<Link>> {
        let mut links = Vec::new();
        let mut root = DMatrix::from_diagonal(told.start);
        for i in 0..track.intervals.len() {
            let known = known.map(|links| &links[i]);
            let begun = track.intervals[i].clone();
            let factors = &told.factors[i];
            let passed =
                match self.pass(track.run, &mut track.intervals[i], (&root, told.force, factors), (i == 0, known)) {
                    Some(passed) => passed,
                    None => {
                        // Where it was led astray it begins anew from what the samples say.
                        root = DMatrix::from_diagonal(told.start);
                        let start = guess(self.built, &self.stage.tapes[track.run], begun.span.from);
                        track.intervals[i] = Interval { start, force: DVector::zeros(begun.force.len()), ..begun };
                        self.pass(track.run, &mut track.intervals[i], (&root, told.force, factors), (true, None))?
                    }
                };
            root = passed.root;
            links.push(passed.link);
            if let [this, next, ..] = &mut track.intervals[i..] {
                // It is expected to be pushed as this one is.
                next.start = passed.end;
                next.force.clone_from(&this.force);
            }
        }
        Some(links)
    }

    /// One interval of it: state and force at their best by its samples and what came before, about themselves (iterated filter: Bell and Cathey 1993).
    fn pass(
        &self,
        run: usize,
        interval: &mut Interval,
        (root, force, factors): (&DMatrix<f64>, &DVector<f64>, &DVector<f64>),
        (is_first, known): (bool, Option<&Link>),
    ) -> Option<Passed> {
        let expected = interval.start.clone();
        let mut link = known.cloned();
        let mut last: Option<Interval> = None;
        for pass in 1.. {
            let (r, end) = self.shoot_or_nearer(run, interval, last.as_ref())?;
            last = Some(interval.clone());
            if link.is_none() || is_first && known.is_none() {
                link = Some(self.link(run, interval)?);
            }
            let taken = link.as_ref()?;
            let off = DVector::from_vec(expected.difference(&interval.start, self.freedoms));
            let update = chain::update(&alone(taken, (&r, &off, &interval.force), factors), root, force);
            let (mut state, mut force) = (update.state + off, &update.force - &interval.force);
            if holds(self.built) {
                let share = self.share_that_helps((run, interval), (&r, factors), (&state, &force));
                state *= share;
                force *= share;
            }
            interval.start = self.retract(&interval.start, state.as_slice());
            interval.force += &force;
            if pass == if is_first { FIRST } else { PASSES } {
                let end = self.retract(&end, (&taken.a * state + &taken.b * force).as_slice());
                return link.map(|link| Passed { link, end, root: update.root });
            }
        }
        None
    }

    /// What an interval reads; where its replay leaves the range of numbers, halfway to another that does not, which it then is.
    fn shoot_or_nearer(&self, run: usize, interval: &mut Interval, to: Option<&Interval>) -> Option<Base> {
        for _ in 0..NEARER {
            if let Some(base) = self.shoot(self.built, run, interval, &interval.start) {
                return Some(base);
            }
            *interval = self.on_the_way(to?, interval, 0.5);
        }
        None
    }

    /// Derivatives of all intervals of a run.
    pub fn links(&self, track: &Track) -> Option<Vec<Link>> {
        track.intervals.par_iter().map(|interval| self.link(track.run, interval)).collect()
    }

    /// The same of a run some intervals of which are new: of the others they are known.
    pub fn links_again(&self, (before, known): (&Track, &[Link]), track: &Track) -> Option<Vec<Link>> {
        let of = |interval: &Interval| {
            let at = before.intervals.partition_point(|b| b.span.from < interval.span.from - SAME);
            let same = before.intervals.get(at).zip(known.get(at));
            let same = same.filter(|(b, _)| b.span == interval.span && b.members == interval.members);
            same.map_or_else(|| self.link(track.run, interval), |(_, link)| Some(link.clone()))
        };
        track.intervals.par_iter().map(of).collect()
    }

    /// Residuals and defects of a run, as they would be without the forces that push it, beside columns of numbers.
    ///
    /// Columns are written where they stay: those of a screen are hundreds of megabytes.
    pub fn sides(&self, track: &Track, links: &[Link], bases: &Bases<'_>, sources: &[Source<'_>]) -> Vec<Side> {
        let side = |i: usize| self.bare_side(track, (&links[i], &bases.exact[i]), (i, sources.len()));
        let mut sides: Vec<Side> = (0..track.intervals.len()).map(side).collect();
        let mut places: Vec<Vec<_>> = sources.iter().map(|_| Vec::with_capacity(track.intervals.len())).collect();
        for Side { y, d } in &mut sides {
            let columns = y.column_iter_mut().zip(d.column_iter_mut());
            places.iter_mut().zip(columns).for_each(|(own, column)| own.push(column));
        }
        places.into_par_iter().zip(sources).for_each(|(places, source)| {
            let mut places = places.into_iter();
            let mut write = |(by_reading, by_end): &Column| {
                if let Some((mut y, mut d)) = places.next() {
                    y.copy_from(by_reading);
                    d.copy_from(by_end);
                }
            };
            match source {
                Source::Known(columns) => columns.iter().for_each(write),
                Source::Taken(variation) => self.put_columns(track, bases, variation, |column| write(&column)),
            }
        });
        sides
    }

    /// The last column of an interval's side, before so many others that are still empty.
    fn bare_side(&self, track: &Track, (link, (r, end)): (&Link, &Base), (i, numbers): (usize, usize)) -> Side {
        let n_x = self.freedoms.len();
        let next = track.intervals.get(i + 1);
        let defect = next.map_or_else(|| vec![0.0; n_x], |next| end.difference(&next.start, self.freedoms));
        let (mut y, mut d) = (DMatrix::zeros(r.len(), numbers + 1), DMatrix::zeros(n_x, numbers + 1));
        let force = &track.intervals[i].force;
        y.column_mut(numbers).copy_from(&(r - &link.f * force));
        d.column_mut(numbers).copy_from(&(DVector::from_vec(defect) - &link.b * force));
        Side { y, d }
    }

    /// The state at an instant of a run, from the interval that it lies in.
    pub fn state_at(&self, track: &Track, time: f64) -> Option<Start> {
        let at = track.intervals.partition_point(|i| i.span.from <= time + SAME).max(1) - 1;
        let interval = &track.intervals[at];
        if (interval.span.from - time).abs() <= SAME {
            return Some(interval.start.clone());
        }
        let part = interval.until(time);
        self.shoot(self.built, track.run, &part, &part.start).map(|base| base.1)
    }

    /// The same run with some intervals halved, the second half from where the first one ends.
    pub fn halved(&self, track: &Track, which: &[bool]) -> Result<Track, DiagnoseError> {
        let half = |(interval, is_halved): (&Interval, &bool)| {
            let middle = 0.5 * (interval.span.from + interval.span.to);
            let state = is_halved.then(|| self.state_at(track, middle)).flatten();
            let Some(state) = state else { return vec![interval.clone()] };
            let [mut first, mut second] = [interval.clone(), interval.clone()];
            (first.span.to, second.span.from) = (middle, middle);
            second.start = state;
            vec![first, second]
        };
        let intervals = track.intervals.iter().zip(which).flat_map(half).collect();
        Track { run: track.run, intervals }.onto((self.stage, self.coarse), self.built)
    }

    /// A share of the way from one course of a run to another one.
    pub fn between(&self, a: &Track, b: &Track, share: f64) -> Track {
        let mut between = a.clone();
        for (interval, b) in between.intervals.iter_mut().zip(&b.intervals) {
            *interval = self.on_the_way(interval, b, share);
        }
        between
    }

    /// A share of the way from one begin of an interval to another one.
    fn on_the_way(&self, a: &Interval, b: &Interval, share: f64) -> Interval {
        let by = DVector::from_vec(b.start.difference(&a.start, self.freedoms)) * share;
        let force = (1.0 - share) * &a.force + share * &b.force;
        Interval { start: self.retract(&a.start, by.as_slice()), force, ..a.clone() }
    }

    /// Moves the states of a run, and what pushes it, as a smoother says.
    pub fn moved(&self, track: &Track, smoothed: &Smoothed) -> Track {
        let mut moved = track.clone();
        for (interval, (by, force)) in moved.intervals.iter_mut().zip(smoothed.states.iter().zip(&smoothed.forces)) {
            interval.start = self.retract(&interval.start, by.as_slice());
            interval.force.clone_from(force);
        }
        moved
    }
}

/// ∂r/∂θ and ∂end/∂θ of an interval.
pub type Column = (DVector<f64>, DVector<f64>);

/// Where the columns of a number come from.
#[derive(Clone, Copy, Debug)]
pub enum Source<'a> {
    /// They are taken from a model in which it is moved.
    Taken(&'a Variation),
    /// They are known, interval by interval.
    Known(&'a [Column]),
}

/// Events by interval, without those at the begin of a run that is commanded: what was commanded before is not recorded, and a late actuator still
/// follows it.
fn told_by(built: &Built, tape: &Tape, instants: &[f64]) -> Result<Vec<Vec<u32>>, DiagnoseError> {
    let mut members = members_between(built, tape, instants)?;
    if let (Some(first), false) = (members.first_mut(), tape.commands.is_empty()) {
        first.retain(|m| tape.events[*m as usize].time >= tape.span.0 + UNHEARD);
    }
    Ok(members)
}

/// What a knot stands aside of even division, as a share of the closest sampling.
const ASIDE: f64 = 0.3;
/// How long a run may follow commands from before its begin, s.
const UNHEARD: f64 = 0.02;
/// Two instants closer than this are one, s.
const SAME: f64 = 1e-9;
/// Passes over an interval, over the first, whose state is only guessed, and times that a move which leaves the range of numbers is halved.
const PASSES: usize = 2;
const FIRST: usize = 3;
const NEARER: usize = 6;

/// What is known of a run before it is followed.
#[derive(Clone, Copy, Debug)]
pub struct Told<'a> {
    /// Standard deviation of the first state, by coordinate.
    pub start: &'a DVector<f64>,
    /// Standard deviation of the unknown force of an interval, by coordinate.
    pub force: &'a DVector<f64>,
    /// Factor of the noise, by interval and residual.
    pub factors: &'a [DVector<f64>],
}

/// An interval that was passed: its derivatives, its end, and a root of the covariance of that.
struct Passed {
    link: Link,
    end: Start,
    root: DMatrix<f64>,
}

/// Values of all scalars of an interval from those that a model was read at.
pub(super) fn told(is_glanced: bool, interval: &Interval, read: DVector<f64>) -> DVector<f64> {
    if is_glanced { interval.few.expanded(&read) } else { read }
}

/// Matrices of a link.
const LINK: usize = 4;

/// Largest share of a column's length by which another one differs from it.
fn share_of_change((a, b): (&DMatrix<f64>, &DMatrix<f64>)) -> f64 {
    let share = |k: usize| (a.column(k) - b.column(k)).norm() / a.column(k).norm().max(f64::MIN_POSITIVE.sqrt());
    (0..a.ncols()).map(share).fold(0.0, f64::max)
}

fn matrices(columns: &[Column], rows: usize, n_x: usize) -> (DMatrix<f64>, DMatrix<f64>) {
    let of = |rows: usize, pick: fn(&Column) -> &DVector<f64>| {
        DMatrix::from_fn(rows, columns.len(), |i, j| pick(&columns[j])[i])
    };
    (of(rows, |c| &c.0), of(n_x, |c| &c.1))
}

/// An interval without numbers, its channels taken together, about the state that was expected (`off` from where its residuals were taken) and without the
/// force that pushed it there.
fn alone(link: &Link, (r, off, force): (&DVector<f64>, &DVector<f64>, &DVector<f64>), factors: &DVector<f64>) -> Node {
    let (n_x, n_f) = (link.s.ncols(), link.f.ncols());
    let mut all = DMatrix::zeros(r.len(), n_x + n_f + 1);
    all.columns_mut(0, n_x).copy_from(&link.s);
    all.columns_mut(n_x, n_f).copy_from(&link.f);
    all.column_mut(n_x + n_f).copy_from(&(r + &link.s * off - &link.f * force));
    all.column_iter_mut().for_each(|mut column| column.component_div_assign(factors));
    Node::summed(all.transpose() * all, [link.a.clone(), link.b.clone(), DMatrix::zeros(n_x, 1)])
}
