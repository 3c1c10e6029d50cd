//! Numbers in attributes: what they must be, and what is wrong with them if they are not.

use super::errors::{UrdfProblem, cut};
use super::schema::{Attribute, Kind, Tag};

/// Beyond this a number is a slip, and squares of it would no longer be finite.
const LARGEST: f64 = 1e15;

/// The numbers of an attribute's text; empty for a text without numbers.
pub(crate) fn parse_numbers(tag: &Tag, attribute: &Attribute, text: &str) -> Result<Vec<f64>, UrdfProblem> {
    let kind = attribute.kind;
    let out_of_range =
        |rule| UrdfProblem::OutOfRange { tag: tag.name, attribute: attribute.name, text: cut(text), rule };
    let Some(expected) = number_count(kind) else {
        let is_empty_name = kind == Kind::Name && text.trim().is_empty();
        if kind == Kind::Flag && !matches!(text.trim(), "true" | "false") {
            return Err(out_of_range(rule_of(kind)));
        }
        return if is_empty_name { Err(out_of_range("is empty; write a name")) } else { Ok(Vec::new()) };
    };
    let mut numbers = Vec::with_capacity(expected);
    for word in text.split_whitespace() {
        let bad =
            || UrdfProblem::BadNumber { tag: tag.name, attribute: attribute.name, text: cut(text), word: cut(word) };
        let number = word.parse::<f64>().map(|x| unlimited(kind, x)).map_err(|_| bad())?;
        if number.is_nan() || (number.is_infinite() && !may_be_infinite(kind)) {
            return Err(bad());
        }
        numbers.push(number);
    }
    if kind == Kind::Scale {
        // pybullet's files have a fourth; the walk tells.
        numbers.truncate(expected);
    }
    if numbers.len() != expected {
        let (attribute, found) = (attribute.name, numbers.len());
        return Err(UrdfProblem::WrongLength { tag: tag.name, attribute, text: cut(text), found, expected });
    }
    broken_rule(kind, &numbers).map_or(Ok(numbers), |rule| Err(out_of_range(rule)))
}

fn number_count(kind: Kind) -> Option<usize> {
    match kind {
        Kind::Text | Kind::Name | Kind::Flag => None,
        Kind::Number | Kind::NumberOrInfinity => Some(1),
        Kind::Positive | Kind::NonNegative | Kind::NonNegativeOrInfinity => Some(1),
        Kind::AcuteAngle | Kind::HalfTurn => Some(1),
        Kind::Vec3 | Kind::Size | Kind::Scale => Some(3),
        Kind::Rgba | Kind::Quaternion => Some(4),
    }
}

/// Some write 1e16 for "no limit".
fn unlimited(kind: Kind, number: f64) -> f64 {
    if may_be_infinite(kind) && number.abs() > LARGEST { number.signum() * f64::INFINITY } else { number }
}

fn may_be_infinite(kind: Kind) -> bool {
    matches!(kind, Kind::NumberOrInfinity | Kind::NonNegativeOrInfinity)
}

fn broken_rule(kind: Kind, numbers: &[f64]) -> Option<&'static str> {
    let any = |broken: fn(f64) -> bool| numbers.iter().any(|x| broken(*x));
    let is_broken = match kind {
        Kind::Positive | Kind::Size => any(|x| x <= 0.0),
        Kind::NonNegative | Kind::NonNegativeOrInfinity => any(|x| x < 0.0),
        Kind::Scale => any(|x| x == 0.0),
        Kind::Rgba => any(|x| !(0.0..=1.0).contains(&x)),
        Kind::Quaternion => numbers.iter().all(|x| *x == 0.0),
        Kind::AcuteAngle => any(|x| x <= 0.0 || x >= std::f64::consts::FRAC_PI_2),
        Kind::HalfTurn => any(|x| x <= 0.0 || x >= std::f64::consts::PI),
        Kind::Text | Kind::Name | Kind::Number | Kind::NumberOrInfinity | Kind::Vec3 | Kind::Flag => false,
    };
    if is_broken {
        return Some(rule_of(kind));
    }
    any(|x| x.is_finite() && x.abs() > LARGEST).then_some("is beyond 1e15; check units (SI: m, kg, s, rad)")
}

fn rule_of(kind: Kind) -> &'static str {
    match kind {
        Kind::Size => "has an edge that is not positive; give three lengths in m",
        Kind::Positive => "is not positive; give a length in m",
        Kind::NonNegative | Kind::NonNegativeOrInfinity => "is negative; give its magnitude",
        Kind::Scale => "flattens the mesh; scales must not be zero",
        Kind::Rgba => "is no colour; give four numbers from 0 to 1",
        Kind::Quaternion => "is no rotation; give a unit quaternion x y z w",
        Kind::AcuteAngle => "is not between 0 and π/2; give an angle in rad",
        Kind::HalfTurn => "is not between 0 and π; give an angle in rad",
        Kind::Flag => "is neither true nor false; write one of them",
        Kind::Text | Kind::Name | Kind::Number | Kind::NumberOrInfinity | Kind::Vec3 => "is out of range",
    }
}
