//! Blocks on planes: creep, sliding, pulling.

use crate::support::scenes::block_on_slope;
use crate::support::{Setup, bristle, linear, run};
use sim::{Environment, Integrator, PairLaw, World};

const MU: f64 = 0.4;

fn setup(integrator: Integrator, step: f64) -> Setup {
    Setup { integrator, step, environment: Environment::DeepSpace }
}

fn law() -> PairLaw {
    PairLaw { normal: linear(1e6, 1e3), friction: Some(bristle(MU, 1e6, 100.0)) }
}

fn x(world: &World) -> f64 {
    world.state().bases[0].translation.vector.x
}

#[test]
fn block_below_the_friction_angle_does_not_creep() {
    // Four corners share the load unevenly on a slope; at 10° each stays below its own limit.
    let mut world = block_on_slope(10_f64.to_radians(), law(), &setup(Integrator::ImplicitEuler, 1e-3));
    run(&mut world, 5_000);
    let start = x(&world);
    run(&mut world, 60_000);
    let creep = (x(&world) - start) / 60.0;
    println!("creep at 10 deg over 60 s: {creep:.2e} m/s");
    assert!(creep.abs() <= 1e-12);
}

#[test]
fn block_above_the_friction_angle_slides_as_coulomb_says() {
    let angle = 30_f64.to_radians();
    let mut world = block_on_slope(angle, law(), &setup(Integrator::ImplicitEuler, 1e-3));
    run(&mut world, 1_000);
    let (v0, t0) = (world.kinematics(0).vel[0].lin.x, world.state().time);
    run(&mut world, 1_000);
    let slope = (world.kinematics(0).vel[0].lin.x - v0) / (world.state().time - t0);
    let exact = 9.81 * (angle.sin() - MU * angle.cos());
    println!("sliding acceleration {slope:.9}, exact {exact:.9}, relative {:.1e}", slope / exact - 1.0);
    assert!((slope / exact - 1.0).abs() <= 1e-6);
}
