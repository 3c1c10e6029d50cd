//! A gear that yields or has play: the drive turns a rotor, the rotor turns the joint through a spring.
//!
//!   B ω̇ = u − τ,   τ = k e(x) + d ẋ where |x| > g/2, else 0,   e = x ∓ g/2,   x = θ − q,  ẋ = ω − q̇
//!
//! θ, ω: the motor side in joint units, where encoder and tachometer sit; B: the reflected rotor inertia, which has left
//! the joint's diagonal; τ acts on the link side, where the joint's friction is. With g = 0 it is joint elasticity. Its
//! memory is (x, ẋ), zero for an unloaded gear however the joint stands or moves.
//!
//! Runge–Kutta integrates both. The one-solve schemes solve the motor together with the joint, linearly implicit with
//! the law checked: for a new rate v' of the joint, ω' follows from B (ω' − ω) = h (u' − τ'), piecewise linear, by
//! Newton's method, and  −∂τ/∂v' = s (B + h s_u)/(B + h (s_u + s)),  s = k β + d θ,  enters the matrix: stable at any k.
//!
//! A speed limit L (see [`crate::parts::speed_limit`]) is the motor's: a step that would turn it faster ends at ω' = L, with the
//! effort u = B (L − ω)/h + τ' that leads there, as long as that is between nothing and what was asked; else with u = 0.

use crate::parts::coordinate::{CoordinateForce, CoordinatePoint};

/// A compliance between a drive and its joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Series {
    /// Index into `v`.
    pub coordinate: usize,
    /// B: rotor inertia reflected to the joint, kg·m² or kg; above zero.
    pub rotor: f64,
    /// k, N·m/rad or N/m; finite and above zero.
    pub stiffness: f64,
    /// d, N·m·s/rad or N·s/m.
    pub damping: f64,
    /// Full width of the play, rad or m.
    pub gap: f64,
}

/// The motor at the point where a coordinate's law is evaluated.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motor {
    /// Effort on the link side, and −∂/∂v'.
    pub effort: f64,
    pub slope: f64,
    /// Effort of the actuators on the rotor.
    pub driven: f64,
    /// Rate of the rotor at the end of a one-solve step.
    pub rate_end: f64,
    /// Whether the drive gave less than was asked, at the speed limit.
    pub is_limited: bool,
}

/// What a motor's step depends on beside its joint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shaft<'a> {
    /// Deflection and its rate.
    pub memory: &'a [f64],
    /// Length of the step, s.
    pub step: f64,
    /// Rate at which the motor stops pushing, rad/s or m/s.
    pub speed_limit: f64,
}

/// Most Newton steps for the motor's rate; a piecewise linear law needs as many as it has corners, and one.
const MAX_STEPS: usize = 12;

impl Series {
    pub(crate) fn find_fault(&self) -> Option<String> {
        let Self { rotor, stiffness, damping, gap, .. } = *self;
        if !(rotor.is_finite() && rotor > 0.0) {
            return Some("has no rotor behind the gear; give the joint's drive a reflected inertia".to_owned());
        }
        let sound = stiffness.is_finite() && stiffness > 0.0 && damping >= 0.0 && damping.is_finite() && gap >= 0.0;
        (!sound).then(|| "needs a finite stiffness above zero, and damping and gap of at least zero".to_owned())
    }

    /// Spring torque, and whether the gear is engaged.
    fn eval_law(&self, x: f64, rate: f64) -> (f64, bool) {
        let half = 0.5 * self.gap;
        if x.abs() <= half && half > 0.0 {
            return (0.0, false);
        }
        (self.stiffness * (x - half.copysign(x)) + self.damping * rate, true)
    }

    /// The motor where the joint's new rate is `v_new`; `drive` gives effort and slope at the motor's position and rate.
    pub(crate) fn eval(
        &self,
        at: &CoordinatePoint,
        v_new: f64,
        shaft: &Shaft<'_>,
        drive: impl Fn(&CoordinatePoint, f64, f64) -> (f64, f64),
    ) -> Motor {
        let limit = shaft.speed_limit;
        let motor = self.turn(at, v_new, shaft, &drive);
        let asked = motor.driven;
        if asked.signum() * motor.rate_end <= limit {
            return motor;
        }
        let held = self.turn_to(at, v_new, shaft, limit.copysign(asked));
        let motor = if held.driven * asked >= 0.0 { held } else { self.turn(at, v_new, shaft, &|_, _, _| (0.0, 0.0)) };
        Motor { is_limited: asked != 0.0, ..motor }
    }

