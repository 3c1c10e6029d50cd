//! The friction laws in the world: levels with a grain, resistance to spin and rolling, a plane that turns.

use crate::support::{ALL, Setup, block, bristle, linear, link, robot, run, shape, spec, twist, world};
use contact::Shape;
use friction::{Bristle, Pivot};
use sim::{Base, Grain, Integrator, PairLaw, World};
use spatial::{Pose, Rot, Vec3};

const GRAVITY: f64 = 9.81;
const RADIUS: f64 = 0.05;
const MASS: f64 = 0.5;

/// A ball on the floor, at the depth where its normal spring carries it.
fn ball_on_floor(law: PairLaw, stiffness: f64, setup: &Setup) -> World {
    let moment = 0.4 * MASS * RADIUS * RADIUS;
    let ball = robot(vec![link("ball", MASS, Vec3::zeros(), Vec3::repeat(moment))], Vec::new());
    let mut spec = spec(vec![(ball, Base::Free)], &setup.gravity(Vec3::new(0.0, 0.0, -GRAVITY)));
    spec.shapes = vec![shape("floor", None, Shape::HalfSpace), shape("ball", Some(0), Shape::Ball { radius: RADIUS })];
    spec.pairs = vec![([0, 1], law)];
    let mut world = world(spec);
    world.state_mut().bases[0] = Pose::translation(0.0, 0.0, RADIUS - MASS * GRAVITY / stiffness);
    world
}

fn pivot(spin_lever: f64, rolling_lever: f64) -> Pivot {
    Pivot { spin_lever, rolling_lever, stiffness: 0.5, damping: 1e-2 }
}

/// θ̈ = −r m g / I.
#[test]
fn spinning_ball_is_braked_by_its_spin_lever() {
    for integrator in ALL {
        let law =
            PairLaw { pivot: Some(pivot(2e-3, 0.0)), ..PairLaw::new(linear(2e4, 60.0), Some(bristle(0.4, 5e3, 10.0))) };
        let mut world = ball_on_floor(law, 2e4, &Setup::new(integrator).step(1e-4));
        world.set_base_twists(&[twist([0.0, 0.0, 20.0], [0.0; 3])]);
        let spin = |w: &World| w.kinematics(0).vel[0].ang.z;
        run(&mut world, 2_000); // the angular bristle is on its bound
        let (start, from) = (spin(&world), world.state().time);
        run(&mut world, 2_000);
        let measured = (start - spin(&world)) / (world.state().time - from);
        let expected = 2e-3 * MASS * GRAVITY / (0.4 * MASS * RADIUS * RADIUS);
        println!("{integrator:?}: {measured} of {expected} rad/s²");
        // The implicit check of laws leaves 1e-3 of the moment's last correction; the mean is far better.
        assert!((measured - expected).abs() < 1e-6 * expected);
    }
}

/// It stops, and then it holds: no creep under a moment below r fₙ.
#[test]
fn spinning_ball_comes_to_rest_and_stays() {
    for integrator in ALL {
        let law =
            PairLaw { pivot: Some(pivot(2e-3, 0.0)), ..PairLaw::new(linear(2e4, 60.0), Some(bristle(0.4, 5e3, 10.0))) };
        let mut world = ball_on_floor(law, 2e4, &Setup::new(integrator).step(1e-4));
        world.set_base_twists(&[twist([0.0, 0.0, 2.0], [0.0; 3])]);
        run(&mut world, 30_000);
        let spin = world.kinematics(0).vel[0].ang.norm();
        println!("{integrator:?}: {spin:.1e} rad/s");
        assert!(spin < 1e-6);
    }
}

/// a = 5 g b / (7 R): the moment b m g turns the ball against its rolling, and friction at the foot brakes it.
#[test]
fn rolling_ball_is_braked_by_its_rolling_lever() {
    for integrator in ALL {
        let law =
            PairLaw { pivot: Some(pivot(0.0, 1e-3)), ..PairLaw::new(linear(2e4, 60.0), Some(bristle(0.4, 5e3, 10.0))) };
        let mut world = ball_on_floor(law, 2e4, &Setup::new(integrator).step(1e-4));
        world.set_base_twists(&[twist([0.0, 1.0 / RADIUS, 0.0], [1.0, 0.0, 0.0])]);
        run(&mut world, 5_000);
        let speed = |w: &World| w.kinematics(0).vel[0].lin.x;
        let (start, from) = (speed(&world), world.state().time);
        run(&mut world, 5_000);
        let measured = (start - speed(&world)) / (world.state().time - from);
        // Friction acts half-way between the two surfaces, which overlap by m g / k.
        let radius = RADIUS - 0.5 * MASS * GRAVITY / 2e4;
        let expected = 1e-3 * GRAVITY * radius / (radius * radius + 0.4 * RADIUS * RADIUS);
        println!("{integrator:?}: {measured} of {expected} m/s²");
        // The foot's bristle still swings a little after its first stretch.
        assert!((measured - expected).abs() < 1e-4 * expected);
    }
}

