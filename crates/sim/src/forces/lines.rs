//! What a line makes of a command at an instant: [`crate::LineLaw`].

use super::Acting;
use crate::model::{Lines, Model};
use crate::parts::{ActuatorKind, Command, CoordinatePoint, LineEffect, LineLaw, nominal_effort};
use crate::state::{Pending, State};

impl Lines {
    /// Output and slope of an actuator that would nominally give `effort`.
    pub fn deliver(&self, index: usize, (effort, slope): (f64, f64), acting: &Acting<'_>) -> (f64, f64) {
        if !self.is_used {
            return (effort, slope);
        }
        let line = &self.lines[index];
        let (mut effort, mut slope) = (line.gain * effort, line.gain * slope);
        if let Some((time, memory)) = line.lag {
            let kept = calc_kept(time, acting);
            effort += (acting.state.effects[memory] - effort) * kept;
            slope *= 1.0 - kept;
        }
        if effort.abs() > line.limit {
            return (line.limit.copysign(effort), 0.0);
        }
        (effort, slope.max(0.0))
    }

    /// The command that acts on an actuator at present; before any was accepted, the first.
    pub fn command<'a>(&self, index: usize, state: &'a State) -> &'a Command {
        let acting = state.acting.get(index).filter(|_| self.has_delay && self.lines[index].delay.is_some());
        acting.unwrap_or(&state.commands[index])
    }
}

impl LineEffect {
    /// What the lag tends to at present: gain times the nominal effort.
    pub(super) fn calc_demand(&self, acting: &Acting<'_>) -> f64 {
        let (model, state, index) = (acting.model, acting.state, self.actuator);
        let lines = &model.effects.lines;
        let kind = &model.actuators[index].kind;
        let (q, v) = match *kind {
            ActuatorKind::JointDrive { coordinate, .. } => model.calc_motor_side(state, coordinate),
            _ => (0.0, 0.0),
        };
        let at = CoordinatePoint::still(q, v, acting.step);
        lines.lines[index].gain * nominal_effort(kind, lines.command(index, state), &at, (q, v)).0
    }

    /// The lag's output at the end of a step that began at `start`.
    pub(super) fn calc_lagged(&self, acting: &Acting<'_>, start: f64) -> f64 {
        let LineLaw::Lag(time) = self.law else { return start };
        let demand = self.calc_demand(acting);
        let left = if time > 0.0 { (-acting.step / time).exp() } else { 0.0 };
        demand + (start - demand) * left
    }
}

/// Instants closer than this are one, s.
const SAME_INSTANT: f64 = 1e-9;

/// Steps shorter than this share of a lag's time constant resolve it.
const RESOLVED: f64 = 0.25;

/// The share of a lag's start that is left where a law is evaluated.
fn calc_kept(time: f64, acting: &Acting<'_>) -> f64 {
    let ratio = acting.step / time;
    match acting.since {
        Some(since) if ratio <= RESOLVED => (-since / time).exp(),
        _ if time > 0.0 => (1.0 - (-ratio).exp()) / ratio,
        _ => 0.0,
    }
}

/// Takes new commands into the lines, and lets those act whose time has come.
pub(crate) fn accept(model: &Model, state: &mut State) {
    let lines = &model.effects.lines;
    if !lines.has_delay {
        return;
    }
    if state.acting.len() != state.commands.len() {
        // The first commands act until those after them do.
        state.acting.clone_from(&state.commands);
    }
    for (index, line) in lines.lines.iter().enumerate() {
        let Some(delay) = line.delay else { continue };
        let command = state.commands[index];
        let last = state.pending.iter().rev().find(|p| p.actuator == index).map_or(state.acting[index], |p| p.command);
        if command != last {
            state.pending.push(Pending { actuator: index, time: state.time + delay, command });
        }
    }
    let now = state.time + SAME_INSTANT;
    for pending in state.pending.iter().filter(|p| p.time <= now) {
        state.acting[pending.actuator] = pending.command;
    }
    state.pending.retain(|p| p.time > now);
}

/// When the next delayed command acts, s.
pub(crate) fn next_switch(state: &State) -> Option<f64> {
    state.pending.iter().map(|p| p.time).reduce(f64::min)
}
