//! All hypotheses: every effect at every place where it could act, with the points at which it is screened.

mod actuators;
mod bodies;
mod contacts;
mod joints;
mod sensors;
mod tolerances;

pub use tolerances::within;

use crate::facts::Facts;
use crate::hypothesis::{Column, Coordinate, Encoding, Hypothesis, ScreenPoint, Tier};

/// Enumerates what could be left out of the model.
pub fn hypotheses(facts: &Facts) -> Vec<Hypothesis> {
    let mut all = Vec::new();
    facts.joints.iter().for_each(|j| joints::add(j, facts, &mut all));
    facts.joints.iter().filter(|j| j.largest_command > 0.0).for_each(|j| actuators::add_joint(j, &mut all));
    actuators::add_thrusters(&facts.thrusters, &mut all);
    facts.bodies.iter().for_each(|b| bodies::add(b, facts, &mut all));
    bodies::add_world(facts, &mut all);
    facts.contacts.iter().for_each(|c| contacts::add(c, facts, &mut all));
    facts.sensors.iter().for_each(|s| sensors::add(s, &mut all));
    all
}

/// A hypothesis whose coordinates are its parameters, without screen points.
fn hypothesis(name: &'static str, place: &str, coordinates: Vec<Coordinate>) -> Hypothesis {
    Hypothesis {
        name,
        place: place.to_owned(),
        constants: Vec::new(),
        coordinates,
        encoding: Encoding::Direct,
        screens: Vec::new(),
        tier: Tier::Exotic,
        held: Vec::new(),
        is_dear: false,
        tolerance: Vec::new(),
    }
}

impl Hypothesis {
    fn encoded(mut self, encoding: Encoding) -> Self {
        self.encoding = encoding;
        self
    }

    fn nominal_number(mut self) -> Self {
        self.tier = Tier::Nominal;
        self
    }

    fn dear(mut self) -> Self {
        self.is_dear = true;
        self
    }

    /// One screen point at neutral: a column for each of the given coordinates, with its first step.
    fn screened(mut self, columns: &[(usize, f64)]) -> Self {
        let base = self.neutral();
        let columns = columns.iter().map(|(k, step)| along(&base, &[(*k, 1.0)], *step)).collect();
        self.screens.push(ScreenPoint { label: String::new(), columns });
        self
    }

    /// A screen point that holds coordinate `k` at each value of a grid (of the parameter), the columns taken there.
    fn screened_on(mut self, k: usize, grid: &[f64], columns: &[(Vec<(usize, f64)>, f64)]) -> Self {
        for value in grid {
            let mut base = self.neutral();
            base[k] = match self.coordinates[k].scale {
                crate::hypothesis::Scale::Linear => *value,
                crate::hypothesis::Scale::Log => value.ln(),
            };
            let columns = columns.iter().map(|(direction, step)| along(&base, direction, *step)).collect();
            self.screens.push(ScreenPoint { label: format!("{} = {value:.3}", self.coordinates[k].key), columns });
        }
        self
    }

    /// A screen point of secants: the change of the residual from nominal to each of these coordinates.
    fn screened_at(mut self, label: &str, points: &[Vec<f64>]) -> Self {
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

fn along(base: &[f64], direction: &[(usize, f64)], step: f64) -> Column {
    let mut d = vec![0.0; base.len()];
    direction.iter().for_each(|(k, x)| d[*k] = *x);
    Column { base: base.to_vec(), direction: d, step, secant: false }
}

/// `from`·2^(i·`per_octave`⁻¹) up to `to`.
fn log_grid(from: f64, to: f64, per_octave: f64) -> Vec<f64> {
    let count = ((to / from).log2() * per_octave).round().max(1.0) as i32;
    (0..=count).map(|i| from * 2f64.powf(f64::from(i) / per_octave)).collect()
}
