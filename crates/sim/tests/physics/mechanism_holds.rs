//! Bushings and welds against closed forms: the six natural frequencies, deflection under load, strength.

use crate::support::mechanisms::{HALF, at, ground, mechanism, tied_block, two_blocks};
use crate::support::{ALL, Setup, block, run, spec, twist, world};
use sim::{
    Actuator, ActuatorKind, Base, Bushing, Command, Integrator, MechanismKind, MechanismStatus, ModelSpec, Strength,
    Weld, World,
};
use spatial::{Pose, Rot, Twist, Vec3};

/// Mass and principal moments of the block of 2 kg.
fn inertias() -> [f64; 6] {
    let [x, y, z] = HALF.map(|e| e * e);
    let third = 2.0 / 3.0;
    [third * (y + z), third * (x + z), third * (x + y), 2.0, 2.0, 2.0]
}

/// A bushing with six different springs.
fn six_springs() -> Bushing {
    Bushing {
        stiffness: Vec3::new(200.0, 500.0, 900.0),
        torsional_stiffness: Vec3::new(5.0, 9.0, 14.0),
        ..Bushing::default()
    }
}

#[test]
fn bushing_has_its_six_natural_frequencies() {
    let springs = [5.0, 9.0, 14.0, 200.0, 500.0, 900.0];
    for axis in 0..6 {
        let mut world = tied_block(MechanismKind::Bushing(six_springs()), &Setup::new(Integrator::RungeKutta4));
        let mut kick = [0.0; 6];
        kick[axis] = 1e-3;
        world.set_base_twists(&[twist([kick[0], kick[1], kick[2]], [kick[3], kick[4], kick[5]])]);
        let rate = (springs[axis] / inertias()[axis]).sqrt();
        let mut worst = 0.0_f64;
        for _ in 0..3_000 {
            run(&mut world, 1);
            let e = world.mechanisms().next().unwrap().deformation;
            let exact = 1e-3 / rate * (rate * world.state().time).sin();
            worst = worst.max((e[axis] - exact).abs() * rate / 1e-3);
            let others = (0..6).filter(|i| *i != axis).map(|i| e[i].abs()).fold(0.0, f64::max);
            assert!(others < 1e-12, "axis {axis} moves another: {others:e}");
        }
        println!("axis {axis}: {:.2} rad/s, error {worst:.1e} of the amplitude after 3 s", rate);
        // RK4 at h ω ≤ 0.04: phase error (hω)⁴/120 per radian.
        assert!(worst < 1e-5);
    }
}

#[test]
fn damped_bushing_decays_as_its_ratio_says() {
    // Sphere-like body: all six at the same frequency, by the constructor from frequency and ratio.
    for integrator in ALL {
        let hold = Bushing::from_frequency(2.0, 0.1, [f64::INFINITY, 2.0], [f64::INFINITY, 2.0 / 3.0 * 0.02]);
        let tie = mechanism("tie", ground(Pose::identity()), at(0, 0.0, 0.0, 0.0), MechanismKind::Bushing(hold));
        let body = block(2.0, Vec3::repeat(0.1));
        let setup = Setup::new(integrator).step(1e-4);
        let mut world = world(ModelSpec { mechanisms: vec![tie], ..spec(vec![(body, Base::Free)], &setup) });
        world.set_base_twists(&[twist([0.02, 0.0, 0.0], [0.03, 0.0, 0.0])]);
        run(&mut world, 10_000);
        let rate = std::f64::consts::TAU * 2.0;
        let (decay, damped) = (0.1 * rate, rate * (1.0 - 0.01_f64).sqrt());
        let shape = (-decay).exp() * damped.sin() / damped;
        let e = world.mechanisms().next().unwrap().deformation;
        let off = (e[0] - 0.02 * shape).abs().max((e[3] - 0.03 * shape).abs());
        println!("{integrator:?}: {off:.1e}");
        // First order: ω² h t / 2 of the amplitude of 2 mm · e^−1.26.
        assert!(off < if integrator == Integrator::RungeKutta4 { 1e-11 } else { 1e-5 }, "{integrator:?}: {off:e}");
    }
}

