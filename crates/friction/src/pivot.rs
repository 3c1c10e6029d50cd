//! Resistance of a single point to spinning and rolling: what a patch would resist, lumped.
//!
//!   spin     |m_n| ≤ r fₙ     about the normal;   r: for a disc of radius R under even pressure, pure spin, (2/3) μ R
//!   rolling  |m_t| ≤ b fₙ     in the plane;       b: the lever of rolling resistance (Coulomb)
//!
//! Each is a bristle of its own whose deflection is an angle. A lumped law knows nothing of how sliding takes spin
//! resistance away (Contensou 1963): where that matters, let several points of a patch carry the load.

use crate::bristle::Bristle;
use crate::trial::{FrictionError, Slope, Trial, check_not_negative, check_positive};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Parameters, SI. Neutral: both levers zero.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pivot {
    /// Lever r of spinning, m.
    pub spin_lever: f64,
    /// Lever b of rolling, m.
    pub rolling_lever: f64,
    /// Stiffness of both angular bristles, N·m/rad.
    pub stiffness: f64,
    /// Their damping, N·m·s/rad.
    pub damping: f64,
}

/// What one evaluation needs.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// Angular deflection at the start, rad: spin along the normal, rolling in the plane.
    pub start: Vector3<f64>,
    /// The same if nothing slipped.
    pub trial: Vector3<f64>,
    /// Unit normal.
    pub normal: Vector3<f64>,
    /// Time between the two, s; positive.
    pub elapsed: f64,
    /// Normal force, N.
    pub normal_force: f64,
}

/// What a pivot answers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PivotMoment {
    /// Moment on B, N·m.
    pub moment: Vector3<f64>,
    /// What becomes of the angular deflection, rad.
    pub turn: Vector3<f64>,
    /// −∂m/∂(turn) along the normal, N·m/rad.
    pub spin_slope: f64,
    /// The same in the plane.
    pub rolling_slope: Slope,
}

impl Pivot {
    /// Checks every parameter's range.
    pub fn check(&self) -> Result<(), FrictionError> {
        check_not_negative(&[
            ("spin_lever", self.spin_lever),
            ("rolling_lever", self.rolling_lever),
            ("damping", self.damping),
        ])?;
        check_positive(&[("stiffness", self.stiffness)])
    }

    fn bristle(&self, lever: f64) -> Bristle {
        Bristle {
            mu_static: lever,
            mu_kinetic: lever,
            stiffness: self.stiffness,
            damping: self.damping,
            ..Bristle::default()
        }
    }

    /// The law: moment, new angular deflection, and derivatives.
    pub fn eval(&self, turn: &Turn) -> PivotMoment {
        let n = turn.normal;
        let split = |v: &Vector3<f64>| (n * n.dot(v), v - n * n.dot(v));
        let ((s_spin, s_roll), (t_spin, t_roll)) = (split(&turn.start), split(&turn.trial));
        let ask = |lever: f64, s: Vector3<f64>, s_trial: Vector3<f64>| {
            let Turn { elapsed, normal_force, .. } = *turn;
            self.bristle(lever).eval(&Trial { s, s_trial, elapsed, normal_force, ..Trial::default() })
        };
        let (spin, roll) = (ask(self.spin_lever, s_spin, t_spin), ask(self.rolling_lever, s_roll, t_roll));
        PivotMoment {
            moment: spin.force + roll.force,
            turn: spin.s + roll.s,
            // One-dimensional: on its bound it does not change any more.
            spin_slope: if spin.by_deflection.direction == Vector3::zeros() { spin.by_deflection.across } else { 0.0 },
            rolling_slope: roll.by_deflection,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spin_and_rolling_are_held_up_to_their_levers() {
        let law = Pivot { spin_lever: 0.01, rolling_lever: 0.002, stiffness: 5.0, damping: 0.0 };
        let ask = |trial: Vector3<f64>| {
            law.eval(&Turn { start: Vector3::zeros(), trial, normal: Vector3::z(), elapsed: 1e-3, normal_force: 10.0 })
        };
        let held = ask(Vector3::new(0.001, 0.0, 0.01));
        assert_eq!(held.moment, Vector3::new(-0.005, 0.0, -0.05));
        let slips = ask(Vector3::new(0.0, 1.0, -1.0));
        assert!((slips.moment - Vector3::new(0.0, -0.02, 0.1)).norm() < 1e-15);
        assert_eq!(slips.spin_slope, 0.0);
    }
}
