//! Body effects in the world: where their wrenches, rates and momenta enter a step.
//!
//! A vehicle's momentum (p, L) in [`State::momentum`] is that of its bodies *and* of the parts inside them. Parts and
//! bodies exchange momentum without any impulse being added anywhere: the base twist follows from what the parts leave,
//!
//!   V_B = I_lock⁻¹ (h − h_parts − Σ I_i V_i^rel),
//!
//! so that internal effects conserve the total to rounding with every integrator. What the parts exert on their bodies
//! enters the accelerations of the solve alone. Only a part's weight is an impulse from outside.
//!
//! Runge–Kutta integrates the memories with everything else. The Euler schemes kick (velocities and momenta with the
//! forces of the step's start) and then drift (places, with the velocities of its end); the midpoint scheme takes the
//! rates at the middle of the step, evaluated once more when its mean velocities are known.

use crate::model::{Model, Scheme};
use crate::parts::{BodyEffect, BodyMotion, BodyPlace};
use crate::state::State;
use crate::workspace::{Action, Workspace, calc_motion, of_bodies, world_wrench};
use multibody::Kinematics;
use spatial::{Twist, Vec3, Wrench};

/// Evaluates all body effects at the present stage: external wrenches join those of `ws.external`, the rest waits in
/// `ws.parts`.
pub(crate) fn eval(model: &Model, state: &State, ws: &mut Workspace) {
    let mut external = std::mem::take(&mut ws.external);
    eval_parts(model, state, ws, |body, wrench| external[body] += wrench);
    ws.external = external;
}

fn eval_parts(model: &Model, state: &State, ws: &mut Workspace, mut push: impl FnMut(usize, Wrench)) {
    let mut parts = std::mem::take(&mut ws.parts);
    parts.internal.fill(Wrench::default());
    parts.weight.fill(Wrench::default());
    parts.power = 0.0;
    parts.actions.clear();
    for (index, effect) in of_bodies(model) {
        let BodyPlace { vehicle, link, .. } = effect.place;
        let kin = &ws.kin[vehicle];
        let motion = calc_motion(model, kin, &effect.place, state.time);
        let at = model.effects.memory(index);
        let memory = &state.effects[at.clone()];
        let particle = effect.law.particle(memory);
        let field = particle.map_or(Vec3::zeros(), |(_, x, _)| model.calc_field(state.time, &x));
        let action = effect.law.eval(&effect.place, &motion, memory, &field, &mut parts.rates[at]);
        let to_anchor = kin.anchor - motion.frame_wl.pos;
        let body = model.vehicles[vehicle].body0 + model.vehicles[vehicle].tree.links[link].body;
        let external = action.external.about(&to_anchor);
        push(body, external);
        parts.actions.push(Action { effect: index, body, external, loss: action.loss });
        parts.internal[body] += action.internal.about(&to_anchor);
        parts.weight[vehicle] += action.on_part.about(&to_anchor);
        parts.power += particle.map_or(0.0, |(_, _, v)| action.on_part.force.dot(&v));
    }
    ws.parts = parts;
}

/// What the parts weigh joins the momentum, and its work the account.
pub(crate) fn add_impulses(model: &Model, state: &mut State, ws: &Workspace, h: f64) {
    if !ws.parts.has_parts {
        return;
    }
    for (i, (vehicle, weight)) in model.vehicles.iter().zip(&ws.parts.weight).enumerate() {
        let impulse = world_wrench(vehicle, &ws.kin[i].anchor, &(*weight * h));
        state.momentum[i] += impulse;
        state.account.impulse += impulse;
    }
    state.account.environment_work += h * ws.parts.power;
}

/// Works of the loads from outside, with the twists that displace the bodies; what the parts' dampers take.
pub(crate) fn add_works(model: &Model, state: &mut State, ws: &Workspace, twist_of: impl Fn(usize) -> Twist, h: f64) {
    for action in &ws.parts.actions {
        let work = h * (twist_of(action.body).dot(&action.external) - action.loss);
        state.works[model.work_of_effect(action.effect)] += work;
        state.account.effect_loss += h * action.loss;
    }
}

/// The memory half a step on, with the rates of its start: where the midpoint scheme evaluates.
pub(crate) fn drift_to_midpoint(model: &Model, state: &mut State, ws: &mut Workspace, half: f64) {
    if !ws.parts.has_parts {
        return;
    }
    eval_parts(model, state, ws, |_, _| {});
    ws.parts.start.copy_from_slice(&state.effects);
    for (index, _) in of_bodies(model) {
        for k in model.effects.memory(index) {
            state.effects[k] += half * ws.parts.rates[k];
        }
    }
}

/// The memory at the end of a one-solve step, once the gains are known and before anything has moved.
pub(crate) fn advance(model: &Model, state: &mut State, ws: &mut Workspace, scheme: Scheme) {
    if !ws.parts.has_parts {
        return;
    }
    let h = ws.step;
    for (index, effect) in of_bodies(model) {
        let at = model.effects.memory(index);
        let (memory, rates) = (&mut state.effects[at.clone()], &mut ws.parts.rates[at.clone()]);
        if scheme == Scheme::ImplicitMidpoint {
            memory.iter_mut().zip(&ws.parts.start[at]).zip(rates).for_each(|((m, s), r)| *m = s + h * *r);
            continue;
        }
        let kin = &ws.kin[effect.place.vehicle];
        let mut motion = calc_motion(model, kin, &effect.place, state.time);
        let vehicle = &model.vehicles[effect.place.vehicle];
        let gain = ws.dvel[vehicle.body0 + vehicle.tree.links[effect.place.link].body];
        motion.twist += gain.about(&(motion.frame_wl.pos - kin.anchor));
        kick_and_drift(effect, &motion, memory, rates, h);
    }
}

/// Velocities and momenta with the rates of the step's start, then places with what they have become.
fn kick_and_drift(effect: &BodyEffect, end: &BodyMotion, memory: &mut [f64], rates: &mut [f64], h: f64) {
    let first = effect.law.first_kick();
    for k in first..memory.len() {
        memory[k] += h * rates[k];
    }
    effect.law.eval(&effect.place, end, memory, &Vec3::zeros(), rates);
    for k in 0..first {
        memory[k] += h * rates[k];
    }
}

/// Puts every part to rest with its body, at the positions and velocities that `ws` holds.
pub(crate) fn rest(model: &Model, state: &mut State, ws: &Workspace) {
    for (index, effect) in of_bodies(model) {
        let motion = calc_motion(model, &ws.kin[effect.place.vehicle], &effect.place, state.time);
        let memory = &mut state.effects[model.effects.memory(index)];
        effect.law.calc_memory(&motion, &REST[..memory.len()], memory);
    }
}

/// Relative coordinates of a part at rest.
const REST: [f64; 6] = [0.0; 6];

/// Energy of the parts, J: of their motion, and in their springs.
pub(crate) fn calc_energy(model: &Model, state: &State, effect: (usize, &BodyEffect), kin: &Kinematics) -> f64 {
    let (index, BodyEffect { place, law }) = effect;
    let frame = kin.link_frame(&model.vehicles[place.vehicle].tree, place.link);
    law.calc_energy(&frame, &state.effects[model.effects.memory(index)])
}
