//! The meshes of a robot: each file is loaded once for each scale, and each trouble told once, where it is first asked for.
//!
//! | the mesh is | asked for by visuals alone | by a collision |
//! | --- | --- | --- |
//! | not there | a doubt: it is not drawn | a doubt: it is not felt, and a contact that needs it is refused |
//! | there and unusable | a doubt: it is not drawn | an error: somebody meant it to touch |
//!
//! A package or folder that is nowhere takes all its meshes with it and is one trouble, not one for each of them.

use super::doubts::{Loss, UrdfDoubt};
use super::facts::{Facts, LinkFact};
use super::findings::Findings;
use super::schema::MESH;
use super::walk::{numbers_of, own_children, text_of};
use crate::mesh::{SearchPaths, load_mesh};
use crate::{Mesh, MeshError};
use roxmltree::Node;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A mesh file as named in the URDF, at a scale.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct MeshKey {
    name: String,
    scale_bits: [u64; 3],
}

impl MeshKey {
    /// What a `<mesh>` asks for; `None` if it is unsound, which the walk has told.
    pub(crate) fn of(mesh: Node<'_, '_>) -> Option<(Self, [f64; 3])> {
        let name = text_of(mesh, "filename").map(str::trim).filter(|n| !n.is_empty())?;
        let scale = if text_of(mesh, "scale").is_some() { numbers_of(mesh, &MESH, "scale")? } else { [1.0; 3] };
        Some((Self { name: name.into(), scale_bits: scale.map(f64::to_bits) }, scale))
    }
}

/// Meshes that were had, and why others were not.
pub(crate) type Meshes = BTreeMap<MeshKey, Result<Arc<Mesh>, MeshError>>;

/// Where meshes are looked for.
pub(crate) struct Surroundings<'a> {
    pub(crate) base_dir: &'a Path,
    pub(crate) search: &'a SearchPaths,
}

/// A mesh that was not had: where it is first asked for, by whom, and why.
struct Lost {
    offset: usize,
    subject: String,
    loss: Loss,
    error: MeshError,
}

/// Loads all meshes.
pub(crate) fn load_meshes(
    facts: &Facts<'_, '_>,
    surroundings: &Surroundings<'_>,
    findings: &mut Findings<'_>,
) -> Meshes {
    let mut loader = MeshLoader { surroundings, known: Meshes::new(), files: BTreeMap::new() };
    // By name: a mesh that is missing is missing at every scale.
    let mut lost: BTreeMap<String, Lost> = BTreeMap::new();
    for link in &facts.links {
        for (mesh, seen) in meshes_of(link) {
            let Some((key, scale)) = MeshKey::of(mesh) else { continue };
            let Err(error) = loader.load(&key, scale) else { continue };
            let loss = Loss { seen, touching: !seen };
            let here = Lost { offset: mesh.range().start, subject: link.subject(), loss, error };
            note(&mut lost, key.name, here);
        }
    }
    tell(lost, findings);
    loader.known
}

/// The `<mesh>` tags of a link, with whether they are its visuals'.
fn meshes_of<'a, 'i: 'a>(link: &LinkFact<'a, 'i>) -> impl Iterator<Item = (Node<'a, 'i>, bool)> {
    let named = |name: &'static str| move |n: &Node<'_, '_>| n.tag_name().name() == name;
    own_children(link.node).flat_map(move |shape| {
        let seen = shape.tag_name().name() == "visual";
        let is_shape = seen || shape.tag_name().name() == "collision";
        let geometries = own_children(shape).filter(named("geometry")).filter(move |_| is_shape);
        geometries.flat_map(own_children).filter(named("mesh")).map(move |mesh| (mesh, seen)).collect::<Vec<_>>()
    })
}

/// Adds to what is told of one mesh or place.
fn note(lost: &mut BTreeMap<String, Lost>, name: String, more: Lost) {
    match lost.entry(name) {
        Entry::Vacant(place) => drop(place.insert(more)),
        Entry::Occupied(mut place) => place.get_mut().join(more),
    }
}

fn tell(lost: BTreeMap<String, Lost>, findings: &mut Findings<'_>) {
    let (mut places, mut counts) = (BTreeMap::new(), BTreeMap::<String, usize>::new());
    for lost in lost.into_values() {
        if let Some(place) = lost.error.missing_place() {
            *counts.entry(place.clone()).or_default() += 1;
            note(&mut places, place, lost);
        } else if lost.error.is_missing() || !lost.loss.touching {
            findings.doubt(lost.offset, lost.subject, UrdfDoubt::Mesh { mesh: lost.error, loss: lost.loss });
        } else {
            findings.add(lost.offset, lost.subject, lost.error.into());
        }
    }
    for (lost, count) in places.into_values().zip(counts.into_values()) {
        let doubt = UrdfDoubt::Meshes { place: lost.error, count, loss: lost.loss };
        findings.doubt(lost.offset, lost.subject, doubt);
    }
}

impl Lost {
    /// Both losses, at the place of the earlier.
    fn join(&mut self, other: Self) {
        let (a, b) = (self.loss, other.loss);
        if other.offset < self.offset {
            *self = other;
        }
        self.loss = Loss { seen: a.seen || b.seen, touching: a.touching || b.touching };
    }
}

struct MeshLoader<'a> {
    surroundings: &'a Surroundings<'a>,
    known: Meshes,
    /// One file may have several names (relative, package://…).
    files: BTreeMap<(PathBuf, [u64; 3]), Arc<Mesh>>,
}

impl MeshLoader<'_> {
    fn load(&mut self, key: &MeshKey, scale: [f64; 3]) -> Result<(), MeshError> {
        let known = self.known.get(key).cloned();
        let loaded = known.unwrap_or_else(|| self.load_new(key, scale));
        let is_had = loaded.as_ref().map(|_| ()).map_err(Clone::clone);
        self.known.entry(key.clone()).or_insert(loaded);
        is_had
    }

    fn load_new(&mut self, key: &MeshKey, scale: [f64; 3]) -> Result<Arc<Mesh>, MeshError> {
        let file = self.surroundings.search.find(&key.name, self.surroundings.base_dir)?;
        let place = (file, key.scale_bits);
        if let Some(mesh) = self.files.get(&place) {
            return Ok(mesh.clone());
        }
        let mesh = Arc::new(load_mesh(&place.0, scale)?);
        self.files.insert(place, mesh.clone());
        Ok(mesh)
    }
}
