//! A ball in a hollow of planes: friction that lifts it off the faces that cause it.

use crate::support::{Setup, bristle, linear, link, robot, run, shape, spec, twist, world};
use contact::Shape;
use sim::{Base, Integrator, PairLaw, ShapeSpec};
use spatial::{Pose, Rot, Vec3};

/// A ball of 1 kg thrown with a spin into a hollow of planes that lean by `slope` from the level, evenly about the vertical;
/// how deep it gets into one of them, m.
fn deepest_in_a_hollow(planes: usize, slope: f64, mu: f64, integrator: Integrator) -> f64 {
    const RADIUS: f64 = 0.05;
    let setup = Setup::new(integrator).gravity(Vec3::new(0.0, 0.0, -9.81));
    let ball = robot(vec![link("ball", 1.0, Vec3::zeros(), Vec3::repeat(1e-3))], Vec::new());
    let mut spec = spec(vec![(ball, Base::Free)], &setup);
    spec.shapes = vec![shape("ball", Some(0), Shape::Ball { radius: RADIUS })];
    let law = PairLaw::new(linear(1e6, 1e3), Some(bristle(mu, 1e6, 0.0)));
    for k in 0..planes {
        let heading = std::f64::consts::TAU * k as f64 / planes as f64;
        let turn = Rot::from_scaled_axis(Vec3::z() * heading) * Rot::from_scaled_axis(Vec3::y() * slope);
        let pose_ls = Pose::from_parts(Vec3::zeros().into(), turn);
        spec.shapes.push(ShapeSpec { pose_ls, ..shape(&format!("plane{k}"), None, Shape::HalfSpace) });
        spec.pairs.push(([k + 1, 0], law));
    }
    let mut world = world(spec);
    world.state_mut().bases[0] = Pose::translation(0.0, 0.0, RADIUS / slope.cos() + 5e-3);
    world.set_base_twists(&[twist([1.0, 2.0, 3.0], [0.02, 0.03, -0.1])]);
    let mut deepest = 0.0_f64;
    for _ in 0..500 {
        run(&mut world, 1);
        deepest = world.touches().fold(deepest, |deepest, t| deepest.max(-t.gap));
    }
    deepest
}

#[test]
fn a_ball_does_not_fall_through_a_wedge_with_friction() {
    // Friction lifts it off the faces that press: passes that jump between pressing and not touching left it no force.
    for integrator in [Integrator::ImplicitEuler, Integrator::ImplicitMidpoint] {
        for (planes, slope) in [(2, 40.0_f64), (3, 40.0), (3, 60.0), (3, 80.0), (5, 60.0)] {
            for mu in [0.2, 0.5, 1.0] {
                let deepest = deepest_in_a_hollow(planes, slope.to_radians(), mu, integrator);
                println!("{integrator:?}, {planes} planes at {slope}°, μ = {mu}: {deepest:.1e} m deep");
                // 0.33 m/s on 1e6 N/m: v √(m/k) = 0.33 mm, and as much again where a step ends in the contact.
                assert!(deepest < 6e-4);
            }
        }
    }
}
