//! Regularised Coulomb friction, for comparison: a smooth curve in place of the jump, without memory.
//!
//!   f = −μ(u) fₙ u / √(u² + v_d²) − b u
//!
//! Under a load below μ fₙ it does not stick: it slides at u = v_d x/√(1 − x²), with x the load over μ fₙ. That creep is the
//! price of every law whose force depends on the slip velocity alone.

use crate::levels::Levels;
use crate::trial::{Brush, BrushRate, FrictionError, Slope, Trial, check_not_negative, check_positive};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Parameters, SI.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RegularisedCoulomb {
    /// Level in slow sliding, 1.
    pub mu_static: f64,
    /// Level in fast sliding, 1; neutral: equal to `mu_static`.
    pub mu_kinetic: f64,
    /// Speed over which the level falls (Stribeck), m/s.
    pub stribeck_speed: f64,
    /// Speed v_d at which the force has 1/√2 of its level, m/s.
    pub transition_speed: f64,
    /// Viscous term, N·s/m; neutral: 0.
    pub viscous: f64,
}

impl RegularisedCoulomb {
    /// Checks every parameter's range.
    pub fn check(&self) -> Result<(), FrictionError> {
        check_not_negative(&[
            ("mu_static", self.mu_static),
            ("mu_kinetic", self.mu_kinetic),
            ("viscous", self.viscous),
        ])?;
        check_positive(&[("transition_speed", self.transition_speed), ("stribeck_speed", self.stribeck_speed)])
    }

    fn levels(&self) -> Levels {
        Levels {
            rested: self.mu_static,
            kinetic: self.mu_kinetic,
            stribeck_speed: self.stribeck_speed,
            dwell_time: 0.0,
            fall_time: 0.0,
        }
    }

    /// The law.
    pub fn eval(&self, trial: &Trial) -> Brush {
        if trial.normal_force <= 0.0 {
            return Brush::default();
        }
        let (levels, u) = (self.levels(), trial.slip.norm());
        let bound = levels.at(levels.calc_rest(1.0, u, 0.0)) * trial.normal_force;
        let width = u.hypot(self.transition_speed);
        let fall = levels.calc_slope(u) * trial.normal_force * u / width;
        let by_slip = Slope {
            across: bound / width + self.viscous,
            along: bound * self.transition_speed.powi(2) / width.powi(3) + fall + self.viscous,
            direction: if u > 0.0 { trial.slip / u } else { Vector3::zeros() },
        };
        let force = -(bound / width + self.viscous) * trial.slip;
        Brush { force, by_slip, ..Brush::default() }
    }

    /// The law in continuous time.
    pub fn eval_rate(&self, trial: &Trial) -> BrushRate {
        BrushRate { force: self.eval(trial).force, ..BrushRate::none() }
    }
}
