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

/// ε: share of the limit over which the effort falls. Smaller ones cost digits of the work (10⁻¹⁶/ε), larger ones hold
/// the limit less sharply.
pub(crate) const FALL: f64 = 1e-6;

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
