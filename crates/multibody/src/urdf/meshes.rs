//! The meshes of a robot: each file is loaded once for each scale, and each trouble told once, where it is first asked for.
//!
//! | the mesh is | asked for by visuals alone | by a collision |
//! | --- | --- | --- |
//! | not there | a doubt: it is not drawn | a doubt: it is not felt, and a contact that needs it is refused |
//! | there and unusable | a doubt: it is not drawn | an error: somebody meant it to touch |
//!
//! A package that is nowhere takes all its meshes with it and is one trouble, not one for each of them.

use super::doubts::{Loss, UrdfDoubt};
use super::facts::{Facts, LinkFact};
use super::findings::Findings;
use super::schema::MESH;
use super::walk::{numbers_of, own_children, text_of};
use crate::mesh::{SearchPaths, load_mesh};
use crate::{Mesh, MeshError};
use roxmltree::Node;
use std::collections::BTreeMap;
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

/// A mesh that was not had: where it is first asked for, and by whom.
struct Lost {
    offset: usize,
    subject: String,
    loss: Loss,
}

/// Loads all meshes.
pub(crate) fn load_meshes(
    facts: &Facts<'_, '_>,
    surroundings: &Surroundings<'_>,
    findings: &mut Findings<'_>,
) -> Meshes {
    let mut loader = MeshLoader { surroundings, known: Meshes::new(), files: BTreeMap::new() };
    let mut lost: BTreeMap<MeshKey, Lost> = BTreeMap::new();
    for link in &facts.links {
        for (mesh, seen) in meshes_of(link) {
            let Some((key, scale)) = MeshKey::of(mesh) else { continue };
            if loader.load(&key, scale) {
                continue;
            }
            let loss = Loss { seen: false, touching: false };
            let first = || Lost { offset: mesh.range().start, subject: link.subject(), loss };
            let lost = &mut lost.entry(key).or_insert_with(first).loss;
            *lost = Loss { seen: lost.seen || seen, touching: lost.touching || !seen };
        }
    }
    tell(&loader.known, lost, findings);
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

fn tell(known: &Meshes, lost: BTreeMap<MeshKey, Lost>, findings: &mut Findings<'_>) {
    let mut packages: BTreeMap<&str, LostPackage<'_>> = BTreeMap::new();
    for (key, lost) in lost {
        let Some(Err(error)) = known.get(&key) else { continue };
        if let MeshError::NoPackage { package, .. } = error {
            let all = packages.entry(package).or_insert(LostPackage { count: 0, all: None, error });
            all.count += 1;
            all.all = Some(match all.all.take() {
                Some(first) => first.and(lost),
                None => lost,
            });
        } else if error.is_missing() || !lost.loss.touching {
            findings.doubt(lost.offset, lost.subject, UrdfDoubt::Mesh { mesh: error.clone(), loss: lost.loss });
        } else {
            findings.add(lost.offset, lost.subject, error.clone().into());
        }
    }
    for LostPackage { count, all, error } in packages.into_values() {
        let Some(lost) = all else { continue };
        let doubt = UrdfDoubt::Package { mesh: error.clone(), count, loss: lost.loss };
        findings.doubt(lost.offset, lost.subject, doubt);
    }
}

/// Meshes that went with their package, which is told at the first of them.
struct LostPackage<'a> {
    count: usize,
    all: Option<Lost>,
    error: &'a MeshError,
}

impl Lost {
    /// Both, at the place of the earlier.
    fn and(self, other: Self) -> Self {
        let loss =
            Loss { seen: self.loss.seen || other.loss.seen, touching: self.loss.touching || other.loss.touching };
        Self { loss, ..if other.offset < self.offset { other } else { self } }
    }
}

struct MeshLoader<'a> {
    surroundings: &'a Surroundings<'a>,
    known: Meshes,
    /// One file may have several names (relative, package://…).
    files: BTreeMap<(PathBuf, [u64; 3]), Arc<Mesh>>,
}

impl MeshLoader<'_> {
    /// Whether the mesh is had.
    fn load(&mut self, key: &MeshKey, scale: [f64; 3]) -> bool {
        if !self.known.contains_key(key) {
            let loaded = self.load_new(key, scale);
            self.known.insert(key.clone(), loaded);
        }
        self.known.get(key).is_some_and(Result::is_ok)
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
