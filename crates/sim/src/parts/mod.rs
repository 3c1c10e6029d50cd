//! What a world is made of: data, and the laws that a part states by itself.

mod actuator;
mod coordinate;
mod drive;
mod effect;
mod environment;
mod force;
mod mechanism;
mod pair;
mod push;
mod speed_limit;
mod vehicle;
mod weight;

pub use actuator::{Actuator, ActuatorKind, Command};
pub use coordinate::Coordinate;
pub use drive::{Drive, DriveAxis, DrivePath, Motion};
pub use effect::{
    Appendage, Axes, BodyAction, BodyEffect, BodyLaw, BodyMotion, BodyPlace, DryFriction, DryLevel, Effect, EffectKind,
    JointEffect, JointLaw, LineEffect, LineLaw, Load, REACH, Series, Slosh, Sphere,
};
pub use environment::Environment;
pub use force::Force;
pub use mechanism::{
    Anchor, Bushing, Capture, Latch, Mechanism, MechanismKind, MechanismMemory, MechanismStatus, Overload, PullIn,
    Side, Strength, Strut, StrutSides, Weld,
};
pub use pair::{Grain, PairLaw};
pub use push::Push;
pub use vehicle::{Base, Vehicle, VehicleSpec};

pub(crate) use actuator::nominal_effort;
pub(crate) use coordinate::{CoordinateForce, CoordinatePoint};
pub(crate) use effect::{Shaft, reversal_step};
pub(crate) use mechanism::{Deformation, MAX_ROWS, Moment, RowForce, Rows, calc_offset};
pub(crate) use speed_limit::{Branch, FALL, apply as apply_speed_limit};
