//! Hypotheses: an effect at a place, with coordinates in which it is fitted and points at which it is screened.
//!
//! A coordinate is a parameter, its logarithm (positive ones), or a combination that stays regular where the effect is neutral (m p in place of p,
//! the square of a mean motion, level and ellipse in place of two levels and an angle). A screen point is a place in these coordinates: either
//! beside neutral, one column a direction, or far from it, where the effect has no derivative at neutral (a secant).

use scenario::spec::{Effect, ParamValue};
use std::collections::BTreeMap;

/// One fitted coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinate {
    /// Parameter it belongs to; `com[1]` is a component of a vector.
    pub key: &'static str,
    /// How it stands for the parameter.
    pub scale: Scale,
    /// Value at which the effect does nothing, or a typical one where that is not the coordinate that turns it off.
    pub neutral: f64,
    /// Smallest and largest value.
    pub bounds: [f64; 2],
}

/// How a coordinate stands for its parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// The parameter itself.
    Linear,
    /// Its natural logarithm.
    Log,
}

/// What a set of coordinates means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Each coordinate is its parameter.
    Direct,
    /// (m, m·com): a point mass.
    Moment,
    /// (k, k·anchor, d): a spring to a point.
    Anchored,
    /// (k, k·q_rest).
    Rested,
    /// (i, ln rate): damper inertia, and torque per speed and inertia.
    RateOfInertia,
    /// Square of the parameter.
    Squared,
    /// Three coordinates (level, a, b): μ₁,₂ = level ± √(a² + b²), angle = ½ atan2(b, a).
    Ellipse,
    /// (a, b, …): amplitude √(a² + b²), phase atan2(b, a), of a scalar.
    Phasor,
    /// The parameter's inverse first, then the others as they are.
    Compliance,
    /// One coordinate is what its parameter exceeds another by: a breakaway level is not below the sliding one.
    Excess {
        /// The coordinate that is an excess.
        of: usize,
        /// The coordinate that it exceeds.
        over: usize,
    },
}

/// Where a hypothesis is screened.
#[derive(Clone, Debug, PartialEq)]
pub struct ScreenPoint {
    /// What tells this point from the others of the hypothesis: "v_s = 0.02".
    pub label: String,
    /// Coordinates at which each column is taken; the column is the change of the residual from nominal, over `step`.
    pub columns: Vec<Column>,
}

/// One column of a screen.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Coordinates where nothing acts yet.
    pub base: Vec<f64>,
    /// Direction from there.
    pub direction: Vec<f64>,
    /// First step along it; a secant keeps it.
    pub step: f64,
    /// Whether the step stays as it is.
    pub secant: bool,
}

/// Whether an effect corrects a number that the nominal model has, or adds physics.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Tier {
    /// A nominal number.
    Nominal,
    /// Physics or a fault.
    Exotic,
}

/// An effect at a place.
#[derive(Clone, Debug, PartialEq)]
pub struct Hypothesis {
    /// Name, as in the table of effects.
    pub name: &'static str,
    /// Place, as in the table of effects.
    pub place: String,
    /// Parameters that are not fitted.
    pub constants: Vec<(&'static str, ParamValue)>,
    /// What is fitted.
    pub coordinates: Vec<Coordinate>,
    /// What the coordinates mean.
    pub encoding: Encoding,
    /// Where it is screened.
    pub screens: Vec<ScreenPoint>,
    /// Kind of claim.
    pub tier: Tier,
    /// Coordinates that no data of this kind can show; they stay at neutral.
    pub held: Vec<usize>,
    /// Whether its screen is dear: many points, or memory whose start is free too.
    pub is_dear: bool,
    /// Standard deviations of the coordinates where the scenario gives them a tolerance; empty for a finding.
    pub tolerance: Vec<f64>,
}

impl Coordinate {
    /// A linear coordinate without bounds.
    pub fn free(key: &'static str, neutral: f64) -> Self {
        Self { key, scale: Scale::Linear, neutral, bounds: [f64::NEG_INFINITY, f64::INFINITY] }
    }

    /// A linear coordinate that is not negative.
    pub fn level(key: &'static str, neutral: f64) -> Self {
        Self { bounds: [0.0, f64::INFINITY], ..Self::free(key, neutral) }
    }

    /// A positive one, by its logarithm; `neutral` and bounds are the parameter's.
    pub fn log(key: &'static str, neutral: f64, bounds: [f64; 2]) -> Self {
        Self { key, scale: Scale::Log, neutral: neutral.ln(), bounds: bounds.map(f64::ln) }
    }

