//! The speed at which a motor stops pushing: a reaction wheel's limit, a joint's velocity limit.
//!
//!   τ = τ_asked · clamp((L − s v')/(ε L), 0, 1),   s = sign τ_asked,   v': the coordinate's rate at the step's end
//!
//! A motor at its limit gives nothing further in the direction in which it turns, and all that it has in the other: it is no
//! brake, so that what carries the coordinate beyond L (the bus of a wheel that is struck) is not held back. The fall over
//! ε L stands for the jump; with the rate taken at the step's *end* it is stiff and harmless: a step that would pass L
//! ends within ε L of it, whatever the step and the inertia, and one that is not stopped does not feel the limit at all.
//!
//! The line of a pass may go on where the law has a corner: from full effort to none, a pass goes by the fall between
//! them, else the passes would jump between both for ever. Runge–Kutta takes v' = v + h v̇ with v the rate at the step's
//! start, so that each stage, and therefore their mean, ends at L; its accelerations answer to the fall by one more solve.

use crate::actuator::CoordinatePoint;
use crate::effect::Acting;
use crate::model::Model;
use crate::state::State;
use crate::workspace::Workspace;

/// ε: share of the limit over which the effort falls. Smaller ones cost digits of the work (10⁻¹⁶/ε), larger ones hold
/// the limit less sharply.
const FALL: f64 = 1e-6;

/// Which branch of the law a line follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Branch {
    /// All that is asked.
    Full,
    /// Falling towards the limit.
    Falling,
    /// Nothing: the limit is reached or passed.
    Spent,
}

/// What a limit leaves of an effort.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limited {
    pub effort: f64,
    /// −∂/∂v' by what was asked.
    pub slope: f64,
    /// −∂/∂v' by the fall, v' the rate at the step's end.
    pub fall: f64,
    pub branch: Branch,
}

/// What a speed limit leaves of an effort and its slope at the rate `end`, on the branch next to the last line's.
pub(crate) fn apply(limit: f64, asked: (f64, f64), end: f64, before: Option<Branch>) -> Limited {
    let (effort, slope) = asked;
    let share = (limit - effort.signum() * end) / (FALL * limit);
    if effort == 0.0 || share.is_nan() {
        return Limited { effort, slope, fall: 0.0, branch: Branch::Full };
    }
    let branch = match (share, before) {
        (share, Some(Branch::Spent)) if share >= 1.0 => Branch::Falling,
        (share, Some(Branch::Full)) if share <= 0.0 => Branch::Falling,
        (share, _) if share >= 1.0 => Branch::Full,
        (share, _) if share <= 0.0 => Branch::Spent,
        _ => Branch::Falling,
    };
    match branch {
        Branch::Full => Limited { effort, slope, fall: 0.0, branch },
        Branch::Spent => Limited { effort: 0.0, slope: 0.0, fall: 0.0, branch },
        Branch::Falling => {
            let fall = effort.abs() / (FALL * limit);
            Limited { effort: effort * share, slope: slope * share.clamp(0.0, 1.0), fall, branch }
        }
    }
}

/// Whether a rate is so far below a limit that the line at full effort stands.
fn is_far(limit: f64, point: &CoordinatePoint, rate: f64) -> bool {
    point.branch == Some(Branch::Full) && rate.abs() < (1.0 - FALL) * limit
}

/// Checks the limits at the solution of a scheme that checks no other law; where one was passed, draws a new line.
pub(crate) fn hold_in_step(model: &Model, state: &State, ws: &mut Workspace) -> bool {
    let mut hold = true;
    for &i in &model.speed_limited {
        let (v_new, (effort, slope)) = (state.v[i] + ws.v_gain[i], ws.coordinate_lines[i]);
        if is_far(model.coordinates[i].speed_limit, &ws.coordinate_points[i], v_new) {
            continue;
        }
        let acting = Acting { model, state, step: ws.step, since: None };
        let law = model.coordinates[i].eval(&ws.coordinate_points[i], v_new, &acting);
        if ws.coordinate_points[i].branch != law.branch {
            ws.coordinate_points[i].branch = law.branch;
            hold = false;
        }
        ws.coordinate_forces[i] = crate::actuator::CoordinateForce { effort: effort - slope * ws.v_gain[i], ..law };
        ws.coordinate_lines[i] = (law.effort + law.slope * ws.v_gain[i], law.slope);
    }
    hold
}

/// The same at a stage of Runge–Kutta, whose gains are accelerations.
pub(crate) fn hold_at_stage(model: &Model, state: &State, ws: &mut Workspace, v_start: &[f64]) -> bool {
    let mut hold = true;
    for &i in &model.speed_limited {
        let end = v_start[i] + ws.step * ws.v_gain[i];
        if is_far(model.coordinates[i].speed_limit, &ws.coordinate_points[i], end) {
            continue;
        }
        let before = ws.coordinate_points[i].branch;
        let point = CoordinatePoint { end: Some(end), ..ws.coordinate_points[i] };
        let acting = Acting { model, state, step: ws.step, since: ws.since };
        let law = model.coordinates[i].eval(&point, state.v[i], &acting);
        let slope = ws.step * law.fall;
        ws.coordinate_forces[i] = law;
        ws.coordinate_lines[i] = (law.effort + slope * ws.v_gain[i], slope);
        ws.coordinate_points[i] = CoordinatePoint { branch: law.branch, ..point };
        hold &= law.branch == before;
    }
    hold
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motor_pushes_fully_below_its_limit_and_not_at_all_beyond_in_that_direction_alone() {
        let at = |effort: f64, end: f64| apply(50.0, (effort, 0.0), end, None).effort;
        assert_eq!((at(0.2, 49.9), at(0.2, 50.0), at(0.2, 70.0)), (0.2, 0.0, 0.0));
        assert_eq!((at(-0.2, 49.9), at(-0.2, 50.0), at(-0.2, 70.0)), (-0.2, -0.2, -0.2), "it brakes with all it has");
        assert_eq!((at(-0.2, -49.9), at(-0.2, -50.0), at(0.2, -50.0)), (-0.2, 0.0, 0.2));
        assert_eq!(apply(f64::INFINITY, (0.2, 0.1), 1e9, None).effort, 0.2, "no limit, no fall");
    }

    #[test]
    fn half_way_down_the_fall_half_is_left_and_the_slope_is_that_of_the_line() {
        let half = apply(50.0, (0.2, 0.0), 50.0 * (1.0 - 0.5 * FALL), None);
        // Round-off of 50 over the fall's width.
        assert!((half.effort - 0.1).abs() < 0.2 * 1e-9, "{}", half.effort);
        assert!((half.fall - 0.2 / (50.0 * FALL)).abs() < 1e-9 * half.fall);
    }

    #[test]
    fn a_pass_that_jumps_over_the_fall_is_led_along_it() {
        let beyond = apply(50.0, (0.2, 0.0), 51.0, Some(Branch::Full));
        assert_eq!(beyond.branch, Branch::Falling);
        assert!(beyond.effort < 0.0, "the line of the fall goes on");
        assert_eq!(apply(50.0, (0.2, 0.0), 51.0, Some(Branch::Falling)).branch, Branch::Spent);
        assert_eq!(apply(50.0, (0.2, 0.0), 40.0, Some(Branch::Spent)).branch, Branch::Falling);
    }
}
