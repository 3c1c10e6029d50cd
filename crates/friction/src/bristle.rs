//! The law and its derivative.
//!
//! With P = 1 − n nᵀ the projector on the plane (n is not needed: all vectors lie in it, so the derivative is given by
//! its action on them), K = k + c/τ and s⁺ the trial deflection:
//!
//!   stick   −∂f/∂s⁺ = K
//!   slip    −∂f/∂s⁺ = K (s_max/|s⁺|)(1 − ŝŝᵀ)                 turning only: along ŝ the force is at its bound
//!   where the damper overshoots the bound, f̂ takes ŝ's place and μ fₙ/|f_trial| multiplies.
//!
//! The dependence on fₙ is left out here: it is not symmetric, and a solver that re-solves sees it in the next pass.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// Parameters of the extended bristle law, SI. Neutral where it says so.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bristle {
    /// Level at rest, 1.
    pub mu_static: f64,
    /// Level in fast sliding, 1; neutral: equal to `mu_static`.
    pub mu_kinetic: f64,
    /// Speed over which the level falls (Stribeck), m/s; only its size against the slip speed counts.
    pub stribeck_speed: f64,
    /// Stiffness of one point's bristle, N/m.
    pub stiffness: f64,
    /// Damping of the bristle, N·s/m; neutral: 0.
    pub damping: f64,
    /// Viscous term outside the bound, N·s/m; neutral: 0.
    pub viscous: f64,
}

impl Default for Bristle {
    fn default() -> Self {
        Self { mu_static: 0.0, mu_kinetic: 0.0, stribeck_speed: 1e-3, stiffness: 1e5, damping: 0.0, viscous: 0.0 }
    }
}

/// A parameter out of its range.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionError {
    /// The parameter's name.
    pub parameter: &'static str,
    /// Its value.
    pub value: f64,
    /// What it must be.
    pub must_be: &'static str,
}

impl std::fmt::Display for FrictionError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "friction parameter {} = {} must be {}", self.parameter, self.value, self.must_be)
    }
}

impl std::error::Error for FrictionError {}

/// What one evaluation needs.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// Deflection at the start, carried into the present tangent plane, m.
    pub s: Vector3<f64>,
    /// Deflection if nothing slipped: `s` plus the tangential displacement of B's point relative to A's, m.
    pub s_trial: Vector3<f64>,
    /// Slip velocity of B relative to A, for the level and the viscous term, m/s.
    pub slip: Vector3<f64>,
    /// Time between the two deflections, s; positive.
    pub elapsed: f64,
    /// Normal force, N; nothing is transmitted where it is not positive.
    pub normal_force: f64,
}

/// What the brush answers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Brush {
    /// Force on B, N.
    pub force: Vector3<f64>,
    /// What becomes of the deflection, m; zero without normal force.
    pub s: Vector3<f64>,
    /// Whether it sticks.
    pub sticks: bool,
    /// −∂f/∂s⁺ is `tangent · (1 − d dᵀ)` within the plane, with `direction` = d (zero in sticking), N/m.
    pub tangent: f64,
    /// Direction in which the force is at its bound; zero in sticking.
    pub direction: Vector3<f64>,
}

