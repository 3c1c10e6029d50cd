//! Internal dissipation: a sphere inside the body, coupled to it by a viscous torque.
//!
//!   i ω̇_s = c (ω − ω_s),   the opposite on the body         ω_s absolute, W axes: the memory
//!
//! A sphere's inertia is the same about every axis, so its attitude is of no account. Angular momentum stays, energy
//! falls by c ‖ω − ω_s‖² until body and sphere turn as one about the axis of the largest inertia. The body's nominal
//! inertia holds the sphere locked; the build takes i·1 out (`multibody::Inertial::without_sphere`).
//! Neutral is i = 0: a sphere without inertia follows at once. (c = 0 is not: the sphere would not turn with the body.)
//! Valid for a step well below i/c. This is the fluid ring or viscous nutation damper in its simplest, isotropic form.

use super::motion::BodyMotion;
use super::vector_at;
use spatial::{Vec3, Wrench};

/// An inner sphere in its fluid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// i, kg·m².
    pub inertia: f64,
    /// c, N·m·s.
    pub c: f64,
}

impl Sphere {
    /// Torque on the body, W axes; the rate of the memory ω_s; what the fluid takes, W.
    pub fn eval(&self, motion: &BodyMotion, memory: &[f64], rate: &mut [f64]) -> (Wrench, f64) {
        if self.inertia == 0.0 {
            rate[..3].fill(0.0);
            return (Wrench::default(), 0.0);
        }
        let slip = motion.twist.ang - vector_at(memory, 0);
        let on_sphere = self.c * slip;
        rate[..3].copy_from_slice((on_sphere / self.inertia).as_slice());
        (Wrench::new(-on_sphere, Vec3::zeros()), slip.dot(&on_sphere))
    }

    /// Of the sphere, W axes.
    pub fn calc_momentum(&self, memory: &[f64]) -> Wrench {
        Wrench::new(self.inertia * vector_at(memory, 0), Vec3::zeros())
    }

    /// Of motion, J; nothing is stored.
    pub fn calc_energy(&self, memory: &[f64]) -> f64 {
        0.5 * self.inertia * vector_at(memory, 0).norm_squared()
    }

    /// The memory as seen from the body: ω_s − ω, axes of the link.
    pub fn calc_relative(&self, motion: &BodyMotion, memory: &[f64], relative: &mut [f64]) {
        let own = vector_at(memory, 0) - motion.twist.ang;
        relative[..3].copy_from_slice(motion.frame_wl.rot.tr_mul(&own).as_slice());
    }

    /// The memory that is seen so from the body.
    pub fn calc_memory(&self, motion: &BodyMotion, relative: &[f64], memory: &mut [f64]) {
        let own = motion.frame_wl.rot * vector_at(relative, 0);
        memory[..3].copy_from_slice((motion.twist.ang + own).as_slice());
    }
}
