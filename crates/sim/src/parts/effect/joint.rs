//! Efforts on one joint coordinate: friction, cables, ripple, disturbances.
//!
//! | law | effort, N·m or N |
//! | --- | --- |
//! | viscous | −b q̇, of one value or of two by the sign of q̇ |
//! | quadratic | −b₂ |q̇| q̇ |
//! | offset | e |
//! | dry | −(g/z₀)(z + t_d ż e^(−(q̇/v_d)²)),  ż = q̇ − max(|q̇|, v_c) z/z₀ |
//! | ripple | A sin(n q + φ) |
//! | cable | −k (q − q_rest) |
//! | periodic | A sin(2π f t + φ) |
//!
//! Dry friction is Dahl's (1968), with t_d = 2 ms, v_d = 0.02 rad/s or m/s, and the level g constant, falling with speed, or
//! of two values by the sign of z. Divided by q̇, its equation loses the time:
//!   dz/dq = 1 − σ z/z₀,  σ = sign q̇,   so   z = σ z₀ + (z_a − σ z₀) e^(−|q − q_a|/z₀)   while the direction holds.
//! The deflection of every stage is therefore taken from the displacement since the step's start, exactly; a reversal
//! within the step is placed by a linear rate between its ends. Integrated as a rate, z would be stiff (|q̇|/z₀ is
//! 3,000 /s at 1 rad/s); so it is bounded at any step, and the law is as smooth in q as the motion lets it be. What is
//! left is the corner at a reversal: a step of Runge–Kutta that holds one is divided, see [`REVERSAL_STEP`].
//!
//! Below the creep rate v_c the joint does not hold: a load of less than the level moves it, at v_c times its share of the level
//! (lubricant films, teeth under load; the regularised Coulomb friction of other simulators). z then relaxes with the time z₀/v_c
//! towards z₀ q̇/v_c. Over a time t at a steady rate both cases are one,
//!   z = z₀ Δq/m + (z_a − z₀ Δq/m) e^(−m/z₀),   m = max(|Δq|, v_c t),
//! and v_c = 0 is Dahl's law.

use crate::parts::coordinate::CoordinatePoint;
use std::f64::consts::TAU;

/// An effort on one joint coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointEffect {
    /// Index into `v`.
    pub coordinate: usize,
    /// The law.
    pub law: JointLaw,
}

/// The laws of single coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointLaw {
    /// Against the rate.
    Viscous {
        /// N·m·s/rad or N·s/m.
        damping: f64,
    },
    /// The same with a number for each direction.
    ViscousBySide {
        /// Where q̇ ≥ 0, N·m·s/rad or N·s/m.
        plus: f64,
        /// Elsewhere.
        minus: f64,
    },
    /// Against the square of the rate.
    Quadratic {
        /// N·m·s²/rad² or N·s²/m².
        drag: f64,
    },
    /// The same always: what a drive adds to its command, a weight that is not in the model.
    Offset {
        /// N·m or N.
        effort: f64,
    },
    /// Dahl's dry friction.
    Dry(DryFriction),
    /// Periodic in the position.
    Ripple {
        /// N·m or N.
        amplitude: f64,
        /// Periods per turn, or 2π/wavelength in 1/m.
        order: f64,
        /// rad.
        phase: f64,
    },
    /// A spring to a rest position.
    Cable {
        /// N·m/rad or N/m.
        stiffness: f64,
        /// rad or m.
        rest: f64,
    },
    /// Periodic in time.
    Periodic {
        /// N·m or N.
        amplitude: f64,
        /// Hz.
        frequency: f64,
        /// rad.
        phase: f64,
    },
}

/// Dry friction with a deflection before it slides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DryFriction {
    /// g: how high it is.
    pub level: DryLevel,
    /// z₀: deflection at which it is fully there, rad or m, above zero; the level over z₀ is its stiffness at rest.
    pub reach: f64,
    /// v_c: rate below which it yields slowly instead of holding, rad/s or m/s; zero where it holds.
    pub creep: f64,
}

