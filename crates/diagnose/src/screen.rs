//! The screen: what each hypothesis could explain, without a refit.
//!
//! For the columns C of a screen point, with starts and the active parameters P projected out of C and r,
//!
//!   S = b ᵀA⁻¹ b,  A = C⊥ᵀC⊥,  b = C⊥ᵀr⊥,    amplitudes −A⁻¹ b
//!
//! S is the fall of the cost that the linear model promises, χ² with the rank of A where nothing but noise is left. An effect with memory
//! brings the memory's own start as columns that each segment eliminates: in windows that begin in mid-run it is already moving.

use crate::error::DiagnoseError;
use crate::fit::{Fit, pseudo_inverse, scaled, vary};
use crate::hypothesis::{Column, Hypothesis, Scale, ScreenPoint};
use crate::linear::{Segment, Stage, StartColumns, Variation, eliminate};
use crate::plant::{Built, Plant};
use crate::start::{Freedom, freedoms};
use crate::stretches::spokesmen;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::sync::Arc;

/// What a screen point promises.
#[derive(Clone, Debug)]
pub struct Score {
    /// Index of the hypothesis.
    pub hypothesis: usize,
    /// Index of its screen point.
    pub point: usize,
    /// Promised fall of the cost.
    pub score: f64,
    /// Rank of its columns.
    pub rank: usize,
    /// Coordinates to begin a refit with.
    pub start: Vec<f64>,
    /// How far the numbers that are fitted already go with it; empty where the screen does not say.
    pub beside: Vec<f64>,
    /// How well the data show it.
    pub shown: Shown,
}

/// What the Fisher information of a screen says of a hypothesis, starts and active parameters eliminated.
#[derive(Clone, Debug)]
pub struct Shown {
    /// What was varied and the standard error that it would have: a coordinate, in its parameter's unit, or a share of the whole effect where
    /// that has no derivative at neutral. Infinite where nothing shows it.
    pub errors: Vec<(String, f64)>,
    /// Condition number of the scaled information matrix.
    pub condition: f64,
}

/// A column of a screen point.
pub(crate) struct Probe {
    variation: Variation,
    /// Steps of the memory that it brings, where its starts are to be freed.
    memory: Option<Vec<f64>>,
    /// Whether it concerns nothing but how readings are read.
    is_reading: bool,
}

/// Root mean square (units of noise) that a column's step shall have on the pilot segments.
const WISH: f64 = 0.3;
/// Root mean square below which a probe's step says nothing, units of noise.
const SILENT: f64 = 1e-3;
/// One in so many segments tunes the steps, and so many of the worst.
const PILOTS: usize = 8;
const WORST: usize = 2;
/// A screen looks at so many of the longest segments, or at more of shorter ones.
const SEGMENTS: f64 = 24.0;

/// Scores every screen point of every hypothesis beside a converged fit; best first.
///
/// Of very many segments an even selection speaks for all.
pub fn screen(stage: &Stage<'_>, plant: &Plant, fit: &Fit, all: &[Hypothesis]) -> Result<Vec<Score>, DiagnoseError> {
    let (thinned, share) = thinned(fit);
    let mut scores = screen_all(&stage.coarser(), plant, &thinned, all)?;
    scores.iter_mut().for_each(|s| s.score /= share);
    Ok(scores)
}

/// A fit of an even selection of its segments that is enough to screen by, and their share of all.
pub(crate) fn thinned(fit: &Fit) -> (Fit, f64) {
    let lengths = fit.segments.iter().map(|s| s.span.to - s.span.from);
    let (total, longest) = lengths.fold((0.0, 0.0), |(sum, most): (f64, f64), l| (sum + l, most.max(l)));
    let every = ((total / (SEGMENTS * longest)).ceil() as usize).max(1);
    let thinned =
        Fit { segments: fit.segments.iter().skip(every / 2).step_by(every).cloned().collect(), ..fit.clone() };
    let share = thinned.segments.len() as f64 / fit.segments.len().max(1) as f64;
    (thinned, share)
}

