//! Whether the masses belong to rigid bodies, and every joint moves one.
//!
//! Links joined by fixed joints are one body. A body that a joint moves needs mass; the body of the root may have
//! none, for it may be the world (a free base asks [`crate::RobotDescription::root_has_mass`]).

use super::errors::{Findings, UrdfProblem, cut};
use super::facts::{Facts, InertialFact, LinkFact};
use super::graph::Graph;
use spatial::{Inertia, InertiaError};

/// Mass and tensor of each link alone.
pub(crate) fn check_inertias(facts: &Facts<'_, '_>, findings: &mut Findings<'_>) {
    for link in &facts.links {
        let Some(inertial) = link.inertial.as_ref().filter(|i| i.mass != 0.0) else { continue };
        if let Err(error) = Inertia::check(inertial.mass, &inertial.tensor) {
            let problem = UrdfProblem::Inertia { fault: word(&error, inertial), file: findings.file_name() };
            findings.add(inertial.offset, link.subject(), problem);
        }
    }
}

/// A diagonal tensor is spoken of by the names of the file, others by their principal moments.
fn word(error: &InertiaError, inertial: &InertialFact) -> String {
    let t = &inertial.tensor;
    let is_diagonal = t[(0, 1)] == 0.0 && t[(0, 2)] == 0.0 && t[(1, 2)] == 0.0;
    let (InertiaError::Triangle(_), true) = (error, is_diagonal) else { return error.to_string() };
    let largest = t.diagonal().imax();
    let (a, b) = ((largest + 1) % 3, (largest + 2) % 3);
    let (a, b) = (a.min(b), a.max(b));
    let name = |i: usize| ["Ixx", "Iyy", "Izz"][i];
    let (ta, tb, tc) = (t[(a, a)], t[(b, b)], t[(largest, largest)]);
    format!("inertia violates {} + {} ≥ {} ({ta} + {tb} < {tc})", name(a), name(b), name(largest))
}

/// Mass of every body that a joint moves.
pub(crate) fn check_bodies(facts: &Facts<'_, '_>, graph: &Graph, findings: &mut Findings<'_>) {
    let (body_of, has_mass) = join_bodies(facts, graph);
    for (i, link) in facts.links.iter().enumerate() {
        check_massless(link, body_of[i] == 0, findings);
        let Some((joint, _)) = graph.carried_by[i] else { continue };
        let joint = &facts.joints[joint];
        if joint.kind != "fixed" && !has_mass[body_of[i]] {
            let problem = UrdfProblem::MovesNoMass { link: cut(link.name) };
            findings.add(joint.offset(), joint.subject(), problem);
        }
    }
}

/// For each link its body; for each body whether it has mass. The root's body is 0.
fn join_bodies(facts: &Facts<'_, '_>, graph: &Graph) -> (Vec<usize>, Vec<bool>) {
    let mut body_of = vec![0; facts.links.len()];
    let mut has_mass = Vec::new();
    for &link in &graph.order {
        let fixed_to = graph.carried_by[link].filter(|(joint, _)| facts.joints[*joint].kind == "fixed");
        body_of[link] = fixed_to.map_or(has_mass.len(), |(_, parent)| body_of[parent]);
        if fixed_to.is_none() {
            has_mass.push(false);
        }
        // An inertial that could not be read is an error already, not a missing mass as well.
        let is_unreadable = facts.links[link].inertial.is_none() && facts.links[link].has_inertial_tag();
        has_mass[body_of[link]] |= facts.links[link].has_mass() || is_unreadable;
    }
    (body_of, has_mass)
}

/// A tensor without mass is a slip, unless the link does not move: some files make the base so.
fn check_massless(link: &LinkFact<'_, '_>, is_root_body: bool, findings: &mut Findings<'_>) {
    let Some(inertial) = link.inertial.as_ref().filter(|i| i.mass == 0.0 && !is_root_body) else { return };
    if inertial.tensor.iter().any(|x| *x != 0.0) {
        findings.add(inertial.offset, link.subject(), UrdfProblem::NoMass);
    }
}
