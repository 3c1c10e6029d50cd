//! Watches a docking: the conditions at first contact, the sequence of latches, what is left of the motion, and how it ended.
//!
//! Of the visitor's frame F as seen from the port's frame P (z out of either side, nominal z against z, x along x):
//!
//!   axial p_z, lateral √(p_x² + p_y²), tilt between −z_F and z_P, roll about z_P,     closing −ṗ_z, all as P sees them

use super::Metric;
use super::interface::Interface;
use crate::spec::Docking;
use record::{Event, EventKind};
use serde_json::Value;
use sim::{Flow, MechanismStatus, Model, World};
use spatial::{Pose, Rot, Vec3, log_rotation};

/// Distance behind its closest approach that counts as moving away, m.
const AWAY: f64 = 0.02;

/// Where and how F stands and moves against P.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Relative {
    /// Along P's z, m.
    pub(super) axial: f64,
    /// Across it, m.
    pub(super) lateral: f64,
    /// Angle between the facing z axes, rad.
    pub(super) tilt: f64,
    /// About P's z, rad.
    pub(super) roll: f64,
    /// Against P's z, m/s.
    pub(super) closing: f64,
    /// Across it, m/s.
    pub(super) lateral_rate: f64,
    /// About P's x and y, rad/s.
    pub(super) tilt_rate: f64,
    /// About P's z, rad/s.
    pub(super) roll_rate: f64,
    /// Distance of the origins, m.
    pub(super) distance: f64,
    /// Speed of the visitor's base as the port's vehicle sees it, m/s.
    pub(super) speed: f64,
    /// Angular rate between the two bases, rad/s.
    pub(super) rate: f64,
}

/// Offset (m) and angle (rad) of a latch's two frames within which it has drawn in.
const SEATED: (f64, f64) = (2e-3, 5e-3);

/// The watcher.
#[derive(Clone, Debug)]
pub(super) struct DockingWatch {
    spec: Docking,
    ends: [(usize, usize); 2],
    capture: Vec<usize>,
    hard_dock: Vec<usize>,
    at_contact: Option<Relative>,
    nearest: f64,
    captured_at: Option<f64>,
    released_at: Option<f64>,
    hard_docked_at: Option<f64>,
    rest_since: Option<f64>,
    overload_at: Option<f64>,
    left_at: Option<f64>,
    engaged: Vec<(String, Option<f64>)>,
    interface: Interface,
    peak_force: f64,
}

impl DockingWatch {
    pub(super) fn new(spec: &Docking, model: &Model) -> Option<Self> {
        let ends = [model.link(&spec.visitor)?, model.link(&spec.port)?];
        let index = |name: &String| model.mechanisms.iter().position(|m| m.name == *name);
        let capture: Vec<usize> = spec.capture.iter().filter_map(index).collect();
        let hard_dock: Vec<usize> = spec.hard_dock.iter().filter_map(index).collect();
        let engaged = spec.capture.iter().chain(&spec.hard_dock).map(|n| (n.clone(), None)).collect();
        let latches: Vec<usize> = capture.iter().chain(&hard_dock).copied().collect();
        Some(Self {
            interface: Interface::new(model, ends[0].0, ends[1].0, &latches),
            peak_force: 0.0,
            spec: spec.clone(),
            ends,
            capture,
            hard_dock,
            at_contact: None,
            nearest: f64::INFINITY,
            captured_at: None,
            released_at: None,
            hard_docked_at: None,
            rest_since: None,
            overload_at: None,
            left_at: None,
            engaged,
        })
    }

