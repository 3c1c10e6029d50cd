//! How a diagnosis looks for an effect: candidates at the places of a rig, and what it has to know of their cost and their names.
//!
//! An effect is fitted in coordinates and screened at points ([`candidate`](super::candidate)). All that tells one effect from another in a search
//! stands here, as data of its definition.

use super::candidate::{Candidate, Coordinate};
use super::facts::{ActuatorFact, BodyFact, ContactFact, JointFact, MechanismFact, SensorFact, Survey};
use crate::spec::Tolerance;

/// How a diagnosis looks for an effect.
#[derive(Clone, Copy)]
pub struct Identify {
    /// Where it could act, and how it is fitted and screened there.
    pub candidates: Candidates,
    /// Kind of claim.
    pub tier: Tier,
    /// Standard deviations of its coordinates, by a scenario's tolerances: where it corrects a nominal number that has one.
    pub tolerance: Option<Deviations>,
    /// What it has to bring at a place beside what its numbers cost, in the criterion.
    pub penalty: Option<fn(&str) -> f64>,
    /// The laws that it becomes at a place where some of its numbers do nothing, and likelier readings of the same thing there.
    pub nested: Option<Nested>,
    /// How amplitudes of secants become coordinates to start a fit with.
    pub start: Start,
    /// How many minima its cost has.
    pub minima: Minima,
    /// What it concerns.
    pub concerns: Concerns,
}

