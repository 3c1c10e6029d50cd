//! The coordinates in which the memory of effects is said: see [`memory_layout`].

use super::Model;
use crate::parts::{EffectKind, REACH};

/// One coordinate of the effects' memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MemorySlot {
    /// Index of the effect in the model.
    pub effect: usize,
    /// What it is, within its effect.
    pub name: &'static str,
    /// Its place in [`crate::State::effects`] and in [`crate::World::effect_memory`].
    pub offset: usize,
    /// A usual size, for differences and priors; SI.
    pub scale: f64,
    /// The largest that it comes to by itself, SI: dry friction slides at its reach. None where nothing holds it.
    pub largest: Option<f64>,
}

/// All coordinates of the effects' memory, in order.
pub fn memory_layout(model: &Model) -> Vec<MemorySlot> {
    let of = |(effect, kind): (usize, &EffectKind)| {
        let (start, scales) = (model.effects.memory(effect).start, scales(kind));
        let largest = match kind {
            EffectKind::Joint(effect) => effect.largest_deflection(),
            _ => None,
        };
        let slot = move |(k, name): (usize, &&'static str)| {
            let scale = scales.get(k).copied().unwrap_or(1.0);
            MemorySlot { effect, name, offset: start + k, scale, largest }
        };
        kind.memory_names().iter().enumerate().map(slot)
    };
    model.effects.list.iter().map(|e| &e.kind).enumerate().flat_map(of).collect()
}

/// Usual sizes of an effect's coordinates.
fn scales(kind: &EffectKind) -> &'static [f64] {
    match kind {
        EffectKind::Joint(_) => &[REACH],
        // Milliradians of a loaded gear, and what they make in a tenth of a second.
        EffectKind::Series(_) => &[1e-3, 1e-2],
        EffectKind::Body(effect) => effect.law.memory_scales(),
        _ => &[],
    }
}
