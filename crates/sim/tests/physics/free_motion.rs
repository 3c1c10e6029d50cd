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
