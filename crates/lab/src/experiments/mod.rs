//! One file per experiment; the order here is the order of the report.

mod incline;

use crate::Experiment;

/// All experiments, in the order of the report.
pub fn catalogue() -> Vec<Experiment> {
    vec![incline::EXPERIMENT, crate::real::entry_tosses::EXPERIMENT, crate::real::entry_fretting::EXPERIMENT]
}
