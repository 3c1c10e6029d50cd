//! Gears that yield or have play: two inertias with a spring between them.

use crate::support::effects::{INERTIA, on_joint, wheel_world};
use crate::support::{ALL, Setup, run};
use sim::{EffectKind, Energy, EnergyAudit, Integrator, JointLaw, Series, World};

const ROTOR: f64 = 0.2;

fn gear(stiffness: f64, damping: f64, gap: f64) -> EffectKind {
    EffectKind::Series(Series { coordinate: 0, rotor: ROTOR, stiffness, damping, gap })
}

#[test]
fn rotor_and_wheel_swing_against_each_other_at_their_own_frequency() {
    // Reduced inertia 1/(1/B + 1/I); counted between zero crossings of the deflection.
    let expected = (5_000.0_f64 * (1.0 / ROTOR + 1.0 / INERTIA)).sqrt() / std::f64::consts::TAU;
    for integrator in ALL {
        let mut world = wheel_world(&[gear(5_000.0, 0.0, 0.0)], &Setup::new(integrator).step(2e-4));
        world.settle_effects();
        world.state_mut().effects[0] = 1e-3;
        let (mut crossings, mut first, mut last, mut before) = (0, 0.0, 0.0, 1e-3);
        for _ in 0..5_000 {
            run(&mut world, 1);
            let now = world.state().effects[0];
            if before > 0.0 && now <= 0.0 {
                last = world.state().time - 2e-4 * now / (now - before);
                first = if crossings == 0 { last } else { first };
                crossings += 1;
            }
            before = now;
        }
        let frequency = f64::from(crossings - 1) / (last - first);
        assert!((frequency / expected - 1.0).abs() < 1e-3, "{integrator:?}: {frequency} Hz against {expected}");
        assert!((INERTIA * world.state().v[0] + ROTOR * world.motor_side(0).1).abs() < 1e-12, "momentum of both");
    }
}

#[test]
fn very_stiff_gear_is_a_rigid_one() {
    for integrator in [Integrator::ImplicitEuler, Integrator::ImplicitMidpoint] {
        // h² k (1/B + 1/I) = 7e6: no explicit step holds that.
        let mut world = wheel_world(&[gear(1e12, 0.0, 0.0)], &Setup::new(integrator));
        world.commands_mut()[0].effort = 1.4;
        run(&mut world, 500);
        assert!((world.state().v[0] - 0.5 * 1.4 / (INERTIA + ROTOR)).abs() < 1e-6, "{integrator:?}");
        assert!(world.state().effects[0].abs() < 1e-11, "{integrator:?}");
    }
}

#[test]
fn loaded_gear_starts_loaded_and_the_encoder_reads_its_motor() {
    for integrator in ALL {
        // A cable's 3.5 N·m, held by the motor through its play: nothing moves.
        let cable = on_joint(JointLaw::Cable { stiffness: 7.0, rest: -0.5 });
        let mut world = wheel_world(&[gear(7_000.0, 6.0, 0.002), cable], &Setup::new(integrator));
        world.commands_mut()[0].effort = 3.5;
        world.settle_effects();
        let held = 3.5 / 7_000.0 + 0.001;
        assert!((world.motor_side(0).0 - held).abs() < 1e-15 && world.motor_side(0).1 == 0.0);
        run(&mut world, 400);
        assert!((world.motor_side(0).0 - held).abs() < 1e-14 && world.state().q[0].abs() < 1e-14, "{integrator:?}");
        // Without the motor's effort the cable takes both along, the spring carrying what the rotor needs.
        world.commands_mut()[0].effort = 0.0;
        run(&mut world, 100);
        assert!(world.state().q[0] < -1e-2, "{integrator:?}: {}", world.state().q[0]);
        assert!(world.state().effects[0] > 1e-3, "{integrator:?}: the rotor is dragged, on the same flank");
    }
}

#[test]
fn within_its_play_a_wheel_knows_nothing_of_its_motor() {
    for integrator in ALL {
        let mut world = wheel_world(&[gear(7_000.0, 6.0, 0.2)], &Setup::new(integrator));
        world.settle_effects();
        world.commands_mut()[0].effort = 0.4;
        run(&mut world, 300);
        assert_eq!(world.state().v[0], 0.0, "{integrator:?}");
        assert!((world.motor_side(0).1 - 0.3 * 0.4 / ROTOR).abs() < 1e-12);
        // 0.1 rad of play takes √(2·0.1·B/u) = 0.316 s: then the teeth meet, and both move on.
        run(&mut world, 700);
        assert!(world.state().v[0] > 0.2, "{integrator:?}: {}", world.state().v[0]);
        let both = INERTIA * world.state().v[0] + ROTOR * world.motor_side(0).1;
        assert!((both - 0.4).abs() < 1e-9, "{integrator:?}: impulse of the motor");
    }
}

#[test]
fn gear_keeps_its_books() {
    let sum = |w: &World| Energy::of(w).kinetic + Energy::of(w).effect - w.works().actuators[0];
    for (gap, damping) in [(0.0, 0.0), (0.0, 6.0), (0.01, 6.0)] {
        for integrator in ALL {
            let mut world = wheel_world(&[gear(7_000.0, damping, gap)], &Setup::new(integrator).step(1e-4));
            world.settle_effects();
            let (start, mut audit) = (sum(&world), EnergyAudit::new(&world));
            let mut highest = start;
            for k in 0..20 {
                world.commands_mut()[0].effort = if k % 4 < 2 { 2.0 } else { -2.0 };
                run(&mut world, 500);
                highest = highest.max(sum(&world));
            }
            let books = audit.close(&world).numerical_loss;
            println!("{integrator:?} d {damping} gap {gap}: books {books:.1e}, lost {:.2e} J", start - sum(&world));
            let bound = if integrator == Integrator::RungeKutta4 { if gap > 0.0 { 1e-6 } else { 1e-9 } } else { 1e-1 };
            assert!(books.abs() < bound, "{integrator:?}: {books:.1e}");
            let slack = if integrator == Integrator::SemiImplicitEuler { 2e-3 } else { 1e-6 };
            assert!(highest <= start + slack, "{integrator:?}: a gear makes no energy: {:.1e}", highest - start);
            if damping == 0.0 && integrator == Integrator::RungeKutta4 {
                assert!((sum(&world) - start).abs() < 1e-8, "{:.1e}", sum(&world) - start);
            }
        }
    }
}
