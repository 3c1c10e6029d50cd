//! How sure the numbers of a fitted set are.
//!
//! The inverse of A, the curvature of the cost, is too sure where slip and impact make the cost ragged and where what is left is not
//! white. Further looks widen it, the largest of the first three counts:
//!
//! - scatter: (A⁻¹ M A⁻¹)ᵢᵢ with M the scatter of the segments' gradients about their mean (the sandwich of White 1982);
//! - profile: how far one number must go, the others along with it and every start settled anew, for the cost to rise by 4, the
//!   point two standard errors out;
//! - way: what derivatives still promise where no step brings it, −A⁻¹ Gᵀr, added as a variance;
//! - step: what ever shorter steps would move the numbers by, twice what those of half the length do (first order), −2 A⁻¹ G⊥ᵀ(r_half − r), added as a variance.

use crate::bias::Halved;
use crate::error::DiagnoseError;
use crate::fit::{Fit, pseudo_inverse};
use crate::linear::{Segment, SegmentLinear, Stage};
use crate::plant::Plant;
use nalgebra::{DMatrix, DVector};

/// Errors of a set's fitted numbers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Uncertainty {
    /// Covariance of the fitted numbers.
    pub covariance: DMatrix<f64>,
    /// By number: whether its error is that of the profile.
    pub from_profile: Vec<bool>,
    /// Growth of the cost where each run is predicted with numbers that the others alone would give (to first order; one held back at a time).
    pub optimism: f64,
}

/// Rise of the cost two standard errors from its valley.
const TWO_SIGMA: f64 = 4.0;
/// Distances at which the profile is taken, standard errors of the curvature.
const DISTANCES: [f64; 4] = [2.0, 8.0, 32.0, 128.0];
/// Growth of an error by the profile below which the curvature has told the same.
const SAME: f64 = 1.1;
/// What ever shorter steps move, in what halved ones do, where errors are in proportion to them.
const TO_THE_END: f64 = 2.0;
/// Segments that a scatter wants at least.
const SCATTERED: usize = 3;

/// Estimates them about a converged fit.
pub(crate) fn estimate(stage: &Stage<'_>, plant: &Plant, found: &Fit) -> Result<Uncertainty, DiagnoseError> {
    let slots = found.set.slots();
    let n = slots.len();
    if n == 0 {
        return Ok(Uncertainty::default());
    }
    let Halved { linear, curvature: a, inverse, shift, .. } = Halved::new(stage, plant, found)?;
    let gradients: Vec<DVector<f64>> =
        linear.iter().map(|l| l.reduced.view((0, n + 1), (n, 1)).column(0).into()).collect();
    let scatter = calc_scatter(&inverse, &gradients);
    let way = &inverse * gradients.iter().sum::<DVector<f64>>();
    let mut widths = DVector::zeros(n);
    let mut from_profile = vec![false; n];
    for i in 0..n {
        // What only moves within its tolerance is no finding whose error is told.
        if found.set.members[slots[i].0].0.is_tolerated() {
            widths[i] = inverse[(i, i)].max(0.0);
            continue;
        }
        let curvature = inverse[(i, i)].max(0.0).sqrt();
        let profile = calc_profile(stage, plant, (found, &linear), (&inverse, i));
        from_profile[i] = profile > SAME * curvature && profile.powi(2) >= scatter[i];
        widths[i] =
            curvature.powi(2).max(scatter[i]).max(profile.powi(2)) + (TO_THE_END * shift[i]).powi(2) + way[i].powi(2);
    }
    let growth = |i: usize| if inverse[(i, i)] > 0.0 { (widths[i] / inverse[(i, i)]).sqrt() } else { 1.0 };
    let covariance = DMatrix::from_fn(n, n, |i, j| growth(i) * growth(j) * inverse[(i, j)]);
    let optimism = calc_optimism(&a, &linear, &found.segments);
    Ok(Uncertainty { covariance, from_profile, optimism })
}

