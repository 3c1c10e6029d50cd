//! Friction of a disc that slides and spins under uniform pressure (Contensou 1963; in elliptic integrals: Farkas, Bartels,
//! Unger and Wolf 2003).
//!
//! With ε = v/(ω R), m = ε² (below one) or 1/ε² (above), K and E the complete elliptic integrals of parameter m:
//!
//!   F/μN  = 4 [(ε²+1) E + (ε²−1) K]/(3π ε)                         ε ≤ 1
//!         = 4 [(ε²+1) E − (ε²−1) K]/(3π)                           ε ≥ 1
//!   T/μNR = 4 [(4−2ε²) E + (ε²−1) K]/(9π)                          ε ≤ 1
//!         = 4 ε [(4−2ε²) E + (2ε² − 5 + 3/ε²) K]/(9π)              ε ≥ 1
//!
//! The test holds them against the area integral.

use std::f64::consts::PI;

/// Complete elliptic integrals K and E of the parameter m in [0, 1), by the arithmetic–geometric mean
/// (Abramowitz and Stegun 1964, chapter 17).
pub fn calc_elliptic(m: f64) -> (f64, f64) {
    let (mut a, mut g, mut c2, mut power, mut sum) = (1.0_f64, (1.0 - m).sqrt(), m, 0.5, 0.5 * m);
    // Quadratic: a handful of rounds reaches round-off for every m that is a number below one.
    while c2 > 1e-31 {
        let (next_a, next_g) = (0.5 * (a + g), (a * g).sqrt());
        c2 = (0.5 * (a - g)).powi(2);
        power *= 2.0;
        sum += power * c2;
        (a, g) = (next_a, next_g);
    }
    let k = 0.5 * PI / a;
    (k, k * (1.0 - sum))
}

/// Force over μN and torque over μNR at ε = v/(ωR).
pub fn calc_disc(epsilon: f64) -> (f64, f64) {
    let e2 = epsilon * epsilon;
    if epsilon == 0.0 {
        return (0.0, 2.0 / 3.0);
    }
    if (epsilon - 1.0).abs() < 1e-12 {
        return (8.0 / (3.0 * PI), 8.0 / (9.0 * PI));
    }
    if epsilon < 1.0 {
        let (k, e) = calc_elliptic(e2);
        let force = 4.0 * ((e2 + 1.0) * e + (e2 - 1.0) * k) / (3.0 * PI * epsilon);
        return (force, 4.0 * ((4.0 - 2.0 * e2) * e + (e2 - 1.0) * k) / (9.0 * PI));
    }
    let (k, e) = calc_elliptic(1.0 / e2);
    let force = 4.0 * ((e2 + 1.0) * e - (e2 - 1.0) * k) / (3.0 * PI);
    (force, 4.0 * epsilon * ((4.0 - 2.0 * e2) * e + (2.0 * e2 - 5.0 + 3.0 / e2) * k) / (9.0 * PI))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elliptic_integrals_have_their_known_values() {
        let (k, e) = calc_elliptic(0.5);
        assert!((k - 1.854_074_677_301_372).abs() < 1e-14 && (e - 1.350_643_881_047_675_5).abs() < 1e-14);
        assert!((calc_elliptic(0.0).0 - 0.5 * PI).abs() < 1e-15);
    }

    /// The area integral in polar co-ordinates, midpoint rule.
    fn integrate(epsilon: f64) -> (f64, f64) {
        let (rings, rays) = (400, 800);
        let (mut force, mut torque) = (0.0, 0.0);
        for i in 0..rings {
            let r = (f64::from(i) + 0.5) / f64::from(rings);
            for j in 0..rays {
                let phi = 2.0 * PI * (f64::from(j) + 0.5) / f64::from(rays);
                let (x, y) = (r * phi.cos(), r * phi.sin());
                let (u, w) = (epsilon - y, x);
                let weight = 2.0 * r / f64::from(rings * rays);
                let size = u.hypot(w);
                force += weight * u / size;
                torque += weight * (x * w - y * u) / size;
            }
        }
        (force, torque)
    }

    #[test]
    fn closed_forms_are_the_area_integral() {
        for epsilon in [0.01, 0.3, 0.9, 1.0, 1.1, 2.0, 7.0] {
            let ((f, t), (f_sum, t_sum)) = (calc_disc(epsilon), integrate(epsilon));
            // Midpoint rule across the kink at the centre of rotation.
            assert!((f - f_sum).abs() < 3e-5 && (t - t_sum).abs() < 3e-5, "{epsilon}: {f} {f_sum} {t} {t_sum}");
        }
    }
}
