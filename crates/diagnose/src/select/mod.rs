//! Selection: which effects, at which places, and how many.
//!
//! Every hypothesis is a few columns beside the same linear chain ([`pool`]). Sets of them grow in linear algebra alone, numbers, forces and noise as large as
//! is likeliest for each ([`sets`]); the best few are fitted in full simulation and judged by one criterion ([`search`]):
//!
//!   −2 log L(θ̂, q̂, κ̂) + d ln N − 2 log prior        (BIC: Schwarz 1978)

pub mod lines;
pub mod pool;
pub mod regression;
pub mod scale;
pub mod search;
pub mod sets;