impl Bristle {
    /// Checks every parameter's range.
    pub fn check(&self) -> Result<(), FrictionError> {
        let all = [
            ("mu_static", self.mu_static),
            ("mu_kinetic", self.mu_kinetic),
            ("damping", self.damping),
            ("viscous", self.viscous),
        ];
        for (parameter, value) in all {
            if !(value.is_finite() && value >= 0.0) {
                return Err(FrictionError { parameter, value, must_be: "finite and not negative" });
            }
        }
        for (parameter, value) in [("stiffness", self.stiffness), ("stribeck_speed", self.stribeck_speed)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(FrictionError { parameter, value, must_be: "finite and positive" });
            }
        }
        Ok(())
    }

    /// Friction level at a slip speed, m/s.
    #[inline]
    pub fn calc_level(&self, speed: f64) -> f64 {
        if self.mu_static == self.mu_kinetic {
            return self.mu_static;
        }
        let x = speed / self.stribeck_speed;
        self.mu_kinetic + (self.mu_static - self.mu_kinetic) * (-x * x).exp()
    }

    /// Largest deflection that a normal force (N) holds at a slip speed (m/s), m.
    #[inline]
    pub fn calc_reach(&self, normal_force: f64, speed: f64) -> f64 {
        self.calc_level(speed) * normal_force.max(0.0) / self.stiffness
    }

    /// Energy stored in a deflection, J.
    pub fn calc_stored_energy(&self, s: &Vector3<f64>) -> f64 {
        0.5 * self.stiffness * s.norm_squared()
    }

    /// The law: force, new deflection, and derivative.
    #[inline]
    pub fn eval(&self, trial: &Trial) -> Brush {
        if trial.normal_force <= 0.0 {
            return Brush {
                force: Vector3::zeros(),
                s: Vector3::zeros(),
                sticks: false,
                tangent: 0.0,
                direction: Vector3::zeros(),
            };
        }
        let bound = self.calc_level(trial.slip.norm()) * trial.normal_force;
        let s_max = bound / self.stiffness;
        let length = trial.s_trial.norm();
        let sticks = length <= s_max;
        let (s, shrink) =
            if sticks { (trial.s_trial, 1.0) } else { (trial.s_trial * (s_max / length), s_max / length) };
        let mut direction = if sticks { Vector3::zeros() } else { trial.s_trial / length };
        let mut tangent = (self.stiffness + self.damping / trial.elapsed) * shrink;
        // The damper sees what was left within the bound of now: the length that a falling bound takes away slips at the
        // tip. Counted as a rate of the bristle, it would push along the slip and give energy.
        let length_before = trial.s.norm();
        let before = if length_before > s_max { trial.s * (s_max / length_before) } else { trial.s };
        let mut force = -(self.stiffness * s + self.damping / trial.elapsed * (s - before));
        let size = force.norm();
        if size > bound && self.damping > 0.0 {
            direction = force / size;
            tangent *= bound / size;
            force = direction * bound;
        }
        Brush { force: force - self.viscous * trial.slip, s, sticks, tangent, direction }
    }
}

/// What the law says in continuous time, for integrators that take rates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BrushRate {
    /// Force on B, N.
    pub force: Vector3<f64>,
    /// The deflection within what the normal force holds, m.
    pub s: Vector3<f64>,
    /// Its rate, m/s: the slip velocity, without the part that would lengthen a bristle on its bound.
    pub s_rate: Vector3<f64>,
    /// Whether it sticks.
    pub sticks: bool,
}

/// How near the bound counts as on it: with a strict comparison round-off would choose the branch.
const ON_BOUND: f64 = 1.0 - 1e-9;

impl Bristle {
    /// The law in continuous time at the deflection `s` (m), slip velocity (m/s) and normal force (N).
    pub fn eval_rate(&self, s: &Vector3<f64>, slip: &Vector3<f64>, normal_force: f64) -> BrushRate {
        if normal_force <= 0.0 {
            let zero = Vector3::zeros();
            return BrushRate { force: zero, s: zero, s_rate: zero, sticks: false };
        }
        let bound = self.calc_level(slip.norm()) * normal_force;
        let (s_max, length) = (bound / self.stiffness, s.norm());
        let s = if length > s_max { s * (s_max / length) } else { *s };
        let outward = s.dot(slip);
        let slides = length >= s_max * ON_BOUND && outward > 0.0;
        let s_rate = if slides { slip - s * (outward / s.norm_squared()) } else { *slip };
        let mut force = -(self.stiffness * s + self.damping * s_rate);
        let size = force.norm();
        if size > bound {
            force *= bound / size;
        }
        BrushRate { force: force - self.viscous * slip, s, s_rate, sticks: !slides }
    }
}