    /// The motor under what its drive gives.
    fn turn(
        &self,
        at: &CoordinatePoint,
        v_new: f64,
        shaft: &Shaft<'_>,
        drive: &impl Fn(&CoordinatePoint, f64, f64) -> (f64, f64),
    ) -> Motor {
        let &Shaft { memory, step, .. } = shaft;
        let (x_start, w_start) = (memory[0], memory[1]);
        let omega = at.v_start + w_start;
        if at.theta == 0.0 {
            let (driven, _) = drive(at, at.q_base + x_start, omega);
            let (effort, _) = self.eval_law(x_start, w_start);
            let rate_end = omega + step * (driven - effort) / self.rotor;
            return Motor { effort, slope: 0.0, driven, rate_end, is_limited: false };
        }
        let (x_base, theta_base) = self.bases(at, v_new, memory);
        let mut rate_end = omega + v_new - at.v_start;
        let (mut effort, mut driven, mut spring, mut by_drive) = (0.0, 0.0, 0.0, 0.0);
        for _ in 0..MAX_STEPS {
            let rate = (1.0 - at.theta) * omega + at.theta * rate_end;
            let link_rate = (1.0 - at.theta) * at.v_start + at.theta * v_new;
            let (torque, engaged) = self.eval_law(x_base + at.beta * rate_end, rate - link_rate);
            let (u, slope) = drive(at, theta_base + at.beta * rate_end, rate);
            spring = if engaged { self.stiffness * at.beta + self.damping * at.theta } else { 0.0 };
            (effort, driven, by_drive) = (torque, u, slope);
            let miss = self.rotor * (rate_end - omega) - step * (u - torque);
            let gain = miss / (self.rotor + step * (by_drive + spring));
            rate_end -= gain;
            effort -= spring * gain;
            driven += by_drive * gain;
            if gain.abs() <= 1e-13 * (rate_end.abs() + omega.abs()) {
                break;
            }
        }
        let held = self.rotor + step * by_drive;
        let slope = spring * held / (held + step * spring);
        Motor { effort, slope, driven, rate_end, is_limited: false }
    }

    /// The motor that ends the step at a rate, with the effort on the rotor that takes.
    fn turn_to(&self, at: &CoordinatePoint, v_new: f64, shaft: &Shaft<'_>, rate_end: f64) -> Motor {
        let &Shaft { memory, step, .. } = shaft;
        let omega = at.v_start + memory[1];
        let (x, rate, link_rate) = if at.theta == 0.0 {
            (memory[0], omega, at.v_start)
        } else {
            let mean = |start: f64, end: f64| (1.0 - at.theta) * start + at.theta * end;
            let x = self.bases(at, v_new, memory).0 + at.beta * rate_end;
            (x, mean(omega, rate_end), mean(at.v_start, v_new))
        };
        let (effort, engaged) = self.eval_law(x, rate - link_rate);
        let slope = if engaged { self.stiffness * at.beta + self.damping * at.theta } else { 0.0 };
        let driven = effort + self.rotor * (rate_end - omega) / step;
        Motor { effort, slope, driven, rate_end, is_limited: false }
    }

    /// Deflection and motor position at the evaluated point, less β times the motor's new rate.
    fn bases(&self, at: &CoordinatePoint, v_new: f64, memory: &[f64]) -> (f64, f64) {
        let omega = at.v_start + memory[1];
        let carried = if at.theta == 1.0 { 0.0 } else { at.beta * omega };
        let x_base = memory[0] + carried - at.moved_base - at.beta * v_new;
        (x_base, at.q_base + memory[0] + carried - at.moved_base)
    }

    pub(crate) fn write_rates(&self, memory: &[f64], force: &CoordinateForce, v_dot: f64, rates: &mut [f64]) {
        rates[0] = memory[1];
        rates[1] = (force.driven - force.through) / self.rotor - v_dot;
    }

    /// Deflection that carries a load at rest, rad or m.
    pub(crate) fn calc_rest(&self, load: f64) -> f64 {
        if load == 0.0 { 0.0 } else { load / self.stiffness + (0.5 * self.gap).copysign(load) }
    }

    /// Power that its damper takes at a deflection and its rate, W.
    pub(crate) fn calc_loss(&self, [x, rate]: [f64; 2]) -> f64 {
        let is_engaged = x.abs() > 0.5 * self.gap || self.gap == 0.0;
        if is_engaged { self.damping * rate * rate } else { 0.0 }
    }

    /// In the spring and in the rotor, J.
    pub(crate) fn calc_energy(&self, memory: &[f64], v: f64) -> f64 {
        let (beyond, omega) = ((memory[0].abs() - 0.5 * self.gap).max(0.0), v + memory[1]);
        0.5 * self.stiffness * beyond * beyond + 0.5 * self.rotor * omega * omega
    }
}
