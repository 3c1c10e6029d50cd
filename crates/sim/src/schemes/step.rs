//! One step, readable: where forces are evaluated, how they are solved for, and how momentum and poses follow.
//!
//! The three one-solve schemes share this code; they differ in where the laws are evaluated ([`Scheme`]). Per step:
//!
//! 1. external wrenches, bias by inverse dynamics at zero acceleration, touching points;
//! 2. laws at the predicted end, A dv = h (τ − c + Jᵀf), and a check of the laws at the solution: where the line
//!    missed the law, a new line and a new solve (at most eight);
//! 3. momentum takes the forces that both bodies felt; poses move with the solved velocities, centres of mass with p/m;
//! 4. kinematics at the new pose, base twist from momentum, bristles from the displacement of material points.
//!
//! Derivation, costs and the traps: crate documentation.

use crate::books;
use crate::forces::contacts::{calc_carried, commit_bristles, find_touches};
use crate::forces::{Acting, calc_bias, calc_external, drives, effects, inner, mechanisms, pivots, speed_limits};
use crate::model::{Model, Scheme};
use crate::parts::{Base, CoordinateForce, CoordinatePoint};
use crate::solve;
use crate::state::State;
use crate::workspace::{Answer, Place, Touch, Workspace, calc_carried_linear, world_wrench};
use multibody::Kinematics;
use spatial::{Pose, Rot, Twist, Vec3, Wrench, exp_rotation};

/// Relative difference between the line's force and the law's that asks for a new solve.
const LAW_TOLERANCE: f64 = 1e-3;

/// Force (N or N·m) below which a difference is round-off and nobody's business.
const FORCE_FLOOR: f64 = 1e-10;

/// Most solves in a step.
pub(crate) const MAX_SOLVES: u32 = 8;

/// Largest (h ω)² at which the midpoint rule resolves a contact; beyond it the stiff form takes over.
const RESOLVED: f64 = 0.1;

/// Advances the world by one step; `ws` holds the kinematics of `state`.
pub(crate) fn step(model: &Model, state: &mut State, ws: &mut Workspace, scheme: Scheme) {
    let h = ws.step;
    ws.since = None;
    ws.gain_share = if scheme == Scheme::ImplicitMidpoint { 0.5 } else { 1.0 };
    begin(model, state, ws);
    drives::begin(model, state, ws, h);
    if scheme == Scheme::ImplicitMidpoint {
        inner::drift_to_midpoint(model, state, ws, 0.5 * h);
        drift_to_midpoint(model, state, ws, 0.5 * h);
        state.time += 0.5 * h;
    }
    calc_external(model, state, ws);
    calc_bias(model, state, ws, false);
    find_touches(model, state, ws, h);
    mechanisms::find_couplings(model, state, ws);
    pivots::find_pivots(model, ws);
    place_laws(model, state, ws, scheme);
    solve_laws(model, state, ws, scheme);
    effects::advance(model, state, ws, scheme);
    add_impulses(model, state, ws, h);
    match scheme {
        Scheme::ImplicitMidpoint => drift_from_midpoint(model, state, ws, 0.5 * h),
        _ => drift(model, state, ws, h),
    }
    drives::place(model, state, ws.end);
    place_vehicles(model, state, ws, scheme);
    books::add_coordinates(model, state, ws);
    books::add_cut_off(model, state, ws);
    finish(model, state, ws);
    drives::add_step(model, state, ws);
    pivots::commit(ws);
    commit_bristles(model, state, ws);
    mechanisms::commit(model, state, ws);
}

/// Kinematics and frames of the drifted state, every centre of mass in its place.
fn place_vehicles(model: &Model, state: &mut State, ws: &mut Workspace, scheme: Scheme) {
    for (i, vehicle) in model.vehicles.iter().enumerate() {
        ws.update_screws(model, state, i);
        if !vehicle.base.is_held() {
            place_centre(model, state, ws, i, scheme);
        }
        ws.update_frames(model, i);
    }
}