/// A plate welded to the world at an offset, with a jet that pushes it along its own x axis.
fn pushed(weld: Weld, integrator: Integrator) -> World {
    let place = Pose::from_parts(Vec3::new(0.4, 0.1, -0.2).into(), Rot::from_scaled_axis(Vec3::new(0.3, -0.8, 0.2)));
    let foot = ground(place * Pose::translation(0.05, 0.0, 0.0));
    let tie = mechanism("weld", foot, at(0, 0.05, 0.0, 0.0), MechanismKind::Weld(weld));
    let kind =
        ActuatorKind::Thruster { body: 0, position: Vec3::new(0.05, 0.0, 0.0), direction: Vec3::x(), max_force: 1e3 };
    let mut spec = spec(vec![(block(2.0, Vec3::from(HALF)), Base::Free)], &Setup::new(integrator));
    spec.mechanisms = vec![tie];
    spec.actuators = vec![Actuator { name: "jet".to_owned(), kind }];
    let mut world = world(spec);
    world.state_mut().bases[0] = place;
    world.rest_mechanism(0);
    world
}

fn push(world: &mut World, force: f64, steps: usize) {
    world.commands_mut()[0] = Command { effort: force, ..Command::default() };
    run(world, steps);
}

#[test]
fn weld_deflects_by_force_over_stiffness_and_rests_where_it_was_made() {
    for integrator in ALL {
        let hold = Bushing::isotropic([2e4, 400.0], [500.0, 8.0]);
        let mut world = pushed(Weld { hold, strength: Strength::default() }, integrator);
        let place = world.state().bases[0];
        run(&mut world, 100);
        let stored = world.mechanisms().next().unwrap().stored;
        assert!(stored < 1e-25, "{integrator:?}: a weld stores nothing at rest: {stored:e} J");
        push(&mut world, 30.0, 3_000);
        let moved = world.state().bases[0].translation.vector - place.translation.vector;
        let exact = place.rotation * Vec3::x() * (30.0 / 2e4);
        assert!((moved - exact).norm() < 1e-12, "{integrator:?}: {moved:?}");
        let load = world.mechanisms().next().unwrap().wrench_w.force.norm();
        assert!((load - 30.0).abs() < 1e-8, "{integrator:?}: {load}");
    }
}

#[test]
fn hard_weld_is_stable_at_a_millisecond() {
    for integrator in [Integrator::ImplicitEuler, Integrator::ImplicitMidpoint] {
        let hold = Bushing::isotropic([1e7, 0.0], [1e6, 0.0]);
        let mut world = pushed(Weld { hold, strength: Strength::default() }, integrator);
        world.set_base_twists(&[twist([0.3, -0.5, 0.2], [0.5, 0.2, -0.1])]);
        push(&mut world, 500.0, 3_000);
        let e = world.mechanisms().next().unwrap().deformation;
        let [phi, p] = [Vec3::new(e[0], e[1], e[2]), Vec3::new(e[3], e[4], e[5])];
        println!("{integrator:?}: {:.2e} rad, {:.2e} m, {:?}", phi.norm(), p.norm(), world.state().work);
        assert!(phi.norm() < 1e-9 && (p.norm() - 5e-5).abs() < 1e-9, "{integrator:?}: {e:?}");
        assert_eq!(world.state().work.unconverged_steps, 0);
    }
}

#[test]
fn weld_holds_below_its_strength_and_breaks_above() {
    for integrator in ALL {
        let weld = Weld {
            hold: Bushing::isotropic([2e4, 400.0], [500.0, 8.0]),
            strength: Strength { force: 50.0, moment: f64::INFINITY },
        };
        let mut world = pushed(weld, integrator);
        for k in 1..=49_u8 {
            push(&mut world, f64::from(k), 40);
        }
        push(&mut world, 49.0, 2_000);
        assert_eq!(world.mechanisms().next().unwrap().status, MechanismStatus::Engaged, "{integrator:?}");
        push(&mut world, 51.0, 2_000);
        let report = world.mechanisms().next().unwrap();
        assert_eq!(report.status, MechanismStatus::Broken, "{integrator:?}");
        assert!(report.since > 3.9 && world.kinematics(0).vel[0].lin.norm() > 10.0, "{integrator:?}: it flies");
    }
}

