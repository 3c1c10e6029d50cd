//! Shapes that must not come near each other: their least distance, and whether they touched.
//!
//! Distances are measured between the shapes as they are, whether or not the scenario lets them touch, and as seldom as their motion allows
//! (conservative advancement: Mirtich 1996; Zhang, Lee and Kim 2006). Between two looks the distance d of a pair falls by no more than the way
//! that its points may have gone against each other,
//!
//!   c = |Δ(p_B − p_A)| + |θ_A| r_A + |θ_B| r_B      per step; p, θ: origin and turn of a body, r: radius of its shapes about p
//!
//! so that a pair which stood at d needs no look before Σ c has eaten d − (d_least − e): until then it cannot have come nearer than the
//! least distance so far by more than e, the error that a figure may have. The next look is there, within a step if need be, on the straight way
//! between its two ends. What passes through within a step is seen; what is far costs a few additions a step.
//!
//!   e = 1 % of the least distance so far, at least 10 µm; once shapes have touched also 1/16 of a step's way
//!
//! "Touched" means overlap at a look.

use super::Metric;
use crate::glob_matches;
use crate::spec::KeepOut;
use contact::{ContactPoint, Detector, Scene, Shape};
use record::{Event, EventKind};
use serde_json::Value;
use sim::{Model, World};
use spatial::{Frame, Pose, exp_rotation, log_rotation};

/// Distance up to which a clearance is measured, m; what stays farther apart has no figure.
const REACH: f64 = 1.0;
/// Error of the least distance: a share of it, and at least so much, m. Half of either doubles the looks of an approach.
const ERROR: (f64, f64) = (0.01, 1e-5);
/// Parts of a step in which shapes that have touched are followed deeper.
const PARTS: f64 = 16.0;

/// Two colliders that are kept apart.
#[derive(Clone, Copy, Debug)]
struct Pair {
    bodies: [usize; 2],
    /// Radii of their bodies' shapes about their origins, m.
    radii: [f64; 2],
    /// Whether one of them has no end: it is as long as the other is far.
    is_endless: bool,
    /// What the distance is at least, m.
    at_least: f64,
    /// Way of the points against each other in the present step, m.
    way: f64,
}

/// The watcher.
pub(super) struct KeepOutWatch {
    scene: Scene,
    detector: Detector,
    points: Vec<ContactPoint>,
    pairs: Vec<Pair>,
    /// Bodies of the pairs.
    bodies: Vec<usize>,
    /// Frames at the present look, and at the two ends of the present step.
    frames: Vec<Frame>,
    ends: [Vec<Frame>; 2],
    reach: Vec<f64>,
    /// Time of the last observed state, s.
    time: Option<f64>,
    /// Least distance so far, m; [`REACH`] where none was as small.
    least: f64,
    clearance: Option<f64>,
    touched: Option<f64>,
    looks: u64,
}

impl std::fmt::Debug for KeepOutWatch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("KeepOutWatch").field("clearance", &self.clearance).finish_non_exhaustive()
    }
}

impl KeepOutWatch {
    /// `None` where nothing is kept out. A side that names no shape has been told by the scenario's check.
    pub(super) fn new(rules: &[KeepOut], model: &Model) -> Option<Self> {
        let colliders = model.scene.colliders().to_vec();
        let scene = Scene::like(Some(&model.scene), colliders, pairs_of(rules, model)).ok()?;
        let pairs: Vec<Pair> = scene.pairs().iter().map(|pair| Pair::of(*pair, &scene, model)).collect();
        let mut bodies: Vec<usize> = pairs.iter().flat_map(|p| p.bodies).collect();
        bodies.sort_unstable();
        bodies.dedup();
        let still = vec![Frame::from(&Pose::identity()); model.world_body() + 1];
        (!pairs.is_empty()).then(|| Self {
            detector: Detector::new(&scene),
            points: Vec::new(),
            pairs,
            bodies,
            frames: still.clone(),
            ends: [still.clone(), still],
            reach: vec![0.5 * REACH; model.world_body() + 1],
            time: None,
            least: REACH,
            clearance: None,
            touched: None,
            looks: 0,
            scene,
        })
    }

