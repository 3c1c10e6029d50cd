//! A damped oscillator under a load that grows evenly, in closed form.
//!
//!   m ÿ + c ẏ + κ y = f₀ + f₁ t,     y(0) = 0,  ẏ(0) = v₀
//!   y = a + b t + e^{−αt} (z₀ C(t) + (ż₀ + α z₀) S(t)),   b = f₁/κ,  a = (f₀ − c b)/κ,  z₀ = −a,  ż₀ = v₀ − b
//!
//! with α = c/2m, ω² = κ/m − α², and C = cos ωt, S = sin ωt/ω; cosh and sinh where the damping is supercritical.

/// The motion from one event to the next.
#[derive(Clone, Copy, Debug)]
pub struct Oscillator {
    /// m, kg.
    pub mass: f64,
    /// c, N·s/m.
    pub damping: f64,
    /// κ, N/m; positive.
    pub stiffness: f64,
    /// f₀, N.
    pub load: f64,
    /// f₁, N/s.
    pub load_rate: f64,
    /// v₀, m/s.
    pub speed: f64,
}

impl Oscillator {
    /// y and ẏ at `t`, m and m/s.
    pub fn at(&self, t: f64) -> (f64, f64) {
        let b = self.load_rate / self.stiffness;
        let a = (self.load - self.damping * b) / self.stiffness;
        let alpha = 0.5 * self.damping / self.mass;
        let omega2 = self.stiffness / self.mass - alpha * alpha;
        let (z, z_dot) = (-a, self.speed - b);
        let p = z_dot + alpha * z;
        let (c, s) = waves(omega2, alpha, t);
        let y = z * c + p * s;
        // d/dt of the decaying C is −α C − ω² S, that of S is C − α S.
        let rate = z * (-alpha * c - omega2 * s) + p * (c - alpha * s);
        (a + b * t + y, b + rate)
    }

    /// A time in which nothing changes much: a small part of the fastest period, s.
    pub fn resolution(&self) -> f64 {
        0.05 / (self.stiffness / self.mass).sqrt().max(self.damping / self.mass)
    }
}

/// e^{−αt} C(t) and e^{−αt} S(t).
fn waves(omega2: f64, alpha: f64, t: f64) -> (f64, f64) {
    let w = omega2.abs().sqrt();
    if omega2 > 0.0 {
        let decay = (-alpha * t).exp();
        return (decay * (w * t).cos(), decay * (w * t).sin() / w);
    }
    let (slow, fast) = (((w - alpha) * t).exp(), ((-w - alpha) * t).exp());
    if w == 0.0 { (slow, slow * t) } else { (0.5 * (slow + fast), 0.5 * (slow - fast) / w) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The closed form meets the equation it solves, by central differences, under any damping.
    #[test]
    fn it_solves_its_equation() {
        for damping in [0.0, 3.0, 40.0, 90.0] {
            let o = Oscillator { mass: 2.0, damping, stiffness: 200.0, load: 3.0, load_rate: -1.5, speed: 0.7 };
            assert_eq!((o.at(0.0).0.abs() < 1e-15, (o.at(0.0).1 - 0.7).abs() < 1e-15), (true, true));
            for k in 1..20 {
                let (t, e) = (0.1 * f64::from(k), 1e-5);
                let (y, v) = o.at(t);
                let by_y = (o.at(t + e).0 - o.at(t - e).0) / (2.0 * e);
                let acceleration = (o.at(t + e).1 - o.at(t - e).1) / (2.0 * e);
                let rest = o.mass * acceleration + damping * v + o.stiffness * y - o.load - o.load_rate * t;
                // Differences: e² of third derivatives up to 1e3, and round-off of 1e-16/1e-5.
                assert!((by_y - v).abs() < 1e-7 && rest.abs() < 1e-6, "{damping} {t}: {rest}");
            }
        }
    }
}
