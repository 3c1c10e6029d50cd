//! Spin and rolling resistance of touching points within a step: the moments beside the forces of `contacts`.
//!
//! A pair with a [`friction::Pivot`] gives each of its points an angular deflection θ, carried like the bristle's:
//!
//!   θ⁺ = θ_base + β ω',      m = pivot(θ⁺, fₙ),      G = h β (−∂m/∂θ⁺)        ω: of B against A, W axes
//!
//! with β and θ_base as for the contact's own law. Moments act on both bodies alike and change no force balance; angular
//! momentum takes the same numbers on both sides. Runge–Kutta holds them through a step: there they are of first order.

use crate::model::Model;
use crate::state::State;
use crate::workspace::{PivotTouch, Workspace, world_wrench};
use friction::{PivotMoment, Turn};
use spatial::{Mat3, SpatialMatrix, Vec3, Wrench};

/// Relative difference between a line's moment and the law's that asks for a new solve, and what is round-off, N·m.
const TOLERANCE: (f64, f64) = (1e-3, 1e-12);

fn spin_of(model: &Model, ws: &Workspace, body: usize) -> Vec3 {
    model.owners.get(body).map_or(Vec3::zeros(), |&(vehicle, local)| ws.kin[vehicle].vel[local].ang)
}

/// Lists them; touches hold the carried deflections.
pub(crate) fn find_pivots(model: &Model, ws: &mut Workspace) {
    ws.pivots.clear();
    for (index, touch) in ws.touches.iter().enumerate() {
        if model.laws[touch.pair as usize].pivot.is_none() {
            continue;
        }
        let rate = spin_of(model, ws, touch.body_b) - spin_of(model, ws, touch.body_a);
        ws.pivots.push(PivotTouch {
            touch: index,
            pair: touch.pair,
            weight: touch.weight,
            bodies: [touch.body_a, touch.body_b],
            start: touch.turn,
            rate,
            base: touch.turn,
            beta: 0.0,
            elapsed: 1.0,
            normal: touch.normal,
            trial: touch.turn,
            out: PivotMoment::default(),
            line: Vec3::zeros(),
            slope: Mat3::zeros(),
            moment: Vec3::zeros(),
        });
    }
}

impl PivotTouch {
    /// Evaluates the law at the angular velocity `rate + gain`, and draws the line for the next solve.
    fn eval(&mut self, model: &Model, ws: &Workspace, gain: &Vec3) {
        let touch = &ws.touches[self.touch];
        let laws = model.laws[touch.pair as usize].weighted(touch.weight);
        let Some(law) = &laws.pivot else { return };
        let trial = self.base + self.beta * (self.rate + gain);
        self.trial = trial;
        let (normal, normal_force) = (touch.normal, touch.out.normal_force);
        self.out = law.eval(&Turn { start: self.start, trial, normal, elapsed: self.elapsed, normal_force });
        let about_normal = self.out.spin_slope * (normal * normal.transpose());
        self.slope = self.beta * (about_normal + self.out.rolling_slope.calc_matrix(&normal));
        self.line = self.out.moment + self.slope * gain;
    }

    /// Of its angular bristles, N·m/rad.
    fn stiffness(&self, model: &Model) -> f64 {
        model.laws[self.pair as usize].pivot.as_ref().map_or(0.0, |p| self.weight * p.stiffness)
    }

    fn gain(&self, ws: &Workspace) -> Vec3 {
        ws.dvel[self.bodies[1]].ang - ws.dvel[self.bodies[0]].ang
    }
}

impl PivotTouch {
    /// What the law takes for good in a step of `h`, J.
    fn calc_loss(&self, model: &Model, h: f64) -> f64 {
        let turned = (self.trial - self.start) * (h / self.elapsed);
        let end = self.end_turn(h);
        -self.out.moment.dot(&turned) - self.stiffness(model) * self.out.turn.dot(&(end - self.start))
    }

    /// Angular deflection at the end of a step of `h`: what sticks at mid-step goes on to there, what slips stays as its law left it.
    fn end_turn(&self, h: f64) -> Vec3 {
        let slipped = self.trial - self.out.turn;
        let went_on =
            |along: &Vec3, slip: &Vec3| if slip.norm() <= ON_BOUND * along.norm() { h / self.elapsed } else { 1.0 };
        let split = |v: &Vec3| (self.normal * self.normal.dot(v), v - self.normal * self.normal.dot(v));
        let ((spin, roll), (spin_slip, roll_slip)) = (split(&(self.out.turn - self.start)), split(&slipped));
        self.start + spin * went_on(&spin, &spin_slip) + roll * went_on(&roll, &roll_slip)
    }
}

/// Share of a deflection's change that counts as no slip: round-off.
const ON_BOUND: f64 = 1e-9;

