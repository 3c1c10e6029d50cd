//! Blocks on planes: creep for an hour, sliding, pulling by a spring.

use crate::support::scenes::block_on_slope;
use crate::support::{ALL, Setup, bristle, joint, linear, link, robot, run, shape, spec, world};
use contact::Shape;
use multibody::JointKind;
use sim::{Actuator, ActuatorKind, Base, Integrator, ModelSpec, PairLaw, ShapeSpec, World};
use spatial::{Pose, Vec3};

const MU: f64 = 0.4;
const GRAVITY: f64 = 9.81;
/// Largest creep below the friction angle, m/s.
const CREEP: f64 = 1e-12;

/// Stiff enough that 1 ms is far beyond an explicit method's limit: h² k/m = 1 per point.
fn stiff() -> PairLaw {
    PairLaw::new(linear(1e6, 1e3), Some(bristle(MU, 1e6, 100.0)))
}

/// Soft enough for the explicit integrators at 1 ms.
fn soft() -> PairLaw {
    PairLaw::new(linear(2e4, 100.0), Some(bristle(MU, 2e4, 40.0)))
}

fn position(world: &World) -> Vec3 {
    world.state().bases[0].translation.vector
}

/// Mean speed of the block over `steps`, once 5 s have let it settle, m/s.
fn creep(angle_deg: f64, law: PairLaw, setup: &Setup, steps: usize) -> f64 {
    let mut world = block_on_slope(angle_deg.to_radians(), law, setup);
    run(&mut world, 5_000);
    let (start, from) = (position(&world), world.state().time);
    run(&mut world, steps);
    (position(&world) - start).norm() / (world.state().time - from)
}

#[test]
fn block_below_the_friction_angle_does_not_creep_in_an_hour() {
    // The corners share the load unevenly on a slope; below 21.8° (tan = μ) the block as a whole is held, at 10° every
    // single corner stays below its own limit as well.
    std::thread::scope(|scope| {
        for angle in [10.0, 18.0] {
            scope.spawn(move || {
                let creep = creep(angle, stiff(), &Setup::new(Integrator::ImplicitEuler), 3_600_000);
                println!("creep at {angle}° over 3,600 s: {creep:.1e} m/s");
                assert!(creep <= CREEP);
            });
        }
    });
}

#[test]
fn block_does_not_creep_with_the_other_integrators() {
    for integrator in ALL {
        let creep = creep(10.0, soft(), &Setup::new(integrator), 60_000);
        println!("{integrator:?}: creep at 10° over 60 s: {creep:.1e} m/s");
        assert!(creep <= CREEP);
    }
}

/// Acceleration along the slope over one second of sliding, over that of Coulomb's law.
fn relative_acceleration(angle: f64, law: PairLaw, setup: &Setup) -> f64 {
    let mut world = block_on_slope(angle, law, setup);
    run(&mut world, (1.0 / setup.step) as usize);
    let (v0, t0) = (world.kinematics(0).vel[0].lin.x, world.state().time);
    run(&mut world, (1.0 / setup.step) as usize);
    let slope = (world.kinematics(0).vel[0].lin.x - v0) / (world.state().time - t0);
    slope / (GRAVITY * (angle.sin() - MU * angle.cos()))
}

/// Each integrator with a bristle that it can slide: for Runge–Kutta h < 2 s_max/|u|.
fn sliding_case(integrator: Integrator) -> (PairLaw, Setup) {
    let setup = Setup::new(integrator);
    match integrator {
        Integrator::ImplicitEuler => (stiff(), setup),
        Integrator::RungeKutta4 => (PairLaw { friction: Some(bristle(MU, 4e3, 10.0)), ..soft() }, setup.step(5e-5)),
        _ => (soft(), setup),
    }
}

