//! Slosh: a point mass on an isotropic spring and damper inside a body.
//!
//! The mass m is a free particle: its place x and velocity ẋ in W are the memory. With the body's frame at x_B and ω,
//! and r the rest place in the body,
//!
//!   u = x − (x_B + R r),     w = ẋ − (ẋ_B + ω × (x − x_B)) = R d(Rᵀu)/dt
//!   m ẍ = −m (Ω² u + 2 ζ Ω w) + m g(x),   and m (Ω² u + 2 ζ Ω w) on the body *at x*
//!
//! w is the rate of the deflection as the turning body sees it, so that the damper rests when fluid and body turn as one.
//! It is not along u; equal and opposite forces at the same point conserve angular momentum all the same. g is the
//! field's acceleration (gravity, tide, tilt) at the particle.
//!
//! The body's nominal mass and inertia hold the particle locked at rest; the build takes it out
//! (`multibody::Inertial::without_point`). Ω = 2π f, the frequency with the body held; on a free body it is higher:
//! along one axis Ω √(M / (M − m)), M the total mass. At m = 0 nothing reacts and nothing was taken out.
//! Valid for Ω h well below one; deflections are not limited by walls.

use super::motion::BodyMotion;
use super::vector_at;
use spatial::{Frame, Vec3, Wrench};

/// A sloshing mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slosh {
    /// kg.
    pub mass: f64,
    /// Ω, rad/s, with the body held.
    pub rate: f64,
    /// ζ.
    pub damping: f64,
    /// r: rest place from the link's origin, axes of the link, m.
    pub rest: Vec3,
}

impl Slosh {
    /// Force on the body at the particle, about the link's origin; the rate of the memory (x, ẋ), the field's acceleration
    /// included; what the damper takes, W.
    pub fn eval(&self, motion: &BodyMotion, memory: &[f64], field: &Vec3, rate: &mut [f64]) -> (Wrench, f64) {
        let (x, v) = (vector_at(memory, 0), vector_at(memory, 3));
        let arm = x - motion.frame_wl.pos;
        let slip = v - motion.twist.at(&arm);
        let damping = 2.0 * self.damping * self.rate;
        let pull = self.rate * self.rate * (arm - motion.frame_wl.rot * self.rest) + damping * slip;
        rate[..3].copy_from_slice(v.as_slice());
        rate[3..6].copy_from_slice((field - pull).as_slice());
        (Wrench::from_force_at(self.mass * pull, &arm), self.mass * damping * slip.norm_squared())
    }

    /// Of the particle, about the link's origin, W axes.
    pub fn calc_momentum(&self, frame_wl: &Frame, memory: &[f64]) -> Wrench {
        let arm = vector_at(memory, 0) - frame_wl.pos;
        Wrench::from_force_at(self.mass * vector_at(memory, 3), &arm)
    }

    /// Of motion and of the spring, J.
    pub fn calc_energy(&self, frame_wl: &Frame, memory: &[f64]) -> f64 {
        let u = vector_at(memory, 0) - frame_wl.point(&self.rest);
        let kinetic = 0.5 * self.mass * vector_at(memory, 3).norm_squared();
        kinetic + 0.5 * self.mass * self.rate * self.rate * u.norm_squared()
    }

    /// The memory as seen from the body: Rᵀu and its rate.
    pub fn calc_relative(&self, motion: &BodyMotion, memory: &[f64], relative: &mut [f64]) {
        let (frame, x) = (&motion.frame_wl, vector_at(memory, 0));
        let u = frame.inverse_point(&x) - self.rest;
        let w = frame.rot.tr_mul(&(vector_at(memory, 3) - motion.twist.at(&(x - frame.pos))));
        relative[..3].copy_from_slice(u.as_slice());
        relative[3..6].copy_from_slice(w.as_slice());
    }

    /// The memory that is seen so from the body; zeros give a particle at rest that moves with it.
    pub fn calc_memory(&self, motion: &BodyMotion, relative: &[f64], memory: &mut [f64]) {
        let frame = &motion.frame_wl;
        let arm = frame.rot * (self.rest + vector_at(relative, 0));
        let v = motion.twist.at(&arm) + frame.rot * vector_at(relative, 3);
        memory[..3].copy_from_slice((frame.pos + arm).as_slice());
        memory[3..6].copy_from_slice(v.as_slice());
    }
}
