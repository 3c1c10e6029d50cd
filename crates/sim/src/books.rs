//! The books of a step: what every element puts in, and what it takes for good.
//!
//!   work of an effort    τ Δq:  at the middle of the step's displacement, with the rate Δq/h at which it was made
//!   loss of a law        stated by the law (c ẋ², μ fₙ × what slips), never as what is left of a balance
//!
//! Δq is the displacement that the scheme made: h v' for the Euler schemes, h v̄ for the midpoint. A mass that is pushed thus
//! gains ½ m Δv² less than its works say, a spring half as much again, k Δx²/2: what an integrator damps is in no work and in
//! no loss, and [`crate::EnergyAudit`] shows it by itself. Runge–Kutta books the rates of its stages with their weights.
//!
//! What is *stored* is a function of the state ([`crate::Energy`]). Forces that act and books that are kept take different
//! ways from the laws, so that a force that is not what its law says of itself leaves a balance that no step closes.

use crate::forces::{Acting, Passage, effects, own};
use crate::model::Model;
use crate::parts::PairLaw;
use crate::state::{ContactMemory, State};
use crate::workspace::{Touch, Workspace};
use spatial::{Twist, Vec3, Wrench};

/// Twist of a body about its vehicle's anchor, with which the scheme displaces it: gains are spatial, those of the velocity field
/// at a place fixed in W, and the base moves on meanwhile; ½ h ω × v of it on the mean.
fn displacing_twist(model: &Model, ws: &Workspace, body: usize) -> Twist {
    let (vehicle, local) = model.owners[body];
    let twist = ws.kin[vehicle].vel[local] + ws.dvel[body] * ws.gain_share;
    if ws.gain_share == 0.0 {
        return twist;
    }
    let base = ws.base_start[vehicle] + ws.base_gain[vehicle] * ws.gain_share;
    Twist::new(twist.ang, twist.lin + 0.5 * ws.step * base.ang.cross(&base.lin))
}

/// Works of gravity and tides, thrusters, and effects on bodies.
pub(crate) fn add_external(model: &Model, state: &mut State, ws: &Workspace, h: f64) {
    if !ws.keeps_books {
        return;
    }
    if !model.environment.is_still() {
        let power = |(body, weight): (usize, &Wrench)| displacing_twist(model, ws, body).dot(weight);
        let power: f64 = ws.weights.iter().enumerate().map(power).sum();
        state.account.environment_work += h * power;
    }
    for thrust in &ws.thrusts {
        state.works[thrust.actuator] += h * displacing_twist(model, ws, thrust.body).dot(&thrust.wrench);
    }
    effects::add_works(model, state, ws, |body| displacing_twist(model, ws, body), h);
    own::add_works(model, state, ws, |body| displacing_twist(model, ws, body), h);
}

/// Work and loss of a touching point, whose bodies gained `gain` against each other.
pub(crate) fn add_touch(model: &Model, state: &mut State, ws: &Workspace, touch: &Touch, gain: &Vec3) {
    let h = if ws.since.is_some() { 1.0 } else { ws.step };
    let moved = h * (touch.u + ws.gain_share * (touch.carried + gain));
    let work = touch.out.force.dot(&moved);
    // At the mean of the velocities before and after: what motion gained.
    state.account.contact_to_motion += h * touch.out.force.dot(&(touch.u + 0.5 * gain));
    state.account.contact_work += work;
    state.account.contact_intake += (-work).max(0.0);
    let law = &model.laws[touch.pair as usize];
    state.account.contact_loss += calc_acting_share(touch) * calc_touch_loss(law, touch, gain, h);
}

/// Share of the law's normal force that acted: one, but for steps that end before line and law agree.
fn calc_acting_share(touch: &Touch) -> f64 {
    let (acting, law) = (touch.normal.dot(&touch.out.force), touch.normal.dot(&touch.out.law));
    if (acting - law).abs() <= DISAGREE * law.abs() { 1.0 } else { (acting / law).clamp(0.0, 1.0) }
}

