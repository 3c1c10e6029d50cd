//! Selection: which effects, at which places, and how many.
//!
//! Every hypothesis is a few columns beside the same linear chain ([`pool`]). Sets of them grow in linear algebra alone, numbers, forces and noise as large as
//! is likeliest for each ([`sets`]); the best few are fitted in full simulation and judged by one criterion ([`search`]):
//!
//!   −2 log L(θ̂, q̂, κ̂) + d ln N − 2 log prior        (BIC: Schwarz 1978)

mod detail;
mod dull;
mod enough;
mod exchange;
mod kin;
mod left;
pub(crate) mod lines;
mod orders;
pub mod pool;
pub mod regression;
mod rounds;
pub mod scale;
pub mod search;
pub mod sets;

/// Quantile of a gamma distribution over its mean, by the normal score: the cube root is nearly normal (Wilson and Hilferty 1931).
fn gamma_quantile_over_mean(shape: f64, score: f64) -> f64 {
    (1.0 - 1.0 / (9.0 * shape) + score / (9.0 * shape).sqrt()).powi(3)
}
