//! Numbers and checks a world.

use super::{Effects, Model, ModelSpec, ShapeSpec};
use crate::error::ModelError;
use crate::parts::{ActuatorKind, Base, Coordinate, Force, Mechanism, MechanismKind, Vehicle, VehicleSpec};
use contact::Collider;
use contact::Scene;
use multibody::JointKind;
use spatial::{Frame, Vec3};
use std::sync::Arc;

impl Model {
    /// Numbers and checks a world.
    pub fn build(spec: ModelSpec) -> Result<Self, ModelError> {
        Self::build_like(None, spec)
    }

    /// As [`Model::build`], to the bit; colliders that are equal to those of a known scene share what was prepared for them.
    pub fn build_like(known: Option<&Scene>, spec: ModelSpec) -> Result<Self, ModelError> {
        if !(spec.step.is_finite() && spec.step > 0.0) {
            return Err(ModelError::Step(spec.step));
        }
        let vehicles = number_vehicles(spec.vehicles)?;
        let owners: Vec<_> =
            vehicles.iter().enumerate().flat_map(|(i, v)| (0..v.tree.bodies.len()).map(move |b| (i, b))).collect();
        let collider_names = spec.shapes.iter().map(|s| qualified_name(&vehicles, s)).collect();
        let collider_links = spec.shapes.iter().map(|s| link_name(&vehicles, s)).collect();
        let colliders: Vec<_> = spec.shapes.iter().map(|s| collider(&vehicles, s, owners.len())).collect();
        let (pairs, laws): (Vec<_>, Vec<_>) = spec.pairs.into_iter().unzip();
        let scene = Scene::like(known, colliders, pairs)?;
        let collider_radius = calc_collider_radius(&scene, owners.len() + 1);
        let coordinates = vehicles.iter().flat_map(coordinates_of).collect::<Vec<_>>();
        let mechanism_sides = resolve_mechanisms(&spec.mechanisms, &vehicles, owners.len())?;
        let mut model = Self {
            vehicles,
            scene,
            laws,
            collider_names,
            collider_links,
            owners,
            coordinates,
            actuators: spec.actuators,
            environment: spec.environment,
            integrator: spec.integrator,
            step: spec.step,
            mechanisms: spec.mechanisms,
            drives: Vec::new(),
            effects: Effects::default(),
            forces: Vec::new(),
            mechanism_sides,
            dead_weights: Vec::new(),
            speed_limited: Vec::new(),
            collider_radius,
        };
        model.attach_drives()?;
        model.effects = Effects::build(spec.effects, &mut model)?;
        super::dead_weight::attach(&mut model)?;
        model.speed_limited = speed_limited(&model.coordinates);
        Ok(model)
    }

    fn attach_drives(&mut self) -> Result<(), ModelError> {
        for (i, actuator) in self.actuators.iter().enumerate() {
            if let ActuatorKind::JointDrive { coordinate, .. } | ActuatorKind::JointEffort { coordinate, .. } =
                actuator.kind
            {
                let slot = self.coordinates.get_mut(coordinate).filter(|c| c.is_scalar);
                slot.ok_or_else(|| ModelError::Actuator(actuator.name.clone()))?.actuators.push(i);
            }
            if let ActuatorKind::LatchRelease { mechanism } = actuator.kind {
                let is_latch = |m: &Mechanism| matches!(m.kind, MechanismKind::Latch(_));
                let found = self.mechanisms.get(mechanism).is_some_and(is_latch);
                found.then_some(()).ok_or_else(|| ModelError::LatchRelease(actuator.name.clone()))?;
            }
        }
        Ok(())
    }
}

impl Model {
    /// The same model with forces of one's own. Errors: one that acts on a link that is not there.
    pub fn with_forces(mut self, forces: Vec<Arc<dyn Force>>) -> Result<Self, ModelError> {
        let is_there = |(v, l): &(usize, usize)| self.vehicles.get(*v).is_some_and(|v| *l < v.tree.links.len());
        for force in &forces {
            if let Some((vehicle, link)) = force.links().iter().find(|at| !is_there(at)) {
                let fault = format!("acts on link {link} of vehicle {vehicle}, which is not there; see Model::link");
                return Err(ModelError::Force { name: force.name().to_owned(), fault });
            }
        }
        self.forces = forces;
        Ok(self)
    }
}

fn number_vehicles(specs: Vec<VehicleSpec>) -> Result<Vec<Vehicle>, ModelError> {
    let (mut q0, mut v0, mut body0) = (0, 0, 0);
    let mut vehicles: Vec<Vehicle> = Vec::with_capacity(specs.len());
    for VehicleSpec { name, tree, base } in specs {
        if vehicles.iter().any(|v| v.name == name) {
            return Err(ModelError::DuplicateVehicle(name));
        }
        if base != Base::Fixed && tree.mass() <= 0.0 {
            return Err(ModelError::MasslessBase(name));
        }
        check_mask(&name, base)?;
        if let Some(range) = tree.find_empty_range() {
            return Err(ModelError::EmptyRange { vehicle: name, range });
        }
        let vehicle = Vehicle { name, tree, base, q0, v0, body0 };
        (q0, v0, body0) = (q0 + vehicle.tree.nq, v0 + vehicle.tree.nv, body0 + vehicle.tree.bodies.len());
        vehicles.push(vehicle);
    }
    Ok(vehicles)
}

