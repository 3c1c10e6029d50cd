//! Several effects at once: one linear screen of all hypotheses together, and a selection among them.
//!
//! Where a rig departs from its model in several ways, the effect that promises most alone may be none of them: it stands for what they
//! have in common. The screen of [`crate::screen`] looks at one hypothesis at a time; here the columns of all of them stand in one Gram
//! matrix, starts and active parameters eliminated, and the fall of the cost that a *set* S promises,
//!
//!   b_Sᵀ A_SS⁻¹ b_S,
//!
//! costs a small linear system. What a model leaves that no effect of the library has is no noise, and there a criterion for noise is sure of
//! anything: the fall is therefore judged by cross-validation, amplitudes from all folds of the segments but one, the fall in that one (Stone 1974). Sets grow by one effect at a time, the best few of each size go on (beam search), so that what was taken first
//! can turn out to be nothing beside two others. A set whose amplitudes no effect can have (friction that drives) is none.

use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::fit::{Fit, pseudo_inverse};
use crate::hypothesis::{Hypothesis, Tier};
use crate::linear::{Segment, Stage, Variation};
use crate::plant::Plant;
use crate::screen::{Pilots, Probe, Score, Screened, probes_of, thinned, vary_active};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Sets of each size that go on to the next.
const BEAM: usize = 8;
/// Share of what a set leaves that one more effect must promise.
const FURTHER: f64 = 0.15;
/// Hypotheses that take part: the best of a screen by themselves.
const TAKING_PART: usize = 60;
/// What more physics beside other physics has to promise above a corrected nominal number, as a share of the most that one effect promises: a number
/// that is slightly off is likelier.
const LUXURY: f64 = 0.05;
/// Folds of the segments: stretches of the recording in their order.
const FOLDS: usize = 5;
/// Sets that are handed on.
const HANDED: usize = 2;

/// A set of effects that promises more than any of them.
#[derive(Clone, Debug)]
pub(crate) struct Ensemble {
    /// Indices of the hypotheses, and coordinates to begin a refit with.
    pub members: Vec<(usize, Vec<f64>)>,
    /// Promised fall of the cost.
    pub score: f64,
    /// What each member promises of it beside the others.
    pub parts: Vec<f64>,
}

impl Ensemble {
    /// Beside a set.
    pub(crate) fn beside(&self, set: &EffectSet, all: &[Hypothesis]) -> EffectSet {
        self.members.iter().fold(set.clone(), |set, (h, x)| set.with(&all[*h], x))
    }
}

/// Sets of at least two effects and at most `most`, the best first; none where one effect promises nearly as much. `scores`: those of a
/// screen beside the same fit.
pub(crate) fn screen_together(
    stage: &Stage<'_>,
    plant: &Plant,
    fit: &Fit,
    (all, scores, most): (&[Hypothesis], &[Score], usize),
) -> Result<Vec<Ensemble>, DiagnoseError> {
    let mut taking: Vec<&Score> = Vec::new();
    for score in scores {
        if taking.len() < TAKING_PART && taking.iter().all(|t| t.hypothesis != score.hypothesis) {
            taking.push(score);
        }
    }
    let (fit, share) = &thinned(fit);
    let coarse = stage.coarser();
    let pilots = Pilots::new(&coarse, fit);
    let probes_at = |score: &&Score| {
        let h = &all[score.hypothesis];
        probes_of(&coarse, plant, (fit, &pilots), (h, &h.screens[score.point]))
    };
    let probes: Vec<Vec<Probe>> = taking.par_iter().map(probes_at).collect();
    let active = vary_active(plant, fit)?;
    let gram = Gram::new(&coarse, fit, &active, &probes);
    let has_findings = fit.set.has_findings();
    let linear = Linear { all, taking: &taking, gram: &gram, noise: share * fit.noise, has_findings };
    Ok(linear.select(most))
}

/// Products of the active columns, those of all hypotheses and of the residual, by fold.
struct Gram {
    folds: Vec<DMatrix<f64>>,
    all: DMatrix<f64>,
    active: usize,
    /// First column of each hypothesis, and the number of all.
    first: Vec<usize>,
}

