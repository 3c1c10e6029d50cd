//! Coulomb's stick–slip in closed form: a block on a belt that moves at V, held by a spring, levels μₛ and μₖ.
//!
//!   it rides until K x = μₛ N; then x − x_k = Δ cos ω t + (V/ω) sin ω t about x_k = μₖ N/K, Δ = (μₛ − μₖ) N/K
//!
//! until its speed is the belt's again, at x − x_k = −Δ: with tan φ = V/(ω Δ) and A² = Δ² + (V/ω)²
//!
//!   spring force between μₖ N ± K A,   period 2 Δ/V + (π + 2 φ)/ω

/// The block, the belt and the spring.
#[derive(Clone, Copy, Debug)]
pub struct Slider {
    /// kg.
    pub mass: f64,
    /// Spring, N/m.
    pub spring: f64,
    /// Speed of the belt, m/s.
    pub belt: f64,
    /// Static and kinetic level times the normal force, N.
    pub levels: [f64; 2],
}

impl Slider {
    /// Lowest and highest spring force of the cycle, N.
    pub fn calc_extremes(&self) -> [f64; 2] {
        let omega = (self.spring / self.mass).sqrt();
        let swing = (self.levels[0] - self.levels[1]).hypot(self.spring * self.belt / omega);
        [self.levels[1] - swing, self.levels[1] + swing]
    }

    /// Period of the cycle, s.
    pub fn calc_period(&self) -> f64 {
        let omega = (self.spring / self.mass).sqrt();
        let drop = (self.levels[0] - self.levels[1]) / self.spring;
        2.0 * drop / self.belt + (std::f64::consts::PI + 2.0 * (self.belt / (omega * drop)).atan()) / omega
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fast_belts_leave_the_free_oscillation_and_slow_ones_the_ride() {
        let fast = Slider { mass: 1.0, spring: 1e4, belt: 1e3, levels: [4.0, 3.0] };
        assert!((fast.calc_period() / (std::f64::consts::TAU / 100.0) - 1.0).abs() < 1e-4);
        let slow = Slider { belt: 1e-6, ..fast };
        assert!((slow.calc_period() / 200.0 - 1.0).abs() < 1e-3);
        assert!((slow.calc_extremes()[1] - 4.0).abs() < 1e-6);
    }
}
