//! Struts against closed forms: oscillation, preload, end stops, the ring that stands on six of them.

use crate::support::mechanisms::{
    at, mechanism, ring_spec, start_ring, struck_ring, strut_length, two_blocks, two_blocks_spec,
};
use crate::support::{ALL, Setup, block, run, spec, twist, world};
use sim::{Base, Integrator, MechanismKind, ModelSpec, MomentumAudit, Strut, StrutSides, World};
use spatial::{Pose, Vec3};

/// Two blocks 1 m apart on x, their centres joined by a strut; the second moves at `speed` along x against the first, the
/// centre of mass of both drifting.
fn pair(strut: Strut, speed: f64, setup: &Setup) -> World {
    let tie = mechanism("strut", at(0, 0.0, 0.0, 0.0), at(1, 0.0, 0.0, 0.0), MechanismKind::Strut(strut));
    let mut world = two_blocks([2.0, 3.0], vec![tie], setup);
    world.state_mut().bases[1] = Pose::translation(1.0, 0.0, 0.0);
    world.set_base_twists(&[twist([0.0; 3], [0.1, 0.2, 0.0]), twist([0.0; 3], [0.1 + speed, 0.2, 0.0])]);
    world
}

/// Reduced mass of the pair, kg.
const MU: f64 = 1.2;

fn spring(stiffness: f64, ratio: f64) -> Strut {
    let damping = 2.0 * ratio * (stiffness * MU).sqrt();
    Strut { rest_length: 1.0, stiffness, damping, ..Strut::default() }
}

/// Deflection of a damped oscillator that starts at rest length with `speed`.
fn free_oscillation(strut: &Strut, speed: f64, t: f64) -> f64 {
    let decay = 0.5 * strut.damping / MU;
    let rate = (strut.stiffness / MU - decay * decay).sqrt();
    speed / rate * (-decay * t).exp() * (rate * t).sin()
}

#[test]
fn strut_between_two_free_bodies_oscillates_as_their_reduced_mass_does() {
    // 2 s, some six periods. Errors ∝ h, h², h, h⁴ of the amplitude of 10 mm; h = 0.2 ms.
    let bounds = [4e-4, 3e-6, 4e-4, 1e-11];
    let strut = spring(480.0, 0.02);
    for (integrator, bound) in ALL.into_iter().zip(bounds) {
        let mut world = pair(strut, 0.2, &Setup::new(integrator).step(2e-4));
        let mut worst = 0.0_f64;
        for _ in 0..200 {
            run(&mut world, 50);
            let exact = free_oscillation(&strut, 0.2, world.state().time);
            worst = worst.max((strut_length(&world) - 1.0 - exact).abs());
        }
        println!("{integrator:?}: {worst:.1e} m");
        assert!(worst < bound, "{integrator:?}: {worst:e} m");
    }
}

#[test]
fn orders_of_convergence_on_a_swinging_strut() {
    // Two bodies that turn and swing on a strut off their centres; reference: RK4 at a tenth of the finest step.
    let build = |integrator, h: f64| {
        let strut = Strut { rest_length: 0.7, stiffness: 200.0, damping: 1.0, preload: 3.0, ..Strut::default() };
        let tie = mechanism("strut", at(0, 0.1, 0.1, 0.0), at(1, -0.1, 0.0, 0.1), MechanismKind::Strut(strut));
        let mut world = two_blocks([2.0, 3.0], vec![tie], &Setup::new(integrator).step(h));
        world.state_mut().bases[1] = Pose::translation(1.0, 0.0, 0.0);
        world.set_base_twists(&[twist([0.1, 0.5, -0.3], [0.1, 0.2, 0.0]), twist([0.3, 0.0, 0.4], [0.0, 0.0, 0.3])]);
        run(&mut world, (1.0 / h).round() as usize);
        world.state().bases[1].translation.vector
    };
    let reference = build(Integrator::RungeKutta4, 2.5e-4);
    for (integrator, order) in ALL.into_iter().zip([1.0, 2.0, 1.0, 4.0]) {
        let steps = if integrator == Integrator::RungeKutta4 { [1e-2, 5e-3, 2.5e-3] } else { [4e-3, 2e-3, 1e-3] };
        let errors = steps.map(|h| (build(integrator, h) - reference).norm());
        let measured = (errors[1] / errors[2]).log2();
        println!("{integrator:?}: {errors:?}, order {measured:.2}");
        assert!((measured - order).abs() < 0.25, "{integrator:?}: order {measured}");
    }
}

