//! Touching points within a step: where each law is evaluated, its linearisation, and what becomes of the bristles.
//!
//! The law is evaluated at a *predicted* relative velocity u' of B's material point against A's:
//!
//!   gap = gap_base + β u'·n,   s⁺ = s_base + β P u',   rate = (1 − θ) u + θ u'
//!
//! | scheme | gap_base | β | θ | τ |
//! | --- | --- | --- | --- | --- |
//! | implicit Euler | g | h | 1 | h |
//! | midpoint, resolved | g_m − h/4 u·n | h/4 | ½ | h/2 |
//! | midpoint, stiff | g_m | h | 1 | h |
//! | semi-implicit Euler | g | 0 | 0 | h |
//!
//! and G = −h ∂f/∂u', symmetric and positive semidefinite, is what the solver adds to the mass matrix. The dependence of
//! friction on the normal force is left to the next pass.

use crate::model::{Model, PairLaw};
use crate::state::{ContactMemory, State};
use crate::workspace::Workspace;
use friction::Trial;
use spatial::{Frame, Mat3, Vec3};

/// One touching point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    pub pair: u32,
    pub feature: u64,
    pub body_a: usize,
    pub body_b: usize,
    /// The contact point in W, and in the two bodies' frames.
    pub point: Vec3,
    pub local_a: Vec3,
    pub local_b: Vec3,
    /// B's axes in W at the place of detection.
    pub rot_b: Mat3,
    /// From A to B.
    pub normal: Vec3,
    pub gap: f64,
    /// Share of the pair's law that acts here.
    pub weight: f64,
    /// Deflection at the start, carried into the present plane.
    pub s: Vec3,
    /// Velocity of B's point relative to A's at the start.
    pub u: Vec3,
    /// What the bodies' turning adds to it over the step, without any gain: h (ω_B − ω_A) × ẋ_C. Gains are spatial, those
    /// of the velocity field at a place fixed in W, but the contact moves on with ẋ_C, taken as the mean of both points'.
    pub carried: Vec3,
    pub place: Place,
    pub out: Outcome,
}

/// Where the law is evaluated.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Place {
    pub gap_base: f64,
    pub s_base: Vec3,
    pub beta: f64,
    pub theta: f64,
    pub elapsed: f64,
}

/// What the law answered, and the line through it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Outcome {
    /// Force on B by the law at the last u', N.
    pub law: Vec3,
    /// Normal part of it, N.
    pub normal_force: f64,
    /// Deflection and regime by the law.
    pub s: Vec3,
    pub sticks: bool,
    /// Passes of this step in which the slip force turned by more than 90°.
    pub turns: u8,
    /// −h ∂f/∂u', kg.
    pub g: Mat3,
    /// The line's force at u' = u, N.
    pub line: Vec3,
    /// Force that the solve gave both bodies, N.
    pub force: Vec3,
}

impl Touch {
    /// Evaluates the law at the predicted relative velocity `u_new`, and draws the line for the next solve.
    ///
    /// Newton's tangent in slip (turning only) overshoots a point that is about to stop, and would throw it to and fro
    /// for ever. Where the slip force has turned, the next line is that of the bristle without a bound, which leads to
    /// the neighbourhood of rest; where that did not settle it, the secant through the unloaded bristle: friction is
    /// the slope of a convex potential, which the secant's parabola bounds from above, so that every pass descends.
    pub fn eval(&mut self, law: &PairLaw, u_new: &Vec3, h: f64) -> Outcome {
        let law = &law.weighted(self.weight);
        let (n, at) = (self.normal, self.place);
        let rate = (1.0 - at.theta) * self.u + at.theta * u_new;
        let (u_n, rate_n) = (n.dot(u_new), n.dot(&rate));
        let normal = law.normal.eval(at.gap_base + at.beta * u_n, rate_n);
        let nn = n * n.transpose();
        let mut out = Outcome {
            law: normal.force * n,
            normal_force: normal.force,
            g: -h * (at.beta * normal.d_gap + at.theta * normal.d_rate) * nn,
            ..Outcome::default()
        };
        let mut excess = Vec3::zeros();
        if let Some(friction) = &law.friction {
            let (s_trial, slip) = (at.s_base + at.beta * (u_new - u_n * n), rate - rate_n * n);
            let brush = friction.eval(&Trial {
                s: self.s,
                s_trial,
                slip,
                elapsed: at.elapsed,
                normal_force: normal.force + law.normal.adhesion,
            });
            out.law += brush.force;
            out.s = brush.s;
            out.sticks = brush.sticks;
            out.g += h * at.theta * friction.viscous * plane_of(&n);
            out.turns = self.out.turns + u8::from(self.has_turned(&brush));
            if out.turns == 0 || brush.direction == Vec3::zeros() {
                out.g += h * at.beta * brush.calc_tangent_matrix(&n);
            } else if out.turns > self.out.turns && out.turns == 1 {
                let spring = friction.stiffness + friction.damping / at.elapsed;
                out.g += h * at.beta * spring * plane_of(&n);
                let unbounded = friction.damping / at.elapsed * self.s - spring * s_trial;
                excess = unbounded - friction.viscous * slip - brush.force;
            } else {
                out.g += h * at.beta * brush.tangent * plane_of(&n);
            }
        }
        out.line = out.law + excess + out.g * (u_new - self.u - self.carried) / h;
        out.force = out.law;
        out
    }

