//! What may touch what: checked, immutable, shared by all threads.

use crate::convex::{Convex, Core};
use crate::cylinder::Cylinder;
use crate::docking::{Sheet, Tessellation, rank_of};
use crate::faceted::Faceted;
use crate::{Collider, ContactError, Shape};
use parry3d_f64::math::{Pose as ParryPose, Vector};
use parry3d_f64::shape::SharedShape;
use spatial::{Frame, Mat3, Pose, Vec3};
use std::sync::Arc;

/// One contact point of a pair, A the pair's first collider, B its second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// Index into [`Scene::pairs`].
    pub pair: u32,
    /// Identity inside the pair.
    pub feature: u64,
    /// Witness point on A's surface, W axes, m.
    pub point_a_w: Vec3,
    /// Witness point on B's surface, W axes, m.
    pub point_b_w: Vec3,
    /// Unit normal, from A to B.
    pub normal_w: Vec3,
    /// Distance along the normal, m; negative: penetration.
    pub gap: f64,
    /// Share of the pair's law (stiffness, damping, adhesion) that acts here: 1, but for the samples of a bed.
    pub weight: f64,
}

/// A convex piece, or a surface, as the detector asks it.
#[derive(Clone)]
pub(crate) enum Solid {
    Ball(f64),
    Primitive(Convex, Twin),
    HalfSpace(Twin),
    Docking(Sheet, Twin, Faceted),
    Other(Twin, Faceted),
    Bed(crate::Bed),
}

/// The same piece as parry knows it, and its turn within the piece's frame (parry's cylinder stands along y).
#[derive(Clone)]
pub(crate) struct Twin {
    pub(crate) shape: SharedShape,
    pub(crate) turn: Mat3,
}

impl Twin {
    fn new(shape: SharedShape) -> Self {
        Self { shape, turn: Mat3::identity() }
    }
}

/// One piece of a collider.
#[derive(Clone)]
pub(crate) struct Part {
    /// Piece in body.
    pub(crate) frame_bp: Frame,
    pub(crate) solid: Solid,
    /// Half extents of the piece's bounding box about `centre`, piece axes; infinite for a half-space.
    pub(crate) half: Vec3,
    pub(crate) centre: Vec3,
    /// Whether it is a mesh with an inside.
    pub(crate) closed: bool,
}

/// Colliders and the pairs of them that are looked at.
#[derive(Clone)]
pub struct Scene {
    colliders: Vec<Collider>,
    pairs: Vec<[usize; 2]>,
    pub(crate) parts: Vec<Arc<[Part]>>,
    /// Pair of two colliders, by `low * n + high`; `NONE` where they are not looked at.
    pub(crate) pair_of: Vec<u32>,
    /// Colliders of the pairs that are looked at, in order: the others need no place.
    pub(crate) asked: Vec<u32>,
}

/// No pair.
pub(crate) const NONE: u32 = u32::MAX;

impl std::fmt::Debug for Scene {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Scene").field("colliders", &self.colliders.len()).field("pairs", &self.pairs.len()).finish()
    }
}

impl Scene {
    /// Checks and prepares colliders and pairs of their indices.
    pub fn new(colliders: Vec<Collider>, pairs: Vec<[usize; 2]>) -> Result<Self, ContactError> {
        Self::like(None, colliders, pairs)
    }

