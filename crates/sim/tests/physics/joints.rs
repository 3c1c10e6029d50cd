//! Joints: stops, drives, dry friction, mimic joints, rotors, floating and planar joints.

use crate::support::{ALL, Setup, joint, link, robot, run, spec, twist, world};
use multibody::{JointDescription, JointKind, Mimic, Tree};
use sim::{Actuator, ActuatorKind, Base, Energy, Integrator, ModelSpec, MomentumAudit, World};
use spatial::Vec3;

const INERTIA: f64 = 0.5;

/// A wheel of 0.5 kg·m² on a fixed post, with the joint as `change` leaves it.
fn wheel(change: impl Fn(&mut JointDescription)) -> Tree {
    let mut hinge = joint("hinge", 0, Vec3::zeros(), Vec3::z(), JointKind::Revolute);
    change(&mut hinge);
    let post = link("post", 1.0, Vec3::zeros(), Vec3::repeat(0.1));
    robot(vec![post, link("wheel", 1.0, Vec3::zeros(), Vec3::repeat(INERTIA))], vec![hinge])
}

fn fixed(tree: Tree, setup: &Setup) -> ModelSpec {
    spec(vec![(tree, Base::Fixed)], setup)
}

fn effort_on(coordinate: usize) -> Actuator {
    let kind = ActuatorKind::JointEffort { coordinate, limit: 10.0 };
    Actuator { name: format!("motor{coordinate}"), kind }
}

#[test]
fn stop_takes_energy_and_holds_the_joint() {
    for integrator in ALL {
        let tree = wheel(|j| (j.position_limits, j.effort_limit) = (Some([-0.5, 0.5]), 50.0));
        let mut spec = fixed(tree, &Setup::new(integrator));
        spec.actuators = vec![effort_on(0)];
        let mut world = world(spec);
        world.state_mut().v[0] = 2.0;
        world.refresh();
        let start = Energy::of(&world).kinetic;
        let (mut farthest, mut fastest) = (0.0_f64, 0.0_f64);
        for _ in 0..2_000 {
            run(&mut world, 1);
            farthest = farthest.max(world.state().q[0]);
            fastest = fastest.max(-world.state().v[0]);
        }
        println!("{integrator:?}: overtravel {:.4} rad, rebound {fastest:.3} rad/s", farthest - 0.5);
        assert!(Energy::of(&world).kinetic < start && fastest < 2.0);
        assert!(farthest - 0.5 < 0.05);
        // Pressed against the stop at 5 N·m it comes to rest where the stop's spring says.
        world.commands_mut()[0].effort = 5.0;
        run(&mut world, 8_000);
        let depth = world.state().q[0] - 0.5;
        assert!(world.state().v[0].abs() < 1e-9 && depth > 0.0 && depth < 0.01, "{integrator:?}: {depth}");
        assert!((world.effort(0)).abs() < 1e-6, "motor and stop balance");
    }
}

#[test]
fn a_joint_flies_up_to_its_stop_and_from_it_in_long_steps_and_not_on_it() {
    let tree = wheel(|j| (j.position_limits, j.effort_limit) = (Some([-0.5, 0.5]), 50.0));
    let mut world = world(fixed(tree, &Setup::new(Integrator::RungeKutta4)));
    let place = |world: &World| (world.state().time, world.state().q[0], world.state().v[0]);
    world.state_mut().v[0] = 2.0;
    world.refresh();
    assert!(world.advance_free(0.2).unwrap() && (world.state().q[0] - 0.4).abs() < 1e-12);
    let before = place(&world);
    assert!(!world.advance_free(0.2).unwrap(), "it would be 0.3 rad beyond its range");
    assert_eq!(place(&world), before);
    while world.state().v[0] > 0.0 {
        run(&mut world, 1);
    }
    assert!(world.state().q[0] > 0.5 && !world.advance_free(0.2).unwrap(), "it leans on its stop");
    while world.state().q[0] > 0.5 {
        run(&mut world, 1);
    }
    assert!(world.state().v[0] < 0.0 && world.advance_free(0.2).unwrap(), "it has left it");
}

#[test]
fn drive_holds_its_torque_limit_and_then_its_target() {
    for integrator in ALL {
        let mut spec = fixed(wheel(|_| ()), &Setup::new(integrator));
        let kind = ActuatorKind::JointDrive { coordinate: 0, stiffness: 100.0, damping: 14.0, limit: 2.0 };
        spec.actuators = vec![Actuator { name: "drive".to_owned(), kind }];
        let mut world = world(spec);
        world.commands_mut()[0].position = 1.0;
        run(&mut world, 100);
        // Saturated: q = τ t²/2I.
        let (t, expected) = (world.state().time, 0.5 * 2.0 / INERTIA * 0.01);
        assert!((world.state().q[0] - expected).abs() < 2.0 / INERTIA * t * 1e-3, "{integrator:?}");
        assert!((world.effort(0) - 2.0).abs() < 1e-12);
        run(&mut world, 10_000);
        assert!((world.state().q[0] - 1.0).abs() < 1e-9 && world.state().v[0].abs() < 1e-9, "{integrator:?}");
    }
}