    /// Whether a force on its bound has turned by more than 90° since the last pass.
    fn has_turned(&self, brush: &friction::Brush) -> bool {
        let before = self.out.law - self.normal * self.normal.dot(&self.out.law);
        brush.direction != Vec3::zeros() && brush.force.dot(&before) < 0.0
    }

    /// Lever arms do not matter here: the relative velocity of the two material points.
    fn relative_velocity(ws: &Workspace, model: &Model, body_a: usize, body_b: usize, point: &Vec3) -> Vec3 {
        ws.vel_at(model, body_b, point) - ws.vel_at(model, body_a, point)
    }
}

/// (ω_B − ω_A) × ½ (v_A + v_B) at the contact point, m/s².
pub(crate) fn calc_carried(model: &Model, ws: &Workspace, touch: &Touch) -> Vec3 {
    let spin = |body: usize| model.owners.get(body).map_or(Vec3::zeros(), |&(v, b)| ws.kin[v].vel[b].ang);
    let at = |body: usize| ws.vel_at(model, body, &touch.point);
    (spin(touch.body_b) - spin(touch.body_a)).cross(&(0.5 * (at(touch.body_a) + at(touch.body_b))))
}

/// The projector on the plane normal to `n`.
fn plane_of(n: &Vec3) -> Mat3 {
    Mat3::identity() - n * n.transpose()
}

/// Speculative distance: a point counts if it may touch within the step. It moves at most this much.
fn update_reach(model: &Model, ws: &mut Workspace, h: f64) {
    for (body, &(vehicle, local)) in model.owners.iter().enumerate() {
        let radius = model.collider_radius[body];
        if radius < 0.0 {
            continue;
        }
        let kin = &ws.kin[vehicle];
        let twist = kin.vel[local];
        let speed = twist.at(&kin.pos[local]).norm() + twist.ang.norm() * radius;
        ws.reach[body] = 2.0 * h * speed;
    }
}

/// Finds the touching points at the present frames and gives each its bristle.
pub(crate) fn find_touches(model: &Model, state: &State, ws: &mut Workspace, h: f64) {
    ws.touches.clear();
    if model.scene.pairs().is_empty() {
        return;
    }
    update_reach(model, ws, h);
    ws.detector.detect(&model.scene, &ws.frames, &ws.reach, &mut ws.points);
    for i in 0..ws.points.len() {
        let contact = ws.points[i];
        let (body_a, body_b) = model.pair_bodies(contact.pair as usize);
        let point = 0.5 * (contact.point_a_w + contact.point_b_w);
        let u = Touch::relative_velocity(ws, model, body_a, body_b, &point);
        if contact.gap + 2.0 * h * contact.normal_w.dot(&u).min(0.0) >= 0.0 {
            continue;
        }
        ws.touches.push(Touch {
            pair: contact.pair,
            feature: contact.feature,
            body_a,
            body_b,
            point,
            local_a: ws.frames[body_a].inverse_point(&point),
            local_b: ws.frames[body_b].inverse_point(&point),
            rot_b: ws.frames[body_b].rot,
            normal: contact.normal_w,
            gap: contact.gap,
            weight: contact.weight,
            s: Vec3::zeros(),
            u,
            carried: Vec3::zeros(),
            place: Place::default(),
            out: Outcome::default(),
        });
    }
    for i in 0..ws.touches.len() {
        ws.touches[i].carried = calc_carried(model, ws, &ws.touches[i]) * h;
    }
    remember(&model.scene, &state.bristles, &mut ws.touches, &ws.frames);
}

