//! What stands behind a diagnosis: plain data that the estimator fills and the report draws.
//!
//! Samples come at full rate; the report thins what it draws (least and largest value of every stretch). NaN is "not
//! measured" or "not computed" and leaves a gap. Everything may be empty: the report leaves out what it has no data for.

use crate::diagnosis::Role;

/// Everything that a report shows besides the [`Diagnosis`](crate::Diagnosis) itself.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Evidence {
    /// Title of the recording; its folder's name where it has none.
    pub title: String,
    /// What was found about the recording before anything was fitted.
    pub quality: Vec<Remark>,
    /// Which parameters the recording can show at all, judged before the fit.
    pub identifiability: Vec<Identifiable>,
    /// The simulation's own error.
    pub discretisation: Option<Discretisation>,
    /// The test whether there is a mismatch at all.
    pub detection: Option<Detection>,
    /// Mismatch by channel and time, one per run.
    pub heat: Vec<Heat>,
    /// Measured, nominal and corrected curves of the channels that matter.
    pub curves: Vec<Curve>,
    /// The missing force over time.
    pub forces: Vec<MissingForce>,
    /// The missing force against the quantity that it depends on.
    pub scatters: Vec<Scatter>,
    /// All hypotheses, best first.
    pub ranking: Vec<Hypothesis>,
    /// Parameters of the effects that were chosen.
    pub parameters: Vec<Parameter>,
    /// Correlation of these parameters, in their order; empty where there is none.
    pub correlation: Vec<Vec<f64>>,
    /// Autocorrelation of residuals before and after.
    pub whiteness: Vec<Whiteness>,
    /// Where the time went, in order.
    pub timings: Vec<Stage>,
}

/// A remark on the data.
#[derive(Debug, Clone, PartialEq)]
pub struct Remark {
    /// How serious.
    pub level: Level,
    /// Channel, run or place it is about; may be empty.
    pub subject: String,
    /// One sentence.
    pub text: String,
}

/// How serious a remark is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// Good to know.
    Note,
    /// Weakens the diagnosis.
    Warning,
    /// May make it wrong.
    Serious,
}

/// How well the recording shows one parameter, from the Fisher information before the fit.
#[derive(Debug, Clone, PartialEq)]
pub struct Identifiable {
    /// Name of the effect.
    pub effect: String,
    /// Its place.
    pub place: String,
    /// The parameter, with its component where it is a vector: `inertia zz`.
    pub parameter: String,
    /// Unit.
    pub unit: String,
    /// Standard error to expect, nuisance eliminated; infinite where the data cannot show it.
    pub std_err: f64,
    /// Condition number of the effect's scaled information matrix.
    pub condition: f64,
    /// What follows, in words; may be empty.
    pub remark: String,
}

/// The check of the integration by halving its step.
#[derive(Debug, Clone, PartialEq)]
pub struct Discretisation {
    /// Step that was used, s.
    pub step_s: f64,
    /// Length of the windows over which it was judged, s.
    pub window_s: f64,
    /// RMS difference to half the step, in units of noise.
    pub error: f64,
    /// Bound it must keep, in units of noise.
    pub bound: f64,
}

/// The test whether simulation and recording differ beyond the noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Detection {
    /// What the statistic is, in words: "largest window score of 420".
    pub statistic: String,
    /// Its value.
    pub value: f64,
    /// Value that noise alone exceeds with probability `false_alarm` over the whole recording.
    pub bound: f64,
    /// Probability of a false alarm over the whole recording.
    pub false_alarm: f64,
}

/// Mismatch of one run: mean square of the residual in units of noise, by channel and time bin.
#[derive(Debug, Clone, PartialEq)]
pub struct Heat {
    /// File of the run.
    pub run: String,
    /// What the run is for.
    pub role: Role,
    /// Windows after which the state is estimated anew, s; `None`: one free run.
    pub window_s: Option<f64>,
    /// Edges of the bins, s: one more than there are bins.
    pub edges_s: Vec<f64>,
    /// One row per channel.
    pub rows: Vec<HeatRow>,
}

