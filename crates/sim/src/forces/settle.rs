//! The memory that a start at rest decides.

use super::{Acting, calc_bias, calc_external};
use crate::model::Model;
use crate::parts::{Base, CoordinatePoint, EffectKind, Vehicle};
use crate::state::State;
use crate::workspace::Workspace;

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
    let is_fixed = |v: &&Vehicle| v.v_range().contains(&i) && v.base == Base::Fixed;
    if model.vehicles.iter().any(|v| is_fixed(&v)) { ws.tau[i] - (force.effort - force.through) } else { force.driven }
}
