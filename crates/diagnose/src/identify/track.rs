//! A run cut at knots, simulated interval by interval from states of their own, and made linear.

use super::chain::{self, Node, Prior, Smoothed};
use super::forces::has_memory;
use crate::error::DiagnoseError;
use crate::guess::guess;
use crate::linear::{Stage, Variation};
use crate::plant::Built;
use crate::replay::{Pace, Shot, Span, members_between, shoot};
use crate::start::{Freedom, Start, freedoms};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// An interval between two knots.
#[derive(Clone, Debug)]
pub struct Interval {
    /// When.
    pub span: Span,
    /// The events of the tape that tell of it.
    pub members: Vec<u32>,
    /// The state at its begin that is believed at present.
    pub start: Start,
}

/// What an interval reads, units of noise, and where it ends.
pub type Base = (DVector<f64>, Start);

/// What all intervals of a run read and where they end: as exactly as it is judged, and as derivatives are taken.
#[derive(Clone, Debug)]
pub struct Bases {
    /// For residuals.
    pub exact: Vec<Base>,
    /// For difference quotients.
    pub glanced: Vec<Base>,
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
    /// The model at present.
    pub built: &'a Built,
    /// Coordinates of a state.
    pub freedoms: &'a [Freedom],
    /// An unknown force on each coordinate that moves.
    pub forces: &'a [Variation],
}

/// Coordinates of a state that intervals hand on to each other.
pub fn coordinates(built: &Built, start: &Start) -> Vec<Freedom> {
    freedoms(built, start).into_iter().filter(|f| !matches!(f, Freedom::Bristle(..))).collect()
}

impl Track {
    /// Cuts a run into so many intervals of one length, each with the state that its samples suggest.
    pub fn cut(stage: &Stage<'_>, built: &Built, run: usize, count: usize) -> Result<Self, DiagnoseError> {
        let tape = &stage.tapes[run];
        let (from, to) = tape.span;
        let instants: Vec<f64> = (0..=count).map(|i| from + (to - from) * i as f64 / count as f64).collect();
        let members = members_between(built, tape, &instants)?;
        let interval = |(w, members): (&[f64], Vec<u32>)| {
            let span = Span { from: w[0], to: w[1] };
            Interval { span, members, start: guess(built, tape, w[0]) }
        };
        Ok(Self { run, intervals: instants.windows(2).zip(members).map(interval).collect() })
    }
}