impl From<DryLevel> for DryFriction {
    /// With the usual reach, and without creep.
    fn from(level: DryLevel) -> Self {
        Self { level, reach: REACH, creep: 0.0 }
    }
}

/// How high dry friction is, N·m or N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DryLevel {
    /// c.
    Constant(f64),
    /// c + (s − c) exp(−(q̇/v_s)²).
    Falling {
        /// Sliding level.
        c: f64,
        /// Level at rest.
        s: f64,
        /// rad/s or m/s.
        v_s: f64,
    },
    /// By the sign of the deflection.
    Directed {
        /// Where z ≥ 0: against motion in the positive direction.
        c_plus: f64,
        /// Elsewhere.
        c_minus: f64,
    },
}

/// z₀ where nothing else is known, rad or m.
pub const REACH: f64 = 3e-4;
/// t_d: time constant of the damping of small motion, s.
const DAMPING_TIME: f64 = 2e-3;
/// v_d: rate beyond which that damping fades, rad/s or m/s.
const DAMPING_RATE: f64 = 0.02;

/// Longest step of Runge–Kutta in which dry friction turns, s, and as a share of the step where that is longer. Measured on a
/// seven-joint arm that rests and starts again under noisy commands, 12 s: 0.2 ms stays within a tenth of an encoder's noise.
const REVERSAL_STEP: f64 = 2e-4;
const REVERSAL_SHARE: f64 = 0.2;

/// Longest part, s, of a step of `h` that holds a reversal.
pub(crate) fn reversal_step(h: f64) -> f64 {
    REVERSAL_STEP.max(REVERSAL_SHARE * h)
}

impl DryLevel {
    fn is_nothing(&self) -> bool {
        match *self {
            Self::Constant(c) => c == 0.0,
            Self::Falling { c, s, .. } => c == 0.0 && s == 0.0,
            Self::Directed { c_plus, c_minus } => c_plus == 0.0 && c_minus == 0.0,
        }
    }

    fn calc(&self, z: f64, v: f64) -> f64 {
        match *self {
            Self::Constant(c) => c,
            Self::Falling { c, s, v_s } => c + (s - c) * (-(v / v_s) * (v / v_s)).exp(),
            Self::Directed { c_plus, c_minus } => {
                if z >= 0.0 {
                    c_plus
                } else {
                    c_minus
                }
            }
        }
    }
}

impl DryFriction {
    /// Effort and −∂effort/∂v' at the deflection z; β and θ say how z and v depend on the new rate v'.
    fn eval(&self, z: f64, v: f64, beta: f64, theta: f64) -> (f64, f64) {
        let fade = DAMPING_TIME * (-(v / DAMPING_RATE) * (v / DAMPING_RATE)).exp();
        let stiffness = self.level.calc(z, v) / self.reach;
        let creeps = v.abs() < self.creep;
        let open = if creeps { 1.0 } else { 1.0 - v.signum() * z / self.reach };
        let rate = if creeps { v - self.creep * z / self.reach } else { v * open };
        (-stiffness * (z + fade * rate), (stiffness * open * (beta + fade * theta)).max(0.0))
    }

    /// Deflection after the displacement of a law's point from the start of the step, where it was `z`.
    fn calc_deflection(&self, z: f64, at: &CoordinatePoint, moved: f64, v: f64) -> f64 {
        let Some((v_start, elapsed)) = at.from else { return self.drag(z, moved, at.elapsed) };
        if v_start * v < 0.0 {
            // The rate goes linearly through zero: so far out, and the rest of the way back.
            let share = v_start / (v_start - v);
            let out = 0.5 * v_start * elapsed * share;
            return self.drag(self.drag(z, out, elapsed * share), moved - out, elapsed * (1.0 - share));
        }
        self.drag(z, moved, elapsed)
    }

    /// Deflection after a displacement in one direction, in a time.
    fn drag(&self, z: f64, moved: f64, time: f64) -> f64 {
        let (way, crept) = (moved.abs(), self.creep * time);
        let end = if crept > way { self.reach * moved / crept } else { self.reach.copysign(moved) };
        end + (z - end) * (-way.max(crept) / self.reach).exp()
    }
}

