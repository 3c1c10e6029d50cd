//! A free-floating arm without any force: momentum to round-off, energy and positions to the integrator's order.

use crate::support::{ALL, Setup, arm7, free_world, run};
use sim::{Energy, Environment, Integrator, MomentumAudit, World};
use spatial::{Twist, Vec3};

fn arm(integrator: Integrator, step: f64) -> World {
    let mut world = free_world(arm7(), &Setup { integrator, step, environment: Environment::DeepSpace });
    world.state_mut().q.copy_from_slice(&[0.3, 0.7, 0.2, -1.3, 0.1, 0.8, 0.0]);
    world.state_mut().v.copy_from_slice(&[0.4, -0.5, 0.6, 0.8, -1.0, 0.9, 0.7]);
    world.set_base_twists(&[Twist::new(Vec3::new(0.1, -0.05, 0.08), Vec3::new(0.02, 0.01, -0.03))]);
    world
}

#[test]
fn momentum_stays_to_round_off_for_every_integrator() {
    for integrator in ALL {
        let mut world = arm(integrator, 1e-3);
        let mut audit = MomentumAudit::new(&world);
        for _ in 0..40 {
            run(&mut world, 100);
            audit.update(&world);
        }
        println!("{integrator:?}: linear {:.1e}, angular {:.1e}", audit.linear_drift, audit.angular_drift);
        // Rounding of 4,000 steps.
        assert!(audit.linear_drift < 1e-12 && audit.angular_drift < 1e-12);
    }
}

#[test]
fn energy_drifts_with_the_integrators_order() {
    for (integrator, bound) in ALL.into_iter().zip([5e-3, 1e-5, 5e-3, 1e-11]) {
        let mut world = arm(integrator, 1e-3);
        let start = Energy::of(&world).kinetic;
        run(&mut world, 4_000);
        let drift = (Energy::of(&world).kinetic / start - 1.0).abs();
        println!("{integrator:?}: ΔE/E {drift:.1e}");
        assert!(drift < bound);
    }
}

/// Where the end of the arm is and how it turns, as a long step shows it and as it is.
fn error_within(step: f64) -> f64 {
    let instants: Vec<f64> = [0.2, 0.45, 0.5, 0.8].iter().map(|share| share * step).collect();
    let mut world = arm(Integrator::RungeKutta4, step);
    let mut shown = Vec::new();
    let has_flown = world.advance_past(step, (&[], &instants), |_, world| {
        shown.push((world.state().time, world.link_frame(0, 7).pos, world.link_twist(0, 7)));
    });
    assert!(has_flown.unwrap() && shown.len() == instants.len());
    let error = |(instant, seen): (&f64, &(f64, Vec3, Twist))| {
        let mut fine = arm(Integrator::RungeKutta4, instant / 64.0);
        run(&mut fine, 64);
        assert!((seen.0 - instant).abs() < 1e-12, "time {} at {instant}", seen.0);
        (fine.link_frame(0, 7).pos - seen.1).norm() + (fine.link_twist(0, 7).ang - seen.2.ang).norm()
    };
    instants.iter().zip(&shown).map(error).fold(0.0, f64::max)
}

#[test]
fn a_long_step_shows_the_world_within_it_to_third_order() {
    // One step: its local error goes with the fourth power of its length.
    let errors = [0.08, 0.04, 0.02, 0.01].map(error_within);
    println!("within steps of 80, 40, 20, 10 ms: {errors:?}");
    let order = (errors[0] / errors[3]).log2() / 3.0;
    assert!((3.7..5.0).contains(&order) && errors[3] < 1e-5, "order {order}: {errors:?}");
}

#[test]
fn looking_at_the_world_within_a_step_changes_nothing() {
    let (mut seen, mut plain) = (arm(Integrator::RungeKutta4, 0.02), arm(Integrator::RungeKutta4, 0.02));
    for _ in 0..20 {
        let now = seen.state().time;
        assert!(seen.advance_past(0.02, (&[], &[now + 0.005, now + 0.013]), |_, _| ()).unwrap());
        assert!(plain.advance_free(0.02).unwrap());
    }
    assert_eq!(seen.state(), plain.state());
    // Only Runge–Kutta knows what is within its steps.
    let mut other = arm(Integrator::ImplicitMidpoint, 0.02);
    let before = other.state().clone();
    assert!(!other.advance_past(0.02, (&[], &[0.01]), |_, _| ()).unwrap());
    assert_eq!(*other.state(), before);
}