impl Brush {
    /// −∂f/∂s⁺ as a matrix, N/m, in the plane normal to `n`.
    #[inline]
    pub fn calc_tangent_matrix(&self, n: &Vector3<f64>) -> Matrix3<f64> {
        self.tangent * (Matrix3::identity() - n * n.transpose() - self.direction * self.direction.transpose())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: Bristle =
        Bristle { mu_static: 0.5, mu_kinetic: 0.3, stribeck_speed: 0.01, stiffness: 1e4, damping: 5.0, viscous: 2.0 };

    fn trial(s: Vector3<f64>, ds: Vector3<f64>) -> Trial {
        Trial { s, s_trial: s + ds, slip: ds / 1e-3, elapsed: 1e-3, normal_force: 20.0 }
    }

    #[test]
    fn sliding_force_is_the_level_against_the_motion() {
        let law = Bristle { damping: 0.0, viscous: 0.0, ..LAW };
        let s = Vector3::new(law.calc_reach(20.0, 1.0), 0.0, 0.0);
        let brush = law.eval(&trial(s, Vector3::new(1e-3, 0.0, 0.0)));
        assert!(!brush.sticks);
        // Round-off of a product.
        assert!((brush.force - Vector3::new(-0.3 * 20.0, 0.0, 0.0)).norm() < 1e-13);
    }

    #[test]
    fn sticking_force_is_the_spring_and_its_damper() {
        let brush = LAW.eval(&trial(Vector3::new(1e-4, 0.0, 0.0), Vector3::new(0.0, 1e-6, 0.0)));
        assert!(brush.sticks);
        let expected = -Vector3::new(1.0, 1e-2 + 5e-3 + 2e-3, 0.0);
        assert!((brush.force - expected).norm() < 1e-13);
    }

    #[test]
    fn a_falling_normal_force_shortens_the_bristle_and_gives_no_energy() {
        let s = Vector3::new(9e-4, 0.0, 0.0);
        let brush = LAW.eval(&Trial { normal_force: 5.0, ..trial(s, Vector3::zeros()) });
        assert!(LAW.calc_stored_energy(&brush.s) < LAW.calc_stored_energy(&s));
        assert!(brush.force.norm() <= 0.5 * 5.0 + 1e-12);
    }

    #[test]
    fn without_normal_force_nothing_is_left() {
        let brush = LAW.eval(&Trial { normal_force: 0.0, ..trial(Vector3::x() * 1e-4, Vector3::zeros()) });
        assert_eq!((brush.force, brush.s), (Vector3::zeros(), Vector3::zeros()));
    }

    #[test]
    fn derivative_is_exact_in_stick_and_in_slip() {
        let law = Bristle { mu_kinetic: 0.5, damping: 0.0, viscous: 0.0, ..LAW };
        for ds in [Vector3::new(1e-5, 2e-5, 0.0), Vector3::new(2e-3, 1e-3, 0.0)] {
            let at = trial(Vector3::new(1e-4, -2e-4, 0.0), ds);
            let matrix = law.eval(&at).calc_tangent_matrix(&Vector3::z());
            for k in 0..2 {
                let e = Vector3::ith(k, 1e-9);
                let (up, down) = (
                    law.eval(&Trial { s_trial: at.s_trial + e, ..at }).force,
                    law.eval(&Trial { s_trial: at.s_trial - e, ..at }).force,
                );
                // Central difference over 2 nm at forces of a few N: round-off 1e-15/1e-9, relative to k = 1e4 N/m.
                assert!(((down - up) / 2e-9 - matrix.column(k)).norm() < 1e-2);
            }
        }
    }

    #[test]
    fn impossible_parameters_are_named() {
        let bad = Bristle { stiffness: 0.0, ..LAW };
        assert_eq!(bad.check().expect_err("zero stiffness").parameter, "stiffness");
        let bad = Bristle { mu_static: f64::NAN, ..LAW };
        assert_eq!(bad.check().expect_err("NaN level").parameter, "mu_static");
    }
}
