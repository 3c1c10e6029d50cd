//! Latches: when they engage, what they hold, how they let go.

use crate::support::mechanisms::{ground, mechanism, on};
use crate::support::{ALL, Setup, block, run, spec, twist, world};
use sim::{
    Actuator, ActuatorKind, Base, Bushing, Capture, Command, Energy, Integrator, Latch, MechanismKind, MechanismStatus,
    Overload, PullIn, Strength, World,
};
use spatial::{Pose, Rot, Twist, Vec3};

fn latch() -> Latch {
    Latch {
        capture: Capture {
            axial: [-0.005, 0.02],
            lateral: 0.03,
            tilt: 0.1,
            roll: 0.2,
            closing_speed: [0.01, 0.3],
            dwell: 0.0,
        },
        hold: Bushing::isotropic([2e4, 300.0], [300.0, 5.0]),
        strength: Strength { force: 200.0, moment: f64::INFINITY },
        overload: Overload::LetsGo,
        pull_in: None,
    }
}

/// How a block of 2 kg comes to the latch in the world's origin.
#[derive(Clone, Copy)]
struct Approach {
    lateral: f64,
    turn: Vec3,
    speed: f64,
}

const GOOD: Approach = Approach { lateral: 0.02, turn: Vec3::new(0.05, 0.02, 0.1), speed: 0.1 };

/// The block starts 40 mm in front of the latch; its face's centre is what is caught. Actuators: the latch's release, and a
/// jet that pulls the block off along its z.
fn approach(latch: Latch, how: Approach, setup: &Setup) -> World {
    let face = Pose::translation(0.0, 0.0, -0.2);
    let mut spec = spec(vec![(block(2.0, Vec3::new(0.1, 0.15, 0.2)), Base::Free)], setup);
    spec.mechanisms = vec![mechanism("hook", ground(Pose::identity()), on(0, face), MechanismKind::Latch(latch))];
    let jet =
        ActuatorKind::Thruster { body: 0, position: Vec3::new(0.0, 0.0, -0.2), direction: Vec3::z(), max_force: 1e3 };
    spec.actuators = vec![
        Actuator { name: "open".to_owned(), kind: ActuatorKind::LatchRelease { mechanism: 0 } },
        Actuator { name: "jet".to_owned(), kind: jet },
    ];
    let mut world = world(spec);
    let turn = Rot::from_scaled_axis(how.turn);
    let place = Vec3::new(how.lateral, 0.0, 0.04) - turn * face.translation.vector;
    world.state_mut().bases[0] = Pose::from_parts(place.into(), turn);
    world.set_base_twists(&[twist([0.0; 3], [0.0, 0.0, -how.speed])]);
    world
}

fn status(world: &World) -> MechanismStatus {
    world.mechanisms().next().unwrap().status
}

/// Runs until the latch has changed its state, at most 2,500 steps.
fn run_until_change(world: &mut World) -> Option<f64> {
    let before = status(world);
    (0..2_500).find(|_| {
        run(world, 1);
        status(world) != before
    })?;
    Some(world.state().time)
}

#[test]
fn latch_engages_when_the_face_enters_its_region_and_all_conditions_hold() {
    for integrator in ALL {
        let mut world = approach(latch(), GOOD, &Setup::new(integrator));
        let time = run_until_change(&mut world).unwrap();
        // From 40 mm to 20 mm at 0.1 m/s.
        assert!((time - 0.2).abs() < 1.5e-3, "{integrator:?}: engaged at {time} s");
        assert_eq!(status(&world), MechanismStatus::Engaged);
        assert_eq!(world.mechanisms().next().unwrap().since, time);
    }
}

#[test]
fn each_condition_violated_alone_keeps_the_latch_open() {
    let limits = latch().capture;
    let cases = [
        ("lateral", latch(), Approach { lateral: 0.031, ..GOOD }),
        ("tilt", latch(), Approach { turn: Vec3::new(0.101, 0.0, 0.1), ..GOOD }),
        ("roll", latch(), Approach { turn: Vec3::new(0.05, 0.02, 0.21), ..GOOD }),
        ("too fast", latch(), Approach { speed: 0.301, ..GOOD }),
        ("too slow", latch(), Approach { speed: 0.0099, ..GOOD }),
        ("axial", Latch { capture: Capture { axial: [0.041, 0.06], ..limits }, ..latch() }, GOOD),
        // 25 mm at 0.1 m/s take 0.25 s.
        ("dwell", Latch { capture: Capture { dwell: 0.26, ..limits }, ..latch() }, GOOD),
    ];
    for (name, latch, how) in cases {
        let mut world = approach(latch, how, &Setup::new(Integrator::ImplicitEuler));
        run(&mut world, 6_000);
        assert_eq!(status(&world), MechanismStatus::Open, "{name}");
        assert_eq!(world.state().account.mechanism_work, 0.0, "{name}");
    }
    let waits = Latch { capture: Capture { dwell: 0.1, ..limits }, ..latch() };
    let mut world = approach(waits, GOOD, &Setup::new(Integrator::ImplicitEuler));
    let time = run_until_change(&mut world).unwrap();
    assert!((time - 0.3).abs() < 2.5e-3, "engaged at {time} s, after the dwell");
}