impl Frame<'_> {
    fn shoot(&self, built: &Built, run: usize, interval: &Interval, start: &Start) -> Option<Base> {
        self.shoot_at(self.stage.pace, built, (run, interval), start)
    }

    /// The same at the pace of derivatives: models without corners by the midpoint rule.
    fn glance(&self, built: &Built, run: usize, interval: &Interval, start: &Start) -> Option<Base> {
        self.shoot_at(Pace { midpoint: true, ..self.stage.pace }, built, (run, interval), start)
    }

    fn shoot_at(&self, pace: Pace, built: &Built, (run, interval): (usize, &Interval), start: &Start) -> Option<Base> {
        let tape = &self.stage.tapes[run];
        let found = shoot(built, tape, start, (interval.span, &interval.members), pace);
        let work = found.as_ref().map_or_else(|_| sim::Work::default(), |s| s.work);
        self.stage.work.add(interval.span.to - interval.span.from, built.model.owners.len(), &work);
        let Shot { residuals, end, .. } = found.ok()?;
        residuals.iter().all(|r| r.is_finite()).then(|| (DVector::from_vec(residuals), end))
    }

    /// Derivatives of an interval by its state and by forces; none where its replay left the range of numbers.
    pub fn link(&self, run: usize, interval: &Interval) -> Option<Link> {
        let n_x = self.freedoms.len();
        let (r, end) = &self.glance(self.built, run, interval, &interval.start)?;
        let column = |moved: Option<Base>, step: f64| match moved {
            Some((q, e)) => ((q - r) / step, DVector::from_vec(e.difference(end, self.freedoms)) / step),
            None => (DVector::zeros(r.len()), DVector::zeros(n_x)),
        };
        let by_state = |freedom: &Freedom| {
            let step = freedom.first_step();
            column(self.glance(self.built, run, interval, &interval.start.moved(*freedom, step)), step)
        };
        let by_force = |v: &Variation| column(self.glance(&v.built, run, interval, &interval.start), v.step);
        let states: Vec<_> = self.freedoms.par_iter().map(by_state).collect();
        let forces: Vec<_> = self.forces.par_iter().map(by_force).collect();
        let (s, a) = matrices(&states, r.len(), n_x);
        let (f, b) = matrices(&forces, r.len(), n_x);
        Some(Link { s, f, a, b })
    }

    /// Columns of a number along a run, carried from interval to interval as far as it brings memory of its own: ∂r/∂θ and ∂end/∂θ of each.
    pub fn columns(&self, track: &Track, bases: &Bases, variation: &Variation) -> Vec<Column> {
        let brings = has_memory(&variation.built, self.built);
        let mut carried: Option<Start> = None;
        let mut out = Vec::with_capacity(track.intervals.len());
        let bases = if variation.built.model.is_smooth() { &bases.glanced } else { &bases.exact };
        for (interval, (r, end)) in track.intervals.iter().zip(bases) {
            let mut start = interval.start.fitted_to(&variation.built);
            if let Some(before) = carried.as_ref().filter(|_| brings) {
                start.remember(before, self.built);
            }
            let Some((q, e)) = self.glance(&variation.built, track.run, interval, &start) else {
                out.push((DVector::zeros(r.len()), DVector::zeros(self.freedoms.len())));
                continue;
            };
            let by = DVector::from_vec(e.difference(end, self.freedoms)) / variation.step;
            out.push(((q - r) / variation.step, by));
            carried = Some(e);
        }
        out
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

    /// What the present model reads in every interval, and where each ends; none where a replay left the range of numbers.
    pub fn bases(&self, track: &Track) -> Option<Bases> {
        let all = || track.intervals.par_iter();
        let exact: Option<Vec<Base>> = all().map(|i| self.shoot(self.built, track.run, i, &i.start)).collect();
        let exact = exact?;
        let glanced: Option<Vec<Base>> = match self.built.model.is_smooth() {
            true => all().map(|i| self.glance(self.built, track.run, i, &i.start)).collect(),
            false => Some(exact.clone()),
        };
        Some(Bases { exact, glanced: glanced? })
    }

    /// Follows a run from its first state by what its samples say (extended Kalman filter, each interval about its own estimate), and leaves the states there; the derivatives
    /// on the way, or none where a replay left the range of numbers.
    pub fn follow(&self, track: &mut Track, prior: Prior<'_>) -> Option<Vec<Link>> {
        let mut links = Vec::new();
        let mut root = DMatrix::from_diagonal(prior.start);
        let count = track.intervals.len();
        for i in 0..count {
            let mut passes = if i == 0 { FIRST } else { 1 };
            let (update, end) = loop {
                let interval = &track.intervals[i];
                let base = self.shoot(self.built, track.run, interval, &interval.start)?;
                let link = self.link(track.run, interval)?;
                let update = chain::update(&alone(&link, &base.0), &root, prior);
                passes -= 1;
                if passes == 0 {
                    links.push(link);
                    break (update, base.1);
                }
                track.intervals[i].start = interval.start.retract(self.freedoms, update.state.as_slice());
            };
            if i + 1 < count {
                track.intervals[i + 1].start = end.retract(self.freedoms, update.end.as_slice());
            }
            root = update.root;
        }
        Some(links)
    }

    /// Derivatives of all intervals of a run.
    pub fn links(&self, track: &Track) -> Option<Vec<Link>> {
        track.intervals.par_iter().map(|interval| self.link(track.run, interval)).collect()
    }

    /// Residuals and defects of a run beside columns of numbers.
    pub fn sides(&self, track: &Track, bases: &Bases, columns: &[Vec<Column>]) -> Vec<Side> {
        let n_x = self.freedoms.len();
        let of = |i: usize| {
            let (r, end) = &bases.exact[i];
            let next = track.intervals.get(i + 1);
            let defect = next.map_or_else(|| vec![0.0; n_x], |next| end.difference(&next.start, self.freedoms));
            let width = columns.len() + 1;
            let (mut y, mut d) = (DMatrix::zeros(r.len(), width), DMatrix::zeros(n_x, width));
            for (k, column) in columns.iter().enumerate() {
                y.column_mut(k).copy_from(&column[i].0);
                d.column_mut(k).copy_from(&column[i].1);
            }
            y.column_mut(width - 1).copy_from(r);
            d.column_mut(width - 1).copy_from_slice(&defect);
            Side { y, d }
        };
        (0..track.intervals.len()).map(of).collect()
    }

    /// The state at an instant of a run, from the interval that it lies in.
    pub fn state_at(&self, track: &Track, time: f64) -> Option<Start> {
        let at = track.intervals.partition_point(|i| i.span.from <= time + SAME).max(1) - 1;
        let interval = &track.intervals[at];
        if (interval.span.from - time).abs() <= SAME {
            return Some(interval.start.clone());
        }
        let part = Interval { span: Span { to: time, ..interval.span }, members: Vec::new(), ..interval.clone() };
        self.shoot(self.built, track.run, &part, &part.start).map(|base| base.1)
    }

    /// Moves the states of a run as a smoother says.
    pub fn moved(&self, track: &Track, smoothed: &Smoothed) -> Track {
        let mut moved = track.clone();
        for (interval, by) in moved.intervals.iter_mut().zip(&smoothed.states) {
            interval.start = interval.start.retract(self.freedoms, by.as_slice());
        }
        moved
    }
}

/// ∂r/∂θ and ∂end/∂θ of an interval.
pub type Column = (DVector<f64>, DVector<f64>);

/// Two instants closer than this are one, s.
const SAME: f64 = 1e-9;
/// Passes over the first interval, whose state is only guessed.
const FIRST: usize = 3;

fn matrices(columns: &[Column], rows: usize, n_x: usize) -> (DMatrix<f64>, DMatrix<f64>) {
    let of = |rows: usize, pick: fn(&Column) -> &DVector<f64>| {
        DMatrix::from_fn(rows, columns.len(), |i, j| pick(&columns[j])[i])
    };
    (of(rows, |c| &c.0), of(n_x, |c| &c.1))
}

/// An interval without numbers, its channels taken together.
fn alone(link: &Link, r: &DVector<f64>) -> Node {
    let (n_x, n_f) = (link.s.ncols(), link.f.ncols());
    let mut all = DMatrix::zeros(r.len(), n_x + n_f + 1);
    all.columns_mut(0, n_x).copy_from(&link.s);
    all.columns_mut(n_x, n_f).copy_from(&link.f);
    all.column_mut(n_x + n_f).copy_from(r);
    Node { grams: vec![(0, all.tr_mul(&all))], a: link.a.clone(), b: link.b.clone(), d: DMatrix::zeros(n_x, 1) }
}
