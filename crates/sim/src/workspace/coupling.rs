//! A mechanism that acts in a step.

use crate::parts::{Deformation, MAX_ROWS, RowForce, Rows};
use spatial::{Vec3, Wrench};

/// An acting mechanism in this step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coupling {
    pub index: usize,
    pub bodies: [usize; 2],
    pub at: Deformation,
    /// Rows about the anchors of the two bodies' vehicles.
    pub rows: [[Wrench; MAX_ROWS]; 2],
    /// Origins of the two frames, W.
    pub origins: [Vec3; 2],
    pub rate: Rows,
    pub carried: Rows,
    pub base: Rows,
    pub beta: f64,
    pub theta: f64,
    pub law: [RowForce; MAX_ROWS],
    /// Force at zero gain, and its fall with the gain.
    pub line: Rows,
    pub slope: Rows,
    pub force: Rows,
}
