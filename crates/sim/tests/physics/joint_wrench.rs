//! What passes through a joint, against closed forms: a pendulum, a tool on a body that turns and is pushed, a scale, a spring.

use crate::body_loads::effect;
use crate::support::mechanisms::{at, ground, mechanism};
use crate::support::{ALL, Setup, block, hunt_crossley, joint, link, robot, run, shape, spec, twist, world};
use contact::Shape;
use multibody::JointKind;
use sim::{Axes, Base, BodyLaw, Bushing, Integrator, Load, MechanismKind, ModelSpec, PairLaw, ShapeSpec};
use spatial::{Pose, Vec3};

const DOWN: Vec3 = Vec3::new(0.0, 0.0, -9.81);

#[test]
fn the_hinge_of_a_pendulum_bears_weight_and_centripetal_force_and_no_moment() {
    let (mass, long, moment, angle, rate) = (2.0, 0.5, 0.06, 0.7_f64, 1.3);
    let rod = link("rod", mass, Vec3::new(0.0, 0.0, -long), Vec3::new(0.05, moment, 0.01));
    let hinge = joint("hinge", 0, Vec3::new(0.1, 0.2, 0.3), Vec3::y(), JointKind::Revolute);
    let tree = robot(vec![link("base", 1.0, Vec3::zeros(), Vec3::repeat(1.0)), rod], vec![hinge]);
    for integrator in ALL {
        let mut world = world(spec(vec![(tree.clone(), Base::Fixed)], &Setup::new(integrator).gravity(DOWN)));
        let state = world.state_mut();
        (state.q[0], state.v[0]) = (angle, rate);
        world.refresh();
        let arm = Vec3::new(-long * angle.sin(), 0.0, -long * angle.cos());
        let spin = Vec3::new(0.0, rate, 0.0);
        let turn = Vec3::new(0.0, arm.cross(&(mass * DOWN)).y / (moment + mass * long * long), 0.0);
        let force = mass * (turn.cross(&arm) + spin.cross(&spin.cross(&arm)) - DOWN);
        let read = world.calc_joint_wrench(0, 1).unwrap();
        // What differences over 20 µs miss of a swing of 0.7 Hz, of 17 N.
        assert!((read.force - force).norm() < 1e-7, "{integrator:?}: {:?} for {force:?}", read.force);
        assert!(read.moment.norm() < 1e-7, "{integrator:?}: {:?}", read.moment);
        // A base hangs on nothing.
        assert_eq!(world.calc_joint_wrench(0, 0), Some(spatial::Wrench::default()));
    }
}

#[test]
fn a_fixed_joint_bears_what_moves_the_tool_behind_it() {
    let (mass, com, moments) = (2.0, Vec3::new(0.05, 0.0, 0.1), Vec3::new(0.02, 0.03, 0.04));
    let mount = joint("mount", 0, Vec3::new(0.4, 0.1, 0.3), Vec3::z(), JointKind::Fixed);
    let hull = link("hull", 12.0, Vec3::new(0.05, -0.02, 0.1), Vec3::new(0.9, 1.1, 1.3));
    let tree = robot(vec![hull, link("tool", mass, com, moments)], vec![mount]);
    let pushes = vec![
        effect(BodyLaw::Load(Load::ConstantForce { vector: Vec3::new(3.0, -1.0, 2.0), axes: Axes::Body })),
        effect(BodyLaw::Load(Load::ConstantTorque { vector: Vec3::new(0.2, 0.1, -0.3), axes: Axes::Body })),
    ];
    let setup = Setup::new(Integrator::RungeKutta4);
    let mut world = world(ModelSpec { effects: pushes, ..spec(vec![(tree, Base::Free)], &setup) });
    world.set_base_twists(&[twist([0.5, -0.8, 0.3], [0.1, 0.0, 0.2])]);
    run(&mut world, 200);
    let (rate, frame) = (world.calc_link_acceleration(0, 1).unwrap(), world.link_frame(0, 1));
    let (spin, arm) = (world.link_twist(0, 1).ang, frame.rot * com);
    let force = mass * (rate.lin + rate.ang.cross(&arm) + spin.cross(&spin.cross(&arm)));
    let tensor = frame.rot * spatial::Mat3::from_diagonal(&moments) * frame.rot.transpose();
    let moment = tensor * rate.ang + spin.cross(&(tensor * spin)) + arm.cross(&force);
    let read = world.calc_joint_wrench(0, 1).unwrap();
    assert!((read.force - force).norm() < 1e-7, "{:?} for {force:?}", read.force);
    assert!((read.moment - moment).norm() < 1e-7, "{:?} for {moment:?}", read.moment);
}

