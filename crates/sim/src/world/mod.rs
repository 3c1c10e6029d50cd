//! A model and its state, advancing.

mod account;
mod cut;
mod energy;
mod meet;
mod run;

pub use account::MomentumAudit;
pub use energy::{Energy, EnergyAudit, EnergyBalance, Works};
pub use run::{Controller, Flow, Known, Measured, NoControl, Observer, Perception};

use crate::error::StepError;
use crate::forces::{self, MechanismReport, contacts, drives, effects, mechanisms, memory};
use crate::model::{Integrator, Model, Scheme};
use crate::parts::{Command, MechanismKind, MechanismMemory, Push, calc_offset};
use crate::schemes::{rk4, step};
use crate::state::{ContactMemory, State};
use crate::workspace::{Rest, Workspace, calc_carried, calc_world_momentum};
use friction::Friction;
use multibody::Kinematics;
use spatial::{Frame, Twist, Vec3, Wrench};
use std::sync::Arc;

/// A world that advances step by step.
///
/// After [`World::state_mut`] the next call sees the state as it was left; a clone of [`World::state`] is a snapshot,
/// and a world that continues from it repeats the same bits.
#[derive(Debug)]
pub struct World {
    model: Arc<Model>,
    pub(crate) state: State,
    pub(crate) ws: Workspace,
    /// Scratch of Runge–Kutta's stages.
    rk: rk4::Stages,
    is_fresh: bool,
    pub(crate) integrator: Integrator,
    pub(crate) perception: Option<Arc<dyn Perception>>,
}

/// A touching point, as the last step left it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchReport {
    /// The scene's pair.
    pub pair: usize,
    /// Identity within the pair.
    pub feature: u64,
    /// The contact point in W, m.
    pub point_w: Vec3,
    /// From A to B.
    pub normal_w: Vec3,
    /// Force on B, N.
    pub force_w: Vec3,
    /// Normal part of the law's force, N.
    pub normal_force: f64,
    /// Gap at the step's start, m; negative: penetration.
    pub gap: f64,
    /// Share of the pair's law that acts at the point: 1, but for the samples of a bed.
    pub weight: f64,
    /// Bristle deflection, m.
    pub deflection: f64,
    /// Whether the bristle sticks.
    pub sticks: bool,
}

/// Time over which accelerations are taken, s: 10⁻¹⁰ of a motion's second derivative is missed, 10⁻¹¹ of its rate is round-off.
pub(crate) const GLANCE: f64 = 2e-5;

/// Speeds (m/s) beyond which a run counts as diverged.
const MAX_SPEED: f64 = 1e6;

impl World {
    /// A world at a state.
    pub fn new(model: Arc<Model>, mut state: State) -> Self {
        // A state from before a model had mechanisms knows nothing of them: they begin as at the start.
        let known = state.mechanisms.len();
        state.mechanisms.extend(model.mechanisms.iter().skip(known).map(|m| m.kind.start()));
        // Likewise of effects.
        state.effects.resize(model.effects.n_memory(), 0.0);
        let is_blank = !state.is_settled && memory::is_blank(&model, &state);
        let (ws, rk) = (Workspace::new(&model), rk4::Stages::new(&model));
        let integrator = model.integrator;
        let mut world = Self { model, state, ws, rk, is_fresh: false, integrator, perception: None };
        world.refresh();
        if is_blank && world.ws.parts.has_parts {
            memory::rest_parts(&world.model, &mut world.state, &world.ws);
            world.is_fresh = false;
            world.refresh();
        }
        world
    }

    /// The same world without accounts of energy: [`State::works`] and [`State::account`] say nothing of what it does from now on, and
    /// nothing that moves is any different. For replays that nobody asks what became of the energy.
    pub fn without_books(mut self) -> Self {
        self.ws.keeps_books = false;
        self
    }

    /// The same world advanced by another integrator than its model asks for.
    pub fn with_integrator(mut self, integrator: Integrator) -> Self {
        self.integrator = integrator;
        self
    }

