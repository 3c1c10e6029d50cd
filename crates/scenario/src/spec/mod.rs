//! The scenario file as types: one struct per table, one enum per closed choice.
//!
//! Quantities keep the unit of the file, which their name ends in (`step_s`, `rpy_deg`); methods such as
//! [`PoseSpec::pose`] give SI values. The doc comments here are also the descriptions in the JSON Schema, and the
//! schema is what the file is checked against: a key exists when a field does.
//!
//! Rules that one field cannot say stand beside it as schema extensions, obeyed by `schema::check`:
//! `x-name` (a name that paths and places can carry), `x-refers` (what a text must name), `x-exactly-one` and
//! `x-at-most-one` (keys that exclude each other), `x-ordered` (first ≤ second), `x-ascending` (a list, or the first
//! numbers of a list of points), `x-nonzero`, `x-unit-quaternion`, `x-may-be-infinite`.

mod actuator;
mod campaign;
mod contact;
mod docking;
mod effect;
mod friction;
mod mechanism;
mod navigation;
mod pose;
mod regress;
mod sensor;
mod shape;
mod strategy;
mod tolerance;
mod vehicle;

pub use actuator::{Actuator, ActuatorKind, Drive, DriveAxis, DriveMotion, JointDrive};
pub use campaign::{
    Ball, Campaign, CampaignExpect, Correlate, Directions, Disperse, Expect, Mutation, Normal, Sampling, Scalar, Sweep,
    Uniform, Variant,
};
pub use contact::{ContactLaw, ContactRule, Grain, NormalLaw, Pivot, PointRule};
pub use docking::{Approach, Docking, KeepOut};
pub use effect::{Effect, ParamValue};
pub use friction::{BristleFriction, Dahl, ElastoPlastic, FrictionLaw, LuGre, RegularisedCoulomb};
pub use mechanism::{
    Capture, Hold, Latch, Mechanism, MechanismKind, MechanismSide, Overload, PerAxis, Strut, StrutSides, Weld,
};
pub use navigation::Navigation;
pub use pose::{PoseSpec, TwistSpec};
pub use regress::Margin;
pub use sensor::{MechanismEnd, Sensor, SensorKind};
pub use shape::{Shape, ShapeKind};
pub use strategy::{Command, OneOrMany, Replay, Schedule, SoftDock, Strategy, TrackAndGrasp};
pub use tolerance::Tolerance;
pub use vehicle::{Base, BaseAxis, BaseKind, EndEffectorPose, JointStart, PartialBase, Vehicle};

