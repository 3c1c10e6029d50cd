//! Docking shapes against brute force, against themselves seen otherwise, and in smooth motion.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod brute_force;
mod parry;
mod seats;
mod smooth;
mod support;
mod symmetry;
