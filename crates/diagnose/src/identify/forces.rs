//! Unknown forces: one on every coordinate that moves, constant over an interval.

use crate::error::DiagnoseError;
use crate::facts::Facts;
use crate::fit::EffectSet;
use crate::linear::Variation;
use crate::locate::places;
use crate::plant::{Built, Plant};
use crate::start::Freedom;
use nalgebra::{DMatrix, DVector};
use scenario::spec::Effect;

/// An unknown force.
#[derive(Clone, Debug)]
pub struct Force {
    /// Place, as in the table of effects.
    pub place: String,
    /// Which of the forces there: "torque x".
    pub label: String,
    effect: Effect,
    size: f64,
}

/// The forces on all coordinates of a model.
pub fn forces(facts: &Facts) -> Vec<Force> {
    let of_place = |place: crate::locate::Place| {
        let steady = |(label, effect, size): (String, Effect, f64)| {
            let label = label.strip_suffix("constant").map(|l| l.trim_end().to_owned())?;
            place.name.strip_prefix("contact:").is_none().then(|| Force {
                place: place.name.clone(),
                label,
                effect,
                size,
            })
        };
        place.columns.clone().into_iter().filter_map(steady).collect::<Vec<_>>()
    };
    places(facts, 1.0).into_iter().flat_map(of_place).collect()
}

/// A model for each force, beside a set of effects.
pub fn vary_forces(plant: &Plant, set: &EffectSet, forces: &[Force]) -> Result<Vec<Variation>, DiagnoseError> {
    let vary = |force: &Force| {
        let mut effects = set.effects();
        effects.push(force.effect.clone());
        Ok(Variation { built: plant.build(&effects)?, step: force.size, is_tolerated: false })
    };
    forces.iter().map(vary).collect()
}

/// Forces that would by themselves move the rates as these move from interval to interval: beyond them nothing is unknown. `steps`: changes
/// of the state over an interval; `b`: ∂end/∂f of a typical one.
pub fn first_spread(freedoms: &[Freedom], steps: &[DVector<f64>], b: &DMatrix<f64>) -> DVector<f64> {
    let is_rate = |f: &Freedom| matches!(f, Freedom::Spin(..) | Freedom::Speed(..) | Freedom::Rate(..));
    let rates: Vec<usize> = (0..freedoms.len()).filter(|k| is_rate(&freedoms[*k])).collect();
    let of = |j: usize| {
        let column = DVector::from_iterator(rates.len(), rates.iter().map(|k| b[(*k, j)]));
        let along = |step: &DVector<f64>| rates.iter().zip(column.iter()).map(|(k, b)| step[*k] * b).sum::<f64>();
        let square: f64 = steps.iter().map(|s| along(s).powi(2)).sum::<f64>() / steps.len().max(1) as f64;
        square.sqrt() / column.norm_squared().max(f64::MIN_POSITIVE)
    };
    DVector::from_iterator(b.ncols(), (0..b.ncols()).map(of))
}

/// Whether a model remembers more than another: memory of effects, or joints of parts inside.
pub(crate) fn has_memory(built: &Built, beside: &Built) -> bool {
    built.start.effects.len() > beside.start.effects.len() || built.start.q.len() > beside.start.q.len()
}