fn screen_all(stage: &Stage<'_>, plant: &Plant, fit: &Fit, all: &[Hypothesis]) -> Result<Vec<Score>, DiagnoseError> {
    let active = vary_active(plant, fit)?;
    let points: Vec<(usize, usize)> =
        all.iter().enumerate().flat_map(|(h, hyp)| (0..hyp.screens.len()).map(move |p| (h, p))).collect();
    let pilots = Pilots::new(stage, fit);
    let probes_at = |(h, p): &(usize, usize)| probes_of(stage, plant, (fit, &pilots), (&all[*h], &all[*h].screens[*p]));
    let probes: Vec<Vec<Probe>> = points.par_iter().map(probes_at).collect();
    let mut products = sum_products(stage, fit, &active, &probes);
    products.iter_mut().for_each(|k| fit.set.add_prior(k));
    let counts = (active.len(), fit.count);
    let places = points.iter().zip(&probes).zip(products);
    let scores = places.filter_map(|((at, probes), k)| score((&all[at.0], *at), probes, k, counts));
    let mut scores: Vec<Score> = scores.collect();
    scores.sort_by(|a, b| b.score.total_cmp(&a.score));
    Ok(scores)
}

/// A model for each fitted number of a set, moved by a step that suits it.
pub(crate) fn vary_active(plant: &Plant, fit: &Fit) -> Result<Vec<Variation>, DiagnoseError> {
    let slots = fit.set.slots();
    let sizes: Vec<f64> = slots.iter().map(|(m, k)| active_size(fit, *m, *k)).collect();
    vary(plant, &fit.set, &slots, &sizes)
}

/// A step of an active coordinate: a tenth of its standard error moves the whole residual by a tenth of one unit; a hundredfold of it is still linear.
fn active_size(fit: &Fit, m: usize, k: usize) -> f64 {
    let at = fit.set.slots().iter().position(|s| *s == (m, k)).unwrap_or(0);
    let error = fit.covariance.get((at, at)).map_or(0.0, |v| v.max(0.0).sqrt());
    let coordinate = &fit.set.members[m].0.coordinates[k];
    let floor = if coordinate.scale == Scale::Log { 1e-5 } else { 1e-6 * fit.set.members[m].1[k].abs() };
    (3.0 * error).max(floor).max(1e-12)
}

/// The columns of a screen point with tuned steps; those that cannot be built are left out.
pub(crate) fn probes_of(
    stage: &Stage<'_>,
    plant: &Plant,
    (fit, pilots): (&Fit, &Pilots<'_>),
    (hypothesis, point): (&Hypothesis, &ScreenPoint),
) -> Vec<Probe> {
    let build = |base: &[f64], direction: &[f64], step: f64| -> Option<Variation> {
        let x: Vec<f64> = base.iter().zip(direction).map(|(b, d)| b + step * d).collect();
        let set = fit.set.with(hypothesis, &hypothesis.clamped(&x));
        plant.build(&set.effects()).ok().map(|built| Variation { built, step, is_tolerated: false })
    };
    let tuned = |c: &Column| {
        let first = build(&c.base, &c.direction, c.step)?;
        if c.secant {
            return Some(first);
        }
        let size = pilots.size(stage, &first.built);
        let step = if size > 0.0 && size.is_finite() { c.step * (WISH / size).clamp(1e-6, 1e4) } else { c.step };
        let near = (0.1..3.0).contains(&(step / c.step));
        let variation = if near { first } else { build(&c.base, &c.direction, step)? };
        Some(variation)
    };
    let mut probes: Vec<Probe> = point
        .columns
        .iter()
        .filter_map(tuned)
        .map(|variation| Probe { variation, memory: None, is_reading: hypothesis.is_reading() })
        .collect();
    // Memory is much the same in all columns of a point: two of them tell its starts.
    let pilot = &fit.segments[fit.segments.len() / 2];
    for probe in probes.iter_mut().step_by(3).take(2) {
        let base = freedoms(&fit.built, &pilot.start);
        let own = freedoms(&probe.variation.built, &pilot.start.fitted_to(&probe.variation.built));
        if own.iter().any(|f| !base.contains(f)) {
            probe.memory = Some(Vec::new());
            probe.memory = Some(own_columns(stage, pilot, &base, probe).1);
        }
    }
    probes
}

/// Segments that tune steps, those in which most is amiss and an even selection, with the residuals of the fit.
pub(crate) struct Pilots<'a> {
    all: &'a [Segment],
    residuals: Vec<DVector<f64>>,
    chosen: Vec<usize>,
}

