//! Effects: physics that a nominal model leaves out, each a small law with a place.
//!
//! What an effect may do to a step, and where:
//!
//! | hook | meaning | called by |
//! | --- | --- | --- |
//! | [`add_wrenches`] | forces on bodies; they join the external ones, so that momentum and energy stay audited | every evaluation of forces |
//! | [`crate::Coordinate`] | efforts on one joint coordinate, with their slope for the implicit solve | every evaluation of a coordinate |
//! | [`write_rates`] | rates of memory that Runge–Kutta integrates with everything else | every stage |
//! | [`advance`] | memory over a whole step of the one-solve schemes | after their solve |
//! | [`commit`] | memory that follows exactly from what an accepted step did, whatever the integrator | the end of a step |
//!
//! Memory stands in [`State::effects`], one stretch per effect in the model's order; it is zero where everything is at
//! rest and unloaded. What a start under load needs (a gear that carries an arm's weight, a drive that lags behind its
//! first command) is set by [`settle`], once, when the first step begins: as if all had stood so for long.
//! A world without effects pays one comparison per hook.

mod body;
mod joint;
mod line;
mod memory;
mod series;

pub use body::{Appendage, Axes, BodyAction, BodyEffect, BodyLaw, BodyMotion, BodyPlace, Load, Slosh, Sphere};
pub use joint::{DryFriction, DryLevel, JointEffect, JointLaw, REACH};
pub use line::{LineEffect, LineLaw};
pub use memory::{MemorySlot, memory_layout};
pub use series::Series;

pub(crate) use series::Shaft;

pub(crate) use body::{Parts, add_impulses, calc_carried, calc_carried_linear, drift_to_midpoint, particles};
pub(crate) use line::{Lines, accept, next_switch};
pub(crate) use memory::{calc_relative, is_blank, rest_parts, set_relative};

use crate::actuator::{Coordinate, CoordinatePoint};
use crate::error::ModelError;
use crate::model::{Base, Model};
use crate::state::State;
use crate::step::{Scheme, calc_bias, calc_external};
use crate::workspace::Workspace;
use multibody::Kinematics;
use spatial::{Twist, Vec3, Wrench};
use std::ops::Range;

/// Physics beyond the nominal model.
#[derive(Clone, Debug, PartialEq)]
pub struct Effect {
    /// For messages: its name and place.
    pub name: String,
    /// What it does.
    pub kind: EffectKind,
}

/// The families of effects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EffectKind {
    /// An effort on one joint coordinate.
    Joint(JointEffect),
    /// A gear that yields or has play, between a drive and its joint.
    Series(Series),
    /// What happens to a command on its way to the actuator's output.
    Line(LineEffect),
    /// A load on one body, or a part that moves inside it.
    Body(BodyEffect),
    /// A constant acceleration of everything, W axes, m/s²: a table out of level.
    Tilt(Vec3),
}

impl EffectKind {
    /// What its memory holds, one name each; empty for an effect without memory.
    pub fn memory_names(&self) -> &'static [&'static str] {
        match self {
            Self::Joint(effect) => effect.memory_names(),
            Self::Series(_) => &["deflection", "deflection_rate"],
            Self::Line(effect) => effect.memory_names(),
            Self::Body(effect) => effect.law.memory_names(),
            Self::Tilt(_) => &[],
        }
    }
}

/// Effects of a model, with what was worked out at its build.
#[derive(Clone, Debug, Default)]
pub(crate) struct Effects {
    pub list: Vec<Effect>,
    /// First memory of each effect, and the number of all.
    starts: Vec<usize>,
    pub lines: Lines,
    /// Sum of the tilts, W axes, m/s².
    pub tilt: Vec3,
    /// Whether an effect's memory has rates or is advanced by a step.
    has_motion: bool,
}

impl Effects {
    /// Numbers the memory, and hands efforts and gears to their coordinates.
    pub fn build(list: Vec<Effect>, model: &mut Model) -> Result<Self, ModelError> {
        let mut starts = vec![0];
        for effect in &list {
            starts.push(starts[starts.len() - 1] + effect.kind.memory_names().len());
        }
        let lines = Lines::new(model.actuators.len());
        let moves = |kind: &EffectKind| matches!(kind, EffectKind::Series(_) | EffectKind::Body(_));
        let has_motion = list.iter().any(|e| moves(&e.kind));
        let mut effects = Self { list, starts, lines, tilt: Vec3::zeros(), has_motion };
        for index in 0..effects.list.len() {
            effects.attach(index, model)?;
        }
        Ok(effects)
    }

