//! A replay made linear: residuals and their derivatives by free starts and by parameters, starts eliminated.
//!
//! Per segment, with r the residuals, S = ∂r/∂x₀ and G = ∂r/∂θ (difference quotients over steps that move the residual by a fraction of the
//! noise), only products are kept:
//!
//!   H = [S G r]ᵀ [S G r],      K = H_pp − H_ps H_ss⁺ H_sp,      p = (θ, r)
//!
//! K is the Gram matrix of what is left of G and r when the start has done what it can (Schur complement; the pseudo-inverse of the scaled
//! H_ss is damped, so that a start that nothing shows stays put, and a bristle that slides already does not run off). Sums of K over segments hold everything that a step of a fit and a score
//! test need.

use crate::held::holds;
use crate::pace::touches;
use crate::plant::Built;
use crate::replay::{Pace, Span, readings, residuals_of};
use crate::start::{Freedom, Start, freedoms};
use crate::tape::Tape;
use crate::work::Work;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use scenario::measure::Reading as Measured;
use std::sync::Arc;

/// A stretch of a run, with the start that is believed at present.
#[derive(Clone, Debug)]
pub struct Segment {
    /// Index of the run.
    pub run: usize,
    /// The stretch.
    pub span: Span,
    /// Its start.
    pub start: Start,
    /// What the samples around it say of the start, whatever the model.
    pub guess: Arc<Start>,
    /// Weight of its residuals; below one where a window is far from followed and shall not outvote the others.
    pub weight: f64,
    /// Derivatives by the start, as last computed: they change little from one fit to the next.
    pub columns: Option<Arc<StartColumns>>,
    /// Steps of the difference quotients that served last.
    pub steps: Steps,
}

/// Derivatives of a segment's residual by the coordinates of its start, and by the numbers that only move within their tolerances: they change
/// little from one set of effects to the next.
#[derive(Clone, Debug)]
pub struct StartColumns {
    /// The coordinates.
    pub freedoms: Vec<Freedom>,
    /// A column each.
    pub columns: Vec<DVector<f64>>,
    /// Columns of the numbers with a tolerance, as last computed; empty where there are none.
    pub within: Vec<DVector<f64>>,
}

impl StartColumns {
    /// Whether they are those of a residual of so many scalars.
    pub(crate) fn is_of(&self, count: usize) -> bool {
        self.columns.iter().all(|c| c.len() == count)
    }
}

/// Steps of the difference quotients by coordinate of a start; they live from one linearisation to the next.
#[derive(Clone, Debug, Default)]
pub struct Steps(Arc<[(Freedom, f64)]>);

/// A changed model and how far it was changed: one column of G.
#[derive(Clone, Debug)]
pub struct Variation {
    /// The model with one parameter moved.
    pub built: Built,
    /// By how much.
    pub step: f64,
    /// Whether that parameter only moves within its tolerance.
    pub is_tolerated: bool,
}

/// Products of one segment's residuals and derivatives.
#[derive(Clone, Debug)]
pub struct SegmentLinear {
    /// Scalars in the residual.
    pub count: usize,
    /// Squared norm of the residual.
    pub cost: f64,
    /// Free coordinates of the start.
    pub freedoms: Vec<Freedom>,
    /// How many of them the residual shows.
    pub shown: usize,
    /// Gram matrix of (G, r) with the start eliminated.
    pub reduced: DMatrix<f64>,
    /// H_ss⁺ H_sp: what the start takes of each column of (G, r).
    pub taken: DMatrix<f64>,
    /// The start's columns.
    pub columns: Option<Arc<StartColumns>>,
    /// The steps over which they were taken.
    pub steps: Steps,
    /// H_ss, H_sp and H_pp.
    pub gram: [DMatrix<f64>; 3],
}

/// Damping of the scaled H_ss.
const DAMPING: f64 = 1e-9;
/// Root mean square by which a step shall move the residual, in units of noise.
const WISH: f64 = 0.2;
/// Root mean square below which a change of the residual is rounding, units of noise.
const ROUNDING: f64 = 1e-5;
/// The same below which a variation's step leaves a segment as it is, where others move by tenths of the noise.
const UNTOUCHED: f64 = 1e-3;
/// Longest step of a start's coordinate, its own unit.
const LONGEST: f64 = 1.0;
/// Range of that within which a step is kept.
const FAIR: [f64; 2] = [0.02, 2.0];

/// Steps of derivatives and screens, in steps of a prediction.
const COARSER: f64 = 2.0;
/// Root mean square by which these may move a residual and still be taken for derivatives, units of noise.
const ALIKE: f64 = 0.3;
/// Share of that which is always borne.
const SMOOTH: f64 = 0.1;

