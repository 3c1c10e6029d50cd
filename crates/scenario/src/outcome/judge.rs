//! Watches a run step by step and says at its end what became of it.

use super::base::BaseWatch;
use super::capture::CaptureWatch;
use super::contacts::ContactWatch;
use super::creep::CreepGauge;
use super::docking::DockingWatch;
use super::energy::EnergyWatch;
use super::keep_out::KeepOutWatch;
use super::mechanisms::MechanismWatch;
use super::motors::MotorWatch;
use super::{Metric, Outcome};
use crate::build::Mission;
use crate::spec::{Scenario, Strategy};
use record::{Event, EventKind};
use serde_json::Value;
use sim::{Flow, MomentumAudit, Observer, StepError, World};

/// Steps between two entries of the momentum audit.
const AUDIT_EVERY: u64 = 100;

/// The observer that every run has.
#[derive(Debug)]
pub struct Judge {
    capture: Option<CaptureWatch>,
    docking: Option<DockingWatch>,
    host: Option<BaseWatch>,
    contacts: ContactWatch,
    keep_out: Option<KeepOutWatch>,
    creep: CreepGauge,
    mechanisms: MechanismWatch,
    motors: MotorWatch,
    audit: Option<MomentumAudit>,
    energy: EnergyWatch,
    events: Vec<Event>,
}

impl Judge {
    /// For a mission at its start.
    pub fn new(mission: &Mission) -> Self {
        let (world, scenario) = (&mission.world, &mission.scenario);
        let model = world.model();
        let capture = match &scenario.strategy {
            Strategy::TrackAndGrasp(spec) => CaptureWatch::new(spec, model),
            _ => None,
        };
        Self {
            capture,
            docking: scenario.docking.as_ref().and_then(|spec| DockingWatch::new(spec, model)),
            host: host(scenario).and_then(|name| model.vehicle(name)).map(|v| BaseWatch::new(world, v)),
            contacts: ContactWatch::new(model),
            keep_out: KeepOutWatch::new(&scenario.keep_out, model),
            creep: CreepGauge::new(mission.steps, world.model().step),
            mechanisms: MechanismWatch::new(world),
            motors: MotorWatch::new(scenario, world),
            audit: MomentumAudit::applies(world).then(|| MomentumAudit::new(world)),
            energy: EnergyWatch::new(world),
            events: Vec::new(),
        }
    }

    /// Events so far.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// Whether this step brought the first contact.
    fn observe_contact(&mut self, world: &World) -> bool {
        let Some(pair) = self.contacts.observe(world) else { return false };
        let (time, step) = (world.state().time, world.state().steps);
        let text = format!("first contact: {pair}");
        self.events.push(Event { t: time, step, kind: EventKind::Contact, text });
        true
    }

    /// What became of the run.
    pub fn conclude(mut self, world: &World, ended: &Result<(), StepError>) -> Outcome {
        if let Some(audit) = &mut self.audit {
            audit.update(world);
        }
        let (outcome, reason) = match (ended, &self.capture, &self.docking) {
            (Err(error), ..) => ("diverged", error.to_string()),
            (Ok(()), Some(capture), _) => capture.conclude(world),
            (Ok(()), None, Some(docking)) => docking.conclude(world, self.contacts.last_contact),
            (Ok(()), None, None) => ("completed", "the run came to its end".to_owned()),
        };
        let mut metrics = self.calc_metrics(world, outcome);
        let warnings = self.energy.add_metrics(world, &mut metrics).into_iter().collect();
        Outcome { outcome, reason, metrics, events: self.events, warnings }
    }

