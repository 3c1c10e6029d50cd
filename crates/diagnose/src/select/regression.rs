//! Regression of the missing force on what every hypothesis would make of it.
//!
//! A smoother finds the force f that lacks on every coordinate of every interval, whatever it comes from. What a hypothesis does within an interval is a force
//! as well, W = (FᵀF + Q⁻¹)⁻¹FᵀY with the smoother's variances Q, by which neither is a force that hardly shows, and
//!
//!   f = W θ + ε,   ε ~ t₄ of a scale of its own for each coordinate      (Lange, Little and Taylor 1989; reweighted least squares)
//!
//! asks which of them it is. In contrast to the chain this does not ask that an interval be followed sample by sample along the line on which a hypothesis was
//! taken: where a joint turns, dry friction is far from any line, and a few such intervals are outliers here, not a contradiction.

use super::pool::Pool;
use super::scale::Scale;
use crate::fit::pseudo_inverse;
use crate::identify::chain::Smoothed;
use crate::identify::marginal::Linear;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// The missing force, and the forces of all columns.
pub struct Regression<'a> {
    pool: &'a Pool,
    scale: &'a Scale,
    /// Residuals of the runs, for prices.
    count: usize,
    /// Coordinate by coordinate over all intervals, by what a force there does to the readings: what is missing, its variances, and the columns' forces.
    coordinates: Vec<Coordinate>,
}

struct Coordinate {
    missing: DVector<f64>,
    variance: DVector<f64>,
    columns: DMatrix<f64>,
}

/// A set that the missing force speaks for.
#[derive(Clone, Debug)]
pub struct Spoken {
    /// Entries of the pool, and coordinates to begin a fit with.
    pub members: Vec<(usize, Vec<f64>)>,
    /// Change of −2 log likelihood.
    pub change: f64,
    /// The same with the price of its members.
    pub criterion: f64,
}

/// Degrees of freedom of the t distribution.
const TAILS: f64 = 4.0;
/// Reweightings.
const STEPS: usize = 12;
/// Share of all that is missing by which columns may be off on any coordinate: less is not told apart.
const OFF: f64 = 0.03;
/// Largest inverse of a force's variance.
const LARGEST: f64 = 1e30;
/// Sets that grow, and entries that they grow by.
const GROWN: usize = 3;
const TAKING_PART: usize = 30;

impl<'a> Regression<'a> {
    /// Of some runs with their smoothed forces, whose standard deviations are `force`; the columns of the pool begin at `first`.
    pub fn new(
        (pool, scale): (&'a Pool, &'a Scale),
        (runs, first): (&[Linear], usize),
        (smoothed, force): (&[Smoothed], &DVector<f64>),
    ) -> Self {
        let columns = pool.columns();
        let of_run = |run: &Linear| {
            let of_interval = |i: usize| {
                let f = &run.links[i].f;
                let transposed = f.transpose();
                let mut gram = &transposed * f;
                (0..gram.nrows()).for_each(|k| gram[(k, k)] += force[k].powi(-2).min(LARGEST));
                let told = transposed * run.sides[i].y.columns(first, columns);
                gram.cholesky().map_or_else(|| told.clone() * 0.0, |c| c.solve(&told))
            };
            (0..run.sides.len()).into_par_iter().map(of_interval).collect::<Vec<_>>()
        };
        let parts: Vec<DMatrix<f64>> = runs.iter().flat_map(of_run).collect();
        let flat: Vec<(&DVector<f64>, &DVector<f64>)> =
            smoothed.iter().flat_map(|s| s.forces.iter().zip(&s.variances)).collect();
        let links = || runs.iter().flat_map(|r| r.links.iter());
        let of = |j: usize| {
            let size = (links().map(|l| l.f.column(j).norm_squared()).sum::<f64>() / flat.len().max(1) as f64).sqrt();
            Coordinate {
                missing: DVector::from_iterator(flat.len(), flat.iter().map(|p| size * p.0[j])),
                variance: DVector::from_iterator(flat.len(), flat.iter().map(|p| size * size * p.1[j])),
                columns: DMatrix::from_fn(parts.len(), columns, |i, c| size * parts[i][(j, c)]),
            }
        };
        let n_f = flat.first().map_or(0, |p| p.0.len());
        let count = runs.iter().flat_map(|r| &r.sides).map(|s| s.y.nrows()).sum();
        Self { pool, scale, count, coordinates: (0..n_f).map(of).collect() }
    }