#[test]
fn hard_strut_is_stable_at_a_millisecond() {
    // h ω = 2.9 for 1e7 N/m on 1.2 kg, and a damper of 1e5 N·s/m.
    for integrator in [Integrator::ImplicitEuler, Integrator::ImplicitMidpoint] {
        for damping in [0.0, 1e5] {
            let strut = Strut { rest_length: 1.0, stiffness: 1e7, damping, ..Strut::default() };
            let mut world = pair(strut, 0.5, &Setup::new(integrator));
            run(&mut world, 2_000);
            let length = strut_length(&world);
            assert!((length - 1.0).abs() < 1e-9, "{integrator:?}: {length}");
            assert_eq!(world.state().work.unconverged_steps, 0);
        }
    }
}

#[test]
fn preloaded_strut_rests_where_spring_and_preload_balance_a_load() {
    // A block of 2 kg in 9 m/s² on a bumper that is preloaded by 10 N: 18 N = 10 N + k s.
    let strut = Strut {
        rest_length: 0.5,
        stiffness: 400.0,
        damping: 40.0,
        preload: -10.0,
        sides: StrutSides::PushOnly,
        ..Strut::default()
    };
    for integrator in ALL {
        let setup = Setup::new(integrator).gravity(Vec3::new(0.0, 0.0, -9.0));
        let foot = crate::support::mechanisms::ground(Pose::identity());
        let leg = mechanism("leg", foot, at(0, 0.0, 0.0, 0.0), MechanismKind::Strut(strut));
        let rail = Base::Only([false, false, false, false, false, true]);
        let spec = ModelSpec { mechanisms: vec![leg], ..spec(vec![(block(2.0, Vec3::repeat(0.1)), rail)], &setup) };
        let mut world = world(spec);
        world.state_mut().bases[0] = Pose::translation(0.0, 0.0, 0.5);
        run(&mut world, 5_000);
        let sunk = 0.5 - strut_length(&world);
        assert!((sunk - 8.0 / 400.0).abs() < 1e-12, "{integrator:?}: {sunk}");
        let push = -world.mechanisms().next().unwrap().tension;
        assert!((push - 18.0).abs() < 1e-9, "{integrator:?}: {push}");
    }
}

