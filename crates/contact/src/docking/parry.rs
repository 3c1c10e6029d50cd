//! The docking shapes behind parry3d's extension points: a custom shape, and a dispatcher for its queries.
//!
//! `DockingDispatcher.chain(DefaultQueryDispatcher)` answers distance, contact, closest points, intersection and manifolds
//! of a [`DockingShape`] against balls, capsules, cylinders, boxes, half-spaces and other docking shapes with the same
//! closed forms as [`crate::Detector`]; every other pair is left to the next dispatcher, as are shape casts.

use super::Docking;
use super::body::{Body, Kind};
use super::pair::DockingBuffer;
use super::sheet::{Near, Sheet};
use crate::ContactError;
use crate::analytic::Raw;
use crate::convex::Core;
use crate::cylinder::Cylinder;
use crate::scene::{from_parry, to_parry};
use parry3d_f64::bounding_volume::{Aabb, BoundingSphere, BoundingVolume};
use parry3d_f64::mass_properties::MassProperties;
use parry3d_f64::math::{Pose as ParryPose, Vector};
use parry3d_f64::query::details::{ContactManifoldsWorkspace, NormalConstraints, ShapeCastOptions};
use parry3d_f64::query::{
    ClosestPoints, Contact, ContactManifold, NonlinearRigidMotion, PersistentQueryDispatcher, PointProjection,
    PointQuery, QueryDispatcher, Ray, RayCast, RayIntersection, ShapeCastHit, ShapeDistance, ShapeIntersection,
    TrackedContact, Unsupported,
};
use parry3d_f64::shape::{FeatureId, PackedFeatureId, Shape, ShapeType, TriMesh, TypedShape};
use spatial::{Frame, Vec3};

/// Steps of a ray towards a surface; each covers the distance to it.
const RAY_STEPS: usize = 256;
/// Bits of a parry feature that are its number.
const CODE: u32 = 0x3fff_ffff;
/// Distance at which a ray has arrived, m.
const ARRIVED: f64 = 1e-12;

/// A docking shape as parry3d's custom shape.
#[derive(Clone, Debug)]
pub struct DockingShape {
    docking: Docking,
    sheets: Vec<Sheet>,
}

impl DockingShape {
    /// Checks the sizes.
    pub fn new(docking: Docking) -> Result<Self, ContactError> {
        docking.check("docking shape")?;
        Ok(Self { docking, sheets: docking.sheets(0).collect() })
    }

    /// What it is made of.
    pub fn docking(&self) -> &Docking {
        &self.docking
    }

    /// Outward normal and distance from the surface of `p`, negative inside.
    fn nearest(&self, p: &Vec3) -> Near {
        let surface = |sheet: &Sheet| {
            let near = sheet.nearest(p);
            Near { distance: near.distance - sheet.radius, ..near }
        };
        let far = Near { normal: Vec3::z(), distance: f64::INFINITY };
        self.sheets.iter().map(surface).fold(far, |a, b| if b.distance < a.distance { b } else { a })
    }
}

impl Shape for DockingShape {
    fn compute_local_aabb(&self) -> Aabb {
        let boxes = self.sheets.iter().map(|sheet| {
            let (half, centre) = sheet.bounds();
            Aabb::from_half_extents(to_parry(&centre), to_parry(&half))
        });
        boxes.reduce(|a, b| a.merged(&b)).unwrap_or_else(Aabb::new_invalid)
    }

    fn compute_local_bounding_sphere(&self) -> BoundingSphere {
        BoundingSphere::new(Vector::ZERO, self.docking.calc_bounding_radius())
    }

    fn clone_dyn(&self) -> Box<dyn Shape> {
        Box::new(self.clone())
    }

    /// Not scaled: a wall keeps its thickness only where all axes scale alike, and users give sizes.
    fn scale_dyn(&self, _scale: Vector, _subdivisions: u32) -> Option<Box<dyn Shape>> {
        None
    }

    /// Of the tessellation.
    fn mass_properties(&self, density: f64) -> MassProperties {
        let mesh = self.docking.tessellate();
        let vertices = mesh.vertices.iter().map(to_parry).collect();
        TriMesh::new(vertices, mesh.triangles)
            .map_or_else(|_| MassProperties::default(), |m| m.mass_properties(density))
    }

    fn shape_type(&self) -> ShapeType {
        ShapeType::Custom
    }

    fn as_typed_shape(&self) -> TypedShape<'_> {
        TypedShape::Custom(self)
    }

    fn ccd_thickness(&self) -> f64 {
        self.sheets.iter().map(|sheet| sheet.radius).fold(f64::INFINITY, f64::min)
    }

    fn ccd_angular_thickness(&self) -> f64 {
        std::f64::consts::FRAC_PI_4
    }
}

