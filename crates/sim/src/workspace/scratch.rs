//! What elements keep for the rest of a step.

use crate::parts::BodyMotion;
use spatial::{Twist, Wrench};

/// What one thruster does to its body, about the anchor of the body's vehicle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Thrust {
    pub actuator: usize,
    pub body: usize,
    pub wrench: Wrench,
}

/// What a force does to one body, about the anchor of the body's vehicle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pull {
    pub force: usize,
    pub at: (usize, usize),
    pub body: usize,
    pub wrench: Wrench,
}

/// Scratch of all forces.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pulls {
    pub pulls: Vec<Pull>,
    pub motions: Vec<BodyMotion>,
    pub wrenches: Vec<Wrench>,
}

/// A driven vehicle at the start of a step, about W's origin: its momentum, what others gave it so far, its base's twist.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct DriveStart {
    pub momentum: Wrench,
    pub given: Wrench,
    pub twist: Twist,
}

/// A joint that a free flight may hold: it is at rest on a stiff spring, whose swing would forbid long steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    /// Index into the world's `v`.
    pub coordinate: usize,
    /// Speed (m/s, rad/s) up to which it counts as at rest.
    pub speed: f64,
    /// Acceleration (m/s², rad/s²), free of its hold, up to which it may be held.
    pub acceleration: f64,
}