/// Coefficient of restitution of a Hunt–Crossley stop at the speed v: root of d v (1 + e) = ln((1 + d v)/(1 − d e v)).
fn restitution(dissipation: f64, speed: f64) -> f64 {
    let x = dissipation * speed;
    let off = |e: f64| x * (1.0 + e) - ((1.0 + x) / (1.0 - x * e)).ln();
    let (mut low, mut high) = (0.0, 1.0_f64.min((1.0 - 1e-12) / x));
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if off(middle) > 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[test]
fn end_stops_throw_back_with_the_restitution_of_their_dissipation() {
    let stop = Strut { stroke: [0.9, 1.1], stop_stiffness: 4e4, stop_dissipation: 1.2, ..Strut::default() };
    for speed in [0.5, -0.5] {
        let mut world = pair(stop, speed, &Setup::new(Integrator::RungeKutta4).step(2e-5));
        let mut books = 0.0_f64;
        // At the stop after 0.2 s; a contact lasts some 20 ms.
        for _ in 0..250 {
            run(&mut world, 60);
            let report = world.mechanisms().next().unwrap();
            books = books.min(report.stored);
            let out_of_stop = if speed > 0.0 { report.tension } else { -report.tension };
            assert!(out_of_stop >= 0.0, "a stop pulled with {out_of_stop} N");
        }
        let gone = world.mechanisms().next().unwrap().rates[0];
        let (e, exact) = (-gone / speed, restitution(1.2, 0.5));
        println!("restitution {e:.9}, closed form {exact:.9}");
        assert!((e - exact).abs() < 1e-6, "{e} against {exact}");
        assert!((0.3..0.8).contains(&exact), "the closed form has a root of its own");
    }
}

#[test]
fn stops_give_no_energy_back_with_any_integrator_that_resolves_them() {
    // Ten strokes to and fro, both stops: after each the motion is slower, and in between it is the same.
    let stop = Strut { stroke: [0.95, 1.05], stop_stiffness: 4e4, stop_dissipation: 0.8, ..Strut::default() };
    for integrator in ALL {
        let mut world = pair(stop, 0.5, &Setup::new(integrator).step(2e-4));
        let (mut last, mut swings) = (f64::INFINITY, 0);
        for _ in 0..40_000 {
            run(&mut world, 1);
            let report = world.mechanisms().next().unwrap();
            if report.tension == 0.0 && report.deformation[0] > 0.999 && report.deformation[0] < 1.001 {
                let speed = report.rates[0].abs();
                swings += usize::from(speed < last - 1e-6);
                assert!(speed <= last + 1e-12, "{integrator:?}: {speed} after {last}");
                last = speed;
            }
        }
        assert!(swings >= 5, "{integrator:?}: {swings} swings");
    }
}

#[test]
fn hard_stop_at_a_millisecond_never_throws_back_faster() {
    for integrator in [Integrator::ImplicitEuler, Integrator::ImplicitMidpoint] {
        let stop = Strut { stroke: [0.9, 1.1], stop_stiffness: 1e7, stop_dissipation: 0.5, ..Strut::default() };
        let mut world = pair(stop, 0.5, &Setup::new(integrator));
        for _ in 0..1_000 {
            run(&mut world, 1);
            assert!(world.mechanisms().next().unwrap().rates[0].abs() <= 0.5 + 1e-12);
        }
        println!("{integrator:?}: {:?}", world.state().work);
        assert!(strut_length(&world) < 1.1 + 1e-3 && world.state().work.unconverged_steps == 0);
    }
}

#[test]
fn slack_cable_lets_the_bodies_fly_free() {
    let cable = Strut { rest_length: 1.5, sides: StrutSides::PullOnly, ..spring(1e3, 0.2) };
    for integrator in ALL {
        let mut world = pair(cable, -0.2, &Setup::new(integrator));
        run(&mut world, 1_000);
        assert_eq!(world.state().momentum[0].force, Vec3::new(0.2, 0.4, 0.0), "{integrator:?}");
    }
}

#[test]
fn anchors_that_meet_go_on_without_nan() {
    for integrator in ALL {
        let mut world = pair(Strut { rest_length: 0.2, ..spring(300.0, 0.1) }, -0.5, &Setup::new(integrator));
        world.state_mut().bases[1] = Pose::identity();
        world.refresh();
        run(&mut world, 3_000);
        assert!(strut_length(&world).is_finite());
    }
}

/// Struts of a soft-capture ring at rest: preloaded outwards against their long stops.
fn ring_strut() -> Strut {
    Strut {
        rest_length: 0.35,
        stiffness: 600.0,
        damping: 60.0,
        preload: -15.0,
        stroke: [0.15, 0.55],
        stop_stiffness: 5e4,
        stop_dissipation: 0.5,
        ..Strut::default()
    }
}

#[test]
fn ring_on_six_struts_struck_off_centre_keeps_momentum_for_ten_seconds() {
    for integrator in ALL {
        let mut world = struck_ring(ring_strut(), &Setup::new(integrator));
        let mut audit = MomentumAudit::new(&world);
        let mut most = 0.0_f64;
        for _ in 0..10_000 {
            run(&mut world, 1);
            audit.update(&world);
            most = most.max(world.mechanisms().map(|m| m.tension.abs()).fold(0.0, f64::max));
        }
        println!(
            "{integrator:?}: linear {:.1e}, angular {:.1e}, largest strut force {most:.0} N, {:?}",
            audit.linear_drift,
            audit.angular_drift,
            world.state().work
        );
        // Rounding of 10,000 steps.
        assert!(audit.linear_drift < 1e-13 && audit.angular_drift < 1e-13, "{integrator:?}");
        assert!(most > 30.0, "the ring was struck");
    }
}

#[test]
fn swapping_the_sides_of_every_mechanism_changes_nothing_but_rounding() {
    for integrator in ALL {
        let [one, other] = [false, true].map(|swap| {
            let mut world = struck_ring(ring_strut(), &Setup::new(integrator));
            if swap {
                let mut spec = ring_spec(ring_strut(), &Setup::new(integrator));
                spec.mechanisms.clone_from(&world.model().mechanisms);
                spec.mechanisms.iter_mut().for_each(|m| std::mem::swap(&mut m.side_a, &mut m.side_b));
                world = crate::support::world(spec);
                start_ring(&mut world);
            }
            let before: Vec<_> = world.mechanisms().map(|m| m.wrench_w.force).collect();
            run(&mut world, 1_000);
            (before, world.state().bases.clone())
        });
        for (a, b) in one.0.iter().zip(&other.0).take(6) {
            assert_eq!(*a, -*b, "a strut's force flips to the last bit");
        }
        for (a, b) in one.1.iter().zip(&other.1) {
            let off = (a.translation.vector - b.translation.vector).norm() + a.rotation.angle_to(&b.rotation);
            assert!(off < 1e-7, "{integrator:?}: {off:e}"); // acos near one
        }
    }
}

#[test]
fn turned_shifted_and_drifting_world_shows_the_same_ring() {
    use spatial::{Rot, Twist};
    let turn = Pose::from_parts(Vec3::new(0.4, -0.2, 0.3).into(), Rot::from_scaled_axis(Vec3::new(0.5, -1.1, 0.7)));
    for integrator in ALL {
        let drift = Vec3::new(0.3, -0.2, 0.1);
        let relative = |change: &dyn Fn(&Pose) -> Pose, drift: Vec3| {
            let mut world = struck_ring(ring_strut(), &Setup::new(integrator));
            let twists: Vec<_> = (0..3).map(|i| world.kinematics(i).vel[0]).collect();
            let rot = change(&Pose::identity()).rotation;
            world.state_mut().bases.iter_mut().for_each(|b| *b = change(b));
            let moved: Vec<_> = twists.iter().map(|t| Twist::new(rot * t.ang, rot * t.lin + drift)).collect();
            world.set_base_twists(&moved);
            run(&mut world, 500);
            let bases = &world.state().bases;
            [bases[0].inverse() * bases[1], bases[0].inverse() * bases[2]]
        };
        let plain = relative(&|p| *p, Vec3::zeros());
        let off = |other: [Pose; 2]| {
            plain
                .iter()
                .zip(&other)
                .map(|(a, b)| (a.translation.vector - b.translation.vector).norm())
                .fold(0.0, f64::max)
        };
        let (turned, drifting) = (off(relative(&|p| turn * p, Vec3::zeros())), off(relative(&|p| *p, drift)));
        println!("{integrator:?}: turned {turned:.1e} m, drifting {drifting:.1e} m");
        assert!(turned < 1e-12, "{integrator:?}");
        // Runge–Kutta's stages take L and x × p with their own errors: invariant to its order only.
        let bound = if integrator == Integrator::RungeKutta4 { 1e-8 } else { 1e-11 };
        assert!(drifting < bound, "{integrator:?}: {drifting:e}");
    }
}

#[test]
fn mechanism_that_cannot_be_is_refused_with_its_name() {
    let refuse = |kind: MechanismKind| {
        let tie = mechanism("leg", at(0, 0.0, 0.0, 0.0), at(1, 0.0, 0.0, 0.0), kind);
        sim::Model::build(two_blocks_spec([1.0, 1.0], vec![tie], &Setup::new(Integrator::ImplicitEuler)))
            .unwrap_err()
            .to_string()
    };
    let reversed = refuse(MechanismKind::Strut(Strut { stroke: [1.0, 0.5], ..Strut::default() }));
    assert!(reversed.contains("\"leg\"") && reversed.contains("ascend"), "{reversed}");
    let negative = refuse(MechanismKind::Strut(Strut { damping: -1.0, ..Strut::default() }));
    assert!(negative.contains("damping = -1"), "{negative}");
    let tie = mechanism("leg", at(0, 0.0, 0.0, 0.0), at(0, 0.1, 0.0, 0.0), MechanismKind::Strut(Strut::default()));
    let spec = two_blocks_spec([1.0, 1.0], vec![tie], &Setup::new(Integrator::ImplicitEuler));
    assert!(sim::Model::build(spec).unwrap_err().to_string().contains("same body"));
}