impl PointQuery for DockingShape {
    fn project_local_point(&self, p: Vector, solid: bool) -> PointProjection {
        let at = from_parry(p);
        let near = self.nearest(&at);
        let is_inside = near.distance <= 0.0;
        let point = if is_inside && solid { p } else { to_parry(&(at - near.distance * near.normal)) };
        PointProjection::new(is_inside, point)
    }

    fn project_local_point_and_get_feature(&self, p: Vector) -> (PointProjection, FeatureId) {
        (self.project_local_point(p, false), FeatureId::Face(0))
    }
}

impl RayCast for DockingShape {
    /// Steps by the distance from the surface, which no ray can cross within it (Hart 1996).
    fn cast_local_ray_and_get_normal(&self, ray: &Ray, longest: f64, solid: bool) -> Option<RayIntersection> {
        let (origin, dir) = (from_parry(ray.origin), from_parry(ray.dir));
        let speed = dir.norm();
        let start = self.nearest(&origin);
        if start.distance <= 0.0 && solid {
            return Some(RayIntersection::new(0.0, Vector::ZERO, FeatureId::Face(0)));
        }
        let side = 1f64.copysign(start.distance);
        let mut time = 0.0;
        for _ in 0..RAY_STEPS {
            let near = self.nearest(&(origin + time * dir));
            let distance = side * near.distance;
            if distance <= ARRIVED {
                return Some(RayIntersection::new(time, to_parry(&(side * near.normal)), FeatureId::Face(0)));
            }
            time += distance / speed;
            // Also where the ray has no direction, and `time` is no number.
            if !(time <= longest) {
                return None;
            }
        }
        None
    }
}

/// Answers parry3d's queries for pairs with a [`DockingShape`].
#[derive(Clone, Copy, Debug, Default)]
pub struct DockingDispatcher;

/// A parry shape in the terms of this crate.
struct Pieces<'a> {
    core: Option<Core>,
    plane: bool,
    sheets: &'a [Sheet],
    radius: f64,
    frame: Frame,
}

impl<'a> Pieces<'a> {
    fn of(shape: &'a dyn Shape, frame: &Frame) -> Option<Self> {
        let plain = Pieces { core: None, plane: false, sheets: &[], radius: 0.0, frame: *frame };
        if let Some(docking) = shape.as_shape::<DockingShape>() {
            return Some(Self { sheets: &docking.sheets, ..plain });
        }
        let upright = |z: Vec3, pos: Vec3| {
            let (x, y) = crate::patch::tangents(&z);
            Frame { rot: frame.rot * spatial::Mat3::from_columns(&[x, y, z]), pos: frame.point(&pos) }
        };
        Some(match shape.as_typed_shape() {
            TypedShape::Ball(ball) => Self { radius: ball.radius, ..plain },
            TypedShape::Cuboid(cuboid) => {
                Self { core: Some(Core::Cuboid { half: from_parry(cuboid.half_extents) }), ..plain }
            }
            TypedShape::HalfSpace(half) => {
                Self { plane: true, frame: upright(from_parry(half.normal), Vec3::zeros()), ..plain }
            }
            TypedShape::Cylinder(cylinder) => {
                let core = Core::Cylinder(Cylinder { radius: cylinder.radius, half: cylinder.half_height });
                Self { core: Some(core), frame: upright(Vec3::y(), Vec3::zeros()), ..plain }
            }
            TypedShape::Capsule(capsule) => {
                let (a, b) = (from_parry(capsule.segment.a), from_parry(capsule.segment.b));
                let axis = (b - a).try_normalize(0.0).unwrap_or_else(Vec3::z);
                let core = Core::Segment { half: 0.5 * (b - a).norm() };
                Self { core: Some(core), radius: capsule.radius, frame: upright(axis, 0.5 * (a + b)), ..plain }
            }
            _ => return None,
        })
    }

    fn bodies(&self) -> impl Iterator<Item = Body<'_>> {
        let body = |kind, radius| Body { kind, radius, frame: self.frame };
        let own = match (&self.core, self.plane) {
            (Some(core), _) => Kind::Core(core),
            (None, true) => Kind::Plane,
            (None, false) => Kind::Point,
        };
        let own = self.sheets.is_empty().then(|| body(own, self.radius));
        own.into_iter().chain(self.sheets.iter().map(move |sheet| body(Kind::Sheet(sheet), sheet.radius)))
    }
}

/// All points nearer than `margin`, in the first shape's frame.
fn points(pos12: &ParryPose, g1: &dyn Shape, g2: &dyn Shape, margin: f64) -> Result<Vec<Raw>, Unsupported> {
    let rotation = parry3d_f64::glamx::DMat3::from_quat(pos12.rotation);
    let columns = [rotation.x_axis, rotation.y_axis, rotation.z_axis].map(from_parry);
    let frame = Frame { rot: spatial::Mat3::from_columns(&columns), pos: from_parry(pos12.translation) };
    let one = Pieces::of(g1, &Frame::identity()).ok_or(Unsupported)?;
    let two = Pieces::of(g2, &frame).ok_or(Unsupported)?;
    if one.sheets.is_empty() && two.sheets.is_empty() {
        return Err(Unsupported);
    }
    let (mut buffer, mut found) = (DockingBuffer::default(), Vec::new());
    for (i, a) in one.bodies().enumerate() {
        for (j, b) in two.bodies().enumerate() {
            let start = found.len();
            buffer.add_points(&a, &b, margin, &mut found);
            found[start..]
                .iter_mut()
                .for_each(|p: &mut Raw| p.feature = crate::manifold::mix(p.feature, i as u32, j as u32));
        }
    }
    Ok(found)
}