    /// Lets forces beside all laws act from now on, or none.
    pub fn push(&mut self, push: Option<Push>) {
        self.ws.push = push;
    }

    /// The model.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// The state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The state, to be changed.
    pub fn state_mut(&mut self) -> &mut State {
        self.is_fresh = false;
        &mut self.state
    }

    /// The commands that act from now on.
    pub fn commands_mut(&mut self) -> &mut [Command] {
        &mut self.state.commands
    }

    /// Brings kinematics and twists up to a state that was changed.
    pub fn refresh(&mut self) {
        if !self.is_fresh {
            let now = self.state.time;
            self.state.works.resize(self.model.n_works(), 0.0);
            drives::place(&self.model, &mut self.state, now);
            self.update();
            self.is_fresh = true;
        }
    }

    /// Sets base twists (about each base's origin, W axes) at the present poses and rates: writes the momentum. What
    /// effects put inside the bodies comes to rest with them; [`World::set_effect_memory`] moves it.
    pub fn set_base_twists(&mut self, twists: &[Twist]) {
        let now = self.state.time;
        drives::place(&self.model, &mut self.state, now);
        self.ws.update_positions(&self.model, &self.state);
        for (i, vehicle) in self.model.vehicles.iter().enumerate() {
            let kin = &mut self.ws.kin[i];
            kin.update_velocities(&vehicle.tree, &twists[i], &self.state.v[vehicle.v_range()]);
            self.state.momentum[i] = calc_world_momentum(vehicle, kin);
        }
        if self.ws.parts.has_parts {
            memory::rest_parts(&self.model, &mut self.state, &self.ws);
        }
        self.is_fresh = false;
        self.refresh();
    }

    /// Advances by one step of the model.
    pub fn advance(&mut self) -> Result<(), StepError> {
        self.advance_by(self.model.step)
    }

    /// Advances by one step of `h` s; nothing happens unless `h` is above zero.
    ///
    /// Where a delayed command begins to act on the way, the step is made in two; see [`World::next_switch`]. Where dry
    /// joint friction has reversed in it, Runge–Kutta makes it again in parts of 0.2 ms, or of a fifth where that is longer.
    pub fn advance_by(&mut self, h: f64) -> Result<(), StepError> {
        if h.is_nan() || h <= 0.0 {
            return Ok(());
        }
        self.refresh();
        self.ws.backup.copy_from(&self.state);
        let (step, start) = (self.model.step, self.state.time);
        let is_regular = h == step && start == self.state.steps as f64 * step;
        let end = if is_regular { (self.state.steps + 1) as f64 * step } else { start + h };
        let mut left = h;
        // What is left of a stretch in which dry friction turns, and is made in short steps.
        let mut turning = 0.0;
        let may_turn = self.may_turn();
        loop {
            forces::accept(&self.model, &mut self.state);
            self.settle_effects();
            let part = self.calc_part(left, turning, h);
            let is_last = part >= left;
            self.ws.step = part;
            self.ws.end = if is_last { end } else { self.state.time + part };
            if may_turn {
                self.ws.before.copy_from(&self.state);
            }
            self.make_step()?;
            let is_long = turning <= 0.0 && part > effects::longest_turn(h);
            if is_long && may_turn && effects::has_turned(&self.model, &self.ws.before, &self.state) {
                self.state.copy_from(&self.ws.before);
                self.is_fresh = false;
                self.refresh();
                turning = part;
                continue;
            }
            (left, turning) = (left - part, turning - part);
            if is_last {
                self.state.steps += 1;
                return Ok(());
            }
        }
    }

