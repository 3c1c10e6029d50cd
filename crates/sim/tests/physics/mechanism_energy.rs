//! The energy account of mechanisms: closed for smooth laws by RK4, one-sided for every integrator; and determinism.

use crate::support::mechanisms::{at, calc_total, mechanism, struck_ring, two_blocks};
use crate::support::{ALL, Setup, run, twist, world};
use sim::{Bushing, Energy, EnergyAudit, Integrator, MechanismKind, Strength, Strut, StrutSides, World};
use spatial::{Pose, Rot, Vec3};

/// A bushing with no equal springs, all damped.
fn uneven() -> Bushing {
    Bushing {
        stiffness: Vec3::new(150.0, 400.0, 900.0),
        damping: Vec3::new(2.0, 1.0, 3.0),
        torsional_stiffness: Vec3::new(8.0, 3.0, 15.0),
        torsional_damping: Vec3::new(0.05, 0.1, 0.02),
    }
}

/// Two blocks on an uneven bushing, far from rest: half a radian and 50 mm off, turning.
fn swinging(hold: Bushing, setup: &Setup) -> World {
    let tie = mechanism("tie", at(0, 0.1, 0.0, 0.05), at(1, -0.1, 0.02, 0.0), MechanismKind::Bushing(hold));
    let mut world = two_blocks([2.0, 3.0], vec![tie], setup);
    let turn = Rot::from_scaled_axis(Vec3::new(0.3, -0.35, 0.2));
    world.state_mut().bases[1] = Pose::from_parts(Vec3::new(0.23, -0.04, 0.06).into(), turn);
    world.set_base_twists(&[twist([0.5, -0.3, 0.2], [0.1, 0.2, -0.1]), twist([-0.4, 0.6, 1.0], [-0.2, 0.0, 0.3])]);
    world
}

#[test]
fn bushing_far_from_rest_closes_its_energy_to_the_order_of_rk4() {
    let drift = |h: f64, hold: Bushing| {
        let mut world = swinging(hold, &Setup::new(Integrator::RungeKutta4).step(h));
        let (start, stored) = (calc_total(&world), Energy::of(&world).mechanism);
        assert!(stored > 0.5, "{stored} J to begin with");
        run(&mut world, (1.0 / h).round() as usize);
        (calc_total(&world) - start) / start
    };
    let elastic = Bushing { damping: Vec3::zeros(), torsional_damping: Vec3::zeros(), ..uneven() };
    for hold in [uneven(), elastic] {
        let (coarse, fine) = (drift(2e-3, hold), drift(2e-4, hold));
        println!("energy drift {coarse:.1e} at 2 ms, {fine:.1e} at 0.2 ms");
        assert!(fine.abs() < 1e-10, "{fine:e}");
        assert!(coarse.abs() > 1e2 * fine.abs(), "the drift is the integrator's: {coarse:e}, {fine:e}");
    }
}

/// Two-sided, within its stroke: smooth.
fn smooth() -> Strut {
    Strut { rest_length: 0.35, stiffness: 600.0, damping: 60.0, preload: -15.0, ..Strut::default() }
}

#[test]
fn six_struts_close_their_energy_with_rk4_at_a_small_step() {
    let mut world = struck_ring(smooth(), &Setup::new(Integrator::RungeKutta4).step(1e-4));
    let start = calc_total(&world);
    run(&mut world, 10_000);
    let (off, account) = ((calc_total(&world) - start) / start, world.state().account);
    println!("{off:.1e} of {start:.3} J, dissipated {:.3} J", account.mechanism_loss);
    assert!(off.abs() < 1e-10, "{off:e}");
    assert!(account.mechanism_loss > 0.2);
}

#[test]
fn stops_and_one_sided_struts_close_their_energy_to_their_kinks() {
    // Piecewise smooth: RK4 loses its order where a stop or the slack begins; 0.1 ms.
    for sides in [StrutSides::PushOnly, StrutSides::PullOnly] {
        let strut = Strut { sides, stroke: [0.33, 0.37], stop_stiffness: 1e4, stop_dissipation: 0.5, ..smooth() };
        let mut world = struck_ring(strut, &Setup::new(Integrator::RungeKutta4).step(1e-4));
        let start = calc_total(&world);
        run(&mut world, 10_000);
        let off = (calc_total(&world) - start) / start;
        println!("{sides:?}: {off:.1e}");
        assert!(off.abs() < 1e-6, "{off:e}");
    }
}

