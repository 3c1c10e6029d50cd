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
//! rates as seen from the body, all zero where body and part move as one. [`BodyLaw::memory_names`] lists those coordinates.

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

use spatial::{Frame, Inertia, Mat3, Vec3, Wrench};

/// An effect on one body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyEffect {
    /// The link, and what must be known of its body.
    pub(crate) place: BodyPlace,
    /// What it does.
    pub law: BodyLaw,
}

impl BodyEffect {
    /// At a link of a vehicle. The vehicle's tree is without what the effect's part takes with it
    /// ([`multibody::Inertial::without_point`] and its like); centre of mass and tensor of the whole are worked out when
    /// the model is built.
    pub fn new(vehicle: usize, link: usize, law: BodyLaw) -> Self {
        Self { place: BodyPlace { vehicle, link, com: Vec3::zeros(), tensor_com: Mat3::zeros() }, law }
    }

    /// Where it acts.
    pub fn place(&self) -> &BodyPlace {
        &self.place
    }
}

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

impl BodyLaw {
    /// Whether something moves inside the body, with momentum and memory of its own.
    pub fn has_part(&self) -> bool {
        !matches!(self, Self::Load(_))
    }

    /// The relative coordinates of the part, in order: deflection (m) and its rate, η (√kg·m) and its rate, angular
    /// velocity (rad/s). The memory has as many numbers.
    pub fn memory_names(&self) -> &'static [&'static str] {
        match self {
            Self::Load(_) => &[],
            Self::Slosh(_) => &["u.x", "u.y", "u.z", "u_rate.x", "u_rate.y", "u_rate.z"],
            Self::Appendage(_) => &["eta", "eta_rate"],
            Self::Sphere(_) => &["omega.x", "omega.y", "omega.z"],
        }
    }

    /// Usual sizes of those coordinates: centimetres, and milliradians per second.
    pub fn memory_scales(&self) -> &'static [f64] {
        match self {
            Self::Load(_) => &[],
            Self::Slosh(_) => &[1e-2; 6],
            Self::Appendage(_) => &[1e-2; 2],
            Self::Sphere(_) => &[1e-3; 3],
        }
    }

    /// Mass (kg), place and velocity in W of a part that has weight.
    pub fn particle(&self, memory: &[f64]) -> Option<(f64, Vec3, Vec3)> {
        match self {
            Self::Slosh(slosh) => Some((slosh.mass, vector_at(memory, 0), vector_at(memory, 3))),
            _ => None,
        }
    }

    /// What keeps it from being simulated in steps of `step` s: a part must not turn by more than a radian in one.
    pub(crate) fn find_fault(&self, step: f64) -> Option<String> {
        let (what, rate) = match self {
            Self::Load(_) => return None,
            Self::Slosh(s) => ("frequency", s.rate * (2.0 * s.damping).max(1.0)),
            Self::Appendage(m) => ("frequency", m.rate * (2.0 * m.damping).max(1.0)),
            Self::Sphere(s) if s.inertia == 0.0 => return None,
            Self::Sphere(s) => ("c/i_damper", s.c / s.inertia),
        };
        let too_fast = rate.is_nan() || rate * step > 1.0;
        too_fast
            .then(|| format!("moves at {rate:.3e} rad/s ({what}), too fast for a step of {step} s; shorten the step"))
    }

    /// What the part adds to its link when it is locked at rest, about the link's origin, link axes.
    pub(crate) fn calc_locked(&self) -> Inertia {
        match self {
            Self::Load(_) => Inertia::default(),
            Self::Slosh(slosh) => Inertia::from_com(slosh.mass, &slosh.rest, &Mat3::zeros()),
            Self::Appendage(m) => Inertia { rot: m.coupling * m.coupling.transpose(), ..Inertia::default() },
            Self::Sphere(s) => Inertia { rot: Mat3::from_diagonal_element(s.inertia), ..Inertia::default() },
        }
    }

    /// First of the memory's velocities and momenta; what stands before are places.
    pub(crate) fn first_kick(&self) -> usize {
        match self {
            Self::Load(_) | Self::Sphere(_) => 0,
            Self::Slosh(_) => 3,
            Self::Appendage(_) => 1,
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

    /// Energy of the part, J: of its motion, and in its spring.
    pub fn calc_energy(&self, frame_wl: &Frame, memory: &[f64]) -> f64 {
        match self {
            Self::Load(_) => 0.0,
            Self::Slosh(slosh) => slosh.calc_energy(frame_wl, memory),
            Self::Appendage(mode) => mode.calc_energy(memory),
            Self::Sphere(sphere) => sphere.calc_energy(memory),
        }
    }

    /// The memory in the coordinates of [`BodyLaw::memory_names`].
    pub fn calc_relative(&self, motion: &BodyMotion, memory: &[f64], relative: &mut [f64]) {
        match self {
            Self::Load(_) => {}
            Self::Slosh(slosh) => slosh.calc_relative(motion, memory, relative),
            Self::Appendage(mode) => mode.calc_relative(motion, memory, relative),
            Self::Sphere(sphere) => sphere.calc_relative(motion, memory, relative),
        }
    }

    /// The memory that has the given relative coordinates; zeros: at rest with the body.
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
