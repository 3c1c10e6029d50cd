//! All checks in a row: each says what it finds, none stops the others unless it takes their ground.

use super::docking::{DockingShapes, collect_docking};
use super::errors::{Findings, UrdfProblem};
use super::facts::{Facts, collect_facts};
use super::graph::{Graph, build_graph};
use super::joints::{Follows, check_joints, resolve_mimics};
use super::physics::{check_bodies, check_inertias};
use super::schema::MESH;
use super::walk::{check_tags, numbers_of, own_children, text_of};
use crate::mesh::{SearchPaths, load_mesh};
use crate::{Mesh, MeshError};
use roxmltree::Node;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What the checks worked out, for the conversion.
pub(crate) struct Checked {
    pub(crate) graph: Graph,
    pub(crate) follows: Vec<Option<Follows>>,
    pub(crate) meshes: BTreeMap<MeshKey, Arc<Mesh>>,
    pub(crate) docking: DockingShapes,
}

/// A mesh file as named in the URDF, at a scale.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct MeshKey {
    name: String,
    scale_bits: [u64; 3],
}

impl MeshKey {
    pub(crate) fn new(name: &str, scale: [f64; 3]) -> Self {
        Self { name: name.into(), scale_bits: scale.map(f64::to_bits) }
    }
}

/// Where meshes are looked for.
pub(crate) struct Surroundings<'a> {
    pub(crate) base_dir: &'a Path,
    pub(crate) search: &'a SearchPaths,
}

/// Runs every check; `None` if there is no tree, which is among the findings.
pub(crate) fn check_robot(
    robot: Node<'_, '_>,
    surroundings: &Surroundings<'_>,
    findings: &mut Findings<'_>,
) -> Option<Checked> {
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
    graph.map(|graph| Checked { graph, follows, meshes, docking })
}

/// Loads each mesh once for each scale, and tells each trouble where it is first asked for.
fn load_meshes(
    facts: &Facts<'_, '_>,
    surroundings: &Surroundings<'_>,
    findings: &mut Findings<'_>,
) -> BTreeMap<MeshKey, Arc<Mesh>> {
    let mut loader = MeshLoader { surroundings, known: BTreeMap::new(), files: BTreeMap::new() };
    for link in &facts.links {
        let shapes = own_children(link.node).filter(|n| matches!(n.tag_name().name(), "visual" | "collision"));
        for mesh in shapes.flat_map(own_meshes) {
            let Some(name) = text_of(mesh, "filename").filter(|n| !n.trim().is_empty()) else { continue };
            if let Err(error) = loader.load(name, scale_of(mesh)) {
                findings.add(mesh.range().start, link.subject(), error.into());
            }
        }
    }
    loader.known.into_iter().filter_map(|(key, mesh)| Some((key, mesh?))).collect()
}

fn own_meshes<'a, 'i>(shape: Node<'a, 'i>) -> Vec<Node<'a, 'i>> {
    let geometries = own_children(shape).filter(|n| n.tag_name().name() == "geometry");
    geometries.flat_map(own_children).filter(|n| n.tag_name().name() == "mesh").collect()
}

fn scale_of(mesh: Node<'_, '_>) -> [f64; 3] {
    numbers_of(mesh, &MESH, "scale").unwrap_or([1.0; 3])
}

struct MeshLoader<'a> {
    surroundings: &'a Surroundings<'a>,
    /// `None` for those that failed and were told.
    known: BTreeMap<MeshKey, Option<Arc<Mesh>>>,
    /// One file may have several names (relative, package://…).
    files: BTreeMap<(PathBuf, [u64; 3]), Arc<Mesh>>,
}

impl MeshLoader<'_> {
    fn load(&mut self, name: &str, scale: [f64; 3]) -> Result<(), MeshError> {
        let key = MeshKey::new(name, scale);
        if self.known.contains_key(&key) {
            return Ok(());
        }
        let loaded = self.load_new(name.trim(), scale, key.scale_bits);
        self.known.insert(key, loaded.as_ref().ok().cloned());
        loaded.map(|_| ())
    }

    fn load_new(&mut self, name: &str, scale: [f64; 3], scale_bits: [u64; 3]) -> Result<Arc<Mesh>, MeshError> {
        let file = self.surroundings.search.find(name, self.surroundings.base_dir)?;
        if let Some(mesh) = self.files.get(&(file.clone(), scale_bits)) {
            return Ok(mesh.clone());
        }
        let mesh = Arc::new(load_mesh(&file, scale)?);
        self.files.insert((file, scale_bits), mesh.clone());
        Ok(mesh)
    }
}
