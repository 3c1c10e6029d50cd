//! From a command to what an actuator delivers: delay, gain, lag, saturation, in this order.
//!
//!   acting command(t) = command(t − delay)           the first one acts until the second's delayed instant
//!   asked   = gain × what the nominal actuator would give (its own limit included)
//!   T ė     = asked − e                              e: delivered, where there is a lag
//!   output  = e within ± limit
//!
//! Commands are held between their instants, so the lag is solved exactly: e = asked + (e₀ − asked) exp(−t/T). Explicit
//! stages take it at their own time where the step resolves it (T ≥ 4 h); elsewhere, and in the one-solve schemes, a step
//! takes the mean of that exponential, so that the impulse is exact for a held command at any T, down to zero. Delayed
//! commands stand in [`State::pending`] with the time at which they act, and [`crate::World`] ends its steps there.

use super::Acting;
use crate::actuator::{Actuator, ActuatorKind, Command, CoordinatePoint, nominal_effort};
use crate::state::{Pending, State};

/// What happens to the command of one actuator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineEffect {
    /// Index into the model's actuators.
    pub actuator: usize,
    /// What happens.
    pub law: LineLaw,
}

/// The laws of the line from a command to an actuator's output.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LineLaw {
    /// Delivered over asked; gains of several effects multiply.
    Gain(f64),
    /// Time from a command to its action, s.
    Delay(f64),
    /// Time constant of a first-order lag, s.
    Lag(f64),
    /// Largest output, N or N·m; the smallest of several holds.
    Saturation(f64),
}

impl LineEffect {
    /// See [`super::EffectKind::driving_rate`].
    pub(super) fn driving_rate(&self) -> f64 {
        match self.law {
            LineLaw::Lag(time) if time > 0.0 => 1.0 / time,
            LineLaw::Lag(_) | LineLaw::Gain(_) | LineLaw::Delay(_) | LineLaw::Saturation(_) => 0.0,
        }
    }
}

/// One actuator's line.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Line {
    gain: f64,
    limit: f64,
    /// Time constant, and where the output stands in the effects' memory.
    lag: Option<(f64, usize)>,
    delay: Option<f64>,
}

/// The lines of a model's actuators; empty where no effect touches one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lines {
    lines: Vec<Line>,
    /// Whether an effect touches any.
    is_used: bool,
    has_delay: bool,
}

/// Instants closer than this are one, s.
const SAME_INSTANT: f64 = 1e-9;

/// Steps shorter than this share of a lag's time constant resolve it.
const RESOLVED: f64 = 0.25;

impl Lines {
    pub fn new(actuators: usize) -> Self {
        let line = Line { gain: 1.0, limit: f64::INFINITY, lag: None, delay: None };
        Self { lines: vec![line; actuators], is_used: false, has_delay: false }
    }

    pub fn attach(&mut self, effect: &LineEffect, memory: usize, actuators: &[Actuator]) -> Result<(), String> {
        let is_latch = |a: &Actuator| matches!(a.kind, ActuatorKind::LatchRelease { .. });
        if actuators.get(effect.actuator).is_none_or(is_latch) {
            return Err("needs an actuator that gives a force or torque".to_owned());
        }
        let line = &mut self.lines[effect.actuator];
        let at_least = |x: f64, low: f64| if x >= low { Ok(x) } else { Err(format!("{x} must be at least {low}")) };
        let taken = match effect.law {
            LineLaw::Gain(gain) => {
                line.gain *= gain;
                false
            }
            LineLaw::Saturation(limit) => {
                line.limit = line.limit.min(at_least(limit, 0.0)?);
                false
            }
            LineLaw::Lag(time) => line.lag.replace((at_least(time, 0.0)?, memory)).is_some(),
            LineLaw::Delay(delay) => line.delay.replace(at_least(delay, 0.0)?).is_some(),
        };
        self.is_used = true;
        self.has_delay |= line.delay.is_some();
        if taken { Err("the actuator has one of this kind already; remove one of them".to_owned()) } else { Ok(()) }
    }

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

/// The share of a lag's start that is left where a law is evaluated.
fn calc_kept(time: f64, acting: &Acting<'_>) -> f64 {
    let ratio = acting.step / time;
    match acting.since {
        Some(since) if ratio <= RESOLVED => (-since / time).exp(),
        _ if time > 0.0 => (1.0 - (-ratio).exp()) / ratio,
        _ => 0.0,
    }
}

impl LineEffect {
    pub(super) fn memory_names(&self) -> &'static [&'static str] {
        if matches!(self.law, LineLaw::Lag(_)) { &["output"] } else { &[] }
    }

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

/// Takes new commands into the lines, and lets those act whose time has come.
pub(crate) fn accept(model: &crate::Model, state: &mut State) {
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
