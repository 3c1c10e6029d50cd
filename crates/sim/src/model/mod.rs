//! The immutable world: vehicles, contact pairs and their laws, actuators, environment.
//!
//! All vehicles' coordinates stand in one vector each, `q` and `v`; bodies have one global index, the world (fixed,
//! in W) the last. A `Model` never changes after [`Model::build`] and is shared by all threads.

mod build;
mod dead_weight;
mod drives;
mod effects;
mod lines;
mod memory_layout;

pub(crate) use dead_weight::DeadWeight;
pub(crate) use effects::Effects;
pub(crate) use lines::Lines;
pub use memory_layout::{MemorySlot, memory_layout};

use crate::parts::{
    Actuator, Coordinate, Drive, Effect, EffectKind, Environment, Force, Mechanism, PairLaw, Series, Vehicle,
    VehicleSpec,
};
use contact::Scene;
use multibody::JointKind;
use spatial::{Frame, Inertia, Pose, Vec3};
use std::sync::Arc;

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

/// Where the laws of a step are evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scheme {
    ImplicitEuler,
    ImplicitMidpoint,
    SemiImplicitEuler,
}

/// A shape that touches, before it becomes a [`contact::Collider`].
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
    pub drives: Vec<Drive>,
    /// Physics beyond all that.
    pub(crate) effects: Effects,
    /// Forces of one's own; see [`Model::with_forces`].
    pub(crate) forces: Vec<Arc<dyn Force>>,
    /// Global bodies and the frames in them, of the two sides of each mechanism.
    pub(crate) mechanism_sides: Vec<[(usize, Frame); 2]>,
    /// Pairs whose guide presses them together with a weight; nothing is detected for them.
    pub(crate) dead_weights: Vec<DeadWeight>,
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

    /// Whether a gear that yields or has play stands between the motor of a coordinate and its joint.
    pub fn has_gear(&self, coordinate: usize) -> bool {
        self.coordinates[coordinate].series.is_some()
    }
}
