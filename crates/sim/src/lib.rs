//! The world: bodies, contact, actuators, environment; its state, and how it advances.
//!
//! # The step
//!
//! World axes everywhere; each vehicle's spatial vectors are about its anchor, the base origin at this instant.
//!
//! State: base poses, joint coordinates and rates, bristles, and per vehicle the momentum (p, L) about W's origin. The
//! base twist follows from it: V_B = I_lock⁻¹ (h − Σ I_i V_i^rel).
//!
//!   f = law(g + h u_n, s + h u_t, u),   G = −h ∂f/∂u          per contact, at the predicted end
//!   A dv = h (τ − c + Jᵀ f),   A = M + Jᵀ G J + diag(h k_d + h² k_p)
//!   f_lin = f − G J dv / h, checked against the law at u + J dv; a new line where it missed
//!   p_a −= h f_lin,  p_b += h f_lin,  L likewise with x × h f_lin: the same numbers on both sides
//!   poses with the solved velocities, centres of mass with p/m; bristles from the displacement of the material points
//!
//! Momentum is conserved to rounding because only equal and opposite impulses enter it; stiffness is harmless because
//! the poses move with the *solved* velocities (backward Euler map of the linear test equation). The base twist taken
//! from the momentum differs from the solved one by O(h²), and that difference meets no stiffness.
//!
//! Where u' is meant at the end of the step, u' = u + J dv + h (ω_b − ω_a) × ẋ_c: dv is spatial, the gain of the velocity
//! field at a place fixed in W, and the contact moves on. With it, and with centres of mass that move by h p/m exactly, a
//! scene seen from a drifting frame is the same to rounding.
//!
//! Integrators: [`Integrator`]. Sources: Anitescu and Potra 1997 for the linearly implicit contact step; Featherstone
//! 2008 for the tree algorithms; Liang, Fillmore and Ma 2012 for the bristle.

mod books;
mod error;
mod forces;
mod model;
mod parts;
mod schemes;
mod solve;
mod state;
mod workspace;
mod world;

pub use error::{ModelError, StepError};
pub use forces::MechanismReport;
pub use model::{Integrator, MemorySlot, Model, ModelSpec, ShapeSpec, memory_layout};
pub use parts::{
    Actuator, ActuatorKind, Anchor, Appendage, Axes, Base, BodyAction, BodyEffect, BodyLaw, BodyMotion, BodyPlace,
    Bushing, Capture, Command, Coordinate, Drive, DriveAxis, DrivePath, DryFriction, DryLevel, Effect, EffectKind,
    Environment, Force, Grain, JointEffect, JointLaw, Latch, LineEffect, LineLaw, Load, Mechanism, MechanismKind,
    MechanismMemory, MechanismStatus, Motion, Overload, PairLaw, PullIn, Push, REACH, Series, Side, Slosh, Sphere,
    Strength, Strut, StrutSides, Vehicle, VehicleSpec, Weld,
};
pub use state::{Account, ContactMemory, Pending, State, Work};
pub use workspace::Rest;
pub use world::{
    Controller, Energy, EnergyAudit, EnergyBalance, Flow, Known, Measured, MomentumAudit, NoControl, Observer,
    Perception, TouchReport, Works, World,
};
