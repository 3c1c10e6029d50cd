//! What acts on bodies from outside, and what motion takes beyond it.

use super::{Acting, calc_thrust, effects, own};
use crate::model::Model;
use crate::parts::ActuatorKind;
use crate::state::State;
use crate::workspace::{Thrust, Workspace};
use multibody::Accelerations;
use spatial::Wrench;

/// Forces from outside on every body, about its vehicle's anchor.
pub(crate) fn calc_external(model: &Model, state: &State, ws: &mut Workspace) {
    for (body, &(vehicle, local)) in model.owners.iter().enumerate() {
        let kin = &ws.kin[vehicle];
        ws.weights[body] = model.environment.calc_wrench(state.time, &kin.anchor, &kin.inertia[local]);
        ws.external[body] = ws.weights[body];
    }
    ws.thrusts.clear();
    let acting = Acting { model, state, step: ws.step, since: ws.since };
    for (index, actuator) in model.actuators.iter().enumerate() {
        if let ActuatorKind::Thruster { body, position, direction, .. } = actuator.kind {
            let (vehicle, local) = model.owners[body];
            let kin = &ws.kin[vehicle];
            let r = kin.pos[local] + kin.rot[local] * position;
            let force = kin.rot[local] * (calc_thrust(index, &acting) * direction);
            let wrench = Wrench::from_force_at(force, &r);
            ws.external[body] += wrench;
            ws.thrusts.push(Thrust { actuator: index, body, wrench });
        }
    }
    effects::add_wrenches(model, state, ws);
    own::add_wrenches(model, state, ws);
    add_to_bases(model, ws);
}

/// What motion takes beyond the external forces, at zero acceleration: with the start's velocities, or with those half
/// a gain later (midpoint).
pub(crate) fn calc_bias(model: &Model, state: &State, ws: &mut Workspace, half_gain: bool) {
    for (i, vehicle) in model.vehicles.iter().enumerate() {
        let range = vehicle.v_range();
        for k in range.clone() {
            ws.v_mid[k] = state.v[k] + if half_gain { 0.5 * ws.v_gain[k] } else { 0.0 };
        }
        let motion = Accelerations { base: ws.base_acceleration[i], v: &ws.v_mid[range], v_dot: &[] };
        let bodies = vehicle.body0..vehicle.body0 + vehicle.tree.bodies.len();
        ws.dynamics[i].calc_body_wrenches(&vehicle.tree, &ws.kin[i], &motion, &ws.external[bodies.clone()]);
        ws.bias[bodies].copy_from_slice(&ws.dynamics[i].wrench);
    }
    if ws.parts.has_parts {
        ws.bias.iter_mut().zip(&ws.parts.internal).for_each(|(bias, internal)| *bias -= *internal);
    }
}

/// Adds what acts on bases to the forces from outside.
fn add_to_bases(model: &Model, ws: &mut Workspace) {
    let Some(push) = &ws.push else { return };
    for ((vehicle, kin), push) in model.vehicles.iter().zip(&ws.kin).zip(&push.bases) {
        // The anchor of a vehicle is the origin of its base link.
        let rot = &kin.rot[0];
        ws.external[vehicle.body0] += Wrench::new(rot * push.moment, rot * push.force);
    }
}
