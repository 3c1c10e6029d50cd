//! Initial states: what a replay starts from, and the coordinates in which it is estimated.
//!
//! A start holds poses, twists, joints, the memory of effects, and the bristles of points that touch. Its tangent has, in this order and as far as each
//! is free: turn of each base (rotation vector, W axes), place of its origin, spin, speed; joint coordinates; joint rates; memory of effects.

use crate::plant::Built;
use friction::Friction;
use sim::World;
use spatial::{Pose, Twist, Vec3, exp_rotation};
use std::cell::RefCell;
use std::sync::Arc;

/// Slip below which a bristle counts as on its way, m/s.
const CRAWL: f64 = 1e-4;

/// Where a replay starts.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// Time, s.
    pub time: f64,
    /// Base poses.
    pub bases: Vec<Pose>,
    /// Base twists about the base's origin, W axes.
    pub twists: Vec<Twist>,
    /// Joint coordinates.
    pub q: Vec<f64>,
    /// Joint rates.
    pub v: Vec<f64>,
    /// Deviation of the effects' memory from its rest, by slot.
    pub memory: Vec<f64>,
    /// Deflections of the bristles that touch at the start, W axes, m; empty where all begin unloaded.
    pub bristles: Vec<Vec3>,
}

/// One free coordinate of a start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Freedom {
    /// Rotation of a base about an axis of W.
    Turn(usize, usize),
    /// Place of a base's origin along an axis of W.
    Place(usize, usize),
    /// Angular velocity of a base.
    Spin(usize, usize),
    /// Velocity of a base's origin.
    Speed(usize, usize),
    /// Joint coordinate.
    Joint(usize),
    /// Joint rate.
    Rate(usize),
    /// Memory slot of an effect.
    Memory(usize),
    /// Deflection of a bristle along an axis of W.
    Bristle(usize, usize),
}

impl Freedom {
    /// Perturbation for a first difference quotient: rad, m, rad/s, m/s, or the slot's own unit.
    pub fn first_step(&self) -> f64 {
        match self {
            Self::Turn(..) | Self::Place(..) | Self::Joint(_) => 1e-6,
            Self::Spin(..) | Self::Speed(..) | Self::Rate(_) => 1e-6,
            Self::Memory(_) => 1e-5,
            Self::Bristle(..) => 1e-8,
        }
    }
}

impl Start {
    /// The start of the scenario itself.
    pub fn nominal(built: &Built) -> Self {
        let (model, state) = (&built.model, &built.start);
        let world = World::new(Arc::clone(model), state.clone());
        let twists = (0..model.vehicles.len()).map(|v| world.kinematics(v).vel[0]).collect();
        Self {
            time: 0.0,
            bases: state.bases.clone(),
            twists,
            q: state.q.clone(),
            v: state.v.clone(),
            memory: vec![0.0; count_memory(built)],
            bristles: Vec::new(),
        }
    }

    /// The same for a model with other memory: slots that it does not know begin at rest.
    pub fn fitted_to(&self, built: &Built) -> Self {
        let mut start = self.clone();
        start.memory.resize(count_memory(built), 0.0);
        let nominal = (&built.start.q, &built.start.v);
        let (known_q, known_v) = (start.q.len().min(nominal.0.len()), start.v.len().min(nominal.1.len()));
        start.q.truncate(known_q);
        start.v.truncate(known_v);
        start.q.extend(&nominal.0[known_q..]);
        start.v.extend(&nominal.1[known_v..]);
        start
    }

    /// A world at this start.
    pub fn world(&self, built: &Built, run: usize) -> World {
        let mut state = built.start.clone();
        state.time = self.time;
        state.bases.clone_from(&self.bases);
        state.q.clone_from(&self.q);
        state.v.clone_from(&self.v);
        let mut world = World::new(Arc::clone(built.model_of(run)), state);
        world.set_base_twists(&self.twists);
        if !self.bristles.is_empty() {
            world.seed_bristles(|i, _| self.bristles.get(i).copied().unwrap_or_default());
        }
        world
    }