/// Shifts a base so that its vehicle's centre of mass moves by h p/m exactly, with the momentum that moves it.
///
/// The drift of the base origin is off by O(h²), and L − x × p turns that into spin: a body flying at 1 m/s and turning at
/// 1 rad/s would be pushed aside by ½ mm/s, and its rotation would depend on the frame that one looks from.
fn place_centre(model: &Model, state: &mut State, ws: &mut Workspace, i: usize, scheme: Scheme) {
    let start = &ws.momentum_start[i];
    let mean = match scheme {
        Scheme::ImplicitMidpoint => 0.5 * (start + own_momentum(model, state, ws, i)),
        _ => own_momentum(model, state, ws, i),
    };
    let (mass, first_moment) = calc_first_moment(&ws.kin[i]);
    let kin = &mut ws.kin[i];
    let off = ws.centre_start[i] + mean * (ws.step / mass) - (kin.anchor + first_moment / mass);
    let mask = model.vehicles[i].base.mask();
    let shift = Vec3::from_fn(|k, _| if mask[3 + k] { off[k] } else { 0.0 });
    state.bases[i].translation.vector += shift;
    kin.anchor = state.bases[i].translation.vector;
}

/// Linear momentum of a vehicle's bodies, without the parts that effects put inside them.
fn own_momentum(model: &Model, state: &State, ws: &Workspace, vehicle: usize) -> Vec3 {
    let total = state.momentum[vehicle].force;
    if ws.parts.has_parts { total - calc_carried_linear(model, state, vehicle) } else { total }
}

/// Mass of a vehicle and its first moment about the anchor.
fn calc_first_moment(kin: &Kinematics) -> (f64, Vec3) {
    kin.inertia.iter().fold((0.0, Vec3::zeros()), |(mass, moment), i| (mass + i.mass, moment + i.mc))
}

/// Keeps what the end of the step needs of its start.
pub(crate) fn begin(model: &Model, state: &State, ws: &mut Workspace) {
    ws.frames_start.copy_from_slice(&ws.frames);
    ws.q_start.copy_from_slice(&state.q);
    ws.effects_start.copy_from_slice(&state.effects);
    ws.queries_start = ws.detector.narrow_count();
    for i in 0..model.vehicles.len() {
        ws.base_start[i] = ws.kin[i].vel[0];
        ws.momentum_start[i] = own_momentum(model, state, ws, i);
        let (mass, first_moment) = calc_first_moment(&ws.kin[i]);
        ws.centre_start[i] = ws.kin[i].anchor + first_moment / mass;
    }
}

/// Velocities at the new state, whose positions `ws` holds, and what is remembered of it.
pub(crate) fn finish(model: &Model, state: &mut State, ws: &mut Workspace) {
    let now = std::mem::replace(&mut state.time, ws.end);
    ws.update_velocities(model, state);
    state.time = now;
    for (i, coordinate) in model.coordinates.iter().enumerate().filter(|(_, c)| c.dry.is_some()) {
        let moved = state.q[coordinate.q_index] - ws.q_start[coordinate.q_index];
        let start = state.dry[i];
        state.dry[i] = coordinate.advance_dry(start, moved, ws.step);
        state.account.joint_loss += coordinate.calc_dry_loss(start, state.dry[i], moved);
    }
    effects::commit(model, state, ws);
    state.time = ws.end;
    state.work.steps += 1;
    state.work.contact_queries += ws.detector.narrow_count() - ws.queries_start;
}

