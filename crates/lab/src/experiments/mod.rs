//! One file per experiment; the order here is the order of the report.

mod anisotropy;
mod bouncing_sphere;
mod disc;
mod dwell;
mod force_balance;
mod incline;
mod integrators;
mod oscillating;
mod peers;
mod pinch_hold;
mod rolling_ball;
mod slider_circle;
mod slider_l;
mod slider_line;
mod sliding_docking;
mod sliding_paths;
mod smooth_sliding;
mod stick_slip;
mod wedging_peg;

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
        bouncing_sphere::EXPERIMENT,
        rolling_ball::EXPERIMENT,
        wedging_peg::EXPERIMENT,
        pinch_hold::EXPERIMENT,
        force_balance::EXPERIMENT,
        smooth_sliding::EXPERIMENT,
        integrators::EXPERIMENT,
        crate::real::entry_tosses::EXPERIMENT,
        crate::real::entry_fretting::EXPERIMENT,
    ]
}