    fn attach(&mut self, index: usize, model: &mut Model) -> Result<(), ModelError> {
        let Effect { name, kind } = &self.list[index];
        let refuse = |fault: &str| ModelError::Effect { name: name.clone(), fault: fault.to_owned() };
        match kind {
            EffectKind::Joint(effect) => {
                coordinate_of(model, effect.coordinate).ok_or_else(|| refuse(NO_COORDINATE))?.effects.push(index);
            }
            EffectKind::Series(series) => {
                let coordinate = coordinate_of(model, series.coordinate).ok_or_else(|| refuse(NO_COORDINATE))?;
                if coordinate.series.replace(index).is_some() {
                    return Err(refuse("the joint has a gear already; give it elasticity or backlash, not both"));
                }
                series.find_fault().map_or(Ok(()), |fault| Err(refuse(&fault)))?;
            }
            EffectKind::Line(line) => {
                self.lines.attach(line, self.starts[index], &model.actuators).map_err(|fault| refuse(&fault))?;
            }
            EffectKind::Body(effect) => {
                let place = body::find_place(model, &self.list, &effect.place);
                let place = place.ok_or_else(|| refuse("names no vehicle or link"))?;
                let law = effect.law;
                law.find_fault(model.step).map_or(Ok(()), |fault| Err(refuse(&fault)))?;
                self.list[index].kind = EffectKind::Body(BodyEffect { place, law });
            }
            EffectKind::Tilt(tilt) => self.tilt += tilt,
        }
        Ok(())
    }

    /// Where the memory of an effect stands in [`State::effects`].
    pub fn memory(&self, index: usize) -> Range<usize> {
        self.starts[index]..self.starts[index + 1]
    }

    /// How many numbers all effects remember.
    pub fn n_memory(&self) -> usize {
        self.starts.last().copied().unwrap_or(0)
    }
}

const NO_COORDINATE: &str = "needs a revolute or prismatic joint that follows no other";

fn coordinate_of(model: &mut Model, coordinate: usize) -> Option<&mut Coordinate> {
    model.coordinates.get_mut(coordinate).filter(|c| c.is_scalar)
}

/// What a coordinate's law reads of the world beside its own position and rate.
#[derive(Clone, Copy)]
pub(crate) struct Acting<'a> {
    pub model: &'a Model,
    pub state: &'a State,
    /// Length of the step, s.
    pub step: f64,
    /// Time since the step's start of an explicit stage, s; none where one evaluation stands for the whole step.
    pub since: Option<f64>,
}

impl<'a> Acting<'a> {
    /// Memory of an effect.
    pub fn memory(&self, index: usize) -> &'a [f64] {
        &self.state.effects[self.model.effects.memory(index)]
    }
}

/// Adds what effects do to the bodies, about their vehicles' anchors, W axes.
pub(crate) fn add_wrenches(model: &Model, state: &State, ws: &mut Workspace) {
    let tilt = model.effects.tilt;
    if tilt != Vec3::zeros() {
        for (body, &(vehicle, local)) in model.owners.iter().enumerate() {
            let inertia = &ws.kin[vehicle].inertia[local];
            ws.external[body] += Wrench::new(inertia.mc.cross(&tilt), inertia.mass * tilt);
        }
    }
    body::eval(model, state, ws);
}

/// Works of the effects on bodies, with the twists that displace these.
pub(crate) fn add_works(model: &Model, state: &mut State, ws: &Workspace, twist_of: impl Fn(usize) -> Twist, h: f64) {
    for (index, effect) in model.effects.list.iter().enumerate() {
        if let EffectKind::Tilt(tilt) = &effect.kind {
            let power = |(body, &(vehicle, local)): (usize, &(usize, usize))| {
                let inertia = &ws.kin[vehicle].inertia[local];
                twist_of(body).dot(&Wrench::new(inertia.mc.cross(tilt), inertia.mass * tilt))
            };
            let power: f64 = model.owners.iter().enumerate().map(power).sum();
            state.works[model.work_of_effect(index)] += h * power;
        }
    }
    body::add_works(model, state, ws, twist_of, h);
}