    fn calc_metrics(&self, world: &World, outcome: &str) -> Vec<Metric> {
        let mut metrics = Vec::new();
        let mut add = |name: &'static str, value: Value, meaning| {
            metrics.push(Metric { name: name.into(), value, meaning });
        };
        if let Some(capture) = &self.capture {
            let (rate, speed) = capture.calc_relative_motion(world);
            add("captured", (outcome == "captured").into(), "held by friction and relative motion stopped");
            add("grasp_time_s", optional(capture.grasp_time), "time at which the fingers held the bar");
            add("stopped_time_s", optional(capture.stopped_time), "time at which the relative motion was stopped");
            add("grasp_slip_m", capture.slip.into(), "largest motion of the bar in the fingers, elastic part included");
            add(
                "grasp_rotation_deg",
                capture.rotation.to_degrees().into(),
                "largest rotation of the bar in the fingers",
            );
            add("residual_rate_deg_per_s", rate.to_degrees().into(), "angular rate between the two buses at the end");
            add("residual_speed_m_per_s", speed.into(), "speed between tool and grapple frame at the end");
        }
        if let Some(why) = lost_because(outcome, self.capture.as_ref()) {
            add("lost_because", why.into(), "class of the failure");
        }
        let contacts = &self.contacts;
        add("first_contact_s", optional(contacts.first_contact), "time of the first contact");
        add("peak_contact_force_n", contacts.peak_force.into(), "largest sum of contact forces in a step");
        add("peak_contact_force_s", optional(contacts.peak_time), "when that was");
        add("contact_impulse_n_s", contacts.impulse.into(), "sum of contact forces over time");
        add("contact_time_s", (contacts.touching_steps as f64 * world.model().step).into(), "time in contact");
        add("ended_s", world.state().time.into(), "time at which the run ended");
        if let Some(creep) = self.creep.read(world) {
            add("held_points", creep.points.into(), "touching points held through the last seconds");
            add("creep_slip_m", creep.slip.into(), "slip of held points in the last seconds, less elastic deflection");
            add("creep_rotation_rad", creep.rotation.into(), "rotation of held points likewise");
            add(
                "held_motion_m",
                creep.total_slip.into(),
                "motion of held points in the last seconds, elastic part included",
            );
            add("held_rotation_rad", creep.total_rotation.into(), "rotation of the held body likewise");
        }
        if let Some(docking) = &self.docking {
            docking.add_metrics(world, outcome, &mut metrics);
        }
        if let Some(host) = &self.host {
            host.add_metrics(&mut metrics);
        }
        if let Some(keep_out) = &self.keep_out {
            keep_out.add_metrics(&mut metrics);
        }
        self.contacts.add_metrics(world.model(), &mut metrics);
        self.mechanisms.add_metrics(world, &mut metrics);
        self.motors.add_metrics(&mut metrics);
        self.add_momentum_drift(&mut metrics);
        metrics
    }

    fn add_momentum_drift(&self, metrics: &mut Vec<Metric>) {
        let mut add = |name: &'static str, value: f64, meaning| {
            metrics.push(Metric { name: name.into(), value: value.into(), meaning });
        };
        if let Some(audit) = &self.audit {
            add(
                "momentum_drift_linear",
                audit.linear_drift,
                "drift of linear momentum over the largest Σ m‖v‖, from the links",
            );
            add(
                "momentum_drift_angular",
                audit.angular_drift,
                "drift of angular momentum over the largest Σ (lever × m‖v‖ + spin)",
            );
        }
    }
}

fn optional(value: Option<f64>) -> Value {
    value.map_or(Value::Null, Value::from)
}

impl Observer for Judge {
    fn observe(&mut self, world: &World) -> Flow {
        let touched = world.state().steps > 0 && self.observe_contact(world);
        let flow = match &mut self.docking {
            Some(docking) => docking.observe(world, touched, &mut self.events),
            None => Flow::Continue,
        };
        if let Some(host) = &mut self.host {
            host.observe(world);
        }
        if let Some(keep_out) = &mut self.keep_out {
            keep_out.observe(world, &mut self.events);
        }
        if let Some(capture) = &mut self.capture {
            capture.observe(world, &mut self.events);
        }
        self.mechanisms.observe(world, &mut self.events);
        self.motors.observe(world, &mut self.events);
        self.creep.observe(world);
        if world.state().steps.is_multiple_of(AUDIT_EVERY)
            && let Some(audit) = &mut self.audit
        {
            audit.update(world);
        }
        flow
    }
}

/// The vehicle whose base is disturbed: the servicer, or the one that is docked to.
fn host(scenario: &Scenario) -> Option<&str> {
    match (&scenario.strategy, &scenario.docking) {
        (Strategy::TrackAndGrasp(spec), _) => Some(&spec.servicer),
        (_, Some(docking)) => docking.port.split('/').next(),
        _ => None,
    }
}

/// Class of a failure: slipped, bounced, missed, jammed, overload, released or time-out; `None` where nothing failed.
fn lost_because(outcome: &str, capture: Option<&CaptureWatch>) -> Option<&'static str> {
    if capture.is_some() {
        return match outcome {
            "lost" => Some("slipped"),
            "not-reached" => Some("missed"),
            "not-finished" | "not-stopped" => Some("time-out"),
            _ => None,
        };
    }
    ["bounced", "missed", "jammed", "overload", "released", "time-out"].into_iter().find(|o| *o == outcome)
}