/// Distance (m) within which a point inherits the bristle of a vanished neighbour of the same pair.
const NEIGHBOUR: f64 = 2e-3;

/// Hands every touch the bristle of its identity; where features say nothing, that of the nearest lost neighbour.
fn remember(scene: &contact::Scene, memories: &[ContactMemory], touches: &mut [Touch], frames: &[Frame]) {
    let mut known = 0;
    for touch in touches.iter_mut() {
        if let Some(at) = find_memory(memories, touch.pair, touch.feature) {
            touch.s = carry(&memories[at].s_b, &frames[touch.body_b], &touch.normal);
            known += 1;
        }
    }
    if known == memories.len() || known == touches.len() {
        return;
    }
    for memory in memories {
        let taken = |t: &Touch| (t.pair, t.feature) == (memory.pair, memory.feature);
        // A bed's samples are known by their number, and there may be hundreds of them.
        if scene.has_bed(memory.pair as usize) || touches.iter().any(taken) {
            continue;
        }
        let is_orphan = |t: &Touch| {
            t.pair == memory.pair
                && t.s == Vec3::zeros()
                && !memories.iter().any(|m| (m.pair, m.feature) == (t.pair, t.feature))
        };
        let distance = |t: &Touch| (t.local_b - memory.point_b).norm();
        let nearest = touches.iter_mut().filter(|t| is_orphan(t)).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        if let Some(touch) = nearest.filter(|t| distance(t) < NEIGHBOUR) {
            touch.s = carry(&memory.s_b, &frames[touch.body_b], &touch.normal);
        }
    }
}

/// Place of a point's memory in a sorted list.
pub(crate) fn find_memory(memories: &[ContactMemory], pair: u32, feature: u64) -> Option<usize> {
    memories.binary_search_by(|m| (m.pair, m.feature).cmp(&(pair, feature))).ok()
}

/// A deflection kept in B's axes, in the present tangent plane: turned with B, laid into the plane, length kept.
fn carry(s_b: &Vec3, frame_wb: &Frame, normal: &Vec3) -> Vec3 {
    let s = frame_wb.rot * s_b;
    let laid = s - normal * normal.dot(&s);
    let (before, after) = (s.norm_squared(), laid.norm_squared());
    if after > 0.0 { laid * (before / after).sqrt() } else { Vec3::zeros() }
}

/// Keeps the bristles of the accepted step: in stick the deflection follows the displacement of the material points
/// between the frames at the step's start and now, in slip it is what the law said.
pub(crate) fn commit_bristles(model: &Model, state: &mut State, ws: &mut Workspace) {
    ws.memories.clear();
    for touch in &ws.touches {
        if model.laws[touch.pair as usize].friction.is_none() || touch.out.normal_force <= 0.0 {
            continue;
        }
        let (b0, b1) = (&ws.frames_start[touch.body_b], &ws.frames[touch.body_b]);
        let (a0, a1) = (&ws.frames_start[touch.body_a], &ws.frames[touch.body_a]);
        let s_b = if touch.out.sticks {
            let now = b1.point(&touch.local_b) - a1.point(&touch.local_a);
            let start = b0.point(&touch.local_b) - a0.point(&touch.local_a);
            let moved = now - start;
            touch.rot_b.tr_mul(&touch.s) + b1.rot.tr_mul(&(moved - touch.normal * touch.normal.dot(&moved)))
        } else {
            touch.rot_b.tr_mul(&touch.out.s)
        };
        ws.memories.push(ContactMemory { pair: touch.pair, feature: touch.feature, s_b, point_b: touch.local_b });
    }
    std::mem::swap(&mut state.bristles, &mut ws.memories);
}
