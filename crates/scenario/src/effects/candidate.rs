//! A candidate: an effect at a place, with coordinates in which it is fitted and points at which it is screened.
//!
//! A coordinate is a parameter, its logarithm (positive ones), or a combination that stays regular where the effect is neutral (m p in place of p,
//! the square of a mean motion, level and ellipse in place of two levels and an angle). A screen point is a place in these coordinates: either
//! beside neutral, one column a direction, or far from it, where the effect has no derivative at neutral (a secant).

use crate::spec::ParamValue;

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
    /// How far from neutral it may be expected, a standard deviation: what keeps it there where no reading shows it. Infinite for none.
    pub spread: f64,
}

/// How a coordinate stands for its parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// The parameter itself.
    Linear,
    /// Its natural logarithm.
    Log,
}

impl Coordinate {
    /// A linear coordinate without bounds.
    pub fn free(key: &'static str, neutral: f64) -> Self {
        Self { key, scale: Scale::Linear, neutral, bounds: [f64::NEG_INFINITY, f64::INFINITY], spread: f64::INFINITY }
    }

    /// A linear coordinate that is not negative.
    pub fn level(key: &'static str, neutral: f64) -> Self {
        Self { bounds: [0.0, f64::INFINITY], ..Self::free(key, neutral) }
    }

    /// A positive one, by its logarithm; `neutral` and bounds are the parameter's.
    pub fn log(key: &'static str, neutral: f64, bounds: [f64; 2]) -> Self {
        Self { key, scale: Scale::Log, neutral: neutral.ln(), bounds: bounds.map(f64::ln), spread: f64::INFINITY }
    }

