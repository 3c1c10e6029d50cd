//! What a change of inertia does to the scale of missing forces.
//!
//! A linear model holds the readings for ρ = r + F f + Y θ with F as it is. Where a number makes bodies lighter the same motion needs smaller forces, so that
//! unknown ones seem to be explained: in the limit nothing moves nothing. The density of the readings says what that costs. A force f that a motion a
//! asks for, f = M(θ) a + …, has p(a) = p(f) |∂f/∂a|, so that −2 log p has, beside what the forces make of it,
//!
//!   −2 Σᵢ ln (‖∂a/∂f‖ₒ / ‖∂a/∂f‖θ)
//!
//! over the intervals i in which the readings say what f is. M is linear in θ. Only the price is taken, no reward for what is heavier.

use super::pool::Pool;
use crate::identify::chain::Smoothed;
use crate::identify::fit::{Fitted, Problem};
use crate::identify::marginal::Spread;
use crate::plant::Built;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Inertia against unknown forces at a few states, and how columns change it.
#[derive(Clone, Debug, Default)]
pub struct Scale {
    /// M at each state, in the coordinates of rates and forces.
    inertia: Vec<DMatrix<f64>>,
    /// ∂M/∂θ of every column, at each state; none where it changes nothing.
    columns: Vec<Option<Vec<DMatrix<f64>>>>,
    /// By force: intervals in which it is known.
    known: DVector<f64>,
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
        let inertia_of = |built: &Built, (t, i): &(usize, usize)| {
            let track = &fit.tracks[*t];
            frame.answer(built, track.run, &track.intervals[*i]).filter(DMatrix::is_square)?.try_inverse()
        };
        let inertia: Option<Vec<DMatrix<f64>>> = states.iter().map(|s| inertia_of(&fit.built, s)).collect();
        let Some(inertia) = inertia.filter(|m| !m.is_empty()) else { return Self::default() };
        let column = |v: &crate::linear::Variation| {
            let change = |k: usize| inertia_of(&v.built, &states[k]).map(|m| (m - &inertia[k]) / v.step);
            let first = change(0)?;
            let is_any = first.amax() * v.step > LEAST * inertia[0].amax();
            is_any.then(|| std::iter::once(Some(first)).chain((1..states.len()).map(change)).collect())?
        };
        let columns = pool.variations.par_iter().map(column).collect();
        let mut known = DVector::zeros(spread.force.len());
        for (run, smoothed) in smoothed.iter().enumerate() {
            let [_, prior] = spread.by_interval(run, smoothed.variances.len());
            for (variance, prior) in smoothed.variances.iter().zip(&prior) {
                known += variance.zip_map(prior, |v, q| if q > 0.0 { (1.0 - v / (q * q)).max(0.0) } else { 0.0 });
            }
        }
        Self { inertia, columns, known }
    }

    /// The price of some columns at some amplitudes; infinite where nothing is left to be moved.
    pub fn price(&self, columns: &[usize], amplitudes: &[f64]) -> f64 {
        let moving: Vec<(&Vec<DMatrix<f64>>, f64)> = columns
            .iter()
            .zip(amplitudes)
            .filter_map(|(c, a)| self.columns.get(*c)?.as_ref().map(|m| (m, *a)))
            .collect();
        if moving.is_empty() {
            return 0.0;
        }
        let mut price = 0.0;
        for (k, inertia) in self.inertia.iter().enumerate() {
            let changed = moving.iter().fold(inertia.clone(), |sum, (m, a)| sum + &m[k] * *a);
            let (Some(before), Some(after)) = (inertia.clone().try_inverse(), changed.try_inverse()) else {
                return f64::INFINITY;
            };
            for (j, known) in self.known.iter().enumerate() {
                let [a, b] = [&before, &after].map(|m| m.column(j).norm());
                price += 2.0 * known * (b / a).ln();
            }
        }
        (price / self.inertia.len() as f64).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One joint of inertia 2 whose force is known in 50 intervals; the first column is its inertia, the second one moves nothing.
    fn scale() -> Scale {
        Scale {
            inertia: vec![DMatrix::from_element(1, 1, 2.0)],
            columns: vec![Some(vec![DMatrix::from_element(1, 1, 1.0)]), None],
            known: DVector::from_element(1, 50.0),
        }
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