/// At which places of a rig there are candidates.
#[derive(Clone, Copy)]
pub enum Candidates {
    /// At joints with one coordinate.
    Joint(AtJoint),
    /// At actuators whose command was recorded: drives of joints, thrusters, all thrusters together.
    Actuator(fn(&ActuatorFact) -> Vec<Candidate>),
    /// At bodies.
    Body(AtBody),
    /// At joints and at bodies.
    JointAndBody {
        /// At joints with one coordinate.
        joint: AtJoint,
        /// At bodies.
        body: AtBody,
    },
    /// Everywhere at once.
    World(fn(&Survey<'_>) -> Vec<Candidate>),
    /// At contact pairs.
    Contact(fn(&ContactFact) -> Vec<Candidate>),
    /// At mechanisms.
    Mechanism(fn(&MechanismFact) -> Vec<Candidate>),
    /// At sensors.
    Sensor(fn(&SensorFact) -> Vec<Candidate>),
    /// Nowhere: it is what a diagnosis says when it finds no other.
    Nowhere,
}

/// Standard deviations of coordinates by a scenario's tolerances.
pub type Deviations = fn(&Tolerance, &[Coordinate]) -> Vec<f64>;
/// Nested laws at a place and some coordinates.
pub type Nested = fn(&str, &[f64]) -> Vec<Alternative>;
/// Candidates at a joint.
pub type AtJoint = fn(&JointFact, &Survey<'_>) -> Vec<Candidate>;
/// Candidates at a body.
pub type AtBody = fn(&BodyFact, &Survey<'_>) -> Vec<Candidate>;

impl Candidates {
    /// Those at a joint.
    pub fn at_joint(&self, joint: &JointFact, survey: &Survey<'_>) -> Vec<Candidate> {
        match self {
            Self::Joint(of) | Self::JointAndBody { joint: of, .. } => of(joint, survey),
            Self::Actuator(_)
            | Self::Body(_)
            | Self::World(_)
            | Self::Contact(_)
            | Self::Mechanism(_)
            | Self::Sensor(_)
            | Self::Nowhere => Vec::new(),
        }
    }

    /// Those at an actuator.
    pub fn at_actuator(&self, actuator: &ActuatorFact) -> Vec<Candidate> {
        match self {
            Self::Actuator(of) => of(actuator),
            Self::Joint(_)
            | Self::Body(_)
            | Self::JointAndBody { .. }
            | Self::World(_)
            | Self::Contact(_)
            | Self::Mechanism(_)
            | Self::Sensor(_)
            | Self::Nowhere => Vec::new(),
        }
    }

    /// Those at a body.
    pub fn at_body(&self, body: &BodyFact, survey: &Survey<'_>) -> Vec<Candidate> {
        match self {
            Self::Body(of) | Self::JointAndBody { body: of, .. } => of(body, survey),
            Self::Joint(_)
            | Self::Actuator(_)
            | Self::World(_)
            | Self::Contact(_)
            | Self::Mechanism(_)
            | Self::Sensor(_)
            | Self::Nowhere => Vec::new(),
        }
    }

    /// Those of the whole rig.
    pub fn at_world(&self, survey: &Survey<'_>) -> Vec<Candidate> {
        match self {
            Self::World(of) => of(survey),
            Self::Joint(_)
            | Self::Actuator(_)
            | Self::Body(_)
            | Self::JointAndBody { .. }
            | Self::Contact(_)
            | Self::Mechanism(_)
            | Self::Sensor(_)
            | Self::Nowhere => Vec::new(),
        }
    }

    /// Those at a contact.
    pub fn at_contact(&self, contact: &ContactFact) -> Vec<Candidate> {
        match self {
            Self::Contact(of) => of(contact),
            Self::Joint(_)
            | Self::Actuator(_)
            | Self::Body(_)
            | Self::JointAndBody { .. }
            | Self::World(_)
            | Self::Mechanism(_)
            | Self::Sensor(_)
            | Self::Nowhere => Vec::new(),
        }
    }

    /// Those at a mechanism.
    pub fn at_mechanism(&self, mechanism: &MechanismFact) -> Vec<Candidate> {
        match self {
            Self::Mechanism(of) => of(mechanism),
            Self::Joint(_)
            | Self::Actuator(_)
            | Self::Body(_)
            | Self::JointAndBody { .. }
            | Self::World(_)
            | Self::Contact(_)
            | Self::Sensor(_)
            | Self::Nowhere => Vec::new(),
        }
    }

    /// Those at a sensor.
    pub fn at_sensor(&self, sensor: &SensorFact) -> Vec<Candidate> {
        match self {
            Self::Sensor(of) => of(sensor),
            Self::Joint(_)
            | Self::Actuator(_)
            | Self::Body(_)
            | Self::JointAndBody { .. }
            | Self::World(_)
            | Self::Contact(_)
            | Self::Mechanism(_)
            | Self::Nowhere => Vec::new(),
        }
    }
}

/// Whether an effect corrects a number that the nominal model has, or adds physics.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Tier {
    /// A nominal number.
    Nominal,
    /// Physics or a fault.
    Exotic,
}

/// How amplitudes of the secants of a screen point become coordinates.
///
/// Secants are changes of the residual from nominal to a point; their amplitudes add up to a strength.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// The mean of the points, weighted by amplitude.
    Mean,
    /// The sum of the points: the effect is linear in its coordinates.
    Sum,
    /// The mean, but the first coordinate is that of the first point times the strength.
    Proportional,
    /// The same where the first coordinate is a logarithm.
    LogProportional,
    /// The mean, but the first coordinate, a logarithm, falls with the strength.
    LogInverse,
    /// The points are along six axes, and the effect goes with the dyad of the vector coordinate: the largest principal axis of the sum. Where the first
    /// coordinate is a mass that is free, that and its first moment add up.
    Dyad,
}

/// How many minima the cost of an effect has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Minima {
    /// One, or few enough that a fit from the best point ends in the right one.
    One,
    /// One for each frequency, or a long flat one along a speed or a stiffness.
    Several,
}

/// What an effect concerns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Concerns {
    /// How things move, or when it is read.
    Motion,
    /// Nothing but how a sensor reads what there is to be read at the time.
    Reading,
}

/// Another reading of what a candidate has become.
#[derive(Clone, Debug, PartialEq)]
pub struct Alternative {
    /// Name of the effect.
    pub name: &'static str,
    /// Whether it stands at a contact, and not at the same place.
    pub is_at_contact: bool,
    /// Its coordinates.
    pub coordinates: Vec<f64>,
    /// Those of them that stay as they are.
    pub held: Vec<usize>,
}

impl Alternative {
    /// Another effect at the same place.
    pub fn here(effect: &super::EffectDef, coordinates: Vec<f64>) -> Self {
        Self { name: effect.name, is_at_contact: false, coordinates, held: Vec::new() }
    }

    /// Another effect at any contact.
    pub fn at_contact(effect: &super::EffectDef, coordinates: Vec<f64>) -> Self {
        Self { is_at_contact: true, ..Self::here(effect, coordinates) }
    }
}
