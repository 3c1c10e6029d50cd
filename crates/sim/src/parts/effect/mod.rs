//! Effects: physics that a nominal model leaves out, each a small law with a place.

mod body;
mod joint;
mod line;
mod series;

pub use body::{Appendage, Axes, BodyAction, BodyEffect, BodyLaw, BodyMotion, BodyPlace, Load, Slosh, Sphere};
pub(crate) use joint::reversal_step;
pub use joint::{DryFriction, DryLevel, JointEffect, JointLaw, REACH};
pub use line::{LineEffect, LineLaw};
pub use series::Series;
pub(crate) use series::Shaft;

use spatial::Vec3;

/// Physics beyond the nominal model.
#[derive(Clone, Debug, PartialEq)]
pub struct Effect {
    /// For messages: its name and place.
    pub name: String,
    /// What it does.
    pub kind: EffectKind,
}

/// The families of effects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EffectKind {
    /// An effort on one joint coordinate.
    Joint(JointEffect),
    /// A gear that yields or has play, between a drive and its joint.
    Series(Series),
    /// What happens to a command on its way to the actuator's output.
    Line(LineEffect),
    /// A load on one body, or a part that moves inside it.
    Body(BodyEffect),
    /// A constant acceleration of everything, W axes, m/s²: a table out of level.
    Tilt(Vec3),
}

impl EffectKind {
    /// What its memory holds, one name each; empty for an effect without memory.
    pub fn memory_names(&self) -> &'static [&'static str] {
        match self {
            Self::Joint(effect) => effect.memory_names(),
            Self::Series(_) => &["deflection", "deflection_rate"],
            Self::Line(effect) => effect.memory_names(),
            Self::Body(effect) => effect.law.memory_names(),
            Self::Tilt(_) => &[],
        }
    }
}

impl EffectKind {
    /// The fastest that what it brings with it swings or settles, rad/s or 1/s; zero where it brings nothing that moves.
    pub(crate) fn own_rate(&self) -> f64 {
        let quick = |rate: f64| if rate.is_finite() { rate } else { 0.0 };
        match self {
            Self::Series(series) => quick((series.stiffness / series.rotor).sqrt()),
            Self::Body(effect) => match effect.law {
                BodyLaw::Load(_) => 0.0,
                BodyLaw::Slosh(slosh) => slosh.rate,
                BodyLaw::Appendage(appendage) => appendage.rate,
                BodyLaw::Sphere(sphere) => quick(sphere.c / sphere.inertia),
            },
            Self::Joint(_) | Self::Line(_) | Self::Tilt(_) => 0.0,
        }
    }

    /// The fastest that it drives the rest, rad/s or 1/s: a period in time, a lag.
    pub(crate) fn driving_rate(&self) -> f64 {
        match self {
            Self::Joint(effect) => effect.driving_rate(),
            Self::Line(line) => line.driving_rate(),
            Self::Body(BodyEffect { law: BodyLaw::Load(Load::Periodic { rate, .. }), .. }) => rate.abs(),
            Self::Body(_) | Self::Series(_) | Self::Tilt(_) => 0.0,
        }
    }
}
