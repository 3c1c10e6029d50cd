//! Efforts on joints: Dahl's friction in its four forms, cables, ripple, disturbances, reflected rotors.

use crate::support::effects::{INERTIA, on_joint, wheel_spec, wheel_world};
use crate::support::{ALL, Setup, arm7, free_world, run, world};
use multibody::{Accelerations, Drive, Dynamics, Kinematics};
use sim::{DryFriction, DryLevel, Energy, Integrator, JointLaw, MomentumAudit, World};
use spatial::{Pose, Twist, Wrench};

#[test]
fn viscous_friction_slows_a_wheel_exponentially() {
    for integrator in ALL {
        let mut world = wheel_world(&[on_joint(JointLaw::Viscous { damping: 0.9 })], &Setup::new(integrator));
        world.state_mut().v[0] = 2.0;
        run(&mut world, 1_000);
        let expected = 2.0 * (-0.9 / INERTIA).exp();
        // First-order schemes: h λ t/2 = 1.6e-3.
        assert!((world.state().v[0] / expected - 1.0).abs() < 2e-3, "{integrator:?}: {}", world.state().v[0]);
    }
}

#[test]
fn sliding_wheel_loses_c_over_i_per_second_and_sticks() {
    for integrator in ALL {
        let mut world =
            wheel_world(&[on_joint(JointLaw::Dry(DryLevel::Constant(0.8).into()))], &Setup::new(integrator));
        world.state_mut().v[0] = 1.0;
        run(&mut world, 100);
        let (v, t) = (world.state().v[0], world.state().time);
        run(&mut world, 300);
        let slope = (world.state().v[0] - v) / (world.state().time - t);
        assert!((slope / (-0.8 / INERTIA) - 1.0).abs() < 1e-9, "{integrator:?}: {slope}");
        run(&mut world, 4_600);
        assert!(world.state().v[0].abs() < 1e-6, "{integrator:?}: still at {}", world.state().v[0]);
        let largest = sim::memory_layout(world.model())[0].largest;
        assert_eq!(largest, Some(sim::REACH));
        assert!(world.state().effects[0].abs() < sim::REACH, "a deflection within its reach");
    }
}

/// A wheel under a slow sine of effort that reverses it, for 2 s.
fn reversing(level: DryLevel, integrator: Integrator, step: f64) -> World {
    let periodic = JointLaw::Periodic { amplitude: 3.0, frequency: 1.5, phase: 0.3 };
    let mut world =
        wheel_world(&[on_joint(JointLaw::Dry(level.into())), on_joint(periodic)], &Setup::new(integrator).step(step));
    run(&mut world, (2.0 / step).round() as usize);
    world
}

#[test]
fn dry_friction_through_reversals_is_accurate_at_a_millisecond() {
    let levels = [
        DryLevel::Constant(0.8),
        DryLevel::Falling { c: 0.7, s: 1.0, v_s: 0.08 },
        DryLevel::Directed { c_plus: 0.9, c_minus: 0.6 },
    ];
    for level in levels {
        let [fine, half, coarse] =
            [1e-5, 5e-4, 1e-3].map(|step| reversing(level, Integrator::RungeKutta4, step).state().q[0]);
        println!("{level:?}: {:.2e} rad at 1 ms, {:.2e} at 0.5 ms", coarse - fine, half - fine);
        // An encoder's noise is 2e-5 rad.
        assert!((coarse - fine).abs() < 2e-5, "{level:?}: {}", coarse - fine);
        for integrator in ALL {
            let other = reversing(level, integrator, 1e-4).state().q[0];
            assert!((other - fine).abs() < 5e-4, "{integrator:?} {level:?}: {}", other - fine);
        }
    }
}

#[test]
fn levels_of_dry_friction_are_those_of_speed_and_direction() {
    let slope = |level: DryLevel, v: f64| {
        let mut world =
            wheel_world(&[on_joint(JointLaw::Dry(level.into()))], &Setup::new(Integrator::RungeKutta4).step(1e-4));
        world.state_mut().v[0] = v;
        world.state_mut().effects[0] = 3e-4 * v.signum();
        run(&mut world, 1);
        (world.state().v[0] - v) / world.state().time * INERTIA
    };
    let falling = DryLevel::Falling { c: 0.5, s: 1.0, v_s: 0.1 };
    assert!((slope(falling, 0.1) + 0.5 + 0.5 * (-1.0_f64).exp()).abs() < 1e-3, "at v_s: c + (s − c)/e");
    assert!((slope(falling, 2.0) + 0.5).abs() < 1e-9, "far above: c");
    let directed = DryLevel::Directed { c_plus: 0.9, c_minus: 0.6 };
    assert!((slope(directed, 1.0) + 0.9).abs() < 1e-9 && (slope(directed, -1.0) - 0.6).abs() < 1e-9);
}

