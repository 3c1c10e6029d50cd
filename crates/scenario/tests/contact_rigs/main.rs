//! The contact rigs (dock-impact, air-table) against recordings of an independent simulator.
//!
//! With the effects and the initial states of a practice set's key, softdock's nominal scenario must predict what was recorded
//! to within the sensors' noise. Recordings are looked for in `$SOFTDOCK_RECORDINGS` or in `../shared/recordings`
//! beside the checkout; where there are none, the tests say so and pass.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

mod key;
mod neutral;
#[path = "../keys/practice.rs"]
mod practice;
mod replay;
mod sets;