#[test]
fn block_above_the_friction_angle_slides_as_coulomb_says() {
    for angle_deg in [24.0_f64, 30.0, 45.0] {
        for integrator in ALL {
            let (law, setup) = sliding_case(integrator);
            let error = relative_acceleration(angle_deg.to_radians(), law, &setup) - 1.0;
            println!("{integrator:?}: acceleration at {angle_deg}° off by {error:.1e}");
            assert!(error.abs() <= 1e-6);
        }
    }
}

#[test]
fn sliding_block_stops_after_v_squared_over_two_mu_g() {
    for integrator in ALL {
        let (law, setup) = sliding_case(integrator);
        let mut world = block_on_slope(0.0, law, &setup);
        run(&mut world, (2.0 / setup.step) as usize);
        let (speed, start) = (0.5, position(&world).x);
        world.state_mut().momentum[0].force.x += speed;
        let height = position(&world).z;
        world.state_mut().momentum[0].moment.y += height * speed;
        run(&mut world, (1.0 / setup.step) as usize);
        let distance = position(&world).x - start;
        let exact = speed * speed / (2.0 * MU * GRAVITY);
        println!("{integrator:?}: slid {distance:.6} m, Coulomb {exact:.6} m");
        // The bristle's reach μ m g/(4 k), 245 µm where softest, and one step of motion, ½ mm.
        assert!((distance - exact).abs() < 6e-4);
    }
}

/// What pulls the block.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Puller {
    /// A drive whose stiffness the integrator sees.
    Drive,
    /// The spring's force at the start of every step.
    Effort,
}

/// A fixed rail, a massless carriage on x and a 1 kg block that slides on the carriage in z, resting on the floor.
fn pulled_block_spec(integrator: Integrator, puller: Puller) -> ModelSpec {
    let mut carriage = link("carriage", 0.0, Vec3::zeros(), Vec3::zeros());
    carriage.inertial = None;
    let rail = multibody::LinkDescription { name: "rail".to_owned(), ..carriage.clone() };
    let sled = link("block", 1.0, Vec3::zeros(), Vec3::repeat(1e-2));
    let joints = vec![
        joint("along", 0, Vec3::zeros(), Vec3::x(), JointKind::Prismatic),
        joint("lift", 1, Vec3::zeros(), Vec3::z(), JointKind::Prismatic),
    ];
    let setup = Setup::new(integrator).gravity(-GRAVITY * Vec3::z());
    let mut spec = spec(vec![(robot(vec![rail, carriage, sled], joints), Base::Fixed)], &setup);
    let half = Vec3::new(0.1, 0.1, 0.05);
    spec.shapes = vec![
        ShapeSpec { pose_ls: Pose::translation(0.0, 0.0, -0.05), ..shape("floor", None, Shape::HalfSpace) },
        ShapeSpec { link: 2, ..shape("block", Some(0), Shape::Cuboid { half_extents: half }) },
    ];
    spec.pairs = vec![([0, 1], PairLaw::new(linear(1e6, 1e3), Some(bristle(MU, 1e6, 0.0))))];
    let limit = f64::INFINITY;
    let kind = match puller {
        Puller::Drive => ActuatorKind::JointDrive { coordinate: 0, stiffness: 100.0, damping: 0.0, limit },
        Puller::Effort => ActuatorKind::JointEffort { coordinate: 0, limit },
    };
    spec.actuators = vec![Actuator { name: "spring".to_owned(), kind }];
    spec
}

fn pulled_block(integrator: Integrator, puller: Puller) -> World {
    world(pulled_block_spec(integrator, puller))
}