#[test]
fn rates_follow_their_closed_forms_under_quadratic_friction_an_offset_and_viscous_friction_by_side() {
    let after = |law: JointLaw, v: f64| {
        let mut world = wheel_world(&[on_joint(law)], &Setup::new(Integrator::RungeKutta4));
        world.state_mut().v[0] = v;
        run(&mut world, 500);
        (world.state().v[0], world.state().time)
    };
    for v in [2.0, -2.0] {
        let (end, t) = after(JointLaw::Quadratic { drag: 0.9 }, v);
        assert!((end - v / (1.0 + 0.9 * v.abs() * t / INERTIA)).abs() < 1e-9, "I v̇ = −b₂|v|v: {end}");
        let (end, t) = after(JointLaw::Offset { effort: 0.3 }, v);
        assert!((end - v - 0.3 * t / INERTIA).abs() < 1e-9, "{end}");
        let (end, t) = after(JointLaw::ViscousBySide { plus: 0.9, minus: 0.4 }, v);
        let damping = if v > 0.0 { 0.9 } else { 0.4 };
        assert!((end - v * (-damping * t / INERTIA).exp()).abs() < 1e-9, "{end}");
    }
}

#[test]
fn small_motion_about_a_rest_deflection_is_damped_by_its_micro_damping() {
    // I ẍ = −(c/z₀)(x + 0.002 ẋ) about z = 0: ω = √(c/(z₀ I)) = 73 rad/s, damping ratio ω/2 · 2 ms = 0.073. Dahl's own
    // loss at |z| ≪ z₀ is small beside it.
    let mut world = wheel_world(
        &[on_joint(JointLaw::Dry(DryLevel::Constant(0.8).into()))],
        &Setup::new(Integrator::RungeKutta4).step(1e-4),
    );
    let omega = (0.8_f64 / 3e-4 / INERTIA).sqrt();
    world.state_mut().v[0] = 1e-7 * omega;
    let mut peak = 0.0_f64;
    let zeta = 0.5 * omega * 2e-3;
    let period = std::f64::consts::TAU / (omega * (1.0 - zeta * zeta).sqrt());
    run(&mut world, (period / 1e-4).round() as usize);
    for _ in 0..(period / 1e-4) as usize {
        run(&mut world, 1);
        peak = peak.max(world.state().q[0]);
    }
    // Second positive peak, at five quarters of a period.
    let expected = 1e-7 * (-zeta * omega * 1.25 * period).exp() * (zeta * zeta).exp();
    assert!((peak / expected - 1.0).abs() < 0.02, "{peak:.3e} against {expected:.3e}");
}

#[test]
fn below_its_creep_rate_dry_friction_is_a_damper_behind_a_spring() {
    // Under a load τ < c the joint creeps at v_c τ/c; where it holds, the deflection is z₀ τ/c and stays. Damped: 2 ms.
    let (c, load, creep) = (0.8, 0.5, 4e-3);
    for integrator in ALL {
        for reach in [3e-4, 1e-3] {
            let at = |creep| {
                let dry = JointLaw::Dry(DryFriction { level: DryLevel::Constant(c), reach, creep });
                let laws = [on_joint(dry), on_joint(JointLaw::Offset { effort: load })];
                let mut world = wheel_world(&laws, &Setup::new(integrator).step(5e-4));
                // Twenty times z₀/v_c.
                run(&mut world, 30_000);
                (world.state().v[0], world.state().effects[0])
            };
            let (v, z) = at(creep);
            assert!((v / (creep * load / c) - 1.0).abs() < 1e-6, "{integrator:?}: creeps at {v}");
            assert!((z / (reach * load / c) - 1.0).abs() < 1e-6, "{integrator:?}: deflected by {z}");
            let (v, z) = at(0.0);
            assert!(v.abs() < 1e-4 * creep, "{integrator:?}: holds at {v}");
            assert!((z / (reach * load / c) - 1.0).abs() < 1e-3, "{integrator:?}: deflected by {z}");
        }
    }
}

#[test]
fn friction_that_creeps_is_dahls_above_the_creep_rate() {
    let after = |creep| {
        let dry = JointLaw::Dry(DryFriction { level: DryLevel::Constant(0.8), reach: 3e-4, creep });
        let mut world = wheel_world(&[on_joint(dry)], &Setup::new(Integrator::RungeKutta4));
        world.state_mut().v[0] = 2.0;
        run(&mut world, 300);
        assert!(world.state().v[0] > 0.5);
        world.state().q[0]
    };
    assert_eq!(after(0.0).to_bits(), after(0.1).to_bits());
}

