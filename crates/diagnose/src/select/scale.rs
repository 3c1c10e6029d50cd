//! What a change of inertia, or of how a sensor reads, does to the scale of missing forces.
//!
//! A linear model holds the readings for ρ = r + F f + Y θ with F as it is. Where a number makes bodies lighter the same motion needs smaller forces, so that
//! unknown ones seem to be explained: in the limit nothing moves nothing. The density of the readings says what that costs. A force f that a motion a
//! asks for, f = M(θ) a + …, has p(a) = p(f) |∂f/∂a|, so that −2 log p has, beside what the forces make of it,
//!
//!   −2 Σᵢ ln (‖∂a/∂f‖ₒ / ‖∂a/∂f‖θ)
//!
//! over the intervals i in which the readings say what f is. M is linear in θ. Only the price is taken, no reward for what is heavier. A sensor that
//! reads twice what there is has the same cost: half the motion is what it tells of. There ∂r/∂f, which is linear in θ, stands for ∂a/∂f, with all
//! that is read beside it.

use super::pool::Pool;
use crate::identify::chain::Smoothed;
use crate::identify::fit::{Fitted, Problem};
use crate::identify::marginal::Spread;
use crate::linear::Variation;
use crate::plant::Built;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// What scales unknown forces at a few states, and how columns change it.
#[derive(Clone, Debug, Default)]
pub struct Scale {
    /// M at each state, in the coordinates of rates and forces.
    inertia: Table,
    /// What is read of forces in an interval from each state, ∂r/∂f.
    readings: Table,
    /// By force: intervals in which it is known.
    known: DVector<f64>,
}

/// Matrices at each state, and their derivatives by every column: none where it changes nothing.
#[derive(Clone, Debug, Default)]
struct Table {
    own: Vec<DMatrix<f64>>,
    by_column: Vec<Option<Vec<DMatrix<f64>>>>,
}

impl Table {
    /// Of some models and the matrix of a model at a state; nothing where one of them has none.
    fn new(
        (built, variations): (&Built, &[Option<&Variation>]),
        states: usize,
        matrix: &(dyn Fn(&Built, usize) -> Option<DMatrix<f64>> + Sync),
    ) -> Self {
        let own: Option<Vec<DMatrix<f64>>> = (0..states).map(|k| matrix(built, k)).collect();
        let Some(own) = own.filter(|m| !m.is_empty()) else { return Self::default() };
        let column = |v: &Option<&Variation>| {
            let v = (*v)?;
            let change = |k: usize| matrix(&v.built, k).map(|m| (m - &own[k]) / v.step);
            let first = change(0)?;
            let is_any = first.amax() * v.step > LEAST * own[0].amax();
            is_any.then(|| std::iter::once(Some(first)).chain((1..states).map(change)).collect())?
        };
        let by_column = variations.par_iter().map(column).collect();
        Self { own, by_column }
    }

    /// Every matrix with some columns at some amplitudes; nothing where none of these changes anything.
    fn changed(&self, columns: &[usize], amplitudes: &[f64]) -> Vec<[DMatrix<f64>; 2]> {
        let moving: Vec<_> =
            columns.iter().zip(amplitudes).filter_map(|(c, a)| Some((self.by_column.get(*c)?.as_ref()?, *a))).collect();
        if moving.is_empty() {
            return Vec::new();
        }
        let changed =
            |(k, own): (usize, &DMatrix<f64>)| moving.iter().fold(own.clone(), |sum, (m, a)| sum + &m[k] * *a);
        self.own.iter().enumerate().map(|(k, own)| [own.clone(), changed((k, own))]).collect()
    }
}

/// States at which inertia is looked at.
const STATES: usize = 6;
/// Share by which a column has to change it.
const LEAST: f64 = 1e-6;

