//! Parts inside bodies: scratch of their effects, and what they carry of a vehicle's momentum.

use crate::model::Model;
use crate::parts::{BodyEffect, BodyMotion, BodyPlace, EffectKind};
use crate::state::State;
use multibody::Kinematics;
use spatial::{Vec3, Wrench};

/// Scratch of the body effects.
#[derive(Clone, Debug, Default)]
pub(crate) struct Parts {
    /// Whether any effect has a part with momentum of its own.
    pub has_parts: bool,
    /// Per body, about its vehicle's anchor: from the parts inside.
    pub internal: Vec<Wrench>,
    /// Per vehicle, about its anchor: weight of the parts.
    pub weight: Vec<Wrench>,
    /// Power of that weight, W.
    pub power: f64,
    /// What every effect does to its body from outside, and what its part's damper takes, W.
    pub actions: Vec<Action>,
    /// Of [`State::effects`]; only the parts' own entries are used.
    pub rates: Vec<f64>,
    /// The memory at the start of a midpoint step.
    pub start: Vec<f64>,
}

/// What one effect does to its body, about the anchor of the body's vehicle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Action {
    pub effect: usize,
    pub body: usize,
    pub external: Wrench,
    pub loss: f64,
}

impl Parts {
    /// What an effect does to its body from outside, about the anchor of the body's vehicle.
    pub fn load_of(&self, effect: usize) -> Wrench {
        self.actions.iter().find(|a| a.effect == effect).map_or(Wrench::default(), |a| a.external)
    }

    pub fn new(model: &Model) -> Self {
        let n = model.effects.n_memory();
        Self {
            has_parts: of_bodies(model).any(|(_, e)| e.law.has_part()),
            internal: vec![Wrench::default(); model.owners.len()],
            weight: vec![Wrench::default(); model.vehicles.len()],
            power: 0.0,
            actions: Vec::with_capacity(model.effects.list.len()),
            rates: vec![0.0; n],
            start: vec![0.0; n],
        }
    }
}

/// The body effects of a model with their indices.
pub(crate) fn of_bodies(model: &Model) -> impl Iterator<Item = (usize, &BodyEffect)> {
    model.effects.list.iter().enumerate().filter_map(|(index, effect)| match &effect.kind {
        EffectKind::Body(body) => Some((index, body)),
        _ => None,
    })
}

/// The effect's link at the positions and velocities that `kin` holds.
pub(crate) fn calc_motion(model: &Model, kin: &Kinematics, place: &BodyPlace, time: f64) -> BodyMotion {
    let tree = &model.vehicles[place.vehicle].tree;
    BodyMotion { frame_wl: kin.link_frame(tree, place.link), twist: kin.link_twist(tree, place.link), time }
}

/// Momentum of the parts inside a vehicle's bodies, about its anchor, W axes.
pub(crate) fn calc_carried(model: &Model, state: &State, vehicle: usize, kin: &Kinematics) -> Wrench {
    let tree = &model.vehicles[vehicle].tree;
    let mut sum = Wrench::default();
    for (index, effect) in of_bodies(model).filter(|(_, e)| e.place.vehicle == vehicle) {
        let frame_wl = kin.link_frame(tree, effect.place.link);
        let own = effect.law.calc_momentum(&frame_wl, &state.effects[model.effects.memory(index)]);
        sum += own.about(&(kin.anchor - frame_wl.pos));
    }
    sum
}

/// Masses (kg) and places in W of the parts that have weight.
pub(crate) fn particles<'a>(model: &'a Model, state: &'a State) -> impl Iterator<Item = (f64, Vec3)> + 'a {
    of_bodies(model).filter_map(|(index, effect)| {
        let particle = effect.law.particle(&state.effects[model.effects.memory(index)]);
        particle.map(|(mass, place, _)| (mass, place))
    })
}

/// Linear momentum of the parts inside a vehicle's bodies, N·s; a function of the memory alone.
pub(crate) fn calc_carried_linear(model: &Model, state: &State, vehicle: usize) -> Vec3 {
    let own = |(index, effect): (usize, &BodyEffect)| {
        let particle = effect.law.particle(&state.effects[model.effects.memory(index)]);
        particle.map_or(Vec3::zeros(), |(m, _, v)| m * v)
    };
    of_bodies(model).filter(|(_, e)| e.place.vehicle == vehicle).map(own).sum()
}