    /// Advances by one step of `h` s if nothing touches in it and no joint leans on its stop; else leaves the world as it was and says `false`.
    ///
    /// What flies freely bears longer steps than what touches: a caller tries a long one, and makes short ones where it fails.
    pub fn advance_free(&mut self, h: f64) -> Result<bool, StepError> {
        if self.ws.touches.is_empty() && !self.leans() {
            self.advance_by(h)?;
            if self.ws.touches.is_empty() && !self.leans() {
                return Ok(true);
            }
            self.ws.touches.clear();
            self.return_to_backup();
        }
        Ok(false)
    }

    /// As [`World::advance_free`] (with joints held: as [`World::advance_resting`]), and shows the world as it was at some ascending instants
    /// within the step. Only Runge–Kutta tells these, to third order in the step, and only of a step that it makes in one.
    ///
    /// What a sensor reads does not cut a flight's step then. The world that is shown is to be read, not asked what acted on it. Nothing may be
    /// so near that it could touch within the step, whichever way the bodies turn: a touch that begins and ends in it would be missed.
    pub fn advance_past(
        &mut self,
        h: f64,
        (rests, instants): (&[Rest], &[f64]),
        mut look: impl FnMut(usize, &Self),
    ) -> Result<bool, StepError> {
        let (start, steps) = (self.state.time, self.state.work.steps);
        let is_cut =
            forces::next_switch(&self.state).is_some_and(|t| t < start + h) || self.may_turn() && !rests.is_empty();
        if self.integrator != Integrator::RungeKutta4 || is_cut || !self.ws.touches.is_empty() {
            return Ok(false);
        }
        self.refresh();
        if contacts::is_near(&self.model, &mut self.ws, h) {
            return Ok(false);
        }
        self.rk.ask(&self.model, instants.iter().map(|t| (t - start) / h));
        let flown = if rests.is_empty() { self.advance_free(h) } else { self.advance_resting(h, rests) };
        self.rk.ask(&self.model, std::iter::empty());
        if !flown? {
            return Ok(false);
        }
        if self.state.work.steps != steps + 1 {
            self.return_to_backup();
            return Ok(false);
        }
        for index in 0..instants.len() {
            std::mem::swap(&mut self.state, self.rk.between(index));
            self.update();
            look(index, self);
            std::mem::swap(&mut self.state, self.rk.between(index));
        }
        self.update();
        Ok(true)
    }

    /// Whether a joint is beyond its range, where its stop, which is stiff, pushes it back.
    fn leans(&self) -> bool {
        self.model.coordinates.iter().zip(&self.state.q).any(|(c, q)| c.depth_at_stop(*q) > 0.0)
    }

    /// Back to where the last step began.
    pub(crate) fn return_to_backup(&mut self) {
        self.state.copy_from(&self.ws.backup);
        self.is_fresh = false;
        self.refresh();
    }

    /// Kinematics and twists of the present state.
    fn update(&mut self) {
        self.ws.update_positions(&self.model, &self.state);
        self.ws.update_velocities(&self.model, &self.state);
    }

    /// As [`World::advance_free`], with some joints held where they are, under Runge–Kutta. Where one of them moves, or would be set in
    /// motion by more than it may, the world stays as it was, and the answer is `false`.
    ///
    /// Momentum is untouched: the vehicle moves on as one with them.
    pub fn advance_resting(&mut self, h: f64, rests: &[Rest]) -> Result<bool, StepError> {
        let moves = |rest: &Rest| self.state.v[rest.coordinate].abs() > rest.speed;
        if self.integrator != Integrator::RungeKutta4 || rests.iter().any(moves) || !self.ws.touches.is_empty() {
            return Ok(false);
        }
        self.ws.held.clear();
        for rest in rests {
            let v = std::mem::take(&mut self.state.v[rest.coordinate]);
            self.ws.held.push((*rest, v));
        }
        (self.is_fresh, self.ws.unrest) = (false, 0.0);
        let flown = self.advance_free(h);
        let held = std::mem::take(&mut self.ws.held);
        if matches!(flown, Ok(true)) && self.ws.unrest <= 1.0 {
            self.ws.held = held;
            self.ws.held.clear();
            return Ok(true);
        }
        if matches!(flown, Ok(true)) {
            self.state.copy_from(&self.ws.backup);
        }
        held.iter().for_each(|(rest, v)| self.state.v[rest.coordinate] = *v);
        self.is_fresh = false;
        self.refresh();
        flown.map(|_| false)
    }

