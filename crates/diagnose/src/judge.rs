//! Prediction errors: every run, free and in windows, under the nominal and the corrected model, each with its own starts.

use crate::error::DiagnoseError;
use crate::fit::{EffectSet, Effort, Fit, fit};
use crate::linear::Stage;
use crate::plant::Plant;
use crate::run::{cut, joined};
use record::Role;

/// Fits of the starts of all runs.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// In windows, nominal and corrected.
    pub windowed: [Fit; 2],
    /// Whole runs, nominal and corrected.
    pub whole: [Fit; 2],
}

/// Fit of starts alone.
const STARTS: Effort = Effort { iterations: 6, share: 1e-4 };

/// Estimates the starts of every run under both models.
pub fn judge(stage: &Stage<'_>, plant: &Plant, set: &EffectSet, window: f64) -> Result<Judgement, DiagnoseError> {
    let of = |set: &EffectSet| -> Result<(Fit, Fit), DiagnoseError> {
        let frozen =
            EffectSet { held: set.slots().into_iter().chain(set.held.iter().copied()).collect(), ..set.clone() };
        let built = plant.build(&frozen.effects())?;
        let segments = cut(&built, stage.tapes, Some(window), |_| true);
        let windowed = fit(stage, plant, frozen.clone(), segments, STARTS)?;
        let whole = fit(stage, plant, frozen, joined(&windowed, stage.tapes), STARTS)?;
        Ok((windowed, whole))
    };
    let nominal = of(&EffectSet::default())?;
    let corrected = if set.members.is_empty() { nominal.clone() } else { of(set)? };
    Ok(Judgement { windowed: [nominal.0, corrected.0], whole: [nominal.1, corrected.1] })
}

impl Judgement {
    /// Root mean square of some runs, units of noise: nominal and corrected.
    pub fn rms(&self, stage: &Stage<'_>, windowed: bool, wanted: impl Fn(usize) -> bool) -> [f64; 2] {
        let fits = if windowed { &self.windowed } else { &self.whole };
        [0, 1].map(|m| {
            let of = |s: &crate::linear::Segment| {
                let r = stage.residuals(&fits[m].built, s);
                (r.norm_squared(), r.len())
            };
            let sums = fits[m].segments.iter().filter(|s| wanted(s.run)).map(of);
            let (cost, count) = sums.fold((0.0, 0), |sum, p| (sum.0 + p.0, sum.1 + p.1));
            (cost / count.max(1) as f64).sqrt()
        })
    }

    /// Root mean square over the runs of a role.
    pub fn rms_of(&self, stage: &Stage<'_>, windowed: bool, role: Role) -> Option<[f64; 2]> {
        let has = stage.tapes.iter().any(|t| t.role == role);
        has.then(|| self.rms(stage, windowed, |run| stage.tapes[run].role == role))
    }
}
