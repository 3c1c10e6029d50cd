//! The set of deflections that a contact holds: a disc, or an ellipse with its own axes.
//!
//!   (s₁/a₁)² + (s₂/a₂)² ≤ 1,      s₁ along the grain, s₂ across it; aᵢ = μᵢ fₙ / k
//!
//! A trial outside it comes back to the nearest point of the ellipse: the return of an elastic spring under the principle
//! of maximum dissipation, so that the slip is normal to the ellipse and the derivative symmetric. On a disc that is the
//! radial return. The nearest point is s_i = s⁺_i a_i²/(a_i² + λ), with λ > 0 the root of
//!
//!   Σ (a_i s⁺_i / (a_i² + λ))² = 1,
//!
//! a falling, convex function of λ: Newton's method from the left climbs to it without a turn.
//!
//! The radial return shortens the deflection along itself instead, s = s⁺/√((s⁺₁/a₁)² + (s⁺₂/a₂)²): in steady sliding the
//! force then opposes the velocity, at the level of that direction. Which of the two holds is [`crate::Return`].

use crate::trial::{Return, is_zero};
use nalgebra::Vector3;

/// Semi-axes along and across the grain, m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ellipse {
    pub along: f64,
    pub across: f64,
    /// Unit vector; zero for a disc of radius `along`.
    pub grain: Vector3<f64>,
    /// How a deflection beyond it comes back.
    pub way: Return,
}

/// The nearest point of the set, and the derivative of that map: `shrink (1 − d dᵀ)` within the plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    pub s: Vector3<f64>,
    pub inside: bool,
    pub shrink: f64,
    pub normal: Vector3<f64>,
}

/// Newton steps at most; a handful is enough for round-off at any aspect ratio, each at least halves the distance.
const NEWTON_STEPS: usize = 60;

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

    /// What the set holds of a deflection, by its way of return.
    #[inline]
    pub fn hold(&self, s: &Vector3<f64>) -> Nearest {
        match self.way {
            Return::Nearest => self.nearest(s),
            Return::Radial => self.shortened(s),
        }
    }

    /// A deflection beyond the set shortened along itself. Of the derivative only the symmetric part, which turns, is told.
    fn shortened(&self, s: &Vector3<f64>) -> Nearest {
        if self.is_round() {
            return self.nearest_on_disc(s);
        }
        let size = self.calc_size(s);
        if size <= 1.0 {
            return Nearest { s: *s, inside: true, shrink: 1.0, normal: Vector3::zeros() };
        }
        let normal = s.try_normalize(0.0).unwrap_or_default();
        let shrink = 1.0 / size.sqrt();
        Nearest { s: s * shrink, inside: false, shrink, normal }
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
    pub fn nearest(&self, s: &Vector3<f64>) -> Nearest {
        if self.is_round() {
            return self.nearest_on_disc(s);
        }
        let s_along = s.dot(&self.grain);
        let rest = s - self.grain * s_along;
        let s_across = rest.norm();
        let side = if s_across > 0.0 { rest / s_across } else { Vector3::zeros() };
        let (a, b) = (self.along, self.across);
        if a == 0.0 || b == 0.0 || (s_along / a).powi(2) + (s_across / b).powi(2) <= 1.0 {
            return self.degenerate_or_inside(s, (s_along, s_across), &side);
        }
        let lambda = root((a * s_along, b * s_across), (a * a, b * b));
        let (da, db) = (a * a / (a * a + lambda), b * b / (b * b + lambda));
        let (pa, pb) = (da * s_along, db * s_across);
        // Normal of the ellipse there, and what is left of D − D g gᵀ D / gᵀ D g: one eigenvalue, across the normal.
        let (ga, gb) = (pa / (a * a), pb / (b * b));
        let size = ga.hypot(gb);
        let (na, nb) = (ga / size, gb / size);
        let shrink = da * db / (da * na * na + db * nb * nb);
        Nearest { s: self.grain * pa + side * pb, inside: false, shrink, normal: self.grain * na + side * nb }
    }

    #[inline]
    fn nearest_on_disc(&self, s: &Vector3<f64>) -> Nearest {
        let length = s.norm();
        if length <= self.along {
            return Nearest { s: *s, inside: true, shrink: 1.0, normal: Vector3::zeros() };
        }
        let shrink = self.along / length;
        Nearest { s: s * shrink, inside: false, shrink, normal: s / length }
    }

    fn degenerate_or_inside(&self, s: &Vector3<f64>, (along, across): (f64, f64), side: &Vector3<f64>) -> Nearest {
        if self.along > 0.0 && self.across > 0.0 {
            return Nearest { s: *s, inside: true, shrink: 1.0, normal: Vector3::zeros() };
        }
        let held = self.grain * along.clamp(-self.along, self.along) + side * across.min(self.across);
        Nearest { s: held, inside: false, shrink: 0.0, normal: s.try_normalize(0.0).unwrap_or_default() }
    }
}

