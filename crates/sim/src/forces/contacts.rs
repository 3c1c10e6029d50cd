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

use crate::model::Model;
use crate::parts::PairLaw;
use crate::state::{ContactMemory, State};
use crate::workspace::{Answer, Outcome, Place, Touch, Workspace};
use contact::ContactPoint;
use friction::{Brush, Friction, Trial, carry, mean_of};
use spatial::{Frame, Mat3, Twist, Vec3};

/// Steepest secant that [`Touch::calc_pressing`] believes.
const SHORTEST_WAY: f64 = -9.0;

impl Touch {
    /// Asks the law at the predicted relative velocity `u_new`; the outcome's line is not drawn yet.
    pub fn eval(&mut self, law: &PairLaw, u_new: Vec3, answer: &mut Answer) {
        let law = &*law.weighted(self.weight);
        let (n, at) = (self.normal, self.place);
        let rate = (1.0 - at.theta) * self.u + at.theta * u_new;
        let (u_n, rate_n) = (n.dot(&u_new), n.dot(&rate));
        let gap = at.gap_base + at.beta * u_n;
        let (normal, adhesion) = (law.normal.eval(gap, rate_n), law.normal.adhesion_at(gap));
        let mut out = Outcome {
            law: normal.force * n,
            normal_force: normal.force,
            bears: normal.force + adhesion > 0.0,
            pressing: [self.calc_pressing(normal.force), self.out.pressing[0]],
            passes: self.out.passes + 1,
            ..Outcome::default()
        };
        *answer = Answer { u_new, normal, friction: None, is_first_turn: false };
        if let Some(friction) = &law.friction {
            let (s_trial, slip) = (at.s_base + at.beta * (u_new - u_n * n), rate - rate_n * n);
            let brush = friction.eval(&Trial {
                s: self.s,
                s_trial,
                slip,
                elapsed: at.elapsed,
                normal_force: out.pressing[0] + adhesion,
                rest: self.rest,
                grain: self.grain,
            });
            out.law += brush.force;
            (out.s, out.rest, out.sticks) = (brush.s, brush.rest, brush.sticks);
            let has_turned = self.has_turned(&brush);
            out.turns = self.out.turns + u8::from(has_turned);
            answer.friction = Some((s_trial, slip, brush));
            answer.is_first_turn = has_turned && out.turns == 1;
        }
        out.force = out.law;
        self.out = out;
    }

    /// Draws the line for the next solve through what the law answered, `self.out`.
    ///
    /// Newton's tangent in slip (turning only) overshoots a point that is about to stop, and would throw it to and fro
    /// for ever. Where the slip force has turned, the next line is that of the bristle without a bound, which leads to
    /// the neighbourhood of rest; where that did not settle it, the secant through the unloaded bristle: friction is
    /// the slope of a convex potential, which the secant's parabola bounds from above, so that every pass descends.
    pub fn draw_line(&mut self, law: &PairLaw, answer: &Answer, h: f64) {
        let law = &*law.weighted(self.weight);
        let (n, at, normal) = (self.normal, self.place, answer.normal);
        let mut g = -h * (at.beta * normal.d_gap + at.theta * normal.d_rate) * (n * n.transpose());
        let mut excess = Vec3::zeros();
        if let (Some(friction), Some((s_trial, slip, brush))) = (&law.friction, &answer.friction) {
            g += h * self.calc_friction_slope(brush, friction, answer.is_first_turn);
            if answer.is_first_turn {
                let (stiffness, damping) = friction.spring();
                let spring = stiffness + damping / at.elapsed;
                excess = damping / at.elapsed * self.s - spring * s_trial - friction.viscous() * slip - brush.force;
            }
        }
        self.out.line = self.out.law + excess + g * (answer.u_new - self.u - self.carried) / h;
        self.out.g = g;
    }

    /// Normal force that bounds the friction in the next line, when the last one led to `normal`.
    ///
    /// Friction is held at its bound while a pass solves, so the passes iterate N ← F(N). In a wedge friction lifts the body
    /// off the faces that cause it, F falls steeper than −1, and the iteration would jump between pressing and not touching
    /// for ever: a ball fell through a corner of three planes. From the third pass on the secant of F says how far to go; it
    /// shortens the way and never lengthens it.
    fn calc_pressing(&self, normal: f64) -> f64 {
        let [last, before] = self.out.pressing;
        if self.out.passes < 2 || last == before {
            return normal;
        }
        let slope = (normal - self.out.normal_force) / (last - before);
        last + (normal - last) / (1.0 - slope.clamp(SHORTEST_WAY, 0.0))
    }

