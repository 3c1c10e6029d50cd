//! Prediction errors: every run, free and in windows, under the nominal and the corrected model, each with its own starts.

use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::fit::{Effort, Fit, fit};
use crate::linear::{Segment, Stage};
use crate::lost;
use crate::plant::{Built, Plant};
use crate::standing::follow_with;
use crate::stretches::{cut, joined};
use crate::tape::Tape;
use nalgebra::DVector;
use rayon::prelude::*;
use record::Role;
use std::borrow::Cow;

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
    /// In windows and over whole runs, what the nominal model predicts whose numbers alone are corrected within their tolerances: what effects
    /// explain is what these leave. None where there are no such numbers, or no effects beside them.
    pub tolerated: Option<[Prediction; 2]>,
}

/// Models to be judged: windows and whole runs of each, with the starts that the search has found.
#[derive(Clone, Copy, Debug)]
pub struct Models<'a> {
    /// The nominal one.
    pub nominal: [&'a Fit; 2],
    /// The nominal one, its numbers corrected within their tolerances.
    pub tolerated: Option<[&'a Fit; 2]>,
    /// The corrected one.
    pub found: [&'a Fit; 2],
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
    models: Models<'_>,
    (window, follows): (f64, bool),
) -> Result<Judgement, DiagnoseError> {
    let Models { nominal, tolerated, found } = models;
    let set = &found[0].set;
    let [few_tapes, all_tapes] = [few, all].map(|stage| as_late_as(&found[0].built, stage.tapes));
    let few = &Stage { tapes: &few_tapes, ..*few };
    let all = &Stage { tapes: &all_tapes, ..*all };
    let predict = |fit: Fit| Prediction {
        residuals: fit.segments.par_iter().map(|s| all.residuals(&fit.built, s)).collect(),
        fit,
    };
    let of = |[known, runs]: [&Fit; 2], who: Who| -> Result<[Prediction; 2], DiagnoseError> {
        let is_last = who == Who::Corrected || set.members.is_empty();
        let stage = Stage { pace: if is_last { all.pace } else { few.pace }, ..*few };
        let set = known.set.frozen();
        let built = plant.build(&set.effects())?;
        let runs = if is_last { found[1] } else { runs };
        let is_corrected = is_last || who == Who::Tolerated;
        let model = Candidate { stage, plant, set, built, who, is_corrected, known, runs };
        let starts = if follows { model.starts_along_runs(window)? } else { model.starts_in_windows(window)? };
        Ok(starts.map(predict))
    };
    let [windows_before, runs_before] = of(nominal, Who::Nominal)?;
    let [windows_after, runs_after] = match set.members.is_empty() {
        true => [windows_before.clone(), runs_before.clone()],
        false => of(found, Who::Corrected)?,
    };
    let has_effects = set.has_findings();
    let tolerated = tolerated.filter(|fits| has_effects && !fits[0].set.members.is_empty());
    Ok(Judgement {
        windowed: [windows_before, windows_after],
        whole: [runs_before, runs_after],
        tolerated: tolerated.map(|fits| of(fits, Who::Tolerated)).transpose()?,
    })
}

/// Which model is judged.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Who {
    Nominal,
    Tolerated,
    Corrected,
}

impl Who {
    /// For who watches.
    fn words(self) -> &'static str {
        match self {
            Self::Nominal => "nominal model",
            Self::Tolerated => "nominal model, its numbers within their tolerances",
            Self::Corrected => "corrected model",
        }
    }
}

/// Runs with their sensors as late as they are in a model; as they were where none is.
fn as_late_as<'t>(built: &Built, tapes: &'t [Tape]) -> Cow<'t, [Tape]> {
    match tapes.iter().any(|tape| tape.is_late_in(built)) {
        true => tapes.iter().map(|tape| tape.as_late_as(built)).collect(),
        false => Cow::Borrowed(tapes),
    }
}

/// A model whose starts are estimated to judge it.
struct Candidate<'a> {
    stage: Stage<'a>,
    plant: &'a Plant,
    /// Its effects, no number free.
    set: EffectSet,
    built: Built,
    who: Who,
    /// Whether it is corrected: by effects, or within tolerances.
    is_corrected: bool,
    /// The fit whose windows are known, and that whose whole runs are.
    known: &'a Fit,
    runs: &'a Fit,
}

