//! The immutable world: vehicles, contact pairs and their laws, actuators, environment.
//!
//! All vehicles' coordinates stand in one vector each, `q` and `v`; bodies have one global index, the world (fixed,
//! in W) the last. A `Model` never changes after [`Model::build`] and is shared by all threads.

use crate::actuator::{Actuator, ActuatorKind, Coordinate};
use crate::effect::{Effect, EffectKind, Effects, Series};
use crate::environment::Environment;
use crate::error::ModelError;
use crate::force::Force;
use crate::mechanism::{Mechanism, MechanismKind};
use contact::{Collider, Normal, Scene};
use friction::{Friction, Pivot};
use multibody::{JointKind, Tree};
use spatial::{Frame, Inertia, Pose, Vec3};
use std::sync::Arc;

/// How a vehicle's base moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// Six freedoms.
    Free,
    /// None: bolted to W.
    Fixed,
    /// Only the marked components of its twist, W axes: angular x, y, z, then linear x, y, z.
    Only([bool; 6]),
    /// Moves as this one of [`Model::drives`] says, whatever the forces; see [`Model::with_drives`].
    Driven(usize),
}

impl Base {
    /// Whether no force moves it.
    pub fn is_held(&self) -> bool {
        matches!(self, Self::Fixed | Self::Driven(_))
    }

    /// The free components: angular x, y, z, then linear x, y, z.
    pub fn mask(&self) -> [bool; 6] {
        match self {
            Self::Free => [true; 6],
            Self::Fixed | Self::Driven(_) => [false; 6],
            Self::Only(mask) => *mask,
        }
    }
}

/// One robot or spacecraft in the world.
#[derive(Clone, Debug)]
pub struct Vehicle {
    /// Unique name.
    pub name: String,
    /// Its tree.
    pub tree: Tree,
    /// How its base moves.
    pub base: Base,
    /// First index into the world's `q`.
    pub q0: usize,
    /// First index into the world's `v`.
    pub v0: usize,
    /// Global index of its base body.
    pub body0: usize,
}

impl Vehicle {
    /// Its part of the world's `q`.
    pub fn q_range(&self) -> std::ops::Range<usize> {
        self.q0..self.q0 + self.tree.nq
    }

    /// Its part of the world's `v`.
    pub fn v_range(&self) -> std::ops::Range<usize> {
        self.v0..self.v0 + self.tree.nv
    }
}

/// The laws of one contact pair; both are forces on B, A the pair's first collider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairLaw {
    /// Along the normal.
    pub normal: Normal,
    /// In the tangent plane; `None` for a frictionless pair.
    pub friction: Option<Friction>,
    /// Against spinning and rolling, lumped in every point; `None` where several points of a patch do it.
    pub pivot: Option<Pivot>,
    /// Direction along which the friction levels are meant, for a law that differs across it.
    pub grain: Option<Grain>,
    /// Whether only the deepest point of the pair bears, under one identity wherever it moves to; else all of them do.
    pub only_deepest: bool,
}

impl PairLaw {
    /// Laws of forces alone, without a grain.
    pub fn new(normal: Normal, friction: Option<Friction>) -> Self {
        Self { normal, friction, pivot: None, grain: None, only_deepest: false }
    }

    /// Whether its points have memory.
    pub(crate) fn remembers(&self) -> bool {
        self.friction.is_some() || self.pivot.is_some()
    }
}

/// A direction of a surface, as brushed or turned: laid into the tangent plane at every point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grain {
    /// Whether it belongs to B; else to A.
    pub on_b: bool,
    /// The direction, axes of the body (of W for the world).
    pub axis: Vec3,
    /// Turn of the laid direction about the outward normal of the side it belongs to, rad.
    pub angle: f64,
}

impl Grain {
    /// The direction at a point, W axes; zero where it stands upright on the plane.
    pub(crate) fn calc_direction(&self, touch: &crate::contacts::Touch) -> Vec3 {
        let axis = if self.on_b { touch.rot_b } else { touch.rot_a } * self.axis;
        let laid = axis - touch.normal * touch.normal.dot(&axis);
        let laid = laid.try_normalize(UPRIGHT * axis.norm()).unwrap_or_default();
        if self.angle == 0.0 {
            return laid;
        }
        let outward = if self.on_b { -touch.normal } else { touch.normal };
        let (sin, cos) = self.angle.sin_cos();
        laid * cos + outward.cross(&laid) * sin
    }
}

/// Sine of the angle to the normal below which a grain says nothing.
const UPRIGHT: f64 = 1e-6;

