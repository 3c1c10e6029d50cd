//! Loads on one body in closed form: what drags, pulls, swings and shakes it.

use crate::support::{ALL, Setup, block, run, spec, twist, world};
use sim::{Axes, Base, BodyEffect, BodyLaw, Effect, EffectKind, Integrator, Load, ModelSpec, World};
use spatial::{Pose, Rot, Vec3};
use std::f64::consts::TAU;

/// kg.
const MASS: f64 = 12.0;
/// Half the edges of the body, m.
const HALF: [f64; 3] = [0.3, 0.2, 0.1];

/// An effect on vehicle 0's base.
pub(crate) fn effect(law: BodyLaw) -> Effect {
    Effect { name: format!("{law:?}"), kind: EffectKind::Body(BodyEffect::new(0, 0, law)) }
}

/// The usual block under a load, drifting and turning.
fn loaded(load: Load, setup: &Setup) -> World {
    let tree = block(MASS, Vec3::from(HALF));
    let effects = vec![effect(BodyLaw::Load(load))];
    let mut world = world(ModelSpec { effects, ..spec(vec![(tree, Base::Free)], setup) });
    world.set_base_twists(&[twist([0.0, 0.0, 0.5], [0.4, 0.0, 0.0])]);
    world
}

fn seconds(world: &mut World, time: f64) {
    let steps = (time / world.model().step).round() as usize;
    run(world, steps);
}

/// Relative error of an integrator over a few seconds at 1 ms, of a motion of about 1 /s.
fn tolerance(integrator: Integrator) -> f64 {
    match integrator {
        Integrator::RungeKutta4 => 1e-11,
        // Wrenches at the step's start: h/2 times the rate of the motion and the seconds.
        _ => 2e-3,
    }
}

#[test]
fn drag_slows_a_body_as_the_laws_say() {
    for integrator in ALL {
        let setup = Setup::new(integrator);
        let speed = |load| {
            let mut world = loaded(load, &setup);
            seconds(&mut world, 3.0);
            world.kinematics(0).vel[0].lin.norm()
        };
        let (c, v) = (5.0, 0.4);
        let linear = v * (-c * 3.0 / MASS).exp();
        let quadratic = v / (1.0 + c * v * 3.0 / MASS);
        assert!((speed(Load::LinearDrag { c }) / linear - 1.0).abs() < tolerance(integrator), "{integrator:?}");
        assert!((speed(Load::QuadraticDrag { c }) / quadratic - 1.0).abs() < tolerance(integrator), "{integrator:?}");
    }
}

#[test]
fn eddy_currents_stop_a_spin_exponentially() {
    let moment = MASS / 3.0 * (HALF[0] * HALF[0] + HALF[1] * HALF[1]);
    for integrator in ALL {
        let mut world = loaded(Load::AngularDamping { c: 0.2 }, &Setup::new(integrator));
        seconds(&mut world, 3.0);
        let spin = world.kinematics(0).vel[0].ang;
        let expected = 0.5 * (-0.2 * 3.0 / moment).exp();
        assert!((spin.z / expected - 1.0).abs() < tolerance(integrator) && spin.xy().norm() == 0.0, "{integrator:?}");
    }
}

#[test]
fn a_world_force_makes_a_parabola_and_a_body_force_a_circle() {
    for integrator in ALL {
        let setup = Setup::new(integrator);
        let vector = Vec3::new(0.0, 0.3, 0.0);
        let mut straight = loaded(Load::ConstantForce { vector, axes: Axes::World }, &setup);
        seconds(&mut straight, 4.0);
        let at = straight.state().bases[0].translation.vector;
        let expected = Vec3::new(1.6, 0.5 * 0.3 / MASS * 16.0, 0.0);
        assert!((at - expected).norm() < tolerance(integrator), "{integrator:?}");
        // Turning at 0.5 rad/s, a body force has turned once after 4π s and left no velocity behind.
        let mut turning = loaded(Load::ConstantForce { vector, axes: Axes::Body }, &setup);
        seconds(&mut turning, 2.0 * TAU);
        assert!((turning.kinematics(0).vel[0].lin - Vec3::new(0.4, 0.0, 0.0)).norm() < 1e-4, "{integrator:?}");
    }
}

#[test]
fn a_torque_about_a_principal_axis_spins_the_body_up() {
    let moment = MASS / 3.0 * (HALF[0] * HALF[0] + HALF[1] * HALF[1]);
    for (integrator, axes) in ALL.into_iter().zip([Axes::Body, Axes::World, Axes::Body, Axes::World]) {
        let load = Load::ConstantTorque { vector: Vec3::new(0.0, 0.0, 0.02), axes };
        let mut world = loaded(load, &Setup::new(integrator));
        seconds(&mut world, 3.0);
        let spin = world.kinematics(0).vel[0].ang.z;
        // The momentum takes the torque exactly, whatever the scheme.
        assert!((spin - 0.5 - 0.06 / moment).abs() < 1e-12, "{integrator:?}");
    }
}

#[test]
fn a_tilted_table_moves_every_vehicle_alike() {
    let tilt = Vec3::new(4e-4, -2.5e-4, 0.0);
    for integrator in ALL {
        let vehicles =
            [3.0, 40.0].map(|m| (block(m, Vec3::from(HALF)), Base::Only([false, false, true, true, true, false])));
        let effects = vec![Effect { name: "tilt".to_owned(), kind: EffectKind::Tilt(tilt) }];
        let mut world = world(ModelSpec { effects, ..spec(vehicles.to_vec(), &Setup::new(integrator)) });
        seconds(&mut world, 5.0);
        for base in &world.state().bases {
            assert!((base.translation.vector - 0.5 * 25.0 * tilt).norm() < 2e-6, "{integrator:?}");
        }
    }
}

