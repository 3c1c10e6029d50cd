//! `[[effect]]` entries → edits of the robots, of the parts of the world, and effects of the simulation.
//!
//! Three passes: [`check`] holds every entry against its definition; [`edit_robots`] changes masses before the trees are
//! built; [`apply`] changes everything else once shapes, actuators and mechanisms stand. What an entry becomes is the business
//! of its definition ([`Build`]); where in the world it lands is that of the files here.

mod body;
mod contact;
mod entry;
mod inertia;
mod joint;
mod line;
mod mount;
mod places;

pub(crate) use entry::Entry;
pub(crate) use mount::{Tip, add_mount};

pub(super) use body::{NominalComs, nominal_coms};

use super::actuators::ActuatorTable;
use super::faults::Faults;
use crate::effects::Build;
use multibody::{Inertial, RobotDescription};
use sim::{Environment, Mechanism, PairLaw, ShapeSpec, VehicleSpec};

/// The parts of a world that effects may change, before it is built.
pub(crate) struct Parts {
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

/// The robots of a scenario before their trees are built.
pub(super) struct Robots<'a> {
    /// Names of the vehicles.
    pub(super) names: &'a [&'a str],
    pub(super) descriptions: &'a mut [RobotDescription],
    /// Centres of mass as the files have them.
    pub(super) nominal_coms: &'a NominalComs,
}

/// Every entry of the file, held against its definition; those at fault are left out and told.
pub(super) fn check<'a>(scenario: &'a crate::spec::Scenario, faults: &mut Faults<'_>) -> Vec<Entry<'a>> {
    let all = scenario.effects.iter().enumerate();
    all.filter_map(|(i, effect)| Entry::check(i, effect, faults)).collect()
}

/// Changes masses, centres of mass and inertias, before the trees are built: new values first, then what is added to them,
/// whatever the order in the file, then what is taken out to move by itself. Returns what the links had after the first: their own.
pub(super) fn edit_robots(plan: &[Entry<'_>], robots: &mut Robots<'_>, faults: &mut Faults<'_>) -> Vec<OwnInertials> {
    for entry in plan {
        if let Build::SetMass(edit) = entry.def.build {
            inertia::edit(entry, edit, robots, faults);
        }
    }
    let own_of = |robot: &RobotDescription| robot.links.iter().map(|l| (l.name.clone(), l.inertial)).collect();
    let own = robots.descriptions.iter().map(own_of).collect();
    for entry in plan {
        if let Build::AddMass(edit) = entry.def.build {
            inertia::edit(entry, edit, robots, faults);
        }
    }
    for entry in plan {
        if let Build::Part(part) = entry.def.build {
            body::take_out(entry, part, robots, faults);
        }
    }
    own
}

/// The links of a robot with the mass properties that are their own: of the file, or of a correction.
pub type OwnInertials = Vec<(String, Option<Inertial>)>;

/// Changes the parts of the world, and adds what acts in it.
pub(super) fn apply(plan: &[Entry<'_>], parts: &mut Parts, faults: &mut Faults<'_>) {
    // A mount numbers coordinates and bodies anew, before anything is built on them.
    for entry in plan {
        if let Build::Mount(add) = entry.def.build {
            add(entry, parts, faults);
        }
    }
    // A gear takes the whole reflected inertia of its joint, so that comes first.
    for entry in plan {
        if let Build::Rotor(add) = entry.def.build {
            joint::edit(entry, add, parts, faults);
        }
    }
    for entry in plan {
        match entry.def.build {
            Build::Gear(of) => joint::add_gears(entry, of, parts, faults),
            Build::Effort(of) => joint::add_efforts(entry, |_| Some(of(entry)), parts, faults),
            Build::EffortOrLoad { effort, load } => match entry.is_at_joint() {
                true => joint::add_efforts(entry, |faults| effort(entry, faults), parts, faults),
                false => body::add_loads(entry, |faults| load(entry, faults), parts, faults),
            },
            Build::Command(of) => line::add(entry, of, parts, faults),
            Build::ThrustAxis(turned) => line::turn_thrusters(entry, turned, parts, faults),
            Build::Load(of) => body::add_loads(entry, |_| Some(of(entry)), parts, faults),
            Build::Part(part) => body::add_parts(entry, part, parts, faults),
            Build::Acceleration(of) => body::add_acceleration(entry, of(entry), parts),
            Build::Pair(edit) => contact::edit_laws(entry, edit, parts, faults),
            Build::Mechanism(edit) => {
                for index in places::mechanisms(entry, parts, faults) {
                    edit(entry, &mut parts.mechanisms[index].kind);
                }
            }
            Build::Pose(displace) => contact::displace_parts(entry, displace, parts, faults),
            Build::NoModel => {
                entry.fault(faults, "is what a diagnosis says of physics without a model; remove the entry")
            }
            // Stages before this one; and faults of sensors change no world, but what is read of it: `measure` and `sensors`.
            Build::SetMass(_) | Build::AddMass(_) | Build::Rotor(_) | Build::Mount(_) | Build::Sensor(_) => {}
        }
    }
}