impl JointEffect {
    /// See [`super::EffectKind::driving_rate`].
    pub(crate) fn driving_rate(&self) -> f64 {
        match self.law {
            JointLaw::Periodic { frequency, .. } => TAU * frequency.abs(),
            JointLaw::Viscous { .. }
            | JointLaw::ViscousBySide { .. }
            | JointLaw::Quadratic { .. }
            | JointLaw::Offset { .. }
            | JointLaw::Dry(_)
            | JointLaw::Ripple { .. }
            | JointLaw::Cable { .. } => 0.0,
        }
    }

    pub(crate) fn memory_names(&self) -> &'static [&'static str] {
        if matches!(self.law, JointLaw::Dry(_)) { &["deflection"] } else { &[] }
    }

    /// Effort and −∂effort/∂v' at position `q` and rate `v`, which `at` places for the new rate `v_new`.
    pub(crate) fn eval(
        &self,
        (at, v_new): (&CoordinatePoint, f64),
        (q, v): (f64, f64),
        memory: &[f64],
        time: f64,
    ) -> (f64, f64) {
        match self.law {
            JointLaw::Viscous { damping } => (-damping * v, damping * at.theta),
            JointLaw::ViscousBySide { plus, minus } => {
                let damping = if v >= 0.0 { plus } else { minus };
                (-damping * v, damping * at.theta)
            }
            JointLaw::Quadratic { drag } => (-drag * v.abs() * v, 2.0 * drag * v.abs() * at.theta),
            JointLaw::Offset { effort } => (effort, 0.0),
            JointLaw::Dry(dry) => {
                let z = dry.calc_deflection(memory[0], at, at.moved_base + at.beta * v_new, v);
                dry.eval(z, v, at.beta, at.theta)
            }
            JointLaw::Ripple { amplitude, order, phase } => {
                let (sin, cos) = (order * q + phase).sin_cos();
                // Only the restoring half of a wave may enter the matrix, which stays positive so.
                (amplitude * sin, (-amplitude * order * cos * at.beta).max(0.0))
            }
            JointLaw::Cable { stiffness, rest } => (-stiffness * (q - rest), stiffness * at.beta),
            JointLaw::Periodic { amplitude, frequency, phase } => {
                (amplitude * (TAU * frequency * time + phase).sin(), 0.0)
            }
        }
    }

    /// Deflection at which dry friction slides, rad or m; none of other laws.
    pub(crate) fn largest_deflection(&self) -> Option<f64> {
        if let JointLaw::Dry(dry) = self.law { Some(dry.reach) } else { None }
    }

    /// Whether it is dry friction.
    pub(crate) fn is_dry(&self) -> bool {
        matches!(self.law, JointLaw::Dry(dry) if !dry.level.is_nothing())
    }

    /// Takes the deflection over the accepted step.
    pub(crate) fn commit(&self, at: &CoordinatePoint, v: f64, memory: &mut [f64]) {
        if let ([z], JointLaw::Dry(dry)) = (memory, &self.law) {
            *z = dry.calc_deflection(*z, at, at.moved_base, v);
        }
    }

    /// Whether what it does is a potential, in [`Self::calc_energy`]; else its work is booked.
    pub(crate) fn stores(&self) -> bool {
        matches!(self.law, JointLaw::Cable { .. } | JointLaw::Ripple { .. } | JointLaw::Offset { .. })
    }

    /// What its spring holds, J.
    pub(crate) fn calc_energy(&self, q: f64) -> f64 {
        match self.law {
            JointLaw::Cable { stiffness, rest } => 0.5 * stiffness * (q - rest) * (q - rest),
            JointLaw::Ripple { amplitude, order: 0.0, phase } => -amplitude * phase.sin() * q,
            JointLaw::Ripple { amplitude, order, phase } => amplitude / order * (order * q + phase).cos(),
            JointLaw::Offset { effort } => -effort * q,
            JointLaw::Viscous { .. }
            | JointLaw::ViscousBySide { .. }
            | JointLaw::Quadratic { .. }
            | JointLaw::Dry(_)
            | JointLaw::Periodic { .. } => 0.0,
        }
    }
}