/// The root λ of Σ (xᵢ/(aᵢ + λ))² = 1, for a sum above one at λ = 0.
fn root(x: (f64, f64), a: (f64, f64)) -> f64 {
    let mut lambda = (x.0.abs() - a.0).max(x.1.abs() - a.1).max(0.0);
    for _ in 0..NEWTON_STEPS {
        let (p, q) = (x.0 / (a.0 + lambda), x.1 / (a.1 + lambda));
        let value = p * p + q * q - 1.0;
        let step = value / (2.0 * (p * p / (a.0 + lambda) + q * q / (a.1 + lambda)));
        let next = lambda + step;
        if next <= lambda {
            break;
        }
        lambda = next;
    }
    lambda
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_point_is_on_the_ellipse_and_the_way_to_it_is_normal() {
        let ellipse = Ellipse { along: 2.0, across: 0.5, grain: Vector3::x(), way: Return::Nearest };
        for k in 0..200 {
            let angle = f64::from(k) * 0.0314;
            let s = Vector3::new(angle.cos(), angle.sin(), 0.0) * (2.1 + 0.1 * f64::from(k));
            let near = ellipse.nearest(&s);
            let on = (near.s.x / 2.0).powi(2) + (near.s.y / 0.5).powi(2);
            // Round-off of the root.
            assert!((on - 1.0).abs() < 1e-12, "{on}");
            assert!((s - near.s).normalize().cross(&near.normal).norm() < 1e-9);
        }
    }

    #[test]
    fn its_derivative_is_that_of_the_nearest_point() {
        let ellipse = Ellipse { along: 2.0, across: 0.5, grain: Vector3::new(0.6, 0.8, 0.0), way: Return::Nearest };
        let s = Vector3::new(1.7, 1.9, 0.0);
        let near = ellipse.nearest(&s);
        for k in 0..2 {
            let e = Vector3::ith(k, 1e-6);
            let slope = (ellipse.nearest(&(s + e)).s - ellipse.nearest(&(s - e)).s) / 2e-6;
            let unit = Vector3::ith(k, 1.0);
            let claimed = near.shrink * (unit - near.normal * near.normal[k]);
            // Central difference: 1e-12 of curvature and round-off 1e-16/1e-6.
            assert!((slope - claimed).norm() < 1e-8, "{slope} {claimed}");
        }
    }

    #[test]
    fn equal_axes_are_the_radial_return() {
        let s = Vector3::new(3.0, -4.0, 0.0);
        let round = Ellipse { along: 1.0, across: 1.0, grain: Vector3::x(), way: Return::Nearest };
        let disc = round.nearest(&s);
        let nearly = Ellipse { across: 1.0 + 1e-13, ..round }.nearest(&s);
        assert!((disc.s - s / 5.0).norm() < 1e-15);
        assert!((nearly.s - disc.s).norm() < 1e-12);
    }

    #[test]
    fn shortened_along_itself_a_deflection_keeps_its_direction_and_ends_on_the_ellipse() {
        let ellipse = Ellipse { along: 2.0, across: 0.5, grain: Vector3::x(), way: Return::Radial };
        for k in 0..200 {
            let angle = f64::from(k) * 0.0314;
            let s = Vector3::new(angle.cos(), angle.sin(), 0.0) * (2.1 + 0.1 * f64::from(k));
            let held = ellipse.hold(&s);
            // Round-off of a quotient.
            assert!(held.s.cross(&s).norm() < 1e-14 * s.norm_squared() && held.s.dot(&s) > 0.0);
            assert!(((held.s.x / 2.0).hypot(held.s.y / 0.5) - 1.0).abs() < 1e-14);
        }
        let flat = Ellipse { across: 0.0, ..ellipse };
        assert_eq!(flat.hold(&Vector3::y()).s, Vector3::zeros(), "nothing is held across a grain without friction");
        assert_eq!(flat.hold(&Vector3::x()).s, Vector3::x());
    }
}
