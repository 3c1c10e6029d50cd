//! LuGre, Dahl and elasto-plastic friction, for comparison: one bristle whose deflection relaxes as it is dragged.
//!
//!   ż = u − α(z, u) (σ₀ |u| / (μ(u) fₙ)) z,      f = −(σ₀ z + σ₁ ż + σ₂ u)
//!
//! | law | α | σ₁, σ₂, μ |
//! | --- | --- | --- |
//! | LuGre (Canudas de Wit, Olsson, Åström and Lischinsky 1995) | 1 | free |
//! | Dahl (Dahl 1968, exponent 1) | 1 | 0, 0, constant |
//! | elasto-plastic (Dupont, Hayward, Armstrong and Altpeter 2002) | 0 below a break-away deflection, rising to 1 at the bound | free |
//!
//! With α = 1 the deflection relaxes with every motion, also below breakaway: under a load that oscillates about a mean, the
//! body drifts. In discrete time the rate is taken implicitly, for z' = (z + Δ)/(1 + α σ₀ |Δ|/(μ fₙ)), Δ the displacement.

use crate::levels::Levels;
use crate::trial::{Brush, BrushRate, FrictionError, Slope, Trial, check_not_negative, check_positive};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Parameters, SI.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LuGre {
    /// Level in slow sliding, 1.
    pub mu_static: f64,
    /// Level in fast sliding, 1; neutral: equal to `mu_static`.
    pub mu_kinetic: f64,
    /// Speed over which the level falls (Stribeck), m/s.
    pub stribeck_speed: f64,
    /// σ₀, N/m.
    pub stiffness: f64,
    /// σ₁, N·s/m.
    pub damping: f64,
    /// σ₂, N·s/m.
    pub viscous: f64,
    /// Deflection below which nothing relaxes, as a share of the bound's, from 0 (LuGre, Dahl) to below 1 (elasto-plastic).
    pub break_away: f64,
}

impl LuGre {
    /// Dahl's law.
    pub fn dahl(mu: f64, stiffness: f64) -> Self {
        Self {
            mu_static: mu,
            mu_kinetic: mu,
            stribeck_speed: 1e-3,
            stiffness,
            damping: 0.0,
            viscous: 0.0,
            break_away: 0.0,
        }
    }

    /// Checks every parameter's range.
    pub fn check(&self) -> Result<(), FrictionError> {
        check_not_negative(&[
            ("mu_static", self.mu_static),
            ("mu_kinetic", self.mu_kinetic),
            ("damping", self.damping),
            ("viscous", self.viscous),
            ("break_away", self.break_away),
        ])?;
        if self.break_away >= 1.0 {
            return Err(FrictionError { parameter: "break_away", value: self.break_away, must_be: "below 1" });
        }
        check_positive(&[("stiffness", self.stiffness), ("stribeck_speed", self.stribeck_speed)])
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

    /// α: how much of the relaxation acts at a deflection that moves along `way`.
    fn calc_relaxation(&self, z: &Vector3<f64>, way: &Vector3<f64>, bound: f64) -> f64 {
        if self.break_away == 0.0 {
            return 1.0;
        }
        let (length, reach) = (z.norm(), bound / self.stiffness);
        let free = self.break_away * reach;
        if length <= free || z.dot(way) <= 0.0 {
            return 0.0;
        }
        if length >= reach {
            return 1.0;
        }
        0.5 + 0.5 * (PI * (length - 0.5 * (reach + free)) / (reach - free)).sin()
    }

    fn calc_bound(&self, trial: &Trial) -> f64 {
        let levels = self.levels();
        levels.at(levels.calc_rest(1.0, trial.slip.norm(), 0.0)) * trial.normal_force
    }

    /// The law.
    pub fn eval(&self, trial: &Trial) -> Brush {
        let bound = self.calc_bound(trial);
        if trial.normal_force <= 0.0 || bound <= 0.0 {
            let force = if trial.normal_force > 0.0 { -self.viscous * trial.slip } else { Vector3::zeros() };
            return Brush { force, ..Brush::default() };
        }
        let moved = trial.s_trial - trial.s;
        let way = moved.norm();
        let relax = self.calc_relaxation(&trial.s_trial, &moved, bound) * self.stiffness / bound;
        let divisor = 1.0 + relax * way;
        let z = trial.s_trial / divisor;
        let rate = self.damping / trial.elapsed;
        let direction = if way > 0.0 { moved / way } else { Vector3::zeros() };
        let across = (self.stiffness + rate) / divisor;
        let along = across * (1.0 - relax * z.dot(&direction)).max(0.0);
        Brush {
            force: -(self.stiffness * z + rate * (z - trial.s) + self.viscous * trial.slip),
            s: z,
            rest: 1.0,
            sticks: false,
            by_deflection: Slope { across, along, direction },
            by_slip: Slope::even(self.viscous),
        }
    }

    /// The law in continuous time.
    pub fn eval_rate(&self, trial: &Trial) -> BrushRate {
        let bound = self.calc_bound(trial);
        if trial.normal_force <= 0.0 || bound <= 0.0 {
            return BrushRate::none();
        }
        let (z, u) = (trial.s, trial.slip);
        let relax = self.calc_relaxation(&z, &u, bound) * self.stiffness / bound;
        let s_rate = u - z * (relax * u.norm());
        BrushRate {
            force: -(self.stiffness * z + self.damping * s_rate + self.viscous * u),
            s: z,
            s_rate,
            sticks: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(break_away: f64) -> LuGre {
        LuGre { damping: 3.0, viscous: 0.5, break_away, ..LuGre::dahl(0.4, 1e4) }
    }

    fn drag(law: &LuGre, way: f64, steps: usize) -> Brush {
        let (mut s, mut brush) = (Vector3::zeros(), Brush::default());
        for _ in 0..steps {
            let moved = Vector3::x() * (way / steps as f64);
            let trial = Trial { s, s_trial: s + moved, normal_force: 10.0, elapsed: 1.0, ..Trial::default() };
            brush = law.eval(&trial);
            s = brush.s;
        }
        brush
    }

    /// Dahl dragged from zero: z = z_max (1 − exp(−x/z_max)), here with z_max = 0.4 mm.
    #[test]
    fn dahl_relaxes_exponentially_with_the_way() {
        let brush = drag(&LuGre::dahl(0.4, 1e4), 3e-4, 20_000);
        let expected = -4.0 * (1.0 - (-0.75_f64).exp());
        // First order in the step: 3e-4/20,000 of 4e-4.
        assert!((brush.force.x - expected).abs() < 1e-4, "{} {expected}", brush.force.x);
    }

    #[test]
    fn elasto_plastic_is_a_spring_up_to_its_break_away() {
        let brush = drag(&LuGre { damping: 0.0, ..law(0.7) }, 2.7e-4, 100);
        assert!((brush.force.x + 2.7).abs() < 1e-12);
    }

    #[test]
    fn dragged_far_it_holds_its_level() {
        for break_away in [0.0, 0.7] {
            let brush = drag(&law(break_away), 0.1, 100_000);
            assert!((brush.force.x + 4.0).abs() < 1e-2, "{}", brush.force.x);
        }
    }

    #[test]
    fn impossible_parameters_are_named() {
        assert_eq!(law(1.0).check().expect_err("never breaks away").parameter, "break_away");
    }
}