/// Whether forces on bodies must be evaluated again once the mean velocities of a step are known.
pub(crate) fn depends_on_twists(model: &Model) -> bool {
    model.effects.list.iter().any(|e| matches!(e.kind, EffectKind::Body(_)))
}

/// Rates of the memory at a stage of Runge–Kutta, whose accelerations `ws.v_gain` and `ws.dvel` hold (per second).
pub(crate) fn write_rates(model: &Model, state: &State, ws: &Workspace, rates: &mut [f64]) {
    if !model.effects.has_motion {
        return;
    }
    for (index, effect) in model.effects.list.iter().enumerate() {
        let at = model.effects.memory(index);
        match &effect.kind {
            EffectKind::Joint(_) | EffectKind::Line(_) | EffectKind::Tilt(_) => {}
            EffectKind::Body(_) => rates[at.clone()].copy_from_slice(&ws.parts.rates[at]),
            EffectKind::Series(series) => {
                let (force, v_dot) = (&ws.coordinate_forces[series.coordinate], ws.v_gain[series.coordinate]);
                series.write_rates(&state.effects[at.clone()], force, v_dot, &mut rates[at]);
            }
        }
    }
}

/// Memory over a step of a one-solve scheme, once the gains are known and before anything has moved.
pub(crate) fn advance(model: &Model, state: &mut State, ws: &mut Workspace, scheme: Scheme) {
    if !model.effects.has_motion {
        return;
    }
    body::advance(model, state, ws, scheme);
    for (index, effect) in model.effects.list.iter().enumerate() {
        if let EffectKind::Series(series) = &effect.kind {
            let i = series.coordinate;
            let acting = Acting { model, state, step: ws.step, since: None };
            let (point, v_new) = (&ws.coordinate_points[i], state.v[i] + ws.v_gain[i]);
            let next = series.advance(point, v_new, &acting, index, scheme);
            state.effects[model.effects.memory(index)].copy_from_slice(&next);
        }
    }
}

/// Memory that follows from the displacements of the accepted step; `state` is its end.
pub(crate) fn commit(model: &Model, state: &mut State, ws: &Workspace) {
    for (index, effect) in model.effects.list.iter().enumerate() {
        let at = model.effects.memory(index);
        match &effect.kind {
            EffectKind::Joint(joint) => {
                let i = joint.coordinate;
                let moved = state.q[model.coordinates[i].q_index] - ws.q_start[model.coordinates[i].q_index];
                let end = CoordinatePoint::at_end(moved, &ws.coordinate_points[i], ws.step);
                joint.commit(&end, state.v[i], &mut state.effects[at]);
            }
            EffectKind::Line(line) if !at.is_empty() => {
                let acting = Acting { model, state, step: ws.step, since: None };
                let end = line.calc_lagged(&acting, state.effects[at.start]);
                state.effects[at.start] = end;
            }
            EffectKind::Line(_) | EffectKind::Series(_) | EffectKind::Body(_) | EffectKind::Tilt(_) => {}
        }
    }
}

impl EffectKind {
    /// The fastest that what it brings with it swings or settles, rad/s or 1/s; zero where it brings nothing that moves.
    pub(crate) fn own_rate(&self) -> f64 {
        let quick = |rate: f64| if rate.is_finite() { rate } else { 0.0 };
        match self {
            Self::Series(series) => quick((series.stiffness / series.rotor).sqrt()),
            Self::Body(effect) => match effect.law {
                BodyLaw::Load(_) => 0.0,
                BodyLaw::Slosh(slosh) => slosh.rate,
                BodyLaw::Appendage(appendage) => appendage.rate,
                BodyLaw::Sphere(sphere) => quick(sphere.c / sphere.inertia),
            },
            Self::Joint(_) | Self::Line(_) | Self::Tilt(_) => 0.0,
        }
    }