#[test]
fn engagement_stores_nothing_and_no_energy_appears() {
    for integrator in ALL {
        let mut world = approach(latch(), GOOD, &Setup::new(integrator));
        let before = Energy::of(&world).kinetic;
        run_until_change(&mut world).unwrap();
        let energy = Energy::of(&world);
        // Free flight so far: kinetic energy to rounding. Deformation is of rounding's size.
        assert!((energy.kinetic / before - 1.0).abs() < 1e-12, "{integrator:?}: {} J", energy.kinetic - before);
        assert!(energy.mechanism < 1e-25, "{integrator:?}: {} J", energy.mechanism);
        for _ in 0..2_000 {
            run(&mut world, 1);
            let energy = Energy::of(&world);
            assert!(energy.kinetic + energy.mechanism <= before * (1.0 + 1e-9), "{integrator:?}");
        }
        assert!(world.kinematics(0).vel[0].lin.norm() < 1e-6, "{integrator:?}: caught and at rest");
        let caught = world.mechanisms().next().unwrap().deformation.map(f64::abs);
        assert!(caught.iter().all(|e| *e < 1e-8), "{integrator:?}: it rests where it was caught");
    }
}

/// Caught, at rest, then pulled with `force` for a second.
fn pull(latch: Latch, force: f64, integrator: Integrator) -> World {
    let mut world = approach(latch, GOOD, &Setup::new(integrator));
    run(&mut world, 2_000);
    assert_eq!(status(&world), MechanismStatus::Engaged);
    // Slowly: a load applied at once would double.
    for k in 1..=100 {
        world.commands_mut()[1] = Command { effort: 0.01 * force * f64::from(k), ..Command::default() };
        run(&mut world, 20);
    }
    run(&mut world, 1_000);
    world
}

#[test]
fn latch_holds_below_its_load_and_lets_go_or_breaks_above() {
    for integrator in ALL {
        let held = pull(latch(), 196.0, integrator);
        assert_eq!(status(&held), MechanismStatus::Engaged, "{integrator:?}");
        let load = held.mechanisms().next().unwrap().wrench_w.force.norm();
        assert!((load - 196.0).abs() < 1e-6, "{integrator:?}: {load} N");
        assert_eq!(status(&pull(latch(), 204.0, integrator)), MechanismStatus::Released, "{integrator:?}");
        let brittle = Latch { overload: Overload::Breaks, ..latch() };
        let broken = pull(brittle, 204.0, integrator);
        assert_eq!(status(&broken), MechanismStatus::Broken, "{integrator:?}");
        // What it had stored, F²/2k = 1 J, is lost, not given to the bodies.
        let lost = broken.state().account.mechanism_loss;
        assert!(lost > 0.99 * 200.0 * 200.0 / 4e4, "{integrator:?}: {lost} J");
        let weak = Latch { strength: Strength { force: f64::INFINITY, moment: 0.5 }, ..latch() };
        assert_eq!(status(&pull(weak, 5.0, integrator)), MechanismStatus::Engaged, "{integrator:?}");
    }
}

#[test]
fn latch_bears_moments_up_to_its_limit() {
    // The catch itself turns the block's 20 mm offset into some moment; a tight limit lets go at once.
    let weak = Latch { strength: Strength { force: f64::INFINITY, moment: 1e-3 }, ..latch() };
    let mut world = approach(weak, GOOD, &Setup::new(Integrator::ImplicitEuler));
    run(&mut world, 1_000);
    assert_eq!(status(&world), MechanismStatus::Released);
}

#[test]
fn latch_releases_on_command_and_waits_again_when_the_command_is_withdrawn() {
    for integrator in ALL {
        let mut world = approach(latch(), GOOD, &Setup::new(integrator));
        run(&mut world, 2_000);
        assert_eq!(status(&world), MechanismStatus::Engaged);
        let open = |world: &mut World, effort| world.commands_mut()[0] = Command { effort, ..Command::default() };
        open(&mut world, 1.0);
        run(&mut world, 1);
        assert_eq!(status(&world), MechanismStatus::Released, "{integrator:?}");
        // Held open while the block still stands in the region.
        run(&mut world, 500);
        assert_eq!(status(&world), MechanismStatus::Released, "{integrator:?}");
        open(&mut world, 0.0);
        run(&mut world, 1);
        assert_eq!(status(&world), MechanismStatus::Open, "{integrator:?}: ready for the next catch");
        world.set_base_twists(&[twist([0.0; 3], [0.0, 0.0, -0.05])]);
        run(&mut world, 2);
        assert_eq!(status(&world), MechanismStatus::Engaged, "{integrator:?}");
    }
}