use crate::document::Source;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// One scenario: what is there, how it moves, what is done and what is expected.
///
/// Built by [`crate::load`] or [`crate::parse`], which check it; every quantity is then finite and within its range.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// Name of the scenario, also of its recordings.
    #[schemars(length(min = 1))]
    pub name: String,
    /// What the scenario shows, in a sentence or two.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// Seed of every random number of the run. Mandatory, so that a run can always be repeated.
    #[schemars(range(max = 9_223_372_036_854_775_807_u64))]
    pub seed: u64,
    /// Simulated time, s.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub duration_s: f64,
    /// How time advances.
    #[serde(default)]
    pub integrator: Integrator,
    /// What surrounds the vehicles.
    #[serde(default)]
    pub environment: Environment,
    /// The vehicles: robots, spacecraft, test articles.
    #[serde(rename = "vehicle")]
    #[schemars(length(min = 1))]
    pub vehicles: Vec<Vehicle>,
    /// Collision shapes that the URDF cannot say, or that the scenario adds.
    #[serde(default, rename = "shape", skip_serializing_if = "Vec::is_empty")]
    pub shapes: Vec<Shape>,
    /// The law of contact pairs that no `[[contact]]` names.
    #[serde(default)]
    pub contact_default: ContactLaw,
    /// Laws of named contact pairs; of several entries that match a pair the last one decides.
    #[serde(default, rename = "contact", skip_serializing_if = "Vec::is_empty")]
    pub contacts: Vec<ContactRule>,
    /// Struts, bushings, latches and welds.
    #[serde(default, rename = "mechanism", skip_serializing_if = "Vec::is_empty")]
    pub mechanisms: Vec<Mechanism>,
    /// Joint motors, thrusters and wheels.
    #[serde(default, rename = "actuator", skip_serializing_if = "Vec::is_empty")]
    pub actuators: Vec<Actuator>,
    /// What is measured, where, how often and how badly.
    #[serde(default, rename = "sensor", skip_serializing_if = "Vec::is_empty")]
    pub sensors: Vec<Sensor>,
    /// Prescribed motions: a stage, a shaker, a table.
    #[serde(default, rename = "drive", skip_serializing_if = "Vec::is_empty")]
    pub drives: Vec<Drive>,
    /// Guidance and control.
    #[serde(default)]
    pub strategy: Strategy,
    /// What the strategy knows.
    #[serde(default, skip_serializing_if = "Navigation::is_absent")]
    pub navigation: Navigation,
    /// Physics beyond the nominal model.
    #[serde(default, rename = "effect", skip_serializing_if = "Vec::is_empty")]
    pub effects: Vec<Effect>,
    /// How far nominal numbers may be off, for a diagnosis.
    #[serde(default, skip_serializing_if = "Tolerance::is_exact")]
    pub tolerance: Tolerance,
    /// What counts as docked; metrics and the outcome of a docking come with it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub docking: Option<Docking>,
    /// Shapes that must stay apart.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub keep_out: Vec<KeepOut>,
    /// What a regression run must show.
    #[serde(default, rename = "expect", skip_serializing_if = "Vec::is_empty")]
    pub expects: Vec<Expect>,
    /// How far a regression run may be from its baseline.
    #[serde(default, rename = "margin", skip_serializing_if = "Vec::is_empty")]
    pub margins: Vec<Margin>,
    /// Changes that must end otherwise.
    #[serde(default, rename = "mutation", skip_serializing_if = "Vec::is_empty")]
    pub mutations: Vec<Mutation>,
    /// What is recorded.
    #[serde(default)]
    pub output: Output,
    /// Dispersed runs of this scenario.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub campaign: Option<Campaign>,
    /// Where every value was written.
    #[serde(skip)]
    pub source: Source,
}

/// How time advances.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Integrator {
    /// The scheme.
    pub kind: IntegratorKind,
    /// Fixed step, s.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 1.0))]
    pub step_s: f64,
}

impl Default for Integrator {
    fn default() -> Self {
        Self { kind: IntegratorKind::ImplicitEuler, step_s: 1e-3 }
    }
}

/// The integration schemes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum IntegratorKind {
    /// Linearly implicit in contact, friction and joint springs; first order; stiff contact at 1 ms.
    ImplicitEuler,
    /// Implicit midpoint; second order.
    ImplicitMidpoint,
    /// Explicit forces, new velocities move the positions; first order.
    SemiImplicitEuler,
    /// Classical Runge–Kutta; fourth order on smooth problems.
    Rk4,
}

/// What surrounds the vehicles.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Environment {
    /// Nothing: no gravity, no medium.
    #[default]
    DeepSpace,
    /// Motion relative to a point on a circular orbit; W axes: x radial outward, y along track, z along the orbit normal.
    Orbit {
        /// Mean motion n = √(μ/a³), rad/s.
        #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 0.01))]
        mean_motion_rad_per_s: f64,
        /// Adds the gravity-gradient torque on every body.
        #[serde(default)]
        gravity_gradient: bool,
    },
    /// A laboratory: uniform gravity.
    Lab {
        /// Acceleration of free fall in W axes, m/s².
        #[serde(default = "standard_gravity")]
        gravity_m_per_s2: [f64; 3],
    },
    /// A flat floor without friction: no weight, bases that move in the plane.
    AirBearing,
}

/// Free fall at the surface, z up, m/s².
fn standard_gravity() -> [f64; 3] {
    [0.0, 0.0, -9.80665]
}

/// What is recorded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Output {
    /// Samples per second of simulated time; bounds the size of a recording, whatever the step.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub log_rate_hz: f64,
    /// Which channels are kept, by glob.
    pub channels: Vec<String>,
}

impl Default for Output {
    fn default() -> Self {
        Self { log_rate_hz: 100.0, channels: vec!["*".to_owned()] }
    }
}
