//! Identification along whole runs: knows residuals, states, forces and numbers, but no effect by its name.
//!
//! A run is cut at knots into short intervals, each simulated from a state of its own (multiple shooting: Bock and Plitt 1984). What joins them is
//! continuity, and an unknown force on every coordinate that may have any size its variance allows: with none of it the chain is one free run, with
//! much of it each interval stands for itself. [`chain`] eliminates states and forces along the run exactly, [`track`] makes a run linear.

mod answer;
pub mod chain;
pub mod coarse;
mod damped;
pub mod fit;
mod follow;
pub mod forces;
mod halve;
mod heard;
mod hold;
pub mod marginal;
mod power;
mod shown;
mod step;
pub mod track;
