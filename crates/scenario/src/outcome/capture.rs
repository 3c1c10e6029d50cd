//! Watches a capture: contact, grasp, what slips in it, and what is left of the relative motion.

use crate::build::{calc_error, halves};
use crate::spec::TrackAndGrasp;
use crate::strategy::{Phase, phase_of};
use record::{Event, EventKind};
use sim::{Model, World};
use spatial::{Pose, Twist};

/// Slip (m) and rotation (rad) in the grasp beyond which the target counts as lost.
const LOST: (f64, f64) = (0.02, 0.1);
/// Angular rate (rad/s) and speed (m/s) between the two buses that count as "stopped".
const STOPPED: (f64, f64) = (1e-3, 2e-3);
/// Time without contact from both sides after which the target counts as lost, s.
const PATIENCE: f64 = 0.25;

/// The watcher.
#[derive(Clone, Debug)]
pub(super) struct CaptureWatch {
    servicer: usize,
    target: usize,
    tool: usize,
    grapple: usize,
    phase: Option<Phase>,
    pub(super) grasp_time: Option<f64>,
    pub(super) stopped_time: Option<f64>,
    grasp_pose: Option<Pose>,
    pub(super) slip: f64,
    pub(super) rotation: f64,
    untouched_since: Option<f64>,
    pub(super) lost: Option<(f64, String)>,
    pub(super) nearest: f64,
}

impl CaptureWatch {
    pub(super) fn new(spec: &TrackAndGrasp, model: &Model) -> Option<Self> {
        let ((servicer, tool), (target, grapple)) = (model.link(&spec.tool_frame)?, model.link(&spec.grapple_frame)?);
        Some(Self {
            servicer,
            target,
            tool,
            grapple,
            phase: None,
            grasp_time: None,
            stopped_time: None,
            grasp_pose: None,
            slip: 0.0,
            rotation: 0.0,
            untouched_since: None,
            lost: None,
            nearest: f64::INFINITY,
        })
    }

    pub(super) fn observe(&mut self, world: &World, events: &mut Vec<Event>) {
        let (time, step) = (world.state().time, world.state().steps);
        let phase = phase_of(world);
        let (tool, grapple) =
            (world.link_frame(self.servicer, self.tool), world.link_frame(self.target, self.grapple).to_pose());
        self.nearest = self.nearest.min((grapple.translation.vector - tool.pos).norm());
        if phase != self.phase {
            if phase == Some(Phase::Damp) {
                self.grasp_time = Some(time);
                self.grasp_pose = Some(tool.to_pose().inverse() * grapple);
            }
            if let Some(text) = phase.map(describe) {
                let kind = if phase == Some(Phase::Damp) { EventKind::Capture } else { EventKind::Phase };
                events.push(Event { t: time, step, kind, text: text.to_owned() });
            }
            self.phase = phase;
        }
        if let Some(start) = self.grasp_pose.filter(|_| self.lost.is_none()) {
            let goal = tool.to_pose() * start;
            let held = world.link_frame(self.target, self.grapple);
            let (turn, shift) = halves(&calc_error(&held, &goal));
            self.slip = self.slip.max(shift.norm());
            self.rotation = self.rotation.max(turn.norm());
            self.watch_hold(world, events);
            let (rate, speed) = self.calc_relative_motion(world);
            if self.stopped_time.is_none() && rate < STOPPED.0 && speed < STOPPED.1 {
                self.stopped_time = Some(time);
                let text = format!("relative motion stopped: {:.4} deg/s, {:.2} mm/s", rate.to_degrees(), 1e3 * speed);
                events.push(Event { t: time, step, kind: EventKind::Note, text });
            }
        }
    }

    fn watch_hold(&mut self, world: &World, events: &mut Vec<Event>) {
        let time = world.state().time;
        let touching = world.touches().any(|t| {
            let (a, b) = world.model().pair_bodies(t.pair);
            let owner = |body: usize| world.model().owners.get(body).map(|o| o.0);
            let pair = (owner(a), owner(b));
            t.normal_force > 0.0
                && (pair == (Some(self.servicer), Some(self.target))
                    || pair == (Some(self.target), Some(self.servicer)))
        });
        self.untouched_since = if touching { None } else { self.untouched_since.or(Some(time)) };
        let loss = if self.untouched_since.is_some_and(|since| time - since > PATIENCE) {
            Some("the fingers lost contact".to_owned())
        } else if self.slip > LOST.0 {
            Some(format!("the target slipped {:.0} mm in the fingers", 1e3 * self.slip))
        } else if self.rotation > LOST.1 {
            Some(format!("the target turned {:.1} deg in the fingers", self.rotation.to_degrees()))
        } else {
            None
        };
        if let Some(text) = loss {
            events.push(Event { t: time, step: world.state().steps, kind: EventKind::Loss, text: text.clone() });
            self.lost = Some((time, text));
        }
    }

    /// Angular rate between the two buses, rad/s, and speed between tool and grapple frame, m/s.
    pub(super) fn calc_relative_motion(&self, world: &World) -> (f64, f64) {
        let bus = |v: usize| world.kinematics(v).vel[0].ang;
        let tool: Twist = world.link_twist(self.servicer, self.tool);
        let grapple = world.link_twist(self.target, self.grapple);
        ((bus(self.servicer) - bus(self.target)).norm(), (tool.lin - grapple.lin).norm())
    }

    /// Outcome and reason at the end of the run.
    pub(super) fn conclude(&self, world: &World) -> (&'static str, String) {
        let (rate, speed) = self.calc_relative_motion(world);
        if let Some((time, text)) = &self.lost {
            return ("lost", format!("{text} at t = {time:.2} s"));
        }
        let Some(time) = self.grasp_time else {
            let mm = 1e3 * self.nearest;
            return (
                "not-reached",
                format!("the fingers never closed on the bar; the tool came within {mm:.0} mm of it"),
            );
        };
        if self.phase != Some(Phase::Hold) {
            return (
                "not-finished",
                format!("gripped at t = {time:.2} s, but the run ended before the motion was stopped"),
            );
        }
        if rate > STOPPED.0 || speed > STOPPED.1 {
            let text = format!("held, but still moving at {:.3} deg/s and {:.2} mm/s", rate.to_degrees(), 1e3 * speed);
            return ("not-stopped", text);
        }
        let text = format!(
            "gripped at t = {time:.2} s and held by friction; relative motion at the end {:.4} deg/s, {:.3} mm/s",
            rate.to_degrees(),
            1e3 * speed
        );
        ("captured", text)
    }
}

fn describe(phase: Phase) -> &'static str {
    match phase {
        Phase::Acquire => "acquire: navigation makes out the target",
        Phase::Reach => "reach: on the way to the standoff point",
        Phase::Approach => "approach: on the last straight, motion matched",
        Phase::Close => "close: fingers closing",
        Phase::Damp => "gripped: stopping the relative motion",
        Phase::Hold => "hold: arm at rest",
        Phase::Abort => "abort: the approach did not come to its end",
    }
}
