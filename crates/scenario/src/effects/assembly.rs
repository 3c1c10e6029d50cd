//! How an entry of a scenario becomes a part of a world: the stage of the build at which it acts, and the function that acts.
//!
//! The stages, in their order: mass properties (new values, then what is added to them), parts that are taken out of their links,
//! mounts, rotor inertia, everything else in the order of the file; what sensors make of a reading comes last, when something
//! is read. `build::effects` goes through them by matches without a catch-all: a new stage has to be thought of in each.

use crate::build::{Entry, Faults, Parts};
use crate::measure::{Gauge, SensorEntry, SensorModel};
use multibody::{Inertial, Joint};
use sim::{BodyLaw, Grain, JointLaw, LineLaw, Load, MechanismKind, PairLaw, Series, ShapeSpec};
use spatial::{InertiaError, Vec3};

/// The stage, and the function.
#[derive(Clone, Copy)]
pub(crate) enum Build {
    /// A new value of a link's mass properties, before the tree is built.
    SetMass(EditMass),
    /// What is added to a link's mass properties, after all new values.
    AddMass(EditMass),
    /// Inertia that a rotor reflects to its joint, before a gear takes it.
    Rotor(fn(&Entry<'_>, &mut Joint, &mut Faults<'_>)),
    /// A gear between rotor and joint; it takes the joint's reflected inertia. None where it is rigid.
    Gear(fn(&Entry<'_>, &mut Joint, &mut Faults<'_>) -> Option<GearSpec>),
    /// An effort on a joint's coordinate.
    Effort(fn(&Entry<'_>) -> JointLaw),
    /// An effort on a joint's coordinate, or a load on a body. None, with a fault, where the parameters are another place's.
    EffortOrLoad {
        /// At a joint.
        effort: fn(&Entry<'_>, &mut Faults<'_>) -> Option<JointLaw>,
        /// At a body.
        load: fn(&Entry<'_>, &mut Faults<'_>) -> Option<Load>,
    },
    /// What happens to a command on its way.
    Command(fn(&Entry<'_>) -> LineLaw),
    /// Another direction of a thruster, axes of its link.
    ThrustAxis(fn(&Entry<'_>, &Vec3) -> Vec3),
    /// A load on a body.
    Load(fn(&Entry<'_>) -> Load),
    /// A part that moves inside a body.
    Part(PartBuild),
    /// An acceleration of everything, W axes, m/s².
    Acceleration(fn(&Entry<'_>) -> Vec3),
    /// Other numbers in the law of a pair; the grain is along the second-named part.
    Pair(fn(&Entry<'_>, &mut PairLaw, Grain) -> Result<(), String>),
    /// Another pose of a contact's second-named part; the flag: it is not one of several that keep together.
    Pose(fn(&Entry<'_>, &mut ShapeSpec, bool)),
    /// A mount behind a contact part: it numbers coordinates and bodies anew, so it comes before all that is built on them.
    Mount(fn(&Entry<'_>, &mut Parts, &mut Faults<'_>)),
    /// Other numbers in the law of a mechanism.
    Mechanism(fn(&Entry<'_>, &mut MechanismKind)),
    /// What a sensor makes of a reading.
    Sensor(SensorBuild),
    /// A diagnosis, no model.
    NoModel,
}

/// Edits the mass properties of a link.
pub(crate) type EditMass = fn(&Entry<'_>, &mut Option<Inertial>, &mut Faults<'_>);

/// A gear without its coordinate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GearSpec {
    pub(crate) rotor: f64,
    pub(crate) stiffness: f64,
    pub(crate) damping: f64,
    pub(crate) gap: f64,
}

impl GearSpec {
    /// At a coordinate.
    pub(crate) fn at(self, coordinate: usize) -> Series {
        Series { coordinate, rotor: self.rotor, stiffness: self.stiffness, damping: self.damping, gap: self.gap }
    }
}

/// A part inside a body: in its nominal mass and inertia, locked at rest.
#[derive(Clone, Copy)]
pub(crate) struct PartBuild {
    /// The parameter that says how much of it there is.
    pub(crate) size: &'static str,
    /// What is left of the link without it; the nominal centre of mass in the link's frame, m.
    pub(crate) take_out: fn(&Entry<'_>, &Inertial, &Vec3) -> Result<Inertial, InertiaError>,
    /// How it moves; the nominal centre of mass in the link's frame, m.
    pub(crate) law: fn(&Entry<'_>, &Vec3) -> BodyLaw,
}

/// A fault of a sensor.
#[derive(Clone, Copy)]
pub(crate) struct SensorBuild {
    /// Adds it to what other effects make of the sensor.
    pub(crate) add: fn(&mut SensorModel, &SensorEntry<'_>),
    /// Why no quantity that it is meant for can have it.
    pub(crate) find_fault: fn(&[Gauge]) -> Option<&'static str>,
}
