//! The dragged bristle is a rope on a post's end: its tip slides along the rope only (a pursuit, or tractrix).
//!
//! With deflection s of constant length L, slip u and ŝ = s/L, sliding says ṡ = u − ŝ (ŝ·u). So the angle θ from u to s obeys,
//! on a straight line with the way x,
//!
//!   dθ/dx = −sin θ / L,      tan(θ/2) = tan(θ₀/2) e^{−x/L}                   (the tractrix)
//!
//! and on a circle of radius R in the steady state the tip runs on the circle of radius √(R² − L²) to which s is tangent,
//!
//!   sin θ = L/R,
//!
//! whatever the speed: both forms are geometry.

/// Angle between slip and deflection after the way `x` (m) on a straight line, from `theta` (rad), rope of `length` (m).
pub fn calc_turning(theta: f64, x: f64, length: f64) -> f64 {
    2.0 * ((0.5 * theta).tan() * (-x / length).exp()).atan()
}

/// Angle by which the deflection lags behind the slip on a circle of `radius` (m), rope of `length` (m), rad.
pub fn calc_lag(length: f64, radius: f64) -> f64 {
    (length / radius).asin()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ṡ = u − ŝ (ŝ·u) in small steps (Heun), on a corner and on a circle.
    #[test]
    fn closed_forms_solve_the_equation_of_the_dragged_bristle() {
        let rate = |s: [f64; 2], u: [f64; 2]| {
            let along = (s[0] * u[0] + s[1] * u[1]) / (s[0] * s[0] + s[1] * s[1]);
            [u[0] - along * s[0], u[1] - along * s[1]]
        };
        let advance = |s: [f64; 2], u0: [f64; 2], u1: [f64; 2], h: f64| {
            let a = rate(s, u0);
            let b = rate([s[0] + h * a[0], s[1] + h * a[1]], u1);
            [s[0] + 0.5 * h * (a[0] + b[0]), s[1] + 0.5 * h * (a[1] + b[1])]
        };
        let (length, h) = (0.3, 1e-4);
        let mut s = [0.0, length];
        for _ in 0..5000 {
            s = advance(s, [1.0, 0.0], [1.0, 0.0], h);
        }
        let theta = calc_turning(std::f64::consts::FRAC_PI_2, 0.5, length);
        assert!((s[1].atan2(s[0]) - theta).abs() < 1e-7);
        let tangent = |t: f64| [-t.sin(), t.cos()];
        let mut s = [0.0, length];
        let steps = 200_000;
        for k in 0..steps {
            s = advance(s, tangent(f64::from(k) * h), tangent(f64::from(k + 1) * h), h);
        }
        let t = tangent(f64::from(steps) * h);
        let sine = (t[0] * s[1] - t[1] * s[0]) / length;
        assert!((sine.abs().asin() - calc_lag(length, 1.0)).abs() < 1e-7, "{sine}");
    }
}