/// Decides where the laws are evaluated, as the contact's own was, and draws the first lines.
pub(crate) fn place(model: &Model, ws: &mut Workspace, h: f64) {
    for i in 0..ws.pivots.len() {
        let mut pivot = ws.pivots[i];
        let at = ws.touches[pivot.touch].place;
        let resolved_midpoint = at.theta == 0.5;
        (pivot.beta, pivot.elapsed) = (at.beta, at.elapsed);
        pivot.base = match (at.beta == 0.0, resolved_midpoint) {
            (true, _) => pivot.start + h * pivot.rate,
            (false, true) => pivot.start + 0.25 * h * pivot.rate,
            (false, false) => pivot.start,
        };
        pivot.eval(model, ws, &Vec3::zeros());
        pivot.moment = pivot.line;
        ws.pivots[i] = pivot;
    }
}

/// Explicit evaluation, as Runge–Kutta's stages take it, `elapsed` s after the step's start.
pub(crate) fn eval_explicit(model: &Model, ws: &mut Workspace, elapsed: f64) {
    find_pivots(model, ws);
    for i in 0..ws.pivots.len() {
        let mut pivot = ws.pivots[i];
        (pivot.base, pivot.elapsed) = (pivot.start + elapsed * pivot.rate, ws.step);
        pivot.eval(model, ws, &Vec3::zeros());
        pivot.moment = pivot.line;
        ws.pivots[i] = pivot;
    }
}

/// Adds what one body's own gain gives, to the inertia of the bodies.
pub(crate) fn add_stiffness(model: &Model, ws: &mut Workspace, h: f64) {
    for pivot in &ws.pivots {
        for body in pivot.bodies.into_iter().filter(|b| *b < model.owners.len()) {
            *ws.extra[body].get_or_insert_default() += calc_matrix(pivot, h);
        }
    }
}

/// The bodies of pivot `k` and the matrix between them, if both move.
pub(crate) fn calc_cross(model: &Model, ws: &Workspace, k: usize, h: f64) -> Option<([usize; 2], SpatialMatrix)> {
    let pivot = &ws.pivots[k];
    let both = pivot.bodies.iter().all(|b| *b < model.owners.len());
    (both && pivot.slope != Mat3::zeros()).then(|| (pivot.bodies, calc_matrix(pivot, h)))
}

fn calc_matrix(pivot: &PivotTouch, h: f64) -> SpatialMatrix {
    SpatialMatrix { ma: h * pivot.slope, ..SpatialMatrix::default() }
}

/// Adds the lines' moments at zero gain to both bodies.
pub(crate) fn add_moments(model: &Model, ws: &mut Workspace) {
    for pivot in &ws.pivots {
        for (body, sign) in pivot.bodies.into_iter().zip([-1.0, 1.0]).filter(|(b, _)| *b < model.owners.len()) {
            ws.contact[body] += Wrench::new(sign * pivot.line, Vec3::zeros());
        }
    }
}

/// Compares lines with laws at the solution; where one missed, the next line is drawn. `true` if none did.
pub(crate) fn laws_hold(model: &Model, ws: &mut Workspace) -> bool {
    let mut hold = true;
    for i in 0..ws.pivots.len() {
        let mut pivot = ws.pivots[i];
        let gain = pivot.gain(ws);
        let on_line = pivot.line - pivot.slope * gain;
        pivot.eval(model, ws, &gain);
        hold &= (pivot.out.moment - on_line).norm() <= TOLERANCE.0 * pivot.out.moment.norm() + TOLERANCE.1;
        pivot.moment = on_line;
        ws.pivots[i] = pivot;
    }
    hold
}

/// Angular momentum and account.
pub(crate) fn add_impulses(model: &Model, state: &mut State, ws: &Workspace, h: f64) {
    for pivot in &ws.pivots {
        for (body, sign) in pivot.bodies.into_iter().zip([-1.0, 1.0]) {
            let Some(&(vehicle, _)) = model.owners.get(body) else { continue };
            let (owner, anchor) = (&model.vehicles[vehicle], ws.kin[vehicle].anchor);
            let impulse = Wrench::new(sign * h * pivot.moment, Vec3::zeros());
            state.momentum[vehicle] += world_wrench(owner, &anchor, &impulse);
        }
        let (gain, is_stage) = (pivot.gain(ws), ws.since.is_some());
        let work = h * pivot.moment.dot(&(pivot.rate + ws.gain_share * gain));
        state.account.contact_work += work;
        state.account.contact_to_motion += h * pivot.moment.dot(&(pivot.rate + 0.5 * gain));
        state.account.contact_intake += (-work).max(0.0);
        state.account.contact_loss += if is_stage { -work } else { pivot.calc_loss(model, h) };
    }
}

/// What became of the deflections, for the touches' memories; in the plane of detection.
pub(crate) fn commit(ws: &mut Workspace) {
    for pivot in &ws.pivots {
        let is_stage = ws.since.is_some();
        ws.touches[pivot.touch].turn = if is_stage { pivot.out.turn } else { pivot.end_turn(ws.step) };
    }
}
