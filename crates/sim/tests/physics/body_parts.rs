//! What moves inside a body: slosh, a flexible mode, an inner sphere. Momentum to rounding, frequencies and energies in
//! closed form, neutral parts.

use crate::body_loads::effect;
use crate::support::{ALL, Setup, arm7, link, robot, run, spec, twist, world};
use multibody::{Inertial, LinkDescription, Tree};
use sim::{Appendage, Base, BodyLaw, Energy, Integrator, Load, ModelSpec, MomentumAudit, Slosh, Sphere, World};
use spatial::{Inertia, Mat3, Vec3};
use std::f64::consts::TAU;

/// A body of 45 kg with products of inertia and its centre of mass off the origin.
fn nominal() -> LinkDescription {
    let com = Vec3::new(0.1, -0.05, 0.2);
    let tensor_com = Mat3::new(9.5, 0.1, -0.2, 0.1, 16.0, 0.3, -0.2, 0.3, 21.5);
    LinkDescription { inertial: Some(Inertial { mass: 45.0, com, tensor_com }), ..link("body", 45.0, com, Vec3::x()) }
}

fn tree(link: LinkDescription) -> Tree {
    robot(vec![link], Vec::new())
}

/// The link without what a part takes with it.
fn without(link: LinkDescription, law: &BodyLaw) -> LinkDescription {
    let whole = link.inertial.unwrap();
    let left = match law {
        BodyLaw::Load(_) => Ok(whole),
        BodyLaw::Slosh(s) => whole.without_point(s.mass, &s.rest),
        BodyLaw::Appendage(m) => whole.without_mode(&m.coupling),
        BodyLaw::Sphere(s) => whole.without_sphere(s.inertia),
    };
    LinkDescription { inertial: Some(left.unwrap()), ..link }
}

/// The body with parts, tumbling, the parts at rest in it.
fn with_parts(laws: &[BodyLaw], base: Base, setup: &Setup) -> World {
    let effects = laws.iter().map(|law| effect(*law)).collect();
    let body = tree(laws.iter().fold(nominal(), without));
    let mut world = world(ModelSpec { effects, ..spec(vec![(body, base)], setup) });
    world.set_base_twists(&[twist([0.3, 0.5, -0.2], [0.1, 0.0, 0.2])]);
    world
}

fn slosh(mass: f64, frequency: f64, damping: f64) -> BodyLaw {
    BodyLaw::Slosh(Slosh { mass, rate: TAU * frequency, damping, rest: Vec3::new(0.35, 0.1, 0.45) })
}

fn mode(size: f64, frequency: f64, damping: f64) -> BodyLaw {
    BodyLaw::Appendage(Appendage { rate: TAU * frequency, damping, coupling: size * Vec3::new(0.8, -0.4, 0.6) })
}

fn all_parts(size: f64) -> [BodyLaw; 3] {
    [slosh(4.0 * size, 0.4, 0.02), mode(2.0 * size, 0.6, 0.01), BodyLaw::Sphere(Sphere { inertia: 1.5 * size, c: 0.4 })]
}

/// Deflects every part and lets it move.
fn disturb(world: &mut World) {
    let n = world.effect_memory().len();
    let relative: Vec<f64> = (0..n).map(|k| 0.05 - 0.02 * k as f64).collect();
    world.set_effect_memory(&relative);
}

#[test]
fn parts_inside_keep_the_momentum_of_the_whole_to_rounding() {
    for integrator in ALL {
        let mut world = with_parts(&all_parts(1.0), Base::Free, &Setup::new(integrator));
        disturb(&mut world);
        let mut audit = MomentumAudit::new(&world);
        for _ in 0..20_000 {
            run(&mut world, 1);
            audit.update(&world);
        }
        let (linear, angular) = (audit.linear_drift, audit.angular_drift);
        println!("{integrator:?}: drift {linear:.1e}, {angular:.1e}");
        assert!(linear < 1e-12 && angular < 1e-12);
    }
}