    /// The fastest that it drives the rest, rad/s or 1/s: a period in time, a lag.
    pub(crate) fn driving_rate(&self) -> f64 {
        match self {
            Self::Joint(effect) => effect.driving_rate(),
            Self::Line(line) => line.driving_rate(),
            Self::Body(BodyEffect { law: BodyLaw::Load(Load::Periodic { rate, .. }), .. }) => rate.abs(),
            Self::Body(_) | Self::Series(_) | Self::Tilt(_) => 0.0,
        }
    }
}

/// Whether an effect is dry friction of a joint.
pub(crate) fn has_dry(model: &Model) -> bool {
    let is_dry = |effect: &Effect| matches!(&effect.kind, EffectKind::Joint(joint) if joint.is_dry());
    model.effects.list.iter().any(is_dry)
}

/// Whether dry friction has turned between two states.
pub(crate) fn has_turned(model: &Model, before: &State, after: &State) -> bool {
    let has = |effect: &Effect| match &effect.kind {
        EffectKind::Joint(joint) if joint.is_dry() => before.v[joint.coordinate] * after.v[joint.coordinate] <= 0.0,
        _ => false,
    };
    model.effects.list.iter().any(has)
}

/// Longest step of `h` in which dry friction may turn, s.
pub(crate) fn longest_turn(h: f64) -> f64 {
    joint::reversal_step(h)
}

/// Puts the memory that a start at rest decides to that rest: gears carry what holds their joints still, lags have passed.
pub(crate) fn settle(model: &Model, state: &mut State, ws: &mut Workspace) {
    if model.effects.has_motion {
        // The loads of all joints at zero acceleration: tau, as the solve takes them.
        calc_external(model, state, ws);
        calc_bias(model, state, ws, false);
        for (i, vehicle) in model.vehicles.iter().enumerate() {
            let bodies = vehicle.body0..vehicle.body0 + vehicle.tree.bodies.len();
            ws.dynamics[i].wrench.copy_from_slice(&ws.bias[bodies]);
            ws.dynamics[i].collect(&vehicle.tree, &ws.kin[i], &mut ws.tau[vehicle.v_range()]);
        }
    }
    for (index, effect) in model.effects.list.iter().enumerate() {
        let acting = Acting { model, state, step: model.step, since: None };
        let at = model.effects.memory(index);
        let rest = match &effect.kind {
            EffectKind::Series(series) => series.calc_rest(calc_load(series.coordinate, &acting, ws)),
            EffectKind::Line(line) if !at.is_empty() => line.calc_demand(&acting),
            EffectKind::Line(_) | EffectKind::Joint(_) | EffectKind::Body(_) | EffectKind::Tilt(_) => continue,
        };
        state.effects[at.start] = rest;
    }
}

/// Effort that holds a coordinate still: its load less its own passive efforts. Of a vehicle that moves as a whole the
/// load is not known before the motion is: there the drive's effort stands for it.
fn calc_load(i: usize, acting: &Acting<'_>, ws: &Workspace) -> f64 {
    let (model, state, coordinate) = (acting.model, acting.state, &acting.model.coordinates[i]);
    let still = CoordinatePoint::still(state.q[coordinate.q_index], state.v[i], acting.step);
    let force = coordinate.eval(&still, state.v[i], acting);
    let is_fixed = |v: &&crate::Vehicle| v.v_range().contains(&i) && v.base == Base::Fixed;
    if model.vehicles.iter().any(|v| is_fixed(&v)) { ws.tau[i] - (force.effort - force.through) } else { force.driven }
}

/// Energy that effects hold, J: in springs, in the rotors behind them, and in parts inside bodies.
pub(crate) fn calc_energy(model: &Model, state: &State, kin: &[Kinematics]) -> f64 {
    let of = |(index, effect): (usize, &Effect)| match &effect.kind {
        EffectKind::Joint(joint) => joint.calc_energy(state.q[model.coordinates[joint.coordinate].q_index]),
        EffectKind::Series(series) => {
            series.calc_energy(&state.effects[model.effects.memory(index)], state.v[series.coordinate])
        }
        EffectKind::Line(_) | EffectKind::Tilt(_) => 0.0,
        EffectKind::Body(effect) => body::calc_energy(model, state, (index, effect), &kin[effect.place.vehicle]),
    };
    model.effects.list.iter().enumerate().map(of).sum()
}