#[test]
fn dry_friction_holds_below_its_level_and_slips_above() {
    for integrator in ALL {
        let mut spec = fixed(wheel(|j| j.friction = 0.8), &Setup::new(integrator));
        spec.actuators = vec![effort_on(0)];
        let mut world = world(spec);
        // The level is 0.8 N·m; a load put on at once swings to twice its value.
        world.commands_mut()[0].effort = 0.35;
        run(&mut world, 20_000);
        let held = world.state().q[0];
        // Deflection at breakaway 3e-4 rad; a bare spring keeps swinging, implicit Euler damps it.
        assert!(held.abs() < 6e-4, "{integrator:?}: {held}");
        world.commands_mut()[0].effort = 2.0;
        run(&mut world, 200);
        let (v0, t0) = (world.state().v[0], world.state().time);
        run(&mut world, 500);
        let slope = (world.state().v[0] - v0) / (world.state().time - t0);
        println!("{integrator:?}: held at {held:.2e} rad; slips with {slope:.6} rad/s²");
        assert!((slope - (2.0 - 0.8) / INERTIA).abs() < 1e-9, "{integrator:?}");
        world.commands_mut()[0].effort = 0.0;
        run(&mut world, 5_000);
        assert!(world.state().v[0].abs() < 0.04, "{integrator:?}: stopped by friction, {}", world.state().v[0]);
    }
}

#[test]
fn damped_joint_decays_exponentially() {
    for (integrator, tolerance) in ALL.into_iter().zip([5e-3, 3e-6, 5e-3, 1e-11]) {
        let mut world = world(fixed(wheel(|j| j.damping = 1.5), &Setup::new(integrator)));
        world.state_mut().v[0] = 1.0;
        run(&mut world, 1_000);
        let expected = (-1.5 / INERTIA * 1.0_f64).exp();
        assert!((world.state().v[0] / expected - 1.0).abs() < tolerance, "{integrator:?}");
    }
}

#[test]
fn mimic_joint_follows_and_its_inertia_counts_with_the_square_of_the_ratio() {
    for integrator in ALL {
        let mut follower = joint("follower", 0, Vec3::new(1.0, 0.0, 0.0), Vec3::z(), JointKind::Revolute);
        follower.mimic = Some(Mimic { joint: 0, multiplier: -2.0, offset: 0.1 });
        let leader = joint("leader", 0, Vec3::zeros(), Vec3::z(), JointKind::Revolute);
        let body = |name| link(name, 1.0, Vec3::zeros(), Vec3::repeat(INERTIA));
        let tree = robot(vec![body("post"), body("a"), body("b")], vec![leader, follower]);
        let mut spec = fixed(tree, &Setup::new(integrator));
        spec.actuators = vec![effort_on(0)];
        let mut world = world(spec);
        world.commands_mut()[0].effort = 1.0;
        run(&mut world, 1_000);
        assert_eq!(world.state().v.len(), 1);
        // I + (−2)² I
        assert!((world.state().v[0] - 1.0 / (5.0 * INERTIA)).abs() < 1e-12, "{integrator:?}");
        let spin = world.link_twist(0, 2).ang.z;
        assert!((spin + 2.0 * world.state().v[0]).abs() < 1e-12);
    }
}

/// A free bus with one reaction wheel along an axis that is no principal one.
fn bus_with_wheel(setup: &Setup) -> (World, Vec3) {
    let axis = Vec3::new(0.2, -0.4, 0.9).normalize();
    let mut tree = robot(vec![link("bus", 50.0, Vec3::new(0.1, 0.0, -0.05), Vec3::new(4.0, 5.0, 6.0))], Vec::new());
    tree.add_rotor(0, &axis, 0.02, "wheel");
    let mut spec = spec(vec![(tree, Base::Free)], setup);
    spec.actuators = vec![effort_on(0)];
    (world(spec), axis)
}

#[test]
fn reaction_wheel_turns_the_bus_against_itself() {
    for integrator in ALL {
        let (mut world, axis) = bus_with_wheel(&Setup::new(integrator));
        let mut audit = MomentumAudit::new(&world);
        world.commands_mut()[0].effort = 0.1;
        run(&mut world, 2_000);
        audit.update(&world);
        let (omega, spin) = (world.kinematics(0).vel[0].ang, world.state().v[0]);
        // At rest as a whole: I_bus ω + J (Ω + ω·a) a = 0 in bus axes.
        let omega_b = world.state().bases[0].rotation.inverse() * omega;
        let bus = Vec3::new(4.0, 5.0, 6.0).component_mul(&omega_b);
        let total = bus + 0.02 * (spin + omega_b.dot(&axis)) * axis;
        println!("{integrator:?}: wheel {spin:.3} rad/s, bus {:.4} rad/s, L {:.1e}", omega.norm(), total.norm());
        assert!(spin > 9.0 && omega.norm() > 0.03);
        assert!(total.norm() < 1e-13 * 0.02 * spin);
        assert!(audit.absolute[1] < 1e-14 && audit.absolute[0] < 1e-14);
        // The motor gave the wheel's momentum relative to the bus: J (Ω̇ + ω̇·a) = τ.
        let axial = 0.02 * (spin + omega_b.dot(&axis));
        assert!((axial - 0.1 * 2.0).abs() < 1e-9, "{integrator:?}: {axial}");
    }
}

