//! Prediction errors: every run, free and in windows, under the nominal and the corrected model, each with its own starts.

use crate::error::DiagnoseError;
use crate::fit::{Effort, Fit, fit};
use crate::linear::{Segment, Stage};
use crate::lost;
use crate::plant::Plant;
use crate::standing::follow_with;
use crate::stretches::{cut, joined};
use crate::tape::Tape;
use nalgebra::DVector;
use rayon::prelude::*;
use record::Role;

/// A model with the starts that suit it best, and what its predictions are off by.
#[derive(Clone, Debug)]
pub struct Prediction {
    /// The starts, segment by segment; its cost is that of the samples which these were estimated from.
    pub fit: Fit,
    /// Residuals of all samples of each segment, units of noise.
    pub residuals: Vec<DVector<f64>>,
}

/// Predictions of all runs by the nominal and by the corrected model.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// In windows.
    pub windowed: [Prediction; 2],
    /// Whole runs.
    pub whole: [Prediction; 2],
}

/// One scalar of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scalar {
    /// Index of the reading.
    pub reading: usize,
    /// Which of its samples.
    pub sample: usize,
    /// Which of its components.
    pub component: usize,
    /// When it was sampled, s.
    pub time: f64,
    /// Prediction less measurement, units of noise.
    pub residual: f64,
}

/// Estimates the starts of every run under both models, from those that the search has found, and judges all samples by them; `follows`: whole
/// runs follow the corrected one.
///
/// `few` has the samples by which starts are estimated, enough for that, `all` those by which both models are judged.
pub fn judge(
    (few, all): (&Stage<'_>, &Stage<'_>),
    plant: &Plant,
    (nominal, found): ([&Fit; 2], &Fit),
    (window, follows): (f64, bool),
) -> Result<Judgement, DiagnoseError> {
    let predict = |fit: Fit| Prediction {
        residuals: fit.segments.par_iter().map(|s| all.residuals(&fit.built, s)).collect(),
        fit,
    };
    let is_last = |known: &Fit| known.set.members.len() == found.set.members.len();
    let of = |known: &Fit| -> Result<(Prediction, Prediction), DiagnoseError> {
        let stage = &Stage { pace: if is_last(known) { all.pace } else { few.pace }, ..*few };
        let set = known.set.frozen();
        let built = plant.build(&set.effects())?;
        // What a wrong model is off by takes no more exact starts.
        let model = if is_last(known) { "corrected" } else { "nominal" };
        let say =
            |what: &str, fit: &Fit| stage.work.watch.step(&format!("{model} model, {what}: error {:.3}", fit.rms()));
        let effort = if is_last(known) { Effort::JUDGED } else { Effort { iterations: GLANCES, ..Effort::JUDGED } };
        let mut windows = cut(&built, stage.tapes, Some(window), |_| true);
        begin_from(stage, &mut windows, &known.segments);
        let first = |windows: &[Segment]| joined(windows, stage.tapes);
        let of_runs = if is_last(known) { found } else { nominal[1] };
        let restarted = |windows: Vec<Segment>| -> Result<Fit, DiagnoseError> {
            let windowed = fit(stage, plant, set.clone(), windows, effort)?;
            say("windows", &windowed);
            let is_plausible = || windowed.rms() < PLAUSIBLE || lost::calc_poor_share(stage, &windowed) <= lost::FEW;
            if !is_last(known) || !is_plausible() {
                return Ok(windowed);
            }
            let anew = stage.begun_anew(&built, &windowed.segments, (Effort::JUDGED, lost::POOR_WINDOW));
            fit(stage, plant, set.clone(), anew, Effort { iterations: 0, ..Effort::JUDGED })
        };
        if !follows {
            // Where whole runs go astray their starts are found in windows, if anywhere.
            let windowed = restarted(windows)?;
            let mut runs = first(&windowed.segments);
            if !is_last(known) {
                begin_from(stage, &mut runs, &of_runs.segments);
            }
            say("windows, begun anew", &windowed);
            let whole = follow_with(stage, plant, set.clone(), &runs, effort)?;
            say("whole runs", &whole);
            return Ok((predict(windowed), predict(whole)));
        }
        let mut runs = first(&windows);
        begin_from(stage, &mut runs, &of_runs.segments);
        let mut whole = follow_with(stage, plant, set.clone(), &runs, effort)?;
        say("whole runs", &whole);
        // Where the model that was found is near, single runs that are far off stand in wrong valleys.
        if is_last(known) && known.rms() < PLAUSIBLE {
            let anew = stage.begun_anew(&built, &whole.segments, (Effort::JUDGED, lost::POOR_RUN));
            whole = fit(stage, plant, set.clone(), anew, Effort { iterations: 1, ..Effort::JUDGED })?;
        }
        say("whole runs, begun anew", &whole);
        let near = |whole: &Fit| -> Vec<Segment> {
            whole.segments.iter().filter(|s| lost::is_near(stage, &built, s)).cloned().collect()
        };
        let followed = near(&whole);
        stage.along(&built, &followed, &mut windows);
        let mut windowed = restarted(windows)?;
        say("windows, begun anew", &windowed);
        if whole.rms() >= lost::NEAR && is_last(known) {
            whole = follow_with(stage, plant, set.clone(), &first(&windowed.segments), effort)?;
            let found = near(&whole);
            if found.len() > followed.len() {
                stage.along(&built, &found, &mut windowed.segments);
                windowed = fit(stage, plant, set.clone(), windowed.segments, Effort::JUDGED)?;
            }
        }
        Ok((predict(windowed), predict(whole)))
    };
    let before = of(nominal[0])?;
    let after = if found.set.members.is_empty() { before.clone() } else { of(found)? };
    Ok(Judgement { windowed: [before.0, after.0], whole: [before.1, after.1] })
}