/// Cells over whose means commands are heard for derivatives, s, the finest first.
pub(crate) fn cells(step: f64) -> [f64; 2] {
    [COARSER * step, COARSER * COARSER * step]
}

/// Everything that replays need beside the segment itself.
#[derive(Clone, Copy, Debug)]
pub struct Stage<'a> {
    /// Runs.
    pub tapes: &'a [Tape],
    /// Step of the replay.
    pub pace: Pace,
    /// What was simulated so far.
    pub work: &'a Work<'a>,
    /// Cost per scalar that is not told from a wrong noise level.
    pub doubt: f64,
    /// Cells over whose means commands are heard where nothing touches, s; none: as they were recorded.
    pub hears: Option<f64>,
}

impl Stage<'_> {
    /// The same with longer steps: derivatives and promises bear what predictions do not.
    pub fn coarser(&self) -> Self {
        let Pace { step, free, .. } = self.pace;
        let step = COARSER * step;
        // Long steps in flight are as long as they may be already.
        let free = if free > self.pace.step { free.max(step) } else { step };
        Self { pace: Pace { step, free, ..self.pace }, hears: Some(step), ..*self }
    }

    /// Where derivatives are taken, and the residuals there; `r` are those of a prediction.
    pub(crate) fn beside(&self, built: &Built, segment: &Segment, r: &DVector<f64>) -> (Self, DVector<f64>) {
        self.beside_within(built, (segment, r), [self.coarser()], ALIKE)
    }

    /// The same for a fit. Where parts touch coarse steps are rough, not only off, and difference quotients do not tell roughness from change: the
    /// less is left to explain, the smoother these have to be.
    fn closely_beside(&self, built: &Built, segment: &Segment, r: &DVector<f64>) -> (Self, DVector<f64>) {
        let left = (r.norm_squared() / r.len().max(1) as f64 - 1.0).max(0.0).sqrt();
        let bound = if touches(built) { ALIKE * left.clamp(SMOOTH, 1.0) } else { ALIKE };
        self.beside_within(built, (segment, r), [self.coarser()], bound)
    }

    /// Where derivatives are taken that only lead towards a start: their error has to be small against what is left to reduce.
    pub(crate) fn towards(&self, built: &Built, segment: &Segment, r: &DVector<f64>) -> (Self, DVector<f64>) {
        let left = (r.norm_squared() / r.len().max(1) as f64).sqrt();
        self.beside_within(built, (segment, r), [self.coarser().coarser(), self.coarser()], ALIKE * left.max(1.0))
    }

    /// The first of some coarser stages that moves a residual by less than a bound, and what it is there; else this one.
    fn beside_within<const N: usize>(
        &self,
        built: &Built,
        (segment, r): (&Segment, &DVector<f64>),
        coarser: [Self; N],
        bound: f64,
    ) -> (Self, DVector<f64>) {
        let is_near = |base: &DVector<f64>| (base - r).norm_squared() < bound * bound * r.len().max(1) as f64;
        let bases = coarser.into_iter().map(|stage| (stage, stage.residuals(built, segment)));
        bases.into_iter().find(|(_, base)| is_near(base)).unwrap_or_else(|| (*self, r.clone()))
    }

    /// Residuals of a segment; infinite where the replay left the range of numbers.
    pub fn residuals(&self, built: &Built, segment: &Segment) -> DVector<f64> {
        self.residuals_from(built, segment, &segment.start)
    }

    fn residuals_from(&self, built: &Built, segment: &Segment, start: &Start) -> DVector<f64> {
        match self.readings_from(built, segment, start) {
            Some(readings) => self.residuals_of(&readings, built, segment),
            None => DVector::from_element(self.count(segment), f64::INFINITY),
        }
    }

    /// What faultless sensors would read in a segment; none where the replay left the range of numbers.
    pub fn readings(&self, built: &Built, segment: &Segment) -> Option<Vec<Measured>> {
        self.readings_from(built, segment, &segment.start)
    }

    fn readings_from(&self, built: &Built, segment: &Segment, start: &Start) -> Option<Vec<Measured>> {
        let tape = &self.tapes[segment.run];
        let heard = self.hears.filter(|_| !holds(built)).map_or(tape, |longest| tape.heard_at(longest));
        let found = readings(built, tape, heard, start, segment.span, self.pace);
        let work = found.as_ref().map_or_else(|_| sim::Work::default(), |r| r.work);
        self.work.add(segment.span.to - segment.span.from, built.model.owners.len(), &work);
        found.ok().map(|r| r.values)
    }

    /// Change of the residual per unit of a variation that concerns nothing but how readings are read.
    pub fn column_of(
        &self,
        readings: &[Measured],
        variation: &Variation,
        segment: &Segment,
        r: &DVector<f64>,
    ) -> DVector<f64> {
        sane((self.residuals_of(readings, &variation.built, segment) - r) / variation.step)
    }

    /// Residuals of a segment whose readings are known; infinite where there are none.
    pub fn residuals_of(&self, readings: &[Measured], built: &Built, segment: &Segment) -> DVector<f64> {
        match residuals_of(readings, built, &self.tapes[segment.run], segment.span) {
            Ok(r) if !readings.is_empty() && segment.weight == 1.0 => DVector::from_vec(r),
            Ok(r) if !readings.is_empty() => DVector::from_vec(r) * segment.weight.sqrt(),
            _ => DVector::from_element(self.count(segment), f64::INFINITY),
        }
    }

    /// Scalars in a segment's residual.
    pub fn count(&self, segment: &Segment) -> usize {
        let tape = &self.tapes[segment.run];
        let range = tape.range(segment.span);
        tape.offsets[range.end] - tape.offsets[range.start]
    }

    /// Scalars in the residuals of some segments, and their squared norm if they were noise alone.
    pub fn noise(&self, segments: &[Segment]) -> (usize, f64) {
        let counts = segments.iter().map(|s| (self.count(s), s.weight));
        counts.fold((0, 0.0), |sum, (count, weight)| (sum.0 + count, sum.1 + weight * count as f64))
    }

    /// Squared norm of all residuals.
    pub fn cost(&self, built: &Built, segments: &[Segment]) -> f64 {
        let parts: Vec<f64> = segments.par_iter().map(|s| finite(self.residuals(built, s).norm_squared())).collect();
        parts.iter().sum()
    }

    /// Linearises every segment about its start, with a column for each variation; `reuse`: the start's columns may be known ones.
    pub fn linearise(
        &self,
        built: &Built,
        segments: &[Segment],
        variations: &[Variation],
        reuse: bool,
    ) -> Vec<SegmentLinear> {
        segments.par_iter().map(|segment| self.linearise_segment(built, segment, variations, reuse)).collect()
    }

    /// Columns of variations; those of numbers with a tolerance may be known ones.
    pub fn columns_by(
        &self,
        segment: &Segment,
        r: &DVector<f64>,
        variations: &[Variation],
        reuse: bool,
    ) -> Vec<DVector<f64>> {
        let tolerated = variations.iter().filter(|v| v.is_tolerated).count();
        let is_whole =
            |k: &&Arc<StartColumns>| k.within.len() == tolerated && k.within.iter().all(|c| c.len() == r.len());
        let known = segment.columns.as_ref().filter(|_| reuse).filter(is_whole);
        let rank = |i: usize| variations[..i].iter().filter(|v| v.is_tolerated).count();
        let of = |(i, v): (usize, &Variation)| match known.filter(|_| v.is_tolerated) {
            Some(known) => known.within[rank(i)].clone(),
            None => self.column(v, segment, r),
        };
        variations.par_iter().enumerate().map(of).collect()
    }

    /// Change of the residual per unit of a variation, from the same start.
    pub fn column(&self, variation: &Variation, segment: &Segment, r: &DVector<f64>) -> DVector<f64> {
        let start = segment.start.fitted_to(&variation.built);
        let moved = self.residuals_from(&variation.built, segment, &start) - r;
        // What no reading shows must not be estimated from rounding.
        if moved.norm_squared() < ROUNDING * ROUNDING * r.len() as f64 {
            return DVector::zeros(r.len());
        }
        sane(moved / variation.step)
    }

    /// Difference quotients by some coordinates of the start, and the steps over which they were taken.
    pub fn quotients(
        &self,
        built: &Built,
        segment: &Segment,
        r: &DVector<f64>,
        (all, sizes): (&[Freedom], &[f64]),
    ) -> Vec<(DVector<f64>, f64)> {
        let of = |(freedom, size): (&Freedom, &f64)| {
            quotient(r, *size, |step| self.residuals_from(built, segment, &segment.start.moved(*freedom, step)))
        };
        all.par_iter().zip(sizes.par_iter()).map(of).collect()
    }

    /// Columns of a start: those that are known already, the others by replays.
    fn start_columns_beside(
        &self,
        built: &Built,
        segment: &Segment,
        r: &DVector<f64>,
        (all, mut sizes): (&[Freedom], Vec<f64>),
        known: Option<&Arc<StartColumns>>,
    ) -> (Arc<StartColumns>, Vec<f64>) {
        if let Some(known) = known.filter(|k| k.freedoms == all) {
            return (Arc::clone(known), sizes);
        }
        let place = |f: &Freedom| known.and_then(|k| k.freedoms.iter().position(|g| g == f).map(|i| &k.columns[i]));
        let open: Vec<usize> = (0..all.len()).filter(|i| place(&all[*i]).is_none()).collect();
        let open_freedoms: Vec<Freedom> = open.iter().map(|i| all[*i]).collect();
        let open_sizes: Vec<f64> = open.iter().map(|i| sizes[*i]).collect();
        let mut fresh = self.quotients(built, segment, r, (&open_freedoms, &open_sizes)).into_iter();
        let column = |(i, f): (usize, &Freedom)| match place(f) {
            Some(known) => known.clone(),
            None => {
                let (column, size) = fresh.next().unwrap_or_else(|| (DVector::zeros(r.len()), sizes[i]));
                sizes[i] = size;
                column
            }
        };
        let columns = all.iter().enumerate().map(column).collect();
        (Arc::new(StartColumns { freedoms: all.to_vec(), columns, within: Vec::new() }), sizes)
    }

    /// The columns of a segment's start: those of the fit that it comes from, where it has them.
    pub fn columns_of(&self, built: &Built, segment: &Segment, r: &DVector<f64>) -> Arc<StartColumns> {
        let all = freedoms(built, &segment.start);
        self.start_columns_beside(built, segment, r, (&all, segment.steps.of(&all)), segment.columns.as_ref()).0
    }

    fn linearise_segment(
        &self,
        built: &Built,
        segment: &Segment,
        variations: &[Variation],
        reuse: bool,
    ) -> SegmentLinear {
        let all = freedoms(built, &segment.start);
        let r = self.residuals(built, segment);
        let (coarse, base) = self.closely_beside(built, segment, &r);
        let of_model = coarse.columns_by(segment, &base, variations, reuse);
        // A flight in which next to nothing of the variations shows has nothing to follow: any columns serve.
        let moved = |(column, v): (&DVector<f64>, &Variation)| v.step * v.step * column.norm_squared();
        let is_untouched = of_model.iter().zip(variations).all(|m| moved(m) < UNTOUCHED * UNTOUCHED * r.len() as f64);
        let known = segment.columns.as_ref().filter(|_| reuse || is_untouched);
        let (of_start, sizes) =
            coarse.start_columns_beside(built, segment, &base, (&all, segment.steps.of(&all)), known);
        let of_start = remembering(of_start, variations, &of_model);
        let s: Vec<&DVector<f64>> = of_start.columns.iter().collect();
        let p: Vec<&DVector<f64>> = of_model.iter().chain(std::iter::once(&r)).collect();
        let linear = eliminate(&s, &p, &all);
        SegmentLinear { columns: Some(of_start), steps: Steps::new(&all, &sizes), ..linear }
    }
}