    /// −∂f/∂u' of the friction force, or what stands in for it where the slip force turned (see [`Self::eval`]).
    ///
    /// A level that falls with speed counts as constant: its slope would take definiteness from the matrix, and the next
    /// pass sees the new level.
    fn calc_friction_slope(&self, brush: &Brush, friction: &Friction, is_first_turn: bool) -> Mat3 {
        let (n, at, slip, mut by_s) = (&self.normal, self.place, brush.by_slip, brush.by_deflection);
        let is_free = by_s.is_even() && slip.is_even();
        let mut by_slip = friction::Slope { along: slip.along.max(0.0), ..slip };
        if is_first_turn {
            let (stiffness, damping) = friction.spring();
            by_s = friction::Slope::even(stiffness + damping / at.elapsed);
        } else if self.out.turns > 0 && !is_free {
            by_s = friction::Slope::even(by_s.across);
            by_slip = friction::Slope::even(slip.across);
        }
        let mut slope = at.beta * by_s.calc_matrix(n);
        if by_slip.across != 0.0 || by_slip.along != 0.0 {
            slope += at.theta * by_slip.calc_matrix(n);
        }
        slope
    }

    /// Whether a force on its bound has turned by more than 90° since the last pass.
    fn has_turned(&self, brush: &Brush) -> bool {
        let before = self.out.law - self.normal * self.normal.dot(&self.out.law);
        let is_free = brush.by_deflection.is_even() && brush.by_slip.is_even();
        !is_free && brush.force.dot(&before) < 0.0
    }
}

/// (ω_B − ω_A) × ½ (v_A + v_B) at the contact point, m/s².
pub(crate) fn calc_carried(model: &Model, ws: &Workspace, touch: &Touch) -> Vec3 {
    let [a, b] = [touch.body_a, touch.body_b].map(|body| ws.twist_at(model, body, &touch.point));
    carried_of(&a, &b)
}

