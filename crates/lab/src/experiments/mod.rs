//! One file per experiment; the order here is the order of the report.

mod anisotropy;
mod disc;
mod dwell;
mod incline;
mod oscillating;
mod peers;
mod slider_circle;
mod slider_l;
mod slider_line;
mod stick_slip;

use crate::Experiment;

/// All experiments, in the order of the report.
pub fn catalogue() -> Vec<Experiment> {
    vec![
        incline::EXPERIMENT,
        slider_line::EXPERIMENT,
        slider_l::EXPERIMENT,
        slider_circle::EXPERIMENT,
        stick_slip::EXPERIMENT,
        dwell::EXPERIMENT,
        disc::EXPERIMENT,
        oscillating::EXPERIMENT,
        anisotropy::EXPERIMENT,
        crate::real::entry_tosses::EXPERIMENT,
        crate::real::entry_fretting::EXPERIMENT,
    ]
}
