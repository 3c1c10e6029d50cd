//! What fits leave, held against each other: forces that are missing, and more noise where a sensor's fault is no force.

use super::search::{FURTHER, further};
use crate::identify::marginal::Spread;

/// Factor by which the noise of a channel may grow where it stands for nothing.
const LOUDER: f64 = 1.01;
/// Mean square beyond that of its noise from which on a channel is loud.
const LOUD: f64 = 0.1;

/// What a fit leaves: what its unknown forces do, and how large they and the noise are.
pub(super) struct Left {
    pub power: f64,
    pub spread: Spread,
}

impl Left {
    /// Whether it takes its part of what another one leaves, or a sensor's fault. `all`: what the nominal model leaves.
    pub(super) fn takes_its_part_of(&self, known: &Self, all: f64, doubt: f64) -> bool {
        self.power <= (1.0 - further(known.power, all)) * known.power || quiets(&self.spread, &known.spread, doubt)
    }
}

/// A set that was fitted, and what it leaves.
pub(super) struct Smaller {
    pub titles: Vec<String>,
    pub left: Left,
}

impl Smaller {
    /// Whether it has all of a smaller set and what it adds takes less than its part.
    pub(super) fn is_idle_beside(&self, known: &Self, all: f64, doubt: f64) -> bool {
        known.titles.iter().all(|t| self.titles.contains(t)) && !self.left.takes_its_part_of(&known.left, all, doubt)
    }
}

/// Whether a spread takes no more for noise than another one.
pub(super) fn is_as_quiet(spread: &Spread, than: &Spread) -> bool {
    spread.noise.iter().zip(&than.noise).all(|(a, b)| *a <= LOUDER * b)
}

/// Whether a channel that reads with more noise beside another spread than its sensor has is next to right beside this one: what is left of the unknown
/// forces does not say how much of a sensor's fault is taken. `doubt`: mean square that a wrong figure of the noise may stand for.
fn quiets(spread: &Spread, than: &Spread, doubt: f64) -> bool {
    let excess = |noise: &f64| excess(*noise, doubt);
    let is_quieted =
        |(after, before): (&f64, &f64)| excess(before) > LOUD && excess(after) <= (1.0 - FURTHER[1]) * excess(before);
    spread.noise.iter().zip(&than.noise).any(is_quieted)
}

/// Gain by sample, −2 log likelihood, of a channel that is next to right where it read with this factor of its noise; none where that is its sensor's.
pub(super) fn quieting(noise: f64, doubt: f64) -> Option<f64> {
    let loud = excess(noise, doubt);
    (loud > LOUD).then(|| (noise * noise / (noise * noise - FURTHER[1] * loud)).ln())
}

/// Mean square of a channel beyond that of its noise.
fn excess(noise: f64, doubt: f64) -> f64 {
    (noise * noise - 1.0 - doubt).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;

    fn with(noise: [f64; 2]) -> Spread {
        Spread { noise: DVector::from_row_slice(&noise), ..Spread::steady(1, 2) }
    }

    #[test]
    fn a_channel_gains_by_what_it_is_quieted() {
        assert_eq!(quieting(1.04, 0.06), None, "its figure may be wrong by that");
        // A quarter of an excess of 3 is left: a variance of 4 becomes 1.75.
        assert!(quieting(2.0, 0.0).is_some_and(|gain| (gain - (4.0f64 / 1.75).ln()).abs() < 1e-12));
    }

    #[test]
    fn a_loud_channel_has_to_become_next_to_right() {
        const DOUBT: f64 = 0.06;
        assert!(quiets(&with([1.0, 1.1]), &with([1.0, 2.0]), DOUBT));
        assert!(!quiets(&with([1.0, 1.6]), &with([1.0, 2.0]), DOUBT), "half of it is left");
        assert!(!quiets(&with([1.0, 1.0]), &with([1.0, 1.05]), DOUBT), "its figure may be wrong by that");
        assert!(quiets(&with([1.0, 3.0]), &with([1.5, 2.0]), DOUBT), "each channel for itself");
        assert!(
            is_as_quiet(&with([1.0, 1.005]), &with([1.0, 1.0])) && !is_as_quiet(&with([1.0, 1.1]), &with([1.5, 1.0]))
        );
    }
}
