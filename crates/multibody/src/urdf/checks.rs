//! All checks in a row: each says what it finds, none stops the others unless it takes their ground.

use super::docking::{DockingShapes, collect_docking};
use super::errors::UrdfProblem;
use super::facts::{Facts, collect_facts};
use super::findings::Findings;
use super::graph::{Graph, build_graph};
use super::joints::{Follows, check_joints, resolve_mimics};
use super::meshes::{Meshes, Surroundings, load_meshes};
use super::physics::{check_bodies, check_inertias};
use super::walk::{check_tags, own_children};
use roxmltree::Node;

/// What the checks worked out, for the conversion.
pub(crate) struct Checked<'a, 'i> {
    pub(crate) facts: Facts<'a, 'i>,
    pub(crate) graph: Graph,
    pub(crate) follows: Vec<Option<Follows>>,
    pub(crate) meshes: Meshes,
    pub(crate) docking: DockingShapes,
}

/// Runs every check; `None` if there is no tree, which is among the findings.
pub(crate) fn check_robot<'a, 'i>(
    robot: Node<'a, 'i>,
    surroundings: &Surroundings<'_>,
    findings: &mut Findings<'_>,
) -> Option<Checked<'a, 'i>> {
    check_tags(robot, findings);
    let facts = collect_facts(robot, findings);
    if !own_children(robot).any(|n| n.tag_name().name() == "link") {
        findings.add(robot.range().start, "robot", UrdfProblem::NoLinks);
    }
    check_joints(&facts, findings);
    let follows = resolve_mimics(&facts, findings);
    check_inertias(&facts, findings);
    let graph = if facts.links.is_empty() { None } else { build_graph(&facts, findings) };
    if let Some(graph) = &graph {
        check_bodies(&facts, graph, findings);
    }
    let meshes = load_meshes(&facts, surroundings, findings);
    let docking = collect_docking(&facts);
    graph.map(|graph| Checked { facts, graph, follows, meshes, docking })
}