    /// Follows the pairs over the step that has just been made.
    pub(super) fn observe(&mut self, world: &World, events: &mut Vec<Event>) {
        let [start, end] = &mut self.ends;
        std::mem::swap(start, end);
        self.bodies.iter().for_each(|&body| end[body] = world.frame(body));
        let now = world.state().time;
        let Some(before) = self.time.replace(now) else {
            self.frames.clone_from(end);
            return self.look(world, now, events);
        };
        let ends = &self.ends;
        self.pairs.iter_mut().for_each(|pair| pair.way = pair.calc_way(ends));
        let mut done = 0.0;
        while let Some(part) = self.calc_part(1.0 - done) {
            done += part;
            self.advance(part);
            self.place(done);
            self.look(world, before + done * (now - before), events);
        }
        self.advance(1.0 - done);
    }

    /// The part of a step after which the next look is due; none where that is beyond what is left.
    fn calc_part(&self, left: f64) -> Option<f64> {
        let longest = self.pairs.iter().map(|p| p.way).fold(0.0, f64::max);
        let followed = if self.touched.is_some() { longest / PARTS } else { 0.0 };
        let error = (ERROR.0 * self.least.abs()).max(ERROR.1).max(followed);
        let part = |p: &Pair| (p.at_least - self.least + error) / p.way;
        let soonest = self.pairs.iter().filter(|p| p.way > 0.0).map(part).reduce(f64::min)?;
        (soonest < left).then_some(soonest)
    }

    /// Takes a part of the present step's way off what is known of every pair.
    fn advance(&mut self, part: f64) {
        self.pairs.iter_mut().for_each(|p| p.at_least -= part * p.way);
    }

    /// Puts the bodies on the straight way between the ends of the present step.
    fn place(&mut self, at: f64) {
        for &body in &self.bodies {
            let [start, end] = [&self.ends[0][body], &self.ends[1][body]];
            let (from, to) = (start.to_pose().rotation, end.to_pose().rotation);
            let turn = exp_rotation(&(at * log_rotation(&(to * from.inverse()))));
            let pos = start.pos + at * (end.pos - start.pos);
            self.frames[body] = Frame { rot: turn.to_rotation_matrix().into_inner() * start.rot, pos };
        }
    }

    /// Measures all pairs where they stand.
    fn look(&mut self, world: &World, time: f64, events: &mut Vec<Event>) {
        self.looks += 1;
        self.detector.detect(&self.scene, &self.frames, &self.reach, &mut self.points);
        for pair in &mut self.pairs {
            pair.at_least = pair.calc_distance_at_least(&self.frames).max(REACH);
        }
        for point in &self.points {
            let pair = &mut self.pairs[point.pair as usize];
            pair.at_least = pair.at_least.min(point.gap);
        }
        let Some(nearest) = self.points.iter().min_by(|a, b| a.gap.total_cmp(&b.gap)) else { return };
        self.least = self.least.min(nearest.gap);
        self.clearance = Some(self.clearance.map_or(nearest.gap, |least| least.min(nearest.gap)));
        if nearest.gap < 0.0 && self.touched.is_none() {
            self.touched = Some(time);
            let [a, b] = self.scene.pairs()[nearest.pair as usize].map(|c| &world.model().collider_names[c]);
            let text = format!("keep-out: {a} touches {b}");
            events.push(Event { t: time, step: world.state().steps, kind: EventKind::Loss, text });
        }
    }

    pub(super) fn add_metrics(&self, metrics: &mut Vec<Metric>) {
        let optional = |value: Option<f64>| value.map_or(Value::Null, Value::from);
        let mut add = |name: &'static str, value, meaning| metrics.push(Metric { name: name.into(), value, meaning });
        add(
            "keep_out_clearance_m",
            optional(self.clearance),
            "least distance of shapes that must stay apart, within 1 m; up to 1 % or 10 µm too large",
        );
        add("keep_out_touched", self.touched.is_some().into(), "whether shapes touched that must not");
        add("keep_out_touched_s", optional(self.touched), "when they first did");
    }
}

