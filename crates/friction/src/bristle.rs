//! The extended bristle law and its derivative.
//!
//! With P = 1 − n nᵀ the projector on the plane (n is not needed: all vectors lie in it, so the derivative is given by
//! its action on them), K = k + c/τ and s⁺ the trial deflection:
//!
//!   stick   −∂f/∂s⁺ = K
//!   slip    −∂f/∂s⁺ = K (s_max/|s⁺|)(1 − ŝŝᵀ)                 turning only: along ŝ the force is at its bound
//!   where the damper overshoots the bound, f̂ takes ŝ's place and μ fₙ/|f_trial| multiplies.
//!
//! On an ellipse 1/√q takes the place of s_max/|s⁺|; what a turn changes of the length there, and the dependence on fₙ, are
//! left out: they are not symmetric, and a solver that re-solves sees them in the next pass.

use crate::ellipse::{Ellipse, Held};
use crate::levels::Levels;
use crate::trial::{Brush, BrushRate, FrictionError, Slope, Trial, check_not_negative, check_positive, is_zero};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Parameters of the extended bristle law, SI. Neutral where it says so.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bristle {
    /// Level at rest, 1.
    pub mu_static: f64,
    /// Level in fast sliding, 1; neutral: equal to `mu_static`.
    pub mu_kinetic: f64,
    /// Speed over which the level falls (Stribeck), m/s; zero: it drops where the bristle breaks away.
    pub stribeck_speed: f64,
    /// Time constant with which the static level returns at rest, s; neutral: 0.
    pub dwell_time: f64,
    /// Time constant with which rest is lost in sliding, s, where there is a dwell time and a Stribeck speed; zero: at once.
    pub fall_time: f64,
    /// Level across the grain over that along it; neutral: 1. In steady sliding the force opposes the velocity, at the
    /// level of its direction: 1/μ(φ)² = cos²φ/μ₁² + sin²φ/μ₂².
    pub across: f64,
    /// Stiffness of one point's bristle, N/m.
    pub stiffness: f64,
    /// Damping of the bristle, N·s/m; neutral: 0.
    pub damping: f64,
    /// Viscous term outside the bound, N·s/m; neutral: 0.
    pub viscous: f64,
}

impl Default for Bristle {
    fn default() -> Self {
        Self {
            mu_static: 0.0,
            mu_kinetic: 0.0,
            stribeck_speed: 1e-3,
            dwell_time: 0.0,
            fall_time: 0.0,
            across: 1.0,
            stiffness: 1e5,
            damping: 0.0,
            viscous: 0.0,
        }
    }
}

impl Bristle {
    /// Checks every parameter's range.
    pub fn check(&self) -> Result<(), FrictionError> {
        check_not_negative(&[
            ("mu_static", self.mu_static),
            ("mu_kinetic", self.mu_kinetic),
            ("stribeck_speed", self.stribeck_speed),
            ("dwell_time", self.dwell_time),
            ("fall_time", self.fall_time),
            ("across", self.across),
            ("damping", self.damping),
            ("viscous", self.viscous),
        ])?;
        check_positive(&[("stiffness", self.stiffness)])
    }

    /// Its levels.
    #[inline]
    pub fn levels(&self) -> Levels {
        Levels {
            rested: self.mu_static,
            kinetic: self.mu_kinetic,
            stribeck_speed: self.stribeck_speed,
            dwell_time: self.dwell_time,
            fall_time: self.fall_time,
        }
    }

    /// Rest of a contact that has just begun.
    #[inline]
    pub(crate) fn initial_rest(&self) -> f64 {
        if self.dwell_time == 0.0 { 1.0 } else { 0.0 }
    }

    /// Largest deflection along the grain that a normal force (N) holds at a rest, m.
    #[inline]
    pub fn calc_reach(&self, normal_force: f64, rest: f64) -> f64 {
        self.levels().at(rest) * normal_force.max(0.0) / self.stiffness
    }

    /// Energy stored in a deflection, J.
    pub fn calc_stored_energy(&self, s: &Vector3<f64>) -> f64 {
        0.5 * self.stiffness * s.norm_squared()
    }

    #[inline]
    pub(crate) fn ellipse(&self, level: f64, normal_force: f64, grain: &Vector3<f64>) -> Ellipse {
        let along = level * normal_force / self.stiffness;
        Ellipse { along, across: along * self.across, grain: *grain }
    }

