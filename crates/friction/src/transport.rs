//! How a deflection is carried while the bodies and the tangent plane turn.
//!
//! The bristle stands between the two bodies: one end is rooted in A, the other in B. Where both turn alike it turns with
//! them; where they turn differently about the normal it turns by the mean of both, so that it does not matter which of them
//! is called A. Where the plane turns against the bodies (rolling, sliding over curvature) the deflection is carried by the
//! smallest rotation that takes the old normal to the new:
//!
//!   s' = s − (n'·s)/(1 + n·n') (n + n'),      for s ⟂ n
//!
//! As the steps shrink that is the parallel transport of the surface (Levi-Civita 1917): lengths, and with them the stored
//! energy, stay; carried round a closed path on a sphere, s comes back turned by the solid angle that the path encloses.

use nalgebra::Vector3;

/// Carries a vector of the plane normal to `from` into the plane normal to `to` (unit vectors), by the smallest rotation;
/// its component along `from` comes to lie along `to`.
///
/// Where the normal reverses there is no smallest rotation: the vector stays where it is.
#[inline]
pub fn carry(v: &Vector3<f64>, from: &Vector3<f64>, to: &Vector3<f64>) -> Vector3<f64> {
    let span = 1.0 + from.dot(to);
    if span < 1e-12 {
        return *v;
    }
    let up = v.dot(from);
    let flat = v - from * up;
    flat - (from + to) * (to.dot(&flat) / span) + to * up
}

/// The mean of a vector that was carried with two bodies, at its length.
#[inline]
pub fn mean_of(with_a: &Vector3<f64>, with_b: &Vector3<f64>) -> Vector3<f64> {
    if with_a == with_b {
        return *with_a;
    }
    let sum = with_a + with_b;
    let (length, size) = (with_b.norm(), sum.norm());
    if size > 0.0 { sum * (length / size) } else { *with_b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Rotation3;

    #[test]
    fn lengths_and_angles_stay() {
        let (n, to) = (Vector3::z(), Vector3::new(0.3, -0.5, 0.7).normalize());
        let (s, t) = (Vector3::new(1.0, 2.0, 0.0), Vector3::new(-0.3, 0.4, 0.0));
        let (sc, tc) = (carry(&s, &n, &to), carry(&t, &n, &to));
        assert!(sc.dot(&to).abs() < 1e-15 && (sc.dot(&tc) - s.dot(&t)).abs() < 1e-15);
        assert!((carry(&sc, &to, &n) - s).norm() < 1e-15, "and back");
        assert!((carry(&n, &n, &to) - to).norm() < 1e-15);
    }

    /// Round a circle of latitude the deflection turns by the solid angle of the cap, 2π (1 − cos θ): parallel transport,
    /// with an error of second order in the step.
    #[test]
    fn round_a_cap_it_turns_by_the_solid_angle() {
        let polar = 0.6_f64;
        let solid = 2.0 * std::f64::consts::PI * (1.0 - polar.cos());
        let normal = |angle: f64| {
            Rotation3::from_axis_angle(&Vector3::z_axis(), angle) * Vector3::new(polar.sin(), 0.0, polar.cos())
        };
        let run = |steps: usize| {
            let (mut n, mut s) = (normal(0.0), Vector3::y());
            for k in 1..=steps {
                let next = normal(2.0 * std::f64::consts::PI * k as f64 / steps as f64);
                s = carry(&s, &n, &next);
                n = next;
            }
            let start = normal(0.0);
            let turned = start.dot(&Vector3::y().cross(&s)).atan2(s.dot(&Vector3::y()));
            ((turned - solid) / (2.0 * std::f64::consts::PI)).fract().abs()
        };
        let (coarse, fine) = (run(100), run(200));
        assert!(coarse < 1e-3 && (coarse / fine - 4.0).abs() < 0.1, "{coarse} {fine}");
    }

    #[test]
    fn the_mean_turns_by_half_the_relative_spin() {
        let s = Vector3::new(1.0, 0.0, 0.0);
        let turned = Rotation3::from_axis_angle(&Vector3::z_axis(), 0.2) * s;
        let half = Rotation3::from_axis_angle(&Vector3::z_axis(), 0.1) * s;
        assert!((mean_of(&s, &turned) - half).norm() < 1e-15);
        assert_eq!(mean_of(&s, &turned), mean_of(&turned, &s));
    }
}