#[test]
fn the_audit_counts_what_the_parts_carry() {
    let mut world = with_parts(&all_parts(1.0), Base::Free, &Setup::new(Integrator::RungeKutta4));
    let audit = MomentumAudit::new(&world);
    // A hand that reaches inside and pushes the particle is a force from outside.
    world.state_mut().effects[3] += 1e-3;
    world.refresh();
    let mut after = audit;
    after.update(&world);
    assert!(after.absolute[0] < 1e-13, "the state's momentum is the whole's: the body gave way");
    let kept = world.kinematics(0).vel[0];
    let mut relative = world.effect_memory();
    relative[3] += 1e-3;
    world.set_effect_memory(&relative);
    let moved = world.kinematics(0).vel[0] - kept;
    assert!(moved.ang.norm() + moved.lin.norm() < 1e-15, "the body keeps its twist, so the whole gains");
    after.update(&world);
    assert!(after.absolute[0] > 3e-3);
}

#[test]
fn what_dampers_take_is_what_the_energy_falls_by() {
    let total = |w: &World| {
        let energy = Energy::of(w);
        energy.kinetic + energy.effect + w.state().account.effect_loss
    };
    for integrator in ALL {
        let mut world = with_parts(&all_parts(1.0), Base::Free, &Setup::new(integrator));
        disturb(&mut world);
        let start = total(&world);
        run(&mut world, 10_000);
        let (loss, drift) = (world.state().account.effect_loss, total(&world) / start - 1.0);
        println!("{integrator:?}: {loss:.3e} J of {start:.3} J lost, balance off by {drift:.1e}");
        let bound = match integrator {
            Integrator::RungeKutta4 => 1e-11,
            Integrator::ImplicitMidpoint => 1e-5,
            _ => 1e-3,
        };
        assert!(loss > 0.01 * start && drift.abs() < bound);
    }
}

#[test]
fn each_scheme_has_its_order_with_every_part() {
    for law in all_parts(1.0) {
        for (integrator, order) in ALL.into_iter().zip([1.0, 2.0, 1.0, 4.0]) {
            let end = |step: f64| {
                let mut world = with_parts(&[law], Base::Free, &Setup::new(integrator).step(step));
                disturb(&mut world);
                run(&mut world, (10.0 / step).round() as usize);
                world.kinematics(0).vel[0].ang
            };
            let (coarse, fine) = ((end(0.02) - end(0.01)).norm(), (end(0.01) - end(0.005)).norm());
            let measured = (coarse / fine).log2();
            println!("{integrator:?}: order {measured:.2}, {fine:.1e} rad/s between 10 and 5 ms; {law:?}");
            assert!((measured - order).abs() < 0.15);
        }
    }
}

/// Frequency from the first and the last of the upward zero crossings of a relative coordinate, Hz.
fn calc_frequency(world: &mut World, slot: usize, seconds: f64) -> f64 {
    let (mut before, mut crossings) = (world.effect_memory()[slot], Vec::new());
    let step = world.model().step;
    while world.state().time < seconds {
        run(world, 1);
        let now = world.effect_memory()[slot];
        if before < 0.0 && now >= 0.0 {
            crossings.push(world.state().time - step * now / (now - before));
        }
        before = now;
    }
    (crossings.len() - 1) as f64 / (crossings.last().unwrap() - crossings[0])
}

/// Relative error of a frequency at 0.5 Hz: RK4 and midpoint by their order; the Euler pair by (h ω)²/24 and first-order
/// coupling.
fn frequency_tolerance(integrator: Integrator) -> f64 {
    if matches!(integrator, Integrator::RungeKutta4) { 1e-7 } else { 1e-4 }
}

#[test]
fn slosh_rings_with_its_body_held_and_faster_with_it_free() {
    for integrator in ALL {
        let rest = nominal().inertial.unwrap().com;
        let law = BodyLaw::Slosh(Slosh { mass: 9.0, rate: TAU * 0.5, damping: 0.0, rest });
        // M/(M − m) = 45/36: the free pair rings at √(5/4) of the held frequency.
        for (base, ratio) in [(Base::Fixed, 1.0), (Base::Free, 1.25_f64.sqrt())] {
            let mut world = with_parts(&[law], base, &Setup::new(integrator));
            world.set_base_twists(&[twist([0.0; 3], [0.0; 3])]);
            world.set_effect_memory(&[0.01, 0.0, 0.0, 0.0, 0.0, 0.0]);
            let f = calc_frequency(&mut world, 0, 20.0);
            println!("{integrator:?} {base:?}: {f:.8} Hz, theory {:.8}", 0.5 * ratio);
            assert!((f / (0.5 * ratio) - 1.0).abs() < frequency_tolerance(integrator));
        }
    }
}