#[test]
fn latch_that_let_go_by_load_does_not_catch_again_by_itself() {
    let mut world = pull(latch(), 204.0, Integrator::ImplicitEuler);
    world.commands_mut()[1] = Command::default();
    world.state_mut().bases[0] = Pose::translation(0.0, 0.0, 0.21);
    world.set_base_twists(&[twist([0.0; 3], [0.0, 0.0, -0.05])]);
    run(&mut world, 200);
    assert_eq!(status(&world), MechanismStatus::Released);
}

#[test]
fn pull_in_leads_the_block_to_nominal_and_its_motor_pays() {
    for integrator in ALL {
        let pulls = Latch { pull_in: Some(PullIn { speed: 0.02, turn_rate: 0.1 }), ..latch() };
        let mut world = approach(pulls, GOOD, &Setup::new(integrator).step(2e-4));
        run_until_change(&mut world).unwrap();
        let mut books = sim::EnergyAudit::new(&world);
        run(&mut world, 20_000);
        let pose = world.state().bases[0] * Pose::translation(0.0, 0.0, -0.2);
        let off = (pose.translation.vector.norm(), pose.rotation.scaled_axis().norm());
        println!("{integrator:?}: {off:?}, motor {:.2e} J", world.state().account.pull_in_work);
        assert!(off.0 < 1e-8 && off.1 < 1e-8, "{integrator:?}: {off:?}");
        assert!(world.state().account.pull_in_work != 0.0);
        let drift = books.close(&world).numerical_loss;
        // Of 0.01 J: what the swinging in the hold loses to a first-order step, and to the others.
        let is_first_order = matches!(integrator, Integrator::ImplicitEuler | Integrator::SemiImplicitEuler);
        let bound = if is_first_order { 5e-4 } else { 1e-7 };
        assert!(drift.abs() < bound, "{integrator:?}: {drift:e} J");
    }
}

#[test]
fn snapshot_in_the_dwell_and_in_the_hold_continues_bit_for_bit() {
    for integrator in ALL {
        let limits = latch().capture;
        let waits = Latch {
            capture: Capture { dwell: 0.05, ..limits },
            pull_in: Some(PullIn { speed: 0.05, turn_rate: 0.1 }),
            ..latch()
        };
        let mut world = approach(waits, GOOD, &Setup::new(integrator));
        for _ in 0..4 {
            run(&mut world, 110);
            let text = serde_json::to_string(world.state()).unwrap();
            let state: sim::State = serde_json::from_str(&text).unwrap();
            let mut again = World::new(world.model().clone(), state);
            let mut plain = World::new(world.model().clone(), world.state().clone());
            run(&mut again, 100);
            run(&mut plain, 100);
            assert_eq!(again.state(), plain.state(), "{integrator:?}");
        }
        assert_eq!(status(&world), MechanismStatus::Engaged);
    }
}

#[test]
fn drifting_world_shows_the_same_catch() {
    // The latch on a heavy free body, both flying at 3 m/s.
    for integrator in ALL {
        let relative = |drift: Vec3| {
            let mut spec = spec(
                vec![(block(20.0, Vec3::repeat(0.3)), Base::Free), (block(2.0, Vec3::repeat(0.1)), Base::Free)],
                &Setup::new(integrator),
            );
            let (face, port) = (on(1, Pose::translation(0.0, 0.0, -0.1)), on(0, Pose::translation(0.0, 0.0, 0.3)));
            spec.mechanisms = vec![mechanism("hook", port, face, MechanismKind::Latch(latch()))];
            let mut world = world(spec);
            world.state_mut().bases[1] = Pose::translation(0.01, 0.0, 0.44);
            world.set_base_twists(&[
                Twist::new(Vec3::new(0.0, 0.02, 0.01), drift),
                Twist::new(Vec3::new(0.03, 0.0, 0.05), drift + Vec3::new(0.0, 0.0, -0.1)),
            ]);
            run(&mut world, 1_000);
            assert_eq!(status(&world), MechanismStatus::Engaged, "{integrator:?}");
            world.state().bases[0].inverse() * world.state().bases[1]
        };
        let [plain, flying] = [Vec3::zeros(), Vec3::new(2.0, -2.0, 1.0)].map(relative);
        let off = (plain.translation.vector - flying.translation.vector).norm();
        println!("{integrator:?}: {off:.1e} m");
        assert!(off < if integrator == Integrator::RungeKutta4 { 1e-6 } else { 1e-10 }, "{integrator:?}: {off:e}");
    }
}
