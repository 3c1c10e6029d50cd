//! Dead weights: a body that a guide keeps at its height above a plate, and that presses on it with its weight.
//!
//!   N = m |g · n|      m: mass of the body's vehicle, g: field of the environment, n: normal of the plate
//!
//! One contact point, below the origin of the body that the shape is fixed to: a slider that does not turn moves as a point. No
//! geometry is asked and nothing gives way, so that the step is not bound to the stiffness of a normal law. Both bodies feel N,
//! of which the guide takes its part.

use super::Model;
use crate::error::ModelError;
use crate::parts::{Base, Environment};
use contact::{NormalLaw, Shape};
use spatial::Vec3;

/// A pair that is pressed together by a guided body's weight.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DeadWeight {
    pub pair: usize,
    /// Global body that slides.
    pub body: usize,
    /// From A to B, W axes.
    pub normal: Vec3,
}

/// Largest component of the normal along a free direction: what rounding leaves of zero.
const ROUNDING: f64 = 1e-12;

/// Finds the model's dead weights, takes them from what is detected, and sets their force.
pub(crate) fn attach(model: &mut Model) -> Result<(), ModelError> {
    for pair in 0..model.laws.len() {
        if !matches!(model.laws[pair].normal.law, NormalLaw::Constant { .. }) {
            continue;
        }
        let found = resolve(model, pair).ok_or_else(|| ModelError::DeadWeight(model.pair_name(pair)))?;
        let (vehicle, _) = model.owners[found.body];
        let force = model.vehicles[vehicle].tree.mass() * calc_field(&model.environment).dot(&found.normal).abs();
        model.laws[pair].normal.law = NormalLaw::Constant { force };
        model.scene.ignore(pair);
        model.dead_weights.push(found);
    }
    Ok(())
}

fn calc_field(environment: &Environment) -> Vec3 {
    match environment {
        Environment::Uniform { gravity } => *gravity,
        Environment::DeepSpace | Environment::Orbit { .. } => Vec3::zeros(),
    }
}

fn resolve(model: &Model, pair: usize) -> Option<DeadWeight> {
    let [a, b] = model.scene.pairs()[pair].map(|c| &model.scene.colliders()[c]);
    let (plane, slider, sign) = match (&a.shape, &b.shape) {
        (Shape::HalfSpace, _) => (a, b, 1.0),
        (_, Shape::HalfSpace) => (b, a, -1.0),
        _ => return None,
    };
    let does_not_turn = |body: usize| {
        let base = model.owners.get(body).map(|&(v, local)| (model.vehicles[v].base, local));
        base.is_none_or(|(base, local)| local == 0 && base.mask()[..3] == [false; 3])
    };
    let (vehicle, _) = *model.owners.get(slider.body)?;
    let normal = sign * (plane.pose_bs.rotation * Vec3::z());
    let mask = model.vehicles[vehicle].base.mask();
    let is_guided = matches!(model.vehicles[vehicle].base, Base::Only(_))
        && (0..3).all(|k| !mask[3 + k] || normal[k].abs() < ROUNDING);
    let fits = is_guided && does_not_turn(slider.body) && does_not_turn(plane.body);
    fits.then_some(DeadWeight { pair, body: slider.body, normal })
}
