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
//! commands stand in [`crate::State::pending`] with the time at which they act, and [`crate::World`] ends its steps there.

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
    pub(crate) fn driving_rate(&self) -> f64 {
        match self.law {
            LineLaw::Lag(time) if time > 0.0 => 1.0 / time,
            LineLaw::Lag(_) | LineLaw::Gain(_) | LineLaw::Delay(_) | LineLaw::Saturation(_) => 0.0,
        }
    }
}

impl LineEffect {
    pub(crate) fn memory_names(&self) -> &'static [&'static str] {
        if matches!(self.law, LineLaw::Lag(_)) { &["output"] } else { &[] }
    }
}
