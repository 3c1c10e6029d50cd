//! Relative orbital motion, in axes that do not turn: Clohessy and Wiltshire, and gravity-gradient libration.

use crate::support::{ALL, Setup, block, free_world, run, spec, twist, world};
use sim::{Base, Environment, Integrator, World};
use spatial::{Pose, Vec3};

/// rad/s: ten minutes of orbit pass in a second, so that the test is short; the motion is the same.
const RATE: f64 = 0.5;

fn orbit(gravity_gradient: bool) -> Environment {
    Environment::Orbit { mean_motion: RATE, gravity_gradient }
}

/// Hill's frame to W at `t`: x radial, y along the flight, z normal to the orbit.
fn to_inertial(v: &Vec3, t: f64) -> Vec3 {
    let (s, c) = (RATE * t).sin_cos();
    Vec3::new(c * v.x - s * v.y, s * v.x + c * v.y, v.z)
}

/// Clohessy and Wiltshire's solution in Hill's frame.
fn clohessy_wiltshire(x: &Vec3, v: &Vec3, t: f64) -> Vec3 {
    let n = RATE;
    let (s, c) = (n * t).sin_cos();
    Vec3::new(
        (4.0 - 3.0 * c) * x.x + s / n * v.x + 2.0 / n * (1.0 - c) * v.y,
        6.0 * (s - n * t) * x.x + x.y - 2.0 / n * (1.0 - c) * v.x + (4.0 * s - 3.0 * n * t) / n * v.y,
        c * x.z + s / n * v.z,
    )
}

#[test]
fn coasting_body_follows_clohessy_and_wiltshire() {
    let (x, v) = (Vec3::new(3.0, -8.0, 2.0), Vec3::new(0.4, -0.9, 0.7));
    for (integrator, tolerance) in ALL.into_iter().zip([0.2, 5e-4, 0.2, 1e-9]) {
        let setup = Setup { environment: orbit(false), ..Setup::new(integrator) };
        let mut world = free_world(block(10.0, Vec3::repeat(0.2)), &setup);
        world.state_mut().bases[0] = Pose::translation(x.x, x.y, x.z);
        let inertial = v + Vec3::new(-RATE * x.y, RATE * x.x, 0.0);
        world.set_base_twists(&[twist([0.0; 3], inertial.into())]);
        run(&mut world, 20_000);
        let t = world.state().time;
        let exact = to_inertial(&clohessy_wiltshire(&x, &v, t), t);
        let off = (world.state().bases[0].translation.vector - exact).norm();
        println!("{integrator:?}: {off:.1e} m off after {:.1} revolutions", t * RATE / std::f64::consts::TAU);
        assert!(off < tolerance);
    }
}

/// Angle of the body's long axis from the radial direction, in the orbit's plane, rad.
fn pitch(world: &World) -> f64 {
    let axis = world.state().bases[0].rotation * Vec3::x();
    let t = RATE * world.state().time;
    let off = axis.y.atan2(axis.x) - t;
    off.sin().atan2(off.cos())
}

#[test]
fn gravity_gradient_swings_a_long_body_with_the_libration_frequency() {
    // Pitch: ω = n √(3 (I_y − I_x)/I_z), x radial (Hughes 1986, 9.2), for small angles.
    for integrator in ALL {
        let setup = Setup { environment: orbit(true), ..Setup::new(integrator) };
        let mut world = world(spec(vec![(block(10.0, Vec3::new(1.0, 0.2, 0.3)), Base::Free)], &setup));
        let moments = 10.0 / 3.0 * Vec3::new(0.04 + 0.09, 1.0 + 0.09, 1.0 + 0.04);
        world.state_mut().bases[0].rotation = spatial::Rot::from_scaled_axis(0.01 * Vec3::z());
        world.set_base_twists(&[twist([0.0, 0.0, RATE], [0.0; 3])]);
        let libration = RATE * (3.0 * (moments.y - moments.x) / moments.z).sqrt();
        let mut crossings = Vec::new();
        let mut before = pitch(&world);
        for _ in 0..40_000 {
            run(&mut world, 1);
            let now = pitch(&world);
            if before > 0.0 && now <= 0.0 {
                crossings.push(world.state().time - 1e-3 * now / (now - before));
            }
            before = now;
        }
        let periods = (crossings.len() - 1) as f64;
        let measured = std::f64::consts::TAU * periods / (crossings.last().unwrap() - crossings[0]);
        println!("{integrator:?}: libration {measured:.6} rad/s, theory {libration:.6}");
        // Amplitude 0.01 rad: the frequency falls by θ²/4 of the double angle, 1e-4; Euler's first order adds its h.
        let bound =
            if matches!(integrator, Integrator::ImplicitMidpoint | Integrator::RungeKutta4) { 2e-4 } else { 2e-3 };
        assert!((measured / libration - 1.0).abs() < bound);
    }
}

#[test]
fn weightless_world_is_the_orbit_of_zero_rate() {
    for integrator in ALL {
        let end = |environment| {
            let mut world =
                free_world(block(10.0, Vec3::new(0.1, 0.2, 0.3)), &Setup { environment, ..Setup::new(integrator) });
            world.state_mut().bases[0] = Pose::translation(3.0, 2.0, 1.0);
            world.set_base_twists(&[twist([0.3, 0.5, -0.2], [0.1, 0.0, 0.2])]);
            run(&mut world, 500);
            world.state().bases[0]
        };
        let still = Environment::Orbit { mean_motion: 0.0, gravity_gradient: true };
        assert_eq!(end(Environment::DeepSpace), end(still), "{integrator:?}");
    }
}