    /// The parameter at a value of the coordinate.
    pub fn parameter(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => value,
            Scale::Log => value.exp(),
        }
    }

    /// Derivative of the parameter by the coordinate.
    pub fn slope(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => 1.0,
            Scale::Log => value.exp(),
        }
    }
}

/// The law that stands at a contact for what drags a body that slides there.
const AT_CONTACT: &str = "friction-viscous";
/// What stands at a contact for a place that is measured wrong by a constant.
const MISPLACED: &str = "contact-geometry-offset";
/// What is held against the former beside the numbers that it takes: as much as two or three of these cost.
const BURDEN: f64 = 25.0;

/// Another reading of what a hypothesis has become.
#[derive(Clone, Debug, PartialEq)]
pub struct Alternative {
    /// Name of the effect.
    pub name: &'static str,
    /// Whether it stands at a contact, and not at the same place.
    pub is_at_contact: bool,
    /// Its coordinates.
    pub coordinates: Vec<f64>,
    /// Those of them that stay as they are.
    pub held: Vec<usize>,
}

impl Hypothesis {
    /// `name at place`.
    pub fn title(&self) -> String {
        format!("{} at {}", self.name, self.place)
    }

    /// Whether the cost has a valley for each frequency, or a long flat one along a speed or a stiffness, and one refit may end in the wrong place.
    pub fn has_valleys(&self) -> bool {
        matches!(
            self.name,
            "slosh"
                | "flexible-appendage"
                | "friction-stribeck"
                | "friction-dwell-time"
                | "joint-stribeck-friction"
                | "joint-elasticity"
                | "joint-backlash"
        )
    }

    /// Whether it is a nominal number that may be off within its tolerance, and no finding.
    pub fn is_tolerated(&self) -> bool {
        !self.tolerance.is_empty()
    }

    /// The same number screened beside where it stands already instead of beside its nominal value.
    pub fn screened_beside(mut self, x: &[f64]) -> Self {
        for column in self.screens.iter_mut().flat_map(|s| &mut s.columns) {
            column.base = x.to_vec();
        }
        self
    }

    /// Whether it concerns nothing but how a sensor reads what there is to be read at the time.
    pub fn is_reading(&self) -> bool {
        matches!(self.name, "sensor-bias" | "sensor-scale" | "sensor-misalignment")
    }

    /// Neutral or typical coordinates.
    pub fn neutral(&self) -> Vec<f64> {
        self.coordinates.iter().map(|c| c.neutral).collect()
    }

    /// The nearest coordinates within the bounds.
    pub fn clamped(&self, x: &[f64]) -> Vec<f64> {
        x.iter().zip(&self.coordinates).map(|(x, c)| x.clamp(c.bounds[0], c.bounds[1])).collect()
    }

    /// Whether a coordinate stands at one of its bounds, zero aside.
    pub fn is_at_bound(&self, x: &[f64]) -> bool {
        x.iter().zip(&self.coordinates).any(|(x, c)| *x != 0.0 && c.bounds.contains(x))
    }

    /// The effect at some coordinates.
    pub fn effect(&self, x: &[f64]) -> Effect {
        let mut params: BTreeMap<String, ParamValue> =
            self.constants.iter().map(|(k, v)| ((*k).to_owned(), v.clone())).collect();
        for (key, value) in self.decode(x) {
            set(&mut params, key, value);
        }
        Effect { name: self.name.to_owned(), place: self.place.clone(), params }
    }

