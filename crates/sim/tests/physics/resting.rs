//! Long steps of free flight with a stiff spring at rest held: what may be held, and what that does to the rest.

use crate::support::effects::on_joint;
use crate::support::{Setup, joint, link, robot, spec, twist, world};
use multibody::JointKind;
use sim::{Actuator, ActuatorKind, Base, Effect, Integrator, JointLaw, ModelSpec, MomentumAudit, Rest, State, World};
use spatial::Vec3;

const STIFFNESS: f64 = 1.6e5;
const TIP: f64 = 0.8;
const STILL: Rest = Rest { coordinate: 0, speed: 1e-5, acceleration: 1e-3 };
/// Far beyond what the spring's 70 Hz bear.
const LONG: f64 = 0.02;

/// A body of 50 kg that flies and turns about a principal axis, with a tip on a spring across it.
fn flying(integrator: Integrator) -> World {
    let slide = joint("slide", 0, Vec3::new(0.0, 0.0, 0.6), Vec3::x(), JointKind::Prismatic);
    let hull = link("hull", 50.0, Vec3::zeros(), Vec3::new(4.0, 5.0, 6.0));
    let tree = robot(vec![hull, link("tip", TIP, Vec3::zeros(), Vec3::repeat(1e-3))], vec![slide]);
    let laws = [JointLaw::Cable { stiffness: STIFFNESS, rest: 0.0 }, JointLaw::Viscous { damping: 260.0 }];
    let motor = ActuatorKind::JointEffort { coordinate: 0, limit: 100.0 };
    let mut world = world(ModelSpec {
        actuators: vec![Actuator { name: "motor".to_owned(), kind: motor }],
        effects: laws.map(|law| Effect { name: format!("{law:?}"), kind: on_joint(law) }).to_vec(),
        ..spec(vec![(tree, Base::Free)], &Setup::new(integrator))
    });
    world.set_base_twists(&[twist([0.0, 0.0, 0.1], [0.05, -0.02, 0.01])]);
    world
}

fn bits(state: &State) -> Vec<u64> {
    let pose = state.bases[0];
    let place = pose.translation.vector.iter().chain(pose.rotation.coords.iter());
    let momentum = state.momentum[0].force.iter().chain(state.momentum[0].moment.iter());
    place.chain(momentum).chain(&state.q).chain(&state.v).map(|x| x.to_bits()).collect()
}

#[test]
fn a_vehicle_with_its_spring_held_moves_as_one_body() {
    let mut world = flying(Integrator::RungeKutta4);
    let mut audit = MomentumAudit::new(&world);
    let start = world.kinematics(0).anchor;
    for _ in 0..100 {
        assert!(world.advance_resting(LONG, &[STILL]).unwrap(), "at {} s", world.state().time);
    }
    audit.update(&world);
    // Rounding of 100 steps.
    assert!(audit.linear_drift < 1e-14 && audit.angular_drift < 1e-14);
    assert!(world.state().q[0] == 0.0 && world.state().v[0] == 0.0);
    // The tip's moments about z are at the axis of the turn: the centre of mass lies on it, 0.6 m · 0.8/50.8 up.
    let moved = world.kinematics(0).anchor - start;
    assert!((moved - 2.0 * Vec3::new(0.05, -0.02, 0.01)).norm() < 1e-12, "{moved:?}");
}

#[test]
fn what_moves_or_is_pushed_is_not_held_and_loses_no_bit() {
    let mut swinging = flying(Integrator::RungeKutta4);
    swinging.state_mut().v[0] = 2.0 * STILL.speed;
    swinging.refresh();
    let mut pushed = flying(Integrator::RungeKutta4);
    pushed.commands_mut()[0].effort = 2.0 * TIP * STILL.acceleration;
    let other = flying(Integrator::ImplicitMidpoint);
    for mut world in [swinging, pushed, other] {
        let before = bits(world.state());
        assert!(!world.advance_resting(LONG, &[STILL]).unwrap());
        assert_eq!(bits(world.state()), before);
        assert_eq!(world.state().time, 0.0);
    }
}

#[test]
fn what_is_pushed_less_than_it_bears_is_held() {
    let mut world = flying(Integrator::RungeKutta4);
    world.state_mut().v[0] = 0.5 * STILL.speed;
    world.commands_mut()[0].effort = 0.25 * TIP * STILL.acceleration;
    assert!(world.advance_resting(1e-3, &[STILL]).unwrap());
    assert_eq!((world.state().q[0], world.state().v[0]), (0.0, 0.0));
}
