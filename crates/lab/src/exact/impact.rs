//! A ball that flies against a wall: Hertz and Hunt–Crossley, without gravity.
//!
//!   m δ̈ = −k δ^{3/2} (1 + d δ̇),   δ(0) = 0,  δ̇(0) = v
//!
//! d = 0 (Hertz; Johnson 1985, section 11.1): energy gives the approach, and the time follows by a Beta function,
//!
//!   δₘ = (5 m v² / 4k)^{2/5},   Fₘ = k δₘ^{3/2},   T = 2 √π Γ(7/5)/Γ(9/10) δₘ/v = 2.9433 δₘ/v
//!
//! d > 0: with u = δ̇, m u du = −k δ^{3/2} (1 + d u) dδ separates, for every exponent, so that approach and return pass the
//! same δₘ:
//!
//!   G(v) = G(−e v),   G(u) = ∫₀ᵘ w dw/(1 + d w) = (d u − ln(1 + d u))/d²         e = 1 − ⅔ d v + O((d v)²)

/// 2 √π Γ(7/5)/Γ(9/10): duration of a Hertzian impact in units of δₘ/v.
const DURATION: f64 = 2.943_275_184_324_706;

/// One impact.
#[derive(Clone, Copy, Debug)]
pub struct Impact {
    /// kg.
    pub mass: f64,
    /// k, N/m^{3/2}.
    pub stiffness: f64,
    /// d, s/m.
    pub dissipation: f64,
    /// Speed of approach, m/s.
    pub speed: f64,
}

impl Impact {
    /// Largest approach without dissipation, m.
    pub fn calc_hertz_approach(&self) -> f64 {
        (1.25 * self.mass * self.speed * self.speed / self.stiffness).powf(0.4)
    }

    /// Largest force without dissipation, N.
    pub fn calc_hertz_force(&self) -> f64 {
        self.calc_force(self.calc_hertz_approach())
    }

    /// Force of the spring at a depth, N.
    pub fn calc_force(&self, depth: f64) -> f64 {
        self.stiffness * depth.max(0.0).powf(1.5)
    }

    /// Duration of the contact without dissipation, s.
    pub fn calc_hertz_duration(&self) -> f64 {
        DURATION * self.calc_hertz_approach() / self.speed
    }

    /// Kinetic energy before, J.
    pub fn calc_energy(&self) -> f64 {
        0.5 * self.mass * self.speed * self.speed
    }

    /// Coefficient of restitution, from the integral.
    pub fn calc_restitution(&self) -> f64 {
        calc_restitution(self.dissipation * self.speed)
    }

    /// (t, δ, δ̇) through the contact in `steps` equal steps of the classical Runge–Kutta method, until the ball has left,
    /// while `gravity` (m/s²) presses on; an own integration, nothing of the simulator's.
    pub fn integrate(&self, steps: usize, gravity: f64) -> Vec<(f64, f64, f64)> {
        let h = self.calc_hertz_duration() / steps as f64;
        let rate = |(depth, u): (f64, f64)| {
            let spring = self.calc_force(depth);
            (u, gravity - spring * (1.0 + self.dissipation * u).max(0.0) / self.mass)
        };
        let at = |y: (f64, f64), k: (f64, f64), h: f64| (y.0 + h * k.0, y.1 + h * k.1);
        let mut y = (0.0, self.speed);
        let mut path = vec![(0.0, y.0, y.1)];
        for step in 1..=4 * steps {
            let k1 = rate(y);
            let k2 = rate(at(y, k1, 0.5 * h));
            let k3 = rate(at(y, k2, 0.5 * h));
            let k4 = rate(at(y, k3, h));
            y.0 += h / 6.0 * (k1.0 + 2.0 * k2.0 + 2.0 * k3.0 + k4.0);
            y.1 += h / 6.0 * (k1.1 + 2.0 * k2.1 + 2.0 * k3.1 + k4.1);
            path.push((step as f64 * h, y.0, y.1));
            if y.0 <= 0.0 {
                break;
            }
        }
        path
    }
}

/// Time and rate δ̇ at the end of a path of [`Impact::integrate`]: the force is next to nothing there, so it ends straight.
pub fn calc_leaving(path: &[(f64, f64, f64)]) -> (f64, f64) {
    let [.., a, b] = path else { return (f64::NAN, f64::NAN) };
    let share = a.1 / (a.1 - b.1);
    (a.0 + share * (b.0 - a.0), a.2 + share * (b.2 - a.2))
}

/// Restitution of Hunt and Crossley's law at x = d v, for every exponent: x − ln(1 + x) = −y − ln(1 − y), e = y/x.
pub fn calc_restitution(x: f64) -> f64 {
    if x == 0.0 {
        return 1.0;
    }
    let target = minus_ln1p(x);
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..100 {
        let e = 0.5 * (low + high);
        if minus_ln1p(-e * x) < target { low = e } else { high = e }
    }
    0.5 * (low + high)
}

/// x − ln(1 + x), without cancellation near zero; infinite where the logarithm has no argument.
fn minus_ln1p(x: f64) -> f64 {
    if x <= -1.0 {
        return f64::INFINITY;
    }
    if x.abs() > 0.1 {
        return x - x.ln_1p();
    }
    // x²/2 − x³/3 + …: 20 terms leave 1e-22 of the sum at |x| = 0.1.
    let (mut sum, mut power) = (0.0, -x);
    for k in 2..22 {
        power *= -x;
        sum += power / f64::from(k);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    const IMPACT: Impact = Impact { mass: 1.0, stiffness: 1e8, dissipation: 0.0, speed: 0.5 };

    #[test]
    fn closed_form_meets_the_integrated_impact() {
        let path = IMPACT.integrate(20_000, 0.0);
        let deepest = path.iter().map(|p| p.1).fold(0.0, f64::max);
        let (duration, speed) = calc_leaving(&path);
        // The deepest of 20,000 samples misses the depth by (π²/8)/20,000² = 3e-9; the rest is round-off and h^3.5.
        assert!((deepest / IMPACT.calc_hertz_approach() - 1.0).abs() < 4e-9);
        assert!((duration / IMPACT.calc_hertz_duration() - 1.0).abs() < 1e-10);
        assert!((speed + IMPACT.speed).abs() < 1e-10);
    }

    #[test]
    fn restitution_meets_the_integrated_impact_to_ten_digits() {
        for dissipation in [1e-3, 0.1, 0.6, 3.0] {
            let impact = Impact { dissipation, ..IMPACT };
            let (_, speed) = calc_leaving(&impact.integrate(20_000, 0.0));
            let integrated = -speed / impact.speed;
            let closed = impact.calc_restitution();
            println!("d v = {}: e = {closed:.12}, integrated {integrated:.12}", dissipation * impact.speed);
            assert!((integrated - closed).abs() < 1e-10);
        }
    }

    #[test]
    fn restitution_begins_as_one_minus_two_thirds_d_v() {
        for x in [1e-6, 1e-4, 1e-2] {
            // The next term of the series is (4/9) x².
            assert!((calc_restitution(x) - (1.0 - 2.0 / 3.0 * x)).abs() < 0.5 * x * x);
        }
    }
}
