//! The memory of the effects as one would say it: relative to rest.
//!
//! [`State::effects`] holds what is integrated. What one sets at a start, or estimates from a recording, are the
//! coordinates of [`memory_layout`]: deflections and rates of a part as its body sees them; for all other effects the
//! memory itself. Zeros are rest in both. Setting them leaves every body's twist as it is, so that pose, twist and these
//! coordinates together are free variables of a start.

use super::body::{calc_carried, calc_motion, of_bodies, rest};
use super::joint::REACH;
use crate::effect::EffectKind;
use crate::model::Model;
use crate::state::State;
use crate::workspace::{Workspace, world_wrench};

/// One coordinate of the effects' memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MemorySlot {
    /// Index of the effect in the model.
    pub effect: usize,
    /// What it is, within its effect.
    pub name: &'static str,
    /// Its place in [`State::effects`] and in [`crate::World::effect_memory`].
    pub offset: usize,
    /// A usual size, for differences and priors; SI.
    pub scale: f64,
    /// The largest that it comes to by itself, SI: dry friction slides at its reach. None where nothing holds it.
    pub largest: Option<f64>,
}

/// All coordinates of the effects' memory, in order.
pub fn memory_layout(model: &Model) -> Vec<MemorySlot> {
    let of = |(effect, kind): (usize, &EffectKind)| {
        let (start, scales) = (model.effects.memory(effect).start, scales(kind));
        let largest = match kind {
            EffectKind::Joint(effect) => effect.largest_deflection(),
            _ => None,
        };
        let slot = move |(k, name): (usize, &&'static str)| {
            let scale = scales.get(k).copied().unwrap_or(1.0);
            MemorySlot { effect, name, offset: start + k, scale, largest }
        };
        kind.memory_names().iter().enumerate().map(slot)
    };
    model.effects.list.iter().map(|e| &e.kind).enumerate().flat_map(of).collect()
}

/// Usual sizes of an effect's coordinates.
fn scales(kind: &EffectKind) -> &'static [f64] {
    match kind {
        EffectKind::Joint(_) => &[REACH],
        // Milliradians of a loaded gear, and what they make in a tenth of a second.
        EffectKind::Series(_) => &[1e-3, 1e-2],
        EffectKind::Body(effect) => effect.law.memory_scales(),
        _ => &[],
    }
}

/// The memory in the coordinates of [`memory_layout`].
pub(crate) fn calc_relative(model: &Model, state: &State, ws: &Workspace) -> Vec<f64> {
    let mut relative = state.effects.clone();
    for (index, effect) in of_bodies(model) {
        let motion = calc_motion(model, &ws.kin[effect.place.vehicle], &effect.place, state.time);
        let at = model.effects.memory(index);
        effect.law.calc_relative(&motion, &state.effects[at.clone()], &mut relative[at]);
    }
    relative
}

/// Sets the memory from the coordinates of [`memory_layout`] (missing ones: zero), at the twists that `ws` holds.
pub(crate) fn set_relative(model: &Model, state: &mut State, ws: &Workspace, relative: &[f64]) {
    let mut all = relative.to_vec();
    all.resize(state.effects.len(), 0.0);
    for (index, effect) in of_bodies(model) {
        let motion = calc_motion(model, &ws.kin[effect.place.vehicle], &effect.place, state.time);
        let at = model.effects.memory(index);
        let own = all[at.clone()].to_vec();
        effect.law.calc_memory(&motion, &own, &mut all[at]);
    }
    add_carried(model, state, ws, -1.0);
    state.effects = all;
    add_carried(model, state, ws, 1.0);
}

/// Puts every part to rest with its body, at the twists that `ws` holds; the momentum was that of the bodies alone.
pub(crate) fn rest_parts(model: &Model, state: &mut State, ws: &Workspace) {
    rest(model, state, ws);
    add_carried(model, state, ws, 1.0);
}

/// Adds `k` times what the parts carry to the vehicles' momentum.
fn add_carried(model: &Model, state: &mut State, ws: &Workspace, k: f64) {
    for (i, vehicle) in model.vehicles.iter().enumerate() {
        let carried = calc_carried(model, state, i, &ws.kin[i]) * k;
        state.momentum[i] += world_wrench(vehicle, &ws.kin[i].anchor, &carried);
    }
}

/// Whether the memory of every part is still zeros, as of a state that was never started.
pub(crate) fn is_blank(model: &Model, state: &State) -> bool {
    of_bodies(model).all(|(index, _)| state.effects[model.effects.memory(index)].iter().all(|x| *x == 0.0))
}