    /// Looks at the world; `touched` at the first contact. Says when all is decided.
    pub(super) fn observe(&mut self, world: &World, touched: bool, events: &mut Vec<Event>) -> Flow {
        let (now, time) = (self.calc_relative(world), world.state().time);
        let force = self.interface.calc_force(world).norm();
        self.peak_force = self.peak_force.max(force);
        let mut note = |kind, text: String| events.push(Event { t: time, step: world.state().steps, kind, text });
        if touched {
            self.at_contact = Some(now);
        }
        self.nearest = self.nearest.min(now.distance);
        if self.overload_at.is_none() && self.spec.overload_n.is_some_and(|limit| force > limit) {
            self.overload_at = Some(time);
            note(EventKind::Loss, format!("overload: {force:.0} N between the two sides"));
        }
        let all = |list: &[usize]| !list.is_empty() && list.iter().all(|m| holds(world, *m));
        let seated = |list: &[usize]| all(list) && list.iter().all(|m| is_seated(world, *m));
        for (name, at) in self.engaged.iter_mut().filter(|(_, at)| at.is_none()) {
            let index = world.model().mechanisms.iter().position(|m| m.name == *name);
            *at = index.filter(|m| holds(world, *m)).map(|_| time);
        }
        if self.captured_at.is_none() && all(&self.capture) {
            self.captured_at = Some(time);
            note(EventKind::Capture, "captured: all capture latches hold".to_owned());
        }
        if self.hard_docked_at.is_none() && seated(&self.hard_dock) {
            self.hard_docked_at = Some(time);
        }
        if self.captured_at.is_some() && self.released_at.is_none() && !all(&self.capture) {
            self.released_at = Some(time);
            note(EventKind::Loss, "a capture latch let go".to_owned());
        }
        let at_rest = now.speed < self.spec.rest_m_per_s && now.rate < self.spec.rest_deg_per_s.to_radians();
        self.rest_since = if at_rest { self.rest_since.or(Some(time)) } else { None };
        self.decide(&now, time)
    }

    /// Whether nothing more can change: it is lost from sight, or docked and at rest.
    fn decide(&mut self, now: &Relative, time: f64) -> Flow {
        let away = now.distance > self.spec.lost_distance_m && now.distance > self.nearest + AWAY;
        if away && !self.is_held() {
            self.left_at.get_or_insert(time);
            return Flow::Stop;
        }
        let rested = self.rest_since.is_some_and(|since| time - since >= self.spec.rest_s);
        let docked = self.hard_dock.is_empty() || self.hard_docked_at.is_some();
        if rested && self.is_held() && docked { Flow::Stop } else { Flow::Continue }
    }

    fn is_held(&self) -> bool {
        self.captured_at.is_some() && self.released_at.is_none()
    }