impl Scale {
    /// Of a pool beside a fit, with the forces of its runs and their prior standard deviations.
    pub fn new(problem: &Problem<'_>, fit: &Fitted, pool: &Pool, smoothed: &[Smoothed], spread: &Spread) -> Self {
        let all: Vec<(usize, usize)> = fit
            .tracks
            .iter()
            .enumerate()
            .flat_map(|(t, track)| (0..track.intervals.len()).map(move |i| (t, i)))
            .collect();
        let every = all.len().div_ceil(STATES).max(1);
        let states: Vec<(usize, usize)> = all.iter().copied().skip(every / 2).step_by(every).collect();
        let frame = problem.frame(fit);
        let inertia_of = |built: &Built, k: usize| {
            let (t, i) = states[k];
            let track = &fit.tracks[t];
            frame.answer(built, track.run, &track.intervals[i]).filter(DMatrix::is_square)?.try_inverse()
        };
        let read = |built: &Built, k: usize| {
            let (t, i) = states[k];
            frame.read_of_forces(built, fit.tracks[t].run, &fit.tracks[t].intervals[i])
        };
        let is_reading: Vec<bool> = pool
            .entries
            .iter()
            .flat_map(|e| e.columns.clone().map(|_| pool.hypotheses[e.hypothesis].is_reading()))
            .collect();
        let of_kind = |reading: bool| -> Vec<Option<&Variation>> {
            pool.variations.iter().zip(&is_reading).map(|(v, r)| (*r == reading).then_some(v)).collect()
        };
        let inertia = Table::new((&fit.built, &of_kind(false)), states.len(), &inertia_of);
        let readings = Table::new((&fit.built, &of_kind(true)), states.len(), &read);
        let mut known = DVector::zeros(spread.force.len());
        for (run, smoothed) in smoothed.iter().enumerate() {
            let [_, prior] = spread.by_interval(run, smoothed.variances.len());
            for (variance, prior) in smoothed.variances.iter().zip(&prior) {
                known += variance.zip_map(prior, |v, q| if q > 0.0 { (1.0 - v / (q * q)).max(0.0) } else { 0.0 });
            }
        }
        Self { inertia, readings, known }
    }

    /// Intervals in which a force is known, of all forces.
    pub fn known(&self) -> f64 {
        self.known.sum()
    }

    /// The price of some columns at some amplitudes; infinite where nothing is left to be moved.
    pub fn price(&self, columns: &[usize], amplitudes: &[f64]) -> f64 {
        let inertia = self.inertia.changed(columns, amplitudes).into_iter();
        let answers: Option<Vec<_>> =
            inertia.map(|[before, after]| Some([before.try_inverse()?, after.try_inverse()?])).collect();
        let Some(answers) = answers else { return f64::INFINITY };
        [answers, self.readings.changed(columns, amplitudes)].iter().map(|of| self.price_of(of)).sum::<f64>().max(0.0)
    }

    /// The price where forces have these effects before and after, a column each.
    fn price_of(&self, effects: &[[DMatrix<f64>; 2]]) -> f64 {
        let mut price = 0.0;
        for [before, after] in effects {
            for (j, known) in self.known.iter().enumerate() {
                let [a, b] = [before, after].map(|m| m.column(j).norm());
                if *known > 0.0 && a > 0.0 {
                    price += 2.0 * known * (b / a).ln();
                }
            }
        }
        price / effects.len().max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One joint of inertia 2 whose force is known in 50 intervals; the first column is its inertia, the second one moves nothing, the third scales what
    /// is read of it.
    fn scale() -> Scale {
        let one = |x| vec![DMatrix::from_element(1, 1, x)];
        Scale {
            inertia: Table { own: one(2.0), by_column: vec![Some(one(1.0)), None, None] },
            readings: Table { own: one(3.0), by_column: vec![None, None, Some(one(3.0))] },
            known: DVector::from_element(1, 50.0),
        }
    }

    #[test]
    fn what_reads_more_pays_for_the_scale_of_what_it_tells_of() {
        let expected = 2.0 * 50.0 * 2f64.ln();
        assert!((scale().price(&[2], &[1.0]) - expected).abs() < 1e-9);
        assert_eq!(scale().price(&[2], &[-0.5]), 0.0, "less costs nothing");
        assert!(scale().price(&[0, 2], &[2.0, 1.0]) < 1e-9, "twice the inertia, read twice as large");
    }

    #[test]
    fn what_is_lighter_pays_for_the_scale_of_its_forces() {
        // Half the inertia: twice the motion by every force.
        let expected = 2.0 * 50.0 * 2f64.ln();
        assert!((scale().price(&[0], &[-1.0]) - expected).abs() < 1e-9);
        assert!(scale().price(&[0], &[-2.0]).is_infinite(), "nothing is left to be moved");
    }

    #[test]
    fn what_is_heavier_and_what_moves_nothing_pay_nothing() {
        assert_eq!(scale().price(&[0], &[1.0]), 0.0);
        assert_eq!(scale().price(&[1], &[5.0]), 0.0);
        assert_eq!(Scale::default().price(&[0], &[-1.0]), 0.0);
    }
}
