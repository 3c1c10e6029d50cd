//! How a step is made of all that.

pub(crate) mod rk4;
mod rk4_bristle;
pub(crate) mod step;
