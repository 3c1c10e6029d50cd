//! Watches a run step by step and says at its end what became of it.

use super::capture::CaptureWatch;
use super::creep::CreepGauge;
use super::mechanisms::MechanismWatch;
use super::{Metric, Outcome};
use crate::build::Mission;
use crate::spec::Strategy;
use record::{Event, EventKind};
use serde_json::Value;
use sim::{Energy, Flow, MomentumAudit, Observer, StepError, World};

/// Steps between two entries of the momentum audit.
const AUDIT_EVERY: u64 = 100;

/// The observer that every run has.
#[derive(Clone, Debug)]
pub struct Judge {
    capture: Option<CaptureWatch>,
    creep: CreepGauge,
    mechanisms: MechanismWatch,
    audit: Option<MomentumAudit>,
    energy_start: Energy,
    first_contact: Option<f64>,
    peak_force: f64,
    impulse: f64,
    touching_steps: u64,
    events: Vec<Event>,
}

impl Judge {
    /// For a mission at its start.
    pub fn new(mission: &Mission) -> Self {
        let world = &mission.world;
        let capture = match &mission.scenario.strategy {
            Strategy::TrackAndGrasp(spec) => CaptureWatch::new(spec, world.model()),
            _ => None,
        };
        Self {
            capture,
            creep: CreepGauge::new(mission.steps, world.model().step),
            mechanisms: MechanismWatch::new(world),
            audit: MomentumAudit::applies(world).then(|| MomentumAudit::new(world)),
            energy_start: Energy::of(world),
            first_contact: None,
            peak_force: 0.0,
            impulse: 0.0,
            touching_steps: 0,
            events: Vec::new(),
        }
    }

    /// Events so far.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    fn observe_contact(&mut self, world: &World) {
        let (mut force, mut largest) = (0.0, 0.0_f64);
        for touch in world.touches() {
            force += touch.force_w.norm();
            largest = largest.max(touch.normal_force);
        }
        if largest <= 0.0 {
            return;
        }
        self.touching_steps += 1;
        self.peak_force = self.peak_force.max(force);
        self.impulse += force * world.model().step;
        if self.first_contact.is_none() {
            let (time, step) = (world.state().time, world.state().steps);
            self.first_contact = Some(time);
            let pair = world.touches().find(|t| t.normal_force > 0.0).map(|t| world.model().pair_name(t.pair));
            let text = format!("first contact: {}", pair.unwrap_or_default());
            self.events.push(Event { t: time, step, kind: EventKind::Contact, text });
        }
    }

    /// What became of the run.
    pub fn conclude(mut self, world: &World, ended: &Result<(), StepError>) -> Outcome {
        if let Some(audit) = &mut self.audit {
            audit.update(world);
        }
        let (outcome, reason) = match (ended, &self.capture) {
            (Err(error), _) => ("diverged", error.to_string()),
            (Ok(()), Some(capture)) => capture.conclude(world),
            (Ok(()), None) => ("completed", "the run came to its end".to_owned()),
        };
        let metrics = self.calc_metrics(world, outcome);
        Outcome { outcome, reason, metrics, events: self.events }
    }

    fn calc_metrics(&self, world: &World, outcome: &str) -> Vec<Metric> {
        let mut metrics = Vec::new();
        let mut add = |name, value: Value, meaning| metrics.push(Metric { name, value, meaning });
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
        add("first_contact_s", optional(self.first_contact), "time of the first contact");
        add("peak_contact_force_n", self.peak_force.into(), "largest sum of contact forces in a step");
        add("contact_impulse_n_s", self.impulse.into(), "sum of contact forces over time");
        add("contact_time_s", (self.touching_steps as f64 * world.model().step).into(), "time in contact");
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
        self.mechanisms.add_metrics(world, &mut metrics);
        self.add_accounts(world, &mut metrics);
        metrics
    }

    fn add_accounts(&self, world: &World, metrics: &mut Vec<Metric>) {
        let mut add = |name, value: f64, meaning| metrics.push(Metric { name, value: value.into(), meaning });
        if let Some(audit) = &self.audit {
            add(
                "momentum_drift_linear",
                audit.linear_drift,
                "drift of linear momentum over the largest Σ m‖v‖, from the links",
            );
            add("momentum_drift_angular", audit.angular_drift, "drift of angular momentum over the largest Σ ‖L_link‖");
        }
        let (now, account) = (Energy::of(world), world.state().account);
        let change = now.kinetic - self.energy_start.kinetic + now.potential - self.energy_start.potential;
        let external = if world.model().environment.is_still() { account.external_work } else { 0.0 };
        let work = account.actuator_work
            + account.passive_joint_work
            + account.contact_work
            + account.mechanism_work
            + account.effect_work
            + external;
        add("kinetic_energy_j", now.kinetic, "at the end");
        add("actuator_work_j", account.actuator_work, "work of the joint actuators");
        add("contact_work_j", account.contact_work, "work of contact forces: negative, stored or dissipated");
        add("joint_loss_j", account.passive_joint_work, "work of joint damping, friction and stops");
        add("integrator_energy_j", change - work, "change of energy that no force explains: the integrator's own");
    }
}

fn optional(value: Option<f64>) -> Value {
    value.map_or(Value::Null, Value::from)
}

impl Observer for Judge {
    fn observe(&mut self, world: &World) -> Flow {
        if world.state().steps > 0 {
            self.observe_contact(world);
        }
        if let Some(capture) = &mut self.capture {
            capture.observe(world, &mut self.events);
        }
        self.mechanisms.observe(world, &mut self.events);
        self.creep.observe(world);
        if world.state().steps.is_multiple_of(AUDIT_EVERY)
            && let Some(audit) = &mut self.audit
        {
            audit.update(world);
        }
        Flow::Continue
    }
}