impl Gram {
    fn new(stage: &Stage<'_>, fit: &Fit, active: &[Variation], probes: &[Vec<Probe>]) -> Self {
        let mut first = vec![active.len()];
        probes.iter().for_each(|p| first.push(first[first.len() - 1] + p.len()));
        let of = |segment: &Segment| {
            let screened = Screened::new(stage, fit, segment, active);
            let columns: Vec<DVector<f64>> = probes.par_iter().flatten().map(|p| screened.column(p)).collect();
            screened.reduced(&columns, &[])
        };
        let parts: Vec<DMatrix<f64>> = fit.segments.par_iter().map(of).collect();
        let side = first[probes.len()] + 1;
        let sum = |parts: &[DMatrix<f64>]| parts.iter().fold(DMatrix::zeros(side, side), |sum, part| sum + part);
        let folds = parts.len().clamp(1, FOLDS);
        let bounds: Vec<usize> = (0..=folds).map(|k| k * parts.len() / folds).collect();
        let folds: Vec<DMatrix<f64>> = bounds.windows(2).map(|b| sum(&parts[b[0]..b[1]])).collect();
        let mut all = sum(&parts);
        fit.set.add_prior(&mut all);
        Self { all, folds, active: active.len(), first }
    }

    fn columns_of(&self, member: usize) -> std::ops::Range<usize> {
        self.first[member]..self.first[member + 1]
    }

    /// Amplitudes of some hypotheses, the active parameters following, and the fall of the cost in folds that these are not taken from.
    fn solve(&self, members: &[usize]) -> (Vec<f64>, f64) {
        let hypotheses = members.iter().flat_map(|m| self.columns_of(*m));
        let columns: Vec<usize> = (0..self.active).chain(hypotheses).collect();
        let (n, last) = (columns.len(), self.all.ncols() - 1);
        let part = |k: &DMatrix<f64>| {
            let a = DMatrix::from_fn(n, n, |i, j| k[(columns[i], columns[j])]);
            (a, DVector::from_fn(n, |i, _| k[(columns[i], last)]))
        };
        let (a, b) = part(&self.all);
        let x = -(pseudo_inverse(&a) * &b);
        let of_fold = |fold: &DMatrix<f64>| {
            let (own_a, own_b) = part(fold);
            let x = -(pseudo_inverse(&(&a - &own_a)) * (&b - &own_b));
            -(2.0 * own_b.dot(&x) + x.dot(&(&own_a * &x)))
        };
        let fall = if self.folds.len() > 1 { self.folds.iter().map(of_fold).sum() } else { -b.dot(&x) };
        (x.iter().skip(self.active).copied().collect(), fall)
    }
}

/// The linear problem.
struct Linear<'a> {
    all: &'a [Hypothesis],
    taking: &'a [&'a Score],
    gram: &'a Gram,
    noise: f64,
    /// Whether there are findings already.
    has_findings: bool,
}

