//! Places of effects → joints, links, actuators, contact pairs.
//!
//! `vehicle/name`, or the name alone where it is the only one; globs name all that match.

use super::{Entry, Parts, Robots};
use crate::build::faults::Faults;
use crate::effects::PlaceKind;
use crate::glob::{glob_matches, is_glob};
use multibody::JointKind;
use sim::{ActuatorKind, VehicleSpec};

/// Of candidates named (vehicle, name), those that a text means; faults are told, and none is found then.
fn resolve(entry: &Entry<'_>, what: &str, candidates: &[(&str, &str)], faults: &mut Faults<'_>) -> Vec<usize> {
    let text = entry.place;
    let full = |(vehicle, name): &(&str, &str)| format!("{vehicle}/{name}");
    let hit = |candidate: &(&str, &str)| {
        if is_glob(text) {
            glob_matches(text, candidate.1) || glob_matches(text, &full(candidate))
        } else {
            candidate.1 == text || full(candidate) == text
        }
    };
    let found: Vec<usize> = (0..candidates.len()).filter(|i| hit(&candidates[*i])).collect();
    if found.is_empty() {
        let valid: Vec<String> =
            if text.contains('/') { candidates.iter().map(full).collect() } else { names_of(candidates) };
        faults.unknown(&entry.key("place"), what, text, valid.iter().map(String::as_str));
    }
    if found.len() > 1 && !is_glob(text) {
        let all: Vec<String> = found.iter().map(|i| full(&candidates[*i])).collect();
        entry.fault(faults, &format!("is at a {what} of several vehicles; write one of {}", all.join(", ")));
        return Vec::new();
    }
    found
}

fn names_of(candidates: &[(&str, &str)]) -> Vec<String> {
    candidates.iter().map(|(_, name)| (*name).to_owned()).collect()
}

/// A joint with a coordinate of its own.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointSite {
    pub(super) vehicle: usize,
    /// Index into the vehicle's moving joints.
    pub(super) joint: usize,
    /// Index into the world's `v`.
    pub(super) coordinate: usize,
}

/// The joints that a place names.
pub(super) fn joints(entry: &Entry<'_>, vehicles: &[VehicleSpec], faults: &mut Faults<'_>) -> Vec<JointSite> {
    let (mut sites, mut candidates, mut v0) = (Vec::new(), Vec::new(), 0);
    for (v, vehicle) in vehicles.iter().enumerate() {
        for (j, joint) in vehicle.tree.joints.iter().enumerate() {
            if !joint.is_mimic && matches!(joint.kind, JointKind::Revolute | JointKind::Prismatic) {
                sites.push(JointSite { vehicle: v, joint: j, coordinate: v0 + joint.v_index });
                candidates.push((vehicle.name.as_str(), joint.name.as_str()));
            }
        }
        v0 += vehicle.tree.nv;
    }
    resolve(entry, "joint", &candidates, faults).into_iter().map(|i| sites[i]).collect()
}

/// The links that a place names: vehicle and link.
pub(super) fn links(entry: &Entry<'_>, robots: &Robots<'_>, faults: &mut Faults<'_>) -> Vec<(usize, usize)> {
    let (mut sites, mut candidates) = (Vec::new(), Vec::new());
    for (v, robot) in robots.descriptions.iter().enumerate() {
        for (l, link) in robot.links.iter().enumerate() {
            sites.push((v, l));
            candidates.push((robots.names[v], link.name.as_str()));
        }
    }
    resolve(entry, "link", &candidates, faults).into_iter().map(|i| sites[i]).collect()
}

/// The links that a place names, once the trees are built: vehicle and link.
pub(super) fn tree_links(entry: &Entry<'_>, vehicles: &[VehicleSpec], faults: &mut Faults<'_>) -> Vec<(usize, usize)> {
    let (mut sites, mut candidates) = (Vec::new(), Vec::new());
    for (v, vehicle) in vehicles.iter().enumerate() {
        for (l, link) in vehicle.tree.links.iter().enumerate() {
            sites.push((v, l));
            candidates.push((vehicle.name.as_str(), link.name.as_str()));
        }
    }
    resolve(entry, "link", &candidates, faults).into_iter().map(|i| sites[i]).collect()
}