impl<'a> Pilots<'a> {
    pub(crate) fn new(stage: &Stage<'_>, fit: &'a Fit) -> Self {
        let all = &fit.segments;
        let residuals: Vec<DVector<f64>> = all.par_iter().map(|s| stage.residuals(&fit.built, s)).collect();
        let excess = |(s, r): (&Segment, &DVector<f64>)| r.norm_squared() / s.weight - r.len() as f64;
        let excesses: Vec<f64> = all.iter().zip(&residuals).map(excess).collect();
        Self { all, residuals, chosen: spokesmen(&excesses, (WORST, all.len().div_ceil(PILOTS))) }
    }

    /// Root mean square of what a changed model does to the pilots; to any segment, where none of these shows it.
    fn size(&self, stage: &Stage<'_>, built: &Built) -> f64 {
        let moved = |i: usize| {
            let segment = &self.all[i];
            let moved = Segment { start: segment.start.fitted_to(built), ..segment.clone() };
            let difference = stage.residuals(built, &moved) - &self.residuals[i];
            (difference.norm_squared() / difference.len().max(1) as f64).sqrt()
        };
        let size = self.chosen.iter().map(|i| moved(*i)).fold(0.0, f64::max);
        if size > 0.0 { size } else { (0..self.all.len()).map(moved).find(|size| *size > 0.0).unwrap_or(0.0) }
    }
}

/// Reduced products of (active, columns, r) of every point, summed over the segments.
fn sum_products(stage: &Stage<'_>, fit: &Fit, active: &[Variation], probes: &[Vec<Probe>]) -> Vec<DMatrix<f64>> {
    let of_segment: Vec<Vec<DMatrix<f64>>> =
        fit.segments.par_iter().map(|segment| products_of(stage, fit, segment, active, probes)).collect();
    (0..probes.len())
        .map(|p| {
            let side = active.len() + probes[p].len() + 1;
            of_segment.iter().fold(DMatrix::zeros(side, side), |sum, parts| sum + &parts[p])
        })
        .collect()
}

fn products_of(
    stage: &Stage<'_>,
    fit: &Fit,
    segment: &Segment,
    active: &[Variation],
    probes: &[Vec<Probe>],
) -> Vec<DMatrix<f64>> {
    let screened = Screened::new(stage, fit, segment, active);
    let of_point = |probes: &Vec<Probe>| {
        let columns: Vec<DVector<f64>> = probes.iter().map(|p| screened.column(p)).collect();
        let of_memory = |p: &Probe| own_columns(stage, segment, &screened.start.freedoms, p).0;
        let own: Vec<DVector<f64>> = probes.iter().flat_map(of_memory).collect();
        screened.reduced(&columns, &own)
    };
    probes.par_iter().map(of_point).collect()
}

/// A segment about which hypotheses are made linear.
pub(crate) struct Screened<'a> {
    stage: &'a Stage<'a>,
    segment: &'a Segment,
    readings: Vec<scenario::measure::Reading>,
    r: DVector<f64>,
    start: Arc<StartColumns>,
    /// Columns of the active numbers.
    active: Vec<DVector<f64>>,
}

impl<'a> Screened<'a> {
    pub(crate) fn new(stage: &'a Stage<'a>, fit: &Fit, segment: &'a Segment, active: &[Variation]) -> Self {
        let readings = stage.readings(&fit.built, segment).unwrap_or_default();
        let r = stage.residuals_of(&readings, &fit.built, segment);
        let start = stage.columns_of(&fit.built, segment, &r);
        let active = stage.columns_by(segment, &r, active, true);
        Self { stage, segment, readings, r, start, active }
    }

    /// Change of the residual per unit of a probe's step.
    pub(crate) fn column(&self, probe: &Probe) -> DVector<f64> {
        match probe.is_reading {
            true => self.stage.column_of(&self.readings, &probe.variation, self.segment, &self.r),
            false => self.stage.column(&probe.variation, self.segment, &self.r),
        }
    }

    /// Products of (active numbers, columns, residual), the start and what a memory begins with eliminated.
    pub(crate) fn reduced(&self, columns: &[DVector<f64>], memory: &[DVector<f64>]) -> DMatrix<f64> {
        let starts: Vec<&DVector<f64>> = self.start.columns.iter().chain(memory).collect();
        let others: Vec<&DVector<f64>> = self.active.iter().chain(columns).chain(std::iter::once(&self.r)).collect();
        eliminate(&starts, &others, &vec![Freedom::Memory(0); starts.len()]).reduced
    }
}