    /// Three components of a vector, each free.
    pub fn vector(keys: [&'static str; 3], neutral: [f64; 3]) -> Vec<Self> {
        keys.into_iter().zip(neutral).map(|(key, at)| Self::free(key, at)).collect()
    }

    /// The same within other bounds.
    pub fn within(self, bounds: [f64; 2]) -> Self {
        Self { bounds, ..self }
    }

    /// The same, expected no farther from neutral than `spread`, a standard deviation: wide enough to be nothing beside what a reading shows.
    pub fn about(self, spread: f64) -> Self {
        Self { spread, ..self }
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

/// What a set of coordinates means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Encoding {
    /// Each coordinate is its parameter.
    Direct,
    /// (m, m·com): a point mass.
    Moment,
    /// (k, k·anchor, d): a spring to a point. Next to k = 0 the others are a force.
    Anchored,
    /// (k, k·q_rest): the same of a joint.
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
    /// (ln of the force at a typical depth δ₀ over δ₀ to the nominal exponent, n) of a law k δⁿ: stiffness and exponent apart are told much worse
    /// than the force that both make, and by steps that each stay in the valley which the other one moves.
    PowerLaw {
        /// The nominal exponent: there the first coordinate is the stiffness.
        exponent: f64,
    },
    /// One coordinate is what its parameter exceeds another by: a breakaway level is not below the sliding one.
    Excess {
        /// The coordinate that is an excess.
        of: usize,
        /// The coordinate that it exceeds.
        over: usize,
    },
}

/// Depth at which the force of a contact is told from its exponent, m.
const TYPICAL_DEPTH: f64 = 1e-3;

impl Encoding {
    /// The parameters at values of the coordinates, component by component.
    pub fn decode(self, coordinates: &[Coordinate], x: &[f64]) -> Vec<(&'static str, f64)> {
        let plain: Vec<(&'static str, f64)> =
            coordinates.iter().zip(x).map(|(c, x)| (c.key, c.parameter(*x))).collect();
        let value = |i: usize| plain[i].1;
        let over = |i: usize, d: f64| (plain[i].0, if d == 0.0 { 0.0 } else { value(i) / d });
        match self {
            Self::Direct => plain,
            Self::Excess { of, over: base } => {
                let mut out = plain.clone();
                out[of].1 += plain[base].1;
                out
            }
            Self::PowerLaw { exponent } => {
                let mut out = plain.clone();
                out[0].1 *= TYPICAL_DEPTH.powf(exponent - value(1));
                out
            }
            Self::Moment => vec![plain[0], over(1, value(0)), over(2, value(0)), over(3, value(0))],
            Self::Anchored => {
                let k = stiffness(value(0), &x[1..4]);
                vec![(plain[0].0, k), over(1, k), over(2, k), over(3, k), plain[4]]
            }
            Self::Rested => {
                let k = stiffness(value(0), &x[1..2]);
                vec![(plain[0].0, k), over(1, k)]
            }
            Self::RateOfInertia => vec![plain[0], (plain[1].0, value(0) * value(1))],
            Self::Squared => vec![(plain[0].0, value(0).max(0.0).sqrt())],
            Self::Ellipse => {
                let (level, a, b) = (value(0), value(1), value(2));
                let half = a.hypot(b);
                let [along, across, angle] = [plain[0].0, plain[1].0, plain[2].0];
                vec![(along, level + half), (across, (level - half).max(1e-6)), (angle, 0.5 * b.atan2(a))]
            }
            Self::Phasor => {
                let [amplitude, phase] = [plain[0].0, plain[1].0];
                let mut out = vec![(amplitude, value(0).hypot(value(1))), (phase, value(1).atan2(value(0)))];
                out.extend(&plain[2..]);
                out
            }
            Self::Compliance => {
                let mut out = vec![(plain[0].0, if value(0) > 0.0 { 1.0 / value(0) } else { f64::INFINITY })];
                out.extend(&plain[1..]);
                out
            }
        }
    }
}

/// Stiffness of a spring that pulls to a point with a force: where it is zero, so little that the force is as good as constant.
fn stiffness(k: f64, forces: &[f64]) -> f64 {
    if k == 0.0 && forces.iter().any(|f| *f != 0.0) { SLACK } else { k }
}

/// Stiffness, N/m or N m/rad, that is next to nothing.
const SLACK: f64 = 1e-9;

/// Where a candidate is screened.
#[derive(Clone, Debug, PartialEq)]
pub struct ScreenPoint {
    /// What tells this point from the others of the candidate: "v_s = 0.02".
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

/// A coordinate along which a column is taken, and the first step along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Along {
    /// Index of the coordinate.
    pub coordinate: usize,
    /// First step.
    pub step: f64,
}

impl Along {
    /// The coordinate, with its first step.
    pub fn new(coordinate: usize, step: f64) -> Self {
        Self { coordinate, step }
    }

    /// Some coordinates, with the same first step each.
    pub fn each(coordinates: impl IntoIterator<Item = usize>, step: f64) -> Vec<Self> {
        coordinates.into_iter().map(|coordinate| Self { coordinate, step }).collect()
    }

    /// The column from a base.
    pub fn from(self, base: &[f64]) -> Column {
        let mut direction = vec![0.0; base.len()];
        direction[self.coordinate] = 1.0;
        Column { base: base.to_vec(), direction, step: self.step, secant: false }
    }
}

/// An effect at a place, as its definition proposes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// The place.
    pub place: String,
    /// Parameters that are not fitted.
    pub constants: Vec<(&'static str, ParamValue)>,
    /// What is fitted.
    pub coordinates: Vec<Coordinate>,
    /// What the coordinates mean.
    pub encoding: Encoding,
    /// Where it is screened.
    pub screens: Vec<ScreenPoint>,
    /// Coordinates that no data of this kind can show, or that are in reserve; they stay at neutral.
    pub held: Vec<usize>,
    /// Those of them that are freed where the law does not follow all of the motion without, and where a fit of them begins.
    pub reserve: Vec<(usize, Begin)>,
    /// Whether its screen is expensive: many points, or memory whose start is free too.
    pub is_expensive: bool,
    /// Whether it is asked for only where nothing else explains what is missing.
    pub is_last: bool,
}

/// Where a fit of a coordinate begins that was held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Begin {
    /// Where the law is nearly right without.
    pub near: f64,
    /// Where it leads astray without: where it is smoothest, and where it is stiffest. One valley does not lead to the other.
    pub afar: [f64; 2],
}

impl Candidate {
    /// One whose coordinates are its parameters, without screen points.
    pub fn new(place: String, coordinates: Vec<Coordinate>) -> Self {
        Self {
            place,
            constants: Vec::new(),
            coordinates,
            encoding: Encoding::Direct,
            screens: Vec::new(),
            held: Vec::new(),
            reserve: Vec::new(),
            is_expensive: false,
            is_last: false,
        }
    }

    /// Neutral or typical coordinates.
    pub fn neutral(&self) -> Vec<f64> {
        self.coordinates.iter().map(|c| c.neutral).collect()
    }

    /// The same with coordinates of this meaning.
    pub fn encoded(mut self, encoding: Encoding) -> Self {
        self.encoding = encoding;
        self
    }

    /// The same with coordinates that stay at neutral.
    pub fn holding(mut self, held: Vec<usize>) -> Self {
        self.held = held;
        self
    }

    /// The same with a coordinate that stays at neutral until the law does not follow all of the motion.
    pub fn in_reserve(mut self, coordinate: usize, begin: Begin) -> Self {
        self.held.push(coordinate);
        self.reserve.push((coordinate, begin));
        self
    }

    /// The same with an expensive screen.
    pub fn expensive(mut self) -> Self {
        self.is_expensive = true;
        self
    }

    /// The same, asked for last where `is_last`.
    pub fn asked_last(mut self, is_last: bool) -> Self {
        self.is_last = is_last;
        self.is_expensive |= is_last;
        self
    }

    /// The same with a word that is not fitted.
    pub fn with_word(mut self, parameter: &'static str, word: &str) -> Self {
        self.constants.push((parameter, ParamValue::Text(word.to_owned())));
        self
    }

    /// One screen point at neutral: a column for each of the given coordinates.
    pub fn screened(mut self, columns: &[Along]) -> Self {
        let base = self.neutral();
        let columns = columns.iter().map(|along| along.from(&base)).collect();
        self.screens.push(ScreenPoint { label: String::new(), columns });
        self
    }

    /// A screen point that holds coordinate `k` at each value of a grid (of the parameter), the columns taken there.
    pub fn screened_on(mut self, k: usize, grid: &[f64], columns: &[Along]) -> Self {
        for value in grid {
            let mut base = self.neutral();
            base[k] = match self.coordinates[k].scale {
                Scale::Linear => *value,
                Scale::Log => value.ln(),
            };
            let columns = columns.iter().map(|along| along.from(&base)).collect();
            self.screens.push(ScreenPoint { label: format!("{} = {value:.3}", self.coordinates[k].key), columns });
        }
        self
    }

    /// A screen point of secants: the change of the residual from nominal to each of these coordinates.
    pub fn screened_at(mut self, label: &str, points: &[Vec<f64>]) -> Self {
        let secant = |point: &Vec<f64>| Column {
            base: vec![0.0; point.len()],
            direction: point.clone(),
            step: 1.0,
            secant: true,
        };
        self.screens.push(ScreenPoint { label: label.to_owned(), columns: points.iter().map(secant).collect() });
        self
    }
}

/// `from`·2^(i·`per_octave`⁻¹) up to `to`.
pub(super) fn log_grid(from: f64, to: f64, per_octave: f64) -> Vec<f64> {
    let count = ((to / from).log2() * per_octave).round().max(1.0) as i32;
    (0..=count).map(|i| from * 2f64.powf(f64::from(i) / per_octave)).collect()
}

/// Six axes whose dyads span all symmetric tensors.
pub(super) fn dyad_axes() -> [spatial::Vec3; 6] {
    use spatial::Vec3;
    let mixed = |i: usize, j: usize| (Vec3::ith(i, 1.0) + Vec3::ith(j, 1.0)).normalize();
    [Vec3::x(), Vec3::y(), Vec3::z(), mixed(0, 1), mixed(0, 2), mixed(1, 2)]
}

/// The centre and places on either side of it along some axes: masses there add up to one with its first moment, whatever its moment of inertia.
pub(super) fn around(axes: impl Iterator<Item = usize>, distance: f64) -> Vec<spatial::Vec3> {
    use spatial::Vec3;
    let sides = axes.flat_map(|k| [Vec3::ith(k, distance), Vec3::ith(k, -distance)]);
    std::iter::once(Vec3::zeros()).chain(sides).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_law_keeps_its_force_at_a_typical_depth_when_its_exponent_moves() {
        let coordinates = [Coordinate::log("k", 1e6, [1e3, 1e9]), Coordinate::free("n", 1.5)];
        let law = Encoding::PowerLaw { exponent: 1.5 };
        let at = |x: [f64; 2]| law.decode(&coordinates, &x).into_iter().map(|p| p.1).collect::<Vec<f64>>();
        let force = |p: &[f64], depth: f64| p[0] * depth.powf(p[1]);
        let nominal = at([1e6f64.ln(), 1.5]);
        assert!((nominal[0] / 1e6 - 1.0).abs() < 1e-12 && nominal[1] == 1.5, "neutral is the nominal law: {nominal:?}");
        let softer = at([1e6f64.ln(), 1.3]);
        assert!((force(&softer, TYPICAL_DEPTH) / force(&nominal, TYPICAL_DEPTH) - 1.0).abs() < 1e-12, "{softer:?}");
        assert!((force(&softer, 1e-4) / force(&nominal, 1e-4) - 10f64.powf(0.2)).abs() < 1e-9, "flatter");
    }
}
