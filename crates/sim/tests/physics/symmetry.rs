//! The laws of motion do not care where, how fast, which way up or in which order a world is described.

use crate::support::scenes::{
    box_hits_plate_spec, gripper_spec, pad_gripper_spec, start_box_hits_plate, start_gripper,
};
use crate::support::{ALL, Setup, arm7, free_world, run, twist, world};
use sim::{Integrator, ModelSpec, World};
use spatial::{Pose, Rot, Twist, Vec3};

/// Round-off of some hundred steps, grown by impacts.
const ROUND_OFF: f64 = 1e-9;
/// What a turn of the world, or the exchange of a pair's bodies, may change: nothing but round-off, m and rad.
const TURNED: f64 = 1e-12;

/// A scene by their spec and start.
type Scene = (fn(&Setup) -> ModelSpec, fn(&mut World));
const SCENES: [Scene; 3] =
    [(gripper_spec, start_gripper), (box_hits_plate_spec, start_box_hits_plate), (pad_gripper_spec, start_gripper)];

fn twists(world: &World) -> [Twist; 2] {
    [0, 1].map(|i| world.kinematics(i).vel[0])
}

/// Pose of the second vehicle in the first one's base frame.
fn relative(world: &World) -> Pose {
    world.state().bases[0].inverse() * world.state().bases[1]
}

fn distance(a: &Pose, b: &Pose) -> f64 {
    (a.translation.vector - b.translation.vector).norm() + a.rotation.rotation_to(&b.rotation).scaled_axis().norm()
}

/// Runs a scene as it is and as `change` leaves its start, and compares how the vehicles lie to each other.
fn compare(tolerance: impl Fn(Integrator) -> f64, change: impl Fn(&mut World)) {
    for integrator in ALL {
        for (scene, (spec, start)) in SCENES.into_iter().enumerate() {
            let [plain, changed] = [false, true].map(|is_changed| {
                let mut world = world(spec(&Setup::new(integrator)));
                start(&mut world);
                if is_changed {
                    change(&mut world);
                }
                run(&mut world, 400);
                assert!(!world.state().bristles.is_empty() || scene == 1);
                relative(&world)
            });
            let off = distance(&plain, &changed);
            println!("{integrator:?}, scene {scene}: {off:.1e}");
            assert!(off < tolerance(integrator));
        }
    }
}

#[test]
fn drifting_world_shows_the_same_contact() {
    // The frame of the box at its start: now the half-spaces move and the box waits.
    // Runge–Kutta's stages take L and x × p with their own errors: invariant to its order only.
    let tolerance = |i| if i == Integrator::RungeKutta4 { 1e-5 } else { ROUND_OFF };
    compare(tolerance, |world| {
        let [a, b] = twists(world);
        let drift = b.lin;
        world.set_base_twists(&[Twist::new(a.ang, a.lin - drift), Twist::new(b.ang, b.lin - drift)]);
    });
}

#[test]
fn fast_flight_does_not_change_how_a_body_turns() {
    // 100 m/s past the origin: L is mostly x × p, and the spin is what is left of it.
    for (integrator, spin) in ALL.into_iter().flat_map(|i| [(i, 0.3), (i, 2.0)]) {
        let fly = |speed: f64| {
            let mut world = free_world(arm7(), &Setup::new(integrator));
            world.state_mut().v.copy_from_slice(&[0.4, -0.5, 0.6, 0.8, -1.0, 0.9, 0.7]);
            world.set_base_twists(&[twist([0.0, 0.1, spin], [speed, 0.0, 0.0])]);
            run(&mut world, 5_000);
            world.state().bases[0].rotation
        };
        let off = fly(0.0).rotation_to(&fly(100.0)).angle();
        println!("{integrator:?}, {spin} rad/s: turned by {off:.1e} rad less or more at 100 m/s");
        assert!(off < 1e-8);
    }
}

#[test]
fn turned_and_shifted_world_shows_the_same_contact() {
    compare(
        |_| TURNED,
        |world| {
            let turn =
                Pose::from_parts(Vec3::new(2.0, -1.0, 3.0).into(), Rot::from_scaled_axis(Vec3::new(0.5, -1.1, 0.7)));
            let moved = twists(world).map(|t| Twist::new(turn * t.ang, turn * t.lin));
            for pose in &mut world.state_mut().bases {
                *pose = turn * *pose;
            }
            world.set_base_twists(&moved);
        },
    );
}

#[test]
fn order_of_pairs_does_not_matter() {
    for integrator in ALL {
        let [one, other] = [false, true].map(|reverse| {
            let mut spec = gripper_spec(&Setup::new(integrator));
            if reverse {
                spec.pairs.reverse();
            }
            let mut world = world(spec);
            start_gripper(&mut world);
            run(&mut world, 400);
            relative(&world)
        });
        assert!(distance(&one, &other) < ROUND_OFF, "{integrator:?}");
    }
}

#[test]
fn order_of_vehicles_does_not_matter() {
    for integrator in ALL {
        let setup = Setup::new(integrator);
        let mut plain = world(box_hits_plate_spec(&setup));
        start_box_hits_plate(&mut plain);
        let mut spec = box_hits_plate_spec(&setup);
        spec.vehicles.reverse();
        for shape in &mut spec.shapes {
            shape.vehicle = shape.vehicle.map(|v| 1 - v);
        }
        let mut swapped = world(spec);
        let [a, b] = twists(&plain);
        swapped.state_mut().bases = plain.state().bases.iter().rev().copied().collect();
        swapped.set_base_twists(&[b, a]);
        run(&mut plain, 400);
        run(&mut swapped, 400);
        let off = distance(&relative(&plain), &relative(&swapped).inverse());
        println!("{integrator:?}: {off:.1e}");
        assert!(off < ROUND_OFF);
    }
}

#[test]
fn swapping_the_bodies_of_a_pair_changes_no_force() {
    // A bristle turns with the mean of both bodies, and every sum over a pair is antisymmetric.
    for integrator in ALL {
        let [one, other] = [false, true].map(|swap| {
            let mut spec = gripper_spec(&Setup::new(integrator));
            if swap {
                spec.pairs.iter_mut().for_each(|(pair, _)| pair.reverse());
            }
            let mut world = world(spec);
            start_gripper(&mut world);
            run(&mut world, 400);
            relative(&world)
        });
        let off = distance(&one, &other);
        println!("{integrator:?}: {off:.1e}");
        assert!(off < TURNED);
    }
}
