//! Storage of the linear systems of a step, island by island.

use crate::model::Model;
use spatial::SpatialMatrix;

/// Row of a body's freedom that its base's guide holds.
pub(crate) const HELD: usize = usize::MAX;

/// The islands of this step and the storage of their systems.
#[derive(Clone, Debug)]
pub(crate) struct Islands {
    /// Island's representative, by vehicle.
    pub group: Vec<usize>,
    /// Per vehicle: row in its island's system of base freedoms and coordinates (`HELD` where there is none).
    pub rows: Vec<Vec<usize>>,
    /// Per representative: size and start in `matrix`.
    pub size: Vec<usize>,
    pub start: Vec<usize>,
    pub matrix: Vec<f64>,
    pub rhs: Vec<Vec<f64>>,
    pub scratch: Vec<f64>,
    /// S_ab of the pairs of bodies that touch.
    pub cross: Vec<([usize; 2], SpatialMatrix)>,
    /// Whether vehicles without joints are left out.
    pub leaves_rigid: bool,
}

impl Islands {
    pub fn new(model: &Model) -> Self {
        let n: usize = model.vehicles.iter().map(|v| 6 + v.tree.nv).sum();
        let largest = model.vehicles.iter().map(|v| 6 + v.tree.nv).max().unwrap_or(0);
        Self {
            group: vec![0; model.vehicles.len()],
            rows: model.vehicles.iter().map(|v| vec![HELD; 6 + v.tree.nv]).collect(),
            size: vec![0; model.vehicles.len()],
            start: vec![0; model.vehicles.len()],
            matrix: vec![0.0; n * (n + LANES)],
            rhs: model.vehicles.iter().map(|_| Vec::with_capacity(n)).collect(),
            scratch: vec![0.0; largest * largest],
            cross: Vec::new(),
            leaves_rigid: false,
        }
    }
}

/// Columns that are summed in registers at a time; rows are padded to a multiple of the fewest.
pub(crate) const LANES: usize = 8;

/// Length of a padded row.
pub(crate) fn padded(n: usize) -> usize {
    n.next_multiple_of(LANES)
}
