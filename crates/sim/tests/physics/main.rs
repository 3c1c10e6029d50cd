//! The simulation against closed forms, conservation laws and itself.
//!
//! `cargo test -p softdock-sim` runs all of it in a few minutes on two cores; a word after `--` picks a topic, as in
//! `cargo test -p softdock-sim -- creep`. Tables that the convergence tests print stand in `tests/tables/`;
//! `SOFTDOCK_BLESS=1 cargo test -p softdock-sim -- table` writes them anew.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod beds;
mod body_loads;
mod body_parts;
mod brush;
mod convergence;
mod determinism;
mod docking;
mod drives;
mod effect_books;
mod effect_gears;
mod effect_joints;
mod effect_lines;
mod energy_books;
mod extremes;
mod followers;
mod forces;
mod free_motion;
mod friction;
mod guided;
mod joint_wrench;
mod joints;
mod loops;
mod mechanism_energy;
mod mechanism_holds;
mod mechanism_latches;
mod mechanism_struts;
mod meeting;
mod momentum;
mod orbit;
mod pushes;
mod resting;
mod restitution;
mod speed_limits;
mod stiff;
mod support;
mod symmetry;
mod torque_free;
mod wedge;