/// A base that turns about an axis must slide in both directions across it, or in none: otherwise the account of its
/// angular momentum would need the reaction of the guide.
fn check_mask(name: &str, base: Base) -> Result<(), ModelError> {
    let m = base.mask();
    for axis in 0..3 {
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        if m[axis] && m[3 + j] != m[3 + k] {
            return Err(ModelError::Mask(name.to_owned()));
        }
    }
    Ok(())
}

/// Bodies and frames of the mechanisms' sides, each mechanism checked.
fn resolve_mechanisms(
    mechanisms: &[Mechanism],
    vehicles: &[Vehicle],
    world: usize,
) -> Result<Vec<[(usize, Frame); 2]>, ModelError> {
    let mut sides: Vec<[(usize, Frame); 2]> = Vec::with_capacity(mechanisms.len());
    for (i, mechanism) in mechanisms.iter().enumerate() {
        let refuse = |fault: &str| ModelError::Mechanism { name: mechanism.name.clone(), fault: fault.to_owned() };
        if mechanisms[..i].iter().any(|m| m.name == mechanism.name) {
            return Err(refuse("is defined twice; give each its own name"));
        }
        let [a, b] = [mechanism.side_a, mechanism.side_b].map(|s| s.resolve(vehicles, world));
        let (Some(a), Some(b)) = (a, b) else { return Err(refuse("an anchor names no vehicle or link")) };
        if a.0 == b.0 {
            return Err(refuse("both anchors are on the same body, which it cannot move; put one on another body"));
        }
        if let Some(fault) = mechanism.kind.find_fault() {
            return Err(refuse(&fault));
        }
        sides.push([a, b]);
    }
    Ok(sides)
}

fn qualified_name(vehicles: &[Vehicle], shape: &ShapeSpec) -> String {
    shape.vehicle.map_or_else(|| format!("world/{}", shape.name), |v| format!("{}/{}", vehicles[v].name, shape.name))
}

fn link_name(vehicles: &[Vehicle], shape: &ShapeSpec) -> String {
    let of = |v: usize| format!("{}/{}", vehicles[v].name, vehicles[v].tree.links[shape.link].name);
    shape.vehicle.map_or_else(|| "world".to_owned(), of)
}

fn collider(vehicles: &[Vehicle], shape: &ShapeSpec, world: usize) -> Collider {
    let (body, pose_bs) = match shape.vehicle {
        None => (world, shape.pose_ls),
        Some(v) => {
            let link = &vehicles[v].tree.links[shape.link];
            (vehicles[v].body0 + link.body, link.frame_bl.to_pose() * shape.pose_ls)
        }
    };
    Collider { name: qualified_name(vehicles, shape), body, pose_bs, shape: shape.shape.clone() }
}

fn calc_collider_radius(scene: &Scene, n_bodies: usize) -> Vec<f64> {
    let mut radius = vec![-1.0_f64; n_bodies];
    for collider in scene.colliders() {
        let reach = collider.pose_bs.translation.vector.norm() + calc_bounding_radius(&collider.shape);
        radius[collider.body] = radius[collider.body].max(reach);
    }
    radius
}

/// Radius of a ball about the shape's origin that holds it, m (a half-space: zero, it belongs to what does not turn).
fn calc_bounding_radius(shape: &contact::Shape) -> f64 {
    use contact::Shape;
    let farthest = |points: &[Vec3]| points.iter().map(|p| p.norm()).fold(0.0, f64::max);
    match shape {
        Shape::Ball { radius } => *radius,
        Shape::Cuboid { half_extents } => half_extents.norm(),
        Shape::Cylinder { radius, half_length } => radius.hypot(*half_length),
        Shape::Capsule { radius, half_length } => radius + half_length,
        Shape::HalfSpace => 0.0,
        Shape::Bed(bed) => bed.samples.iter().map(|s| s.point.norm()).fold(0.0, f64::max),
        Shape::Docking(docking) => docking.calc_bounding_radius(),
        Shape::ConvexHull { vertices } | Shape::TriMesh { vertices, .. } => farthest(vertices),
        Shape::Compound(parts) => {
            parts.iter().map(|(pose, s)| pose.translation.vector.norm() + calc_bounding_radius(s)).fold(0.0, f64::max)
        }
    }
}

fn speed_limited(coordinates: &[Coordinate]) -> Vec<usize> {
    let is_limited = |c: &Coordinate| c.speed_limit.is_finite() && !c.actuators.is_empty() && c.series.is_none();
    (0..coordinates.len()).filter(|i| is_limited(&coordinates[*i])).collect()
}

fn coordinates_of(vehicle: &Vehicle) -> Vec<Coordinate> {
    let mut coordinates = vec![Coordinate::default(); vehicle.tree.nv];
    for joint in vehicle.tree.joints.iter().filter(|j| !j.is_mimic) {
        if matches!(joint.kind, JointKind::Revolute | JointKind::Prismatic) {
            coordinates[joint.v_index] = Coordinate::from_joint(joint, vehicle.q0 + joint.q_index);
        }
    }
    coordinates
}
