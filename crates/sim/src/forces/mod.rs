//! What the parts do in a step: forces, where they are evaluated and with which slopes, and what they remember.

mod acting;
pub(crate) mod contacts;
pub(crate) mod drives;
pub(crate) mod effects;
pub(crate) mod inner;
mod joints;
mod lines;
mod mechanism_report;
pub(crate) mod mechanisms;
pub(crate) mod memory;
mod outside;
pub(crate) mod own;
pub(crate) mod pivots;
mod settle;
pub(crate) mod speed_limits;

pub use mechanism_report::MechanismReport;

pub(crate) use acting::Acting;
pub(crate) use joints::{Passage, calc_thrust};
pub(crate) use lines::{accept, next_switch};
pub(crate) use mechanism_report::calc_report;
pub(crate) use outside::{calc_bias, calc_external};
pub(crate) use settle::settle;