#[test]
fn a_flexible_mode_rings_faster_on_a_free_body() {
    // δ along a principal axis z of moment J: Ω / √(1 − δ²/J).
    for integrator in ALL {
        let body = link("body", 45.0, Vec3::zeros(), Vec3::new(10.0, 12.0, 20.0));
        let law = BodyLaw::Appendage(Appendage { rate: TAU * 0.5, damping: 0.0, coupling: 2.0 * Vec3::z() });
        let effects = vec![effect(law)];
        let mut world = world(ModelSpec {
            effects,
            ..spec(vec![(tree(without(body, &law)), Base::Free)], &Setup::new(integrator))
        });
        world.set_base_twists(&[twist([0.0; 3], [0.0; 3])]);
        world.set_effect_memory(&[0.01, 0.0]);
        let (f, expected) = (calc_frequency(&mut world, 0, 20.0), 0.5 / (1.0_f64 - 4.0 / 20.0).sqrt());
        println!("{integrator:?}: {f:.8} Hz, theory {expected:.8}");
        assert!((f / expected - 1.0).abs() < frequency_tolerance(integrator));
    }
}

#[test]
fn a_damper_turns_any_tumble_into_a_spin_about_the_largest_axis() {
    let body = link("body", 45.0, Vec3::zeros(), Vec3::new(10.0, 16.0, 22.0));
    let law = BodyLaw::Sphere(Sphere { inertia: 3.0, c: 3.0 });
    let effects = vec![effect(law)];
    let setup = Setup::new(Integrator::RungeKutta4).step(0.02);
    let mut world = world(ModelSpec { effects, ..spec(vec![(tree(without(body, &law)), Base::Free)], &setup) });
    world.set_base_twists(&[twist([1.5, 0.05, 0.1], [0.0; 3])]);
    let momentum = world.state().momentum[0].moment;
    let mut energy = Energy::of(&world).kinetic + Energy::of(&world).effect;
    for _ in 0..60 {
        run(&mut world, 500);
        let now = Energy::of(&world).kinetic + Energy::of(&world).effect;
        // Round-off, once it is at its floor.
        assert!(now <= energy * (1.0 + 1e-12), "energy never rises");
        energy = now;
    }
    let axis = world.state().bases[0].rotation * Vec3::z();
    let tilt = axis.cross(&momentum.normalize()).norm();
    // At rest in the spin about the largest axis: E = L²/(2 I₃).
    let floor = momentum.norm_squared() / (2.0 * 22.0);
    println!(
        "after {} s: axis {tilt:.1e} rad from L, energy {:.2e} above its floor",
        world.state().time,
        energy / floor - 1.0
    );
    assert!(tilt < 1e-3 && (energy / floor - 1.0).abs() < 1e-6);
    assert_eq!(world.state().momentum[0].moment, momentum);
}

#[test]
fn stiff_parts_move_as_if_locked() {
    // At 20 Hz against a tumble of 0.6 rad/s: the deflection goes with (ω/Ω)², 2e-5 of the part's lever.
    let setup = Setup::new(Integrator::RungeKutta4).step(2e-3);
    let end = |laws: &[BodyLaw]| {
        let mut world = with_parts(laws, Base::Free, &setup);
        run(&mut world, 2_500);
        (world.state().bases[0], world.kinematics(0).vel[0])
    };
    let (pose, vel) = end(&[]);
    for law in [slosh(4.0, 20.0, 0.7), mode(2.0, 20.0, 0.7), BodyLaw::Sphere(Sphere { inertia: 1.5, c: 300.0 })] {
        let (other, twist) = end(&[law]);
        let off = pose.rotation.angle_to(&other.rotation);
        println!("{law:?}: {off:.1e} rad, {:.1e} rad/s off", (twist.ang - vel.ang).norm());
        assert!(off < 2e-3 && (twist.ang - vel.ang).norm() < 1e-3);
        assert!((twist.lin - vel.lin).norm() < 1e-3);
    }
}