    pub(super) fn calc_relative(&self, world: &World) -> Relative {
        let [f, p] = self.ends;
        let (frame, port) = (world.link_frame(f.0, f.1), world.link_frame(p.0, p.1));
        let (twist, carrier) = (world.link_twist(f.0, f.1), world.link_twist(p.0, p.1));
        let r = frame.pos - port.pos;
        let offset = port.rot.tr_mul(&r);
        let velocity = port.rot.tr_mul(&(twist.lin - carrier.at(&r)));
        let rate = port.rot.tr_mul(&(twist.ang - carrier.ang));
        let facing = Rot::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI);
        let relative = port.to_pose().rotation.inverse() * frame.to_pose().rotation * facing.inverse();
        let turn = log_rotation(&relative);
        let axis = relative * Vec3::z();
        let (speed, turn_rate) = calc_base_motion(world, f.0, p.0);
        Relative {
            axial: offset.z,
            lateral: offset.x.hypot(offset.y),
            tilt: axis.x.hypot(axis.y).atan2(axis.z),
            roll: turn.z,
            closing: -velocity.z,
            lateral_rate: velocity.x.hypot(velocity.y),
            tilt_rate: rate.x.hypot(rate.y),
            roll_rate: rate.z,
            distance: offset.norm(),
            speed,
            rate: turn_rate,
        }
    }

    /// Outcome and reason at the end of the run.
    pub(super) fn conclude(&self, world: &World, last_contact: Option<f64>) -> (&'static str, String) {
        let (now, time) = (self.calc_relative(world), world.state().time);
        let overload = self.overload_at.filter(|at| self.released_at.is_none_or(|released| *at <= released));
        if let Some(at) = self.released_at.filter(|_| overload.is_none()) {
            return ("released", format!("captured, but a capture latch let go at t = {at:.2} s"));
        }
        if let Some(at) = overload {
            let limit = self.spec.overload_n.unwrap_or(f64::INFINITY);
            return ("overload", format!("the force between the two sides passed {limit:.0} N at t = {at:.2} s"));
        }
        if let Some(at) = self.captured_at {
            return ("captured", self.tell_capture(at));
        }
        let Some(contact) = &self.at_contact else {
            return ("missed", format!("nothing touched; the frames came within {:.0} mm", 1e3 * self.nearest));
        };
        if let Some(at) = self.left_at {
            let (mm, deg) = (1e3 * contact.lateral, contact.tilt.to_degrees());
            return (
                "bounced",
                format!(
                    "touched {mm:.0} mm and {deg:.1} deg off, came within {:.0} mm, and was away at t = {at:.2} s",
                    1e3 * self.nearest
                ),
            );
        }
        let still = self.rest_since.is_some_and(|since| time - since >= self.spec.rest_s);
        if still && last_contact.is_some_and(|last| time - last < self.spec.rest_s) {
            let text =
                format!("in contact and at rest, {:.0} mm short of the port, without a capture", 1e3 * now.distance);
            return ("jammed", text);
        }
        ("time-out", format!("not captured when the time was over; {:.0} mm between the frames", 1e3 * now.distance))
    }

    fn tell_capture(&self, at: f64) -> String {
        let hard = self.hard_docked_at.map(|t| format!(", hard dock at {t:.2} s")).unwrap_or_default();
        let rest = self.rest_since.map(|t| format!(", at rest from {t:.2} s")).unwrap_or_default();
        format!("all capture latches held at t = {at:.2} s{hard}{rest}")
    }

    pub(super) fn add_metrics(&self, world: &World, outcome: &str, metrics: &mut Vec<Metric>) {
        let now = self.calc_relative(world);
        let optional = |value: Option<f64>| value.map_or(Value::Null, Value::from);
        let mut add = |name: &str, value: Value, meaning| {
            metrics.push(Metric { name: name.to_owned().into(), value, meaning });
        };
        add("captured", (outcome == "captured").into(), "all capture latches hold at the end, without overload");
        add("held", self.is_held().into(), "no capture latch let go");
        add("capture_time_s", optional(self.captured_at), "time at which all capture latches held");
        if !self.hard_dock.is_empty() {
            add(
                "hard_dock_time_s",
                optional(self.hard_docked_at),
                "time at which all latches of the hard dock held and had drawn in",
            );
        }
        add("rest_time_s", optional(self.rest_since), "time from which the relative motion stayed below the limits");
        for (name, at) in &self.engaged {
            add(&format!("latch.{name}.engaged_s"), optional(*at), "time at which this latch first held");
        }
        if let Some(contact) = &self.at_contact {
            let degrees = |x: f64| Value::from(x.to_degrees());
            add("contact_closing_m_per_s", contact.closing.into(), "closing speed at first contact");
            add("contact_lateral_m", contact.lateral.into(), "lateral misalignment at first contact");
            add("contact_tilt_deg", degrees(contact.tilt), "pitch/yaw misalignment at first contact, vector sum");
            add("contact_roll_deg", degrees(contact.roll), "roll misalignment at first contact");
            add("contact_lateral_m_per_s", contact.lateral_rate.into(), "lateral rate at first contact");
            add("contact_tilt_deg_per_s", degrees(contact.tilt_rate), "pitch/yaw rate at first contact, vector sum");
            add("contact_roll_deg_per_s", degrees(contact.roll_rate), "roll rate at first contact");
        }
        add(
            "residual_speed_m_per_s",
            now.speed.into(),
            "speed of the visitor's base as the port's vehicle sees it, at the end",
        );
        add("residual_rate_deg_per_s", now.rate.to_degrees().into(), "angular rate between the two bases at the end");
        add(
            "peak_interface_force_n",
            self.peak_force.into(),
            "largest resultant of contact and latches between the two sides",
        );
        add("nearest_m", self.nearest.into(), "least distance of the interface frames");
    }
}

/// Speed (m/s) of the base of vehicle `a` as an observer on `b` sees it, and the angular rate between them (rad/s).
pub(crate) fn calc_base_motion(world: &World, a: usize, b: usize) -> (f64, f64) {
    let [own, carrier] = [a, b].map(|v| world.kinematics(v).vel[0]);
    let [at, from] = [a, b].map(|v| world.state().bases[v].translation.vector);
    ((own.lin - carrier.at(&(at - from))).norm(), (own.ang - carrier.ang).norm())
}

/// Whether a latch's two frames coincide: its pull-in is over.
fn is_seated(world: &World, mechanism: usize) -> bool {
    let mechanism = &world.model().mechanisms[mechanism];
    let [a, b] = [mechanism.side_a, mechanism.side_b].map(|side| {
        let link = side.vehicle.map_or(Pose::identity(), |v| world.link_frame(v, side.link).to_pose());
        link * side.pose_la
    });
    let (shift, turn) = (a.translation.vector - b.translation.vector, a.rotation.angle_to(&b.rotation));
    shift.norm() < SEATED.0 && turn < SEATED.1
}

fn holds(world: &World, mechanism: usize) -> bool {
    world.state().mechanisms.get(mechanism).is_some_and(|m| m.status == MechanismStatus::Engaged)
}