/// The same of the two bodies' twists about the point.
fn carried_of(a: &Twist, b: &Twist) -> Vec3 {
    (b.ang - a.ang).cross(&(0.5 * (a.lin + b.lin)))
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

/// Whether any pair may touch within `h` s, however its bodies turn.
pub(crate) fn is_near(model: &Model, ws: &mut Workspace, h: f64) -> bool {
    if model.scene.pairs().is_empty() {
        return false;
    }
    find_points(model, ws, h);
    !ws.points.is_empty()
}

/// Finds the points of all pairs that may touch within `h` s.
fn find_points(model: &Model, ws: &mut Workspace, h: f64) {
    if model.dead_weights.len() < model.scene.pairs().len() {
        update_reach(model, ws, h);
        ws.detector.detect(&model.scene, &ws.frames, &ws.reach, &mut ws.points);
    }
    keep_deepest(model, &mut ws.points);
    add_dead_weights(model, ws);
}

/// Finds the touching points at the present frames and gives each its bristle.
pub(crate) fn find_touches(model: &Model, state: &State, ws: &mut Workspace, h: f64) {
    ws.touches.clear();
    if model.scene.pairs().is_empty() {
        return;
    }
    find_points(model, ws, h);
    for i in 0..ws.points.len() {
        let contact = ws.points[i];
        let (body_a, body_b) = model.pair_bodies(contact.pair as usize);
        let point = 0.5 * (contact.point_a_w + contact.point_b_w);
        let (twist_a, twist_b) = (ws.twist_at(model, body_a, &point), ws.twist_at(model, body_b, &point));
        let u = twist_b.lin - twist_a.lin;
        if contact.gap + 2.0 * h * contact.normal_w.dot(&u).min(0.0) >= 0.0 {
            continue;
        }
        let (frame_a, frame_b) = (&ws.frames[body_a], &ws.frames[body_b]);
        let law = &model.laws[contact.pair as usize];
        let is_still = |body: usize| ws.frames[body].rot == ws.frames_start[body].rot;
        let neighbour = ws.touches.last().filter(|t| (t.body_a, t.body_b) == (body_a, body_b));
        let is_at_start = neighbour.map_or_else(|| is_still(body_a) && is_still(body_b), |t| t.is_at_start);
        let mut touch = Touch {
            pair: contact.pair,
            feature: contact.feature,
            body_a,
            body_b,
            point,
            local_a: frame_a.inverse_point(&point),
            local_b: frame_b.inverse_point(&point),
            rot_a: frame_a.rot,
            rot_b: frame_b.rot,
            is_at_start,
            normal: contact.normal_w,
            gap: contact.gap,
            weight: contact.weight,
            s: Vec3::zeros(),
            rest: law.friction.as_ref().map_or(1.0, Friction::initial_rest),
            grain: Vec3::zeros(),
            turn: Vec3::zeros(),
            u,
            carried: carried_of(&twist_a, &twist_b) * h,
            place: Place::default(),
            out: Outcome::default(),
        };
        if let Some(grain) = &law.grain {
            touch.grain = grain.calc_direction((&touch.rot_a, &touch.rot_b), &touch.normal);
        }
        ws.touches.push(touch);
    }
    let turned = Turned { from: &ws.frames_start, to: &ws.frames };
    remember(&model.scene, &state.bristles, &mut ws.touches, &turned);
}

/// Distance (m) within which a point inherits the bristle of a vanished neighbour of the same pair.
const NEIGHBOUR: f64 = 2e-3;

/// Hands every touch the bristle of its identity; where features say nothing, that of the nearest lost neighbour.
fn remember(scene: &contact::Scene, memories: &[ContactMemory], touches: &mut [Touch], turned: &Turned<'_>) {
    let mut known = 0;
    for touch in touches.iter_mut() {
        if let Some(at) = find_memory(memories, touch.pair, touch.feature) {
            touch.recall(&memories[at], turned);
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
            touch.recall(memory, turned);
        }
    }
}

/// Place of a point's memory in a sorted list.
pub(crate) fn find_memory(memories: &[ContactMemory], pair: u32, feature: u64) -> Option<usize> {
    memories.binary_search_by(|m| (m.pair, m.feature).cmp(&(pair, feature))).ok()
}

/// Leaves one point to every pair whose law says so. A pair's points are neighbours in the list.
fn keep_deepest(model: &Model, points: &mut Vec<contact::ContactPoint>) {
    let mut kept = 0;
    for i in 0..points.len() {
        let mut own = points[i];
        if model.laws[own.pair as usize].only_deepest {
            own.feature = 0;
            if let Some(last) = points[..kept].last_mut().filter(|last| last.pair == own.pair) {
                if own.gap < last.gap {
                    *last = own;
                }
                continue;
            }
        }
        points[kept] = own;
        kept += 1;
    }
    points.truncate(kept);
}

/// How the bodies turned between two moments.
pub(crate) struct Turned<'a> {
    pub from: &'a [Frame],
    pub to: &'a [Frame],
}

impl Turned<'_> {
    /// A vector in W axes, as fixed in a body.
    #[inline]
    fn with(&self, body: usize, v: &Vec3) -> Vec3 {
        let (from, to) = (&self.from[body].rot, &self.to[body].rot);
        if from == to { *v } else { to * from.tr_mul(v) }
    }

    /// The mean of what a unit vector becomes with both bodies.
    #[inline]
    pub fn normal(&self, (a, b): (usize, usize), n: &Vec3) -> Vec3 {
        mean_of(&self.with(a, n), &self.with(b, n))
    }

    /// A deflection of the plane normal to `n`, carried with both bodies into the plane normal to `to`.
    #[inline]
    pub fn deflection(&self, (a, b): (usize, usize), s: &Vec3, n: &Vec3, to: &Vec3) -> Vec3 {
        let with = |v: &Vec3| (self.with(a, v), self.with(b, v));
        carry_with_both(with(s), with(n), to)
    }
}