    /// Sets of up to `most` effects, the best first.
    pub fn grow(&self, most: usize) -> Vec<Spoken> {
        let none = self.solve(&[]).1;
        // A sensor's fault is no force.
        let pushes = |e: &usize| !self.pool.of(*e).place.starts_with("sensor:");
        let mut entries: Vec<usize> = (0..self.pool.entries.len()).filter(pushes).collect();
        let mut beam: Vec<Spoken> = vec![Spoken { members: Vec::new(), change: 0.0, criterion: 0.0 }];
        let mut all: Vec<Spoken> = Vec::new();
        for size in 1..=most {
            let known = |set: &Spoken| set.members.iter().map(|m| m.0).collect::<Vec<usize>>();
            // Each of two effects alone may explain little of what they do together: of pairs all are looked at.
            let grow: Vec<Vec<usize>> = match size {
                2 => entries.iter().map(|e| vec![*e]).collect(),
                _ => beam.iter().map(known).collect(),
            };
            let pairs: Vec<Vec<usize>> = grow
                .iter()
                .enumerate()
                .flat_map(|(n, set)| {
                    let is_new = move |e: &usize| self.pool.is_open(set, *e);
                    let own = if size == 2 { &entries[n + 1..] } else { &entries[..] };
                    own.iter().copied().filter(is_new).map(move |e| [&set[..], &[e]].concat())
                })
                .collect();
            let mut sets: Vec<Spoken> = pairs.par_iter().filter_map(|members| self.spoken(members, none)).collect();
            sets.sort_by(|a, b| a.criterion.total_cmp(&b.criterion));
            if size == 1 {
                entries = sets.iter().map(|s| s.members[0].0).take(TAKING_PART).collect();
            }
            let best = beam.first().map_or(0.0, |b| b.criterion);
            sets.retain(|s| s.criterion < best);
            self.pool.keep_unlike(&mut sets, known);
            sets.truncate(GROWN);
            if sets.is_empty() {
                break;
            }
            all.extend(sets.iter().cloned());
            beam = sets;
        }
        all.sort_by(|a, b| a.criterion.total_cmp(&b.criterion));
        all
    }

    fn spoken(&self, members: &[usize], none: f64) -> Option<Spoken> {
        let (theta, score) = self.solve(members);
        let starts = self.pool.starts(members, theta.as_slice())?;
        let costs = self.pool.price(members, self.count);
        let change = score - none + self.scale.price(&self.pool.columns_of(members), theta.as_slice());
        change.is_finite().then_some(Spoken { members: starts, change, criterion: change + costs })
    }