    /// Frees the bristles of the points that touch, each dragged along where its point slides.
    pub fn free_bristles(&mut self, built: &Built, run: usize) {
        let mut world = self.world(built, run);
        let reach = RefCell::new(Vec::new());
        world.seed_bristles(|_, touch| {
            reach.borrow_mut().push((touch.pair, touch.normal_force, touch.point_w));
            Vec3::zeros()
        });
        self.bristles =
            reach.into_inner().iter().map(|(pair, force, point)| dragged(&world, *pair, *force, point)).collect();
    }

    /// Sets the memory of effects: its rest under the world's present commands, and the deviation from it.
    pub fn set_memory(&self, world: &mut World) {
        world.settle_effects();
        if self.memory.iter().any(|m| *m != 0.0) {
            let rest = world.effect_memory();
            let moved: Vec<f64> = rest.iter().zip(&self.memory).map(|(e, m)| e + m).collect();
            world.set_effect_memory(&moved);
        }
    }

    /// Moves one coordinate.
    pub fn moved(&self, freedom: Freedom, by: f64) -> Self {
        let mut start = self.clone();
        start.shift(freedom, by);
        start
    }

    /// Moves all coordinates.
    pub fn retract(&self, freedoms: &[Freedom], by: &[f64]) -> Self {
        let mut start = self.clone();
        freedoms.iter().zip(by).for_each(|(f, d)| start.shift(*f, *d));
        start
    }

    fn shift(&mut self, freedom: Freedom, by: f64) {
        let along = |axis: usize| Vec3::ith(axis, by);
        match freedom {
            Freedom::Turn(b, axis) => self.bases[b].rotation = exp_rotation(&along(axis)) * self.bases[b].rotation,
            Freedom::Place(b, axis) => self.bases[b].translation.vector += along(axis),
            Freedom::Spin(b, axis) => self.twists[b].ang += along(axis),
            Freedom::Speed(b, axis) => self.twists[b].lin += along(axis),
            Freedom::Joint(i) => self.q[i] += by,
            Freedom::Rate(i) => self.v[i] += by,
            Freedom::Memory(i) => self.memory[i] += by,
            Freedom::Bristle(i, axis) => self.bristles[i] += along(axis),
        }
    }
}

fn count_memory(built: &Built) -> usize {
    built.start.effects.len()
}

/// Where a sliding point's bristle is: at its bound, along the slip; in the middle where it hardly moves.
fn dragged(world: &World, pair: usize, normal_force: f64, point: &Vec3) -> Vec3 {
    let model = world.model();
    let Some(Friction::Bristle(law)) = model.laws[pair].friction else { return Vec3::zeros() };
    let (a, b) = model.pair_bodies(pair);
    let velocity = |body: usize| {
        model.owners.get(body).map_or(Vec3::zeros(), |&(vehicle, local)| {
            let kin = world.kinematics(vehicle);
            kin.vel[local].at(&(point - kin.anchor))
        })
    };
    let slip = velocity(b) - velocity(a);
    slip / (slip.norm() + CRAWL) * law.calc_reach(normal_force, 0.0)
}

/// A freedom of a base by its vehicle and axis.
type Kind = fn(usize, usize) -> Freedom;

/// The coordinates of a start that are free in a model.
pub fn freedoms(built: &Built, start: &Start) -> Vec<Freedom> {
    let model = &built.model;
    let mut all = Vec::new();
    for (b, vehicle) in model.vehicles.iter().enumerate().filter(|(_, v)| !v.base.is_held()) {
        let mask = vehicle.base.mask();
        let kinds: [(Kind, usize); 4] =
            [(Freedom::Turn, 0), (Freedom::Place, 3), (Freedom::Spin, 0), (Freedom::Speed, 3)];
        for (kind, first) in kinds {
            all.extend((0..3).filter(|axis| mask[first + axis]).map(|axis| kind(b, axis)));
        }
    }
    let scalar = || model.coordinates.iter().enumerate().filter(|(_, c)| c.is_scalar);
    all.extend(scalar().map(|(_, c)| Freedom::Joint(c.q_index)));
    all.extend(scalar().map(|(i, _)| Freedom::Rate(i)));
    all.extend((0..count_memory(built)).map(Freedom::Memory));
    all.extend((0..start.bristles.len()).flat_map(|i| (0..3).map(move |axis| Freedom::Bristle(i, axis))));
    all
}