#[test]
fn a_scale_bears_its_pan_and_what_lies_on_it() {
    let pan = link("pan", 1.0, Vec3::zeros(), Vec3::repeat(0.01));
    let mount = joint("mount", 0, Vec3::new(0.2, 0.0, 0.5), Vec3::z(), JointKind::Fixed);
    let scale = robot(vec![link("foot", 5.0, Vec3::zeros(), Vec3::repeat(1.0)), pan], vec![mount]);
    let cuboid = |half: Vec3| Shape::Cuboid { half_extents: half };
    let shapes = vec![
        ShapeSpec { link: 1, ..shape("pan", Some(0), cuboid(Vec3::new(0.2, 0.2, 0.01))) },
        shape("weight", Some(1), cuboid(Vec3::repeat(0.05))),
    ];
    let law = PairLaw::new(hunt_crossley(1e5, 1.0, 5.0), None);
    for integrator in [Integrator::ImplicitEuler, Integrator::RungeKutta4] {
        let vehicles = vec![(scale.clone(), Base::Fixed), (block(3.0, Vec3::repeat(0.05)), Base::Free)];
        let setup = Setup::new(integrator).gravity(DOWN);
        let mut world =
            world(ModelSpec { shapes: shapes.clone(), pairs: vec![([0, 1], law)], ..spec(vehicles, &setup) });
        world.state_mut().bases[1] = Pose::translation(0.25, 0.02, 0.56);
        run(&mut world, 3000);
        let read = world.calc_joint_wrench(0, 1).unwrap();
        assert!((read.force + 4.0 * DOWN).norm() < 1e-4, "{integrator:?}: {:?} N", read.force);
        // The weight lies 50 mm and 20 mm beside the middle.
        let moment = Vec3::new(0.02, -0.05, 0.0) * 3.0 * 9.81;
        assert!((read.moment - moment).norm() < 1e-3, "{integrator:?}: {:?} for {moment:?}", read.moment);
    }
}

#[test]
fn a_mount_bears_what_a_spring_pulls() {
    let tool = link("tool", 1.0, Vec3::zeros(), Vec3::repeat(0.01));
    let mount = joint("mount", 0, Vec3::new(0.0, 0.0, 0.5), Vec3::z(), JointKind::Fixed);
    let tree = robot(vec![link("foot", 5.0, Vec3::zeros(), Vec3::repeat(1.0)), tool], vec![mount]);
    let hold = Bushing { stiffness: Vec3::new(200.0, 500.0, 900.0), ..Bushing::default() };
    let mut end = at(0, 0.0, 0.0, 0.0);
    end.link = 1;
    let tie = mechanism("tie", ground(Pose::translation(0.01, 0.0, 0.5)), end, MechanismKind::Bushing(hold));
    let setup = Setup::new(Integrator::RungeKutta4);
    let world = world(ModelSpec { mechanisms: vec![tie], ..spec(vec![(tree, Base::Fixed)], &setup) });
    // It pulls the tool towards +x; the mount holds against it.
    let read = world.calc_joint_wrench(0, 1).unwrap();
    assert!((read.force - Vec3::new(-2.0, 0.0, 0.0)).norm() < 1e-9, "{:?}", read.force);
}
