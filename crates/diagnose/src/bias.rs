//! What the length of steps does to numbers: steps are as long as what was found bears.
//!
//! Over whole runs a halved step moves readings by more than noise long before it moves what is fitted to them: starts follow. With Δr what halving moves,
//! starts eliminated,
//!
//!   δθ = −A⁻¹ G⊥ᵀ Δr,      ‖Δr⊥‖² = ‖Δr‖² − δθᵀ A δθ
//!
//! are what it moves numbers by, and what nothing follows.

use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::fit::{Fit, pseudo_inverse};
use crate::hypothesis::Scale;
use crate::linear::{Segment, SegmentLinear, Stage, Variation, eliminate};
use crate::pace::{self, Discretisation};
use crate::plant::Plant;
use crate::screen::vary_active;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Halvings that numbers may ask for.
const HALVINGS: usize = 3;
/// Part of a number that steps may move it by whatever its standard error is: its interval is widened by as much.
const EXACT: f64 = 1e-3;
/// Standard deviations of the cost under noise alone that what nothing follows may add to it.
const UNSEEN: f64 = 1.0;

/// Products of a fit's segments about where it stands: of the numbers' columns, of what halved steps move, and of the residual.
pub(crate) struct Halved {
    /// Segment by segment, starts eliminated.
    pub linear: Vec<SegmentLinear>,
    /// Curvature of the cost by the numbers, priors with it.
    pub curvature: DMatrix<f64>,
    /// Its inverse.
    pub inverse: DMatrix<f64>,
    /// What halved steps move the numbers by.
    pub shift: DVector<f64>,
    /// Squared norm of what they move and nothing follows, variances of noise.
    pub left: f64,
}

impl Halved {
    /// About a fit at the stage's pace.
    pub fn new(stage: &Stage<'_>, plant: &Plant, found: &Fit) -> Result<Self, DiagnoseError> {
        let n = found.set.slots().len();
        let variations = vary_active(plant, found)?;
        let of = |s: &Segment| linearised(stage, found, s, &variations);
        let linear: Vec<SegmentLinear> = found.segments.par_iter().map(of).collect();
        let mut prior = DMatrix::zeros(n + 1, n + 1);
        found.set.add_prior(&mut prior);
        let own = |l: &SegmentLinear| l.reduced.view((0, 0), (n, n)).into_owned();
        let curvature = linear.iter().map(own).fold(prior.view((0, 0), (n, n)).into_owned(), |sum, own| sum + own);
        let inverse = pseudo_inverse(&curvature);
        let slope: DVector<f64> = linear.iter().map(|l| DVector::from(l.reduced.view((0, n), (n, 1)).column(0))).sum();
        let shift = -(&inverse * &slope);
        let moved: f64 = linear.iter().map(|l| l.reduced[(n, n)]).sum();
        let left = (moved + slope.dot(&shift)).max(0.0);
        Ok(Self { linear, curvature, inverse, shift, left })
    }

    /// Whether numbers and cost are what they are for other reasons than the length of the steps.
    fn is_fine(&self, found: &Fit) -> bool {
        let is_told = |(i, (m, k)): (usize, (usize, usize))| {
            let sigma = self.inverse[(i, i)].max(0.0).sqrt();
            self.shift[i].abs() <= sigma.max(EXACT * size_of(&found.set, (m, k)))
        };
        self.left <= UNSEEN * found.spread() && found.set.slots().into_iter().enumerate().all(is_told)
    }
}

/// Size of a number in its coordinate's own unit.
fn size_of(set: &EffectSet, (m, k): (usize, usize)) -> f64 {
    let (h, x) = &set.members[m];
    if h.coordinates[k].scale == Scale::Log { 1.0 } else { x[k].abs() }
}

/// Products of one segment.
fn linearised(stage: &Stage<'_>, found: &Fit, segment: &Segment, variations: &[Variation]) -> SegmentLinear {
    let r = stage.residuals(&found.built, segment);
    let (coarse, base) = stage.beside(&found.built, segment, &r);
    let start = coarse.columns_of(&found.built, segment, &base);
    let finer = Stage { pace: pace::half(stage.pace), ..*stage };
    let moved = finer.residuals(&found.built, segment) - &r;
    let moved = if moved.iter().all(|x| x.is_finite()) { moved } else { DVector::zeros(r.len()) };
    let columns = coarse.columns_by(segment, &base, variations, true);
    let starts: Vec<&DVector<f64>> = start.columns.iter().collect();
    let others: Vec<&DVector<f64>> = columns.iter().chain([&moved, &r]).collect();
    SegmentLinear { columns: Some(start.clone()), ..eliminate(&starts, &others, &start.freedoms) }
}

/// Steps that suit a corrected model, said: halved, from those of the search, until that moves its numbers by no more than they are sure, or by next to nothing.
pub(crate) fn suited(stage: &Stage<'_>, plant: &Plant, found: &Fit) -> Result<Discretisation, DiagnoseError> {
    let mut stage = *stage;
    let mut halved = Halved::new(&stage, plant, found)?;
    for _ in 0..HALVINGS {
        if halved.is_fine(found) {
            break;
        }
        stage.pace = pace::half(stage.pace);
        halved = Halved::new(&stage, plant, found)?;
    }
    let suited = Discretisation { pace: stage.pace, worst: (halved.left / found.count.max(1) as f64).sqrt() };
    stage.work.watch.step(&suited.words());
    Ok(suited)
}
