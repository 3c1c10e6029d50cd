//! Effects on mass properties: they change the robot's description before its tree is built.

use super::Entry;
use super::places::links;
use crate::build::faults::Faults;
use crate::effects::EffectName;
use multibody::{Inertial, RobotDescription};
use spatial::{Inertia, Mat3, Vec3};

/// Changes the links that the place names.
pub(super) fn edit(entry: &Entry<'_>, (names, robots): (&[&str], &mut [RobotDescription]), faults: &mut Faults<'_>) {
    for (v, l) in links(entry, (names, robots), faults) {
        match entry.name {
            EffectName::Payload => add_payload(entry, &mut robots[v].links[l].inertial, faults),
            _ => correct(entry, &mut robots[v].links[l].inertial, faults),
        }
    }
}

/// Sets the mass, the centre of mass (link frame) or the tensor about it (link axes) to a new value.
fn correct(entry: &Entry<'_>, inertial: &mut Option<Inertial>, faults: &mut Faults<'_>) {
    let Some(own) = inertial else {
        entry.fault(faults, "corrects a link with mass; name one");
        return;
    };
    match (entry.name, entry.numbers("inertia")) {
        (EffectName::BodyMass, _) => own.mass = entry.number("mass"),
        (EffectName::BodyCom, _) => own.com = entry.vector("com"),
        (_, Some([xx, yy, zz, xy, xz, yz])) => {
            own.tensor_com = Mat3::new(*xx, *xy, *xz, *xy, *yy, *yz, *xz, *yz, *zz);
            if let Err(error) = Inertia::check(own.mass, &own.tensor_com) {
                faults.add(&entry.key("inertia"), format!("is no rigid body's: {error}"));
            }
        }
        _ => {}
    }
}

/// Adds a point mass; written as a correction, so that no mass changes no bit.
fn add_payload(entry: &Entry<'_>, inertial: &mut Option<Inertial>, faults: &mut Faults<'_>) {
    let (mass, at) = (entry.number("mass"), entry.vector("com"));
    let Some(own) = inertial else {
        if mass > 0.0 {
            *inertial = Some(Inertial { mass, com: at, tensor_com: Mat3::zeros() });
        }
        return;
    };
    let total = own.mass + mass;
    if total <= 0.0 {
        faults.add(&entry.key("mass"), format!("takes more than the link has ({} kg)", own.mass));
        return;
    }
    let arm: Vec3 = at - own.com;
    own.tensor_com += own.mass * mass / total * (arm.norm_squared() * Mat3::identity() - arm * arm.transpose());
    own.com += mass / total * arm;
    own.mass = total;
}