/// Decides for every touch and coordinate where its law is evaluated, and draws the first lines at zero gain.
fn place_laws(model: &Model, state: &State, ws: &mut Workspace, scheme: Scheme) {
    let h = ws.step;
    mechanisms::place(model, ws, scheme);
    ws.answers.resize(ws.touches.len(), Answer::default());
    for i in 0..ws.touches.len() {
        let is_stiff = scheme == Scheme::ImplicitMidpoint && is_stiff(model, ws, i);
        let touch = &mut ws.touches[i];
        touch.place = place_of(scheme, touch, h);
        let law = &model.laws[touch.pair as usize];
        if is_stiff {
            touch.place = Place { gap_base: touch.gap, s_base: touch.s, beta: h, theta: 1.0, elapsed: h };
        }
        let answer = &mut ws.answers[i];
        touch.eval(law, touch.u, answer);
        touch.draw_line(law, answer, h);
        if scheme == Scheme::SemiImplicitEuler {
            touch.out.g = spatial::Mat3::zeros();
            touch.out.line = touch.out.law;
        }
    }
    pivots::place(model, ws, h);
    for (i, coordinate) in model.coordinates.iter().enumerate().filter(|(_, c)| !c.is_idle()) {
        let (q, v) = (state.q[coordinate.q_index], state.v[i]);
        // At the midpoint q has drifted by h/2 v already: its base is the start's plus h/4 v.
        let (beta, theta, q_base, moved_base, elapsed) = match scheme {
            Scheme::ImplicitEuler => (h, 1.0, q, 0.0, h),
            Scheme::ImplicitMidpoint => (0.25 * h, 0.5, q - 0.25 * h * v, 0.25 * h * v, 0.5 * h),
            Scheme::SemiImplicitEuler => (0.0, 0.0, q, h * v, h),
        };
        let dry_start = state.dry[i];
        let (from, end, branch) = (None, None, None);
        let point =
            CoordinatePoint { q_base, moved_base, v_start: v, beta, theta, dry_start, elapsed, from, end, branch };
        let force = coordinate.eval(&point, v, &Acting { model, state, step: h, since: None });
        ws.coordinate_points[i] = CoordinatePoint { branch: force.branch, ..point };
        ws.coordinate_forces[i] = force;
        ws.coordinate_lines[i] = (force.effort, force.slope);
    }
}

fn place_of(scheme: Scheme, touch: &Touch, h: f64) -> Place {
    let (u_n, n) = (touch.normal.dot(&touch.u), touch.normal);
    let u_t = touch.u - u_n * n;
    match scheme {
        Scheme::ImplicitEuler => Place { gap_base: touch.gap, s_base: touch.s, beta: h, theta: 1.0, elapsed: h },
        Scheme::ImplicitMidpoint => Place {
            gap_base: touch.gap - 0.25 * h * u_n,
            s_base: touch.s + 0.25 * h * u_t,
            beta: 0.25 * h,
            theta: 0.5,
            elapsed: 0.5 * h,
        },
        Scheme::SemiImplicitEuler => {
            Place { gap_base: touch.gap, s_base: touch.s + h * u_t, beta: 0.0, theta: 0.0, elapsed: h }
        }
    }
}

/// Whether a contact oscillates too fast for the midpoint rule to resolve it: (h ω)² > 0.1 with ω² = n k/m, n the points
/// of its pair, m the lighter body's mass (the effective mass is smaller off the centre of mass; this one is cheap and
/// safe enough, since both forms converge).
fn is_stiff(model: &Model, ws: &Workspace, index: usize) -> bool {
    let touches = &ws.touches;
    let mass = |body: usize| {
        model.owners.get(body).map_or(f64::INFINITY, |&(v, b)| model.vehicles[v].tree.bodies[b].inertia.mass)
    };
    let touch = &touches[index];
    let law = model.laws[touch.pair as usize].weighted(touch.weight);
    let lighter = mass(touch.body_a).min(mass(touch.body_b));
    let normal = law.normal.eval(touch.gap.min(-1e-5), 0.0);
    let stiffness = (-normal.d_gap).max(law.friction.map_or(0.0, |f| f.spring().0));
    let sharing = touches.iter().filter(|t| t.pair == touch.pair).count() as f64;
    ws.step * ws.step * sharing * stiffness > RESOLVED * lighter
}