/// A deflection as either body turned it, each carried from that body's normal into the plane normal to `to`: their mean.
#[inline]
fn carry_with_both((s_a, s_b): (Vec3, Vec3), (n_a, n_b): (Vec3, Vec3), to: &Vec3) -> Vec3 {
    mean_of(&carry(&s_a, &n_a, to), &carry(&s_b, &n_b, to))
}

impl Touch {
    fn recall(&mut self, memory: &ContactMemory, turned: &Turned<'_>) {
        let carried = |s: &Vec3| {
            if self.is_at_start {
                return carry(s, &memory.normal_w, &self.normal);
            }
            turned.deflection((self.body_a, self.body_b), s, &memory.normal_w, &self.normal)
        };
        let turn = if memory.turn_w == Vec3::zeros() { self.turn } else { carried(&memory.turn_w) };
        (self.s, self.rest, self.turn) = (carried(&memory.s_w), memory.rest, turn);
    }

    /// What is kept of the point when the bodies have moved on from the place of detection to frames `a` and `b`: the
    /// deflection `s` of the plane of detection, and what has slipped since, W axes.
    fn remembered(&self, s: &Vec3, slipped: &Vec3, (a, b): (&Frame, &Frame)) -> ContactMemory {
        let with = |v: &Vec3| (a.rot * self.rot_a.tr_mul(v), b.rot * self.rot_b.tr_mul(v));
        let normals = with(&self.normal);
        let normal_w = mean_of(&normals.0, &normals.1);
        let s_w = carry_with_both(with(s), normals, &normal_w) + slipped - normal_w * normal_w.dot(slipped);
        let mut turn_w = self.turn;
        if turn_w != Vec3::zeros() {
            turn_w = carry_with_both(with(&turn_w), normals, &normal_w);
        }
        let Self { pair, feature, local_b: point_b, weight, .. } = *self;
        ContactMemory { pair, feature, s_w, normal_w, turn_w, rest: self.out.rest, point_b, weight }
    }
}

/// Keeps the bristles of the accepted step: in stick the deflection follows the displacement of the material points
/// between the frames at the step's start and now, in slip it is what the law said.
pub(crate) fn commit_bristles(model: &Model, state: &mut State, ws: &mut Workspace) {
    ws.memories.clear();
    for touch in &ws.touches {
        if !model.laws[touch.pair as usize].remembers() || !touch.out.bears {
            continue;
        }
        let (b0, b1) = (&ws.frames_start[touch.body_b], &ws.frames[touch.body_b]);
        let (a0, a1) = (&ws.frames_start[touch.body_a], &ws.frames[touch.body_a]);
        let memory = if touch.out.sticks {
            let now = b1.point(&touch.local_b) - a1.point(&touch.local_a);
            let start = b0.point(&touch.local_b) - a0.point(&touch.local_a);
            // Detected at the start, the two points coincide there; detected at mid-step they may not, and what parts them
            // turns with the bodies: taken as it was, its normal part would enter the plane step by step.
            let with = |from: &Frame, to: &Frame| to.rot * from.rot.tr_mul(&start);
            let turned = if touch.is_at_start { start } else { mean_of(&with(a0, a1), &with(b0, b1)) };
            touch.remembered(&touch.s, &(now - turned), (a1, b1))
        } else {
            touch.remembered(&touch.out.s, &Vec3::zeros(), (a1, b1))
        };
        ws.memories.push(memory);
    }
    std::mem::swap(&mut state.bristles, &mut ws.memories);
}

/// The least penetration that there is, m.
const TOUCHING: f64 = -f64::MIN_POSITIVE;

/// Feature of the one point of such a pair.
const FEATURE: u64 = 0;

/// Adds the one point of every dead weight to what was detected, in the order of pairs.
fn add_dead_weights(model: &Model, ws: &mut Workspace) {
    if model.dead_weights.is_empty() {
        return;
    }
    if model.dead_weights.len() == model.scene.pairs().len() {
        ws.points.clear();
    }
    for weight in &model.dead_weights {
        let place = ws.frames[weight.body].pos;
        ws.points.push(ContactPoint {
            pair: weight.pair as u32,
            feature: FEATURE,
            point_a_w: place,
            point_b_w: place,
            normal_w: weight.normal,
            gap: TOUCHING,
            weight: 1.0,
        });
    }
    ws.points.sort_unstable_by_key(|p| (p.pair, p.feature));
}
