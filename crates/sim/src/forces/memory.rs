//! The memory of the effects as one would say it: relative to rest.
//!
//! [`State::effects`] holds what is integrated. What one sets at a start, or estimates from a recording, are the
//! coordinates of [`crate::memory_layout`]: deflections and rates of a part as its body sees them; for all other effects the
//! memory itself. Zeros are rest in both. Setting them leaves every body's twist as it is, so that pose, twist and these
//! coordinates together are free variables of a start.

use super::inner::rest;
use crate::model::Model;
use crate::state::State;
use crate::workspace::{Workspace, calc_carried, calc_motion, of_bodies, world_wrench};

/// The memory in the coordinates of [`crate::memory_layout`].
pub(crate) fn calc_relative(model: &Model, state: &State, ws: &Workspace) -> Vec<f64> {
    let mut relative = state.effects.clone();
    for (index, effect) in of_bodies(model) {
        let motion = calc_motion(model, &ws.kin[effect.place.vehicle], &effect.place, state.time);
        let at = model.effects.memory(index);
        effect.law.calc_relative(&motion, &state.effects[at.clone()], &mut relative[at]);
    }
    relative
}

/// Sets the memory from the coordinates of [`crate::memory_layout`] (missing ones: zero), at the twists that `ws` holds.
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