#[test]
fn a_tether_swings_a_body_at_the_root_of_k_over_m() {
    for integrator in ALL {
        let load = Load::Tether { k: 30.0, d: 0.0, anchor: Vec3::zeros() };
        let mut world = loaded(load, &Setup::new(integrator));
        world.set_base_twists(&[twist([0.0; 3], [0.4, 0.0, 0.0])]);
        // A quarter of a period out: x = v/ω, at rest.
        let rate = (30.0 / MASS).sqrt();
        seconds(&mut world, 1.0 + (0.25 * TAU / rate - 1.0));
        let x = world.state().bases[0].translation.vector.x;
        // The step count rounds the time to h/2: second order at the turning point.
        assert!((x - 0.4 / rate).abs() < 1e-3 * x, "{integrator:?}: {x}");
    }
}

#[test]
fn a_pump_shakes_a_body_at_its_frequency() {
    let (amplitude, f) = (2.0, 0.5);
    let rate = TAU * f;
    for integrator in ALL {
        let load = |is_force| Load::Periodic { amplitude: amplitude * Vec3::z(), is_force, rate, phase: 0.0 };
        let mut world = loaded(load(true), &Setup::new(integrator));
        seconds(&mut world, 1.0);
        // v = A/(m ω) (1 − cos ωt), after half a period.
        let v = world.kinematics(0).vel[0].lin.z;
        assert!((v - 2.0 * amplitude / (MASS * rate)).abs() < 1e-5, "{integrator:?}: {v}");
        assert!(world.kinematics(0).vel[0].ang.xy().norm() < 1e-12);
        let mut turned = loaded(load(false), &Setup::new(integrator));
        seconds(&mut turned, 1.0);
        assert!(turned.kinematics(0).vel[0].ang.z > 0.5 && turned.kinematics(0).vel[0].lin.z == 0.0);
    }
}

#[test]
fn gravity_gradient_swings_a_long_body_with_the_libration_frequency() {
    // Pitch: ω = n √(3 (I_y − I_x)/I_z), x radial (Hughes 1986, 9.2); the axes of W do not turn.
    let n = 0.5;
    let tree = block(10.0, Vec3::new(1.0, 0.2, 0.3));
    let moments = tree.bodies[0].inertia.rot.diagonal();
    let effects = vec![effect(BodyLaw::Load(Load::GravityGradient { mean_motion: n }))];
    let setup = Setup::new(Integrator::RungeKutta4).step(1e-2);
    let mut world = world(ModelSpec { effects, ..spec(vec![(tree, Base::Free)], &setup) });
    world.state_mut().bases[0].rotation = Rot::from_scaled_axis(1e-3 * Vec3::z());
    world.set_base_twists(&[twist([0.0, 0.0, n], [0.0; 3])]);
    let libration = n * (3.0 * (moments.y - moments.x) / moments.z).sqrt();
    // Ten periods on, the pitch is what it was; a quarter more, and it is zero.
    for (periods, expected) in [(10.0, 1.0), (10.25, 0.0)] {
        let left = periods * TAU / libration - world.state().time;
        seconds(&mut world, left);
        let t = world.state().time;
        let axis = world.state().bases[0].rotation * Vec3::x();
        let pitch = (axis.y.atan2(axis.x) - n * t + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
        // Time rounds to the step: 5 ms at 0.8 rad/s.
        assert!((pitch - 1e-3 * expected).abs() < 1e-5, "pitch {pitch} after {periods} periods");
    }
}

/// The end of a short tumble under loads.
fn end(loads: &[Load], integrator: Integrator) -> String {
    let tree = block(MASS, Vec3::from(HALF));
    let effects = loads.iter().map(|l| effect(BodyLaw::Load(*l))).collect();
    let mut world = world(ModelSpec { effects, ..spec(vec![(tree, Base::Free)], &Setup::new(integrator)) });
    world.state_mut().bases[0] = Pose::translation(3.0, 2.0, 1.0);
    world.set_base_twists(&[twist([0.3, 0.5, -0.2], [0.1, 0.0, 0.2])]);
    run(&mut world, 200);
    // As text: a zero with the other sign is another bit.
    format!("{:?}", (world.state().bases[0], world.kinematics(0).vel[0], world.state().momentum[0]))
}

#[test]
fn neutral_loads_change_no_bit_and_beside_neutral_they_do() {
    let loads = |x: f64| {
        let vector = Vec3::new(x, 0.0, x);
        [
            Load::ConstantForce { vector, axes: Axes::Body },
            Load::ConstantTorque { vector, axes: Axes::World },
            Load::LinearDrag { c: x },
            Load::QuadraticDrag { c: x },
            Load::AngularDamping { c: x },
            // The torque goes with n²; at 1e-6 rad/s it is 1e-13 N·m and below the bits of L.
            Load::GravityGradient { mean_motion: 1e3 * x },
            Load::Tether { k: x, d: 0.0, anchor: Vec3::zeros() },
            Load::Tether { k: 0.0, d: x, anchor: Vec3::zeros() },
            Load::Periodic { amplitude: vector, is_force: true, rate: 1.0, phase: 0.5 },
            Load::Periodic { amplitude: vector, is_force: false, rate: 1.0, phase: 0.5 },
        ]
    };
    for integrator in ALL {
        let nominal = end(&[], integrator);
        assert_eq!(end(&loads(0.0), integrator), nominal, "{integrator:?}");
        for load in loads(1e-6) {
            assert_ne!(end(&[load], integrator), nominal, "{integrator:?}: {load:?}");
        }
    }
}