/// Relative difference of a line's force and a law's that is more than the solver's tolerance.
const DISAGREE: f64 = 1e-2;

/// What a point's laws take for good in a step of `h`, J, where they were evaluated; an explicit stage, whose laws have no place in a
/// step, counts what its bristle stores as well.
fn calc_touch_loss(law: &PairLaw, touch: &Touch, gain: &Vec3, h: f64) -> f64 {
    let (n, at, is_stage) = (&touch.normal, touch.place, touch.place.elapsed == 0.0);
    let u_new = if is_stage { touch.u } else { touch.u + touch.carried + gain };
    let rate = if is_stage { touch.u } else { (1.0 - at.theta) * touch.u + at.theta * u_new };
    let gap = if is_stage { touch.gap } else { at.gap_base + at.beta * n.dot(&u_new) };
    let rate_n = n.dot(&rate);
    let mut loss = h * touch.weight * law.normal.law.calc_loss(gap, rate_n);
    if let Some(friction) = &law.friction {
        loss -= h * (touch.out.law - n * n.dot(&touch.out.law)).dot(&(rate - n * rate_n));
        if !is_stage {
            let (stiffness, s) = (touch.weight * friction.spring().0, &touch.out.s);
            // A bristle that sticks goes on to the step's end; one that slides stays as its law left it.
            let share = if touch.out.sticks { h / at.elapsed } else { 1.0 };
            loss -= stiffness * share * s.dot(&(s - touch.s));
        }
    }
    loss
}

/// Energy in the bristles that a state remembers, J.
pub(crate) fn calc_bristle_energy(model: &Model, memories: &[ContactMemory]) -> f64 {
    memories.iter().map(|m| m.weight * calc_deflection_energy(model, m.pair, &m.s_w, &m.turn_w)).sum()
}

/// In the bristles of a whole point with deflection `s` (m) and angular deflection `turn` (rad), J.
fn calc_deflection_energy(model: &Model, pair: u32, s: &Vec3, turn: &Vec3) -> f64 {
    let law = &model.laws[pair as usize];
    let along = law.friction.as_ref().map_or(0.0, |f| f.calc_stored_energy(s));
    along + law.pivot.as_ref().map_or(0.0, |p| 0.5 * p.stiffness * turn.norm_squared())
}

/// Bristles of the step's start that no point carries on are lost with what they held; `ws` holds the touches before their
/// memories are written.
pub(crate) fn add_cut_off(model: &Model, state: &mut State, ws: &Workspace) {
    if !ws.keeps_books || state.bristles.is_empty() {
        return;
    }
    let carried_on = |t: &&Touch| t.out.bears && model.laws[t.pair as usize].remembers();
    let of = |t: &Touch| t.weight * calc_deflection_energy(model, t.pair, &t.s, &t.turn);
    let kept: f64 = ws.touches.iter().filter(carried_on).map(of).sum();
    state.account.contact_loss += (calc_bristle_energy(model, &state.bristles) - kept).max(0.0);
}

/// Works of actuators and effects on the joints' coordinates and losses there: over a step whose end `state` is, or at the
/// present stage of Runge–Kutta. Dry friction of the joints themselves is booked where its deflection is advanced.
pub(crate) fn add_coordinates(model: &Model, state: &mut State, ws: &Workspace) {
    if !ws.keeps_books {
        return;
    }
    let mut works = std::mem::take(&mut state.works);
    let mut loss = 0.0;
    for (i, coordinate) in model.coordinates.iter().enumerate().filter(|(_, c)| !c.is_idle()) {
        let passage = match ws.since {
            Some(_) => Passage::of_stage(model, state, ws, i),
            None => Passage::over_step(model, state, ws, i),
        };
        let acting = Acting { model, state, step: ws.step, since: ws.since };
        loss += coordinate.add_works(&passage, &acting, &mut works);
    }
    state.works = works;
    state.account.joint_loss += loss;
}
