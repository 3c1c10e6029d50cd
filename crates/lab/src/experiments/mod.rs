//! One file per experiment; the order here is the order of the report.

mod bouncing_sphere;
mod force_balance;
mod incline;
mod integrators;
mod pinch_hold;
mod rolling_ball;
mod sliding_paths;
mod smooth_sliding;
mod wedging_peg;

use crate::Experiment;

/// All experiments, in the order of the report.
pub fn catalogue() -> Vec<Experiment> {
    vec![
        incline::EXPERIMENT,
        bouncing_sphere::EXPERIMENT,
        rolling_ball::EXPERIMENT,
        wedging_peg::EXPERIMENT,
        pinch_hold::EXPERIMENT,
        force_balance::EXPERIMENT,
        smooth_sliding::EXPERIMENT,
        integrators::EXPERIMENT,
    ]
}
