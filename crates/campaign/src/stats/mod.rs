//! Statistics of campaigns: intervals of rates and means, quantiles, correlation, shares of variance, paired
//! comparison.
//!
//! Every interval is a 95 % interval, every p-value two-sided. Nothing here draws random numbers, except the
//! permutations of [`share_of_variance`], whose seed is fixed: the same table gives the same bits.
//!
//! Functions return `None` where there are too few values, or where the values do not vary, instead of NaN.

mod paired;
mod quantile;
mod rank;
mod rate;
mod sample;
mod share;
mod two_samples;

pub use paired::{McNemar, difference_of_paired_rates, holm, runs_needed};
pub use quantile::{beta_quantile, normal_quantile, t_quantile, two_sided_t};
pub use rank::{Correlation, ranks, spearman, spearman_of_ranks};
pub use rate::{Rate, wilson};
pub use sample::{Moments, mean_interval, quantile, sorted};
pub use share::{Noise, Parting, class_count, share_of_variance};
pub use two_samples::{Distance, kolmogorov_smirnov};

use serde::Serialize;

/// Level of all intervals.
pub const LEVEL: f64 = 0.95;

/// An interval, ends included.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Interval {
    /// Whether zero lies outside.
    pub fn excludes_zero(&self) -> bool {
        self.low > 0.0 || self.high < 0.0
    }
}
