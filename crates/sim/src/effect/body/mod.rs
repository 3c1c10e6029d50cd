//! Effects on one rigid body: loads without memory, and parts that move inside it.
//!
//! | file | effects | memory |
//! | --- | --- | --- |
//! | [`load`] | constant-force, constant-torque, linear-drag, quadratic-drag, angular-damping, gravity-gradient, tether-stiffness, periodic-disturbance | – |
//! | [`slosh`] | slosh | place and velocity of the particle, W |
//! | [`appendage`] | flexible-appendage | η and p = η̇ + δ·ω |
//! | [`sphere`] | internal-dissipation | angular velocity of the sphere, W axes |
//!
//! A part's memory is absolute, so that its rate never needs the body's acceleration: no algebraic loop, and at neutral
//! parameters no bit of the body's motion changes. What one wants to say or to estimate is relative: deflections and
//! rates as seen from the body, all zero where body and part move as one. [`BodyLaw::slots`] names those coordinates.

mod appendage;
mod load;
mod motion;
mod slosh;
mod sphere;

pub use appendage::Appendage;
pub use load::Load;
pub use motion::{Axes, BodyMotion, BodyPlace};
pub use slosh::Slosh;
pub use sphere::Sphere;

use spatial::{Frame, Vec3, Wrench};

/// What an effect does to its body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BodyLaw {
    /// A load from outside, without memory.
    Load(Load),
    /// A mass on a spring inside.
    Slosh(Slosh),
    /// A flexible mode.
    Appendage(Appendage),
    /// An inner sphere in its fluid.
    Sphere(Sphere),
}

/// What comes of a law at one instant; about the link's origin, W axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyAction {
    /// On the body, from outside the system.
    pub external: Wrench,
    /// On the body, from the part inside it: no impulse of the system.
    pub internal: Wrench,
    /// On the part, from outside the system: its weight.
    pub on_part: Wrench,
    /// What the part's damper takes, W.
    pub loss: f64,
}

/// Name and usual size of one relative coordinate of a part: u.x, m, for example.
pub type SlotName = (&'static str, f64);

/// Deflections of centimetres and the rates that belong to them at 0.1 Hz.
const SLOSH_SLOTS: [SlotName; 6] =
    [("u.x", 1e-2), ("u.y", 1e-2), ("u.z", 1e-2), ("u_rate.x", 1e-2), ("u_rate.y", 1e-2), ("u_rate.z", 1e-2)];
/// Of η in √kg·m and its rate.
const APPENDAGE_SLOTS: [SlotName; 2] = [("eta", 1e-2), ("eta_rate", 1e-2)];
/// rad/s.
const SPHERE_SLOTS: [SlotName; 3] = [("omega.x", 1e-3), ("omega.y", 1e-3), ("omega.z", 1e-3)];

impl BodyLaw {
    /// Length of the memory.
    pub fn memory_len(&self) -> usize {
        self.slots().len()
    }

    /// The relative coordinates of the part, in order; as many as the memory has.
    pub fn slots(&self) -> &'static [SlotName] {
        match self {
            Self::Load(_) => &[],
            Self::Slosh(_) => &SLOSH_SLOTS,
            Self::Appendage(_) => &APPENDAGE_SLOTS,
            Self::Sphere(_) => &SPHERE_SLOTS,
        }
    }

    /// Mass (kg), place and velocity in W of a part that has weight.
    pub fn particle(&self, memory: &[f64]) -> Option<(f64, Vec3, Vec3)> {
        match self {
            Self::Slosh(slosh) => Some((slosh.mass, vector_at(memory, 0), vector_at(memory, 3))),
            _ => None,
        }
    }

    /// Wrenches and the memory's rate; `field` is the acceleration of free fall at the part, W axes, m/s².
    pub fn eval(
        &self,
        place: &BodyPlace,
        motion: &BodyMotion,
        memory: &[f64],
        field: &Vec3,
        rate: &mut [f64],
    ) -> BodyAction {
        let inside = |(internal, loss)| BodyAction { internal, loss, ..BodyAction::default() };
        match self {
            Self::Load(load) => BodyAction { external: load.calc_wrench(place, motion), ..BodyAction::default() },
            Self::Slosh(slosh) => {
                let arm = vector_at(memory, 0) - motion.frame_wl.pos;
                let on_part = Wrench::from_force_at(slosh.mass * field, &arm);
                BodyAction { on_part, ..inside(slosh.eval(motion, memory, field, rate)) }
            }
            Self::Appendage(mode) => inside(mode.eval(motion, memory, rate)),
            Self::Sphere(sphere) => inside(sphere.eval(motion, memory, rate)),
        }
    }

    /// Momentum of the part, which the body's reduced inertia does not hold; about the link's origin, W axes.
    pub fn calc_momentum(&self, frame_wl: &Frame, memory: &[f64]) -> Wrench {
        match self {
            Self::Load(_) => Wrench::default(),
            Self::Slosh(slosh) => slosh.calc_momentum(frame_wl, memory),
            Self::Appendage(mode) => mode.calc_momentum(frame_wl, memory),
            Self::Sphere(sphere) => sphere.calc_momentum(memory),
        }
    }

    /// Energy of the part, J: of its motion, and stored in its spring.
    pub fn calc_energy(&self, frame_wl: &Frame, memory: &[f64]) -> [f64; 2] {
        match self {
            Self::Load(_) => [0.0; 2],
            Self::Slosh(slosh) => slosh.calc_energy(frame_wl, memory),
            Self::Appendage(mode) => mode.calc_energy(memory),
            Self::Sphere(sphere) => sphere.calc_energy(memory),
        }
    }

    /// The memory in the coordinates of [`BodyLaw::slots`].
    pub fn calc_relative(&self, motion: &BodyMotion, memory: &[f64], relative: &mut [f64]) {
        match self {
            Self::Load(_) => {}
            Self::Slosh(slosh) => slosh.calc_relative(motion, memory, relative),
            Self::Appendage(mode) => mode.calc_relative(motion, memory, relative),
            Self::Sphere(sphere) => sphere.calc_relative(motion, memory, relative),
        }
    }

    /// The memory that has the given coordinates of [`BodyLaw::slots`]; zeros: at rest with the body.
    pub fn calc_memory(&self, motion: &BodyMotion, relative: &[f64], memory: &mut [f64]) {
        match self {
            Self::Load(_) => {}
            Self::Slosh(slosh) => slosh.calc_memory(motion, relative, memory),
            Self::Appendage(mode) => mode.calc_memory(motion, relative, memory),
            Self::Sphere(sphere) => sphere.calc_memory(motion, relative, memory),
        }
    }
}

/// Three numbers of a memory as a vector.
fn vector_at(memory: &[f64], at: usize) -> Vec3 {
    Vec3::new(memory[at], memory[at + 1], memory[at + 2])
}

#[cfg(test)]
mod tests;
