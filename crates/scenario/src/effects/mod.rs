//! Effects: physics beyond the nominal model. One file defines an effect, or a small family; one list names them all.
//!
//! A definition ([`EffectDef`]) says all that is to be said of an effect but its law, which stands in `sim`: its name, where it may act, its
//! parameters with units and ranges, its words for a reader, equation and source, how an entry of a scenario is built, and how a diagnosis looks for
//! it. The scenario's checks, the JSON schema, the build, the diagnosis with its report, the score and the guide's page read it here.
//! To add one: its file, its place in [`ALL`], and its law in `sim`. What is missing from it does not compile.
//!
//! Values are SI, without suffix. At its neutral parameters an effect changes nothing: [`Neutral`] says what they are.

mod assembly;
pub mod candidate;
mod definition;
pub mod facts;
pub mod identify;
mod parameter;
pub mod reference;
mod unit;

mod actuator_delay;
mod actuator_gain;
mod actuator_lag;
mod actuator_misalignment;
mod actuator_saturation;
mod body_inertial;
mod constant_load;
mod contact;
mod contact_geometry_offset;
mod contact_normal;
mod drag;
mod flexible_appendage;
mod friction_anisotropy;
mod friction_bristle_stiffness;
mod friction_coefficient;
mod friction_dwell_time;
mod friction_stribeck;
mod friction_viscous;
mod gravity_gradient;
mod internal_dissipation;
mod joint;
mod joint_armature;
mod joint_cable_stiffness;
mod joint_dry_friction;
mod joint_gear;
mod joint_offset;
mod joint_torque_ripple;
mod joint_viscous_friction;
mod mechanism;
mod mount_compliance;
mod payload;
mod periodic_disturbance;
mod sensor_delay;
mod sensor_misalignment;
mod sensor_value;
mod slosh;
mod tether_stiffness;
mod tilt;
mod unknown;

pub use actuator_delay::ACTUATOR_DELAY;
pub use actuator_gain::ACTUATOR_GAIN;
pub use actuator_lag::ACTUATOR_LAG;
pub use actuator_misalignment::ACTUATOR_MISALIGNMENT;
pub use actuator_saturation::ACTUATOR_SATURATION;
pub use body_inertial::{BODY_COM, BODY_INERTIA, BODY_MASS};
pub use constant_load::{CONSTANT_FORCE, CONSTANT_TORQUE};
pub use contact_geometry_offset::CONTACT_GEOMETRY_OFFSET;
pub use contact_normal::{ADHESION, CONTACT_DAMPING, CONTACT_STIFFNESS};
pub use definition::{Corrects, EffectDef, PlaceKind, Shown};
pub use drag::{ANGULAR_DAMPING, LINEAR_DRAG, QUADRATIC_DRAG};
pub use flexible_appendage::FLEXIBLE_APPENDAGE;
pub use friction_anisotropy::FRICTION_ANISOTROPY;
pub use friction_bristle_stiffness::FRICTION_BRISTLE_STIFFNESS;
pub use friction_coefficient::FRICTION_COEFFICIENT;
pub use friction_dwell_time::FRICTION_DWELL_TIME;
pub use friction_stribeck::FRICTION_STRIBECK;
pub use friction_viscous::FRICTION_VISCOUS;
pub use gravity_gradient::GRAVITY_GRADIENT;
pub use internal_dissipation::INTERNAL_DISSIPATION;
pub use joint_armature::JOINT_ARMATURE;
pub use joint_cable_stiffness::JOINT_CABLE_STIFFNESS;
pub use joint_dry_friction::{JOINT_COULOMB_FRICTION, JOINT_FRICTION_ASYMMETRY, JOINT_STRIBECK_FRICTION};
pub use joint_gear::{JOINT_BACKLASH, JOINT_ELASTICITY};
pub use joint_offset::JOINT_OFFSET;
pub use joint_torque_ripple::JOINT_TORQUE_RIPPLE;
pub use joint_viscous_friction::{JOINT_QUADRATIC_FRICTION, JOINT_VISCOUS_ASYMMETRY, JOINT_VISCOUS_FRICTION};
pub use mechanism::{MECHANISM_DAMPING, MECHANISM_STIFFNESS};
pub use mount_compliance::MOUNT_COMPLIANCE;
pub use parameter::{Neutral, Parameter, Shape};
pub use payload::PAYLOAD;
pub use periodic_disturbance::PERIODIC_DISTURBANCE;
pub use sensor_delay::SENSOR_DELAY;
pub use sensor_misalignment::SENSOR_MISALIGNMENT;
pub use sensor_value::{SENSOR_BIAS, SENSOR_SCALE};
pub use slosh::SLOSH;
pub use tether_stiffness::TETHER_STIFFNESS;
pub use tilt::TILT;
pub use unit::Unit;
pub use unknown::UNKNOWN;

