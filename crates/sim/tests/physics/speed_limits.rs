//! Motors at the speed where they stop pushing: reaction wheels, joints with a velocity limit, motors behind a gear.

use crate::support::effects::on_joint;
use crate::support::{ALL, Setup, joint, link, robot, run, spec, twist, world};
use multibody::JointKind;
use sim::{Actuator, ActuatorKind, Base, EffectKind, Energy, JointLaw, ModelSpec, MomentumAudit, Series, World};
use spatial::Vec3;

/// Of the wheel about its axis, kg·m², and its motor, N·m.
const WHEEL: f64 = 0.02;
const TORQUE: f64 = 0.1;
/// rad/s.
const LIMIT: f64 = 5.0;
/// The fall of the effort before the limit is a millionth of it wide (see `speed_limit`); a wheel that is pushed rests on it.
const WIDTH: f64 = 1.1e-6 * LIMIT;

fn motor(coordinate: usize) -> Actuator {
    let kind = ActuatorKind::JointEffort { coordinate, limit: 1.0 };
    Actuator { name: format!("motor{coordinate}"), kind }
}

/// A free bus with one reaction wheel along an axis that is no principal one.
fn bus(setup: &Setup) -> World {
    let axis = Vec3::new(0.2, -0.4, 0.9).normalize();
    let mut tree = robot(vec![link("bus", 50.0, Vec3::new(0.1, 0.0, -0.05), Vec3::new(4.0, 5.0, 6.0))], Vec::new());
    let wheel = tree.add_rotor(0, &axis, WHEEL, "wheel");
    tree.joints[wheel].velocity_limit = LIMIT;
    let actuators = vec![motor(0)];
    world(ModelSpec { actuators, ..spec(vec![(tree, Base::Free)], setup) })
}

/// Commands an effort for `steps` steps and gives the largest speed reached.
fn push(world: &mut World, effort: f64, steps: usize) -> f64 {
    world.commands_mut()[0].effort = effort;
    (0..steps).fold(0.0, |fastest: f64, _| {
        run(world, 1);
        fastest.max(world.state().v[0].abs())
    })
}

#[test]
fn wheel_stops_at_its_limit_and_what_it_took_stays_with_it() {
    for integrator in ALL {
        for step in [1e-3, 7e-3] {
            let mut world = bus(&Setup::new(integrator).step(step));
            world.set_base_twists(&[twist([0.0; 3], [0.1, 0.02, -0.3])]);
            let mut audit = MomentumAudit::new(&world);
            // The limit is reached after about J L/τ = 1 s.
            let fastest = push(&mut world, TORQUE, (2.0 / step) as usize);
            let (held, work, energy) = (world.state().v[0], world.works().actuators[0], Energy::of(&world));
            assert!(fastest <= LIMIT * (1.0 + 1e-12), "{integrator:?}: {fastest} rad/s");
            assert!(held > LIMIT - WIDTH && world.is_speed_limited(0), "{integrator:?}: {held} rad/s");
            // Nothing turns but wheel and bus against each other: what the motor still gives is round-off.
            push(&mut world, TORQUE, (1.0 / step) as usize);
            let more = world.works().actuators[0] - work;
            assert!(more.abs() < 1e-6 * work && energy.kinetic > work, "{integrator:?}: {more} J of {work} J");
            audit.update(&world);
            assert!(audit.angular_drift < 1e-12 && audit.linear_drift < 1e-12, "{integrator:?}: {audit:?}");
        }
    }
}

#[test]
fn wheel_comes_off_its_limit_in_the_step_in_which_the_command_turns() {
    for integrator in ALL {
        for direction in [1.0, -1.0] {
            let mut world = bus(&Setup::new(integrator));
            push(&mut world, direction * TORQUE, 100);
            let gained = world.state().v[0];
            push(&mut world, direction * TORQUE, 1_500);
            assert!(world.is_speed_limited(0) && world.state().v[0] * direction > 0.0);
            let held = world.state().v[0];
            push(&mut world, -direction * TORQUE, 100);
            // From rest to speed and from the limit back: the same torque on the same inertia, the bus at rest with the
            // whole at zero momentum; what is left is the width of the fall and the integrator on a turn of 1 mrad.
            let lost = held - world.state().v[0];
            assert!((lost / gained - 1.0).abs() < 1e-5, "{integrator:?}: {lost} {gained}");
            assert!(!world.is_speed_limited(0));
        }
    }
}

/// A wheel on a turntable on a fixed post, one axis for both: actuator 0 is the wheel's, 1 the table's.
fn turntable(setup: &Setup) -> World {
    let axle = |name, parent| joint(name, parent, Vec3::zeros(), Vec3::z(), JointKind::Revolute);
    let mut wheel = axle("wheel", 1);
    wheel.velocity_limit = LIMIT;
    let body = |name, inertia| link(name, 1.0, Vec3::zeros(), Vec3::repeat(inertia));
    let tree = robot(vec![body("post", 1.0), body("table", 0.5), body("wheel", WHEEL)], vec![axle("table", 0), wheel]);
    let actuators = vec![motor(1), motor(0)];
    let mut world = world(ModelSpec { actuators, ..spec(vec![(tree, Base::Fixed)], setup) });
    world.state_mut().v[1] = LIMIT;
    world
}