fn nearest(pos12: &ParryPose, g1: &dyn Shape, g2: &dyn Shape, margin: f64) -> Result<Option<Raw>, Unsupported> {
    Ok(points(pos12, g1, g2, margin)?
        .into_iter()
        .min_by(|a, b| a.gap.total_cmp(&b.gap).then(a.feature.cmp(&b.feature))))
}

impl QueryDispatcher for DockingDispatcher {
    fn intersection_test(
        &self,
        pos12: &ParryPose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeIntersection, Unsupported> {
        Ok(nearest(pos12, g1, g2, f64::MIN_POSITIVE)?.is_some().into())
    }

    fn distance(&self, pos12: &ParryPose, g1: &dyn Shape, g2: &dyn Shape) -> Result<ShapeDistance, Unsupported> {
        let near = nearest(pos12, g1, g2, f64::INFINITY)?.ok_or(Unsupported)?;
        Ok(near.gap.max(0.0).into())
    }

    fn contact(
        &self,
        pos12: &ParryPose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: f64,
    ) -> Result<Option<Contact>, Unsupported> {
        let near = nearest(pos12, g1, g2, prediction)?;
        Ok(near.map(|near| {
            let (p1, p2) = witnesses(pos12, &near);
            let n1 = to_parry(&near.normal);
            Contact::new(p1, p2, n1, pos12.rotation.inverse() * -n1, near.gap)
        }))
    }

    fn closest_points(
        &self,
        pos12: &ParryPose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        max_dist: f64,
    ) -> Result<ClosestPoints, Unsupported> {
        Ok(match nearest(pos12, g1, g2, max_dist)? {
            None => ClosestPoints::Disjoint,
            Some(near) if near.gap <= 0.0 => ClosestPoints::Intersecting,
            Some(near) => {
                let (p1, p2) = witnesses(pos12, &near);
                ClosestPoints::WithinMargin(p1, p2)
            }
        })
    }

    fn cast_shapes(
        &self,
        _pos12: &ParryPose,
        _vel12: Vector,
        _g1: &dyn Shape,
        _g2: &dyn Shape,
        _options: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        Err(Unsupported)
    }

    fn cast_shapes_nonlinear(
        &self,
        _motion1: &NonlinearRigidMotion,
        _g1: &dyn Shape,
        _motion2: &NonlinearRigidMotion,
        _g2: &dyn Shape,
        _start: f64,
        _end: f64,
        _stop_at_penetration: bool,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        Err(Unsupported)
    }
}

impl<M: Default + Clone, C: Default + Copy> PersistentQueryDispatcher<M, C> for DockingDispatcher {
    /// One manifold for each point: normals differ. A manifold's data is kept where it keeps its place.
    fn contact_manifolds(
        &self,
        pos12: &ParryPose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: f64,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        _workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported> {
        let found = points(pos12, g1, g2, prediction)?;
        manifolds.resize_with(found.len(), ContactManifold::new);
        for (manifold, raw) in manifolds.iter_mut().zip(&found) {
            let (p1, p2) = witnesses(pos12, raw);
            manifold.local_n1 = to_parry(&raw.normal);
            manifold.local_n2 = pos12.rotation.inverse() * -manifold.local_n1;
            let id = PackedFeatureId::face(raw.feature as u32 & CODE);
            manifold.points.clear();
            manifold.points.push(TrackedContact::new(
                p1,
                p2,
                id,
                PackedFeatureId::face((raw.feature >> 32) as u32 & CODE),
                raw.gap,
            ));
        }
        Ok(())
    }

    fn contact_manifold_convex_convex(
        &self,
        _pos12: &ParryPose,
        _g1: &dyn Shape,
        _g2: &dyn Shape,
        _constraints1: Option<&dyn NormalConstraints>,
        _constraints2: Option<&dyn NormalConstraints>,
        _prediction: f64,
        _manifold: &mut ContactManifold<M, C>,
    ) -> Result<(), Unsupported> {
        Err(Unsupported)
    }
}

/// The two surface points, each in its own shape's frame.
fn witnesses(pos12: &ParryPose, raw: &Raw) -> (Vector, Vector) {
    let p2 = to_parry(&(raw.point_a + raw.gap * raw.normal));
    (to_parry(&raw.point_a), pos12.inverse_transform_point(p2))
}
