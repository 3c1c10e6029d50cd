//! `[[effect]]` entries → edits of the robots, of the parts of the world, and effects of the simulation.
//!
//! Three passes: [`check`] holds every entry against the catalogue; [`edit_robots`] changes masses before the trees are
//! built; [`apply`] changes everything else once shapes, actuators and mechanisms stand. One match over the names says
//! which family an effect belongs to; each family is a file.

mod body;
mod contact;
mod entry;
mod inertia;
mod joint;
mod line;
mod mount;
mod places;

pub(super) use entry::Entry;

pub(super) use body::{NominalComs, nominal_coms};

use super::actuators::ActuatorTable;
use super::faults::Faults;
use crate::effects::{EffectName, PlaceKind};
use multibody::RobotDescription;
use sim::{Environment, Mechanism, PairLaw, ShapeSpec, VehicleSpec};

/// The parts of a world that effects may change, before it is built.
pub(super) struct Parts {
    pub(super) vehicles: Vec<VehicleSpec>,
    pub(super) nominal_coms: NominalComs,
    pub(super) table: ActuatorTable,
    pub(super) shapes: Vec<ShapeSpec>,
    pub(super) pairs: Vec<([usize; 2], PairLaw)>,
    pub(super) mechanisms: Vec<Mechanism>,
    pub(super) environment: Environment,
    /// What the world shall hold beyond all that.
    pub(super) effects: Vec<sim::Effect>,
}

/// What an effect is built by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Family {
    /// More inertia of a joint: before a gear takes it.
    Armature,
    Joint,
    Line,
    Inertia,
    Body,
    Contact,
    Sensor,
    /// A diagnosis, no model.
    None,
}

/// The family of an effect at a kind of place.
fn family(name: EffectName, place: PlaceKind) -> Family {
    use EffectName as N;
    match name {
        N::JointArmature => Family::Armature,
        N::JointViscousFriction
        | N::JointCoulombFriction
        | N::JointStribeckFriction
        | N::JointFrictionAsymmetry
        | N::JointViscousAsymmetry
        | N::JointQuadraticFriction
        | N::JointOffset
        | N::JointBacklash
        | N::JointElasticity
        | N::JointTorqueRipple
        | N::JointCableStiffness => Family::Joint,
        N::PeriodicDisturbance if place == PlaceKind::Joint => Family::Joint,
        N::ActuatorGain | N::ActuatorDelay | N::ActuatorLag | N::ActuatorSaturation | N::ActuatorMisalignment => {
            Family::Line
        }
        N::Payload | N::BodyMass | N::BodyCom | N::BodyInertia => Family::Inertia,
        N::ConstantForce
        | N::ConstantTorque
        | N::Tilt
        | N::LinearDrag
        | N::QuadraticDrag
        | N::AngularDamping
        | N::InternalDissipation
        | N::GravityGradient
        | N::TetherStiffness
        | N::Slosh
        | N::FlexibleAppendage
        | N::PeriodicDisturbance => Family::Body,
        N::ContactStiffness
        | N::ContactDamping
        | N::FrictionCoefficient
        | N::FrictionStribeck
        | N::FrictionBristleStiffness
        | N::FrictionViscous
        | N::FrictionAnisotropy
        | N::FrictionDwellTime
        | N::Adhesion
        | N::ContactGeometryOffset
        | N::MountCompliance => Family::Contact,
        N::SensorBias | N::SensorScale | N::SensorDelay | N::SensorMisalignment => Family::Sensor,
        N::Unknown => Family::None,
    }
}

/// Every entry of the file, held against the catalogue; those at fault are left out and told.
pub(super) fn check<'a>(scenario: &'a crate::spec::Scenario, faults: &mut Faults<'_>) -> Vec<Entry<'a>> {
    let all = scenario.effects.iter().enumerate();
    all.filter_map(|(i, effect)| Entry::check(i, effect, faults)).collect()
}

/// Changes masses, centres of mass and inertias, before the trees are built.
pub(super) fn edit_robots(
    plan: &[Entry<'_>],
    (names, robots): (&[&str], &mut [RobotDescription]),
    faults: &mut Faults<'_>,
) {
    let coms = nominal_coms(robots);
    // New values first, then what is added to them: whatever the order in the file.
    let inertial = plan.iter().filter(|e| family(e.name, e.kind) == Family::Inertia);
    let (added, set): (Vec<_>, Vec<_>) = inertial.partition(|e| e.name == EffectName::Payload);
    for entry in set.into_iter().chain(added) {
        inertia::edit(entry, (names, robots), faults);
    }
    for entry in plan {
        match family(entry.name, entry.kind) {
            Family::Inertia => {}
            Family::Body => body::edit_robots(entry, (names, robots, &coms), faults),
            Family::Contact => contact::edit_robots(entry, (names, robots), faults),
            Family::Armature | Family::Joint | Family::Line | Family::Sensor | Family::None => {}
        }
    }
}

/// Changes the parts of the world, and adds what acts in it.
pub(super) fn apply(plan: &[Entry<'_>], parts: &mut Parts, faults: &mut Faults<'_>) {
    // A mount numbers coordinates and bodies anew, before anything is built on them.
    for entry in plan.iter().filter(|e| e.name == EffectName::MountCompliance) {
        mount::add(entry, parts, faults);
    }
    // A gear takes the whole reflected inertia of its joint, so that comes first.
    for entry in plan.iter().filter(|e| family(e.name, e.kind) == Family::Armature) {
        joint::add_armature(entry, parts, faults);
    }
    for entry in plan {
        match family(entry.name, entry.kind) {
            Family::Joint => joint::apply(entry, parts, faults),
            Family::Line => line::apply(entry, parts, faults),
            Family::Body => body::apply(entry, parts, faults),
            Family::Contact => contact::apply(entry, parts, faults),
            Family::None => {
                entry.fault(faults, "is what a diagnosis says of physics without a model; remove the entry")
            }
            // Faults of sensors change no world, but what is read of it: `measure` and `sensors`.
            Family::Armature | Family::Inertia | Family::Sensor => {}
        }
    }
}
