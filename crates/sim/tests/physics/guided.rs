//! Bases that a guide holds in part: an air bearing (x, y, yaw) and a slider.

use crate::support::{ALL, Setup, arm7, block, bristle, joint, linear, link, robot, run, shape, spec, twist, world};
use contact::Shape;
use multibody::JointKind;
use sim::{Base, Energy, Integrator, PairLaw, World};
use spatial::{Pose, Vec3};

/// Angular x, y, z, then linear x, y, z.
const AIR_BEARING: Base = Base::Only([false, false, true, true, true, false]);
const SLIDER: Base = Base::Only([false, false, false, true, false, false]);

/// A planar arm of two links on an air bearing.
fn planar_arm(setup: &Setup) -> World {
    let body = |name, mass: f64| link(name, mass, Vec3::new(0.2, 0.0, 0.05), Vec3::new(0.02, 0.03, 0.04) * mass);
    let joints = vec![
        joint("shoulder", 0, Vec3::new(0.3, 0.0, 0.1), Vec3::z(), JointKind::Revolute),
        joint("elbow", 1, Vec3::new(0.4, 0.0, 0.0), Vec3::z(), JointKind::Revolute),
    ];
    let tree = robot(vec![body("base", 12.0), body("upper", 3.0), body("fore", 2.0)], joints);
    let mut world = world(spec(vec![(tree, AIR_BEARING)], setup));
    world.state_mut().q.copy_from_slice(&[0.4, -0.9]);
    world.state_mut().v.copy_from_slice(&[0.7, -1.1]);
    world.set_base_twists(&[twist([0.0, 0.0, 0.3], [0.05, -0.02, 0.0])]);
    world
}

#[test]
fn air_bearing_keeps_its_plane_and_its_planar_momentum() {
    for integrator in ALL {
        let mut world = planar_arm(&Setup::new(integrator));
        let momentum =
            |world: &World| multibody::calc_momentum(world.kinematics(0)).about(&-world.kinematics(0).anchor);
        let start = momentum(&world);
        run(&mut world, 5_000);
        let (now, pose) = (momentum(&world), world.state().bases[0]);
        assert_eq!(pose.translation.vector.z, 0.0);
        assert_eq!((pose.rotation.i, pose.rotation.j), (0.0, 0.0), "{integrator:?}");
        let kept = (now.force - start.force).xy().norm() + (now.moment - start.moment).z.abs();
        println!("{integrator:?}: change of p_x, p_y, L_z {kept:.1e}");
        assert!(kept < 1e-13);
    }
}

#[test]
fn planar_motion_of_an_air_bearing_is_that_of_a_free_vehicle_with_the_same_plane() {
    // All forces of a symmetric planar arm lie in the plane: the guide has only moments to hold, and none acts if every
    // centre of mass lies in one plane.
    for integrator in ALL {
        let build = |base: Base| {
            let body = |name, mass: f64| link(name, mass, Vec3::new(0.2, 0.0, 0.0), Vec3::repeat(0.04) * mass);
            let joints = vec![joint("shoulder", 0, Vec3::new(0.3, 0.0, 0.0), Vec3::z(), JointKind::Revolute)];
            let tree = robot(vec![body("base", 12.0), body("upper", 3.0)], joints);
            let mut world = world(spec(vec![(tree, base)], &Setup::new(integrator)));
            world.state_mut().v[0] = 1.3;
            world.set_base_twists(&[twist([0.0, 0.0, -0.4], [0.1, 0.05, 0.0])]);
            run(&mut world, 3_000);
            world.state().bases[0]
        };
        let (free, guided) = (build(Base::Free), build(AIR_BEARING));
        let off =
            (free.translation.vector - guided.translation.vector).norm() + free.rotation.angle_to(&guided.rotation);
        println!("{integrator:?}: {off:.1e}");
        // Round-off of 3,000 steps; the angle from a cosine.
        assert!(off < 1e-7);
    }
}

