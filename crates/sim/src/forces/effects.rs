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
//! first command) is set by [`settle`](super::settle()), once, when the first step begins: as if all had stood so for long.
//! A world without effects pays one comparison per hook.

use super::{Acting, inner};
use crate::model::{Model, Scheme};
use crate::parts::{CoordinatePoint, Effect, EffectKind, reversal_step};
use crate::state::State;
use crate::workspace::Workspace;
use multibody::Kinematics;
use spatial::{Twist, Vec3, Wrench};

/// Adds what effects do to the bodies, about their vehicles' anchors, W axes.
pub(crate) fn add_wrenches(model: &Model, state: &State, ws: &mut Workspace) {
    let tilt = model.effects.tilt;
    if tilt != Vec3::zeros() {
        for (body, &(vehicle, local)) in model.owners.iter().enumerate() {
            let inertia = &ws.kin[vehicle].inertia[local];
            ws.external[body] += Wrench::new(inertia.mc.cross(&tilt), inertia.mass * tilt);
        }
    }
    inner::eval(model, state, ws);
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
    inner::add_works(model, state, ws, twist_of, h);
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
    inner::advance(model, state, ws, scheme);
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
    reversal_step(h)
}

/// Energy that effects hold, J: in springs, in the rotors behind them, and in parts inside bodies.
pub(crate) fn calc_energy(model: &Model, state: &State, kin: &[Kinematics]) -> f64 {
    let of = |(index, effect): (usize, &Effect)| match &effect.kind {
        EffectKind::Joint(joint) => joint.calc_energy(state.q[model.coordinates[joint.coordinate].q_index]),
        EffectKind::Series(series) => {
            series.calc_energy(&state.effects[model.effects.memory(index)], state.v[series.coordinate])
        }
        EffectKind::Line(_) | EffectKind::Tilt(_) => 0.0,
        EffectKind::Body(effect) => inner::calc_energy(model, state, (index, effect), &kin[effect.place.vehicle]),
    };
    model.effects.list.iter().enumerate().map(of).sum()
}
