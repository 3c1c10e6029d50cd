//! The lines of a model's actuators: what effects do to their commands.

use crate::parts::{Actuator, ActuatorKind, LineEffect, LineLaw};

/// One actuator's line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Line {
    pub gain: f64,
    pub limit: f64,
    /// Time constant, and where the output stands in the effects' memory.
    pub lag: Option<(f64, usize)>,
    pub delay: Option<f64>,
}

/// The lines of a model's actuators; empty where no effect touches one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lines {
    pub lines: Vec<Line>,
    /// Whether an effect touches any.
    pub is_used: bool,
    pub has_delay: bool,
}

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
}