/// Sliding at 45° to the grain, a law of maximum dissipation pushes along (μ₁² vₓ, μ₂² v_y), and both levels are met on it.
#[test]
fn sliding_across_the_grain_is_pushed_against_the_slip_by_the_level_of_its_direction() {
    let (along, ratio) = (0.4, 0.5);
    for integrator in ALL {
        let law = Bristle {
            mu_static: along,
            mu_kinetic: along,
            across: ratio,
            stiffness: 5e4,
            damping: 20.0,
            ..Bristle::default()
        };
        let grain = Grain { on_b: false, axis: Vec3::new(2.0, 0.0, 0.3), angle: 0.0 };
        let law = PairLaw { grain: Some(grain), ..PairLaw::new(linear(2e4, 60.0), Some(law.into())) };
        let gravity = Vec3::new(0.0, 0.0, -GRAVITY);
        let half = Vec3::new(0.1, 0.1, 0.001);
        let step = if integrator == Integrator::RungeKutta4 { 2e-5 } else { 1e-4 };
        let mut spec = spec(
            vec![(block(1.0, half), Base::Only([false, false, false, true, true, true]))],
            &Setup::new(integrator).gravity(gravity).step(step),
        );
        spec.shapes =
            vec![shape("floor", None, Shape::HalfSpace), shape("block", Some(0), Shape::Cuboid { half_extents: half })];
        spec.pairs = vec![([0, 1], law)];
        let mut world = world(spec);
        world.state_mut().bases[0] = Pose::translation(0.0, 0.0, half.z - GRAVITY / 8e4);
        world.set_base_twists(&[twist([0.0; 3], [1.0, 1.0, 0.0])]);
        run(&mut world, (0.02 / step) as usize);
        let v = world.kinematics(0).vel[0].lin;
        let moment_before = world.state().time;
        run(&mut world, 10);
        let after = world.kinematics(0).vel[0].lin;
        let pushed = (after - v) / (world.state().time - moment_before);
        let mean = 0.5 * (v + after);
        let way = Vec3::new(mean.x, mean.y, 0.0).normalize();
        let level = 1.0 / (way.x / along).hypot(way.y / (ratio * along));
        let expected = -level * GRAVITY * way;
        println!("{integrator:?}: {pushed:?} of {expected:?} m/s²");
        // The bristle lies behind a direction that turns with 3 rad/s by s_max/|v| of it: 1e-4; the check of laws 1e-3.
        assert!((pushed - expected).norm() < 2e-3 * expected.norm());
    }
}

/// A block that sticks to a plate is carried round by it: the deflection turns with both, and nothing slips or creeps.
#[test]
fn a_stuck_block_turns_with_its_plate() {
    let half = Vec3::new(0.05, 0.05, 0.02);
    let law = PairLaw::new(linear(2e4, 40.0), Some(bristle(0.5, 5e3, 20.0)));
    for integrator in ALL {
        let mut spec = spec(
            vec![(block(1e6, Vec3::new(1.0, 1.0, 0.05)), Base::Free), (block(1.0, half), Base::Free)],
            &Setup::new(integrator),
        );
        spec.shapes = vec![
            shape("plate", Some(0), Shape::HalfSpace),
            shape("block", Some(1), Shape::Cuboid { half_extents: half }),
        ];
        spec.pairs = vec![([0, 1], law)];
        // A drum that turns about x: the block lies on its inside, 0.5 m out, and is pressed by its own inertia.
        let (rate, out) = (2.0, 0.5);
        let inward = Rot::from_scaled_axis(Vec3::new(std::f64::consts::PI, 0.0, 0.0));
        spec.shapes[0].pose_ls = Pose::from_parts(Vec3::new(0.0, 0.0, out).into(), inward);
        let mut world = world(spec);
        let height = out - half.z + rate * rate * (out - half.z) / 8e4;
        world.state_mut().bases[1] = Pose::translation(0.0, 0.0, height);
        world
            .set_base_twists(&[twist([rate, 0.0, 0.0], [0.0; 3]), twist([rate, 0.0, 0.0], [0.0, -rate * height, 0.0])]);
        let relative = |w: &World| w.state().bases[0].inverse() * w.state().bases[1];
        run(&mut world, 2_000);
        let start = relative(&world);
        run(&mut world, 6_000); // 12 rad
        let moved = (start.inverse() * relative(&world)).translation.vector;
        println!("{integrator:?}: moved {:.1e} m", moved.norm());
        assert!(world.touches().all(|t| t.sticks) && world.touches().count() == 4);
        // What the start had not settled dies away with 20 N·s/m on 1 kg.
        assert!(moved.norm() < 1e-9);
    }
}