/// Solves, checks the laws at the solution, and draws new lines where they missed.
fn solve_laws(model: &Model, state: &mut State, ws: &mut Workspace, scheme: Scheme) {
    let h = ws.step;
    let mut must_factor = true;
    let mut converged = false;
    for pass in 0..MAX_SOLVES {
        if must_factor && !solve::factor(model, ws, h) {
            ws.v_gain.fill(f64::NAN);
            return;
        }
        solve::solve(model, ws, h);
        state.work.solves += 1;
        state.work.rate_evaluations += 1;
        let first_midpoint_pass = scheme == Scheme::ImplicitMidpoint && pass == 0;
        converged = match scheme {
            Scheme::SemiImplicitEuler => speed_limits::hold_in_step(model, state, ws),
            _ => laws_hold(model, state, ws, first_midpoint_pass),
        };
        must_factor = !converged;
        if first_midpoint_pass {
            recalc_bias_at_midpoint(model, state, ws);
            must_factor |= !ws.touches.is_empty() || !ws.couplings.is_empty() || !model.effects.list.is_empty();
        }
        if converged && !first_midpoint_pass {
            break;
        }
    }
    state.work.unconverged_steps += u64::from(!converged);
}

/// Once the gains are known, velocity-dependent forces are taken at the mean velocity.
fn recalc_bias_at_midpoint(model: &Model, state: &State, ws: &mut Workspace) {
    for (i, vehicle) in model.vehicles.iter().enumerate() {
        let base = ws.base_start[i];
        let gain = classical_gain(&ws.base_gain[i], &base, ws.step);
        for k in vehicle.v_range() {
            ws.v_mid[k] = state.v[k] + 0.5 * ws.v_gain[k];
        }
        let (kin, range) = (&mut ws.kin[i], vehicle.v_range());
        kin.update_velocities(&vehicle.tree, &(base + gain * 0.5), &ws.v_mid[range]);
    }
    if effects::depends_on_twists(model) || !model.forces.is_empty() {
        calc_external(model, state, ws);
    }
    calc_bias(model, state, ws, true);
    for i in 0..ws.touches.len() {
        let carried = calc_carried(model, ws, &ws.touches[i]) * ws.step;
        let touch = &mut ws.touches[i];
        touch.out.line -= touch.out.g * (carried - touch.carried) / ws.step;
        touch.carried = carried;
    }
    mechanisms::update_carried(model, ws);
    // The start's twists come back: gains are counted from them.
    for (i, vehicle) in model.vehicles.iter().enumerate() {
        let (start, range) = (ws.base_start[i], vehicle.v_range());
        ws.kin[i].update_velocities(&vehicle.tree, &start, &state.v[range]);
    }
}

/// Gain of (ω, velocity of the base origin) from the spatial gain: the origin moves, so ω × v is added.
fn classical_gain(gain: &Twist, base: &Twist, h: f64) -> Twist {
    Twist::new(gain.ang, gain.lin + h * base.ang.cross(&base.lin))
}

/// Evaluates all laws at the solution; where a line missed, or another pass comes anyway, draws the next ones. `true` if
/// none did.
fn laws_hold(model: &Model, state: &State, ws: &mut Workspace, goes_on: bool) -> bool {
    let h = ws.step;
    let mut check = PairCheck::default();
    for i in 0..ws.touches.len() {
        let gain = relative_gain(model, ws, &ws.touches[i]);
        let touch = &mut ws.touches[i];
        let law = &model.laws[touch.pair as usize];
        let force = touch.out.line - touch.out.g * gain / h;
        touch.eval(law, touch.u + touch.carried + gain, &mut ws.answers[i]);
        let next = &touch.out;
        let mut miss = (next.law - force).norm();
        if let Some(friction) = law.friction.as_ref().filter(|_| next.pressing[0] != next.normal_force) {
            // A bound of friction that the normal force does not bear out is a miss as well.
            miss = miss.max(friction.highest_level() * (next.pressing[0] - next.normal_force).abs());
        }
        check.add(touch.pair, miss, next.law.norm());
        touch.out.force = force;
    }
    let joints_hold = joint_laws_hold(model, state, ws);
    let pivots_hold = pivots::laws_hold(model, ws);
    let hold = mechanisms::laws_hold(model, ws) && pivots_hold && joints_hold && check.holds();
    if goes_on || !hold {
        for (touch, answer) in ws.touches.iter_mut().zip(&ws.answers) {
            touch.draw_line(&model.laws[touch.pair as usize], answer, h);
        }
    }
    hold
}