/// Columns of a start that remember those of the numbers with a tolerance.
fn remembering(known: Arc<StartColumns>, variations: &[Variation], columns: &[DVector<f64>]) -> Arc<StartColumns> {
    let within = || variations.iter().zip(columns).filter(|(v, _)| v.is_tolerated).map(|(_, c)| c);
    if within().count() == known.within.len() && within().zip(&known.within).all(|(a, b)| a == b) {
        return known;
    }
    Arc::new(StartColumns { within: within().cloned().collect(), ..(*known).clone() })
}

/// A cost that no number can hold is beyond all others.
pub(crate) fn finite(cost: f64) -> f64 {
    if cost.is_nan() { f64::INFINITY } else { cost }
}

/// A column that no number can hold says nothing.
fn sane(column: DVector<f64>) -> DVector<f64> {
    if column.iter().all(|x| x.is_finite()) { column } else { DVector::zeros(column.len()) }
}

/// Difference quotient over a step that moves the residual by a fraction of the noise; and that step.
fn quotient(r: &DVector<f64>, first: f64, moved: impl Fn(f64) -> DVector<f64>) -> (DVector<f64>, f64) {
    let mut step = first;
    for trial in 0..4 {
        let column = moved(step) - r;
        let size = (column.norm_squared() / (r.len().max(1) as f64)).sqrt();
        let fair = (FAIR[0]..FAIR[1]).contains(&size);
        // What no reading shows (a place that nothing measures) must not be estimated from rounding.
        if size == 0.0 || step >= LONGEST && size < ROUNDING {
            return (DVector::zeros(r.len()), step);
        }
        if fair || trial == 3 {
            return (sane(column / step), step);
        }
        step *= if size.is_finite() { (WISH / size.max(1e-12)).clamp(1e-4, 1e4) } else { 1e-3 };
        step = step.clamp(1e-13, LONGEST);
    }
    (DVector::zeros(r.len()), step)
}

