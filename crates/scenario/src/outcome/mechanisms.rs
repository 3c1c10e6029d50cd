//! Watches mechanisms: when latches engage and let go, what they bear, how far struts travel.

use super::Metric;
use record::{Event, EventKind};
use serde_json::Value;
use sim::{MechanismKind, MechanismStatus, World};

/// The watcher.
#[derive(Clone, Debug, Default)]
pub(super) struct MechanismWatch {
    status: Vec<MechanismStatus>,
    engaged_at: Option<f64>,
    let_go: usize,
    peak_force: f64,
    peak_moment: f64,
    peak_strut_force: f64,
    travel: Vec<[f64; 2]>,
}

impl MechanismWatch {
    /// For a world at its start.
    pub(super) fn new(world: &World) -> Self {
        let status = world.mechanisms().map(|m| m.status).collect();
        let travel = world.mechanisms().map(|m| [m.deformation[0]; 2]).collect();
        Self { status, travel, ..Self::default() }
    }

    pub(super) fn observe(&mut self, world: &World, events: &mut Vec<Event>) {
        for report in world.mechanisms() {
            let mechanism = &world.model().mechanisms[report.index];
            if let MechanismKind::Strut(_) = mechanism.kind {
                let [low, high] = &mut self.travel[report.index];
                (*low, *high) = (low.min(report.deformation[0]), high.max(report.deformation[0]));
                self.peak_strut_force = self.peak_strut_force.max(report.tension.abs());
                continue;
            }
            self.peak_force = self.peak_force.max(report.wrench_w.force.norm());
            self.peak_moment = self.peak_moment.max(report.wrench_w.moment.norm());
            if report.status == self.status[report.index] {
                continue;
            }
            self.status[report.index] = report.status;
            let kind = match report.status {
                MechanismStatus::Engaged => EventKind::Capture,
                MechanismStatus::Released | MechanismStatus::Broken => EventKind::Loss,
                MechanismStatus::Open => EventKind::Note,
            };
            match kind {
                EventKind::Capture => self.engaged_at = self.engaged_at.or(Some(report.since)),
                EventKind::Loss => self.let_go += 1,
                _ => {}
            }
            let text = format!("{} {}", mechanism.name, report.status.name());
            events.push(Event { t: world.state().time, step: world.state().steps, kind, text });
        }
    }

    pub(super) fn add_metrics(&self, world: &World, metrics: &mut Vec<Metric>) {
        if world.model().mechanisms.is_empty() {
            return;
        }
        let mut add = |name: &'static str, value: Value, meaning| {
            metrics.push(Metric { name: name.into(), value, meaning });
        };
        let is_latch = |i: usize| matches!(world.model().mechanisms[i].kind, MechanismKind::Latch(_));
        let holding = world.mechanisms().filter(|m| is_latch(m.index) && m.status == MechanismStatus::Engaged).count();
        let travel = self.travel.iter().map(|[low, high]| high - low).fold(0.0, f64::max);
        add("latches_engaged", holding.into(), "latches that hold at the end");
        add(
            "latch_engaged_s",
            self.engaged_at.map_or(Value::Null, Value::from),
            "time at which the first latch engaged",
        );
        add("mechanisms_let_go", self.let_go.into(), "how often a latch let go or broke, or a weld broke");
        add("peak_hold_force_n", self.peak_force.into(), "largest force in a latch, weld or bushing");
        add("peak_hold_moment_n_m", self.peak_moment.into(), "largest moment in a latch, weld or bushing");
        add("peak_strut_force_n", self.peak_strut_force.into(), "largest force of a strut, stops included");
        add("strut_travel_m", travel.into(), "longest way of a strut between its shortest and longest length");
        let account = world.state().account;
        add("mechanism_work_j", account.mechanism_work.into(), "work of mechanisms: negative, stored or dissipated");
        add("mechanism_loss_j", account.mechanism_loss.into(), "what mechanisms dissipated by their laws");
    }
}