    /// The numbers of some entries' columns, and −2 log likelihood.
    fn solve(&self, members: &[usize]) -> (DVector<f64>, f64) {
        let columns = self.pool.columns_of(members);
        let w: Vec<DMatrix<f64>> = self.coordinates.iter().map(|c| c.columns.select_columns(&columns)).collect();
        let mut theta = DVector::zeros(columns.len());
        // From afar: what the largest forces say counts at first.
        let all: f64 = self.coordinates.iter().map(|c| c.missing.norm_squared() / c.missing.len().max(1) as f64).sum();
        let mut squares = vec![all; self.coordinates.len()];
        let mut score = f64::INFINITY;
        for step in 0..STEPS {
            let (mut a, mut b) = (DMatrix::zeros(columns.len(), columns.len()), DVector::zeros(columns.len()));
            let rest: Vec<DVector<f64>> =
                self.coordinates.iter().zip(&w).map(|(c, w)| &c.missing - w * &theta).collect();
            for (j, c) in self.coordinates.iter().enumerate() {
                let weight = |s: f64, r: f64| (TAILS + 1.0) / (TAILS + r * r / s);
                if step > 0 {
                    // What the law leaves beyond the smoother's own variance; an interval that nothing shows says nothing of it.
                    let (mut sum, mut count) = (0.0, f64::MIN_POSITIVE);
                    for (r, v) in rest[j].iter().zip(c.variance.iter()) {
                        let s = squares[j] + v;
                        let says = (squares[j] / s).powi(2);
                        sum += says * (weight(s, *r) * r * r - v);
                        count += says;
                    }
                    squares[j] = sum / count;
                }
                squares[j] = squares[j].max(OFF * OFF * all + f64::MIN_POSITIVE);
                for (i, r) in rest[j].iter().enumerate() {
                    let row = w[j].row(i).transpose();
                    let s = squares[j] + c.variance[i];
                    let by = if step == 0 { 1.0 } else { weight(s, *r) } / s;
                    a.ger(by, &row, &row, 1.0);
                    b.axpy(by * c.missing[i], &row, 1.0);
                }
            }
            let likelihood = |(j, rest): (usize, &DVector<f64>)| -> f64 {
                let of = |(r, v): (&f64, &f64)| {
                    let s = squares[j] + v;
                    s.ln() + (TAILS + 1.0) * (1.0 + r * r / (TAILS * s)).ln()
                };
                rest.iter().zip(self.coordinates[j].variance.iter()).map(of).sum()
            };
            score = rest.iter().enumerate().map(likelihood).sum();
            if step + 1 < STEPS {
                theta = pseudo_inverse(&a) * &b;
            }
        }
        (theta, score)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::hypotheses;
    use crate::facts::Facts;
    use crate::identify::track::{Link, Side};
    use crate::select::pool::Entry;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use std::sync::Arc;

    const INTERVALS: usize = 120;
    const SAMPLES: usize = 10;
    const JOINTS: usize = 3;

    /// Viscous friction of three joints, a column each, beside a force on each joint.
    fn pool() -> Pool {
        let hypotheses: Vec<_> =
            hypotheses(&Facts::of_joints(JOINTS)).into_iter().filter(|h| h.name == "joint-viscous-friction").collect();
        let entries = (0..JOINTS).map(|hypothesis| Entry { hypothesis, point: 0, columns: hypothesis..hypothesis + 1 });
        Pool { entries: entries.collect(), hypotheses, variations: Vec::new() }
    }

    /// What is told of a law of size `truth` at the first joint, whose columns are wrong in every tenth interval.
    fn told(truth: f64) -> Vec<Spoken> {
        let mut dice = ChaCha8Rng::seed_from_u64(7);
        let mut draw = || -> f64 { StandardNormal.sample(&mut dice) };
        let (mut links, mut sides, mut forces) = (Vec::new(), Vec::new(), Vec::new());
        for i in 0..INTERVALS {
            let f = DMatrix::from_fn(SAMPLES, JOINTS, |_, _| 1e3 * draw());
            // Friction pushes against the rate: a force of −1 for each unit of it.
            let rates = DVector::from_fn(JOINTS, |_, _| draw());
            let wrong = if i % 10 == 0 { -1.0 } else { 1.0 };
            let mut y = DMatrix::zeros(SAMPLES, JOINTS + 1);
            (0..JOINTS).for_each(|k| y.column_mut(k).copy_from(&(f.column(k) * (-wrong * rates[k]))));
            sides.push(Side { y, d: DMatrix::zeros(1, JOINTS + 1) });
            links.push(Link {
                s: DMatrix::zeros(SAMPLES, 1),
                f,
                a: DMatrix::identity(1, 1),
                b: DMatrix::zeros(1, JOINTS),
            });
            forces.push(DVector::from_fn(JOINTS, |k, _| if k == 0 { -truth * rates[0] } else { 0.0 } + 1e-3 * draw()));
        }
        let variances = vec![DVector::from_element(JOINTS, 1e-6); INTERVALS];
        let start = DVector::from_element(1, 1.0);
        let runs = vec![Linear { run: 0, price: 30.0, links: Arc::new(links), sides, channels: Vec::new(), start }];
        let smoothed = Smoothed { forces, variances, ..Smoothed::default() };
        Regression::new((&pool(), &Scale::default()), (&runs, 0), (&[smoothed], &DVector::from_element(JOINTS, 1.0)))
            .grow(3)
    }

    #[test]
    fn a_law_is_told_though_its_columns_are_wrong_here_and_there() {
        let best = &told(0.7)[0];
        assert_eq!(best.members.iter().map(|m| m.0).collect::<Vec<_>>(), [0]);
        let found = best.members[0].1[0];
        assert!((found - 0.7).abs() < 0.02, "{found}");
    }

    #[test]
    fn nothing_is_told_of_noise_and_of_friction_that_drives() {
        assert!(told(0.0).is_empty());
        assert!(told(-0.7).iter().all(|s| s.members.iter().all(|m| m.0 != 0)));
    }
}