/// Products of the columns, the start's eliminated.
pub fn eliminate(s: &[&DVector<f64>], p: &[&DVector<f64>], freedoms: &[Freedom]) -> SegmentLinear {
    let products = |a: &[&DVector<f64>], b: &[&DVector<f64>]| DMatrix::from_fn(a.len(), b.len(), |i, j| a[i].dot(b[j]));
    let (h_ss, h_sp, h_pp) = (products(s, s), products(s, p), products(p, p));
    let r = p[p.len() - 1];
    let shown = h_ss.diagonal().iter().filter(|d| **d > 0.0).count();
    let linear = SegmentLinear {
        count: r.len(),
        shown,
        cost: finite(r.norm_squared()),
        freedoms: freedoms.to_vec(),
        reduced: DMatrix::zeros(0, 0),
        taken: DMatrix::zeros(0, 0),
        columns: None,
        steps: Steps::default(),
        gram: [h_ss, h_sp, h_pp],
    };
    linear.damped(0.0)
}

impl SegmentLinear {
    /// The same with the start's part of the normal equations damped, H_ss + λ diag H_ss: what the data hardly show goes less far.
    pub fn damped(&self, damping: f64) -> Self {
        let [h_ss, h_sp, h_pp] = &self.gram;
        let (n, width) = h_sp.shape();
        let scale = h_ss.diagonal().map(|d| if d > 0.0 { 1.0 / d.sqrt() } else { 0.0 });
        let mut scaled = DMatrix::from_fn(n, n, |i, j| h_ss[(i, j)] * scale[i] * scale[j]);
        for i in 0..n {
            let held = self.freedoms.get(i).and_then(Freedom::reach).map_or(0.0, |reach| (scale[i] / reach).powi(2));
            scaled[(i, i)] += DAMPING + damping + held + if scale[i] == 0.0 { 1.0 } else { 0.0 };
        }
        let right = DMatrix::from_fn(n, width, |i, j| scale[i] * h_sp[(i, j)]);
        let taken = scaled.cholesky().map_or_else(
            || DMatrix::zeros(n, width),
            |c| {
                let x = c.solve(&right);
                DMatrix::from_fn(n, width, |i, j| scale[i] * x[(i, j)])
            },
        );
        Self { reduced: h_pp - h_sp.transpose() * &taken, taken, ..self.clone() }
    }