/// Spring of 100 N/m pulled at 0.01 m/s for 30 s: when the speed passes 5 mm/s, the largest force, and the stops.
fn pull(world: &mut World, puller: Puller) -> (f64, f64, usize) {
    let (mut onset, mut peak, mut stops, mut stuck) = (f64::NAN, 0.0_f64, 0, true);
    for step in 0..30_000 {
        let pulled = 0.01 * f64::from(step) * 1e-3;
        let force = 100.0 * (pulled - world.state().q[0]);
        let command = &mut world.commands_mut()[0];
        match puller {
            Puller::Drive => command.position = pulled + 1e-5,
            Puller::Effort => command.effort = force,
        }
        run(world, 1);
        peak = peak.max(force);
        let speed = world.state().v[0];
        if onset.is_nan() && speed > 5e-3 {
            onset = world.state().time;
        }
        // A stop: slower than a tenth of the pull.
        stops += usize::from(stuck && speed.abs() >= 1e-3);
        stuck = speed.abs() < 1e-3;
    }
    (onset, peak, stops)
}

#[test]
fn block_pulled_by_a_spring_breaks_away_and_cycles_as_coulomb_says() {
    // Exact Coulomb friction: break-away at 3.924 s, 5 mm/s at 4.029 s, peak μ m g + v √(k m) = 4.024 N, then undamped
    // cycling that touches zero speed 41 times. A drive's spring is implicit: implicit Euler damps its cycles (each by
    // π h ω, 3 %), so that they stop touching zero; midpoint does not.
    for (integrator, puller, stops) in [
        (Integrator::ImplicitEuler, Puller::Effort, 40..43),
        (Integrator::ImplicitMidpoint, Puller::Drive, 40..43),
        (Integrator::ImplicitEuler, Puller::Drive, 1..10),
    ] {
        let (onset, peak, counted) = pull(&mut pulled_block(integrator, puller), puller);
        println!("{integrator:?}, {puller:?}: onset {onset:.3} s, peak {peak:.4} N, {counted} stops in 30 s");
        assert!((onset - 4.029).abs() < 2e-3);
        assert!((peak - 4.024).abs() < 1.5e-3);
        assert!(stops.contains(&counted));
    }
}

#[test]
fn laws_are_met_for_a_light_block_beside_a_heavy_one() {
    // A press of 100 t stands beside: were the laws checked against the largest force of the world, the stick line of the
    // light block would overrun its cone by up to 1,000 N.
    let (integrator, puller) = (Integrator::ImplicitEuler, Puller::Effort);
    let mut spec = pulled_block_spec(integrator, puller);
    let half = Vec3::new(0.1, 0.1, 0.05);
    let press = sim::VehicleSpec {
        name: "press".to_owned(),
        tree: crate::support::block(1e5, half),
        base: Base::Only([false, false, false, true, true, true]),
    };
    spec.vehicles.push(press);
    spec.shapes.push(shape("press", Some(1), Shape::Cuboid { half_extents: half }));
    spec.pairs.push(([0, 2], PairLaw::new(linear(1e9, 1e6), Some(bristle(MU, 1e9, 0.0)))));
    let mut beside = world(spec);
    beside.state_mut().bases[1] = Pose::translation(5.0, 0.0, 0.0);
    let alone = pull(&mut pulled_block(integrator, puller), puller);
    assert_eq!(pull(&mut beside, puller), alone);
}

#[test]
fn block_on_a_friction_stiffness_of_1e7_rests_and_every_solve_converges() {
    let law = PairLaw::new(linear(1e7, 1e3), Some(bristle(MU, 1e7, 0.0)));
    let mut world = block_on_slope(0.0, law, &Setup::new(Integrator::ImplicitEuler));
    world.set_base_twists(&[crate::support::twist([0.0, 0.0, 0.2], [0.3, 0.1, 0.0])]);
    run(&mut world, 2_000);
    let (moving, before) = (world.kinematics(0).vel[0].lin.norm(), world.state().work);
    run(&mut world, 1_000);
    let work = world.state().work;
    let solves = (work.solves - before.solves) as f64 / 1e3;
    let all = work.solves as f64 / work.steps as f64;
    println!("at rest {moving:.1e} m/s; {solves:.3} solves per step at rest, {all:.3} with the slide");
    assert!(moving < 1e-12);
    assert!(solves < 1.01 && all < 1.5);
    assert_eq!(work.unconverged_steps, 0);
}
