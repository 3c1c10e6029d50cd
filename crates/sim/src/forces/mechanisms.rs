//! Mechanisms within a step: where each law is evaluated, its line, and what it adds to matrix, right side and books.
//!
//! A coordinate's law is evaluated at the predicted rate ė' = ė + b·dV + carried, as contact is:
//!
//!   e' = e_base + β ė',   rate = (1 − θ) ė + θ ė'        (β, θ and e_base: table in `contacts`)
//!   line: f(dV) = f₀ − (β k + θ c) b·dV
//!
//! Gains dV are spatial, those of the velocity field at a place fixed in W; `carried` is h (ω_b × v_b − ω_a × v_a), by which
//! the material points' gains differ, so that a drifting world looks the same: with ω and v of the two origins for the
//! end of the step; with those of the vehicles' bases at mid-step, where the lever arms have turned already.

use super::mechanism_report::calc_report;
use crate::model::{Model, Scheme};
use crate::parts::{ActuatorKind, Base, Deformation, MAX_ROWS, Moment, RowForce, Rows, Side};
use crate::state::State;
use crate::workspace::{Coupling, Workspace, world_wrench};
use spatial::{SpatialMatrix, Twist, Vec3, Wrench};

/// Relative difference between a line's force and the law's that asks for a new solve.
const LAW_TOLERANCE: f64 = 1e-3;

/// Force (N or N·m) below which a difference is round-off.
const FORCE_FLOOR: f64 = 1e-10;

/// Largest h² k/m, and largest h c/m, at which the midpoint rule resolves a coordinate.
const RESOLVED: (f64, f64) = (0.1, 2.0);

/// The two sides of mechanism `index` at the kinematics that `ws` holds.
pub(crate) fn calc_sides(model: &Model, ws: &Workspace, index: usize) -> [Side; 2] {
    model.mechanism_sides[index].map(|(body, frame_bs)| {
        let frame = &ws.frames[body] * &frame_bs;
        let twist = model.owners.get(body).map_or(Twist::default(), |&(vehicle, local)| {
            let kin = &ws.kin[vehicle];
            kin.vel[local].about(&(frame.pos - kin.anchor))
        });
        Side { frame, twist }
    })
}

/// Lists the acting mechanisms at the present frames.
pub(crate) fn find_couplings(model: &Model, state: &State, ws: &mut Workspace) {
    ws.couplings.clear();
    for (index, (mechanism, memory)) in model.mechanisms.iter().zip(&state.mechanisms).enumerate() {
        let sides = calc_sides(model, ws, index);
        let Some(at) = mechanism.kind.calc_deformation(&sides, memory, state.time) else { continue };
        let bodies = model.mechanism_sides[index].map(|(body, _)| body);
        let rows = bodies.map(|body| about_anchor(model, ws, body, &at));
        let mut coupling = Coupling {
            index,
            bodies,
            at,
            rows,
            origins: sides.map(|s| s.frame.pos),
            rate: at.rest_rate,
            carried: [0.0; MAX_ROWS],
            base: at.e,
            beta: 0.0,
            theta: 0.0,
            law: [RowForce::default(); MAX_ROWS],
            line: [0.0; MAX_ROWS],
            slope: [0.0; MAX_ROWS],
            force: [0.0; MAX_ROWS],
        };
        let speed = coupling.calc_relative(|body| vel_of(model, ws, body));
        coupling.rate.iter_mut().zip(speed).for_each(|(rate, s)| *rate += s);
        ws.couplings.push(coupling);
    }
}

fn about_anchor(model: &Model, ws: &Workspace, body: usize, at: &Deformation) -> [Wrench; MAX_ROWS] {
    let Some(&(vehicle, _)) = model.owners.get(body) else { return [Wrench::default(); MAX_ROWS] };
    let r = ws.kin[vehicle].anchor - at.point;
    at.rows.map(|row| row.about(&r))
}

/// Twist about the anchor of the body's vehicle.
fn vel_of(model: &Model, ws: &Workspace, body: usize) -> Twist {
    model.owners.get(body).map_or(Twist::default(), |&(vehicle, local)| ws.kin[vehicle].vel[local])
}