    /// As [`Scene::new`]; what a known scene has prepared for an equal collider is shared with it. The result is the same.
    pub fn like(known: Option<&Self>, colliders: Vec<Collider>, pairs: Vec<[usize; 2]>) -> Result<Self, ContactError> {
        let mut parts: Vec<Arc<[Part]>> = Vec::with_capacity(colliders.len());
        for collider in &colliders {
            let ready = known.and_then(|scene| {
                let place = scene.colliders.iter().position(|c| c == collider)?;
                Some(Arc::clone(&scene.parts[place]))
            });
            parts.push(match ready {
                Some(ready) => ready,
                None => {
                    collider.check()?;
                    let mut own = Vec::new();
                    add_parts(collider, &collider.shape, &collider.pose_bs, &mut own)?;
                    own.into()
                }
            });
        }
        let n = colliders.len();
        let mut pair_of = vec![NONE; n * n];
        for (index, &[a, b]) in pairs.iter().enumerate() {
            if let Some(&index_out) = [a, b].iter().find(|i| **i >= n) {
                return Err(ContactError::PairIndex { pair: index, index: index_out, colliders: n });
            }
            if a == b {
                return Err(ContactError::SelfPair { pair: index, collider: colliders[a].name.clone() });
            }
            let known = &mut pair_of[a.min(b) * n + a.max(b)];
            if *known != NONE {
                let names = [a, b].map(|i| colliders[i].name.clone());
                return Err(ContactError::PairTwice { pair: index, names, first: *known as usize });
            }
            *known = index as u32;
        }
        let mut scene = Self { colliders, pairs, parts, pair_of, asked: Vec::new() };
        scene.list_asked();
        Ok(scene)
    }

    fn list_asked(&mut self) {
        let n = self.colliders.len();
        let is_asked = |i: &u32| {
            let i = *i as usize;
            (0..n).any(|j| self.pair_of[i.min(j) * n + i.max(j)] != NONE)
        };
        self.asked = (0..n as u32).filter(is_asked).collect();
    }

    /// The pairs, as indices of colliders.
    pub fn pairs(&self) -> &[[usize; 2]] {
        &self.pairs
    }

    /// Whether one of a pair's colliders has a bed, whose points are known by their samples alone.
    pub fn has_bed(&self, pair: usize) -> bool {
        self.pairs[pair].iter().any(|&c| self.parts[c].iter().any(crate::bed_points::is_bed))
    }

    /// Takes a pair from those that are looked at; it keeps its number.
    pub fn ignore(&mut self, pair: usize) {
        let (n, [a, b]) = (self.colliders.len(), self.pairs[pair]);
        self.pair_of[a.min(b) * n + a.max(b)] = NONE;
        self.list_asked();
    }

    /// The colliders.
    pub fn colliders(&self) -> &[Collider] {
        &self.colliders
    }
}

fn add_parts(collider: &Collider, shape: &Shape, pose: &Pose, parts: &mut Vec<Part>) -> Result<(), ContactError> {
    if let Shape::Compound(children) = shape {
        return children
            .iter()
            .try_for_each(|(child_pose, child)| add_parts(collider, child, &(pose * child_pose), parts));
    }
    if let Shape::Docking(docking) = shape {
        for sheet in docking.sheets(rank_of(&collider.name)) {
            let (half, centre) = sheet.bounds();
            let (twin, faceted) = facets_of_sheet(collider, &sheet)?;
            let solid = Solid::Docking(sheet, twin, faceted);
            parts.push(Part { frame_bp: Frame::from(pose), solid, half, centre, closed: false });
        }
        return Ok(());
    }
    let solid = solid_of(collider, shape)?;
    let (half, centre) = bounds(&solid);
    let closed = crate::decompose_measure::is_closed_mesh(shape);
    parts.push(Part { frame_bp: Frame::from(pose), solid, half, centre, closed });
    Ok(())
}

