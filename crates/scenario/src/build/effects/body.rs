//! Effects on bodies and on the world: loads, and parts that move inside a body.
//!
//! A part is in the nominal mass and inertia, locked at rest: it is taken out of its link before the tree is built.
//! Its place counts from the nominal centre of mass, wherever body-com says that it really is.

use super::places::{links, tree_links};
use super::{Entry, Parts, Robots};
use crate::build::faults::Faults;
use crate::effects::PartBuild;
use multibody::RobotDescription;
use sim::{BodyEffect, BodyLaw, Effect, EffectKind, Load};
use spatial::Vec3;

/// Nominal centres of mass by vehicle and link, m, link frame: as the files have them.
pub(in crate::build) type NominalComs = Vec<Vec<Vec3>>;

/// The centres of mass of all links; zero for a link without mass.
pub(in crate::build) fn nominal_coms(robots: &[RobotDescription]) -> NominalComs {
    let of =
        |robot: &RobotDescription| robot.links.iter().map(|l| l.inertial.map_or(Vec3::zeros(), |i| i.com)).collect();
    robots.iter().map(of).collect()
}

/// Takes the parts that will move by themselves out of their links.
pub(super) fn take_out(entry: &Entry<'_>, part: PartBuild, robots: &mut Robots<'_>, faults: &mut Faults<'_>) {
    for (v, l) in links(entry, robots, faults) {
        let Some(own) = &mut robots.descriptions[v].links[l].inertial else {
            entry.fault(faults, "needs a link with mass; name one");
            continue;
        };
        match (part.take_out)(entry, own, &robots.nominal_coms[v][l]) {
            Ok(left) => *own = left,
            Err(error) => {
                let reason = format!("takes more than the link has: what is left of it cannot be ({error})");
                faults.add(&entry.key(part.size), reason);
            }
        }
    }
}

/// Adds parts that move inside bodies.
pub(super) fn add_parts(entry: &Entry<'_>, part: PartBuild, parts: &mut Parts, faults: &mut Faults<'_>) {
    for (v, l) in tree_links(entry, &parts.vehicles, faults) {
        // Rotors stand behind the file's links and have no nominal centre of mass of their own.
        let com = parts.nominal_coms[v].get(l).copied().unwrap_or_default();
        let law = BodyEffect::new(v, l, (part.law)(entry, &com));
        parts.effects.push(Effect { name: entry.title(), kind: EffectKind::Body(law) });
    }
}

/// Adds loads on bodies.
pub(super) fn add_loads(
    entry: &Entry<'_>,
    of: impl Fn(&mut Faults<'_>) -> Option<Load>,
    parts: &mut Parts,
    faults: &mut Faults<'_>,
) {
    for (v, l) in tree_links(entry, &parts.vehicles, faults) {
        if let Some(load) = of(faults) {
            let law = BodyEffect::new(v, l, BodyLaw::Load(load));
            parts.effects.push(Effect { name: entry.title(), kind: EffectKind::Body(law) });
        }
    }
}

/// Adds an acceleration of everything.
pub(super) fn add_acceleration(entry: &Entry<'_>, acceleration: Vec3, parts: &mut Parts) {
    parts.effects.push(Effect { name: entry.title(), kind: EffectKind::Tilt(acceleration) });
}
