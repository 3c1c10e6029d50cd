//! Restitution over h ω, step times contact frequency: a generated table.
//!
//! A 1 kg ball flies at 0.5 m/s against a wall, without gravity. The contact frequency is ω = π / (duration of the
//! contact); the numbers are the mean over eight phases of touch-down within a step, and the largest of them.

use crate::support::scenes::{flying_ball, flying_block};
use crate::support::{ALL, Setup, hunt_crossley, linear, run, table};
use contact::Normal;
use sim::Integrator;
use std::fmt::Write;

const STEP: f64 = 1e-3;
const SPEED: f64 = 0.5;
const H_OMEGA: [f64; 10] = [0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 2.0, 5.0, 20.0];
const DISSIPATION: f64 = 0.3;

/// Mean and largest restitution over the phases of touch-down.
fn restitution(normal: Normal, integrator: Integrator, h_omega: f64) -> (f64, f64) {
    let all = (0..8).map(|phase| {
        let gap = SPEED * STEP * (1.0 + (f64::from(phase) + 0.5) / 8.0);
        let mut world = flying_ball(normal, gap, -SPEED, &Setup::new(integrator).step(STEP));
        run(&mut world, 30 + (8.0 / h_omega) as usize);
        world.state().momentum[0].force.z / SPEED
    });
    let all: Vec<f64> = all.collect();
    (all.iter().sum::<f64>() / 8.0, all.iter().copied().fold(f64::MIN, f64::max))
}

/// A linear spring of that frequency, for 1 kg.
fn spring(h_omega: f64) -> Normal {
    linear((h_omega / STEP).powi(2), 0.0)
}

/// A Hertzian contact of that frequency: duration 2.9432 δ/v at the depth δ = (5 m v²/4k)^(2/5) (Johnson 1985, 11.1).
fn hertz(h_omega: f64) -> Normal {
    let depth = std::f64::consts::PI * STEP / h_omega * SPEED / 2.9432;
    hunt_crossley(1.25 * SPEED * SPEED / depth.powf(2.5), 1.5, DISSIPATION)
}

/// Of Hunt and Crossley's law, any exponent: x − ln(1 + x) = −y − ln(1 − y) with x = d v, y = e d v.
fn exact_hunt_crossley() -> f64 {
    let x = DISSIPATION * SPEED;
    let target = x - x.ln_1p();
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let e = 0.5 * (low + high);
        let y = e * x;
        if -y - (-y).ln_1p() < target { low = e } else { high = e }
    }
    low
}

fn cell((mean, largest): (f64, f64)) -> String {
    let show = |e: f64| if e.abs() > 10.0 { "unstable".to_owned() } else { format!("{e:.3}") };
    format!("{} ({})", show(mean), show(largest))
}

fn add_rows(text: &mut String, law: fn(f64) -> Normal, exact: f64) {
    text.push_str("| h ω | exact | implicit Euler | implicit midpoint | semi-implicit Euler | RK4 |\n");
    text.push_str("| --- | --- | --- | --- | --- | --- |\n");
    for h_omega in H_OMEGA {
        let cells = ALL.map(|i| cell(restitution(law(h_omega), i, h_omega))).join(" | ");
        writeln!(text, "| {h_omega} | {exact:.3} | {cells} |").unwrap();
    }
}

#[test]
fn table_of_restitution() {
    let mut text = "# Restitution over h ω\n\nA ball of 1 kg at 0.5 m/s against a wall, h = 1 ms; ω = π / duration of \
                    the contact. Mean over eight phases of\ntouch-down within a step (largest in brackets). Written by \
                    `SOFTDOCK_BLESS=1 cargo test -p softdock-sim -- table`.\n\n## Linear spring without damping\n\n"
        .to_owned();
    add_rows(&mut text, spring, 1.0);
    writeln!(text, "\n## Hunt–Crossley, n = 1.5, d = {DISSIPATION} s/m\n").unwrap();
    add_rows(&mut text, hertz, exact_hunt_crossley());
    println!("{text}");
    table::check("restitution.md", &text);
}

#[test]
fn implicit_integrators_never_gain_energy_in_an_impact() {
    for law in [spring as fn(f64) -> Normal, hertz] {
        for h_omega in [0.03, 0.15, 0.25, 0.31, 0.32, 0.4, 0.7, 1.5, 3.0, 10.0, 100.0] {
            for integrator in [Integrator::ImplicitEuler, Integrator::ImplicitMidpoint] {
                let (_, largest) = restitution(law(h_omega), integrator, h_omega);
                // Midpoint: phase errors of touch-down, second order in h ω.
                let bound = 1.0 + if integrator == Integrator::ImplicitMidpoint { 0.02 } else { 0.0 };
                assert!(largest <= bound, "{integrator:?} at h ω = {h_omega}: e = {largest}");
            }
        }
    }
}

#[test]
fn midpoint_gains_no_energy_where_several_points_share_an_impact() {
    // Four corners at once: each contact may be resolved by itself, (h ω)² = 0.09, and the block on all four not.
    for h_omega in [0.15, 0.2, 0.25, 0.3] {
        let mut largest = 0.0_f64;
        for phase in 0..8 {
            let gap = SPEED * STEP * (1.0 + (f64::from(phase) + 0.5) / 8.0);
            let mut world = flying_block(spring(h_omega), gap, -SPEED, &Setup::new(Integrator::ImplicitMidpoint));
            run(&mut world, 100);
            largest = largest.max(world.kinematics(0).vel[0].lin.z / SPEED);
        }
        println!("h ω of one point {h_omega}: e up to {largest:.3}");
        assert!(largest <= 1.02);
    }
}