    /// Step of the start that goes with a step of the parameters.
    pub fn start_step(&self, theta: &[f64]) -> Vec<f64> {
        let r = self.taken.ncols() - 1;
        let of =
            |i: usize| -self.taken[(i, r)] - theta.iter().enumerate().map(|(k, d)| self.taken[(i, k)] * d).sum::<f64>();
        (0..self.taken.nrows()).map(of).collect()
    }
}

impl Steps {
    /// Those that served.
    pub(crate) fn new(freedoms: &[Freedom], sizes: &[f64]) -> Self {
        Self(freedoms.iter().copied().zip(sizes.iter().copied()).collect())
    }

    /// A step for each coordinate: what served, or a first one.
    pub(crate) fn of(&self, freedoms: &[Freedom]) -> Vec<f64> {
        let served = |f: &Freedom| self.0.iter().find(|s| s.0 == *f).map_or_else(|| f.first_step(), |s| s.1);
        freedoms.iter().map(served).collect()
    }
}

/// Sum of the reduced products over segments.
pub fn sum_reduced(segments: &[SegmentLinear]) -> DMatrix<f64> {
    let side = segments.first().map_or(1, |s| s.reduced.nrows());
    segments.iter().fold(DMatrix::zeros(side, side), |sum, s| sum + &s.reduced)
}

/// Windows of a run: `length` long, the rest of the run added to the last; the whole run without a length.
pub fn windows(tape: &Tape, length: Option<f64>) -> Vec<Span> {
    let (first, last) = tape.span;
    let count = length.map_or(1, |l| ((last - first) / l).round().max(1.0) as usize);
    let at = |i: usize| first + (last - first) * i as f64 / count as f64;
    (0..count).map(|i| Span { from: at(i), to: at(i + 1) }).collect()
}