pub(crate) use assembly::{Build, EditMass, GearSpec, PartBuild, SensorBuild};

// What a definition's file needs of the others.
use crate::build::{Entry, Faults};
use crate::spec::Tolerance;
use candidate::{Along, Candidate, Coordinate, Encoding, ScreenPoint, around, dyad_axes, log_grid};
use facts::{ActuatorFact, BodyFact, ContactFact, JointFact, MechanismFact, SensorFact, Survey};
use identify::{Alternative, Candidates, Concerns, Identify, Minima, Start, Tier};
use sim::Grain;

/// All of them. At a place a diagnosis asks them in this order.
pub static ALL: [&EffectDef; 51] = [
    &JOINT_VISCOUS_FRICTION,
    &JOINT_COULOMB_FRICTION,
    &JOINT_STRIBECK_FRICTION,
    &JOINT_FRICTION_ASYMMETRY,
    &JOINT_VISCOUS_ASYMMETRY,
    &JOINT_QUADRATIC_FRICTION,
    &JOINT_OFFSET,
    &JOINT_CABLE_STIFFNESS,
    &JOINT_ELASTICITY,
    &JOINT_BACKLASH,
    &JOINT_TORQUE_RIPPLE,
    &JOINT_ARMATURE,
    &ACTUATOR_GAIN,
    &ACTUATOR_DELAY,
    &ACTUATOR_LAG,
    &ACTUATOR_SATURATION,
    &ACTUATOR_MISALIGNMENT,
    &BODY_MASS,
    &BODY_COM,
    &BODY_INERTIA,
    &PAYLOAD,
    &CONSTANT_FORCE,
    &LINEAR_DRAG,
    &QUADRATIC_DRAG,
    &TETHER_STIFFNESS,
    &CONSTANT_TORQUE,
    &ANGULAR_DAMPING,
    &INTERNAL_DISSIPATION,
    &GRAVITY_GRADIENT,
    &SLOSH,
    &FLEXIBLE_APPENDAGE,
    &PERIODIC_DISTURBANCE,
    &TILT,
    &CONTACT_STIFFNESS,
    &CONTACT_DAMPING,
    &ADHESION,
    &CONTACT_GEOMETRY_OFFSET,
    &MOUNT_COMPLIANCE,
    &FRICTION_COEFFICIENT,
    &FRICTION_STRIBECK,
    &FRICTION_BRISTLE_STIFFNESS,
    &FRICTION_VISCOUS,
    &FRICTION_ANISOTROPY,
    &FRICTION_DWELL_TIME,
    &MECHANISM_STIFFNESS,
    &MECHANISM_DAMPING,
    &SENSOR_BIAS,
    &SENSOR_SCALE,
    &SENSOR_MISALIGNMENT,
    &SENSOR_DELAY,
    &UNKNOWN,
];

/// The effect of that name.
pub fn find(name: &str) -> Option<&'static EffectDef> {
    catalogue().find(|effect| effect.name == name)
}

/// All effects, in the order of [`ALL`].
pub fn catalogue() -> impl Iterator<Item = &'static EffectDef> + Clone {
    ALL.iter().copied()
}

/// Those that are models: all but what a diagnosis says when it finds none.
pub fn models() -> impl Iterator<Item = &'static EffectDef> + Clone {
    catalogue().filter(|effect| !matches!(effect.build, Build::NoModel))
}