/// One channel of a [`Heat`].
#[derive(Debug, Clone, PartialEq)]
pub struct HeatRow {
    /// The channel.
    pub channel: String,
    /// Mean square per bin under the nominal model; 1 is noise alone.
    pub nominal: Vec<f64>,
    /// The same under the corrected model; empty where nothing was corrected.
    pub corrected: Vec<f64>,
}

/// One channel of one run: measured and predicted.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// File of the run.
    pub run: String,
    /// What the run is for.
    pub role: Role,
    /// The channel.
    pub channel: String,
    /// Unit.
    pub unit: String,
    /// Noise of the sensor, one sigma, in `unit`, rounding included.
    pub sigma: f64,
    /// Windows after which the state is estimated anew, s; `None`: one free run.
    pub window_s: Option<f64>,
    /// Times, s.
    pub t: Vec<f64>,
    /// Measured.
    pub measured: Vec<f64>,
    /// Predicted by the nominal model; may be empty.
    pub nominal: Vec<f64>,
    /// Predicted by the corrected model; empty where nothing was corrected.
    pub corrected: Vec<f64>,
}

/// The missing generalised force at one degree of freedom, over time.
#[derive(Debug, Clone, PartialEq)]
pub struct MissingForce {
    /// Where it acts.
    pub place: String,
    /// Along what: "torque about z, body axes".
    pub freedom: String,
    /// Unit.
    pub unit: String,
    /// File of the run.
    pub run: String,
    /// Times, s.
    pub t: Vec<f64>,
    /// Estimate from the data and the nominal model.
    pub estimate: Vec<f64>,
    /// One standard error of the estimate.
    pub std_err: Vec<f64>,
    /// The law that was found along the same motion: its name and values.
    pub law: Option<(String, Vec<f64>)>,
}

/// The missing force against one quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Scatter {
    /// Where it acts.
    pub place: String,
    /// Quantity and unit across: "joint velocity, rad/s".
    pub across: String,
    /// Quantity and unit up: "missing torque, N m".
    pub up: String,
    /// Points.
    pub points: Vec<ScatterPoint>,
    /// The law that was found: its name and points along it.
    pub law: Option<(String, Vec<(f64, f64)>)>,
    /// Share of the force's variance that this quantity explains on data it was not fitted to; NaN where not computed.
    pub r_squared: f64,
}

/// One estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScatterPoint {
    /// The quantity.
    pub x: f64,
    /// The force.
    pub y: f64,
    /// Its standard error.
    pub std_err: f64,
}

/// One hypothesis and its evidence; NaN where it was not carried so far.
#[derive(Debug, Clone, PartialEq)]
pub struct Hypothesis {
    /// Name of the effect.
    pub name: String,
    /// Place.
    pub place: String,
    /// Score of the screen: predicted fall of the cost Σr².
    pub screen_score: f64,
    /// Parameters that it may use.
    pub freedoms: usize,
    /// Share of the mismatch beyond the noise that the screen gives it.
    pub share: f64,
    /// Fall of the cost after the refit in full simulation.
    pub refit_fall: f64,
    /// Gain of the information criterion: fall of the cost less `freedoms` · ln N.
    pub bic_gain: f64,
    /// Fall of the cost by the whole chosen set where each run is predicted with numbers that the other runs give, to first order.
    pub held_back_gain: f64,
    /// What became of it.
    pub status: Status,
    /// Why, in words; may be empty.
    pub why: String,
}

/// What became of a hypothesis, in the order in which a reader wants to see them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Status {
    /// Part of the corrected model.
    Chosen,
    /// Explains the same data nearly as well.
    Rival,
    /// Refitted and rejected.
    Rejected,
    /// The screen gave it no chance.
    Screened,
}

impl Status {
    /// Its word for a reader.
    pub fn word(self) -> &'static str {
        match self {
            Self::Chosen => "chosen",
            Self::Rival => "rival",
            Self::Rejected => "rejected",
            Self::Screened => "not refitted",
        }
    }
}

/// A parameter of an effect that was chosen.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Name of the effect.
    pub effect: String,
    /// Its place.
    pub place: String,
    /// The parameter, with its component where it is a vector: `inertia zz`.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Estimate.
    pub value: f64,
    /// Value of the nominal model; NaN where it has none.
    pub nominal: f64,
    /// One standard error; infinite where the data do not show it.
    pub std_err: f64,
    /// 95 % interval, low and high.
    pub interval: (f64, f64),
    /// Whether the interval comes from a profile of the likelihood rather than from its curvature.
    pub from_profile: bool,
}

