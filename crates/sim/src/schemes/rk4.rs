//! The classical fourth-order Runge–Kutta step.
//!
//!   y = (base position, rotation vector from the step's start, joint displacement, v, p, L, s, effects' memory)
//!
//! Every stage takes the base twist from its momentum, so every stage conserves, and so does the sum. Rotation vectors
//! follow θ̇ = ω − ½ θ×ω + 1/12 θ×(θ×ω). Deflections are kept in the plane of the step's start. Those of the comparison laws
//! have rates; what becomes of a bristle's is the business of [`super::rk4_bristle`].
//!
//! Within a step the same stages tell the state at t + θ h to third order (Hairer, Nørsett and Wanner 1993, II.6):
//!
//!   y(θ) = y + h Σ bᵢ(θ) kᵢ,    b₁ = θ − 3θ²/2 + 2θ³/3,  b₂ = b₃ = θ² − 2θ³/3,  b₄ = −θ²/2 + 2θ³/3

use super::rk4_bristle::{self, Stage, Track};
use super::step::{MAX_SOLVES, add_impulses, begin, finish, moved_base};
use crate::books;
use crate::forces::contacts::{Turned, find_memory, find_touches};
use crate::forces::{Acting, calc_bias, calc_external, drives, effects, mechanisms, pivots, speed_limits};
use crate::model::Model;
use crate::parts::CoordinatePoint;
use crate::solve;
use crate::state::{Account, ContactMemory, State};
use crate::workspace::{Touch, Workspace};
use friction::{BrushRate, Trial, carry};
use spatial::{Mat3, Twist, Vec3, Wrench, rotation_rate_of_vector};

/// Scratch of the stages.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stages {
    start: State,
    rate: Rates,
    sum: Rates,
    /// Per vehicle: rotation vector of the base since the step's start, at the present stage.
    turned: Vec<Vec3>,
    slots: Vec<ContactMemory>,
    tracks: Vec<Track>,
    node: usize,
    /// Instants within the step that are asked for; the first `asked` of them.
    between: Vec<Between>,
    asked: usize,
}

/// The world at an instant within a step.
#[derive(Clone, Debug, Default)]
struct Between {
    /// Share of the step.
    at: f64,
    sum: Rates,
    state: State,
}

impl Between {
    /// Weight of a stage, for a stretch of the step that is as long as its own share.
    fn weight(&self, stage: usize) -> f64 {
        let x = self.at;
        match stage {
            0 => 1.0 - x * (1.5 - 2.0 / 3.0 * x),
            3 => x * (2.0 / 3.0 * x - 0.5),
            _ => x * (1.0 - 2.0 / 3.0 * x),
        }
    }
}

/// A rate of everything that is integrated.
#[derive(Clone, Debug, Default)]
struct Rates {
    /// Per vehicle: rotation vector and position of the base.
    base: Vec<Twist>,
    xi: Vec<f64>,
    v: Vec<f64>,
    momentum: Vec<Wrench>,
    /// Per bristle slot, in the plane and the axes of the step's start.
    s: Vec<Vec3>,
    effects: Vec<f64>,
    works: Vec<f64>,
    account: Account,
}

fn zero<T: Clone + Default>(x: &mut Vec<T>, n: usize) {
    x.clear();
    x.resize(n, T::default());
}

impl Rates {
    fn reset(&mut self, model: &Model, slots: usize) {
        zero(&mut self.base, model.vehicles.len());
        zero(&mut self.momentum, model.vehicles.len());
        zero(&mut self.xi, model.nv());
        zero(&mut self.v, model.nv());
        self.reset_sums(model, slots);
        self.account = Account::default();
    }

    /// What a stage adds to; the rest it writes whole.
    fn reset_sums(&mut self, model: &Model, slots: usize) {
        zero(&mut self.s, slots);
        zero(&mut self.effects, model.effects.n_memory());
        zero(&mut self.works, model.n_works());
    }

    fn add_scaled(&mut self, other: &Self, k: f64) {
        fn add<T: Copy + std::ops::AddAssign + std::ops::Mul<f64, Output = T>>(x: &mut [T], y: &[T], k: f64) {
            x.iter_mut().zip(y).for_each(|(x, y)| *x += *y * k);
        }
        add(&mut self.base, &other.base, k);
        add(&mut self.momentum, &other.momentum, k);
        add(&mut self.xi, &other.xi, k);
        add(&mut self.v, &other.v, k);
        add(&mut self.s, &other.s, k);
        add(&mut self.effects, &other.effects, k);
        add(&mut self.works, &other.works, k);
        self.account.add_scaled(&other.account, k);
    }
}