/// Fixed-step integrators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Integrator {
    /// Linearly implicit in contact, friction and joint springs; first order, L-stable. The default.
    #[default]
    ImplicitEuler,
    /// Implicit midpoint; second order where contact is resolved.
    ImplicitMidpoint,
    /// Forces from the start of the step, positions with the new velocities; first order.
    SemiImplicitEuler,
    /// The classical fourth-order method.
    RungeKutta4,
}

/// A shape that touches, before it becomes a [`Collider`].
#[derive(Clone, Debug)]
pub struct ShapeSpec {
    /// Unique within the vehicle.
    pub name: String,
    /// Vehicle, or `None` for the world.
    pub vehicle: Option<usize>,
    /// Link of that vehicle (ignored for the world).
    pub link: usize,
    /// Shape frame in the link frame (in W for the world).
    pub pose_ls: Pose,
    /// The shape.
    pub shape: contact::Shape,
}

/// One vehicle, before it is numbered.
#[derive(Clone, Debug)]
pub struct VehicleSpec {
    /// Unique name.
    pub name: String,
    /// Its tree, rotors included.
    pub tree: Tree,
    /// How its base moves.
    pub base: Base,
}

/// Everything a world is made of.
#[derive(Clone, Debug)]
pub struct ModelSpec {
    /// Vehicles in their order.
    pub vehicles: Vec<VehicleSpec>,
    /// Shapes that may touch.
    pub shapes: Vec<ShapeSpec>,
    /// Pairs of shapes that may touch, with their laws.
    pub pairs: Vec<([usize; 2], PairLaw)>,
    /// What joins bodies beside joints and contact.
    pub mechanisms: Vec<Mechanism>,
    /// Actuators in the order of the commands.
    pub actuators: Vec<Actuator>,
    /// Physics beyond all that, in the order of their memory.
    pub effects: Vec<Effect>,
    /// Gravity and tides.
    pub environment: Environment,
    /// How time advances.
    pub integrator: Integrator,
    /// Step, s.
    pub step: f64,
}

/// The immutable world.
#[derive(Clone, Debug)]
pub struct Model {
    /// Vehicles in their order.
    pub vehicles: Vec<Vehicle>,
    /// Contact geometry.
    pub scene: Scene,
    /// Laws by the scene's pair index.
    pub laws: Vec<PairLaw>,
    /// Names of colliders, `vehicle/shape`, by collider.
    pub collider_names: Vec<String>,
    /// Names of the links that carry them, `vehicle/link`, or `world`.
    pub collider_links: Vec<String>,
    /// Vehicle and body of a global body index; the world is not in the list.
    pub owners: Vec<(usize, usize)>,
    /// Laws of the single coordinates, by index into `v`.
    pub coordinates: Vec<Coordinate>,
    /// Actuators in the order of the commands.
    pub actuators: Vec<Actuator>,
    /// Gravity and tides.
    pub environment: Environment,
    /// How time advances.
    pub integrator: Integrator,
    /// Step, s.
    pub step: f64,
    /// What joins bodies beside joints and contact.
    pub mechanisms: Vec<Mechanism>,
    /// Bases that follow a path.
    pub drives: Vec<crate::drive::Drive>,
    /// Physics beyond all that.
    pub(crate) effects: Effects,
    /// Forces of one's own; see [`Model::with_forces`].
    pub(crate) forces: Vec<Arc<dyn Force>>,
    /// Global bodies and the frames in them, of the two sides of each mechanism.
    pub(crate) mechanism_sides: Vec<[(usize, Frame); 2]>,
    /// Pairs whose guide presses them together with a weight; nothing is detected for them.
    pub(crate) dead_weights: Vec<crate::dead_weight::DeadWeight>,
    /// Coordinates whose actuators a speed limit stops, but for those behind a gear that yields.
    pub(crate) speed_limited: Vec<usize>,
    /// Bounding radius of each body's colliders about its origin, m; negative where it has none.
    pub(crate) collider_radius: Vec<f64>,
}

impl Model {
    /// The fastest of what effects bring with them, and of what they drive the rest with, rad/s: steps much longer than an inverse do not see
    /// it.
    pub fn effect_rates(&self) -> [f64; 2] {
        let most = |rate: fn(&EffectKind) -> f64| self.effects.list.iter().map(|e| rate(&e.kind)).fold(0.0, f64::max);
        [most(EffectKind::own_rate), most(EffectKind::driving_rate)]
    }