/// Diagonal of A⁻¹ M A⁻¹; zeros where there are too few segments to scatter.
fn calc_scatter(inverse: &DMatrix<f64>, gradients: &[DVector<f64>]) -> Vec<f64> {
    let (n, count) = (inverse.nrows(), gradients.len() as f64);
    if gradients.len() < SCATTERED {
        return vec![0.0; n];
    }
    let mean = gradients.iter().sum::<DVector<f64>>() / count;
    let scatter: DMatrix<f64> = gradients.iter().map(|g| (g - &mean) * (g - &mean).transpose()).sum();
    let sandwich = inverse * scatter * inverse * (count / (count - 1.0));
    sandwich.diagonal().iter().copied().collect()
}

/// Standard error of one number by the profile: half the way to where the cost has risen by 4, mean of both sides.
fn calc_profile(
    stage: &Stage<'_>,
    plant: &Plant,
    (found, linear): (&Fit, &[SegmentLinear]),
    (inverse, i): (&DMatrix<f64>, usize),
) -> f64 {
    let slots = found.set.slots();
    let sigma = inverse[(i, i)].max(0.0).sqrt();
    if sigma == 0.0 {
        return 0.0;
    }
    let rise = |distance: f64| -> Option<f64> {
        let theta: Vec<f64> = inverse.column(i).iter().map(|c| distance * c / sigma).collect();
        let set = found.set.moved(&slots, &theta);
        let actual: Vec<f64> = slots.iter().map(|(m, c)| set.members[*m].1[*c] - found.set.members[*m].1[*c]).collect();
        let built = plant.build(&set.effects()).ok()?;
        let (_, cost) = stage.follow(&built, &found.segments, linear, &actual);
        cost.is_finite().then_some(cost - found.cost)
    };
    let side = |sign: f64| {
        let mut reached: f64 = 0.0;
        for distance in DISTANCES {
            match rise(sign * distance) {
                Some(rise) if rise < TWO_SIGMA => reached = distance,
                // As a parabola from there.
                Some(rise) => return (distance * (TWO_SIGMA / rise).sqrt()).max(reached),
                None => return reached,
            }
        }
        reached
    };
    0.25 * sigma * (side(1.0) + side(-1.0))
}

/// Growth of the cost where each run is predicted with numbers fitted to the others: Σ 2 bᵀδ + δᵀAδ with δ = (A − A_run)⁻¹ b_run.
fn calc_optimism(a: &DMatrix<f64>, linear: &[SegmentLinear], segments: &[Segment]) -> f64 {
    let n = a.nrows();
    let mut runs: Vec<usize> = segments.iter().map(|s| s.run).collect();
    runs.dedup();
    let of_run = |run: &usize| {
        let own = || linear.iter().zip(segments).filter(|(_, s)| s.run == *run).map(|(l, _)| &l.reduced);
        let own_a: DMatrix<f64> = own().map(|k| k.view((0, 0), (n, n)).into_owned()).sum();
        let own_b: DVector<f64> = own().map(|k| DVector::from(k.view((0, n + 1), (n, 1)).column(0))).sum();
        // Without this run the gradient is −b_run.
        let delta = pseudo_inverse(&(a - &own_a)) * &own_b;
        2.0 * own_b.dot(&delta) + (delta.transpose() * &own_a * &delta)[(0, 0)]
    };
    if runs.len() < 2 { f64::NAN } else { runs.iter().map(of_run).sum() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scatter_of_white_gradients_is_the_curvature() {
        // Gradients of variance A/J each: A⁻¹ M A⁻¹ = A⁻¹.
        let inverse = DMatrix::from_element(1, 1, 0.25);
        let gradients: Vec<DVector<f64>> = [1.0, -1.0, 1.0, -1.0].map(|g| DVector::from_element(1, g)).to_vec();
        assert!((calc_scatter(&inverse, &gradients)[0] - 0.25 * 0.25 * 4.0 * 4.0 / 3.0).abs() < 1e-12);
        assert_eq!(calc_scatter(&inverse, &gradients[..2]), [0.0]);
    }
}