impl Stages {
    pub fn new(model: &Model) -> Self {
        let turned = vec![Vec3::zeros(); model.vehicles.len()];
        let mut stages = Self { start: State::new(model), turned, ..Self::default() };
        stages.rate.reset(model, 0);
        stages.sum.reset(model, 0);
        stages
    }

    /// Asks for the world at some shares of the next step.
    pub fn ask(&mut self, model: &Model, shares: impl Iterator<Item = f64>) {
        self.asked = 0;
        for at in shares {
            if self.asked == self.between.len() {
                self.between.push(Between { state: State::new(model), ..Between::default() });
            }
            self.between[self.asked].at = at;
            self.asked += 1;
        }
    }

    /// The state at the instant of that number, to be exchanged for another one.
    pub fn between(&mut self, index: usize) -> &mut State {
        &mut self.between[index].state
    }
}

/// Times of the stages in steps, and their weights.
const STAGES: [(f64, f64); 4] = [(0.0, 1.0 / 6.0), (0.5, 1.0 / 3.0), (0.5, 1.0 / 3.0), (1.0, 1.0 / 6.0)];

/// Advances the world by one step; `ws` holds the kinematics of `state`.
pub(crate) fn step(model: &Model, state: &mut State, ws: &mut Workspace, rk: &mut Stages) {
    let h = ws.step;
    begin(model, state, ws);
    // A stage's works are rates: nothing gains within it.
    ws.gain_share = 0.0;
    let bristles = if ws.keeps_books { books::calc_bristle_energy(model, &state.bristles) } else { 0.0 };
    rk.start.copy_from(state);
    for (index, (node, weight)) in STAGES.into_iter().enumerate() {
        ws.since = Some(node * h);
        rk.turned.fill(Vec3::zeros());
        if index > 0 {
            rk.turned.iter_mut().zip(&rk.rate.base).for_each(|(turned, rate)| *turned = rate.ang * (node * h));
            let from = From { start: &rk.start, rate: &rk.rate, slots: &rk.slots };
            place(model, state, &mut ws.displacement, &from, node * h);
            ws.update_positions(model, state);
            ws.update_velocities(model, state);
        }
        find_touches(model, state, ws, h);
        if index == 0 {
            open_slots(model, ws, &mut rk.slots);
            rk.sum.reset(model, rk.slots.len());
            rk.tracks.clear();
            rk.tracks.resize(rk.slots.len(), Track::default());
            let slots = rk.slots.len();
            rk.between[..rk.asked].iter_mut().for_each(|b| b.sum.reset(model, slots));
        }
        rk.node = index;
        calc_rates(model, state, ws, rk);
        rk.sum.add_scaled(&rk.rate, weight);
        for between in &mut rk.between[..rk.asked] {
            let weight = between.weight(index);
            between.sum.add_scaled(&rk.rate, weight);
        }
    }
    for between in &mut rk.between[..rk.asked] {
        let from = From { start: &rk.start, rate: &between.sum, slots: &rk.slots };
        place(model, &mut between.state, &mut ws.displacement, &from, between.at * h);
        between.state.commands.clone_from(&rk.start.commands);
    }
    let from = From { start: &rk.start, rate: &rk.sum, slots: &rk.slots };
    place(model, state, &mut ws.displacement, &from, h);
    drives::place(model, state, ws.end);
    if ws.keeps_books {
        state.account.add_scaled(&rk.sum.account, h);
        state.works.iter_mut().zip(&rk.sum.works).for_each(|(sum, rate)| *sum += rate * h);
    }
    rk4_bristle::place_at_the_end(model, &rk.tracks, &mut state.bristles);
    ws.update_positions(model, state);
    finish(model, state, ws);
    pivots::commit(ws);
    carry_to_the_end(model, state, ws);
    if ws.keeps_books {
        // Stages have booked the whole work of friction as lost; what the bristles hold of it is not.
        state.account.contact_loss -= books::calc_bristle_energy(model, &state.bristles) - bristles;
    }
    mechanisms::commit(model, state, ws);
}

/// Every touching point gets a slot, in the order of touches; its deflection is cut to what the normal force holds.
fn open_slots(model: &Model, ws: &Workspace, slots: &mut Vec<ContactMemory>) {
    slots.clear();
    for touch in &ws.touches {
        let law = model.laws[touch.pair as usize].weighted(touch.weight);
        if !law.remembers() {
            continue;
        }
        let compression = law.normal.calc_compression(touch.gap, touch.normal.dot(&touch.u));
        let s_w = law.friction.map_or(Vec3::zeros(), |f| f.eval_rate(&trial_of(touch, compression)).s);
        let Touch { pair, feature, normal: normal_w, turn: turn_w, rest, local_b: point_b, weight, .. } = *touch;
        slots.push(ContactMemory { pair, feature, s_w, normal_w, turn_w, rest, point_b, weight });
    }
}

