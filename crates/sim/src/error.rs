//! What can go wrong: a model that cannot be, and a run that diverges.

use thiserror::Error;

/// Why a world cannot be built.
#[derive(Debug, Error)]
pub enum ModelError {
    /// The step is not a positive number.
    #[error("step {0} s is not a positive number; set integrator.step_s, 1e-3 is usual")]
    Step(f64),
    /// Two vehicles share a name.
    #[error("vehicle \"{0}\" is defined twice; give each its own name")]
    DuplicateVehicle(String),
    /// A base that moves has no mass behind it.
    #[error("vehicle \"{0}\" has no mass and cannot float; set base = \"fixed\" or give its links an <inertial>")]
    MasslessBase(String),
    /// A base that turns about an axis slides in one direction across it only.
    #[error(
        "vehicle \"{0}\": a base that turns about an axis must be free in both directions across it, or in none; for \
         an air bearing use free = [\"x\", \"y\", \"yaw\"]"
    )]
    Mask(String),
    /// A joint and one that follows it cannot both be within their limits.
    #[error(
        "vehicle \"{vehicle}\": joint \"{}\" may stand at {} … {}, and \"{}\", which follows it, lets it stand at {} … {} \
         only; widen a <limit>, or change multiplier or offset of the <mimic>",
        .range.leader, .range.own[0], .range.own[1], .range.follower, .range.allowed[0], .range.allowed[1]
    )]
    EmptyRange {
        /// Its name.
        vehicle: String,
        /// The two joints and their ranges.
        range: multibody::EmptyRange,
    },
    /// An actuator points at no single-coordinate joint.
    #[error("actuator \"{0}\" needs a revolute or prismatic joint that follows no other")]
    Actuator(String),
    /// A release that belongs to no latch.
    #[error("actuator \"{0}\" releases a mechanism that is no latch")]
    LatchRelease(String),
    /// A mechanism that cannot be.
    #[error("mechanism \"{name}\": {fault}")]
    Mechanism {
        /// Its name.
        name: String,
        /// What is wrong with it.
        fault: String,
    },
    /// A dead weight that nothing holds, or that lies on nothing flat.
    #[error(
        "contact \"{0}\": a dead weight is a guided body on a half-space that does not turn; give the body's vehicle a base \
         without the direction across the plane, {{ free = [\"x\", \"y\"] }}, and the plane a shape of kind half-space"
    )]
    DeadWeight(String),
    /// A drive that cannot be.
    #[error("drive \"{name}\" {fault}")]
    Drive {
        /// Its name.
        name: String,
        /// What is wrong with it.
        fault: String,
    },
    /// An effect that cannot be.
    #[error("effect \"{name}\": {fault}")]
    Effect {
        /// Its name and place.
        name: String,
        /// What is wrong with it.
        fault: String,
    },
    /// A force of one's own that cannot be.
    #[error("force \"{name}\" {fault}")]
    Force {
        /// Its name.
        name: String,
        /// What is wrong with it.
        fault: String,
    },
    /// Contact geometry that cannot be.
    #[error(transparent)]
    Contact(#[from] contact::ContactError),
}

/// Why a run ended early.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum StepError {
    /// A number stopped being finite, or a speed left every physical range.
    #[error(
        "diverged at t = {time:.6} s in body \"{body}\" ({quantity}); the last good state is at t = {last_good:.6} s. \
         Try a smaller step or a softer contact"
    )]
    Diverged {
        /// Time of the failed step's end, s.
        time: f64,
        /// The body that failed first.
        body: String,
        /// What failed.
        quantity: String,
        /// Time of the last good state, s.
        last_good: f64,
    },
}