/// Autocorrelation of one channel's residual.
#[derive(Debug, Clone, PartialEq)]
pub struct Whiteness {
    /// The channel.
    pub channel: String,
    /// Lags, s, from the first after zero.
    pub lags_s: Vec<f64>,
    /// Autocorrelation under the nominal model.
    pub before: Vec<f64>,
    /// Under the corrected model; empty where nothing was corrected.
    pub after: Vec<f64>,
    /// White noise stays within ± this with 95 %.
    pub bound: f64,
}

/// A stage of the work.
#[derive(Debug, Clone, PartialEq)]
pub struct Stage {
    /// What was done.
    pub name: String,
    /// Wall-clock time, s.
    pub wall_s: f64,
    /// Seconds simulated in it.
    pub simulated_s: f64,
}

/// `bins` equal bins from `start` to `end`: their edges.
pub fn bin_edges(start: f64, end: f64, bins: usize) -> Vec<f64> {
    (0..=bins).map(|k| start + (end - start) * k as f64 / bins.max(1) as f64).collect()
}

/// Mean square of a residual per bin; NaN where a bin has no sample.
///
/// `samples`: (time, residual in units of noise) in the order of time; samples outside the edges and residuals that are NaN do not
/// count. The last bin has both its ends.
pub fn mean_squares(samples: impl IntoIterator<Item = (f64, f64)>, edges: &[f64]) -> Vec<f64> {
    let bins = edges.len().saturating_sub(1);
    let mut sums = vec![(0.0, 0_usize); bins];
    for (t, r) in samples {
        let bin = edges.partition_point(|edge| *edge <= t).saturating_sub(1);
        let bin = if edges.last().is_some_and(|end| t == *end) { bins.saturating_sub(1) } else { bin };
        let is_inside = edges.first().is_some_and(|start| t >= *start) && bin < bins;
        if is_inside && !r.is_nan() {
            sums[bin].0 += r * r;
            sums[bin].1 += 1;
        }
    }
    sums.into_iter().map(|(sum, count)| if count > 0 { sum / count as f64 } else { f64::NAN }).collect()
}

/// Autocorrelation of an evenly sampled residual at lags 1 to `lags`, about its mean; with the bound that white noise keeps with 95 %.
pub fn autocorrelation(residual: &[f64], lags: usize) -> (Vec<f64>, f64) {
    let count = residual.len().max(1) as f64;
    let mean = residual.iter().sum::<f64>() / count;
    let product = |lag: usize| -> f64 {
        let pairs = residual.iter().zip(residual.iter().skip(lag));
        pairs.map(|(a, b)| (a - mean) * (b - mean)).sum()
    };
    let variance = product(0);
    let at = |lag| if variance > 0.0 { product(lag) / variance } else { f64::NAN };
    ((1..=lags).map(at).collect(), 1.96 / count.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bin_has_the_mean_square_of_its_samples() {
        let edges = bin_edges(0.0, 3.0, 3);
        assert_eq!(edges, [0.0, 1.0, 2.0, 3.0]);
        let samples = [(-0.1, 9.0), (0.0, 1.0), (0.9, 3.0), (1.5, f64::NAN), (2.0, 2.0), (3.0, 4.0), (3.1, 9.0)];
        let squares = mean_squares(samples, &edges);
        assert_eq!((squares[0], squares[2]), (5.0, 10.0));
        assert!(squares[1].is_nan() && mean_squares(samples, &[]).is_empty());
    }

    #[test]
    fn an_alternating_residual_is_anticorrelated() {
        let residual: Vec<f64> = (0..1000).map(|k| if k % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let (correlation, bound) = autocorrelation(&residual, 2);
        assert!((correlation[0] + 0.999).abs() < 1e-9 && (correlation[1] - 0.998).abs() < 1e-9, "{correlation:?}");
        assert!((bound - 1.96 / 1000_f64.sqrt()).abs() < 1e-12);
        assert!(autocorrelation(&[0.0; 5], 1).0[0].is_nan());
    }
}
