//! Initial states: what a replay starts from, and the coordinates in which it is estimated.
//!
//! A start holds poses, twists, joints, the memory of effects, and the bristles of points that touch. Its tangent has, in this order and as far as each
//! is free: turn of each base (rotation vector, W axes), place of its origin, spin, speed; joint coordinates; joint rates; memory of effects.
//! A turned base keeps its spin in its own axes: what a gyro reads does not hang on an attitude that nothing reads.

use crate::held::Held;
use crate::plant::Built;
use friction::Friction;
use sim::World;
use spatial::{Pose, Twist, Vec3, exp_rotation};
use std::cell::RefCell;
use std::sync::Arc;

/// Deflection by which a bristle's pull is tried, m.
const PULL: f64 = 1e-6;
/// How much stronger than a model thinks a pair may be.
const STRONGER: f64 = 1.5;
/// A step too short to move anything, s.
const INSTANT: f64 = 1e-7;

/// Where a replay starts.
#[derive(Clone, Debug, Default, PartialEq)]
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
    /// How long each base has been still, s: what sticks grows stronger with that.
    pub still: Vec<f64>,
    /// What contacts, mechanisms and dry joints remember, where a replay was there before; as the scenario begins where none was.
    pub held: Option<Arc<Held>>,
}

/// One free coordinate of a start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Freedom {
    /// Rotation of a base, and of its spin with it, about an axis of W.
    Turn(usize, usize),
    /// Place of a base's origin along an axis of W.
    Place(usize, usize),
    /// Angular velocity of a base about one of its own axes.
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
    /// Whether it is a rate of motion.
    pub fn is_rate(&self) -> bool {
        matches!(self, Self::Spin(..) | Self::Speed(..) | Self::Rate(_))
    }

    /// Perturbation for a first difference quotient: rad, m, rad/s, m/s, or the slot's own unit.
    pub fn first_step(&self) -> f64 {
        match self {
            Self::Turn(..) | Self::Place(..) | Self::Joint(_) => 1e-6,
            Self::Spin(..) | Self::Speed(..) | Self::Rate(_) => 1e-6,
            Self::Memory(_) => 1e-5,
            Self::Bristle(..) => 1e-8,
        }
    }

    /// The largest that it comes to by itself; none where nothing holds it.
    pub fn largest(&self, built: &Built) -> Option<f64> {
        let Self::Memory(slot) = *self else { return None };
        sim::memory_layout(&built.model).iter().find(|s| s.offset == slot).and_then(|s| s.largest)
    }

    /// How far a step of an estimate may trust its linear model, its own unit; `None`: as far as it leads.
    pub fn reach(&self) -> Option<f64> {
        matches!(self, Self::Bristle(..)).then_some(1e-4)
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
            still: vec![0.0; state.bases.len()],
            held: None,
        }
    }

    /// The start that continues from where a replay is.
    pub fn of(built: &Built, run: usize, world: &World) -> Self {
        let state = world.state();
        let mut start = Self {
            time: state.time,
            bases: state.bases.clone(),
            twists: (0..state.bases.len()).map(|v| world.kinematics(v).vel[0]).collect(),
            q: state.q.clone(),
            v: state.v.clone(),
            memory: vec![0.0; count_memory(built)],
            bristles: Vec::new(),
            still: vec![0.0; state.bases.len()],
            held: None,
        };
        let held = Held::of(built, state);
        if start.memory.is_empty() && state.bristles.is_empty() {
            return Self { held, ..start };
        }
        let mut fresh = start.world(built, run);
        fresh.commands_mut().copy_from_slice(&state.commands);
        fresh.settle_effects();
        start.memory = world.effect_memory().iter().zip(fresh.effect_memory()).map(|(now, rest)| now - rest).collect();
        let found = RefCell::new(Vec::new());
        fresh.seed_bristles(|_, touch| {
            let own = state.bristles.iter().find(|m| (m.pair as usize, m.feature) == (touch.pair, touch.feature));
            let s = own.map_or(Vec3::zeros(), |m| m.s_w);
            found.borrow_mut().push(s);
            (s, 0.0)
        });
        for memory in &state.bristles {
            let model = &built.model;
            if let Some(Friction::Bristle(law)) = model.laws[memory.pair as usize].friction {
                let stuck = law.levels().calc_time_at_rest(memory.rest);
                vehicles_of(built, memory.pair as usize).for_each(|v| start.still[v] = stuck);
            }
        }
        start.bristles = found.into_inner();
        start.held = held;
        start
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

    /// Takes over from another start what a model has beside another one: memory, and joints of parts inside.
    pub fn remember(&mut self, before: &Self, known: &Built) {
        let take = |own: &mut [f64], before: &[f64], known: usize| {
            own.iter_mut().zip(before).skip(known).for_each(|(own, before)| *own = *before);
        };
        take(&mut self.memory, &before.memory, count_memory(known));
        take(&mut self.q, &before.q, known.start.q.len());
        take(&mut self.v, &before.v, known.start.v.len());
        self.held.clone_from(&before.held);
    }

    /// A world at this start.
    pub fn world(&self, built: &Built, run: usize) -> World {
        let mut state = built.start.clone();
        state.time = self.time;
        state.bases.clone_from(&self.bases);
        state.q.clone_from(&self.q);
        state.v.clone_from(&self.v);
        if let Some(held) = &self.held {
            held.set(&mut state);
        }
        let mut world = World::new(Arc::clone(built.model_of(run)), state).without_books();
        world.set_base_twists(&self.twists);
        if !self.bristles.is_empty() {
            let s = |i: usize| self.bristles.get(i).copied().unwrap_or_default();
            world.seed_bristles(|i, touch| (s(i), self.calc_stuck(built, touch.pair)));
        }
        world
    }

    /// Frees the bristles of the points that touch: of each pair the common deflection whose force gives the bodies the accelerations
    /// that were measured (base by base, m/s² and rad/s², W axes; `None` where nothing measures it), as far as the pair can hold it.
    pub fn free_bristles(&mut self, built: &Built, run: usize, measured: &[Option<Twist>]) {
        self.bristles.clear();
        let reach = RefCell::new(Vec::new());
        self.world(built, run).seed_bristles(|_, touch| {
            let model = &built.model;
            let reaches = match model.laws[touch.pair].friction {
                Some(Friction::Bristle(law)) => law.calc_reach(touch.normal_force, 0.0),
                _ => 0.0,
            };
            reach.borrow_mut().push((touch.pair, reaches, touch.normal_w));
            (Vec3::zeros(), 0.0)
        });
        let points = reach.into_inner();
        let mut pairs: Vec<usize> = points.iter().map(|p| p.0).collect();
        pairs.dedup();
        self.bristles = vec![Vec3::zeros(); points.len()];
        for pair in pairs {
            let of_pair: Vec<usize> = (0..points.len()).filter(|i| points[*i].0 == pair).collect();
            let Some((_, largest, normal)) = of_pair.first().map(|i| points[*i]) else { continue };
            let s = self.balanced(built, run, (&of_pair, &normal), measured);
            // A pair may hold more than this model thinks; what it does not hold is cut when it is used.
            let largest = STRONGER * largest;
            let s = if s.norm() > largest { s * (largest / s.norm()) } else { s };
            of_pair.iter().for_each(|i| self.bristles[*i] = s);
        }
    }

    /// How long a pair has stuck as far as it is known, s: since the later of its bodies moved.
    fn calc_stuck(&self, built: &Built, pair: usize) -> f64 {
        let still = vehicles_of(built, pair).map(|v| self.still[v]).fold(f64::INFINITY, f64::min);
        if still.is_finite() { still } else { 0.0 }
    }

    /// Common deflection of some points that comes nearest to the measured accelerations.
    fn balanced(
        &self,
        built: &Built,
        run: usize,
        (points, normal): (&[usize], &Vec3),
        measured: &[Option<Twist>],
    ) -> Vec3 {
        let accelerations = |s: Vec3| {
            let mut start = self.clone();
            points.iter().for_each(|i| start.bristles[*i] = s);
            start.accelerations(built, run)
        };
        let bare = accelerations(Vec3::zeros());
        let along = normal.cross(&if normal.x.abs() < 0.7 { Vec3::x() } else { Vec3::y() }).normalize();
        let axes = [along, normal.cross(&along)];
        let pulled = axes.map(|axis| accelerations(axis * PULL));
        let (mut a, mut b) = (nalgebra::Matrix2::<f64>::zeros(), nalgebra::Vector2::<f64>::zeros());
        for (v, seen) in measured.iter().enumerate() {
            let Some(seen) = seen else { continue };
            let column = |k: usize| (pulled[k][v].lin - bare[v].lin) / PULL;
            let missing = seen.lin - bare[v].lin;
            for k in 0..2 {
                b[k] += column(k).dot(&missing);
                (0..2).for_each(|l| a[(k, l)] += column(k).dot(&column(l)));
            }
        }
        let x = a.try_inverse().map_or(nalgebra::Vector2::zeros(), |inverse| inverse * b);
        if x.iter().all(|x| x.is_finite()) { axes[0] * x[0] + axes[1] * x[1] } else { Vec3::zeros() }
    }

    /// Accelerations of the bases at the start, by a step too short to move anything.
    fn accelerations(&self, built: &Built, run: usize) -> Vec<Twist> {
        let mut world = self.world(built, run);
        let twists = |world: &World| (0..self.bases.len()).map(|v| world.kinematics(v).vel[0]).collect::<Vec<_>>();
        let before = twists(&world);
        let gone = world.advance_by(INSTANT).is_err();
        let change = |(a, b): (Twist, &Twist)| if gone { Twist::default() } else { (a - *b) * (1.0 / INSTANT) };
        twists(&world).into_iter().zip(&before).map(change).collect()
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

    /// The same moved along its coordinates as far as a model can be there.
    pub fn retract_within(&self, built: &Built, freedoms: &[Freedom], by: &[f64]) -> Self {
        self.retract(freedoms, by).possible(built)
    }

    /// The same with the memory of effects no larger than it comes to by itself: a linear step knows no bounds.
    fn possible(mut self, built: &Built) -> Self {
        for slot in sim::memory_layout(&built.model) {
            if let (Some(own), Some(largest)) = (self.memory.get_mut(slot.offset), slot.largest) {
                *own = own.clamp(-largest, largest);
            }
        }
        self
    }

    /// What has to be added to another start, coordinate by coordinate, to come to this one.
    pub fn difference(&self, other: &Self, freedoms: &[Freedom]) -> Vec<f64> {
        let turn = |b: usize| self.bases[b].rotation * other.bases[b].rotation.inverse();
        let of = |freedom: &Freedom| match *freedom {
            Freedom::Turn(b, axis) => spatial::log_rotation(&turn(b))[axis],
            Freedom::Place(b, axis) => self.bases[b].translation.vector[axis] - other.bases[b].translation.vector[axis],
            Freedom::Spin(b, axis) => (self.spin(b) - other.spin(b))[axis],
            Freedom::Speed(b, axis) => self.twists[b].lin[axis] - other.twists[b].lin[axis],
            Freedom::Joint(i) => self.q[i] - other.q[i],
            Freedom::Rate(i) => self.v[i] - other.v[i],
            Freedom::Memory(i) => self.memory[i] - other.memory[i],
            Freedom::Bristle(i, axis) => self.bristles[i][axis] - other.bristles[i][axis],
        };
        freedoms.iter().map(of).collect()
    }

    /// Angular velocity of a base in its own axes.
    fn spin(&self, base: usize) -> Vec3 {
        self.bases[base].rotation.inverse() * self.twists[base].ang
    }

    fn shift(&mut self, freedom: Freedom, by: f64) {
        let along = |axis: usize| Vec3::ith(axis, by);
        match freedom {
            Freedom::Turn(b, axis) => {
                let turn = exp_rotation(&along(axis));
                self.bases[b].rotation = turn * self.bases[b].rotation;
                self.twists[b].ang = turn * self.twists[b].ang;
            }
            Freedom::Place(b, axis) => self.bases[b].translation.vector += along(axis),
            Freedom::Spin(b, axis) => self.twists[b].ang += self.bases[b].rotation * along(axis),
            Freedom::Speed(b, axis) => self.twists[b].lin += along(axis),
            Freedom::Joint(i) => self.q[i] += by,
            Freedom::Rate(i) => self.v[i] += by,
            // A slot of an effect that has been taken out moves nothing.
            Freedom::Memory(i) => self.memory.get_mut(i).into_iter().for_each(|m| *m += by),
            Freedom::Bristle(i, axis) => self.bristles[i] += along(axis),
        }
    }
}

/// The vehicles whose bases may move of the two bodies of a pair.
fn vehicles_of(built: &Built, pair: usize) -> impl Iterator<Item = usize> {
    let model = &built.model;
    let (a, b) = model.pair_bodies(pair);
    let free = |body: usize| model.owners.get(body).map(|o| o.0).filter(|v| !model.vehicles[*v].base.is_held());
    [a, b].map(free).into_iter().flatten()
}

/// Slots of memory that a start has in a model.
pub(crate) fn count_memory(built: &Built) -> usize {
    built.start.effects.len()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_added_is_the_difference_whatever_the_attitude() {
        let of = |attitude: Vec3, spin: Vec3| Start {
            bases: vec![Pose::from_parts(Vec3::new(1.0, 2.0, 3.0).into(), exp_rotation(&attitude))],
            twists: vec![Twist { ang: exp_rotation(&attitude) * spin, lin: Vec3::zeros() }],
            ..Start::default()
        };
        let one = of(Vec3::new(0.3, -0.2, 0.1), Vec3::new(0.5, 0.1, -0.4));
        let other = of(Vec3::new(-2.0, 0.7, 1.1), Vec3::new(0.5, 0.3, -0.4));
        let spins: Vec<Freedom> = (0..3).map(|axis| Freedom::Spin(0, axis)).collect();
        let by = other.difference(&one, &spins);
        assert!((Vec3::from_column_slice(&by) - Vec3::new(0.0, 0.2, 0.0)).norm() < 1e-12, "its own axes: {by:?}");
        let moved = one.retract(&spins, &by);
        assert!(other.difference(&moved, &spins).iter().all(|d| d.abs() < 1e-12));
        // A turn takes the spin along.
        let turned = one.moved(Freedom::Turn(0, 2), 0.8);
        assert!(turned.difference(&one, &spins).iter().all(|d| d.abs() < 1e-12));
    }
}