#[test]
fn a_falling_tank_does_not_slosh() {
    let setup = Setup::new(Integrator::RungeKutta4).gravity(Vec3::new(0.0, 0.0, -9.81));
    let mut world = with_parts(&[slosh(4.0, 0.4, 0.02)], Base::Free, &setup);
    world.set_base_twists(&[twist([0.0; 3], [0.0; 3])]);
    let mut audit = MomentumAudit::new(&world);
    let total = |w: &World| Energy::of(w).kinetic + Energy::of(w).potential + Energy::of(w).effect;
    let start = total(&world);
    run(&mut world, 1000);
    audit.update(&world);
    assert!((total(&world) - start).abs() < 1e-9, "some 2 kJ of fall come back as motion");
    assert!((world.state().account.environment_work - 0.5 * 45.0 * 9.81 * 9.81).abs() < 1e-9);
    assert!(world.effect_memory().iter().all(|x| x.abs() < 1e-12));
    assert!((world.state().account.impulse.force.z + 45.0 * 9.81).abs() < 1e-9, "the particle's weight counts");
    assert!(audit.linear_drift < 1e-12);
}

/// The seven-joint arm with a tank and a damper in its third link and a mode on its base.
fn arm_with_parts(integrator: Integrator, base: Base) -> World {
    let slosh = BodyLaw::Slosh(Slosh { mass: 0.5, rate: 4.0, damping: 0.05, rest: Vec3::new(0.05, 0.02, 0.1) });
    let sphere = BodyLaw::Sphere(Sphere { inertia: 0.005, c: 0.002 });
    let mode = BodyLaw::Appendage(Appendage { rate: 3.0, damping: 0.02, coupling: Vec3::new(0.3, 0.5, 0.2) });
    let at = |link: usize, law: BodyLaw| sim::Effect {
        name: format!("{law:?}"),
        kind: sim::EffectKind::Body(sim::BodyEffect::new(0, link, law)),
    };
    let effects = vec![at(3, slosh), at(3, sphere), at(0, mode)];
    let mut tree = arm7();
    for effect in &effects {
        let sim::EffectKind::Body(body) = &effect.kind else { continue };
        let inertia = &mut tree.bodies[body.place().link].inertia;
        let own = Inertial { mass: inertia.mass, com: inertia.com(), tensor_com: inertia.tensor_com() };
        let left = match &body.law {
            BodyLaw::Slosh(s) => own.without_point(s.mass, &s.rest),
            BodyLaw::Appendage(m) => own.without_mode(&m.coupling),
            BodyLaw::Sphere(s) => own.without_sphere(s.inertia),
            BodyLaw::Load(_) => Ok(own),
        }
        .unwrap();
        *inertia = Inertia::from_com(left.mass, &left.com, &left.tensor_com);
        tree.links[body.place().link].inertia = *inertia;
    }
    let mut world = world(ModelSpec { effects, ..spec(vec![(tree, base)], &Setup::new(integrator)) });
    for k in 0..7 {
        world.state_mut().v[k] = 0.4 - 0.1 * k as f64;
        world.state_mut().q[k] = 0.2 * k as f64 - 0.5;
    }
    world.set_base_twists(&[twist([0.02, -0.05, 0.03], [0.01, 0.02, 0.0])]);
    disturb(&mut world);
    world
}

