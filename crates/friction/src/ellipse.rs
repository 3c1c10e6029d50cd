//! The set of deflections that a contact holds: a disc, or an ellipse with its own axes, and how a deflection comes back.
//!
//!   q(s) = (s₁/a₁)² + (s₂/a₂)² ≤ 1,      s₁ along the grain, s₂ across it; aᵢ = μᵢ fₙ / k
//!   beyond it   s ← s/√q(s)               shortened along itself
//!
//! Where the levels differ, two things must be said: which forces are held, and in which direction a force that is not
//! held slips. The first is the ellipse (orthotropic friction: Zmitrowicz 1989). The second does not follow from the first.
//! Maximum dissipation would make the slip normal to the ellipse (the *associated* rule; the return is then to the nearest
//! point in the metric of the spring). Surfaces with asperities do not keep to it: Michałowski and Mróz (1978) derive
//! slip that is not associated, from a potential of its own. With a circle for that potential the slip is along the force: in steady
//! sliding, ṡ = u − λ s with s on the ellipse leads s into the direction of u, and
//!
//!   f = −μ(φ) fₙ û,   1/μ(φ)² = cos²φ/μ₁² + sin²φ/μ₂²,   φ: from the grain to the slip
//!
//! so that friction opposes the velocity at the level of its direction, and always dissipates: −f·u = μ(φ) fₙ |u|. This
//! is the one rule here, whichever entry of a file asks for different levels; on a disc both rules are the radial return.
//!
//! A. Zmitrowicz, "Mathematical descriptions of anisotropic friction", Int. J. Solids Structures 25 (1989) 837–862.
//! R. Michałowski and Z. Mróz, "Associated and non-associated sliding rules in contact friction problems", Archives of
//! Mechanics 30 (1978) 259–276.

use crate::trial::is_zero;
use nalgebra::Vector3;

/// Semi-axes along and across the grain, m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ellipse {
    pub along: f64,
    pub across: f64,
    /// Unit vector; zero for a disc of radius `along`.
    pub grain: Vector3<f64>,
}

/// What is held of a deflection, and the derivative of that map: `shrink (1 − d dᵀ)` within the plane, d the `normal`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Held {
    pub s: Vector3<f64>,
    pub inside: bool,
    pub shrink: f64,
    pub normal: Vector3<f64>,
}

impl Ellipse {
    /// The set, `k` times as large.
    #[inline]
    pub fn scaled(&self, k: f64) -> Self {
        Self { along: self.along * k, across: self.across * k, ..*self }
    }

    #[inline]
    pub fn is_round(&self) -> bool {
        self.along == self.across || is_zero(&self.grain)
    }

    /// What the set holds of a deflection. Of the derivative only the part that turns is told, which is symmetric: what a
    /// turn changes of the length is left to the next pass of a solver.
    #[inline]
    pub fn hold(&self, s: &Vector3<f64>) -> Held {
        if self.is_round() {
            return self.hold_on_disc(s);
        }
        let size = self.calc_size(s);
        if size <= 1.0 {
            return Held { s: *s, inside: true, shrink: 1.0, normal: Vector3::zeros() };
        }
        let normal = s.try_normalize(0.0).unwrap_or_default();
        let shrink = 1.0 / size.sqrt();
        Held { s: s * shrink, inside: false, shrink, normal }
    }

    /// (s₁/a₁)² + (s₂/a₂)².
    fn calc_size(&self, s: &Vector3<f64>) -> f64 {
        let s_along = s.dot(&self.grain);
        let s_across = s - self.grain * s_along;
        let share = |x: f64, axis: f64| if x == 0.0 { 0.0 } else { x / (axis * axis) };
        share(s_along * s_along, self.along) + share(s_across.norm_squared(), self.across)
    }

    /// The point of the bound in the direction of a deflection.
    pub fn on_bound(&self, s: &Vector3<f64>) -> Vector3<f64> {
        let size = self.calc_size(s);
        if size > 0.0 { s / size.sqrt() } else { *s }
    }

    #[inline]
    fn hold_on_disc(&self, s: &Vector3<f64>) -> Held {
        let length = s.norm();
        if length <= self.along {
            return Held { s: *s, inside: true, shrink: 1.0, normal: Vector3::zeros() };
        }
        let shrink = self.along / length;
        Held { s: s * shrink, inside: false, shrink, normal: s / length }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ELLIPSE: Ellipse = Ellipse { along: 2.0, across: 0.5, grain: Vector3::new(1.0, 0.0, 0.0) };

    /// Deflections beyond the ellipse in all directions.
    fn outside() -> impl Iterator<Item = Vector3<f64>> {
        (0..200).map(|k| {
            let angle = f64::from(k) * 0.0314;
            Vector3::new(angle.cos(), angle.sin(), 0.0) * (2.1 + 0.1 * f64::from(k))
        })
    }

    #[test]
    fn shortened_along_itself_a_deflection_keeps_its_direction_and_ends_on_the_ellipse() {
        for s in outside() {
            let held = ELLIPSE.hold(&s);
            // Round-off of a quotient.
            assert!(held.s.cross(&s).norm() < 1e-14 * s.norm_squared() && held.s.dot(&s) > 0.0);
            assert!(((held.s.x / 2.0).hypot(held.s.y / 0.5) - 1.0).abs() < 1e-14);
        }
        let flat = Ellipse { across: 0.0, ..ELLIPSE };
        assert_eq!(flat.hold(&Vector3::y()).s, Vector3::zeros(), "nothing is held across a grain without friction");
        assert_eq!(flat.hold(&Vector3::x()).s, Vector3::x());
    }

    #[test]
    fn equal_axes_are_the_radial_return() {
        let s = Vector3::new(3.0, -4.0, 0.0);
        let round = Ellipse { along: 1.0, across: 1.0, ..ELLIPSE };
        let disc = round.hold(&s);
        let nearly = Ellipse { across: 1.0 + 1e-13, ..round }.hold(&s);
        assert!((disc.s - s / 5.0).norm() < 1e-15);
        assert!((nearly.s - disc.s).norm() < 1e-12);
    }

    #[test]
    fn what_it_tells_of_its_derivative_is_how_the_held_point_turns() {
        for s in outside() {
            let held = ELLIPSE.hold(&s);
            let side = Vector3::z().cross(&held.normal);
            let e = side * 1e-6;
            let slope = (ELLIPSE.hold(&(s + e)).s - ELLIPSE.hold(&(s - e)).s) / 2e-6;
            // Central difference: 1e-12 of curvature and round-off 1e-15/1e-6.
            assert!((slope.dot(&side) - held.shrink).abs() < 1e-8, "{slope} {}", held.shrink);
        }
    }

    /// Dragged far in one direction, whatever it began with, a deflection lies along the drag at the level of that direction.
    #[test]
    fn dragged_steadily_it_lies_along_the_slip_at_that_directions_level() {
        for slip in outside().map(|s| s.normalize()) {
            let end = (0..2_000).fold(Vector3::new(-0.3, 0.4, 0.0), |s, _| ELLIPSE.hold(&(s + 0.02 * slip)).s);
            let level = 1.0 / (slip.x / 2.0).hypot(slip.y / 0.5);
            assert!((end - level * slip).norm() < 1e-8, "{end} {slip}");
        }
    }
}