#[test]
fn strut_within_one_vehicle_closes_a_loop() {
    // Two arms on one base, their tips tied by a hard strut: a parallelogram, which swings as one.
    use crate::support::{joint, link, robot};
    use multibody::JointKind;
    use sim::{Anchor, MomentumAudit, Strut};
    for integrator in ALL {
        let arm = |name| link(name, 1.0, Vec3::new(0.0, 0.0, 0.2), Vec3::repeat(0.02));
        let base = link("base", 10.0, Vec3::zeros(), Vec3::repeat(0.5));
        let turn = |name, x| joint(name, 0, Vec3::new(x, 0.0, 0.1), Vec3::y(), JointKind::Revolute);
        let tree = robot(vec![base, arm("left"), arm("right")], vec![turn("l", -0.2), turn("r", 0.2)]);
        let tip = |link| Anchor { vehicle: Some(0), link, pose_la: Pose::translation(0.0, 0.0, 0.4) };
        let strut = Strut { rest_length: 0.4, stiffness: 2e4, damping: 50.0, ..Strut::default() };
        let bar = mechanism("bar", tip(1), tip(2), MechanismKind::Strut(strut));
        let mut spec = spec(vec![(tree, Base::Free)], &Setup::new(integrator).step(2e-4));
        spec.mechanisms = vec![bar];
        let mut world = world(spec);
        world.state_mut().v.copy_from_slice(&[0.4, 0.0]);
        world.set_base_twists(&[Twist::default()]);
        let mut audit = MomentumAudit::new(&world);
        run(&mut world, 2_500);
        audit.update(&world);
        let [left, right] = [world.state().q[0], world.state().q[1]];
        let gap = (world.mechanisms().next().unwrap().deformation[0] - 0.4).abs();
        println!("{integrator:?}: {left:.4} and {right:.4} rad, gap {gap:.1e} m, drift {:.1e}", audit.angular_drift);
        assert!(left > 0.05 && (left - right).abs() < 1e-2 * left && gap < 1e-3, "{integrator:?}");
        assert!(audit.linear_drift < 1e-12 && audit.angular_drift < 1e-12, "{integrator:?}");
    }
}

#[test]
fn bushing_on_a_guided_base_acts_only_where_the_guide_lets_it() {
    for integrator in ALL {
        let tie =
            mechanism("tie", ground(Pose::identity()), at(0, 0.0, 0.0, 0.0), MechanismKind::Bushing(six_springs()));
        let rail = Base::Only([false, false, false, true, false, false]);
        let setup = Setup::new(integrator).step(1e-4);
        let mut world =
            world(ModelSpec { mechanisms: vec![tie], ..spec(vec![(block(2.0, Vec3::from(HALF)), rail)], &setup) });
        world.state_mut().bases[0] = Pose::translation(0.01, 0.02, 0.0);
        run(&mut world, 5_000);
        let p = world.state().bases[0].translation.vector;
        let exact = 0.01 * (10.0_f64 * 0.5).cos();
        assert_eq!((p.y, p.z), (0.02, 0.0));
        // First order: ω² h t/2 = 0.25 % of 10 mm.
        assert!((p.x - exact).abs() < 4e-5, "{integrator:?}: {} against {exact}", p.x);
    }
}

#[test]
fn two_bodies_on_a_bushing_swing_about_their_common_centre() {
    let tie = mechanism("tie", at(0, 0.0, 0.0, 0.0), at(1, 0.0, 0.0, 0.0), MechanismKind::Bushing(six_springs()));
    let mut world = two_blocks([2.0, 6.0], vec![tie], &Setup::new(Integrator::RungeKutta4));
    world.set_base_twists(&[twist([0.0; 3], [0.0, 0.03, 0.0]), twist([0.0; 3], [0.0, -0.01, 0.0])]);
    run(&mut world, 1_000);
    let rate = (500.0_f64 / 1.5).sqrt();
    let exact = -0.04 / rate * rate.sin();
    let gap = world.mechanisms().next().unwrap().deformation[4];
    assert!((gap - exact).abs() < 1e-8, "{gap} against {exact}");
}
