//! What drives put in: the momentum that a driven vehicle gains and nobody else gave it, and its power.
//!
//!   F_drive = ḣ − F_others      about W's origin,     P = F_drive · V        V: the base's twist about W's origin
//!
//! Runge–Kutta books the rates of its stages; the other schemes the sums of a step, with the mean of the twists at its ends.

use crate::model::Model;
use crate::parts::Base;
use crate::state::State;
use crate::workspace::{DriveStart, Workspace};
use multibody::{Accelerations, calc_momentum};
use spatial::{Twist, Vec3, Wrench};

/// Puts every driven base where it is at a time.
#[inline]
pub(crate) fn place(model: &Model, state: &mut State, time: f64) {
    for drive in &model.drives {
        state.bases[drive.vehicle] = drive.calc_motion(time).pose;
    }
}

/// What the twist of driven base `k`, about the place of its origin at `start`, gains until `start + h`.
pub(crate) fn calc_gain(model: &Model, k: usize, start: f64, h: f64) -> Twist {
    let [from, to] = [start, start + h].map(|t| model.drives[k].calc_motion(t));
    let back: Vec3 = from.pose.translation.vector - to.pose.translation.vector;
    to.twist.about(&back) - from.twist
}

/// Keeps the start of a step, and says what the driven bases gain in it.
pub(crate) fn begin(model: &Model, state: &State, ws: &mut Workspace, h: f64) {
    ws.drive_start.clear();
    for (k, drive) in model.drives.iter().enumerate() {
        let v = drive.vehicle;
        ws.drive_gain[v] = calc_gain(model, k, state.time, h);
        ws.base_acceleration[v] = ws.drive_gain[v] * (1.0 / h);
        let start = calc_start(state, ws, v);
        ws.drive_start.push(start);
    }
}

/// Books the step that has ended.
pub(crate) fn add_step(model: &Model, state: &mut State, ws: &Workspace) {
    for ((start, drive), work) in ws.drive_start.iter().zip(&model.drives).zip(model.actuators.len()..) {
        let end = calc_start(state, ws, drive.vehicle);
        let impulse = (end.momentum - start.momentum) - (end.given - start.given);
        state.account.impulse += impulse;
        state.works[work] += ((start.twist + end.twist) * 0.5).dot(&impulse);
    }
}

fn calc_start(state: &State, ws: &Workspace, v: usize) -> DriveStart {
    let kin = &ws.kin[v];
    let to_origin = -kin.anchor;
    DriveStart {
        momentum: calc_momentum(kin).about(&to_origin),
        given: state.momentum[v],
        twist: kin.vel[0].about(&to_origin),
    }
}

/// Books a stage, in rates: `given` are those of the momentum that others give, `v_dot` those of the joints' rates.
pub(crate) fn add_rates(model: &Model, state: &mut State, ws: &mut Workspace, given: &[Wrench], v_dot: &[f64]) {
    for (drive, work) in model.drives.iter().zip(model.actuators.len()..) {
        let v = drive.vehicle;
        let own = calc_momentum_rate(model, state, ws, v, v_dot);
        let force = own - given[v];
        state.account.impulse += force;
        let kin = &ws.kin[v];
        state.works[work] += kin.vel[0].about(&-kin.anchor).dot(&force);
    }
}

/// Rate of a vehicle's momentum about W's origin.
fn calc_momentum_rate(model: &Model, state: &State, ws: &mut Workspace, v: usize, v_dot: &[f64]) -> Wrench {
    let vehicle = &model.vehicles[v];
    debug_assert!(matches!(vehicle.base, Base::Driven(_)), "only driven vehicles have their books kept here");
    if vehicle.tree.bodies.iter().all(|b| b.inertia.mass == 0.0) {
        return Wrench::default();
    }
    let bodies = vehicle.body0..vehicle.body0 + vehicle.tree.bodies.len();
    let (range, external) = (vehicle.v_range(), &ws.external[bodies]);
    let motion = Accelerations { base: ws.base_acceleration[v], v: &state.v[range.clone()], v_dot: &v_dot[range] };
    ws.dynamics[v].calc_body_wrenches(&vehicle.tree, &ws.kin[v], &motion, external);
    let beyond = ws.dynamics[v].wrench.iter().fold(Wrench::default(), |sum, w| sum + *w);
    let sum = external.iter().fold(beyond, |sum, w| sum + *w);
    sum.about(&-ws.kin[v].anchor)
}