impl Pair {
    fn of(colliders: [usize; 2], scene: &Scene, model: &Model) -> Self {
        let colliders = colliders.map(|c| &scene.colliders()[c]);
        let bodies = colliders.map(|c| c.body);
        let is_endless = colliders.iter().any(|c| matches!(c.shape, Shape::HalfSpace));
        Self { bodies, radii: bodies.map(|b| model.collider_radius(b)), is_endless, at_least: 0.0, way: 0.0 }
    }

    /// Bound of the way that points of the two go against each other over a step, m.
    fn calc_way(&self, [start, end]: &[Vec<Frame>; 2]) -> f64 {
        let [a, b] = self.bodies;
        let moved = (end[b].pos - end[a].pos) - (start[b].pos - start[a].pos);
        // Of an endless shape only what is near the other matters.
        let far = if self.is_endless { (end[b].pos - end[a].pos).norm() + self.radii[0] + self.radii[1] } else { 0.0 };
        let turned = |k: usize| calc_turn(&start[self.bodies[k]], &end[self.bodies[k]]) * self.radii[k].max(far);
        moved.norm() + turned(0) + turned(1)
    }

    /// Distance of the balls about the two bodies' origins that hold their shapes, m.
    fn calc_distance_at_least(&self, frames: &[Frame]) -> f64 {
        if self.is_endless {
            return f64::NEG_INFINITY;
        }
        (frames[self.bodies[1]].pos - frames[self.bodies[0]].pos).norm() - self.radii[0] - self.radii[1]
    }
}

/// Angle between two attitudes, rad: ‖R₁ − R₀‖ = 2√2 sin(θ/2), exact where θ is small.
fn calc_turn(start: &Frame, end: &Frame) -> f64 {
    2.0 * ((end.rot - start.rot).norm() / 8.0_f64.sqrt()).min(1.0).asin()
}

