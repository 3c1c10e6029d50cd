//! Findings that turn out to be nothing.
//!
//! What was worth its price at the steps, the states or in the company of a search may be none within its error once it is fitted to the end: a corner within a
//! step, states that came to rest, a synonym that took its place. Wald's statistic says which (1943), a fit without it decides.

use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::fit::{Effort, Fit, fit, pseudo_inverse};
use crate::hypothesis::{Hypothesis, Scale};
use crate::linear::{Segment, Stage};
use crate::plant::Plant;
use crate::work::Watch;
use nalgebra::{DMatrix, DVector};

/// Wald's statistic, in prices, up to which a fit without a finding is tried.
const WEAK: f64 = 2.0;
/// A fit without one in windows: the others are near.
const EFFORT: Effort = Effort { iterations: 6, share: 1e-5, floor: 0.002, ..Effort::NUMBERS };

/// How far a finding is from nothing, (x − x₀)ᵀ Σ⁻¹ (x − x₀) of the numbers that turn it off; none where none of them does.
fn strength(set: &EffectSet, covariance: &DMatrix<f64>, member: usize) -> Option<f64> {
    let (h, x) = &set.members[member];
    if covariance.nrows() != set.slots().len() {
        return None;
    }
    let own: Vec<(usize, usize)> =
        set.slots().into_iter().enumerate().filter(|(_, (m, _))| *m == member).map(|(i, (_, k))| (i, k)).collect();
    let is_linear = |(_, k): &&(usize, usize)| h.coordinates[*k].scale == Scale::Linear;
    let is_level = |(_, k): &&(usize, usize)| h.coordinates[*k].bounds.contains(&h.coordinates[*k].neutral);
    let linear: Vec<_> = own.iter().filter(is_linear).collect();
    let levels: Vec<_> = linear.iter().copied().filter(is_level).collect();
    // What has no level is off where all of its numbers are; a law that is off at no finite number is none of these.
    let told = if !levels.is_empty() {
        levels
    } else if linear.len() == own.len() {
        linear
    } else {
        return None;
    };
    let off = DVector::from_iterator(told.len(), told.iter().map(|(_, k)| x[*k] - h.coordinates[*k].neutral));
    let spread = DMatrix::from_fn(told.len(), told.len(), |i, j| covariance[(told[i].0, told[j].0)]);
    let strength = off.dot(&(pseudo_inverse(&spread) * &off));
    (!told.is_empty() && strength.is_finite()).then_some(strength)
}

/// Findings that may be nothing, the weakest first; `spread`: variance of what is left, in that of noise.
pub(crate) fn weak(
    set: &EffectSet,
    covariance: &DMatrix<f64>,
    spread: f64,
    price: impl Fn(&Hypothesis) -> f64,
) -> Vec<usize> {
    let is_finding = |m: &usize| !set.members[*m].0.is_tolerated();
    let of = |m: usize| Some((m, strength(set, covariance, m)? / spread));
    let mut all: Vec<(usize, f64)> = (0..set.members.len()).filter(is_finding).filter_map(of).collect();
    all.retain(|(m, strength)| *strength < WEAK * price(&set.members[*m].0));
    all.sort_by(|a, b| a.1.total_cmp(&b.1));
    all.into_iter().map(|(m, _)| m).collect()
}

/// A fit without the findings that it is better without, as long as there are some: `weak` says which may be, `less` what is left without one of them where
/// that is better.
pub(crate) fn without<F>(
    mut found: F,
    weak: impl Fn(&F) -> Vec<usize>,
    less: impl Fn(&F, usize) -> Result<Option<F>, DiagnoseError>,
) -> Result<F, DiagnoseError> {
    while let Some(better) = weak(&found).into_iter().find_map(|member| less(&found, member).transpose()).transpose()? {
        found = better;
    }
    Ok(found)
}

/// Whether a fit is better without a finding, said.
pub(crate) fn is_better_by(costs: f64, gone: &Hypothesis, watch: &dyn Watch) -> bool {
    watch.step(&format!("without {}, which may be nothing: criterion {costs:.1}", gone.title()));
    costs < 0.0
}

/// What was found in windows without what is not worth its price there any more.
pub(crate) fn dropped(stage: &Stage<'_>, plant: &Plant, found: Fit) -> Result<Fit, DiagnoseError> {
    // What is left that is no noise makes errors larger, and the cost of all that is fitted.
    let spread = |found: &Fit| found.rms().powi(2).max(1.0);
    let price = |found: &Fit, h: &Hypothesis| {
        (h.coordinates.len() - h.held.len()) as f64 * (found.count as f64).ln() + h.burden()
    };
    let less = |found: &Fit, member: usize| {
        let segments = found.segments.iter().map(|s| Segment { columns: None, ..s.clone() }).collect();
        let less = fit(stage, plant, found.set.without(member), segments, EFFORT)?;
        let h = &found.set.members[member].0;
        let costs = (less.cost - found.cost) / spread(found) - price(found, h);
        Ok(is_better_by(costs, h, stage.work.watch).then_some(less))
    };
    without(found, |found| weak(&found.set, &found.covariance, spread(found), |h| price(found, h)), less)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::hypotheses;
    use crate::facts::Facts;

    /// A viscous friction of four standard errors, and one of a half.
    #[test]
    fn a_number_within_its_error_may_be_nothing_and_one_far_beyond_is_something() {
        let all = hypotheses(&Facts::of_joints(1));
        let of = |name: &str| all.iter().find(|h| h.name == name).expect("it is in the library");
        let set = EffectSet::default().with(of("joint-viscous-friction"), &[0.04]);
        let known = |sigma: f64| DMatrix::from_element(1, 1, sigma * sigma);
        assert!((strength(&set, &known(0.01), 0).expect("it has a level") - 16.0).abs() < 1e-9);
        let price = |_: &Hypothesis| 5.0;
        assert!(weak(&set, &known(0.01), 1.0, price).is_empty());
        assert_eq!(weak(&set, &known(0.08), 1.0, price), [0]);
        assert_eq!(weak(&set, &known(0.01), 4.0, price), [0], "what is left is no noise: errors are twice as large");
        assert_eq!(strength(&set, &DMatrix::zeros(0, 0), 0), None, "nothing is known of its error");
    }
}