    /// The effects' memory in the coordinates of [`crate::memory_layout`], at the last refreshed state.
    pub fn effect_memory(&self) -> Vec<f64> {
        memory::calc_relative(&self.model, &self.state, &self.ws)
    }

    /// Sets the effects' memory from the coordinates of [`crate::memory_layout`]; missing ones are zero. Every body keeps
    /// its twist, and the momentum becomes what belongs to it.
    pub fn set_effect_memory(&mut self, relative: &[f64]) {
        self.refresh();
        memory::set_relative(&self.model, &mut self.state, &self.ws, relative);
        self.is_fresh = false;
        self.refresh();
    }

    /// The share of what is left of a step that is made in one: up to the next switch, and shorter while friction turns.
    fn calc_part(&self, left: f64, turning: f64, h: f64) -> f64 {
        let to_switch = forces::next_switch(&self.state).map_or(left, |t| (t - self.state.time).min(left));
        if turning <= 0.0 {
            return to_switch;
        }
        let (part, longest) = (to_switch.min(turning), effects::longest_turn(h));
        // The last part may be a rounding error longer.
        let part = if part <= longest * (1.0 + 1e-9) { part } else { part / (part / longest - 1e-9).ceil() };
        if left - part < 1e-9 * h { left } else { part }
    }

    /// When the next command that an effect delays begins to act, s; none where none is on its way.
    pub fn next_switch(&self) -> Option<f64> {
        forces::next_switch(&self.state)
    }