    /// The law: force, new deflection and rest, and derivatives.
    #[inline]
    pub fn eval(&self, trial: &Trial) -> Brush {
        let levels = self.levels();
        if trial.normal_force <= 0.0 {
            return Brush { rest: levels.initial_rest(), ..Brush::default() };
        }
        let speed = if levels.is_constant() { 0.0 } else { trial.slip.norm() };
        let mut rest = levels.calc_rest(trial.rest, speed, trial.elapsed);
        let mut bound = self.ellipse(levels.at(rest), trial.normal_force, &trial.grain);
        let mut held = bound.hold(&trial.s_trial);
        if !levels.is_constant() {
            rest = levels.settle(rest, held.inside, trial.elapsed);
            if !held.inside && levels.stribeck_speed == 0.0 {
                bound = self.ellipse(levels.kinetic, trial.normal_force, &trial.grain);
                held = bound.hold(&trial.s_trial);
            }
        }
        // The damper sees the motion within the bound of now, as [`Self::eval_rate`] does: the length that a falling bound takes away slips at the tip.
        // Counted as a rate of the bristle, it would push along the slip and give energy.
        let (before, within) = within(&bound, trial, &held);
        let rate = self.damping / trial.elapsed;
        let mut force = -(self.stiffness * held.s + rate * (within.s - before));
        let along = |inside: bool, slope: f64| if inside { slope } else { 0.0 };
        let mut slope = Slope {
            across: self.stiffness * held.shrink + rate * within.shrink,
            along: along(held.inside, self.stiffness) + along(within.inside, rate),
            direction: held.normal,
        };
        if self.damping > 0.0 {
            let allowed = bound.scaled(self.stiffness).hold(&force);
            if !allowed.inside {
                slope = Slope { across: slope.across * allowed.shrink, along: 0.0, direction: allowed.normal };
                force = allowed.s;
            }
            if !bound.is_round() {
                let moved = trial.s_trial - trial.s;
                let stored = self.calc_stored_energy(&held.s) - self.calc_stored_energy(&trial.s);
                force = self.without_push(force, &held.s, &moved, stored);
            }
        }
        let by_slip = self.calc_slip_slope(trial, speed, held.inside);
        Brush {
            force: force - self.viscous * trial.slip,
            s: held.s,
            rest,
            sticks: held.inside,
            by_deflection: slope,
            by_slip,
        }
    }

    /// The force, or that of the spring alone where the damper would give energy: shortened along itself, a deflection may
    /// run against the motion that shortens it (only far from a circle).
    fn without_push(&self, force: Vector3<f64>, s: &Vector3<f64>, moved: &Vector3<f64>, stored: f64) -> Vector3<f64> {
        if -force.dot(moved) < stored { -self.stiffness * s } else { force }
    }

    /// −∂f/∂u: the viscous term, and in sliding the level that follows the speed.
    #[inline]
    fn calc_slip_slope(&self, trial: &Trial, speed: f64, sticks: bool) -> Slope {
        if sticks || self.mu_static == self.mu_kinetic || speed == 0.0 {
            return Slope::even(self.viscous);
        }
        let direction = trial.slip / speed;
        let fall = self.levels().calc_slope(speed) * trial.normal_force;
        Slope { across: self.viscous, along: self.viscous + fall, direction }
    }

    /// The law in continuous time; `trial.s_trial` and `trial.elapsed` do not matter, rest stays what it was: [`Self::flow`]
    /// moves both.
    pub fn eval_rate(&self, trial: &Trial) -> BrushRate {
        if trial.normal_force <= 0.0 {
            return BrushRate::none();
        }
        let levels = self.levels();
        let speed = if levels.is_constant() { 0.0 } else { trial.slip.norm() };
        let lags = levels.dwell_time > 0.0;
        let rest = if lags { trial.rest } else { levels.calc_rest(trial.rest, speed, 0.0) };
        let bound = self.ellipse(levels.at(rest), trial.normal_force, &trial.grain);
        let s = bound.hold(&trial.s).s;
        let edge = bound.scaled(ON_BOUND).hold(&s);
        let outward = edge.normal.dot(&trial.slip);
        let slides = !edge.inside && outward > 0.0;
        let s_rate = if slides { trial.slip - edge.normal * outward } else { trial.slip };
        let mut force = -(self.stiffness * s + self.damping * s_rate);
        if self.damping > 0.0 {
            force = bound.scaled(self.stiffness).hold(&force).s;
            if !bound.is_round() {
                force = self.without_push(force, &s, &trial.slip, self.stiffness * s.dot(&s_rate));
            }
        }
        BrushRate { force: force - self.viscous * trial.slip, s, s_rate, sticks: !slides }
    }
}

