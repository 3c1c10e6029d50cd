//! Where it is missing: an unknown force at one place at a time, free in every window, estimated with its error.
//!
//! Each place has columns C (a force or torque on each of its freedoms, constant over the window and as half a wave; of a contact its own
//! numbers) that every window may use as it likes, start eliminated:
//!
//!   f̂ = −A⁻¹ b,  cov A⁻¹,  S = bᵀ A⁻¹ b ~ χ²(rank)  per window;      share = S of the place alone ÷ S of all places together
//!
//! Internal effects show at two bodies and cancel in the total, external ones do not; contact effects live only in windows that touch.

use crate::error::DiagnoseError;
use crate::facts::Facts;
use crate::fit::{Fit, pseudo_inverse};
use crate::linear::{Stage, Variation, eliminate};
use crate::plant::Plant;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use scenario::effects::{self, EffectDef};
use scenario::spec::{Effect, ParamValue};
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

/// A place with what could act there.
#[derive(Clone, Debug)]
pub struct Place {
    /// As in the table of effects.
    pub name: String,
    /// Name and unit effect of each column; the effect's size is its step.
    pub columns: Vec<(String, Effect, f64)>,
}

impl Place {
    /// Whether its columns are threes of a mean and half a wave each.
    pub(crate) fn is_told_in_waves(&self) -> bool {
        let is_wave = |column: &(String, Effect, f64)| column.1.name == effects::PERIODIC_DISTURBANCE.name;
        self.columns.len().is_multiple_of(3) && self.columns.iter().all(is_wave)
    }
}

/// What a window says of one place.
#[derive(Clone, Debug)]
pub struct WindowForce {
    /// χ² of the place alone.
    pub score: f64,
    /// Its rank.
    pub rank: usize,
    /// Estimates by column, the unit of the column.
    pub estimate: Vec<f64>,
    /// Their standard errors.
    pub error: Vec<f64>,
    /// Their information matrix A.
    pub information: DMatrix<f64>,
}

/// Missing forces of a fit.
#[derive(Clone, Debug)]
pub struct Located {
    /// Places.
    pub places: Vec<Place>,
    /// By segment, by place.
    pub windows: Vec<Vec<WindowForce>>,
    /// χ² of all places together, by segment.
    pub together: Vec<f64>,
}

impl Located {
    /// χ² of a place over all windows.
    pub fn score(&self, place: usize) -> f64 {
        self.windows.iter().map(|w| w[place].score).sum()
    }

    /// Rank of a place over all windows.
    pub fn rank(&self, place: usize) -> usize {
        self.windows.iter().map(|w| w[place].rank).sum()
    }

    /// Score of a place beyond its rank over that of all places.
    pub fn share(&self, place: usize) -> f64 {
        let all: f64 = self.together.iter().sum();
        ((self.score(place) - self.rank(place) as f64) / all.max(1.0)).clamp(0.0, 1.0)
    }

    /// The number of a place that stands out most.
    pub fn strongest(&self, place: usize) -> usize {
        let score = |column: &usize| {
            let of = |w: &Vec<WindowForce>| {
                let error = w[place].error[*column];
                if error > 0.0 { (w[place].estimate[*column] / error).powi(2) } else { 0.0 }
            };
            self.windows.iter().map(of).sum::<f64>()
        };
        let columns = 0..self.places[place].columns.len();
        columns.max_by(|a, b| score(a).total_cmp(&score(b))).unwrap_or(0)
    }

    /// Places by score, best first.
    pub fn ranked(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.places.len()).collect();
        order.sort_by(|a, b| self.score(*b).total_cmp(&self.score(*a)));
        order
    }
}

/// Places where forces may be missing; `window` in s.
pub fn places(facts: &Facts, window: f64) -> Vec<Place> {
    let mut all = Vec::new();
    let waves = [("constant", 0.0, FRAC_PI_2), ("cosine", 0.5 / window, FRAC_PI_2), ("sine", 0.5 / window, 0.0)];
    for joint in &facts.joints {
        let name = format!("joint:{}", joint.name);
        let column = |(label, f, phase): &(&str, f64, f64)| {
            let effect = wave(&name, ParamValue::Number(1e-2), *f, *phase, None);
            ((*label).to_owned(), effect, 1e-2)
        };
        all.push(Place { columns: waves.iter().map(column).collect(), name });
    }
    for body in facts.bodies.iter().filter(|b| b.is_base) {
        let name = format!("body:{}", body.name);
        let mut columns = Vec::new();
        for (kind, first, size) in [("torque", 0, 1e-4 * body.inertia.trace()), ("force", 3, 1e-4 * body.mass)] {
            for axis in (0..3).filter(|axis| body.mask[first + axis]) {
                for (label, f, phase) in &waves {
                    let mut vector = vec![0.0; 3];
                    vector[axis] = size;
                    let effect = wave(&name, ParamValue::Numbers(vector), *f, *phase, Some(kind));
                    columns.push((format!("{kind} {} {label}", ["x", "y", "z"][axis]), effect, size));
                }
            }
        }
        all.push(Place { name, columns });
    }
    all.extend(facts.contacts.iter().map(contact_place));
    all.extend(facts.mechanisms.iter().map(mechanism_place));
    all.retain(|p: &Place| !p.columns.is_empty());
    all
}

fn wave(place: &str, amplitude: ParamValue, f: f64, phase: f64, kind: Option<&str>) -> Effect {
    let mut params = BTreeMap::from([
        ("amplitude".to_owned(), amplitude),
        ("frequency".to_owned(), ParamValue::Number(f)),
        ("phase".to_owned(), ParamValue::Number(phase)),
    ]);
    if let Some(kind) = kind {
        params.insert("kind".to_owned(), ParamValue::Text(kind.to_owned()));
    }
    Effect { name: "periodic-disturbance".to_owned(), place: place.to_owned(), params }
}