    /// Tells what was commanded before the present time, in order of time: commands that an effect delays act from now on
    /// as if the world had run through them. The present commands are left as they are.
    pub fn recall_commands<'a>(&mut self, past: impl IntoIterator<Item = (f64, &'a [Command])>) {
        let (now, present) = (self.state.time, self.state.commands.clone());
        self.state.acting.clear();
        self.state.pending.clear();
        for (time, commands) in past {
            self.state.time = time;
            self.state.commands.copy_from_slice(commands);
            forces::accept(&self.model, &mut self.state);
        }
        (self.state.time, self.state.commands) = (now, present);
    }

    /// Sets the effects' memory as if all had stood as it is for long: a gear that yields carries what holds its joint
    /// still (on a vehicle that moves as a whole: the drive's effort), a lag has passed. The first step does it by itself;
    /// a caller who wants to start from other memory calls this before and changes [`State::effects`] then.
    pub fn settle_effects(&mut self) {
        if !self.state.is_settled {
            self.refresh();
            forces::settle(&self.model, &mut self.state, &mut self.ws);
            self.state.is_settled = true;
        }
    }

    /// What encoder and tachometer of a coordinate read without fault, rad and rad/s, or m and m/s: the motor side where
    /// a gear yields, else the joint itself.
    pub fn motor_side(&self, coordinate: usize) -> (f64, f64) {
        self.model.calc_motor_side(&self.state, coordinate)
    }

    /// Whether the motors of a coordinate gave less than was asked in the last step, since they turn as fast as they may.
    pub fn is_speed_limited(&self, coordinate: usize) -> bool {
        self.ws.coordinate_forces[coordinate].is_limited
    }

    /// Whether dry friction could turn within a step, and the integrator would feel its corner.
    fn may_turn(&self) -> bool {
        self.integrator == Integrator::RungeKutta4 && effects::has_dry(&self.model)
    }

    fn make_step(&mut self) -> Result<(), StepError> {
        let (model, state, ws) = (&*self.model, &mut self.state, &mut self.ws);
        match self.integrator {
            Integrator::ImplicitEuler => step::step(model, state, ws, Scheme::ImplicitEuler),
            Integrator::ImplicitMidpoint => step::step(model, state, ws, Scheme::ImplicitMidpoint),
            Integrator::SemiImplicitEuler => step::step(model, state, ws, Scheme::SemiImplicitEuler),
            Integrator::RungeKutta4 => rk4::step(model, state, ws, &mut self.rk),
        }
        self.check_finite()
    }

    fn check_finite(&mut self) -> Result<(), StepError> {
        for (i, vehicle) in self.model.vehicles.iter().enumerate() {
            // (a + b)² ≤ 2 (a² + b²) says without a root that all is well; NaN does not pass.
            let is_calm = |t: &Twist| 2.0 * (t.lin.norm_squared() + t.ang.norm_squared()) <= MAX_SPEED * MAX_SPEED;
            for (local, twist) in self.ws.kin[i].vel.iter().enumerate().filter(|(_, t)| !is_calm(t)) {
                let size = twist.lin.norm() + twist.ang.norm();
                if size.is_nan() || size > MAX_SPEED {
                    let time = self.state.time;
                    let body = self.model.body_name(vehicle.body0 + local);
                    let quantity = format!("speed {size:.3e}");
                    self.return_to_backup();
                    return Err(StepError::Diverged { time, body, quantity, last_good: self.state.time });
                }
            }
        }
        Ok(())
    }

    /// Momentum of the parts that effects put inside a vehicle's bodies, about W's origin, W axes.
    pub(crate) fn carried_momentum(&self, vehicle: usize) -> Wrench {
        let kin = &self.ws.kin[vehicle];
        calc_carried(&self.model, &self.state, vehicle, kin).about(&-kin.anchor)
    }

    /// Kinematics of all vehicles at the present state.
    pub(crate) fn all_kinematics(&self) -> &[Kinematics] {
        &self.ws.kin
    }

    /// Kinematics of a vehicle at the present state.
    pub fn kinematics(&self, vehicle: usize) -> &Kinematics {
        &self.ws.kin[vehicle]
    }

    /// Frame of a global body in W.
    pub fn frame(&self, body: usize) -> Frame {
        self.ws.frames[body]
    }

    /// Frame of a vehicle's link in W.
    pub fn link_frame(&self, vehicle: usize, link: usize) -> Frame {
        self.ws.kin[vehicle].link_frame(&self.model.vehicles[vehicle].tree, link)
    }

    /// Twist of a vehicle's link about its own origin, W axes.
    pub fn link_twist(&self, vehicle: usize, link: usize) -> Twist {
        self.ws.kin[vehicle].link_twist(&self.model.vehicles[vehicle].tree, link)
    }

    /// The same world under Runge–Kutta and without books, to look ahead with.
    pub(crate) fn fork(&self) -> Self {
        let fork = Self::new(Arc::clone(&self.model), self.state.clone());
        let mut fork = fork.without_books().with_integrator(Integrator::RungeKutta4);
        fork.ws.push.clone_from(&self.ws.push);
        fork
    }

    /// Rate of change of a link's twist about its own origin, W axes, m/s² and rad/s², from this instant on with the commands that act.
    ///
    /// By differences of motion over 20 µs and twice that under Runge–Kutta, second order: with all that acts, whatever it is. The world itself stays
    /// where it is. None where it would diverge.
    pub fn calc_link_acceleration(&self, vehicle: usize, link: usize) -> Option<Twist> {
        let mut ahead = self.fork();
        let before = ahead.link_twist(vehicle, link);
        let mut glance = || ahead.advance_by(GLANCE).ok().map(|()| ahead.link_twist(vehicle, link) - before);
        let (near, far) = (glance()?, glance()?);
        Some((near * 4.0 - far) * (0.5 / GLANCE))
    }

    /// Work since the start of every actuator, drive and effect, J.
    pub fn works(&self) -> Works<'_> {
        let (actuators, rest) = self.state.works.split_at(self.model.actuators.len());
        let (drives, rest) = rest.split_at(self.model.drives.len());
        let (effects, forces) = rest.split_at(self.model.effects.list.len());
        Works { actuators, drives, effects, forces }
    }

    /// Effort that acted on a coordinate in the last step, N·m or N (actuators and passive laws).
    pub fn effort(&self, coordinate: usize) -> f64 {
        self.ws.coordinate_forces[coordinate].effort
    }

    /// External wrench on a global body in the last step, about its vehicle's anchor, W axes.
    pub fn external_wrench(&self, body: usize) -> Wrench {
        self.ws.external[body]
    }

    /// The mechanisms at the present state.
    pub fn mechanisms(&self) -> impl Iterator<Item = MechanismReport> + '_ {
        self.state.mechanisms.iter().enumerate().take(self.model.mechanisms.len()).map(|(i, memory)| {
            let sides = mechanisms::calc_sides(&self.model, &self.ws, i);
            forces::calc_report(&self.model, i, &sides, memory, self.state.time)
        })
    }

    /// Takes the present relative pose of a weld's or latch's frames for its rest, and engages it: nothing is stored.
    /// A bushing keeps its nominal rest, a strut its length.
    pub fn rest_mechanism(&mut self, index: usize) {
        self.refresh();
        let kind = self.model.mechanisms.get(index).map(|m| m.kind);
        if let Some(MechanismKind::Weld(_) | MechanismKind::Latch(_)) = kind {
            let sides = mechanisms::calc_sides(&self.model, &self.ws, index);
            let (since, offset) = (self.state.time, calc_offset(&sides));
            if let Some(memory) = self.state.mechanisms.get_mut(index) {
                *memory = MechanismMemory { since, offset, ..MechanismMemory::default() };
            }
        }
    }

    /// Evaluates contact at the present state, so that [`Self::touches`] tells the forces of this instant and not those
    /// of the step that led to it: what a force sensor reads now. Nothing advances.
    pub fn refresh_touches(&mut self) {
        self.refresh();
        rk4::refresh_touches(&self.model, &self.state, &mut self.ws);
    }

    /// Gives the points that touch at the present state their bristles: `seed` of a point is its deflection, W axes, m, of which the part
    /// in its tangent plane counts, and the time for which it has stuck, s. Points of laws without memory are passed over.
    pub fn seed_bristles(&mut self, seed: impl Fn(usize, &TouchReport) -> (Vec3, f64)) {
        self.state_mut().bristles.clear();
        self.refresh_touches();
        let reports: Vec<TouchReport> = self.touches().collect();
        let mut seeded = 0;
        for (touch, report) in self.ws.touches.iter().zip(&reports) {
            if !self.model.laws[touch.pair as usize].remembers() || report.gap >= 0.0 {
                continue;
            }
            let ((s, stuck), normal_w) = (seed(seeded, report), touch.normal);
            let rest = match self.model.laws[touch.pair as usize].friction {
                Some(Friction::Bristle(law)) => law.levels().calc_rested(stuck),
                _ => touch.rest,
            };
            seeded += 1;
            self.state.bristles.push(ContactMemory {
                pair: touch.pair,
                feature: touch.feature,
                s_w: s - normal_w * normal_w.dot(&s),
                normal_w,
                turn_w: Vec3::zeros(),
                rest,
                point_b: touch.local_b,
                weight: touch.weight,
            });
        }
        self.state.bristles.sort_by_key(|m| (m.pair, m.feature));
    }

    /// The points that touched in the last step.
    pub fn touches(&self) -> impl Iterator<Item = TouchReport> + '_ {
        self.ws.touches.iter().map(|t| TouchReport {
            pair: t.pair as usize,
            feature: t.feature,
            point_w: t.point,
            normal_w: t.normal,
            force_w: t.out.force,
            normal_force: t.out.normal_force,
            gap: t.gap,
            weight: t.weight,
            deflection: t.out.s.norm(),
            sticks: t.out.sticks,
        })
    }
}
