//! Steps that end where a touch begins, against the closed form of a damped linear contact.
//!
//! A ball of 1 kg, no gravity: x'' = −ω² x − 2 ζ ω x' from x = 0, and it parts where the force has gone to zero,
//! at φ = π − atan2(2 ζ √(1 − ζ²), 1 − 2 ζ²) of the damped swing.

use crate::support::scenes::flying_ball;
use crate::support::{Setup, linear};
use sim::{Integrator, StepError, World};

const OMEGA: f64 = 100.0;
const ZETA: f64 = 0.15;
const SPEED: f64 = 0.5;
/// Until well after it has left, s.
const UNTIL: f64 = 0.08;
const PHASES: u32 = 16;

fn exact_restitution() -> f64 {
    let root = (1.0 - ZETA * ZETA).sqrt();
    let phi = std::f64::consts::PI - (2.0 * ZETA * root).atan2(1.0 - 2.0 * ZETA * ZETA);
    (-ZETA * phi / root).exp() * (ZETA / root * phi.sin() - phi.cos())
}

/// Largest error of the restitution over the phases of touch-down within a step.
fn largest_error(step: f64, advance: fn(&mut World, f64) -> Result<(), StepError>) -> f64 {
    let error = |phase: u32| {
        let gap = SPEED * step * (2.0 + (f64::from(phase) + 0.5) / f64::from(PHASES));
        let law = linear(OMEGA * OMEGA, 2.0 * ZETA * OMEGA);
        let mut world = flying_ball(law, gap, -SPEED, &Setup::new(Integrator::RungeKutta4).step(step));
        while world.state().time < UNTIL {
            advance(&mut world, step).expect("nothing diverges");
        }
        (world.state().momentum[0].force.z / SPEED - exact_restitution()).abs()
    };
    (0..PHASES).map(error).fold(0.0, f64::max)
}

#[test]
fn the_error_falls_by_the_square_of_the_step() {
    let steps = [2e-3, 1e-3, 5e-4, 2.5e-4];
    let across = steps.map(|h| largest_error(h, World::advance_by));
    let meeting = steps.map(|h| largest_error(h, World::advance_meeting));
    println!("across {across:?}\nmeeting {meeting:?}");
    assert!(meeting[0] < 0.1 * across[0], "the coarsest: {:.2e} against {:.2e}", meeting[0], across[0]);
    assert!(across[0] < 16.0 * across[3], "across is of first order: {across:?}");
    assert!(meeting[0] > 30.0 * meeting[3], "meeting is of second order: {meeting:?}");
    assert!(meeting[3] < 1e-4, "{:.2e}", meeting[3]);
}
