//! Eight points round a closed curve of contact: a ball seated in a cone, a ring flat on a plane, a peg in a tight bore.
//!
//! Off centre the deepest place leads and the others follow at equal angles, so what the points do together depends on
//! the offset alone, not on its azimuth: the force is the gradient of Σ U(gap_k), it conserves energy and passes smoothly
//! through zero on the axis. There the azimuth means nothing, so once all of the curve touches by more than the depths
//! differ the points stand fixed in the shape, and in between they turn in proportion. Where all eight touch, a linear
//! law's resultant does not depend on how they are turned (Σ cos θ_k and Σ cos 2θ_k vanish), nor that of δⁿ to its eighth
//! harmonic, so nothing shows.
//!
//! Stiffness k per point: on a seat of normals inclined by β against the axis, 8 k cos²β along the axis and 4 k sin²β
//! across it.

use std::f64::consts::TAU;

/// Points round a curve.
pub(crate) const ROUND: usize = 8;
/// Sector angle, rad.
const SECTOR: f64 = TAU / ROUND as f64;

/// Where the eight points are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seat {
    /// Angle of the first, rad.
    first: f64,
    /// Number of the first, where they are fixed or on their way to it.
    number: Option<u32>,
    leader: f64,
}

impl Seat {
    /// `leader`: angle of the deepest place; `near` and `far`: the smallest gap round the curve, and the largest.
    pub(crate) fn new(leader: f64, near: f64, far: f64) -> Self {
        if far >= 0.0 {
            return Self { first: leader, number: None, leader };
        }
        let sectors = leader / SECTOR;
        let nearest = sectors.round();
        let share = if far > near { (-far / (far - near)).min(1.0) } else { 1.0 };
        let free = 1.0 - share * share * (3.0 - 2.0 * share);
        let number = (nearest as i64).rem_euclid(ROUND as i64) as u32;
        Self { first: SECTOR * (nearest + free * (sectors - nearest)), number: Some(number), leader }
    }

    /// Angle of point `k`, rad.
    pub(crate) fn angle(&self, k: usize) -> f64 {
        self.first + SECTOR * k as f64
    }

    /// Whether the first point is at the deepest place.
    pub(crate) fn follows(&self) -> bool {
        self.number.is_none()
    }

    /// Identity of point `k`.
    pub(crate) fn label(&self, k: usize) -> u32 {
        self.number.map_or(k as u32, |number| ROUND as u32 + (number + k as u32) % ROUND as u32)
    }

    /// Which of the eight an angle is nearest to.
    pub(crate) fn bin(&self, angle: f64) -> usize {
        ((angle - self.leader) / SECTOR).round().rem_euclid(ROUND as f64) as usize % ROUND
    }
}
