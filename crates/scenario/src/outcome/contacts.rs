//! What touches: the sum of all contact forces, and of every pair its peak force, impulse and time.

use super::Metric;
use sim::{Model, World};

/// What became of one pair of shapes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct PairRecord {
    pub(super) peak: f64,
    pub(super) impulse: f64,
    pub(super) time: f64,
    now: f64,
}

/// The watcher of all pairs.
#[derive(Clone, Debug, Default)]
pub(super) struct ContactWatch {
    pub(super) first_contact: Option<f64>,
    pub(super) last_contact: Option<f64>,
    pub(super) peak_force: f64,
    pub(super) peak_time: Option<f64>,
    pub(super) impulse: f64,
    pub(super) touching_steps: u64,
    pairs: Vec<PairRecord>,
}

impl ContactWatch {
    pub(super) fn new(model: &Model) -> Self {
        Self { pairs: vec![PairRecord::default(); model.scene.pairs().len()], ..Self::default() }
    }

    /// Takes the forces of the last step; the name of the pair where it is the first that presses.
    pub(super) fn observe(&mut self, world: &World) -> Option<String> {
        let (mut force, mut pressed) = (0.0, false);
        for touch in world.touches() {
            let own = touch.force_w.norm();
            force += own;
            pressed |= touch.normal_force > 0.0;
            self.pairs[touch.pair].now += own;
        }
        let h = world.model().step;
        for touch in world.touches() {
            let record = &mut self.pairs[touch.pair];
            if record.now > 0.0 {
                record.peak = record.peak.max(record.now);
                record.impulse += record.now * h;
                record.time += h;
                record.now = 0.0;
            }
        }
        if !pressed {
            return None;
        }
        let time = world.state().time;
        self.touching_steps += 1;
        self.impulse += force * h;
        self.last_contact = Some(time);
        if force > self.peak_force {
            (self.peak_force, self.peak_time) = (force, Some(time));
        }
        if self.first_contact.is_some() {
            return None;
        }
        self.first_contact = Some(time);
        let pair = world.touches().find(|t| t.normal_force > 0.0)?.pair;
        Some(world.model().pair_name(pair))
    }

    /// Three figures for every pair that touched.
    pub(super) fn add_metrics(&self, model: &Model, metrics: &mut Vec<Metric>) {
        for (pair, record) in self.pairs.iter().enumerate().filter(|(_, r)| r.time > 0.0) {
            let [a, b] = model.scene.pairs()[pair].map(|c| model.collider_names[c].as_str());
            let mut add = |what: &str, value: f64, meaning| {
                metrics.push(Metric { name: format!("contact.{a}.{b}.{what}").into(), value: value.into(), meaning });
            };
            add("peak_force_n", record.peak, "largest force of this pair in a step");
            add("impulse_n_s", record.impulse, "force of this pair over time");
            add("time_s", record.time, "time in which this pair touched");
        }
    }
}