/// Where a bristle is within a bound before a step, and after it: as it is `held`, but where the bound has fallen below what it was.
#[inline]
fn within(bound: &Ellipse, trial: &Trial, held: &Held) -> (Vector3<f64>, Held) {
    if is_zero(&trial.s) {
        return (trial.s, *held);
    }
    let before = bound.hold(&trial.s);
    if before.inside {
        return (before.s, *held);
    }
    (before.s, bound.hold(&(before.s + (trial.s_trial - trial.s))))
}

/// How near the bound counts as on it: with a strict comparison round-off would choose the branch.
const ON_BOUND: f64 = 1.0 - 1e-9;

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: Bristle = Bristle {
        mu_static: 0.5,
        mu_kinetic: 0.3,
        stribeck_speed: 0.01,
        dwell_time: 0.0,
        fall_time: 0.0,
        across: 1.0,
        stiffness: 1e4,
        damping: 5.0,
        viscous: 2.0,
    };

    fn trial(s: Vector3<f64>, ds: Vector3<f64>) -> Trial {
        Trial { s, s_trial: s + ds, slip: ds / 1e-3, elapsed: 1e-3, normal_force: 20.0, ..Trial::default() }
    }

    #[test]
    fn sliding_force_is_the_level_against_the_motion() {
        let law = Bristle { damping: 0.0, viscous: 0.0, ..LAW };
        let s = Vector3::new(law.calc_reach(20.0, 0.0), 0.0, 0.0);
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
    fn on_a_falling_bound_the_step_law_is_that_of_continuous_time() {
        let law = Bristle { mu_kinetic: 0.5, stribeck_speed: 0.0, ..LAW };
        let (before, now, elapsed) = (20.0, 20.0 - 2e-5, 1e-9);
        let s = Vector3::new(law.calc_reach(before, 1.0), 0.0, 0.0);
        // Outward, along the bound, and inward slower than the bound falls.
        for slip in [Vector3::new(0.3, 0.1, 0.0), Vector3::new(0.0, 0.3, 0.0), Vector3::new(-0.2, 0.0, 0.0)] {
            let trial = Trial { s, s_trial: s + slip * elapsed, slip, elapsed, normal_force: now, ..Trial::default() };
            let (step, rate) = (law.eval(&trial).force, law.eval_rate(&trial).force);
            assert!((step - rate).norm() < 1e-5 * rate.norm(), "{slip}: {step} {rate}");
        }
    }

    #[test]
    fn without_normal_force_nothing_is_left() {
        let brush = LAW.eval(&Trial { normal_force: 0.0, ..trial(Vector3::x() * 1e-4, Vector3::zeros()) });
        assert_eq!((brush.force, brush.s), (Vector3::zeros(), Vector3::zeros()));
    }

    /// In stick and in slip, with and without damper, isotropic and (in stick) not: by central differences.
    #[test]
    fn derivatives_are_exact_in_stick_and_in_slip() {
        for (damping, across) in [(0.0, 1.0), (5.0, 1.0), (0.0, 0.4), (5.0, 0.4)] {
            let law = Bristle { damping, across, ..LAW };
            for ds in [Vector3::new(1e-5, 2e-5, 0.0), Vector3::new(2e-3, 1e-3, 0.0)] {
                let s = Vector3::new(1e-4, -0.5e-4, 0.0);
                let at = Trial { grain: Vector3::x(), ..trial(s, ds) };
                let brush = law.eval(&at);
                let overshoots = !brush.sticks && damping > 0.0;
                for k in 0..2 {
                    let e = Vector3::ith(k, 1e-9);
                    let by_s = law.eval(&Trial { s_trial: at.s_trial - e, ..at }).force
                        - law.eval(&Trial { s_trial: at.s_trial + e, ..at }).force;
                    let matrix = brush.by_deflection.calc_matrix(&Vector3::z());
                    // Differences over 2 nm at forces of a few N: round-off 1e-15/1e-9, against k = 1e4 N/m. Where the damper
                    // overshoots, two returns follow each other and the product of their slopes is not symmetric.
                    let tolerance = if overshoots { 0.2 * law.stiffness } else { 1e-2 };
                    let is_turning_alone = across != 1.0 && !brush.sticks;
                    assert!(is_turning_alone || (by_s / 2e-9 - matrix.column(k)).norm() < tolerance, "{by_s} {matrix}");
                    let e = Vector3::ith(k, 1e-6);
                    let by_u = law.eval(&Trial { slip: at.slip - e, ..at }).force
                        - law.eval(&Trial { slip: at.slip + e, ..at }).force;
                    let claimed = brush.by_slip.calc_matrix(&Vector3::z());
                    let is_radial = across == 1.0 && ds.norm() < 1e-4;
                    if is_radial {
                        assert!((by_u / 2e-6 - claimed.column(k)).norm() < 1e-5 * claimed.norm());
                    }
                }
            }
        }
    }

    /// Dragged steadily, the bristle lies along the slip, and the level's fall with speed is along it too.
    #[test]
    fn the_falling_level_is_in_the_derivative_by_slip() {
        let law = Bristle { damping: 0.0, ..LAW };
        let u = Vector3::new(8e-3, 0.0, 0.0);
        let at = Trial {
            s: Vector3::x() * 1e-3,
            s_trial: Vector3::x() * 2e-3,
            slip: u,
            normal_force: 20.0,
            ..Trial::default()
        };
        let e = Vector3::x() * 1e-7;
        let slope =
            (law.eval(&Trial { slip: u - e, ..at }).force - law.eval(&Trial { slip: u + e, ..at }).force).x / 2e-7;
        let claimed = law.eval(&at).by_slip.along;
        assert!(claimed < 0.0 && (slope - claimed).abs() < 1e-6 * slope.abs(), "{slope} {claimed}");
    }

    #[test]
    fn a_drop_of_level_comes_at_breakaway_and_goes_at_rest() {
        let law = Bristle { stribeck_speed: 0.0, damping: 0.0, viscous: 0.0, ..LAW };
        let just_below = law.eval(&trial(Vector3::zeros(), Vector3::x() * 0.99e-3));
        assert!(just_below.sticks && (just_below.force.x + 9.9).abs() < 1e-12);
        let above = law.eval(&trial(just_below.s, Vector3::x() * 0.02e-3));
        assert!(!above.sticks && (above.force.x + 6.0).abs() < 1e-12 && above.rest == 0.0);
        let on = law.eval(&Trial { rest: above.rest, ..trial(above.s, Vector3::x() * 1e-6) });
        assert!(!on.sticks && (on.force.x + 6.0).abs() < 1e-12, "it slides on at the kinetic level");
        let back = law.eval(&Trial { rest: on.rest, ..trial(on.s, Vector3::x() * -1e-6) });
        assert!(back.sticks && back.rest == 1.0);
        let again = law.eval(&Trial { rest: back.rest, ..trial(back.s, Vector3::x() * 0.3e-3) });
        assert!(again.sticks && again.force.x < -8.9, "rested, it holds the static level again");
    }

    #[test]
    fn the_static_level_returns_with_the_dwell_time() {
        let law = Bristle { stribeck_speed: 0.0, dwell_time: 2.0, ..LAW };
        let mut rest = law.levels().initial_rest();
        for _ in 0..3000 {
            rest = law.eval(&Trial { rest, ..trial(Vector3::zeros(), Vector3::zeros()) }).rest;
        }
        // 3 s of 2 s: 1 − exp(−1.5), to the round-off of 3,000 products.
        assert!((rest - (1.0 - (-1.5_f64).exp())).abs() < 1e-12);
    }

    #[test]
    fn impossible_parameters_are_named() {
        let bad = Bristle { stiffness: 0.0, ..LAW };
        assert_eq!(bad.check().expect_err("zero stiffness").parameter, "stiffness");
        let bad = Bristle { mu_static: f64::NAN, ..LAW };
        assert_eq!(bad.check().expect_err("NaN level").parameter, "mu_static");
    }
}
