//! Shapes that must not come near each other: their least distance, and whether they touched.
//!
//! Distances are measured between the shapes as they are, whether or not the scenario lets them touch, every few steps;
//! "touched" means overlap at such an instant.

use super::Metric;
use crate::glob_matches;
use crate::spec::KeepOut;
use contact::{ContactPoint, Detector, Scene};
use record::{Event, EventKind};
use serde_json::Value;
use sim::{Model, World};
use spatial::{Frame, Pose};

/// Distance up to which a clearance is measured, m; what stays farther apart has no figure.
const REACH: f64 = 1.0;
/// Steps between two measurements, far and near; near is below [`NEAR`].
const EVERY: (u64, u64) = (100, 10);
/// Clearance below which measurements come closer together, m: 0.1 s of 0.5 m/s.
const NEAR: f64 = 0.05;

/// The watcher.
pub(super) struct KeepOutWatch {
    scene: Scene,
    detector: Detector,
    points: Vec<ContactPoint>,
    frames: Vec<Frame>,
    reach: Vec<f64>,
    now: Option<f64>,
    clearance: Option<f64>,
    touched: Option<f64>,
}

impl std::fmt::Debug for KeepOutWatch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("KeepOutWatch").field("clearance", &self.clearance).finish_non_exhaustive()
    }
}

impl KeepOutWatch {
    /// `None` where nothing is kept out. A side that names no shape has been told by the scenario's check.
    pub(super) fn new(rules: &[KeepOut], model: &Model) -> Option<Self> {
        let pairs = pairs_of(rules, model);
        let colliders = model.scene.colliders().to_vec();
        let scene = Scene::like(Some(&model.scene), colliders, pairs).ok().filter(|s| !s.pairs().is_empty())?;
        let bodies = model.world_body() + 1;
        Some(Self {
            detector: Detector::new(&scene),
            points: Vec::new(),
            frames: vec![Frame::from(&Pose::identity()); bodies],
            reach: vec![0.5 * REACH; bodies],
            now: None,
            clearance: None,
            touched: None,
            scene,
        })
    }

    pub(super) fn observe(&mut self, world: &World, events: &mut Vec<Event>) {
        let every = if self.now.is_some_and(|gap| gap < NEAR) { EVERY.1 } else { EVERY.0 };
        if !world.state().steps.is_multiple_of(every) {
            return;
        }
        self.frames.iter_mut().enumerate().for_each(|(body, frame)| *frame = world.frame(body));
        self.detector.detect(&self.scene, &self.frames, &self.reach, &mut self.points);
        self.now = self.points.iter().map(|p| p.gap).reduce(f64::min);
        let Some(nearest) = self.points.iter().min_by(|a, b| a.gap.total_cmp(&b.gap)) else { return };
        self.clearance = Some(self.clearance.map_or(nearest.gap, |least| least.min(nearest.gap)));
        if nearest.gap < 0.0 && self.touched.is_none() {
            let (time, step) = (world.state().time, world.state().steps);
            self.touched = Some(time);
            let [a, b] = self.scene.pairs()[nearest.pair as usize].map(|c| &world.model().collider_names[c]);
            let text = format!("keep-out: {a} touches {b}");
            events.push(Event { t: time, step, kind: EventKind::Loss, text });
        }
    }

    pub(super) fn add_metrics(&self, metrics: &mut Vec<Metric>) {
        let optional = |value: Option<f64>| value.map_or(Value::Null, Value::from);
        let mut add = |name: &'static str, value, meaning| metrics.push(Metric { name: name.into(), value, meaning });
        add(
            "keep_out_clearance_m",
            optional(self.clearance),
            "least distance of shapes that must stay apart, within 1 m",
        );
        add("keep_out_touched", self.touched.is_some().into(), "whether shapes touched that must not");
        add("keep_out_touched_s", optional(self.touched), "when they first did");
    }
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