fn trial_of(touch: &Touch, normal_force: f64) -> Trial {
    let slip = touch.u - touch.normal * touch.normal.dot(&touch.u);
    Trial { s: touch.s, slip, normal_force, rest: touch.rest, grain: touch.grain, ..Trial::default() }
}

/// Bristles were integrated in the plane and the axes of the step's start: they turn with the bodies to its end.
fn carry_to_the_end(model: &Model, state: &mut State, ws: &Workspace) {
    let turned = Turned { from: &ws.frames_start, to: &ws.frames };
    for memory in &mut state.bristles {
        let bodies = model.pair_bodies(memory.pair as usize);
        let normal = turned.normal(bodies, &memory.normal_w);
        memory.s_w = turned.deflection(bodies, &memory.s_w, &memory.normal_w, &normal);
        memory.normal_w = normal;
        let touch = ws.touches.iter().find(|t| (t.pair, t.feature) == (memory.pair, memory.feature));
        if let Some(touch) = touch {
            memory.turn_w = carry(&touch.turn, &touch.normal, &normal);
        }
    }
}

/// Where a stage starts from.
#[derive(Clone, Copy)]
struct From<'a> {
    start: &'a State,
    rate: &'a Rates,
    slots: &'a [ContactMemory],
}

/// The state at `start` + `k` times the rates.
fn place(model: &Model, state: &mut State, displacement: &mut [f64], from: &From<'_>, k: f64) {
    let From { start, rate, slots } = *from;
    state.copy_from_physics(start);
    state.time = start.time + k;
    for (i, vehicle) in model.vehicles.iter().enumerate() {
        let gain = rate.base[i] * k;
        state.bases[i] = moved_base(vehicle.base, &start.bases[i], &gain.lin, &gain.ang);
        state.momentum[i] += rate.momentum[i] * k;
        let xi = &mut displacement[vehicle.v_range()];
        xi.iter_mut().zip(&rate.xi[vehicle.v_range()]).for_each(|(x, r)| *x = r * k);
        vehicle.tree.retract(&mut state.q[vehicle.q_range()], xi);
    }
    state.v.iter_mut().zip(&rate.v).for_each(|(v, r)| *v += r * k);
    drives::place(model, state, state.time);
    state.effects.iter_mut().zip(&rate.effects).for_each(|(x, r)| *x += r * k);
    state.bristles.clear();
    let moved = slots.iter().zip(&rate.s).map(|(slot, r)| ContactMemory { s_w: slot.s_w + r * k, ..*slot });
    state.bristles.extend(moved);
}

/// Rates at the present stage, whose kinematics and touches `ws` holds.
fn calc_rates(model: &Model, state: &mut State, ws: &mut Workspace, rk: &mut Stages) {
    let slots = rk.slots.len();
    rk.rate.reset_sums(model, slots);
    eval_contacts(model, ws, rk);
    mechanisms::eval_explicit(model, state, ws);
    pivots::eval_explicit(model, ws, state.time - rk.start.time);
    eval_coordinates(model, state, ws, rk);
    calc_external(model, state, ws);
    for drive in &model.drives {
        ws.base_acceleration[drive.vehicle] = drive.calc_motion(state.time).acceleration;
    }
    // Bases move by their momentum; accelerations are those of joints alone.
    if model.nv() > 0 {
        calc_bias(model, state, ws, false);
        solve_joints(model, state, ws, &rk.start.v);
        for (rest, _) in &ws.held {
            let share = std::mem::take(&mut ws.v_gain[rest.coordinate]).abs() / rest.acceleration;
            ws.unrest = if share.is_nan() { f64::INFINITY } else { ws.unrest.max(share) };
        }
        rk.rate.v.copy_from_slice(&ws.v_gain);
        state.work.solves += 1;
    }
    effects::write_rates(model, state, ws, &mut rk.rate.effects);
    state.work.rate_evaluations += 1;
    ws.v_gain.fill(0.0);
    ws.dvel.fill(Twist::default());
    let account = std::mem::take(&mut state.account);
    std::mem::swap(&mut rk.rate.works, &mut state.works);
    rk.rate.momentum.copy_from_slice(&state.momentum);
    state.momentum.fill(Wrench::default());
    add_impulses(model, state, ws, 1.0);
    books::add_coordinates(model, state, ws);
    std::mem::swap(&mut rk.rate.momentum, &mut state.momentum);
    drives::add_rates(model, state, ws, &rk.rate.momentum, &rk.rate.v);
    std::mem::swap(&mut rk.rate.works, &mut state.works);
    rk.rate.account = std::mem::replace(&mut state.account, account);
    for (i, vehicle) in model.vehicles.iter().enumerate() {
        let (q, v) = (vehicle.q_range(), vehicle.v_range());
        let twist = ws.kin[i].vel[0];
        rk.rate.base[i] = Twist::new(rotation_rate_of_vector(&rk.turned[i], &twist.ang), twist.lin);
        let xi = &mut ws.displacement[v.clone()];
        vehicle.tree.calc_difference(&rk.start.q[q.clone()], &state.q[q.clone()], xi);
        vehicle.tree.calc_displacement_rate(&rk.start.q[q], xi, &state.v[v.clone()], &mut rk.rate.xi[v]);
    }
}