impl Coupling {
    /// What twists (about the anchors) of the two bodies give in the coordinates.
    fn calc_relative(&self, twist_of: impl Fn(usize) -> Twist) -> Rows {
        let [a, b] = self.bodies.map(twist_of);
        let mut out = [0.0; MAX_ROWS];
        for (i, x) in out.iter_mut().enumerate().take(self.at.n) {
            *x = b.dot(&self.rows[1][i]) - a.dot(&self.rows[0][i]);
        }
        out
    }

    fn calc_gain(&self, ws: &Workspace) -> Rows {
        self.calc_relative(|body| ws.dvel[body])
    }

    fn calc_carried(&self, model: &Model, ws: &Workspace, at_end: bool) -> Rows {
        let [a, b] = [0, 1].map(|k| {
            let Some(&(vehicle, local)) = model.owners.get(self.bodies[k]) else { return Vec3::zeros() };
            let kin = &ws.kin[vehicle];
            let (twist, arm) =
                if at_end { (kin.vel[local], self.origins[k] - kin.anchor) } else { (kin.vel[0], Vec3::zeros()) };
            twist.ang.cross(&twist.at(&arm))
        });
        self.at.rows.map(|row| ws.step * row.force.dot(&(b - a)))
    }

    /// Evaluates the laws at the gains, and draws the lines for the next solve.
    fn eval(&mut self, model: &Model, gain: &Rows) {
        let kind = &model.mechanisms[self.index].kind;
        for (i, gain) in gain.iter().enumerate().take(self.at.n) {
            let next = self.rate[i] + gain + self.carried[i];
            let e = self.base[i] + self.beta * next;
            let law = kind.eval(i, e, (1.0 - self.theta) * self.rate[i] + self.theta * next);
            self.slope[i] = self.beta * law.stiffness + self.theta * law.damping;
            self.line[i] = law.force + self.slope[i] * gain;
            self.law[i] = law;
        }
    }

    /// Wrench on B about the point of action.
    fn calc_wrench(&self, force: &Rows) -> Wrench {
        self.at.rows.iter().zip(force).fold(Wrench::default(), |sum, (row, f)| sum + *row * *f)
    }

    /// Whether lines and laws agree, measured by the largest of the rotations and of the translations.
    fn holds(&self, gain: &Rows) -> bool {
        let groups = if self.at.n == MAX_ROWS { [0..3, 3..6] } else { [0..self.at.n, 0..0] };
        groups.into_iter().all(|group| {
            let (mut miss, mut size, mut rounding) = (0.0_f64, 0.0_f64, FORCE_FLOOR);
            for i in group {
                let (law, on_line) = (&self.law[i], self.line[i] - self.slope[i] * gain[i]);
                miss = miss.max((law.force - on_line).abs());
                size = size.max(law.force.abs());
                // A hard spring makes a force of the last bit of its length.
                rounding += 8.0 * f64::EPSILON * law.stiffness * self.at.e[i].abs();
            }
            miss <= LAW_TOLERANCE * size + rounding
        })
    }

    /// Whether a coordinate moves too fast for the midpoint rule: h² k/m or h c/m, with the two bodies as if free.
    fn is_stiff(&self, model: &Model, ws: &Workspace) -> bool {
        let (h, kind) = (ws.step, &model.mechanisms[self.index].kind);
        (0..self.at.n).any(|i| {
            let mobility: f64 = (0..2).map(|k| calc_mobility(model, ws, self.bodies[k], &self.rows[k][i])).sum();
            let stiffness = kind.calc_stiffness_within(i, self.at.e[i], 2.0 * h * self.rate[i].abs());
            h * h * stiffness * mobility > RESOLVED.0 || h * self.law[i].damping * mobility > RESOLVED.1
        })
    }
}

/// Gain of a coordinate per generalised impulse on one body alone, 1/kg or 1/(kg·m²).
fn calc_mobility(model: &Model, ws: &Workspace, body: usize, row: &Wrench) -> f64 {
    let Some(&(vehicle, local)) = model.owners.get(body) else { return 0.0 };
    if *row == Wrench::default() || (local == 0 && model.vehicles[vehicle].base.is_held()) {
        return 0.0;
    }
    ws.kin[vehicle].inertia[local].twist_of(row).map_or(f64::INFINITY, |twist| twist.dot(row))
}

