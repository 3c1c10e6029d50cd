//! Determinism, bit for bit: the same run again, any thread, snapshot and resume; and no allocation in a step.

use crate::support::scenes::{
    box_hits_plate, gripper, gripper_spec, gripper_twists, pad_gripper, place_gripper, shower, shower_of, start_gripper,
};
use crate::support::{ALL, Setup, arm7, run, spec, twist, world};
use sim::{Actuator, ActuatorKind, Base, Integrator, Model, State, World};
use spatial::Pose;
use std::sync::Arc;

/// All bits of a state; equal for equal states only (`==` would let 0 = −0 pass).
fn bits(state: &State) -> String {
    serde_json::to_string(state).unwrap()
}

/// The worlds that have memory of every kind: bristles that stick and slide, drives, tumbling bases.
fn worlds(setup: &Setup) -> [World; 4] {
    [gripper(setup), box_hits_plate(setup), pad_gripper(setup), shower(setup)]
}

#[test]
fn same_run_again_gives_the_same_bits() {
    for integrator in ALL {
        let [first, second] = [(), ()].map(|()| {
            worlds(&Setup::new(integrator)).map(|mut world| {
                run(&mut world, 2_000);
                bits(world.state())
            })
        });
        assert_eq!(first, second, "{integrator:?}");
    }
}

#[test]
fn resuming_from_a_snapshot_repeats_the_uninterrupted_run() {
    for integrator in ALL {
        for (scene, mut world) in worlds(&Setup::new(integrator)).into_iter().enumerate() {
            // Fingers closing, first touch, sliding, holding; flight, impact.
            for pause in [40, 60, 65, 137, 700] {
                run(&mut world, pause);
                let mut resumed = World::new(world.model().clone(), world.state().clone());
                run(&mut world, 100);
                run(&mut resumed, 100);
                assert_eq!(bits(world.state()), bits(resumed.state()), "{integrator:?}, scene {scene}");
            }
        }
    }
}

#[test]
fn snapshot_through_a_file_repeats_the_uninterrupted_run() {
    for integrator in ALL {
        let mut world = gripper(&Setup::new(integrator));
        run(&mut world, 300);
        assert!(!world.state().bristles.is_empty(), "the snapshot is taken in contact");
        let written = serde_json::to_string(world.state()).unwrap();
        let read: State = serde_json::from_str(&written).unwrap();
        assert_eq!(bits(&read), written);
        let mut resumed = World::new(world.model().clone(), read);
        run(&mut world, 500);
        run(&mut resumed, 500);
        assert_eq!(bits(world.state()), bits(resumed.state()), "{integrator:?}");
    }
}

#[test]
fn without_books_everything_moves_to_the_same_bits() {
    for integrator in ALL {
        let setup = Setup::new(integrator);
        for (scene, (mut kept, plain)) in worlds(&setup).into_iter().zip(worlds(&setup)).enumerate() {
            let mut plain = plain.without_books();
            run(&mut kept, 1_000);
            run(&mut plain, 1_000);
            assert!(plain.state().works.iter().all(|w| *w == 0.0), "{integrator:?}, scene {scene}: no work is booked");
            let mut moved = kept.state().clone();
            assert_ne!(bits(&moved), bits(plain.state()), "{integrator:?}, scene {scene}: the other world has books");
            (moved.account, moved.works) = (plain.state().account, plain.state().works.clone());
            assert_eq!(bits(&moved), bits(plain.state()), "{integrator:?}, scene {scene}");
        }
    }
}

#[test]
fn looking_at_a_world_changes_no_bit() {
    for integrator in ALL {
        let (mut watched, mut alone) = (gripper(&Setup::new(integrator)), gripper(&Setup::new(integrator)));
        for _ in 0..500 {
            run(&mut watched, 1);
            run(&mut alone, 1);
            // `state_mut` asks for a refresh of everything that follows from the state.
            watched.state_mut();
            watched.refresh();
            let (_, _) = (sim::Energy::of(&watched), watched.touches().count());
        }
        assert_eq!(bits(watched.state()), bits(alone.state()), "{integrator:?}");
    }
}

#[test]
fn threads_that_share_a_model_give_the_same_bits() {
    for integrator in ALL {
        let model = Arc::new(Model::build(gripper_spec(&Setup::new(integrator))).unwrap());
        let simulate = |twist_z: f64| {
            let mut world = World::new(model.clone(), State::new(&model));
            start_gripper(&mut world);
            world.state_mut().momentum[1].moment.z += twist_z;
            run(&mut world, 500);
            bits(world.state())
        };
        let alone: Vec<_> = (0..6).map(|i| simulate(1e-3 * f64::from(i))).collect();
        let together: Vec<_> = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..6).map(|i| scope.spawn(move || simulate(1e-3 * f64::from(i)))).collect();
            threads.into_iter().map(|t| t.join().unwrap()).collect()
        });
        assert_eq!(alone, together, "{integrator:?}");
        assert_ne!(alone[0], alone[1], "the runs differ from each other");
    }
}

#[test]
fn model_built_again_from_the_same_spec_gives_the_same_bits() {
    let [first, second] = [(), ()].map(|()| {
        let mut world = world(gripper_spec(&Setup::new(Integrator::ImplicitEuler)));
        start_gripper(&mut world);
        run(&mut world, 1_000);
        bits(world.state())
    });
    assert_eq!(first, second);
}

/// A vehicle far away that touches nothing: islands are solved one by one, so it must not show.
#[test]
fn bystander_changes_no_bit_of_the_others() {
    for integrator in ALL {
        let mut alone = gripper(&Setup::new(integrator));
        let mut spec_with = gripper_spec(&Setup::new(integrator));
        spec_with.vehicles.push(sim::VehicleSpec { name: "bystander".to_owned(), tree: arm7(), base: Base::Free });
        let mut with = world(spec_with);
        with.state_mut().bases[2] = Pose::translation(50.0, 0.0, 0.0);
        place_gripper(&mut with);
        let [grip, held] = gripper_twists();
        with.set_base_twists(&[grip, held, twist([0.1, 0.2, 0.3], [0.0; 3])]);
        run(&mut alone, 1_000);
        run(&mut with, 1_000);
        assert_eq!(alone.state().bases[..], with.state().bases[..2], "{integrator:?}");
        assert_eq!(alone.state().momentum[..], with.state().momentum[..2], "{integrator:?}");
        assert_eq!(alone.state().bristles, with.state().bristles, "{integrator:?}");
    }
}

/// Hulls and meshes are asked of parry3d, which allocates; every other pair has its own code.
const PRIMITIVES: usize = 4;

#[test]
fn step_allocates_nothing() {
    for integrator in ALL {
        let mut spec_arm = spec(vec![(arm7(), Base::Free)], &Setup::new(integrator));
        let kind = ActuatorKind::JointDrive { coordinate: 3, stiffness: 40.0, damping: 8.0, limit: 30.0 };
        spec_arm.actuators = vec![Actuator { name: "drive".to_owned(), kind }];
        let arm = world(spec_arm);
        let [gripper, plate, pads, _] = worlds(&Setup::new(integrator));
        let flying = shower_of(&Setup::new(integrator), PRIMITIVES);
        for (scene, mut world) in [gripper, plate, pads, flying, arm].into_iter().enumerate() {
            // Warm-up: lists of contact points grow to their size.
            run(&mut world, 500);
            let counted = allocation_counter::measure(|| run(&mut world, 500));
            assert_eq!(counted.count_total, 0, "{integrator:?}, scene {scene}: {} bytes", counted.bytes_total);
        }
    }
}