/// Linearisations of the starts of a model that is known to be wrong.
const GLANCES: usize = 2;
/// Root mean square over whole runs up to which starts are doubted before the model is.
const PLAUSIBLE: f64 = 8.0;

/// Takes the starts of segments that are known already, and their derivatives where these are of as many samples.
fn begin_from(stage: &Stage<'_>, segments: &mut [Segment], known: &[Segment]) {
    for segment in segments {
        let begins_alike = |k: &&Segment| k.run == segment.run && (k.span.from - segment.span.from).abs() < 1e-9;
        let Some(known) = known.iter().find(begins_alike) else { continue };
        segment.start.clone_from(&known.start);
        if (known.span.to - segment.span.to).abs() < 1e-9 && known.weight == segment.weight {
            let count = stage.count(segment);
            segment.columns = known.columns.clone().filter(|k| k.is_of(count));
        }
    }
}

impl Prediction {
    /// Root mean square over some runs, units of noise.
    fn rms(&self, wanted: impl Fn(usize) -> bool) -> f64 {
        let count: usize = self.of(&wanted).map(|r| r.len()).sum();
        (self.cost(wanted) / count.max(1) as f64).sqrt()
    }

    /// Squared norm of the residual over some runs.
    fn cost(&self, wanted: impl Fn(usize) -> bool) -> f64 {
        self.of(&wanted).map(|r| r.norm_squared()).sum()
    }

    fn of(&self, wanted: &impl Fn(usize) -> bool) -> impl Iterator<Item = &DVector<f64>> {
        self.fit.segments.iter().zip(&self.residuals).filter(|(s, _)| wanted(s.run)).map(|(_, r)| r)
    }

    /// Every scalar of a run, segment by segment, in the order of its samples.
    pub fn scalars(&self, tape: &Tape) -> Vec<Scalar> {
        let mut all = Vec::new();
        for (segment, r) in self.fit.segments.iter().zip(&self.residuals).filter(|(s, _)| s.run == tape.index) {
            let range = tape.range(segment.span);
            for i in range.clone() {
                let (event, first) = (&tape.events[i], tape.offsets[i] - tape.offsets[range.start]);
                let reading = event.reading as usize;
                all.extend((0..tape.readings[reading].width()).map(|component| Scalar {
                    reading,
                    sample: event.sample as usize,
                    component,
                    time: event.time,
                    residual: r[first + component],
                }));
            }
        }
        all
    }
}

impl Judgement {
    /// Root mean square of some runs, units of noise: nominal and corrected.
    pub fn rms(&self, windowed: bool, wanted: impl Fn(usize) -> bool) -> [f64; 2] {
        self.predictions(windowed).each_ref().map(|p| p.rms(&wanted))
    }

    /// Squared norms of the residuals of some runs: nominal and corrected.
    pub fn costs(&self, windowed: bool, wanted: impl Fn(usize) -> bool) -> [f64; 2] {
        self.predictions(windowed).each_ref().map(|p| p.cost(&wanted))
    }

    fn predictions(&self, windowed: bool) -> &[Prediction; 2] {
        if windowed { &self.windowed } else { &self.whole }
    }

    /// Root mean square over the runs of a role.
    pub fn rms_of(&self, tapes: &[Tape], windowed: bool, role: Role) -> Option<[f64; 2]> {
        tapes.iter().any(|t| t.role == role).then(|| self.rms(windowed, |run| tapes[run].role == role))
    }
}