/// Decides where the laws are evaluated, and draws the first lines.
pub(crate) fn place(model: &Model, ws: &mut Workspace, scheme: Scheme) {
    let h = ws.step;
    for k in 0..ws.couplings.len() {
        let mut coupling = ws.couplings[k];
        coupling.carried = coupling.calc_carried(model, ws, scheme != Scheme::ImplicitMidpoint);
        coupling.eval(model, &[0.0; MAX_ROWS]);
        let resolved = scheme == Scheme::ImplicitMidpoint && !coupling.is_stiff(model, ws);
        (coupling.beta, coupling.theta) = match scheme {
            Scheme::SemiImplicitEuler => (0.0, 0.0),
            Scheme::ImplicitMidpoint if resolved => (0.25 * h, 0.5),
            Scheme::ImplicitEuler | Scheme::ImplicitMidpoint => (h, 1.0),
        };
        if resolved {
            for i in 0..coupling.at.n {
                coupling.base[i] = coupling.at.e[i] - 0.25 * h * coupling.rate[i];
            }
        }
        coupling.eval(model, &[0.0; MAX_ROWS]);
        coupling.force = coupling.line;
        ws.couplings[k] = coupling;
    }
}

/// Explicit evaluation, as Runge–Kutta's stages take it.
pub(crate) fn eval_explicit(model: &Model, state: &State, ws: &mut Workspace) {
    find_couplings(model, state, ws);
    for coupling in &mut ws.couplings {
        coupling.eval(model, &[0.0; MAX_ROWS]);
        coupling.force = coupling.line;
    }
}

/// Takes the velocities at mid-step, which `ws` holds, for what the motion carries.
pub(crate) fn update_carried(model: &Model, ws: &mut Workspace) {
    for k in 0..ws.couplings.len() {
        let carried = ws.couplings[k].calc_carried(model, ws, false);
        let coupling = &mut ws.couplings[k];
        for (i, carried) in carried.iter().enumerate() {
            coupling.line[i] -= coupling.slope[i] * (carried - coupling.carried[i]);
        }
        coupling.carried = carried;
    }
}

/// Adds what one body's own gain gives, to the inertia of the bodies.
pub(crate) fn add_stiffness(model: &Model, ws: &mut Workspace, h: f64) {
    for coupling in &ws.couplings {
        for (k, body) in coupling.bodies.into_iter().enumerate().filter(|(_, b)| *b < model.owners.len()) {
            *ws.extra[body].get_or_insert_default() += coupling.calc_matrix(k, k, h);
        }
    }
}

/// The bodies of coupling `k` and the matrix between them, if both move.
pub(crate) fn calc_cross(model: &Model, ws: &Workspace, k: usize, h: f64) -> Option<([usize; 2], SpatialMatrix)> {
    let coupling = &ws.couplings[k];
    let matrix = coupling.calc_matrix(0, 1, h);
    let both = coupling.bodies.iter().all(|b| *b < model.owners.len());
    (both && matrix != SpatialMatrix::default()).then_some((coupling.bodies, matrix))
}

impl Coupling {
    /// h Σ slope b_k b_lᵀ, about the anchors of sides k and l.
    fn calc_matrix(&self, k: usize, l: usize, h: f64) -> SpatialMatrix {
        let mut sum = SpatialMatrix::default();
        for i in (0..self.at.n).filter(|i| self.slope[*i] != 0.0) {
            let (left, right) = (self.rows[k][i] * (h * self.slope[i]), self.rows[l][i]);
            sum += SpatialMatrix {
                ma: left.moment * right.moment.transpose(),
                ml: left.moment * right.force.transpose(),
                fa: left.force * right.moment.transpose(),
                fl: left.force * right.force.transpose(),
            };
        }
        sum
    }
}