#[test]
fn spinning_wheel_makes_the_bus_a_gyrostat_with_constant_momentum() {
    for integrator in ALL {
        let (mut world, _) = bus_with_wheel(&Setup::new(integrator));
        world.state_mut().v[0] = 300.0;
        world.set_base_twists(&[twist([0.2, -0.1, 0.3], [0.0; 3])]);
        let start = Energy::of(&world).kinetic;
        let mut audit = MomentumAudit::new(&world);
        for _ in 0..100 {
            run(&mut world, 100);
            audit.update(&world);
        }
        let drift = Energy::of(&world).kinetic / start - 1.0;
        println!("{integrator:?}: L drift {:.1e}, energy {drift:.1e}", audit.angular_drift);
        assert!(audit.angular_drift < 1e-12 && audit.linear_drift < 1e-12, "{}", audit.linear_drift);
        let bound = match integrator {
            Integrator::RungeKutta4 => 1e-10,
            Integrator::ImplicitMidpoint => 1e-6,
            _ => 1e-2,
        };
        assert!(drift.abs() < bound);
    }
}

/// A free base that carries a floating body (a slosh mass, held by nothing) and a planar one.
fn base_with_loose_bodies(setup: &Setup) -> World {
    let body = |name, mass| link(name, mass, Vec3::new(0.02, -0.01, 0.03), Vec3::new(0.05, 0.06, 0.08) * mass);
    let planar_axis = Vec3::new(0.6, 0.0, 0.8);
    let joints = vec![
        joint("slosh", 0, Vec3::new(0.3, 0.0, 0.2), Vec3::z(), JointKind::Floating),
        joint("table", 0, Vec3::new(-0.3, 0.1, 0.0), planar_axis, JointKind::Planar),
    ];
    let tree = robot(vec![body("base", 20.0), body("mass", 4.0), body("plate", 3.0)], joints);
    let mut world = world(spec(vec![(tree, Base::Free)], setup));
    world.state_mut().v.copy_from_slice(&[0.05, -0.02, 0.03, 0.4, 0.3, -0.5, 0.04, 0.02, -0.6]);
    world.set_base_twists(&[twist([0.2, -0.3, 0.1], [0.01, 0.0, -0.02])]);
    world
}

#[test]
fn floating_and_planar_joints_keep_momentum_and_converge() {
    for (integrator, order) in ALL.into_iter().zip([1.0, 2.0, 1.0, 4.0]) {
        let finish = |step: f64| {
            let mut world = base_with_loose_bodies(&Setup::new(integrator).step(step));
            let mut audit = MomentumAudit::new(&world);
            run(&mut world, (2.0 / step).round() as usize);
            audit.update(&world);
            assert!(audit.angular_drift < 1e-12 && audit.linear_drift < 1e-12, "{integrator:?}");
            world.state().q.clone()
        };
        let scale = if integrator == Integrator::RungeKutta4 { 5.0 } else { 1.0 };
        let [coarse, middle, fine] = [8e-3, 4e-3, 2e-3].map(|h| finish(h * scale));
        let gap = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| (x - y).powi(2)).sum::<f64>().sqrt();
        let measured = (gap(&coarse, &middle) / gap(&middle, &fine)).log2();
        println!("{integrator:?}: order {measured:.2}");
        assert!((measured - order).abs() < 0.3);
    }
}

#[test]
fn free_floating_child_without_forces_flies_straight() {
    // The floating joint carries nothing: the mass moves on a straight line in W whatever the base does.
    for integrator in ALL {
        let mut world = base_with_loose_bodies(&Setup::new(integrator));
        let centre = |world: &World| world.link_frame(0, 1).point(&Vec3::new(0.02, -0.01, 0.03));
        let (start, turning) = (centre(&world), world.link_twist(0, 1));
        let arm = world.link_frame(0, 1).rot * Vec3::new(0.02, -0.01, 0.03);
        let velocity = turning.at(&arm);
        run(&mut world, 2_000);
        let off = (centre(&world) - start - 2.0 * velocity).norm();
        println!("{integrator:?}: off the straight line by {off:.1e} m");
        let bound = match integrator {
            Integrator::RungeKutta4 => 1e-11,
            Integrator::ImplicitMidpoint => 1e-5,
            _ => 2e-3,
        };
        assert!(off < bound);
    }
}
