//! One channel of one run: the instants where it was sampled, and what was read there.

use super::quantum::find_quantum;
use std::sync::Arc;

/// A channel with only the instants where it was sampled. Times strictly increase; values are finite and in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Name by the recording format, `joint.elbow.position`.
    pub channel: String,
    /// Instants, s; channels that are sampled together share them.
    pub times: Arc<[f64]>,
    /// Values; orientation components are those of a unit quaternion that does not flip.
    pub values: Vec<f64>,
    quantum: f64,
}

impl Series {
    /// A series whose written rounding is found from its values.
    pub fn new(channel: impl Into<String>, times: impl Into<Arc<[f64]>>, values: Vec<f64>) -> Self {
        let quantum = find_quantum(&values);
        Self::with_quantum(channel, times, values, quantum)
    }

    /// A series whose written rounding is known; it survives what is done to the values (units, normalisation).
    pub fn with_quantum(
        channel: impl Into<String>,
        times: impl Into<Arc<[f64]>>,
        values: Vec<f64>,
        quantum: f64,
    ) -> Self {
        Self { channel: channel.into(), times: times.into(), values, quantum }
    }

    /// The written rounding q, in the channel's unit; 0 where the values are continuous.
    ///
    /// It is the width for which q²/12 is the variance of the rounding: the decimal step of the file, or the step of the
    /// encoder where that is coarser (both: q² = q_encoder² + q_file²). Of a quaternion's component it is the step of
    /// that component; about an axis it is 2 q rad.
    pub fn quantum(&self) -> f64 {
        self.quantum
    }

    /// Standard deviation of what is read about what is true: √(σ² + q²/12), q in the unit of σ.
    pub fn sigma_with_rounding(&self, sigma: f64) -> f64 {
        let q = if self.channel.contains(".orientation.") { 2.0 * self.quantum } else { self.quantum };
        (sigma * sigma + q * q / 12.0).sqrt()
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Whether it was never sampled.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// Samples per second, from the median step; 0 with fewer than two samples.
    pub fn rate(&self) -> f64 {
        let step = self.median_step();
        if step > 0.0 { 1.0 / step } else { 0.0 }
    }

    /// Median time from sample to sample, s; 0 with fewer than two samples.
    pub fn median_step(&self) -> f64 {
        median_step(&self.times).unwrap_or(0.0)
    }
}

/// Median time from instant to instant, s; none of fewer than two.
pub fn median_step(times: &[f64]) -> Option<f64> {
    let mut steps: Vec<f64> = times.windows(2).map(|t| t[1] - t[0]).collect();
    let middle = steps.len() / 2;
    (!steps.is_empty()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1)
}
