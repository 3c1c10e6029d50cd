//! Steps of a set's numbers: of a fit, and of difference quotients.

use super::marginal::Estimate;
use crate::effect_set::EffectSet;
use crate::fit::pseudo_inverse;
use crate::hypothesis::Scale;
use nalgebra::{DMatrix, DVector};

/// A step of some numbers of which none leaves its bounds: the least of ½ (θ − f)ᵀ C⁻¹ (θ − f) in the room that each has, f the free step and C its
/// covariance (dual active set: Goldfarb and Idnani 1983). Only of numbers within tolerances: a law's own shape bends so much on its way to a bound (how far
/// a bristle yields) that what the others make of that is worth nothing.
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

/// A number that stops at a bound, on which side, and what holds it there.
struct Stopped {
    number: usize,
    /// 1 where it may not go lower, −1 where it may not go higher.
    side: f64,
    hold: f64,
}

/// The same with the room that each number has below and above it.
///
/// From the free step, whose bounds are broken and whose holds are none, one bound after the other is met; on the way a hold that comes to nothing is let go.
fn stopped_at(room: &[[f64; 2]], free: &DVector<f64>, c: &DMatrix<f64>) -> DVector<f64> {
    let mut stopped: Vec<Stopped> = Vec::new();
    let at = |stopped: &[Stopped]| {
        stopped.iter().fold(free.clone(), |theta, s| theta + c.column(s.number) * (s.side * s.hold))
    };
    for _ in 0..ROUNDS * room.len() {
        let theta = at(&stopped);
        let beyond = |i: usize| (room[i][0] - theta[i], theta[i] - room[i][1]);
        let far = |i: &usize| beyond(*i).0.max(beyond(*i).1) / c[(*i, *i)].max(0.0).sqrt();
        let is_open = |i: &usize| stopped.iter().all(|s| s.number != *i) && c[(*i, *i)] > 0.0 && far(i) > ROUNDING;
        let Some(next) = (0..room.len()).filter(is_open).max_by(|i, j| far(i).total_cmp(&far(j))) else { break };
        let (low, high) = beyond(next);
        meet(
            &mut stopped,
            Stopped { number: next, side: if low > high { 1.0 } else { -1.0 }, hold: 0.0 },
            low.max(high),
            c,
        );
    }
    let mut theta = at(&stopped);
    (0..room.len()).for_each(|i| theta[i] = theta[i].clamp(room[i][0].min(0.0), room[i][1].max(0.0)));
    theta
}

/// Holds one more number until it is back within its bound, which it is `beyond`.
fn meet(stopped: &mut Vec<Stopped>, mut next: Stopped, mut beyond: f64, c: &DMatrix<f64>) {
    loop {
        let n = stopped.len();
        let own = DMatrix::from_fn(n, n, |i, j| {
            stopped[i].side * stopped[j].side * c[(stopped[i].number, stopped[j].number)]
        });
        let with = DVector::from_fn(n, |i, _| stopped[i].side * next.side * c[(stopped[i].number, next.number)]);
        let eases = pseudo_inverse(&own) * &with;
        let yields = c[(next.number, next.number)] - with.dot(&eases);
        let whole = if yields > ROUNDING * c[(next.number, next.number)] { beyond / yields } else { f64::INFINITY };
        let spent = (0..n).filter(|i| eases[*i] > 0.0).map(|i| (i, stopped[i].hold / eases[i]));
        let first = spent.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, hold)| *hold < whole);
        let hold = first.map_or(whole, |(_, hold)| hold);
        if hold.is_infinite() {
            return;
        }
        stopped.iter_mut().zip(eases.iter()).for_each(|(s, ease)| s.hold -= hold * ease);
        next.hold += hold;
        beyond -= hold * yields;
        let Some((gone, _)) = first else { break };
        stopped.remove(gone);
    }
    stopped.push(next);
}

/// Bounds that may be met for each number, and a standard deviation's share that is none.
const ROUNDS: usize = 4;
const ROUNDING: f64 = 1e-9;

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
        let near = |theta: DVector<f64>, other: [f64; 2]| {
            assert!((theta - DVector::from_row_slice(&other)).norm() < 1e-9, "{other:?}");
        };
        near(stopped_at(&[[-0.5, 9.0], [1.0, 9.0]], &free, &c), [-0.5, 1.0]);
        near(stopped_at(&[[-0.5, 9.0], [-9.0, 0.2]], &free, &c), [-0.5, 0.2]);
    }

    #[test]
    fn what_another_bound_holds_back_already_is_let_go() {
        // Both leave their rooms at first; with the worse one at its bound the other is within.
        let c = DMatrix::from_row_slice(2, 2, &[1.0, 0.9, 0.9, 1.0]);
        let free = DVector::from_row_slice(&[3.0, 2.0]);
        let theta = stopped_at(&[[-1.0, 1.0], [-1.0, 1.0]], &free, &c);
        assert!((theta[0] - 1.0).abs() < 1e-9 && (theta[1] - 0.2).abs() < 1e-9, "{theta}");
        // Each pass over the box at its corners and along its edges costs no less.
        let h = pseudo_inverse(&c);
        let cost = |x: f64, y: f64| {
            let off = DVector::from_row_slice(&[x, y]) - &free;
            (off.transpose() * &h * &off)[(0, 0)]
        };
        let least = cost(theta[0], theta[1]);
        for i in 0..=20 {
            let x = -1.0 + 0.1 * f64::from(i);
            assert!((0..=20).all(|j| cost(x, -1.0 + 0.1 * f64::from(j)) > least - 1e-9), "{x}");
        }
    }
}