#[test]
fn cable_and_ripple_give_back_what_they_take() {
    let laws =
        [JointLaw::Cable { stiffness: 20.0, rest: 0.4 }, JointLaw::Ripple { amplitude: 0.7, order: 6.0, phase: 0.2 }];
    for law in laws {
        let mut world = wheel_world(&[on_joint(law)], &Setup::new(Integrator::RungeKutta4));
        world.state_mut().v[0] = 1.0;
        world.refresh();
        let total = |w: &World| Energy::of(w).kinetic + Energy::of(w).effect;
        let start = total(&world);
        run(&mut world, 3_000);
        // RK4: (h ω)⁵ per period.
        assert!((total(&world) - start).abs() < 1e-9, "{law:?}: {:.1e}", total(&world) - start);
        assert!((Energy::of(&world).kinetic - 0.25).abs() > 1e-3, "{law:?} did something");
    }
}

#[test]
fn disturbance_moves_a_free_wheel_as_its_integral_says() {
    for integrator in ALL {
        let law = JointLaw::Periodic { amplitude: 0.3, frequency: 2.0, phase: 0.5 };
        let mut world = wheel_world(&[on_joint(law)], &Setup::new(integrator));
        run(&mut world, 700);
        let omega = std::f64::consts::TAU * 2.0;
        let expected = 0.3 / INERTIA / omega * (0.5_f64.cos() - (omega * 0.7 + 0.5).cos());
        assert!((world.state().v[0] - expected).abs() < 1e-3, "{integrator:?}");
    }
}

#[test]
fn reflected_rotor_adds_to_the_joint_and_to_no_momentum() {
    for integrator in ALL {
        let mut spec = wheel_spec(&[], &Setup::new(integrator));
        spec.vehicles[0].tree.joints[0].armature = 0.3;
        let mut wheel = world(spec);
        wheel.commands_mut()[0].effort = 1.6;
        run(&mut wheel, 500);
        assert!((wheel.state().v[0] - 0.5 * 1.6 / (INERTIA + 0.3)).abs() < 1e-12, "{integrator:?}");
        assert!((Energy::of(&wheel).kinetic - wheel.works().actuators[0]).abs() < 2e-3);
        let mut tree = arm7();
        tree.joints.iter_mut().for_each(|j| j.armature = 0.2);
        let mut arm = free_world(tree, &Setup::new(integrator));
        arm.state_mut().v.copy_from_slice(&[0.5, -0.4, 0.6, 0.5, -0.7, 0.6, 1.0]);
        arm.set_base_twists(&[Twist::default()]);
        let mut audit = MomentumAudit::new(&arm);
        let start = Energy::of(&arm).kinetic;
        for _ in 0..100 {
            run(&mut arm, 10);
            audit.update(&arm);
        }
        assert!(audit.linear_drift < 1e-12 && audit.angular_drift < 1e-11, "{integrator:?}: {audit:?}");
        if integrator == Integrator::RungeKutta4 {
            assert!((Energy::of(&arm).kinetic - start).abs() < 1e-10, "{:.1e}", Energy::of(&arm).kinetic - start);
        }
    }
}

#[test]
fn forward_and_inverse_dynamics_agree_on_reflected_rotors() {
    let mut tree = arm7();
    tree.joints.iter_mut().enumerate().for_each(|(i, j)| j.armature = 0.05 * (i + 1) as f64);
    let q = [0.3, -0.5, 0.9, 1.2, -0.4, 0.7, 0.1];
    let v = [0.5, -0.4, 0.6, 0.5, -0.7, 0.6, 1.0];
    let tau = [1.0, -2.0, 0.5, 0.3, -0.2, 0.1, 0.05];
    let mut kin = Kinematics::new(&tree);
    kin.update_positions(&tree, &Pose::identity(), &q);
    kin.update_velocities(&tree, &Twist::default(), &v);
    let mut dynamics = Dynamics::new(&tree);
    let external = vec![Wrench::default(); tree.bodies.len()];
    let mut v_dot = [0.0; 7];
    let drive = Drive { v: &v, tau: &tau, external: &external, base_free: true };
    let base = dynamics.calc_forward(&tree, &kin, &drive, &mut v_dot).unwrap();
    let mut back = [0.0; 7];
    let motion = Accelerations { base, v: &v, v_dot: &v_dot };
    let wrench = dynamics.calc_inverse(&tree, &kin, &motion, &external, &mut back);
    assert!(back.iter().zip(&tau).all(|(a, b)| (a - b).abs() < 1e-12), "{back:?}");
    assert!(wrench.force.norm() < 1e-11 && wrench.moment.norm() < 1e-11);
    // A free base feels rotors only through the joints: without joint motion none of them counts.
    let mut still = vec![0.0; 13 * 13];
    dynamics.calc_mass_matrix(&tree, &kin, &[], &mut still, 13);
    let mut bare = still.clone();
    let plain = arm7();
    dynamics.calc_mass_matrix(&plain, &kin, &[], &mut bare, 13);
    for (k, (a, b)) in still.iter().zip(&bare).enumerate() {
        let (row, column) = (k / 13, k % 13);
        let expected = if row == column && row >= 6 { 0.05 * (row - 5) as f64 } else { 0.0 };
        assert!((a - b - expected).abs() < 1e-12, "({row}, {column})");
    }
}