/// Columns of the memory that a hypothesis brings, and the steps over which they were taken.
fn own_columns(stage: &Stage<'_>, segment: &Segment, base: &[Freedom], probe: &Probe) -> (Vec<DVector<f64>>, Vec<f64>) {
    let Some(steps) = &probe.memory else { return Default::default() };
    let built = &probe.variation.built;
    let moved = Segment { start: segment.start.fitted_to(built), ..segment.clone() };
    let own: Vec<Freedom> = freedoms(built, &moved.start).into_iter().filter(|f| !base.contains(f)).collect();
    let r = stage.residuals(built, &moved);
    let first: Vec<f64> =
        own.iter().enumerate().map(|(i, f)| steps.get(i).copied().unwrap_or_else(|| f.first_step())).collect();
    stage.quotients(built, &moved, &r, (&own, &first)).into_iter().unzip()
}

/// What a point's information matrix says.
pub(crate) fn find_shown(
    hypothesis: &Hypothesis,
    point: &ScreenPoint,
    (a, inverse): (&DMatrix<f64>, &DMatrix<f64>),
) -> Shown {
    let eigenvalues = scaled(a).1.symmetric_eigenvalues();
    let condition = eigenvalues.max() / eigenvalues.min().max(f64::EPSILON);
    let error = |i: usize| if inverse[(i, i)] > 0.0 { inverse[(i, i)].sqrt() } else { f64::INFINITY };
    let name = |(i, column): (usize, &Column)| {
        let moved = column.direction.iter().position(|d| *d != 0.0).filter(|_| !column.secant);
        match moved.map(|k| (k, &hypothesis.coordinates[k])) {
            Some((k, coordinate)) => {
                let slope = coordinate.slope(column.base[k]) * column.direction[k].abs();
                (coordinate.key.to_owned(), slope * error(i))
            }
            None if point.label.is_empty() => ("share".to_owned(), error(i)),
            None => (format!("share at {}", point.label), error(i)),
        }
    };
    Shown { errors: point.columns.iter().enumerate().map(name).collect(), condition }
}

/// What a point promises; `index` is that of the hypothesis and which of its points.
fn score(
    (hypothesis, index): (&Hypothesis, (usize, usize)),
    probes: &[Probe],
    mut k: DMatrix<f64>,
    (active, count): (usize, usize),
) -> Option<Score> {
    let point = &hypothesis.screens[index.1];
    let n = probes.len();
    if n == 0 || n < point.columns.len() {
        return None;
    }
    // A column that its step does not even move by a thousandth of the noise is rounding, not physics.
    let last = k.ncols() - 1;
    for (i, probe) in probes.iter().enumerate() {
        let moved = probe.variation.step.abs() * (k[(active + i, active + i)].max(0.0) / count as f64).sqrt();
        if moved < SILENT {
            (0..=last).for_each(|j| {
                k[(active + i, j)] = 0.0;
                k[(j, active + i)] = 0.0;
            });
        }
    }
    let (a, b) = project_active(&k, active, n);
    let rank = (0..n).filter(|i| a[(*i, *i)] > 1e-9 * k[(active + i, active + i)].max(1e-30)).count();
    let inverse = pseudo_inverse(&a);
    let amplitudes = -(&inverse * &b);
    let score = -(b.transpose() * &amplitudes)[(0, 0)];
    let weights: Vec<f64> = amplitudes.iter().copied().collect();
    let start = hypothesis.start_from(point, &weights)?;
    let shown = find_shown(hypothesis, point, (&a, &inverse));
    (score.is_finite() && rank > 0).then_some(Score {
        hypothesis: index.0,
        point: index.1,
        score,
        rank,
        start,
        beside: Vec::new(),
        shown,
    })
}

/// A and b of the last `n` columns with the first `active` ones projected out.
fn project_active(k: &DMatrix<f64>, active: usize, n: usize) -> (DMatrix<f64>, DMatrix<f64>) {
    let at = active + n;
    let kpp = k.view((0, 0), (active, active)).into_owned();
    let kpc = k.view((0, active), (active, n)).into_owned();
    let kpr = k.view((0, at), (active, 1)).into_owned();
    let inverse = pseudo_inverse(&kpp);
    let a = k.view((active, active), (n, n)) - kpc.transpose() * &inverse * &kpc;
    let b = k.view((active, at), (n, 1)) - kpc.transpose() * &inverse * &kpr;
    (a, b)
}
