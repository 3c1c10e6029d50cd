//! What acts on single joint coordinates, and the actuators of a world.
//!
//! A coordinate's law, evaluated at the predicted end of the step (q, v):
//!
//!   τ = −b v + stop(q, v) + dry friction + Σ drives,     drive = clamp(k_p (q_ref − q) + k_d (v_ref − v) + τ_ff, ±limit)
//!   stop = max(0, k (lower − q) − c v) below, likewise above; never pulls
//!
//! Beyond the coordinate's speed limit the drives give nothing in the direction of motion: [`super::speed_limit`]. Effects add efforts of their own, change what a drive delivers, or part it from the joint by a gear that yields.
//!
//! The stop's stiffness brings the joint to rest within about 10 mrad (1 mm) of overtravel at its full effort, up to
//! 1e5 N·m/rad (1e6 N/m). Dry
//! friction is the bristle of [`friction`] in one dimension, with the deflection at breakaway of 3e-4 rad or m.

use super::speed_limit::Branch;
use friction::{Bristle, Trial};
use multibody::{Joint, JointKind};
use spatial::Vec3;

/// The passive laws of one coordinate, and who drives it.
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinate {
    /// Whether it is the single coordinate of a revolute or prismatic joint.
    pub is_scalar: bool,
    /// Index into `q`.
    pub q_index: usize,
    /// Viscous friction, N·m·s/rad or N·s/m.
    pub damping: f64,
    /// Dry friction; its `mu` levels are efforts, taken at a normal force of one.
    pub dry: Option<Bristle>,
    /// Stops.
    pub limits: Option<[f64; 2]>,
    /// Stiffness of the stops.
    pub stop_stiffness: f64,
    /// Damping of the stops.
    pub stop_damping: f64,
    /// Speed at which its actuators stop pushing, rad/s or m/s; infinite for none.
    pub speed_limit: f64,
    /// Actuators that act here.
    pub actuators: Vec<usize>,
    /// Effects that act here with an effort of their own.
    pub effects: Vec<usize>,
    /// The effect that parts the actuators from the joint: a gear that yields.
    pub series: Option<usize>,
}

impl Default for Coordinate {
    /// One that nothing acts on.
    fn default() -> Self {
        Self {
            is_scalar: false,
            q_index: 0,
            damping: 0.0,
            dry: None,
            limits: None,
            stop_stiffness: 0.0,
            stop_damping: 0.0,
            speed_limit: f64::INFINITY,
            actuators: Vec::new(),
            effects: Vec::new(),
            series: None,
        }
    }
}

/// Deflection at which dry joint friction breaks away, rad or m.
const DRY_DEFLECTION: f64 = 3e-4;

/// Stop damping over stop stiffness, s.
const STOP_TIME: f64 = 0.02;

impl Coordinate {
    /// From a joint's tags.
    pub fn from_joint(joint: &Joint, q_index: usize) -> Self {
        let (overtravel, hardest) = if joint.kind == JointKind::Revolute { (1e-2, 1e5) } else { (1e-3, 1e6) };
        let stop_stiffness =
            if joint.effort_limit > 0.0 { (joint.effort_limit / overtravel).min(hardest) } else { hardest };
        let dry = (joint.friction > 0.0).then(|| Bristle {
            mu_static: joint.friction,
            mu_kinetic: joint.friction,
            stiffness: joint.friction / DRY_DEFLECTION,
            ..Bristle::default()
        });
        Self {
            is_scalar: true,
            q_index,
            damping: joint.damping,
            dry,
            limits: joint.position_limits,
            stop_stiffness,
            stop_damping: STOP_TIME * stop_stiffness,
            // Zero is what exporters write who know of none.
            speed_limit: if joint.velocity_limit > 0.0 { joint.velocity_limit } else { f64::INFINITY },
            ..Self::default()
        }
    }

    /// Whether nothing acts here.
    pub fn is_idle(&self) -> bool {
        let is_passive = self.damping == 0.0 && self.dry.is_none() && self.limits.is_none();
        is_passive && self.actuators.is_empty() && self.effects.is_empty() && self.series.is_none()
    }
}

