//! What laws of coordinates and lines read of the world.

use crate::model::Model;
use crate::state::State;

/// What a coordinate's law reads of the world beside its own position and rate.
#[derive(Clone, Copy)]
pub(crate) struct Acting<'a> {
    pub model: &'a Model,
    pub state: &'a State,
    /// Length of the step, s.
    pub step: f64,
    /// Time since the step's start of an explicit stage, s; none where one evaluation stands for the whole step.
    pub since: Option<f64>,
}

impl<'a> Acting<'a> {
    /// Memory of an effect.
    pub fn memory(&self, index: usize) -> &'a [f64] {
        &self.state.effects[self.model.effects.memory(index)]
    }
}
