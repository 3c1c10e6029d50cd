//! Stiff contact at an affordable step: rest, no attraction, and honest divergence.

use crate::support::scenes::{block_on_slope, box_hits_plate, flying_ball, pressed_ball};
use crate::support::{ALL, Setup, bristle, hunt_crossley, linear, run, spec, twist, world};
use sim::{Base, Energy, Integrator, PairLaw, StepError, World};
use spatial::Vec3;

#[test]
fn kilogram_on_1e7_newtons_per_metre_rests_at_1_ms_and_is_never_pulled() {
    for normal in [linear(1e7, 0.0), hunt_crossley(1e7, 1.5, 0.0), hunt_crossley(1e10, 1.5, 0.1)] {
        for integrator in [Integrator::ImplicitEuler, Integrator::ImplicitMidpoint] {
            let setup = Setup::new(integrator).gravity(Vec3::new(0.0, 0.0, -9.81));
            let mut world = flying_ball(normal, 1e-4, -0.5, &setup);
            let mut pull = 0.0_f64;
            for _ in 0..3_000 {
                run(&mut world, 1);
                pull = world.touches().fold(pull, |pull, t| pull.max(-t.force_w.dot(&t.normal_w)));
            }
            let speed = world.kinematics(0).vel[0].lin.norm();
            let work = world.state().work;
            let solves = work.solves as f64 / work.steps as f64;
            println!("{integrator:?}: speed {speed:.1e} m/s, largest pull {pull:.1e} N, {solves:.2} solves per step");
            assert!(speed < 1e-9);
            // A thousandth of the impact force (500 N over a step), the law's tolerance.
            assert!(pull < 0.5);
            assert!(solves < 2.3 && work.unconverged_steps == 0);
        }
    }
}

#[test]
fn ball_at_rest_lies_at_the_static_depth() {
    for integrator in ALL {
        let setup = Setup::new(integrator).gravity(Vec3::new(0.0, 0.0, -9.81));
        let mut world = pressed_ball(linear(1e4, 100.0), 0.0, &setup);
        run(&mut world, 2_000);
        let depth = -world.state().bases[0].translation.vector.z;
        assert!((depth - 9.81e-4).abs() < 1e-12, "{integrator:?}: {depth}");
    }
}

#[test]
fn contact_only_takes_energy() {
    // Impact, sliding and grasp without drives: mechanical energy falls from step to step.
    for integrator in [Integrator::ImplicitEuler, Integrator::ImplicitMidpoint] {
        let mut world = box_hits_plate(&Setup::new(integrator));
        let total = |world: &World| Energy::of(world).kinetic;
        let start = total(&world);
        run(&mut world, 1_000);
        let lost = start - total(&world);
        println!("{integrator:?}: {lost:.2e} J of {start:.2e} J lost");
        assert!(lost > 0.0);
    }
}

#[test]
fn divergence_names_time_and_body_and_leaves_the_last_good_state() {
    // Far beyond the explicit methods' limit: h ω = 10.
    let mut found = 0;
    for integrator in [Integrator::SemiImplicitEuler, Integrator::RungeKutta4] {
        let law = PairLaw::new(linear(1e8, 0.0), Some(bristle(0.4, 1e8, 0.0)));
        let mut world = block_on_slope(0.1, law, &Setup::new(integrator));
        world.state_mut().bases[0].translation.vector.z -= 0.02;
        world.state_mut().momentum[0].moment = Vec3::new(1e5, 2e5, 3e5);
        for _ in 0..20_000 {
            let before = world.state().clone();
            let Err(StepError::Diverged { time, body, last_good, .. }) = world.advance() else { continue };
            assert_eq!(body, "vehicle0/block");
            assert!(time > last_good);
            assert_eq!(*world.state(), before, "the last good state is restored");
            let numbers = before.bases[0].translation.vector;
            assert!(numbers.iter().all(|x| x.is_finite()));
            found += 1;
            break;
        }
    }
    assert!(found >= 1, "an explicit method at h ω = 10 diverges");
}

#[test]
fn state_that_is_not_a_number_is_reported_and_not_returned() {
    for integrator in ALL {
        let tree = crate::support::block(1.0, Vec3::repeat(0.1));
        let mut spec = spec(vec![(tree, Base::Free)], &Setup::new(integrator));
        let kind =
            sim::ActuatorKind::Thruster { body: 0, position: Vec3::zeros(), direction: Vec3::x(), max_force: 1.0 };
        spec.actuators = vec![sim::Actuator { name: "jet".to_owned(), kind }];
        let mut world = world(spec);
        world.set_base_twists(&[twist([0.0; 3], [1.0, 0.0, 0.0])]);
        run(&mut world, 10);
        world.commands_mut()[0].effort = f64::NAN;
        let error = world.advance().expect_err("a force that is no number");
        let message = error.to_string();
        assert!(message.contains("vehicle0/block") && message.contains("0.011000"), "{message}");
        assert!((world.state().time - 0.01).abs() < 1e-15);
        world.commands_mut()[0].effort = 0.0;
        run(&mut world, 10);
    }
}