impl Linear<'_> {
    /// What a set promises, less what speaks against it beforehand; `most`: what one effect promises.
    fn worth(&self, ensemble: &Ensemble, most: f64) -> f64 {
        let physics = ensemble.members.iter().filter(|(h, _)| self.all[*h].tier == Tier::Exotic).count();
        let more = physics.saturating_sub(usize::from(!self.has_findings));
        ensemble.score - LUXURY * most * more as f64
    }

    /// A set with its coordinates, if its effects can have them.
    fn ensemble(&self, members: &[usize]) -> Option<Ensemble> {
        let (x, score) = self.gram.solve(members);
        let mut at = 0;
        let coordinates = |m: &usize| {
            let (score, count) = (self.taking[*m], self.gram.columns_of(*m).len());
            let (h, amplitudes) = (&self.all[score.hypothesis], &x[at..at + count]);
            at += count;
            let point = &h.screens[score.point];
            (count == point.columns.len())
                .then(|| h.start_from(point, amplitudes))
                .flatten()
                .map(|s| (score.hypothesis, s))
        };
        let members: Option<Vec<(usize, Vec<f64>)>> = members.iter().map(coordinates).collect();
        members.filter(|_| score.is_finite()).map(|members| Ensemble { members, score, parts: Vec::new() })
    }

    fn select(&self, most: usize) -> Vec<Ensemble> {
        let mut beam: Vec<(Vec<usize>, Ensemble)> = Vec::new();
        let mut alone = 0.0f64;
        let (cost, nothing) =
            (self.gram.all[(self.gram.all.nrows() - 1, self.gram.all.nrows() - 1)], self.gram.solve(&[]).1);
        for size in 1..=most {
            let from: Vec<Vec<usize>> =
                if size == 1 { vec![Vec::new()] } else { beam.iter().map(|b| b.0.clone()).collect() };
            let mut sets: Vec<Vec<usize>> = Vec::new();
            for (set, m) in from.iter().flat_map(|set| (0..self.taking.len()).map(move |m| (set, m))) {
                let mut grown = [&set[..], &[m]].concat();
                grown.sort_unstable();
                if !set.contains(&m) && !sets.contains(&grown) {
                    sets.push(grown);
                }
            }
            let of = |set: Vec<usize>| self.ensemble(&set).map(|e| (set, e));
            let mut grown: Vec<(Vec<usize>, Ensemble)> = sets.into_par_iter().filter_map(of).collect();
            if size == 1 {
                alone = grown.iter().map(|g| g.1.score).fold(0.0, f64::max);
            }
            grown.sort_by(|a, b| self.worth(&b.1, alone).total_cmp(&self.worth(&a.1, alone)));
            grown.truncate(BEAM);
            let [before, after] = [&beam, &grown].map(|sets| sets.first().map_or(nothing, |s| s.1.score));
            let left = (cost - before - self.noise).max(0.0);
            if after - before < (FURTHER * left).max(self.noise.max(1.0).ln()) {
                break;
            }
            beam = grown;
        }
        beam.retain(|b| b.1.members.len() > 1);
        beam.into_iter()
            .take(HANDED)
            .map(|(members, e)| Ensemble { parts: self.parts(&members, e.score), ..e })
            .collect()
    }

    /// What each of some hypotheses promises beside the others.
    fn parts(&self, members: &[usize], score: f64) -> Vec<f64> {
        let without = |m: &usize| members.iter().filter(|o| *o != m).copied().collect::<Vec<usize>>();
        members.iter().map(|m| score - self.gram.solve(&without(m)).1).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::hypotheses;
    use crate::facts::Facts;
    use crate::screen::Shown;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    /// Viscous friction of three joints.
    fn three() -> Vec<Hypothesis> {
        hypotheses(&Facts::of_joints(3)).into_iter().filter(|h| h.name == "joint-viscous-friction").collect()
    }

    /// Products by fold of three columns and a residual: the third column is the sum of the others and some noise.
    fn gram(truth: [f64; 2], noise: f64) -> Gram {
        let mut dice = ChaCha8Rng::seed_from_u64(7);
        let mut draw = || (0..12).map(|_| dice.next_u32() as f64 / f64::from(u32::MAX)).sum::<f64>() - 6.0;
        let mut folds = Vec::new();
        for _ in 0..FOLDS {
            let mut k = DMatrix::zeros(4, 4);
            for _ in 0..40 {
                let (a, b) = (draw(), draw());
                let row = [a, b, a + b + 0.3 * draw(), -(truth[0] * a + truth[1] * b) + noise * draw()];
                k += DMatrix::from_fn(4, 4, |i, j| row[i] * row[j]);
            }
            folds.push(k);
        }
        Gram { all: folds.iter().sum(), folds, active: 0, first: vec![0, 1, 2, 3] }
    }

    fn selected(truth: [f64; 2], noise: f64) -> Vec<Vec<usize>> {
        let all = three();
        let score = |hypothesis: usize| Score {
            hypothesis,
            point: 0,
            score: 1.0,
            rank: 1,
            start: vec![0.0],
            beside: Vec::new(),
            shown: Shown { errors: Vec::new(), condition: 1.0 },
        };
        let scores: Vec<Score> = (0..3).map(score).collect();
        let taking: Vec<&Score> = scores.iter().collect();
        let gram = gram(truth, noise);
        let linear =
            Linear { all: &all, taking: &taking, gram: &gram, noise: noise * noise * 200.0, has_findings: false };
        linear.select(3).iter().map(|e| e.members.iter().map(|m| m.0).collect()).collect()
    }

    #[test]
    fn two_effects_are_not_taken_for_what_they_have_in_common() {
        // Alone the third promises most.
        let gram = gram([1.0, 1.0], 0.1);
        let alone = [0, 1, 2].map(|m| gram.solve(&[m]).1);
        assert!(alone[2] > alone[0] && alone[2] > alone[1], "{alone:?}");
        assert_eq!(selected([1.0, 1.0], 0.1).first(), Some(&vec![0, 1]));
    }

    #[test]
    fn one_effect_makes_no_set_and_neither_does_noise() {
        assert!(selected([1.0, 0.0], 0.1).is_empty());
        assert!(selected([0.0, 0.0], 1.0).is_empty());
    }

    #[test]
    fn friction_that_drives_is_no_member() {
        assert!(selected([1.0, -1.0], 0.1).iter().all(|set| !set.contains(&1)));
    }
}