    /// Whether no law in it has a corner but the joints' stops, and no effect a memory: nothing may touch, no dry friction, no gear, no lag,
    /// no mechanism.
    pub fn is_smooth(&self) -> bool {
        self.scene.pairs().is_empty()
            && self.mechanisms.is_empty()
            && self.effects.n_memory() == 0
            && self.coordinates.iter().all(|c| c.dry.is_none())
    }

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
        crate::dead_weight::attach(&mut model)?;
        model.speed_limited = speed_limited(&model.coordinates);
        Ok(model)
    }

    /// Whether a coordinate is that of a sliding joint: of m and N, not of rad and N·m.
    pub fn slides(&self, coordinate: usize) -> bool {
        let mut joints = self.vehicles.iter().flat_map(|v| v.tree.joints.iter().map(|j| (v.v0 + j.v_index, j)));
        joints.any(|(at, joint)| at == coordinate && !joint.is_mimic && joint.kind == JointKind::Prismatic)
    }

    /// Acceleration of what falls freely at a point of W, m/s², W axes: gravity, tide, tilt.
    pub fn calc_field(&self, time: f64, point: &Vec3) -> Vec3 {
        let unit = Inertia { mass: 1.0, ..Inertia::default() };
        self.environment.calc_wrench(time, point, &unit).force + self.effects.tilt
    }

    /// The effects in their order.
    pub fn effects(&self) -> &[Effect] {
        &self.effects.list
    }

    /// Where the memory of an effect stands in [`crate::State::effects`].
    pub fn effect_memory(&self, index: usize) -> std::ops::Range<usize> {
        self.effects.memory(index)
    }

    /// The gear that an effect is.
    pub(crate) fn series(&self, index: usize) -> Option<(usize, &Series)> {
        match &self.effects.list[index].kind {
            EffectKind::Series(series) => Some((index, series)),
            _ => None,
        }
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

    /// Global index of the world body.
    pub fn world_body(&self) -> usize {
        self.owners.len()
    }

    /// Length of `q`.
    pub fn nq(&self) -> usize {
        self.vehicles.last().map_or(0, |v| v.q0 + v.tree.nq)
    }

    /// Length of `v`.
    pub fn nv(&self) -> usize {
        self.vehicles.last().map_or(0, |v| v.v0 + v.tree.nv)
    }

    /// How many actuators, drives and effects have books of their own.
    pub(crate) fn n_works(&self) -> usize {
        self.actuators.len() + self.drives.len() + self.effects.list.len() + self.forces.len()
    }

    /// Where the books of a force stand in [`crate::State::works`].
    pub(crate) fn work_of_force(&self, index: usize) -> usize {
        self.actuators.len() + self.drives.len() + self.effects.list.len() + index
    }

    /// Where the books of an effect stand in [`crate::State::works`].
    pub(crate) fn work_of_effect(&self, index: usize) -> usize {
        self.actuators.len() + self.drives.len() + index
    }

    /// Index of a vehicle by name.
    pub fn vehicle(&self, name: &str) -> Option<usize> {
        self.vehicles.iter().position(|v| v.name == name)
    }

    /// Vehicle and link of `vehicle/link`.
    pub fn link(&self, name: &str) -> Option<(usize, usize)> {
        let (vehicle, link) = name.split_once('/')?;
        let v = self.vehicle(vehicle)?;
        Some((v, self.vehicles[v].tree.link(link)?))
    }

    /// Name of a pair, `vehicle/shape · vehicle/shape`.
    pub fn pair_name(&self, pair: usize) -> String {
        let [a, b] = self.scene.pairs()[pair];
        format!("{} · {}", self.collider_names[a], self.collider_names[b])
    }

    /// Global bodies of a pair's two colliders.
    #[inline]
    pub fn pair_bodies(&self, pair: usize) -> (usize, usize) {
        let [a, b] = self.scene.pairs()[pair];
        (self.scene.colliders()[a].body, self.scene.colliders()[b].body)
    }

    /// Radius of the ball about a global body's origin that holds its shapes, m; zero where it has none, and for what has no end.
    pub fn collider_radius(&self, body: usize) -> f64 {
        self.collider_radius[body].max(0.0)
    }

    /// Name of a body for messages: `vehicle/joint's child`.
    pub fn body_name(&self, body: usize) -> String {
        let Some(&(vehicle, local)) = self.owners.get(body) else { return "world".to_owned() };
        let vehicle = &self.vehicles[vehicle];
        let link = vehicle.tree.links.iter().find(|l| l.body == local).map_or("?", |l| &l.name);
        format!("{}/{link}", vehicle.name)
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