#[test]
fn off_centre_push_on_an_air_bearing_gives_the_planar_closed_form() {
    for (integrator, tolerance) in ALL.into_iter().zip([1e-4, 1e-7, 1e-4, 1e-12]) {
        let mut spec = spec(vec![(block(5.0, Vec3::new(0.2, 0.1, 0.05)), AIR_BEARING)], &Setup::new(integrator));
        let (position, direction) = (Vec3::new(0.15, 0.0, 0.04), Vec3::y());
        let kind = sim::ActuatorKind::Thruster { body: 0, position, direction, max_force: 2.0 };
        spec.actuators = vec![sim::Actuator { name: "jet".to_owned(), kind }];
        let mut world = world(spec);
        world.commands_mut()[0].effort = 1.0;
        run(&mut world, 500);
        let inertia = 5.0 / 3.0 * (0.04 + 0.01);
        let spin = world.kinematics(0).vel[0].ang;
        assert!((spin.z - 0.15 * 0.5 / inertia).abs() < tolerance, "{integrator:?}: {spin}");
        assert_eq!((spin.x, spin.y), (0.0, 0.0));
        let (kinetic, work) = (Energy::of(&world).kinetic, world.works().actuators[0]);
        assert!((work / kinetic - 1.0).abs() < 3e-3, "{integrator:?}: {work} {kinetic}");
    }
}

#[test]
fn slider_on_a_tilted_rail_falls_with_its_share_of_gravity() {
    for integrator in ALL {
        let setup = Setup::new(integrator).gravity(Vec3::new(0.7, 0.2, -9.8));
        let mut world = world(spec(vec![(block(3.0, Vec3::repeat(0.1)), SLIDER)], &setup));
        run(&mut world, 1_000);
        let velocity = world.kinematics(0).vel[0];
        assert!(
            (velocity.lin - Vec3::new(0.7, 0.0, 0.0)).norm() < 1e-12 && velocity.ang.norm() == 0.0,
            "{integrator:?}"
        );
        let x = world.state().bases[0].translation.vector;
        // First-order drift: h/2 of the final speed.
        assert!((x - Vec3::new(0.35, 0.0, 0.0)).norm() < 4e-4, "{integrator:?}: {x}");
    }
}

#[test]
fn slider_carrying_an_arm_conserves_its_one_component() {
    for integrator in ALL {
        let mut world = world(spec(vec![(arm7(), SLIDER)], &Setup::new(integrator)));
        world.state_mut().v.copy_from_slice(&[0.4, -0.5, 0.6, 0.8, -1.0, 0.9, 0.7]);
        world.set_base_twists(&[twist([0.0; 3], [0.1, 0.0, 0.0])]);
        let momentum = |world: &World| multibody::calc_momentum(world.kinematics(0)).force.x;
        let (start, energy) = (momentum(&world), Energy::of(&world).kinetic);
        run(&mut world, 2_000);
        assert!((momentum(&world) - start).abs() < 1e-13, "{integrator:?}");
        let drift = Energy::of(&world).kinetic / energy - 1.0;
        println!("{integrator:?}: energy drift {drift:.1e}");
        let bound = match integrator {
            Integrator::RungeKutta4 => 1e-10,
            Integrator::ImplicitMidpoint => 1e-4,
            _ => 1e-1,
        };
        assert!(drift.abs() < bound);
        let pose = world.state().bases[0];
        assert_eq!((pose.translation.vector.y, pose.translation.vector.z), (0.0, 0.0));
        assert_eq!(pose.rotation.angle(), 0.0);
    }
}

#[test]
fn block_on_an_air_bearing_stops_against_a_wall_of_contact() {
    // A wall across x, friction along y: contact impulses enter the guided momentum.
    for integrator in ALL {
        let half = Vec3::new(0.1, 0.1, 0.05);
        let mut spec = spec(vec![(block(2.0, half), AIR_BEARING)], &Setup::new(integrator));
        let turn = spatial::Rot::from_scaled_axis(-std::f64::consts::FRAC_PI_2 * Vec3::y());
        let wall = shape("wall", None, Shape::HalfSpace);
        let pose_ls = Pose::from_parts(Vec3::new(0.15, 0.0, 0.0).into(), turn);
        spec.shapes =
            vec![sim::ShapeSpec { pose_ls, ..wall }, shape("box", Some(0), Shape::Cuboid { half_extents: half })];
        spec.pairs = vec![([0, 1], PairLaw::new(linear(1e4, 60.0), Some(bristle(0.3, 1e4, 20.0))))];
        let mut world = world(spec);
        world.set_base_twists(&[twist([0.0, 0.0, 0.5], [0.4, 0.2, 0.0])]);
        let start = Energy::of(&world).kinetic;
        run(&mut world, 1_000);
        let pose = world.state().bases[0];
        assert!(Energy::of(&world).kinetic < start, "{integrator:?}");
        assert!(world.kinematics(0).vel[0].lin.x < 0.0, "it has bounced");
        assert_eq!((pose.translation.vector.z, pose.rotation.i, pose.rotation.j), (0.0, 0.0, 0.0));
    }
}
