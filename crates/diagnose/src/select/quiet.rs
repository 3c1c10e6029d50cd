//! What a sensor's fault leaves: more noise of its channel, and no force that is missing.

use super::search::FURTHER;
use crate::identify::marginal::Spread;

/// Factor by which the noise of a channel may grow where it stands for nothing.
const LOUDER: f64 = 1.01;
/// Mean square beyond that of its noise from which on a channel is loud.
const LOUD: f64 = 0.1;

/// Whether a spread takes no more for noise than another one.
pub(super) fn is_as_quiet(spread: &Spread, than: &Spread) -> bool {
    spread.noise.iter().zip(&than.noise).all(|(a, b)| *a <= LOUDER * b)
}

/// Whether a channel that reads with more noise beside another spread than its sensor has is next to right beside this one: what is left of the unknown
/// forces does not say how much of a sensor's fault is taken. `doubt`: mean square that a wrong figure of the noise may stand for.
pub(super) fn quiets(spread: &Spread, than: &Spread, doubt: f64) -> bool {
    let excess = |noise: &f64| (noise * noise - 1.0 - doubt).max(0.0);
    let is_quieted =
        |(after, before): (&f64, &f64)| excess(before) > LOUD && excess(after) <= (1.0 - FURTHER[1]) * excess(before);
    spread.noise.iter().zip(&than.noise).any(is_quieted)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;

    fn with(noise: [f64; 2]) -> Spread {
        Spread { noise: DVector::from_row_slice(&noise), ..Spread::steady(1, 2) }
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