#[test]
fn at_its_limit_a_motor_gives_what_keeps_it_there_and_no_more() {
    for integrator in ALL {
        let mut world = turntable(&Setup::new(integrator));
        world.commands_mut()[0].effort = TORQUE;
        world.commands_mut()[1].effort = 0.4;
        run(&mut world, 500);
        // Table and wheel gain speed together: τ = J T/(I + J), below the 0.1 N·m that are asked.
        let expected = WHEEL * 0.4 / (0.5 + WHEEL);
        let (given, speed) = (world.effort(1), world.state().v[1]);
        assert!((given - expected).abs() < 1e-9, "{integrator:?}: {given} N·m against {expected}");
        assert!(speed <= LIMIT * (1.0 + 1e-12) && speed > LIMIT - WIDTH, "{integrator:?}: {speed}");
    }
}

#[test]
fn a_motor_is_no_brake_and_lets_itself_be_carried_beyond_its_limit() {
    for integrator in ALL {
        let mut world = turntable(&Setup::new(integrator));
        world.commands_mut()[0].effort = TORQUE;
        world.commands_mut()[1].effort = -0.4;
        run(&mut world, 500);
        // The table turns away beneath it, and nothing acts on the wheel: T/I for half a second.
        assert!(
            (world.state().v[1] - (LIMIT + 0.4 / 0.5 * 0.5)).abs() < 1e-9,
            "{integrator:?}: {}",
            world.state().v[1]
        );
        assert_eq!(world.effort(1), 0.0);
        world.commands_mut()[0].effort = -TORQUE;
        run(&mut world, 1);
        assert_eq!(world.effort(1), -TORQUE, "{integrator:?}: it brakes with all it has");
    }
}

#[test]
fn a_drive_with_far_to_go_travels_at_its_joints_velocity_limit() {
    for integrator in ALL {
        let mut hinge = joint("hinge", 0, Vec3::zeros(), Vec3::z(), JointKind::Revolute);
        hinge.velocity_limit = 0.3;
        hinge.damping = 0.5;
        let body = |name| link(name, 1.0, Vec3::zeros(), Vec3::repeat(0.2));
        let tree = robot(vec![body("post"), body("arm")], vec![hinge]);
        let kind = ActuatorKind::JointDrive { coordinate: 0, stiffness: 200.0, damping: 20.0, limit: 15.0 };
        let actuators = vec![Actuator { name: "drive".to_owned(), kind }];
        let mut world = world(ModelSpec { actuators, ..spec(vec![(tree, Base::Fixed)], &Setup::new(integrator)) });
        world.commands_mut()[0].position = 1.0;
        run(&mut world, 1_000);
        let (q, v) = (world.state().q[0], world.state().v[0]);
        assert!(v <= 0.3 * (1.0 + 1e-12) && v > 0.3 * (1.0 - 2e-6), "{integrator:?}: {v}");
        // It feels the joint's friction and nothing else: the motor gives that, the sum is nothing.
        assert!(world.effort(0).abs() < 1e-6, "{integrator:?}: {}", world.effort(0));
        // A start from rest with 15 N·m takes 4 ms.
        assert!((q - 0.3 * 0.998).abs() < 0.3 * 2e-3, "{integrator:?}: {q}");
        run(&mut world, 9_000);
        assert!((world.state().q[0] - 1.0).abs() < 1e-6, "{integrator:?}: it arrives");
    }
}

#[test]
fn behind_a_gear_that_yields_it_is_the_motor_that_stops_at_the_limit() {
    for integrator in ALL {
        let gear = EffectKind::Series(Series { coordinate: 0, rotor: 0.2, stiffness: 800.0, damping: 4.0, gap: 1e-3 });
        let drag = on_joint(JointLaw::Viscous { damping: 0.1 });
        let mut spec = crate::support::effects::wheel_spec(&[gear, drag], &Setup::new(integrator));
        spec.vehicles[0].tree.joints[0].velocity_limit = LIMIT;
        let mut world = world(spec);
        world.commands_mut()[0].effort = 6.0;
        let (mut work, mut rate) = (0.0_f64, 0.0_f64);
        for _ in 0..6_000 {
            run(&mut world, 1);
            let (work_now, rate_now) = (world.works().actuators[0], world.motor_side(0).1);
            // The gear's spring may swing the rotor beyond; the motor gives nothing there, but for a step that leads back to L,
            // τ h/B = 0.03 rad/s.
            let is_beyond = rate.min(rate_now) > LIMIT + 0.03;
            assert!(!is_beyond || work_now == work, "{integrator:?}: {} J at {rate_now} rad/s", work_now - work);
            (work, rate) = (work_now, rate_now);
        }
        // The joint follows its motor, both at the limit, against 0.1 N·m·s/rad.
        assert!((world.state().v[0] - LIMIT).abs() < 1e-3 && world.is_speed_limited(0), "{integrator:?}");
        world.commands_mut()[0].effort = -6.0;
        run(&mut world, 200);
        assert!(world.motor_side(0).1 < 0.8 * LIMIT, "{integrator:?}: it comes off");
    }
}