fn joint_laws_hold(model: &Model, state: &State, ws: &mut Workspace) -> bool {
    let h = ws.step;
    let mut hold = true;
    for (i, coordinate) in model.coordinates.iter().enumerate().filter(|(_, c)| !c.is_idle()) {
        let (effort, slope) = ws.coordinate_lines[i];
        let v_new = state.v[i] + ws.v_gain[i];
        let on_line = effort - slope * ws.v_gain[i];
        let law = coordinate.eval(&ws.coordinate_points[i], v_new, &Acting { model, state, step: h, since: None });
        hold &= (law.effort - on_line).abs() <= LAW_TOLERANCE * law.effort.abs() + FORCE_FLOOR;
        ws.coordinate_forces[i] = CoordinateForce { effort: on_line, ..law };
        ws.coordinate_lines[i] = (law.effort + law.slope * ws.v_gain[i], law.slope);
        ws.coordinate_points[i].branch = law.branch;
    }
    hold
}

/// Compares lines with laws, pair by pair: a miss counts against the largest force of its own pair, so that a press
/// elsewhere in the world does not loosen a grasp.
#[derive(Default)]
struct PairCheck {
    pair: u32,
    worst: f64,
    largest: f64,
    missed: bool,
}

impl PairCheck {
    fn add(&mut self, pair: u32, miss: f64, size: f64) {
        if pair != self.pair {
            *self = Self { pair, missed: !self.holds(), ..Self::default() };
        }
        self.worst = self.worst.max(miss);
        self.largest = self.largest.max(size);
    }

    fn holds(&self) -> bool {
        !self.missed && self.worst <= LAW_TOLERANCE * self.largest + FORCE_FLOOR
    }
}

/// Gain of the relative velocity of a touch's material points.
fn relative_gain(model: &Model, ws: &Workspace, touch: &Touch) -> Vec3 {
    let at = |body: usize| {
        let Some(&(vehicle, _)) = model.owners.get(body) else { return Vec3::zeros() };
        ws.dvel[body].at(&(touch.point - ws.kin[vehicle].anchor))
    };
    at(touch.body_b) - at(touch.body_a)
}

/// Momentum: every contact gives the same numbers to both sides; and what [`books`] keeps of it.
pub(crate) fn add_impulses(model: &Model, state: &mut State, ws: &Workspace, h: f64) {
    for touch in &ws.touches {
        let impulse = h * touch.out.force;
        let moment = touch.point.cross(&impulse);
        add_impulse(model, state, ws, touch.body_a, &touch.point, &Wrench::new(-moment, -impulse));
        add_impulse(model, state, ws, touch.body_b, &touch.point, &Wrench::new(moment, impulse));
        if ws.keeps_books {
            let gain = relative_gain(model, ws, touch);
            books::add_touch(model, state, ws, touch, &gain);
        }
    }
    mechanisms::add_impulses(model, state, ws, h);
    pivots::add_impulses(model, state, ws, h);
    inner::add_impulses(model, state, ws, h);
    books::add_external(model, state, ws, h);
    for (body, &(vehicle, _)) in model.owners.iter().enumerate() {
        let external = ws.external[body];
        if external == Wrench::default() {
            continue;
        }
        let impulse = world_wrench(&model.vehicles[vehicle], &ws.kin[vehicle].anchor, &(external * h));
        state.momentum[vehicle] += impulse;
        state.account.impulse += impulse;
    }
}

fn add_impulse(model: &Model, state: &mut State, ws: &Workspace, body: usize, point: &Vec3, impulse: &Wrench) {
    let Some(&(vehicle, _)) = model.owners.get(body) else { return };
    let owner = &model.vehicles[vehicle];
    if matches!(owner.base, Base::Free | Base::Driven(_)) {
        state.momentum[vehicle] += *impulse;
    } else if owner.base != Base::Fixed {
        let anchor = ws.kin[vehicle].anchor;
        let about_anchor = Wrench::from_force_at(impulse.force, &(point - anchor));
        state.momentum[vehicle] += world_wrench(owner, &anchor, &about_anchor);
    }
}

