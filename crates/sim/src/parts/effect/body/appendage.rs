//! Flexible appendage: one lightly damped mode, coupled to the body's rotation.
//!
//!   η̈ + 2 ζ Ω η̇ + Ω² η = −δ·ω̇,     H = I ω + δ η̇         ω, δ in the link's axes; η in √kg·m
//!
//! ω̇ on the right is the solution's own acceleration: an algebraic loop, as it stands. The mode's momentum opens it:
//!
//!   p = η̇ + δ·ω:    η̇ = p − δ·ω,    ṗ = −Ω² η − 2 ζ Ω η̇,    H = (I − δ δᵀ) ω + δ p
//!
//! η and p are the memory. The body has the inertia I − δδᵀ (`multibody::Inertial::without_mode`), which must be
//! positive definite, and feels δ (Ω² η + 2 ζ Ω η̇) − ω × δ p. Kinetic energy ½ ω·(I − δδᵀ) ω + ½ p², stored ½ Ω² η².
//! Several modes are several effects. At δ = 0 the mode is nobody's. With the body free, a mode whose δ lies along a
//! principal axis of inertia J rings at Ω / √(1 − δ²/J).
//! Valid for small deflections; the mode neither shifts the centre of mass nor couples to translation.

use super::motion::BodyMotion;
use spatial::{Frame, Vec3, Wrench};

/// One mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Appendage {
    /// Ω, rad/s.
    pub rate: f64,
    /// ζ.
    pub damping: f64,
    /// δ, axes of the link, √kg·m.
    pub coupling: Vec3,
}

impl Appendage {
    /// Torque on the body, W axes; the rate of the memory (η, p); what the damper takes, W.
    pub fn eval(&self, motion: &BodyMotion, memory: &[f64], rate: &mut [f64]) -> (Wrench, f64) {
        let rot = &motion.frame_wl.rot;
        let (eta, p) = (memory[0], memory[1]);
        let eta_rate = p - self.along(motion);
        let damping = 2.0 * self.damping * self.rate;
        let pull = self.rate * self.rate * eta + damping * eta_rate;
        (rate[0], rate[1]) = (eta_rate, -pull);
        let coupling_w = rot * self.coupling;
        let torque = coupling_w * pull - motion.twist.ang.cross(&coupling_w) * p;
        let is_coupled = self.coupling != Vec3::zeros();
        (Wrench::new(torque, Vec3::zeros()), if is_coupled { damping * eta_rate * eta_rate } else { 0.0 })
    }

    /// δ·ω.
    fn along(&self, motion: &BodyMotion) -> f64 {
        self.coupling.dot(&motion.frame_wl.rot.tr_mul(&motion.twist.ang))
    }

    /// δ p, W axes: what the mode adds to the angular momentum of the body with its reduced inertia.
    pub fn calc_momentum(&self, frame_wl: &Frame, memory: &[f64]) -> Wrench {
        Wrench::new(frame_wl.rot * self.coupling * memory[1], Vec3::zeros())
    }

    /// Of motion and of the spring, J. A mode without coupling has none: it is nobody's.
    pub fn calc_energy(&self, memory: &[f64]) -> f64 {
        if self.coupling == Vec3::zeros() {
            return 0.0;
        }
        0.5 * memory[1] * memory[1] + 0.5 * (self.rate * memory[0]).powi(2)
    }

    /// The memory as seen from the body: η and η̇.
    pub fn calc_relative(&self, motion: &BodyMotion, memory: &[f64], relative: &mut [f64]) {
        (relative[0], relative[1]) = (memory[0], memory[1] - self.along(motion));
    }

    /// The memory that is seen so from the body.
    pub fn calc_memory(&self, motion: &BodyMotion, relative: &[f64], memory: &mut [f64]) {
        (memory[0], memory[1]) = (relative[0], relative[1] + self.along(motion));
    }
}