/// Where a coordinate's law is evaluated, and how that place depends on the new rate v':
/// q = `q_base` + β v',  v = (1 − θ) `v_start` + θ v',  displacement since the start = `moved_base` + β v'.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CoordinatePoint {
    pub q_base: f64,
    pub moved_base: f64,
    pub v_start: f64,
    pub beta: f64,
    pub theta: f64,
    pub dry_start: f64,
    pub elapsed: f64,
    /// At an explicit stage: the rate at the step's start, and the time since then.
    pub from: Option<(f64, f64)>,
    /// At an explicit stage: the rate to which it leads at the step's end; elsewhere that is v'.
    pub end: Option<f64>,
    /// Branch of the speed limit that the last line followed.
    pub branch: Option<Branch>,
}

impl CoordinatePoint {
    /// At a position and rate that depend on nothing.
    pub fn still(q: f64, v: f64, elapsed: f64) -> Self {
        let (moved_base, beta, theta, dry_start) = (0.0, 0.0, 0.0, 0.0);
        let (from, end, branch) = (None, None, None);
        Self { q_base: q, moved_base, v_start: v, beta, theta, dry_start, elapsed, from, end, branch }
    }

    /// The end of a step that moved the coordinate by `moved`, whose laws were last evaluated at `last`.
    pub fn at_end(moved: f64, last: &Self, step: f64) -> Self {
        let from = last.from.map(|(v, _)| (v, step));
        Self { moved_base: moved, beta: 0.0, theta: 0.0, elapsed: step, from, ..*last }
    }
}

/// Effort on a coordinate, −∂τ/∂v', and its parts.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CoordinateForce {
    pub effort: f64,
    pub slope: f64,
    /// What the actuators give, on the motor side.
    pub driven: f64,
    /// What of it arrives on the link side: the same, but for a gear that yields.
    pub through: f64,
    /// Branch of the speed limit, where there is one.
    pub branch: Option<Branch>,
    /// Whether the actuators gave less than was asked, since they turn as fast as they may.
    pub is_limited: bool,
    /// −∂τ/∂v' by the speed limit's fall, where it is not in the slope: at an explicit stage.
    pub fall: f64,
}

impl Coordinate {
    /// What becomes of the dry deflection over a step that moves the coordinate by `moved`.
    pub(crate) fn advance_dry(&self, s: f64, moved: f64, h: f64) -> f64 {
        let Some(law) = &self.dry else { return 0.0 };
        let start = Vec3::new(s, 0.0, 0.0);
        let along = Vec3::new(moved, 0.0, 0.0);
        let trial = Trial {
            s: start,
            s_trial: start + along,
            slip: along / h,
            elapsed: h,
            normal_force: 1.0,
            ..Trial::default()
        };
        law.eval(&trial).s.x
    }

    /// What dry friction takes for good while its deflection goes from `start` to `end` under a displacement of `moved`, J: the
    /// force of the bristle's end times what has slipped at its tip.
    pub(crate) fn calc_dry_loss(&self, start: f64, end: f64, moved: f64) -> f64 {
        self.dry.as_ref().map_or(0.0, |law| law.stiffness * end * (moved - (end - start)))
    }

    /// Power that damping and stops take for good, W.
    pub(crate) fn calc_loss(&self, q: f64, v: f64) -> f64 {
        let mut loss = self.damping * v * v;
        if let Some([lower, upper]) = self.limits {
            // Depth in the stop, and the rate at which it grows.
            let (depth, rate) = if q < lower { (lower - q, -v) } else { (q - upper, v) };
            if depth > 0.0 {
                let (spring, brake) = (self.stop_stiffness * depth, self.stop_damping * rate);
                loss += if brake > -spring { brake * rate } else { -spring * rate };
            }
        }
        loss
    }

    /// How far it is beyond its range, where its stop pushes it back, rad or m.
    pub(crate) fn depth_at_stop(&self, q: f64) -> f64 {
        self.limits.map_or(0.0, |[lower, upper]| (lower - q).max(q - upper).max(0.0))
    }

    /// Energy in its stop and in the bristle of its dry friction, J.
    pub(crate) fn calc_energy(&self, q: f64, dry: f64) -> f64 {
        let depth = self.depth_at_stop(q);
        let bristle = self.dry.as_ref().map_or(0.0, |law| law.stiffness);
        0.5 * (self.stop_stiffness * depth * depth + bristle * dry * dry)
    }
}