/// Accelerations of the joints, within the speed limits of their motors.
fn solve_joints(model: &Model, state: &State, ws: &mut Workspace, v_start: &[f64]) {
    for _ in 0..MAX_SOLVES {
        if !solve::solve_joints(model, ws) {
            return ws.v_gain.fill(f64::NAN);
        }
        if speed_limits::hold_at_stage(model, state, ws, v_start) {
            break;
        }
    }
}

fn eval_contacts(model: &Model, ws: &mut Workspace, rk: &mut Stages) {
    let Workspace { touches, frames, frames_start, step, .. } = ws;
    // Back from the present frames to those of the step's start.
    let turns = (&Turned { from: frames_start, to: frames }, &Turned { from: frames, to: frames_start });
    for touch in touches {
        let slot = find_memory(&rk.slots, touch.pair, touch.feature);
        if let Some(slot) = slot {
            let at = Stage { node: rk.node, step: *step, slot: &rk.slots[slot], there: turns.0, back: turns.1 };
            rk4_bristle::bring(model, touch, &at, &mut rk.tracks[slot]);
        }
        let brush = eval_touch(model, touch);
        if let (Some(brush), Some(slot)) = (brush, slot)
            && !rk4_bristle::is_tracked(model, touch.pair)
        {
            let (bodies, normal) = ((touch.body_a, touch.body_b), &rk.slots[slot].normal_w);
            rk.rate.s[slot] = turns.1.deflection(bodies, &brush.s_rate, &touch.normal, normal);
        }
    }
}

/// Force of a touch by its laws as they are, and what friction says of its memory.
fn eval_touch(model: &Model, touch: &mut Touch) -> Option<BrushRate> {
    let (law, n) = (model.laws[touch.pair as usize].weighted(touch.weight), touch.normal);
    let normal = law.normal.eval(touch.gap, n.dot(&touch.u));
    touch.out.law = normal.force * n;
    touch.out.normal_force = normal.force + law.normal.adhesion_at(touch.gap);
    touch.out.g = Mat3::zeros();
    let brush = law.friction.as_ref().map(|f| f.eval_rate(&trial_of(touch, touch.out.normal_force)));
    if let Some(brush) = &brush {
        touch.out.law += brush.force;
        (touch.out.s, touch.out.sticks) = (brush.s, brush.sticks);
    }
    (touch.out.line, touch.out.force) = (touch.out.law, touch.out.law);
    brush
}

/// Finds the touching points of the present state and evaluates their laws there; nothing advances.
pub(crate) fn refresh_touches(model: &Model, state: &State, ws: &mut Workspace) {
    ws.frames_start.copy_from_slice(&ws.frames);
    find_touches(model, state, ws, ws.step);
    for touch in &mut ws.touches {
        eval_touch(model, touch);
    }
}

fn eval_coordinates(model: &Model, state: &State, ws: &mut Workspace, rk: &Stages) {
    for (i, coordinate) in model.coordinates.iter().enumerate().filter(|(_, c)| !c.is_idle()) {
        let (q, v) = (state.q[coordinate.q_index], state.v[i]);
        let point = CoordinatePoint {
            q_base: q,
            moved_base: q - rk.start.q[coordinate.q_index],
            v_start: v,
            beta: 0.0,
            theta: 0.0,
            dry_start: rk.start.dry[i],
            elapsed: ws.step,
            from: ws.since.map(|since| (rk.start.v[i], since)),
            end: Some(rk.start.v[i]),
            branch: None,
        };
        let force = coordinate.eval(&point, v, &Acting { model, state, step: ws.step, since: ws.since });
        ws.coordinate_points[i] = CoordinatePoint { branch: force.branch, ..point };
        ws.coordinate_forces[i] = force;
        ws.coordinate_lines[i] = (force.effort, ws.step * force.fall);
    }
}
