//! Parameters of effects: what stands there, its unit, its range, and where the effect changes nothing.

use super::unit::{NONE, Unit};
use std::fmt;

/// Every number above zero.
pub(super) const POSITIVE: [f64; 2] = [f64::MIN_POSITIVE, f64::INFINITY];
/// Zero and every number above.
pub(super) const AT_LEAST_ZERO: [f64; 2] = [0.0, f64::INFINITY];
/// Every number.
pub(super) const ANY: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// A parameter of an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Its key.
    pub name: &'static str,
    /// What it is, in a few words that follow its name.
    pub meaning: &'static str,
    /// Its unit.
    pub unit: Unit,
    /// What stands there.
    pub shape: Shape,
    /// Where the effect changes nothing.
    pub neutral: Neutral,
    /// Every number is between these, ends included.
    pub range: [f64; 2],
    /// Whether it must be given; else the neutral value stands for it (the first of a choice, zero for a phase).
    pub is_required: bool,
    /// Whether it keeps a nominal value that is not zero where a list of parameters leaves it out.
    pub is_kept: bool,
    /// Power with which it goes with the inertia of a free body without known torques, of which only ratios show.
    pub inertia_power: f64,
}

/// What stands as a parameter's value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// One number.
    Number,
    /// Three numbers.
    Vector,
    /// Six numbers: xx, yy, zz, xy, xz, yz.
    Tensor,
    /// One number or three.
    NumberOrVector,
    /// One of these words.
    Choice(&'static [&'static str]),
}

/// Where an effect changes nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Neutral {
    /// At this value of every entry.
    Value(f64),
    /// At the value of the nominal model.
    Nominal,
    /// A parameter of shape: another one decides whether the effect is there.
    Shape,
}

/// A level, force or coefficient: zero is neutral.
pub(super) const fn zero(name: &'static str, range: [f64; 2], unit: Unit, meaning: &'static str) -> Parameter {
    Parameter {
        name,
        meaning,
        unit,
        shape: Shape::Number,
        neutral: Neutral::Value(0.0),
        range,
        is_required: true,
        is_kept: false,
        inertia_power: 0.0,
    }
}

/// A corrected number of the nominal model.
pub(super) const fn nominal(name: &'static str, range: [f64; 2], unit: Unit, meaning: &'static str) -> Parameter {
    Parameter { neutral: Neutral::Nominal, ..zero(name, range, unit, meaning) }
}

/// A parameter of shape.
pub(super) const fn shape(name: &'static str, range: [f64; 2], unit: Unit, meaning: &'static str) -> Parameter {
    Parameter { neutral: Neutral::Shape, ..zero(name, range, unit, meaning) }
}

/// One of a few words; the first where none is given.
pub(super) const fn choice(name: &'static str, words: &'static [&'static str], meaning: &'static str) -> Parameter {
    Parameter { shape: Shape::Choice(words), ..shape(name, ANY, NONE, meaning) }.optional()
}

impl Parameter {
    /// The same where another value is neutral.
    pub(super) const fn neutral_at(self, value: f64) -> Self {
        Self { neutral: Neutral::Value(value), ..self }
    }

    /// It may be left out.
    pub(super) const fn optional(self) -> Self {
        Self { is_required: false, ..self }
    }

    /// Left out, it keeps a nominal value that is not zero.
    pub(super) const fn kept(self) -> Self {
        Self { is_kept: true, ..self }
    }

    /// Three numbers.
    pub(super) const fn vector(self) -> Self {
        Self { shape: Shape::Vector, ..self }
    }

    /// One number or three.
    pub(super) const fn number_or_vector(self) -> Self {
        Self { shape: Shape::NumberOrVector, ..self }
    }

    /// Six numbers.
    pub(super) const fn tensor(self) -> Self {
        Self { shape: Shape::Tensor, ..self }
    }

    /// It goes with this power of a free body's inertia.
    pub(super) const fn with_inertia(self, power: f64) -> Self {
        Self { inertia_power: power, ..self }
    }

    /// What it is, with its unit and where it is neutral, for a reader.
    pub fn sentence(&self) -> String {
        let unit = match self.unit.text() {
            none if none.is_empty() => none,
            unit => format!(", {unit}"),
        };
        let neutral = match self.neutral {
            Neutral::Shape => String::new(),
            Neutral::Value(_) | Neutral::Nominal => format!("; neutral: {}", self.neutral),
        };
        format!("{}{unit}{neutral}.", self.meaning)
    }

    /// Its range, for a reader.
    pub fn range_text(&self) -> String {
        match (self.shape, self.range) {
            (Shape::Choice(words), _) => words.iter().map(|w| format!("`\"{w}\"`")).collect::<Vec<_>>().join(" or "),
            (_, POSITIVE) => "> 0".to_owned(),
            (_, AT_LEAST_ZERO) => "≥ 0".to_owned(),
            (_, ANY) => "any".to_owned(),
            (_, [low, high]) => format!("{low} … {high}"),
        }
    }
}

impl fmt::Display for Neutral {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Value(x) if x.is_infinite() => f.write_str("∞"),
            Self::Value(x) => write!(f, "{x}"),
            Self::Nominal => f.write_str("nominal"),
            Self::Shape => f.write_str("–"),
        }
    }
}