fn solid_of(collider: &Collider, shape: &Shape) -> Result<Solid, ContactError> {
    let primitive = |core, radius, twin| Solid::Primitive(Convex { core, radius }, twin);
    Ok(match shape {
        Shape::Ball { radius } => Solid::Ball(*radius),
        Shape::Cuboid { half_extents: h } => {
            primitive(Core::Cuboid { half: *h }, 0.0, Twin::new(SharedShape::cuboid(h.x, h.y, h.z)))
        }
        Shape::HalfSpace => Solid::HalfSpace(Twin::new(SharedShape::halfspace(Vector::Z))),
        Shape::Capsule { radius, half_length: half } => {
            primitive(Core::Segment { half: *half }, *radius, Twin::new(SharedShape::capsule_z(*half, *radius)))
        }
        Shape::Cylinder { radius, half_length } => {
            let turn = spatial::rotation_about(&Vec3::x(), std::f64::consts::FRAC_PI_2);
            let core = Core::Cylinder(Cylinder { radius: *radius, half: *half_length });
            primitive(core, 0.0, Twin { shape: SharedShape::cylinder(*half_length, *radius), turn })
        }
        Shape::ConvexHull { vertices } => {
            let points: Vec<Vector> = vertices.iter().map(to_parry).collect();
            let hull = SharedShape::convex_hull(&points).filter(|h| h.mass_properties(1.0).mass() > 0.0);
            let known = hull.and_then(|hull| Some(Solid::Other(Twin::new(hull.clone()), Faceted::hull(&hull)?)));
            let (collider, points) = (collider.name.clone(), vertices.len());
            known.ok_or(ContactError::DegenerateHull { collider, points })?
        }
        Shape::TriMesh { vertices, triangles } => {
            let known = Faceted::mesh(vertices, triangles).and_then(|(points, corners, mesh)| {
                let twin = SharedShape::trimesh(points.iter().map(to_parry).collect(), corners).ok()?;
                Some(Solid::Other(Twin::new(twin), mesh))
            });
            let (collider, triangles) = (collider.name.clone(), triangles.len());
            known.ok_or(ContactError::DegenerateMesh { collider, triangles })?
        }
        Shape::Bed(bed) => Solid::Bed(bed.clone()),
        // Their pieces are parts of their own; none is left.
        Shape::Compound(_) | Shape::Docking(_) => Solid::Ball(0.0),
    })
}

/// A sheet in triangles, for what knows no other answer.
/// A sheet as a tessellation, for pairs that ask no closed form: parry's, and hulls and meshes.
fn facets_of_sheet(collider: &Collider, sheet: &Sheet) -> Result<(Twin, Faceted), ContactError> {
    let mut mesh = Tessellation::default();
    mesh.add(sheet);
    let triangles = mesh.triangles.len();
    let known = Faceted::mesh(&mesh.vertices, &mesh.triangles).and_then(|(points, corners, mesh)| {
        let twin = SharedShape::trimesh(points.iter().map(to_parry).collect(), corners).ok()?;
        Some((Twin::new(twin), mesh))
    });
    known.ok_or_else(|| ContactError::DegenerateMesh { collider: collider.name.clone(), triangles })
}

fn bounds(solid: &Solid) -> (Vec3, Vec3) {
    match solid {
        Solid::Ball(radius) => (Vec3::repeat(*radius), Vec3::zeros()),
        Solid::Primitive(convex, _) => (convex.half_extents(), Vec3::zeros()),
        Solid::HalfSpace(_) => (Vec3::repeat(f64::INFINITY), Vec3::zeros()),
        Solid::Docking(sheet, ..) => sheet.bounds(),
        Solid::Bed(bed) => {
            let (centre, half) = bed.bounds();
            (half, centre)
        }
        Solid::Other(twin, _) => {
            let aabb = twin.shape.compute_local_aabb();
            (from_parry(aabb.half_extents()), from_parry(aabb.center()))
        }
    }
}

pub(crate) fn to_parry(v: &Vec3) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

pub(crate) fn from_parry(v: Vector) -> Vec3 {
    Vec3::new(v.x, v.y, v.z)
}

/// A frame as parry takes it.
pub(crate) fn pose_to_parry(frame: &Frame) -> ParryPose {
    let r = &frame.rot;
    let column = |k: usize| Vector::new(r[(0, k)], r[(1, k)], r[(2, k)]);
    let matrix = parry3d_f64::glamx::DMat3::from_cols(column(0), column(1), column(2));
    ParryPose::from_parts(to_parry(&frame.pos), parry3d_f64::glamx::DQuat::from_mat3(&matrix))
}