impl Candidate<'_> {
    fn say(&self, what: &str, fit: &Fit) {
        self.stage.work.watch.step(&format!("{}, {what}: error {:.3}", self.who.words(), fit.rms()));
    }

    /// What a wrong model is off by takes no more exact starts.
    fn effort(&self) -> Effort {
        if self.is_corrected { Effort::JUDGED } else { Effort { iterations: GLANCES, ..Effort::JUDGED } }
    }

    fn fit(&self, segments: Vec<Segment>, effort: Effort) -> Result<Fit, DiagnoseError> {
        fit(&self.stage, self.plant, self.set.clone(), segments, effort)
    }

    fn follow(&self, runs: &[Segment]) -> Result<Fit, DiagnoseError> {
        follow_with(&self.stage, self.plant, self.set.clone(), runs, self.effort())
    }

    /// Windows of every run, from the starts that are known.
    fn windows(&self, window: f64) -> Vec<Segment> {
        let mut windows = cut(&self.built, self.stage.tapes, Some(window), |_| true);
        begin_from(&self.stage, &mut windows, &self.known.segments);
        windows
    }

    /// Windows with their starts fitted, of the corrected model also those that stand in wrong valleys.
    fn fit_windows(&self, windows: Vec<Segment>) -> Result<Fit, DiagnoseError> {
        let mut windowed = self.fit(windows, self.effort())?;
        self.say("windows", &windowed);
        let is_plausible = || windowed.rms() < PLAUSIBLE || lost::calc_poor_share(&self.stage, &windowed) <= lost::FEW;
        if self.is_corrected && is_plausible() {
            let anew = self.stage.begun_anew(&self.built, &windowed.segments, (Effort::JUDGED, lost::POOR_WINDOW));
            windowed = self.fit(anew, Effort { iterations: 0, ..Effort::JUDGED })?;
        }
        self.say("windows, begun anew", &windowed);
        Ok(windowed)
    }

    /// In windows and over whole runs, where these go astray: their starts are found in windows, if anywhere.
    fn starts_in_windows(&self, window: f64) -> Result<[Fit; 2], DiagnoseError> {
        let windowed = self.fit_windows(self.windows(window))?;
        let mut runs = joined(&windowed.segments, self.stage.tapes);
        if !self.is_corrected {
            begin_from(&self.stage, &mut runs, &self.runs.segments);
        }
        let whole = self.follow(&runs)?;
        self.say("whole runs", &whole);
        Ok([windowed, whole])
    }

    /// In windows and over whole runs, where these are followed: windows begin where the run is then.
    fn starts_along_runs(&self, window: f64) -> Result<[Fit; 2], DiagnoseError> {
        let mut windows = self.windows(window);
        let mut runs = joined(&windows, self.stage.tapes);
        begin_from(&self.stage, &mut runs, &self.runs.segments);
        let mut whole = self.follow(&runs)?;
        self.say("whole runs", &whole);
        // Where the model that was found is near, single runs that are far off stand in wrong valleys.
        if self.is_corrected && self.known.rms() < PLAUSIBLE {
            let anew = self.stage.begun_anew(&self.built, &whole.segments, (Effort::JUDGED, lost::POOR_RUN));
            whole = self.fit(anew, Effort { iterations: 1, ..Effort::JUDGED })?;
        }
        self.say("whole runs, begun anew", &whole);
        let followed = self.near(&whole);
        self.stage.along(&self.built, &followed, &mut windows);
        let mut windowed = self.fit_windows(windows)?;
        if whole.rms() >= lost::NEAR && self.is_corrected {
            whole = self.follow(&joined(&windowed.segments, self.stage.tapes))?;
            let found = self.near(&whole);
            if found.len() > followed.len() {
                self.stage.along(&self.built, &found, &mut windowed.segments);
                windowed = self.fit(windowed.segments, Effort::JUDGED)?;
            }
        }
        Ok([windowed, whole])
    }

    /// The runs that are followed.
    fn near(&self, whole: &Fit) -> Vec<Segment> {
        whole.segments.iter().filter(|s| lost::is_near(&self.stage, &self.built, s)).cloned().collect()
    }
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
    pub(crate) fn rms(&self, wanted: impl Fn(usize) -> bool) -> f64 {
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

    /// Windows, or whole runs, of the model that effects are held against, and of the corrected one.
    pub(crate) fn beside_effects(&self, windowed: bool) -> [&Prediction; 2] {
        let [before, after] = self.predictions(windowed);
        let tolerated = self.tolerated.as_ref().map(|[windows, runs]| if windowed { windows } else { runs });
        [tolerated.unwrap_or(before), after]
    }

    fn predictions(&self, windowed: bool) -> &[Prediction; 2] {
        if windowed { &self.windowed } else { &self.whole }
    }

    /// Root mean square over the runs of a role.
    pub fn rms_of(&self, tapes: &[Tape], windowed: bool, role: Role) -> Option<[f64; 2]> {
        tapes.iter().any(|t| t.role == role).then(|| self.rms(windowed, |run| tapes[run].role == role))
    }
}