/// The pairs of colliders that the rules keep apart; of one body never.
fn pairs_of(rules: &[KeepOut], model: &Model) -> Vec<[usize; 2]> {
    let colliders = model.scene.colliders();
    let body = |c: usize| colliders[c].body;
    let names = |c: usize| [model.collider_names[c].clone(), model.body_name(body(c))];
    let names: Vec<[String; 2]> = (0..colliders.len()).map(names).collect();
    let on = |pattern: &str, c: usize| names[c].iter().any(|name| glob_matches(pattern, name));
    let apart = |a: usize, b: usize| {
        let matches = |r: &KeepOut| {
            let [x, y] = &r.between;
            (on(x, a) && on(y, b)) || (on(x, b) && on(y, a))
        };
        body(a) != body(b) && rules.iter().any(matches)
    };
    let all = (1..colliders.len()).flat_map(|b| (0..b).map(move |a| [a, b]));
    all.filter(|[a, b]| apart(*a, *b)).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use spatial::Vec3;

    /// Two blocks of 0.2 × 0.2 × 0.1 m that are kept apart and do not touch: one at rest, one on its way.
    fn watch(pose: &str, twist: &str, step_s: f64, steps: u64) -> (KeepOutWatch, Vec<Event>) {
        let text = format!(
            "name = \"t\"\nseed = 1\nduration_s = 1000.0\n[integrator]\nstep_s = {step_s}\n\
             [[vehicle]]\nname = \"a\"\nurdf = \"robots/bench/peer-block.urdf\"\n\
             [[vehicle]]\nname = \"b\"\nurdf = \"robots/bench/peer-block.urdf\"\npose = {{ {pose} }}\ntwist = {{ {twist} }}\n\
             [[contact]]\nbetween = [\"*\", \"*\"]\nenabled = false\n\
             [[keep_out]]\nbetween = [\"a/block\", \"b/block\"]\n"
        );
        let file = format!("{}/../../s.toml", env!("CARGO_MANIFEST_DIR"));
        let scenario = crate::parse(&text, &file, &[]).unwrap_or_else(|e| panic!("{e}"));
        let mut world = crate::build(&scenario).unwrap_or_else(|e| panic!("{e}")).world;
        let mut watch = KeepOutWatch::new(&scenario.keep_out, world.model()).expect("two blocks are kept apart");
        let mut events = Vec::new();
        watch.observe(&world, &mut events);
        for _ in 0..steps {
            world.advance().expect("they fly");
            watch.observe(&world, &mut events);
        }
        (watch, events)
    }

    #[test]
    fn what_flies_through_in_ten_steps_or_in_one_is_seen_when_it_comes() {
        // Through the middle along x: 0.4 m from the first touch to the last, after 1.8 m.
        for speed in [4.0, 40.0, 400.0, 4_000.0] {
            let twist = format!("linear_m_per_s = [{speed}, 0.0, 0.0]");
            let (watch, events) = watch("position_m = [-2.0, 0.0, 0.0]", &twist, 0.01, 1 + (4.0 / speed / 0.01) as u64);
            let touched = watch.touched.expect("it flew through");
            // At the look that finds it the overlap is at most the error.
            let expected = 1.8 / speed;
            assert!(
                (touched - expected).abs() < 1e-5 / speed + 1e-12,
                "{touched} s against {expected} s at {speed} m/s"
            );
            assert_eq!(events.len(), 1);
            // Followed deeper by 1/16 of a step's way, 2.5 mm to 0.25 m, until it is 0.1 m deep across z; 2.5 m are too far.
            assert!(speed > 1e3 || watch.clearance.unwrap() < -0.09, "{:?}", watch.clearance);
        }
    }

    #[test]
    fn the_least_distance_of_a_passage_within_a_step_is_within_its_error() {
        // The blocks' faces pass 30 mm from each other, somewhere between two steps.
        for speed in [1.0, 30.0, 700.0] {
            let twist = format!("linear_m_per_s = [{speed}, 0.0, 0.0]");
            let (watch, events) =
                watch("position_m = [-3.21, 0.23, 0.0]", &twist, 0.01, 1 + (7.0 / speed / 0.01) as u64);
            let clearance = watch.clearance.expect("they pass within a metre");
            assert!((0.03 - 1e-12..0.03 * (1.0 + ERROR.0) + ERROR.1).contains(&clearance), "{clearance} m");
            assert!(watch.touched.is_none() && events.is_empty());
        }
    }

    #[test]
    fn a_turning_block_is_followed_by_its_corners() {
        // On an axle 0.2 m away its corner, √0.02 m from it, comes to 58.6 mm every quarter of a turn.
        let (watch, _) = watch("position_m = [0.3, 0.0, 0.0]", "angular_deg_per_s = [0.0, 0.0, 9000.0]", 0.01, 10);
        let expected = 0.2 - 0.02_f64.sqrt();
        let clearance = watch.clearance.expect("near");
        assert!(
            (expected - 1e-12..expected * (1.0 + ERROR.0) + ERROR.1).contains(&clearance),
            "{clearance} {expected}"
        );
    }

    #[test]
    fn what_is_far_or_still_is_hardly_looked_at() {
        let (far, _) = watch("position_m = [40.0, 0.0, 0.0]", "linear_m_per_s = [-0.05, 0.0, 0.0]", 0.01, 20_000);
        assert!(far.looks < 10, "10 m at 40 m: {} looks in 20,000 steps", far.looks);
        let (near, _) = watch("position_m = [0.3, 0.0, 0.0]", "linear_m_per_s = [0.0, 0.0, 0.0]", 0.01, 5_000);
        assert_eq!(near.looks, 1, "nothing moves");
        assert!((near.clearance.unwrap() - 0.1).abs() < 1e-12);
        // From 1 m to 10 µm a look every 1 %, and then every 10 µm.
        let (coming, _) = watch("position_m = [1.2, 0.0, 0.0]", "linear_m_per_s = [-0.01, 0.0, 0.0]", 1e-3, 101_000);
        assert!(coming.touched.is_some() && coming.looks < 2_000, "{} looks in 101,000 steps", coming.looks);
    }

    #[test]
    fn the_angle_between_attitudes_is_exact_however_small() {
        for angle in [1e-12, 1e-5, 0.3, 3.0] {
            let end = Frame { rot: spatial::rotation_about(&Vec3::y(), angle), pos: Vec3::zeros() };
            let turn = calc_turn(&Frame::identity(), &end);
            assert!((turn / angle - 1.0).abs() < 1e-9, "{turn} {angle}");
        }
    }
}