/// So do a mechanism's.
fn mechanism_place(mechanism: &crate::facts::MechanismFact) -> Place {
    let name = mechanism.place();
    let column = |has: bool, label: &str, def: &EffectDef| {
        let params = BTreeMap::from([("factor".to_owned(), ParamValue::Number(1.001))]);
        let effect = Effect { name: def.name.to_owned(), place: name.clone(), params };
        has.then(|| (label.to_owned(), effect, 1e-3))
    };
    let springs = column(mechanism.has_springs, "stiffness", &effects::MECHANISM_STIFFNESS);
    let dampers = column(mechanism.has_dampers, "damping", &effects::MECHANISM_DAMPING);
    Place { columns: springs.into_iter().chain(dampers).collect(), name }
}

/// A contact's own numbers stand for the forces that could be missing in it.
fn contact_place(contact: &crate::facts::ContactFact) -> Place {
    let name = format!("contact:{}", contact.name);
    let effect = |effect: &str, params: &[(&str, f64)]| Effect {
        name: effect.to_owned(),
        place: name.clone(),
        params: params.iter().map(|(k, v)| ((*k).to_owned(), ParamValue::Number(*v))).collect(),
    };
    let mut columns = Vec::new();
    if let Some([mu, k_b, c_b]) = contact.bristle {
        columns.push(("level".to_owned(), effect("friction-coefficient", &[("mu", mu + 1e-5)]), 1e-5));
        let bristle = effect("friction-bristle-stiffness", &[("k_b", k_b * 1.001), ("c_b", c_b)]);
        columns.push(("bristle".to_owned(), bristle, 1e-3 * k_b));
        columns.push(("viscous".to_owned(), effect("friction-viscous", &[("b", 1e-2)]), 1e-2));
    }
    if let Some([k, n, c]) = contact.normal {
        let stiffness = effect("contact-stiffness", &[("k", k * 1.0001), ("n", n)]);
        columns.push(("stiffness".to_owned(), stiffness, 1e-4 * k));
        columns.push(("damping".to_owned(), effect("contact-damping", &[("c", c + 1e-3)]), 1e-3));
    }
    Place { name, columns }
}

/// Estimates the missing forces of every segment of a fit.
pub fn locate(stage: &Stage<'_>, plant: &Plant, fit: &Fit, places: Vec<Place>) -> Result<Located, DiagnoseError> {
    locate_in(stage, plant, fit, places, None)
}

/// The same in other residuals than those of the fit: what of them a force on the fitted model would explain.
pub fn locate_in(
    stage: &Stage<'_>,
    plant: &Plant,
    fit: &Fit,
    places: Vec<Place>,
    residuals: Option<&[DVector<f64>]>,
) -> Result<Located, DiagnoseError> {
    let build = |place: &Place| -> Result<Vec<Variation>, DiagnoseError> {
        let vary = |(_, effect, step): &(String, Effect, f64)| {
            let mut effects = fit.set.effects();
            effects.push(effect.clone());
            Ok(Variation { built: plant.build(&effects)?, step: *step, is_tolerated: false })
        };
        place.columns.iter().map(vary).collect()
    };
    let built: Vec<Vec<Variation>> = places.iter().map(build).collect::<Result<_, _>>()?;
    let of_segment: Vec<(Vec<WindowForce>, f64)> = fit
        .segments
        .par_iter()
        .enumerate()
        .map(|(i, segment)| {
            let r = stage.residuals(&fit.built, segment);
            let start = stage.columns_of(&fit.built, segment, &r);
            let columns: Vec<Vec<DVector<f64>>> =
                built.iter().map(|vs| vs.iter().map(|v| stage.column(v, segment, &r)).collect()).collect();
            let starts: Vec<&DVector<f64>> = start.columns.iter().collect();
            let told = residuals.map_or(&r, |all| &all[i]);
            let others: Vec<&DVector<f64>> = columns.iter().flatten().chain(std::iter::once(told)).collect();
            let k = eliminate(&starts, &others, &start.freedoms).reduced;
            split(&k, &columns.iter().map(Vec::len).collect::<Vec<_>>())
        })
        .collect();
    let (windows, together) = of_segment.into_iter().unzip();
    Ok(Located { places, windows, together })
}

/// Scores of consecutive blocks of columns, each alone, and of all together.
fn split(k: &DMatrix<f64>, widths: &[usize]) -> (Vec<WindowForce>, f64) {
    let n: usize = widths.iter().sum();
    let mut first = 0;
    let mut windows = Vec::new();
    for &width in widths {
        windows.push(window(k, first, width));
        first += width;
    }
    (windows, window(k, 0, n).score)
}

fn window(k: &DMatrix<f64>, first: usize, width: usize) -> WindowForce {
    let last = k.ncols() - 1;
    let a = k.view((first, first), (width, width)).into_owned();
    let b = k.view((first, last), (width, 1)).into_owned();
    let inverse = pseudo_inverse(&a);
    let estimate = -(&inverse * &b);
    WindowForce {
        score: -(b.transpose() * &estimate)[(0, 0)],
        rank: (0..width).filter(|i| a[(*i, *i)] > 0.0).count(),
        estimate: estimate.iter().copied().collect(),
        error: (0..width).map(|i| inverse[(i, i)].max(0.0).sqrt()).collect(),
        information: a,
    }
}