#[test]
fn parts_in_the_links_of_an_arm_keep_the_books() {
    let total = |w: &World| {
        let energy = Energy::of(w);
        energy.kinetic + energy.effect + w.state().account.effect_loss
    };
    for (integrator, bound) in ALL.into_iter().zip([3e-3, 5e-6, 3e-3, 1e-11]) {
        let mut world = arm_with_parts(integrator, Base::Free);
        let (mut audit, start) = (MomentumAudit::new(&world), total(&world));
        run(&mut world, 4000);
        audit.update(&world);
        let (drift, energy) = (audit.linear_drift.max(audit.angular_drift), total(&world) / start - 1.0);
        println!("{integrator:?}: momentum {drift:.1e}, energy balance {energy:.1e}");
        assert!(drift < 1e-12 && energy.abs() < bound);
        assert!(world.state().account.effect_loss > 1e-3 * start);
    }
}

#[test]
fn parts_in_guided_and_held_vehicles_keep_the_balance_of_energy() {
    let total = |w: &World| {
        let energy = Energy::of(w);
        energy.kinetic + energy.effect + w.state().account.effect_loss
    };
    for base in [Base::Fixed, Base::Only([false, false, true, true, true, false])] {
        let mut world = arm_with_parts(Integrator::RungeKutta4, base);
        let start = total(&world);
        run(&mut world, 4000);
        let energy = total(&world) / start - 1.0;
        println!("{base:?}: energy balance {energy:.1e}");
        assert!(energy.abs() < 1e-11);
    }
}

#[test]
fn a_step_with_parts_allocates_nothing() {
    for integrator in ALL {
        let mut world = arm_with_parts(integrator, Base::Free);
        run(&mut world, 10);
        let info = allocation_counter::measure(|| run(&mut world, 50));
        assert_eq!(info.count_total, 0, "{integrator:?}");
    }
}

#[test]
fn neutral_parts_change_no_bit_and_beside_neutral_they_do() {
    let end = |laws: &[BodyLaw], integrator| {
        let mut world = with_parts(laws, Base::Free, &Setup::new(integrator));
        if !laws.is_empty() {
            disturb(&mut world);
        }
        run(&mut world, 200);
        // As text: a zero with the other sign is another bit.
        format!("{:?}", (world.state().bases[0], world.kinematics(0).vel[0], world.state().momentum[0]))
    };
    for integrator in ALL {
        let nominal = end(&[], integrator);
        assert_eq!(end(&all_parts(0.0), integrator), nominal, "{integrator:?}");
        for law in [slosh(1e-6, 0.4, 0.02), mode(1e-6, 0.6, 0.01), BodyLaw::Sphere(Sphere { inertia: 1e-6, c: 1e-6 })] {
            assert_ne!(end(&[law], integrator), nominal, "{integrator:?}: {law:?}");
        }
    }
}

#[test]
fn a_load_knows_its_body_with_the_parts_locked() {
    // Gravity gradient and a force at the centre of mass, on the body and on the body with parts: the same at the start.
    let first = |parts: &[BodyLaw]| {
        let loads = [
            Load::GravityGradient { mean_motion: 0.5 },
            Load::ConstantForce { vector: Vec3::new(1.0, 2.0, 3.0), axes: sim::Axes::World },
        ];
        let laws: Vec<_> = loads.map(BodyLaw::Load).into_iter().chain(parts.iter().copied()).collect();
        let mut world = with_parts(&laws, Base::Free, &Setup::new(Integrator::SemiImplicitEuler));
        run(&mut world, 1);
        world.external_wrench(0)
    };
    let (alone, with) = (first(&[]), first(&all_parts(1.0)));
    assert!((alone.moment - with.moment).norm() < 1e-13 && alone.force == with.force);
}

#[test]
fn memory_says_how_parts_stand_in_the_body() {
    let mut world = with_parts(&all_parts(1.0), Base::Free, &Setup::new(Integrator::RungeKutta4));
    assert!(world.effect_memory().iter().all(|x| x.abs() < 1e-15), "at rest with the body after the start");
    disturb(&mut world);
    let slots = sim::memory_layout(world.model());
    assert_eq!(slots.len(), world.effect_memory().len());
    assert_eq!((slots[0].name, slots[6].name, slots[8].name), ("u.x", "eta", "omega.x"));
    for (k, x) in world.effect_memory().iter().enumerate() {
        assert!((x - (0.05 - 0.02 * k as f64)).abs() < 1e-14, "{}", slots[k].name);
    }
}
