//! An elastic mount: the part in contact is carried by a tip of mass m, taken out of the body, on an isotropic spring.
//!
//!   m ü = F_contact − k u − d u̇  + what the body's motion carries,      u: displacement of the tip in the body's axes, m
//!
//! Three sliding joints of the tree, so that momentum and energy are accounted for like any other's. A force sensor behind
//! the mount reads k u + d u̇. The tip is a point at the part's origin; it does not turn against the body. At an infinite
//! stiffness there is no mount.

use super::contact::part_of;
use super::places::{contacts, tree_links};
use super::{Entry, Parts};
use crate::build::faults::Faults;
use crate::effects::PlaceKind;
use sim::{ActuatorKind, Effect, EffectKind, JointEffect, JointLaw};
use spatial::{Inertia, Mat3, Pose, Vec3, nalgebra};

/// What carries the part: a point on a spring.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tip {
    /// kg.
    pub(crate) mass: f64,
    /// N/m.
    pub(crate) stiffness: f64,
    /// N·s/m.
    pub(crate) damping: f64,
}

/// Adds the mount that an entry asks for. It numbers coordinates and bodies anew, so it comes before all other effects.
pub(crate) fn add_mount(entry: &Entry<'_>, parts: &mut Parts, tip: Tip, faults: &mut Faults<'_>) {
    let mut shapes = shapes_of(entry, parts, faults);
    shapes.sort_unstable();
    shapes.dedup();
    let Some(&first) = shapes.first().filter(|_| tip.stiffness.is_finite()) else { return };
    let body_of = |shape: usize| {
        let spec = &parts.shapes[shape];
        spec.vehicle.map(|v| (v, parts.vehicles[v].tree.links[spec.link].body))
    };
    let Some((vehicle, body)) = body_of(first).filter(|own| shapes.iter().all(|s| body_of(*s) == Some(*own))) else {
        return entry.fault(faults, "needs parts of one body of one vehicle to stand on the mount");
    };
    if tip.mass >= parts.vehicles[vehicle].tree.bodies[body].inertia.mass {
        return faults.add(&entry.key("m"), "is all of the body's mass or more: the tip is taken out of the body");
    }
    let name = format!("{}_mount", parts.shapes[first].name);
    let coordinate = hang(parts, (vehicle, body), &shapes, (tip.mass, &name));
    for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
        let title = |what: &str| format!("{} ({what} along {axis})", entry.title());
        let law = |law| EffectKind::Joint(JointEffect { coordinate: coordinate + k, law });
        let spring = JointLaw::Cable { stiffness: tip.stiffness, rest: 0.0 };
        parts.effects.push(Effect { name: title("spring"), kind: law(spring) });
        let damper = JointLaw::Viscous { damping: tip.damping };
        parts.effects.push(Effect { name: title("damper"), kind: law(damper) });
    }
}

fn shapes_of(entry: &Entry<'_>, parts: &Parts, faults: &mut Faults<'_>) -> Vec<usize> {
    if entry.kind == PlaceKind::Contact {
        return contacts(entry, parts, faults).iter().map(|site| part_of(site, parts, 0)).collect();
    }
    let links = tree_links(entry, &parts.vehicles, faults);
    let all = parts.shapes.iter().enumerate();
    let found: Vec<usize> =
        all.filter(|(_, s)| s.vehicle.is_some_and(|v| links.contains(&(v, s.link)))).map(|(i, _)| i).collect();
    if found.is_empty() && !links.is_empty() {
        entry.fault(faults, "needs a part in contact on the body; name the contact instead");
    }
    found
}

/// Hangs the shapes on a tip; the first coordinate of the tip, as an index into the world's `v`.
fn hang(parts: &mut Parts, (vehicle, body): (usize, usize), shapes: &[usize], (mass, name): (f64, &str)) -> usize {
    let pose_b = |parts: &Parts, shape: usize| {
        let spec = &parts.shapes[shape];
        parts.vehicles[vehicle].tree.links[spec.link].frame_bl.to_pose() * spec.pose_ls
    };
    let sum: Vec3 = shapes.iter().map(|s| pose_b(parts, *s).translation.vector).sum();
    let place = sum / shapes.len() as f64;
    let poses: Vec<Pose> = shapes.iter().map(|s| pose_b(parts, *s)).collect();
    renumber(parts, vehicle);
    let tree = &mut parts.vehicles[vehicle].tree;
    let tip = Inertia::from_com(mass, &place, &Mat3::zeros());
    let own = &mut tree.bodies[body].inertia;
    *own = Inertia { mass: own.mass - tip.mass, mc: own.mc - tip.mc, rot: own.rot - tip.rot };
    let joint = tree.add_sliding_point(body, &place, mass, name);
    let (link, v_index) = (tree.links.len() - 1, tree.joints[joint].v_index);
    let back = Pose::from_parts((-place).into(), nalgebra::UnitQuaternion::identity());
    for (shape, pose) in shapes.iter().zip(poses) {
        (parts.shapes[*shape].link, parts.shapes[*shape].pose_ls) = (link, back * pose);
    }
    parts.vehicles[..vehicle].iter().map(|v| v.tree.nv).sum::<usize>() + v_index
}

/// Makes room for three coordinates and bodies at the end of a vehicle.
fn renumber(parts: &mut Parts, vehicle: usize) {
    let upto = &parts.vehicles[..=vehicle];
    let coordinates: usize = upto.iter().map(|v| v.tree.nv).sum();
    let bodies: usize = upto.iter().map(|v| v.tree.bodies.len()).sum();
    let shift = |x: &mut usize, from: usize| *x += if *x >= from { 3 } else { 0 };
    for actuator in &mut parts.table.actuators {
        match &mut actuator.kind {
            ActuatorKind::JointEffort { coordinate, .. } | ActuatorKind::JointDrive { coordinate, .. } => {
                shift(coordinate, coordinates);
            }
            ActuatorKind::Thruster { body, .. } => shift(body, bodies),
            ActuatorKind::LatchRelease { .. } => {}
        }
    }
    parts.table.rotor_speeds.iter_mut().for_each(|(coordinate, _)| shift(coordinate, coordinates));
}