    /// The effect's parameters at some coordinates, component by component.
    pub fn decode(&self, x: &[f64]) -> Vec<(&'static str, f64)> {
        let plain: Vec<(&'static str, f64)> =
            self.coordinates.iter().zip(x).map(|(c, x)| (c.key, c.parameter(*x))).collect();
        let value = |i: usize| plain[i].1;
        let over = |i: usize, d: f64| (plain[i].0, if d == 0.0 { 0.0 } else { value(i) / d });
        match self.encoding {
            Encoding::Direct => plain,
            Encoding::Excess { of, over: base } => {
                let mut out = plain.clone();
                out[of].1 += plain[base].1;
                out
            }
            Encoding::Moment => vec![plain[0], over(1, value(0)), over(2, value(0)), over(3, value(0))],
            Encoding::Anchored => {
                vec![plain[0], over(1, value(0)), over(2, value(0)), over(3, value(0)), plain[4]]
            }
            Encoding::Rested => vec![plain[0], over(1, value(0))],
            Encoding::RateOfInertia => vec![plain[0], (plain[1].0, value(0) * value(1))],
            Encoding::Squared => vec![(plain[0].0, value(0).max(0.0).sqrt())],
            Encoding::Ellipse => {
                let (level, a, b) = (value(0), value(1), value(2));
                let half = a.hypot(b);
                vec![("mu_1", level + half), ("mu_2", (level - half).max(1e-6)), ("angle", 0.5 * b.atan2(a))]
            }
            Encoding::Phasor => {
                let mut out = vec![("amplitude", value(0).hypot(value(1))), ("phase", value(1).atan2(value(0)))];
                out.extend(&plain[2..]);
                out
            }
            Encoding::Compliance => {
                let mut out = vec![(plain[0].0, if value(0) > 0.0 { 1.0 / value(0) } else { f64::INFINITY })];
                out.extend(&plain[1..]);
                out
            }
        }
    }

    /// Coordinates to begin a refit with, from the amplitudes of a screen point's columns; `None` where they are not possible.
    ///
    /// Beside neutral the columns add up. Of secants, amplitudes add up to a strength that scales the coordinate which turns the effect on.
    pub fn start_from(&self, point: &ScreenPoint, amplitudes: &[f64]) -> Option<Vec<f64>> {
        let columns = &point.columns;
        if columns.iter().any(|c| !c.secant) {
            let mut x = columns[0].base.clone();
            for (column, amplitude) in columns.iter().zip(amplitudes) {
                x.iter_mut().zip(&column.direction).for_each(|(x, d)| *x += amplitude * d);
            }
            let clamped = self.clamped(&x);
            let lost = |k: usize| clamped[k] != x[k] && (clamped[k] - self.coordinates[k].neutral).abs() < 1e-12;
            // A level that would have to be negative explains nothing.
            let moving = (0..x.len()).filter(|k| columns.iter().any(|c| c.direction[*k] != 0.0));
            return (!moving.clone().all(lost)).then_some(clamped);
        }
        let strength: f64 = amplitudes.iter().sum();
        let mean = |k: usize| {
            let weights = amplitudes.iter().map(|w| w.max(0.0)).sum::<f64>().max(1e-30);
            columns.iter().zip(amplitudes).map(|(c, w)| w.max(0.0) * c.direction[k]).sum::<f64>() / weights
        };
        if self.encoding == Encoding::Moment {
            let sum = |k: usize| columns.iter().zip(amplitudes).map(|(c, w)| w * c.direction[k]).sum::<f64>();
            return (strength > 0.0).then(|| self.clamped(&(0..self.coordinates.len()).map(sum).collect::<Vec<_>>()));
        }
        if self.name == "slosh" || self.name == "flexible-appendage" {
            return self.start_from_tensor(columns, amplitudes);
        }
        if strength <= 0.0 {
            return None;
        }
        let mut x: Vec<f64> = (0..self.coordinates.len()).map(mean).collect();
        match self.name {
            "joint-elasticity" | "actuator-delay" => x[0] = strength * columns[0].direction[0],
            "joint-backlash" | "actuator-lag" => x[0] = columns[0].direction[0] + strength.ln(),
            "mount-compliance" => x[0] -= strength.ln(),
            _ => {}
        }
        Some(self.clamped(&x))
    }

    /// Coordinates of a part inside a body: the columns are secants along six axes, and what counts is the tensor Σ w v vᵀ of the
    /// vector (place of a mass, coupling of a mode); its largest principal axis makes one part.
    fn start_from_tensor(&self, columns: &[Column], amplitudes: &[f64]) -> Option<Vec<f64>> {
        let first = self.coordinates.iter().position(|c| c.key.ends_with("[0]"))?;
        let vector = |c: &Column| nalgebra::Vector3::from_fn(|k, _| c.direction[first + k]);
        let tensor = columns
            .iter()
            .zip(amplitudes)
            .fold(nalgebra::Matrix3::zeros(), |sum, (c, w)| sum + *w * vector(c) * vector(c).transpose());
        let eigen = tensor.symmetric_eigen();
        let (at, largest) = eigen.eigenvalues.argmax();
        if largest <= 0.0 {
            return None;
        }
        let axis = eigen.eigenvectors.column(at).into_owned();
        let mut x = columns[0].direction.clone();
        (0..3).for_each(|k| x[first + k] = largest.sqrt() * axis[k]);
        Some(self.clamped(&x))
    }

    /// The law that this one becomes where some of its numbers do nothing, and likelier readings of the same thing.
    ///
    /// What slides under its own weight cannot tell drag from viscous friction, and where only contacts tell places a place that is measured
    /// wrong cannot be told from a part that sits elsewhere: there the other name is found at the contact.
    pub fn plainer(&self, x: &[f64]) -> Vec<Alternative> {
        let here = |name, coordinates| Alternative { name, is_at_contact: false, coordinates, held: Vec::new() };
        let at_contact = |name, coordinates| Alternative { is_at_contact: true, ..here(name, coordinates) };
        let moved = |sign: f64| {
            let coordinates = x.iter().map(|x| sign * x).chain([0.0; 3]).collect();
            Alternative { held: vec![3, 4, 5], ..at_contact(MISPLACED, coordinates) }
        };
        match self.name {
            "joint-stribeck-friction" => vec![here("joint-coulomb-friction", vec![x[0]])],
            "joint-friction-asymmetry" => vec![here("joint-coulomb-friction", vec![0.5 * (x[0] + x[1])])],
            "joint-viscous-asymmetry" => vec![here("joint-viscous-friction", vec![0.5 * (x[0] + x[1])])],
            // Of a thrust that leaves the plane in which all moves its share in the plane is left.
            "actuator-misalignment" => vec![here("actuator-gain", vec![x[0].hypot(x[1]).cos()])],
            "joint-backlash" => vec![here("joint-elasticity", vec![(-x[1]).exp(), x[2]])],
            "tether-stiffness" => vec![here("linear-drag", vec![x[4]]), at_contact(AT_CONTACT, vec![x[4]])],
            // A level that falls at no speed that occurs is the static one, and one that falls at once the kinetic one.
            "friction-stribeck" => [x[0] + x[1], x[1]].map(|mu| here("friction-coefficient", vec![mu])).to_vec(),
            "friction-anisotropy" => vec![here("friction-coefficient", vec![x[0]])],
            _ if self.is_bias_of_place() => vec![moved(1.0), moved(-1.0)],
            _ => Vec::new(),
        }
    }

    fn is_bias_of_place(&self) -> bool {
        self.name == "sensor-bias" && self.place.starts_with("sensor:body.") && self.place.ends_with(".position")
    }

    /// What it has to bring beside what its numbers cost, in the criterion: cameras are surveyed, parts are bolted on.
    pub fn burden(&self) -> f64 {
        if self.is_bias_of_place() { BURDEN } else { 0.0 }
    }

    /// Standard errors of the parameters from the covariance of the coordinates, by difference quotients of [`Self::decode`].
    pub fn errors(&self, x: &[f64], covariance: &nalgebra::DMatrix<f64>) -> Vec<(&'static str, f64)> {
        let at = self.decode(x);
        let slope = |k: usize| {
            let size = (covariance[(k, k)].max(0.0).sqrt() * 1e-3).max(1e-12);
            let mut moved = x.to_vec();
            moved[k] += size;
            self.decode(&moved).iter().zip(&at).map(|(a, b)| (a.1 - b.1) / size).collect::<Vec<f64>>()
        };
        let jacobian: Vec<Vec<f64>> = (0..x.len()).map(slope).collect();
        let variance = |i: usize| {
            let pairs = (0..x.len()).flat_map(|k| (0..x.len()).map(move |l| (k, l)));
            pairs.map(|(k, l)| jacobian[k][i] * covariance[(k, l)] * jacobian[l][i]).sum::<f64>()
        };
        (0..at.len()).map(|i| (at[i].0, variance(i).max(0.0).sqrt())).collect()
    }
}

/// Writes a parameter or a component of one; `com[1]`.
fn set(params: &mut BTreeMap<String, ParamValue>, key: &str, value: f64) {
    let Some((name, index)) = key.strip_suffix(']').and_then(|k| k.split_once('[')) else {
        params.insert(key.to_owned(), ParamValue::Number(value));
        return;
    };
    let index: usize = index.parse().unwrap_or(0);
    let slot = params.entry(name.to_owned()).or_insert_with(|| ParamValue::Numbers(Vec::new()));
    if let ParamValue::Numbers(values) = slot {
        values.resize(values.len().max(index + 1), 0.0);
        values[index] = value;
    }
}
