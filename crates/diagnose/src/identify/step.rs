//! Steps of a set's numbers: of a fit, and of difference quotients.

use super::marginal::Estimate;
use crate::effect_set::EffectSet;
use crate::fit::pseudo_inverse;
use crate::hypothesis::Scale;
use nalgebra::{DMatrix, DVector};

/// A step of some numbers of which none leaves its bounds: those that would stop there, and the others go where that is best, by the step's covariance C:
///
///   θ_f ← θ_f + C_fb C_bb⁻¹ (t − θ_b)
///
/// for those b that stop at t (active set: Nocedal and Wright 2006, ch. 16.5, one way). Only of numbers within tolerances: a law's own shape bends so much on its
/// way to a bound (how far a bristle yields) that what the others make of that is worth nothing.
pub(super) fn within_bounds(set: &EffectSet, slots: &[(usize, usize)], found: &Estimate) -> DVector<f64> {
    let room: Vec<[f64; 2]> = slots
        .iter()
        .map(|(m, k)| {
            let (h, x) = &set.members[*m];
            let bounds = if h.is_tolerated() { h.coordinates[*k].bounds } else { [f64::NEG_INFINITY, f64::INFINITY] };
            bounds.map(|bound| bound - x[*k])
        })
        .collect();
    stopped_at(&room, &found.theta, &found.covariance)
}

/// The same with the room that each number has below and above it.
fn stopped_at(room: &[[f64; 2]], free: &DVector<f64>, c: &DMatrix<f64>) -> DVector<f64> {
    let (mut theta, mut stopped) = (free.clone(), Vec::<(usize, f64)>::new());
    loop {
        let leaves =
            |i: &usize| stopped.iter().all(|(of, _)| of != i) && (theta[*i] < room[*i][0] || theta[*i] > room[*i][1]);
        let leaving: Vec<usize> = (0..room.len()).filter(leaves).collect();
        if leaving.is_empty() {
            return theta;
        }
        stopped.extend(leaving.into_iter().map(|i| (i, theta[i].clamp(room[i][0], room[i][1]))));
        let n = stopped.len();
        let own = DMatrix::from_fn(n, n, |i, j| c[(stopped[i].0, stopped[j].0)]);
        let off = DVector::from_fn(n, |i, _| stopped[i].1 - free[stopped[i].0]);
        let pull = pseudo_inverse(&own) * &off;
        theta = DVector::from_fn(free.len(), |i, _| {
            free[i] + stopped.iter().zip(pull.iter()).map(|((of, _), pull)| c[(i, *of)] * pull).sum::<f64>()
        });
        stopped.iter().for_each(|(of, at)| theta[*of] = *at);
    }
}

/// Steps of the difference quotients: what moves the fit by a fraction of one standard error.
pub(super) fn next_sizes(set: &EffectSet, slots: &[(usize, usize)], covariance: &DMatrix<f64>) -> Vec<f64> {
    let size = |(i, (m, k)): (usize, &(usize, usize))| {
        let (h, x) = &set.members[*m];
        let floor = if h.coordinates[*k].scale == Scale::Log { FLOOR } else { FLOOR * x[*k].abs() };
        covariance[(i, i)].max(0.0).sqrt().min(WIDEST * x[*k].abs().max(1.0)).max(floor).max(f64::MIN_POSITIVE.sqrt())
    };
    slots.iter().enumerate().map(size).collect()
}

/// Smallest step of a difference quotient, relative.
const FLOOR: f64 = 1e-6;
/// Largest, relative to the number or to one.
const WIDEST: f64 = 0.01;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stops_at_a_bound_leaves_the_others_where_that_is_best() {
        // ½ θᵀ A θ + bᵀ θ: free minimum at −C b, and with θ₀ held at t at θ₁ = −(b₁ + A₁₀ t)/A₁₁.
        let a = DMatrix::from_row_slice(2, 2, &[2.0, 1.5, 1.5, 2.0]);
        let b = DVector::from_row_slice(&[1.0, -1.0]);
        let c = pseudo_inverse(&a);
        let free = -(&c * &b);
        assert!(free[0] < -1.0 && free[1] > 1.0, "{free}");
        let wide = [[-9.0, 9.0]; 2];
        assert_eq!(stopped_at(&wide, &free, &c), free);
        let theta = stopped_at(&[[-0.5, 9.0], [-9.0, 9.0]], &free, &c);
        let best = -(b[1] + a[(1, 0)] * -0.5) / a[(1, 1)];
        assert!((theta[0] + 0.5).abs() < 1e-12 && (theta[1] - best).abs() < 1e-9, "{theta} {best}");
        // What would leave its room for another one's sake stops as well, where that ends.
        assert_eq!(stopped_at(&[[-0.5, 9.0], [1.0, 9.0]], &free, &c).as_slice(), [-0.5, 1.0]);
        assert_eq!(stopped_at(&[[-0.5, 9.0], [-9.0, 0.2]], &free, &c).as_slice(), [-0.5, 0.2]);
    }
}
