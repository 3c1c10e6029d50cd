//! Effects on bodies and on the world: loads, and parts that move inside a body.
//!
//! A part is in the nominal mass and inertia, locked at rest: it is taken out of its link before the tree is built.
//! `position` of slosh counts from the nominal centre of mass, wherever body-com says that it really is.

use super::places::{links, tree_links};
use super::{Entry, Parts};
use crate::build::faults::Faults;
use crate::effects::EffectName;
use multibody::{Inertial, RobotDescription};
use sim::{Appendage, Axes, BodyEffect, BodyLaw, Effect, EffectKind, Load, Slosh, Sphere};
use spatial::Vec3;
use std::f64::consts::TAU;

/// Nominal centres of mass by vehicle and link, m, link frame: as the files have them.
pub(in crate::build) type NominalComs = Vec<Vec<Vec3>>;

/// The centres of mass of all links; zero for a link without mass.
pub(in crate::build) fn nominal_coms(robots: &[RobotDescription]) -> NominalComs {
    let of =
        |robot: &RobotDescription| robot.links.iter().map(|l| l.inertial.map_or(Vec3::zeros(), |i| i.com)).collect();
    robots.iter().map(of).collect()
}

/// Takes the parts that will move by themselves out of their links.
pub(super) fn edit_robots(
    entry: &Entry<'_>,
    (names, robots, coms): (&[&str], &mut [RobotDescription], &NominalComs),
    faults: &mut Faults<'_>,
) {
    let key = match entry.name {
        EffectName::Slosh => "mass",
        EffectName::FlexibleAppendage => "coupling",
        EffectName::InternalDissipation => "i_damper",
        _ => return,
    };
    for (v, l) in links(entry, (names, robots), faults) {
        let Some(own) = &mut robots[v].links[l].inertial else {
            entry.fault(faults, "needs a link with mass; name one");
            continue;
        };
        match take_out(entry, own, &coms[v][l]) {
            Ok(left) => *own = left,
            Err(error) => {
                faults.add(&entry.key(key), format!("takes more than the link has: what is left of it {error}"));
            }
        }
    }
}

fn take_out(entry: &Entry<'_>, own: &Inertial, nominal_com: &Vec3) -> Result<Inertial, String> {
    let left = match entry.name {
        EffectName::Slosh => own.without_point(entry.number("mass"), &(nominal_com + entry.vector("position"))),
        EffectName::FlexibleAppendage => own.without_mode(&entry.vector("coupling")),
        _ => own.without_sphere(entry.number("i_damper")),
    };
    left.map_err(|error| format!("cannot be ({error})"))
}

/// Adds what acts on bodies, and the tilt of the world.
pub(super) fn apply(entry: &Entry<'_>, parts: &mut Parts, faults: &mut Faults<'_>) {
    if entry.name == EffectName::Tilt {
        parts.effects.push(Effect { name: entry.title(), kind: EffectKind::Tilt(entry.vector("vector")) });
        return;
    }
    for (v, l) in tree_links(entry, &parts.vehicles, faults) {
        // Rotors stand behind the file's links and have no nominal centre of mass of their own.
        let com = parts.nominal_coms[v].get(l).copied().unwrap_or_default();
        if let Some(law) = law(entry, &com, faults) {
            parts.effects.push(Effect { name: entry.title(), kind: EffectKind::Body(BodyEffect::new(v, l, law)) });
        }
    }
}

fn law(entry: &Entry<'_>, nominal_com: &Vec3, faults: &mut Faults<'_>) -> Option<BodyLaw> {
    let (number, rate) = (|name: &str| entry.number(name), TAU * entry.number("frequency"));
    Some(match entry.name {
        EffectName::Slosh => {
            let rest = nominal_com + entry.vector("position");
            BodyLaw::Slosh(Slosh { mass: number("mass"), rate, damping: number("damping"), rest })
        }
        EffectName::FlexibleAppendage => {
            BodyLaw::Appendage(Appendage { rate, damping: number("damping"), coupling: entry.vector("coupling") })
        }
        EffectName::InternalDissipation => BodyLaw::Sphere(Sphere { inertia: number("i_damper"), c: number("c") }),
        _ => BodyLaw::Load(load(entry, faults)?),
    })
}

fn load(entry: &Entry<'_>, faults: &mut Faults<'_>) -> Option<Load> {
    let axes = if entry.word("frame") == "world" { Axes::World } else { Axes::Body };
    Some(match entry.name {
        EffectName::ConstantForce => Load::ConstantForce { vector: entry.vector("vector"), axes },
        EffectName::ConstantTorque => Load::ConstantTorque { vector: entry.vector("vector"), axes },
        EffectName::LinearDrag => Load::LinearDrag { c: entry.number("c") },
        EffectName::QuadraticDrag => Load::QuadraticDrag { c: entry.number("c") },
        EffectName::AngularDamping => Load::AngularDamping { c: entry.number("c") },
        EffectName::GravityGradient => Load::GravityGradient { mean_motion: entry.number("mean_motion") },
        EffectName::TetherStiffness => {
            Load::Tether { k: entry.number("k"), d: entry.number("d"), anchor: entry.vector("anchor") }
        }
        EffectName::PeriodicDisturbance => return periodic(entry, faults),
        _ => return None,
    })
}

fn periodic(entry: &Entry<'_>, faults: &mut Faults<'_>) -> Option<Load> {
    if entry.numbers("amplitude").is_none_or(|a| a.len() != 3) {
        faults.add(&entry.key("amplitude"), "must be three numbers at a body: a vector in its axes");
        return None;
    }
    Some(Load::Periodic {
        amplitude: entry.vector("amplitude"),
        is_force: entry.word("kind") == "force",
        rate: TAU * entry.number("frequency"),
        phase: entry.number("phase"),
    })
}
