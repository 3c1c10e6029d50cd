//! Joints that follow another: their limits, damping and friction act on the coordinate that both share.

use crate::support::{ALL, Setup, joint, link, robot, run, spec, world};
use multibody::{JointDescription, JointKind, Mimic, Tree};
use sim::{Actuator, ActuatorKind, Base, Energy, Integrator, ModelSpec, World};
use spatial::Vec3;

/// Of each of the two wheels, kg·m².
const INERTIA: f64 = 0.5;
const RATIO: f64 = -2.5;
/// Of both wheels at the leader: I + r² I.
const BOTH: f64 = INERTIA * (1.0 + RATIO * RATIO);

/// A wheel and one that follows it, as `change` leaves the follower's joint.
fn wheels(change: impl Fn(&mut JointDescription)) -> Tree {
    let leader = joint("leader", 0, Vec3::zeros(), Vec3::z(), JointKind::Revolute);
    let mut follower = joint("follower", 0, Vec3::x(), Vec3::z(), JointKind::Revolute);
    follower.mimic = Some(Mimic { joint: 0, multiplier: RATIO, offset: 0.1 });
    change(&mut follower);
    let body = |name| link(name, 1.0, Vec3::zeros(), Vec3::repeat(INERTIA));
    robot(vec![body("post"), body("a"), body("b")], vec![leader, follower])
}

fn world_of(tree: Tree, integrator: Integrator) -> World {
    let kind = ActuatorKind::JointEffort { coordinate: 0, limit: 10.0 };
    let actuators = vec![Actuator { name: "motor".to_owned(), kind }];
    world(ModelSpec { actuators, ..spec(vec![(tree, Base::Fixed)], &Setup::new(integrator)) })
}

#[test]
fn follower_brings_its_damping_with_the_square_of_its_ratio() {
    // First order, second, first, fourth, at λ h = 6e-4 over one time constant of 1.7.
    for (integrator, tolerance) in ALL.into_iter().zip([5e-4, 5e-8, 5e-4, 1e-11]) {
        let mut world = world_of(wheels(|j| j.damping = 0.35), integrator);
        world.state_mut().v[0] = 1.0;
        run(&mut world, 1_000);
        let expected = (-RATIO * RATIO * 0.35 / BOTH).exp();
        let speed = world.state().v[0];
        assert!((speed / expected - 1.0).abs() < tolerance, "{integrator:?}: {speed} against {expected}");
        // What the dampers took is what the wheels lost.
        let (lost, taken) = (0.5 * BOTH - Energy::of(&world).kinetic, world.state().account.joint_loss);
        assert!((taken / lost - 1.0).abs() < 2e-3, "{integrator:?}: {taken} J of {lost} J");
    }
}

#[test]
fn follower_brings_its_dry_friction_with_the_size_of_its_ratio() {
    for integrator in ALL {
        let mut world = world_of(wheels(|j| j.friction = 0.4), integrator);
        world.commands_mut()[0].effort = 3.0;
        run(&mut world, 200);
        let (v0, t0) = (world.state().v[0], world.state().time);
        run(&mut world, 500);
        let slope = (world.state().v[0] - v0) / (world.state().time - t0);
        let expected = (3.0 - RATIO.abs() * 0.4) / BOTH;
        // Round-off of 500 sums.
        assert!((slope / expected - 1.0).abs() < 1e-9, "{integrator:?}: {slope} against {expected}");
    }
}

#[test]
fn leader_stops_where_its_follower_reaches_its_limit() {
    for integrator in ALL {
        // −0.5 … 0.35 less the offset of 0.1, over −2.5: −0.1 … 0.24 at the leader.
        let mut world = world_of(wheels(|j| j.position_limits = Some([-0.5, 0.35])), integrator);
        for (effort, limit) in [(5.0, 0.24), (-5.0, -0.1)] {
            world.commands_mut()[0].effort = effort;
            run(&mut world, 4_000);
            // Pressed into a stop of 1e5 N·m/rad, whose damper is far above critical.
            let expected = limit + effort / 1e5;
            let at = world.state().q[0];
            assert!((at - expected).abs() < 1e-7, "{integrator:?}: {at} against {expected}");
            let follower = world.link_frame(0, 2).rot;
            let turned = follower[(1, 0)].atan2(follower[(0, 0)]);
            assert!((turned - (RATIO * at + 0.1)).abs() < 1e-12, "{integrator:?}: follower at {turned}");
        }
    }
}

#[test]
fn ranges_that_leave_no_position_are_refused_with_both_joints() {
    let mut tree = wheels(|j| j.position_limits = Some([0.5, 0.6]));
    assert!(tree.find_empty_range().is_none(), "the leader may be anywhere");
    tree.joints[0].position_limits = Some([0.0, 1.0]);
    let error = sim::Model::build(spec(vec![(tree, Base::Fixed)], &Setup::new(Integrator::RungeKutta4))).unwrap_err();
    let text = error.to_string();
    for word in ["leader", "follower", "0 … 1", "-0.2 … -0.16", "<mimic>"] {
        assert!(text.contains(word), "{word} is not in: {text}");
    }
}