/// The actuators that a place names: by their own name, by a drive's group, by a glob, or as those of a joint.
pub(super) fn actuators(entry: &Entry<'_>, parts: &Parts, faults: &mut Faults<'_>) -> Vec<usize> {
    if entry.kind == PlaceKind::Joint {
        return actuators_of_joints(entry, parts, faults);
    }
    let all = &parts.table.actuators;
    let found: Vec<usize> = if is_glob(entry.place) {
        (0..all.len()).filter(|i| glob_matches(entry.place, &all[*i].name)).collect()
    } else {
        parts.table.find(entry.place).collect()
    };
    if found.is_empty() {
        faults.unknown(&entry.key("place"), "actuator", entry.place, all.iter().map(|a| a.name.as_str()));
    }
    found
}

/// The mechanisms that a place names, by a glob too.
pub(super) fn mechanisms(entry: &Entry<'_>, parts: &Parts, faults: &mut Faults<'_>) -> Vec<usize> {
    let all = &parts.mechanisms;
    let found: Vec<usize> = (0..all.len()).filter(|i| glob_matches(entry.place, &all[*i].name)).collect();
    if found.is_empty() {
        faults.unknown(&entry.key("place"), "mechanism", entry.place, all.iter().map(|m| m.name.as_str()));
    }
    found
}

fn actuators_of_joints(entry: &Entry<'_>, parts: &Parts, faults: &mut Faults<'_>) -> Vec<usize> {
    let mut found = Vec::new();
    for site in joints(entry, &parts.vehicles, faults) {
        let before = found.len();
        let drives = |kind: &ActuatorKind| match *kind {
            ActuatorKind::JointEffort { coordinate, .. } | ActuatorKind::JointDrive { coordinate, .. } => {
                coordinate == site.coordinate
            }
            ActuatorKind::Thruster { .. } | ActuatorKind::LatchRelease { .. } => false,
        };
        let all = parts.table.actuators.iter().enumerate();
        found.extend(all.filter(|(_, a)| drives(&a.kind)).map(|(i, _)| i));
        if found.len() == before && !is_glob(entry.place) {
            entry.fault(faults, "is at a joint without an actuator; give the joint a [[actuator]]");
        }
    }
    found
}

/// A contact pair that a place names.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactSite {
    /// Index into the pairs.
    pub(super) pair: usize,
    /// Whether the first-named part is the pair's second.
    pub(super) is_swapped: bool,
}

/// The contact pairs that a place `a/b` names; a and b are shapes or links, `vehicle.name` where needed, globs allowed.
pub(super) fn contacts(entry: &Entry<'_>, parts: &Parts, faults: &mut Faults<'_>) -> Vec<ContactSite> {
    let (a, b) = entry.place.split_once('/').unwrap_or((entry.place, ""));
    let is = |text: &str, shape: usize| names_of_shape(parts, shape).iter().any(|n| glob_matches(text, n));
    let mut found = Vec::new();
    for (pair, ([first, second], _)) in parts.pairs.iter().enumerate() {
        if is(a, *first) && is(b, *second) {
            found.push(ContactSite { pair, is_swapped: false });
        } else if is(a, *second) && is(b, *first) {
            found.push(ContactSite { pair, is_swapped: true });
        }
    }
    if found.is_empty() {
        let name = |shape: usize| parts.shapes[shape].name.as_str();
        let valid: Vec<String> = parts.pairs.iter().map(|([a, b], _)| format!("{}/{}", name(*a), name(*b))).collect();
        faults.unknown(&entry.key("place"), "contact", entry.place, valid.iter().map(String::as_str));
    }
    found
}

/// All names of a shape: its own, its link's, and both with the vehicle before a dot.
fn names_of_shape(parts: &Parts, shape: usize) -> Vec<String> {
    let spec = &parts.shapes[shape];
    let Some(vehicle) = spec.vehicle.map(|v| &parts.vehicles[v]) else {
        return vec![spec.name.clone(), format!("world.{}", spec.name), "world".to_owned()];
    };
    let link = &vehicle.tree.links[spec.link].name;
    let with_vehicle = |name: &str| format!("{}.{name}", vehicle.name);
    vec![spec.name.clone(), link.clone(), with_vehicle(&spec.name), with_vehicle(link)]
}
