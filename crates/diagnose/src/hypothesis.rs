//! Hypotheses: an effect at a place, with coordinates in which it is fitted and points at which it is screened.
//!
//! What an effect proposes at a place is a [`Candidate`] of its definition; here is what a search makes of it: tolerances, bounds, the start of a fit
//! from a screen, standard errors. All that tells one effect from another is read from the definition.

use scenario::effects::EffectDef;
use scenario::effects::identify::{Concerns, Minima, Start};
use scenario::spec::{Effect, ParamValue};
use std::collections::BTreeMap;

pub use scenario::effects::candidate::{Begin, Candidate, Column, Coordinate, Encoding, Scale, ScreenPoint};
pub use scenario::effects::identify::{Alternative, Tier};

/// An effect at a place.
#[derive(Clone, Debug, PartialEq)]
pub struct Hypothesis {
    /// What defines the effect.
    pub def: &'static EffectDef,
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
    /// Coordinates that no data of this kind can show, or that are in reserve; they stay at neutral.
    pub held: Vec<usize>,
    /// Those of them that may be freed, see [`Self::relaxed`].
    pub reserve: Vec<(usize, Begin)>,
    /// Whether its screen is expensive: many points, or memory whose start is free too.
    pub is_dear: bool,
    /// Whether it is asked for only where nothing else explains what is missing.
    pub is_last: bool,
    /// Standard deviations of the coordinates where the scenario gives them a tolerance; empty for a finding.
    pub tolerance: Vec<f64>,
}

impl Hypothesis {
    /// What a definition proposes at a place, as a finding.
    pub fn new(def: &'static EffectDef, candidate: Candidate) -> Self {
        let Candidate { place, constants, coordinates, encoding, screens, held, reserve, is_expensive, is_last } =
            candidate;
        Self {
            def,
            name: def.name,
            place,
            constants,
            coordinates,
            encoding,
            screens,
            tier: def.identify.tier,
            held,
            reserve,
            is_dear: is_expensive,
            is_last,
            tolerance: Vec::new(),
        }
    }

    /// `name at place`.
    pub fn title(&self) -> String {
        format!("{} at {}", self.name, self.place)
    }

    /// Whether the cost has a valley for each frequency, or a long flat one along a speed or a stiffness, and one refit may end in the wrong place.
    pub fn has_valleys(&self) -> bool {
        match self.def.identify.minima {
            Minima::One => false,
            Minima::Several => true,
        }
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
        match self.def.identify.concerns {
            Concerns::Motion => false,
            Concerns::Reading => true,
        }
    }

    /// The same with the coordinates free that it has in reserve, and where they begin beside `x` that is nearly right; none where it has none.
    pub fn relaxed(&self, x: &[f64]) -> Option<(Self, Vec<f64>)> {
        self.released(x, |begin| begin.near)
    }

    /// The same beside `x` that leads astray, from each end of what there is.
    pub fn relaxed_afar(&self, x: &[f64]) -> Option<[(Self, Vec<f64>); 2]> {
        Some([self.released(x, |begin| begin.afar[0])?, self.released(x, |begin| begin.afar[1])?])
    }

    fn released(&self, x: &[f64], at: fn(&Begin) -> f64) -> Option<(Self, Vec<f64>)> {
        let (mut free, mut x) = (Self { reserve: Vec::new(), ..self.clone() }, x.to_vec());
        for (k, begin) in &self.reserve {
            free.held.retain(|held| held != k);
            x[*k] = at(begin);
        }
        (!self.reserve.is_empty()).then_some((free, x))
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

    /// The effect's parameters at some coordinates, component by component; it is told without those that are in reserve.
    pub fn decode(&self, x: &[f64]) -> Vec<(&'static str, f64)> {
        let is_in_reserve = |key: &str| self.reserve.iter().any(|(k, _)| self.coordinates[*k].key == key);
        let all = self.encoding.decode(&self.coordinates, x);
        all.into_iter().filter(|(key, _)| !is_in_reserve(key)).collect()
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
            // A level that would have to be negative explains nothing, nor does what only acts by way of it.
            let moving = (0..x.len()).filter(|k| columns.iter().any(|c| c.direction[*k] != 0.0));
            let is_level = |k: &usize| self.coordinates[*k].bounds.contains(&self.coordinates[*k].neutral);
            let mut levels = moving.clone().filter(is_level).peekable();
            // A spring that would have to push is not the force that it begins with.
            let is_slack = matches!(self.encoding, Encoding::Anchored | Encoding::Rested) && lost(0);
            let explains = !is_slack && (levels.peek().is_none() || !levels.all(lost));
            return (explains && !moving.clone().all(lost)).then_some(clamped);
        }
        let strength: f64 = amplitudes.iter().sum();
        let mean = |k: usize| {
            let weights = amplitudes.iter().map(|w| w.max(0.0)).sum::<f64>().max(1e-30);
            columns.iter().zip(amplitudes).map(|(c, w)| w.max(0.0) * c.direction[k]).sum::<f64>() / weights
        };
        let start = self.def.identify.start;
        if start == Start::Dyad {
            return self.start_from_tensor(columns, amplitudes);
        }
        if strength <= 0.0 {
            return None;
        }
        let mut x: Vec<f64> = (0..self.coordinates.len()).map(mean).collect();
        match start {
            Start::Sum => {
                let sum = |k: usize| columns.iter().zip(amplitudes).map(|(c, w)| w * c.direction[k]).sum::<f64>();
                x = (0..x.len()).map(sum).collect();
            }
            Start::Proportional => x[0] = strength * columns[0].direction[0],
            Start::LogProportional => x[0] = columns[0].direction[0] + strength.ln(),
            Start::LogInverse => x[0] -= strength.ln(),
            Start::Mean | Start::Dyad => {}
        }
        Some(self.clamped(&x))
    }

    /// Coordinates of a part inside a body: the columns are secants along six axes, and what counts is the tensor Σ w v vᵀ of the
    /// vector (place of a mass, coupling of a mode); its largest principal axis makes one part.
    fn start_from_tensor(&self, columns: &[Column], amplitudes: &[f64]) -> Option<Vec<f64>> {
        let first = self.coordinates.iter().position(|c| c.key.ends_with("[0]"))?;
        let vector = |c: &Column| nalgebra::Vector3::from_fn(|k, _| c.direction[first + k]);
        if self.coordinates[0].key == "mass" && !self.held.contains(&0) {
            let strength: f64 = amplitudes.iter().sum();
            let moment =
                columns.iter().zip(amplitudes).fold(nalgebra::Vector3::zeros(), |sum, (c, w)| sum + *w * vector(c));
            let mut x = columns[0].direction.clone();
            x[0] *= strength;
            (0..3).for_each(|k| x[first + k] = moment[k] / strength);
            return (strength > 0.0).then(|| self.clamped(&x));
        }
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
    pub fn plainer(&self, x: &[f64]) -> Vec<Alternative> {
        self.def.identify.nested.map_or_else(Vec::new, |nested| nested(&self.place, x))
    }

    /// What it has to bring beside what its numbers cost, in the criterion.
    pub fn burden(&self) -> f64 {
        self.def.identify.penalty.map_or(0.0, |penalty| penalty(&self.place))
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
