//! Initial states: what a replay starts from, and the coordinates in which it is estimated.
//!
//! A start holds poses, twists, joints, the memory of effects, and the bristles of points that touch. Its tangent has, in this order and as far as each
//! is free: turn of each base (rotation vector, W axes), place of its origin, spin, speed; joint coordinates; joint rates; memory of effects.

use crate::plant::Built;
use sim::{Base, World};
use spatial::{Pose, Twist, Vec3, exp_rotation};
use std::sync::Arc;

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
}

impl Freedom {
    /// Perturbation for a first difference quotient: rad, m, rad/s, m/s, or the slot's own unit.
    pub fn first_step(&self) -> f64 {
        match self {
            Self::Turn(..) | Self::Place(..) | Self::Joint(_) => 1e-6,
            Self::Spin(..) | Self::Speed(..) | Self::Rate(_) => 1e-6,
            Self::Memory(_) => 1e-5,
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
    pub fn world(&self, built: &Built) -> World {
        let mut state = built.start.clone();
        state.time = self.time;
        state.bases.clone_from(&self.bases);
        state.q.clone_from(&self.q);
        state.v.clone_from(&self.v);
        let mut world = World::new(Arc::clone(&built.model), state);
        world.set_base_twists(&self.twists);
        world
    }

    /// Sets the memory of effects: its rest under the world's present commands, and the deviation from it.
    pub fn set_memory(&self, world: &mut World) {
        world.settle_effects();
        if self.memory.iter().any(|m| *m != 0.0) {
            world.state_mut().effects.iter_mut().zip(&self.memory).for_each(|(e, m)| *e += m);
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
        }
    }
}

fn count_memory(built: &Built) -> usize {
    built.start.effects.len()
}

/// The coordinates of a start that are free in a model.
pub fn freedoms(built: &Built) -> Vec<Freedom> {
    let model = &built.model;
    let mut all = Vec::new();
    for (b, vehicle) in model.vehicles.iter().enumerate().filter(|(_, v)| v.base != Base::Fixed) {
        let mask = vehicle.base.mask();
        let kinds: [(fn(usize, usize) -> Freedom, usize); 4] =
            [(Freedom::Turn, 0), (Freedom::Place, 3), (Freedom::Spin, 0), (Freedom::Speed, 3)];
        for (kind, first) in kinds {
            all.extend((0..3).filter(|axis| mask[first + axis]).map(|axis| kind(b, axis)));
        }
    }
    let scalar = || model.coordinates.iter().enumerate().filter(|(_, c)| c.is_scalar);
    all.extend(scalar().map(|(_, c)| Freedom::Joint(c.q_index)));
    all.extend(scalar().map(|(i, _)| Freedom::Rate(i)));
    all.extend((0..count_memory(built)).map(Freedom::Memory));
    all
}