#[test]
fn what_an_implicit_step_takes_is_its_numerical_loss() {
    for integrator in ALL {
        let mut world = struck_ring(smooth(), &Setup::new(integrator));
        let (mut audit, total) = (EnergyAudit::new(&world), calc_total(&world));
        run(&mut world, 2_000);
        let damped = total - calc_total(&world);
        println!("{integrator:?}: damped by the integrator {damped:.1e} J of {total:.2} J");
        assert!((audit.close(&world).numerical_loss - damped).abs() < 1e-14 * total, "{integrator:?}");
        if integrator == Integrator::ImplicitEuler {
            assert!(damped > 0.0, "{damped:e}");
        }
    }
}

#[test]
fn hard_bushing_with_implicit_euler_never_gains_energy() {
    let hold = Bushing::isotropic([1e7, 0.0], [1e6, 0.0]);
    let tie = mechanism("tie", at(0, 0.1, 0.0, 0.0), at(1, -0.1, 0.0, 0.0), MechanismKind::Bushing(hold));
    let mut world = two_blocks([2.0, 3.0], vec![tie], &Setup::new(Integrator::ImplicitEuler));
    world.state_mut().bases[1] = Pose::translation(0.2, 0.0, 0.0);
    world.set_base_twists(&[twist([0.1, -0.2, 0.2], [0.1, 0.0, 0.0]), twist([-0.1, 0.3, 0.0], [-0.1, 0.1, 0.0])]);
    let energy = |w: &World| Energy::of(w).kinetic + Energy::of(w).mechanism;
    let mut last = energy(&world);
    for _ in 0..5_000 {
        run(&mut world, 1);
        let now = energy(&world);
        // A turning pair: energy from momentum at the new pose is second order in ω h.
        assert!(now < last * (1.0 + 1e-6), "{now} J after {last} J");
        last = now;
    }
    assert_eq!(world.state().work.unconverged_steps, 0);
}

#[test]
fn run_with_mechanisms_repeats_its_bits_and_allocates_nothing() {
    let strut = Strut { stroke: [0.33, 0.37], stop_stiffness: 1e4, stop_dissipation: 0.5, ..smooth() };
    for integrator in ALL {
        let [mut one, mut other] = [0, 1].map(|_| struck_ring(strut, &Setup::new(integrator)));
        run(&mut one, 300);
        run(&mut other, 300);
        assert_eq!(one.state(), other.state(), "{integrator:?}");
        let counted = allocation_counter::measure(|| run(&mut one, 200));
        assert_eq!(counted.count_total, 0, "{integrator:?}: {} bytes", counted.bytes_total);
    }
}

#[test]
fn idle_latch_far_away_changes_no_bit() {
    use crate::support::scenes::{gripper, gripper_spec, start_gripper};
    for integrator in ALL {
        let setup = Setup::new(integrator);
        let mut plain = gripper(&setup);
        let mut spec = gripper_spec(&setup);
        let capture = sim::Capture {
            axial: [0.0, 0.01],
            lateral: 0.01,
            tilt: 0.1,
            roll: 0.1,
            closing_speed: [-1.0, 1.0],
            dwell: 0.0,
        };
        let latch = sim::Latch {
            capture,
            hold: uneven(),
            strength: Strength::default(),
            overload: sim::Overload::LetsGo,
            pull_in: None,
        };
        spec.mechanisms =
            vec![mechanism("hook", at(0, 5.0, 0.0, 0.0), at(1, 0.0, 0.0, 0.0), MechanismKind::Latch(latch))];
        let mut with = world(spec);
        start_gripper(&mut with);
        run(&mut plain, 300);
        run(&mut with, 300);
        assert_eq!(plain.state().bases, with.state().bases, "{integrator:?}");
        assert_eq!(plain.state().bristles, with.state().bristles, "{integrator:?}");
    }
}