/// Adds the lines' wrenches to both bodies, at zero gain of all that forces move.
pub(crate) fn add_wrenches(model: &Model, ws: &mut Workspace) {
    for coupling in &ws.couplings {
        let driven = match model.drives.is_empty() {
            true => [0.0; MAX_ROWS],
            false => coupling.calc_relative(|body| ws.drive_gain_of(model, body)),
        };
        for (k, sign) in [(0, -1.0), (1, 1.0)] {
            let body = coupling.bodies[k];
            if body < model.owners.len() {
                for (i, row) in coupling.rows[k].iter().enumerate() {
                    let force = coupling.line[i] - coupling.slope[i] * driven[i];
                    ws.contact[body] += *row * (sign * force);
                }
            }
        }
    }
}

/// Compares lines with laws at the solution; where one missed, the next line is drawn. `true` if none did.
pub(crate) fn laws_hold(model: &Model, ws: &mut Workspace) -> bool {
    let mut hold = true;
    for k in 0..ws.couplings.len() {
        let mut coupling = ws.couplings[k];
        let gain = coupling.calc_gain(ws);
        let before = coupling;
        coupling.eval(model, &gain);
        hold &= Coupling { law: coupling.law, ..before }.holds(&gain);
        for (i, gain) in gain.iter().enumerate() {
            coupling.force[i] = before.line[i] - before.slope[i] * gain;
        }
        ws.couplings[k] = coupling;
    }
    hold
}

/// Momentum and accounts: the same numbers on both sides, works at the mean rate of the step.
pub(crate) fn add_impulses(model: &Model, state: &mut State, ws: &Workspace, h: f64) {
    for coupling in &ws.couplings {
        let impulse = coupling.calc_wrench(&coupling.force) * h;
        let about_origin = impulse.about(&-coupling.at.point);
        add_impulse(model, state, ws, (coupling.bodies[0], &coupling.at.point), (&-impulse, &-about_origin));
        add_impulse(model, state, ws, (coupling.bodies[1], &coupling.at.point), (&impulse, &about_origin));
        let gain = coupling.calc_gain(ws);
        for (i, gain) in gain.iter().enumerate().take(coupling.at.n) {
            let force = h * coupling.force[i];
            state.account.mechanism_work += force * (coupling.rate[i] + ws.gain_share * gain);
            state.account.pull_in_work -= force * coupling.at.rest_rate[i];
            state.account.mechanism_loss += h * coupling.law[i].loss;
        }
    }
}

/// An impulse about the point of action and about W's origin, into the momentum of a body's vehicle.
fn add_impulse(
    model: &Model,
    state: &mut State,
    ws: &Workspace,
    (body, point): (usize, &Vec3),
    (about_point, about_origin): (&Wrench, &Wrench),
) {
    let Some(&(vehicle, _)) = model.owners.get(body) else { return };
    let owner = &model.vehicles[vehicle];
    if matches!(owner.base, Base::Free | Base::Driven(_)) {
        state.momentum[vehicle] += *about_origin;
    } else if owner.base != Base::Fixed {
        let anchor = ws.kin[vehicle].anchor;
        state.momentum[vehicle] += world_wrench(owner, &anchor, &about_point.about(&(anchor - point)));
    }
}

/// Revises the memories after an accepted step, whose end `ws` holds. What a hold had stored when it let go is lost.
pub(crate) fn commit(model: &Model, state: &mut State, ws: &Workspace) {
    for (index, mechanism) in model.mechanisms.iter().enumerate() {
        let Some(memory) = state.mechanisms.get(index).copied() else { return };
        if !mechanism.kind.remembers() {
            continue;
        }
        let sides = calc_sides(model, ws, index);
        let report = calc_report(model, index, &sides, &memory, state.time);
        let commanded = model.actuators.iter().zip(&state.commands).any(|(a, c)| {
            matches!(a.kind, ActuatorKind::LatchRelease { mechanism } if mechanism == index) && c.effort > 0.5
        });
        let load = [report.wrench_w.force.norm(), report.wrench_w.moment.norm()];
        let now = Moment { sides: &sides, time: state.time, step: ws.step, commanded, load };
        let next = mechanism.kind.advance(&now, memory);
        if next.status != memory.status {
            state.account.mechanism_loss += report.stored;
        }
        state.mechanisms[index] = next;
    }
}