/// Poses with the solved velocities: base on SE(3) (the spatial twist about the start's anchor), joints on their manifolds.
fn drift(model: &Model, state: &mut State, ws: &mut Workspace, h: f64) {
    for (i, vehicle) in model.vehicles.iter().enumerate() {
        let twist = ws.kin[i].vel[0] + ws.base_gain[i];
        let moved = h * twist.lin + 0.5 * h * h * twist.ang.cross(&twist.lin);
        state.bases[i] = moved_base(vehicle.base, &state.bases[i], &moved, &(h * twist.ang));
    }
    for k in 0..state.v.len() {
        state.v[k] += ws.v_gain[k];
    }
    drift_joints(model, state, ws, h);
}

fn drift_joints(model: &Model, state: &mut State, ws: &mut Workspace, h: f64) {
    for vehicle in &model.vehicles {
        let (q, v) = (vehicle.q_range(), vehicle.v_range());
        let xi = &mut ws.displacement[v.clone()];
        vehicle.tree.calc_displacement(&state.q[q.clone()], &state.v[v], h, xi);
        vehicle.tree.retract(&mut state.q[q], xi);
    }
}

pub(crate) fn moved_base(base: Base, pose: &Pose, moved: &Vec3, turned: &Vec3) -> Pose {
    if base.is_held() {
        return *pose;
    }
    let mask = base.mask();
    let moved = Vec3::from_fn(|i, _| if mask[3 + i] { moved[i] } else { 0.0 });
    // Products of unit quaternions lose their length by some 3e-17 per step, always the same way; the inertia in W axes
    // feels its fourth power, and a body that turns for 1,000 s the angle.
    let rotation = Rot::new_normalize((exp_rotation(turned) * pose.rotation).into_inner());
    Pose::from_parts((pose.translation.vector + moved).into(), rotation)
}

/// Midpoint: half a step with the start's velocities, and kinematics there with the same generalised velocities.
fn drift_to_midpoint(model: &Model, state: &mut State, ws: &mut Workspace, half: f64) {
    for (i, vehicle) in model.vehicles.iter().enumerate() {
        let twist = ws.kin[i].vel[0];
        state.bases[i] = moved_base(vehicle.base, &state.bases[i], &(half * twist.lin), &(half * twist.ang));
    }
    drift_joints(model, state, ws, half);
    drives::place(model, state, state.time + half);
    for (i, vehicle) in model.vehicles.iter().enumerate() {
        let base = ws.base_start[i];
        let kin = &mut ws.kin[i];
        kin.update_positions(&vehicle.tree, &state.bases[i], &state.q[vehicle.q_range()]);
        kin.update_velocities(&vehicle.tree, &base, &state.v[vehicle.v_range()]);
        for body in 0..vehicle.tree.bodies.len() {
            ws.frames[vehicle.body0 + body] = kin.frame(body);
        }
    }
}

/// Midpoint: the second half with the end's velocities.
fn drift_from_midpoint(model: &Model, state: &mut State, ws: &mut Workspace, half: f64) {
    let h = 2.0 * half;
    for (i, vehicle) in model.vehicles.iter().enumerate() {
        let start = ws.base_start[i];
        let mid = start + classical_gain(&ws.base_gain[i], &start, h) * 0.5;
        let gain = Twist::new(ws.base_gain[i].ang, ws.base_gain[i].lin + h * mid.ang.cross(&mid.lin));
        let end = start + gain;
        state.bases[i] = moved_base(vehicle.base, &state.bases[i], &(half * end.lin), &(half * end.ang));
    }
    for k in 0..state.v.len() {
        state.v[k] += ws.v_gain[k];
    }
    drift_joints(model, state, ws, half);
}
