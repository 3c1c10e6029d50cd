//! What acts on single joint coordinates, and the actuators of a world.
//!
//! A coordinate's law, evaluated at the predicted end of the step (q, v):
//!
//!   τ = −b v + stop(q, v) + dry friction + Σ drives,     drive = clamp(k_p (q_ref − q) + k_d (v_ref − v) + τ_ff, ±limit)
//!   stop = max(0, k (lower − q) − c v) below, likewise above; never pulls
//!
//! The stop's stiffness brings the joint to rest within about 10 mrad (1 mm) of overtravel at its full effort, up to
//! 1e5 N·m/rad (1e6 N/m). Dry
//! friction is the bristle of [`friction`] in one dimension, with the deflection at breakaway of 3e-4 rad or m.

use friction::{Bristle, Trial};
use multibody::{Joint, JointKind};
use serde::{Deserialize, Serialize};
use spatial::Vec3;

/// An actuator of the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Actuator {
    /// Unique name.
    pub name: String,
    /// What it does with a command.
    pub kind: ActuatorKind,
}

/// What an actuator does with its [`Command`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ActuatorKind {
    /// Effort on one joint coordinate (a reaction wheel's motor too).
    JointEffort {
        /// Index into `v`.
        coordinate: usize,
        /// N·m or N.
        limit: f64,
    },
    /// Position and rate control of one joint coordinate; implicit in the default integrator.
    JointDrive {
        /// Index into `v`.
        coordinate: usize,
        /// N·m/rad or N/m.
        stiffness: f64,
        /// N·m·s/rad or N·s/m.
        damping: f64,
        /// N·m or N.
        limit: f64,
    },
    /// A force fixed in a body; `effort` of the command, clamped to 0 … max.
    Thruster {
        /// Global body.
        body: usize,
        /// Nozzle, body frame, m.
        position: Vec3,
        /// Force on the body, unit vector, body axes.
        direction: Vec3,
        /// N.
        max_force: f64,
    },
    /// Opens a latch while the command's `effort` is above ½.
    LatchRelease {
        /// Index into the model's mechanisms.
        mechanism: usize,
    },
}

/// What a controller asks of one actuator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Command {
    /// Reference position of a drive, rad or m.
    pub position: f64,
    /// Reference rate of a drive, rad/s or m/s.
    pub velocity: f64,
    /// Effort or feed-forward, N·m or N.
    pub effort: f64,
}

/// The passive laws of one coordinate, and who drives it.
#[derive(Clone, Debug, Default, PartialEq)]
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
    /// Actuators that act here.
    pub actuators: Vec<usize>,
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
            actuators: Vec::new(),
        }
    }

    /// Whether nothing acts here.
    pub fn is_idle(&self) -> bool {
        self.damping == 0.0 && self.dry.is_none() && self.limits.is_none() && self.actuators.is_empty()
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
}

/// Effort on a coordinate, −∂τ/∂v', and the part that actuators give.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CoordinateForce {
    pub effort: f64,
    pub slope: f64,
    pub driven: f64,
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

    /// The law of this coordinate at the rate `v_new`.
    pub(crate) fn eval(
        &self,
        at: &CoordinatePoint,
        v_new: f64,
        actuators: &[Actuator],
        commands: &[Command],
    ) -> CoordinateForce {
        let (q, v) = (at.q_base + at.beta * v_new, (1.0 - at.theta) * at.v_start + at.theta * v_new);
        let mut out =
            CoordinateForce { effort: -self.damping * v, slope: self.damping * at.theta, ..Default::default() };
        if let Some([lower, upper]) = self.limits {
            let (below, above) = (lower - q, q - upper);
            let (depth, sign) = if below > 0.0 { (below, 1.0) } else { (above, -1.0) };
            let push = self.stop_stiffness * depth - sign * self.stop_damping * v;
            if depth > 0.0 && push > 0.0 {
                out.effort += sign * push;
                out.slope += self.stop_stiffness * at.beta + self.stop_damping * at.theta;
            }
        }
        if let Some(law) = &self.dry {
            let s = Vec3::new(at.dry_start, 0.0, 0.0);
            let slip = Vec3::new(v, 0.0, 0.0);
            let s_trial = s + Vec3::new(at.moved_base + at.beta * v_new, 0.0, 0.0);
            let brush =
                law.eval(&Trial { s, s_trial, slip, elapsed: at.elapsed, normal_force: 1.0, ..Trial::default() });
            out.effort += brush.force.x;
            out.slope += if brush.sticks { brush.by_deflection.across * at.beta } else { 0.0 };
        }
        for &index in &self.actuators {
            let (effort, slope) = drive(&actuators[index].kind, &commands[index], at, q, v);
            out.effort += effort;
            out.driven += effort;
            out.slope += slope;
        }
        out
    }
}

fn drive(kind: &ActuatorKind, command: &Command, at: &CoordinatePoint, q: f64, v: f64) -> (f64, f64) {
    match *kind {
        ActuatorKind::JointEffort { limit, .. } => (command.effort.clamp(-limit, limit), 0.0),
        ActuatorKind::JointDrive { stiffness, damping, limit, .. } => {
            let asked = stiffness * (command.position - q) + damping * (command.velocity - v) + command.effort;
            if asked.abs() > limit {
                return (limit.copysign(asked), 0.0);
            }
            (asked, stiffness * at.beta + damping * at.theta)
        }
        ActuatorKind::Thruster { .. } | ActuatorKind::LatchRelease { .. } => (0.0, 0.0),
    }
}
