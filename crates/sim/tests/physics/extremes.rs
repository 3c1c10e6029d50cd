//! A speck between giants, and a rod that jams: where contact dynamics is said to break down.

use crate::support::{Setup, block, bristle, linear, link, robot, run, shape, spec, twist, world};
use contact::Shape;
use sim::{Actuator, ActuatorKind, Base, Energy, Integrator, MomentumAudit, PairLaw, ShapeSpec, World};
use spatial::{Pose, Rot, Vec3};

/// kg; N/m of either contact; N of either thruster; m.
const GIANT: f64 = 1e5;
const SPECK: f64 = 1e-6;
const STIFFNESS: f64 = 1e5;
const PUSH: f64 = 10.0;
const RADIUS: f64 = 1e-3;

/// A ball of 1 mg between two free bodies of 100 t, each pushed at it by a thruster of 10 N.
fn squeezed(setup: &Setup) -> World {
    let half = Vec3::new(1.5, 1.0, 1.0);
    let ball =
        robot(vec![link("speck", SPECK, Vec3::zeros(), Vec3::repeat(0.4 * SPECK * RADIUS * RADIUS))], Vec::new());
    let free = |tree| (tree, Base::Free);
    let mut spec = spec(vec![free(block(GIANT, half)), free(ball), free(block(GIANT, half))], setup);
    let cuboid = || Shape::Cuboid { half_extents: half };
    spec.shapes = vec![
        shape("left", Some(0), cuboid()),
        shape("speck", Some(1), Shape::Ball { radius: RADIUS }),
        shape("right", Some(2), cuboid()),
    ];
    let law = PairLaw::new(linear(STIFFNESS, 0.0), Some(bristle(0.3, 1e4, 0.0)));
    spec.pairs = vec![([0, 1], law), ([1, 2], law)];
    let jet = |name: &str, body, direction| Actuator {
        name: name.to_owned(),
        kind: ActuatorKind::Thruster { body, position: Vec3::zeros(), direction, max_force: PUSH },
    };
    spec.actuators = vec![jet("left", 0, Vec3::x()), jet("right", 2, -Vec3::x())];
    let mut world = world(spec);
    let place = half.x + RADIUS;
    world.state_mut().bases[0] = Pose::translation(-place, 0.0, 0.0);
    world.state_mut().bases[2] = Pose::translation(place, 0.0, 0.0);
    for command in world.commands_mut() {
        command.effort = PUSH;
    }
    world
}

/// Two masses M on a spring of k/2 (two contacts in series), put under ±F at once: N = F (1 − cos ω t), ω² = k/M = 1 /s².
/// The speck between them would swing at √(2k/m) = 4.5e5 rad/s.
#[test]
fn a_milligram_between_hundred_tonnes_passes_on_the_force_of_both() {
    for (integrator, tolerance) in [(Integrator::ImplicitEuler, 2e-3), (Integrator::ImplicitMidpoint, 2e-3)] {
        let mut world = squeezed(&Setup::new(integrator));
        // A little off the middle, and at rest.
        world.state_mut().bases[1] = Pose::translation(1e-7, 2e-6, 0.0);
        let mut audit = MomentumAudit::new(&world);
        let omega = (STIFFNESS / GIANT).sqrt();
        let mut worst = 0.0_f64;
        for _ in 0..3_000 {
            run(&mut world, 1);
            let expected = PUSH * (1.0 - (omega * world.state().time).cos());
            let forces: Vec<f64> = world.touches().map(|t| t.force_w.x).collect();
            let held = forces.len() == 2;
            assert!(held || world.state().time < 0.05, "{integrator:?}: lost at {} s", world.state().time);
            for force in forces.iter().filter(|_| world.state().time > 0.1) {
                worst = worst.max((force - expected).abs() / (2.0 * PUSH));
            }
        }
        audit.update(&world);
        let speck = world.kinematics(1).vel[0].lin.norm();
        let unconverged = world.state().work.unconverged_steps;
        println!("{integrator:?}: force off by {worst:.1e}, speck at {speck:.1e} m/s, {unconverged} steps unconverged");
        assert!(worst < tolerance, "{integrator:?}: {worst}");
        assert!(speck < 1e-6, "{integrator:?}: {speck} m/s");
        assert_eq!(unconverged, 0);
        // Both are pushed with the same force: of 10 N over 3 s, 30 N·s each, nothing is left of the sum but rounding.
        assert!(audit.absolute[0] < 30.0 * 1e-13, "{integrator:?}: {:e} N·s", audit.absolute[0]);
    }
}

#[test]
fn a_milligram_hit_by_hundred_tonnes_flies_off_at_twice_their_speed() {
    for (integrator, step) in [(Integrator::ImplicitMidpoint, 1e-7), (Integrator::RungeKutta4, 2e-7)] {
        let mut spec = squeezed(&Setup::new(integrator).step(step)).model().as_ref().clone();
        spec.actuators.clear();
        let model = std::sync::Arc::new(spec);
        let mut state = sim::State::new(&model);
        state.bases[0] = Pose::translation(-1.5 - RADIUS - 1e-9, 0.0, 0.0);
        state.bases[2] = Pose::translation(10.0, 0.0, 0.0);
        let mut world = World::new(model, state);
        let still = twist([0.0; 3], [0.0; 3]);
        world.set_base_twists(&[twist([0.0; 3], [0.1, 0.0, 0.0]), still, still]);
        let before = world.state().momentum[0].force.x + world.state().momentum[1].force.x;
        run(&mut world, (3e-5 / step) as usize);
        let speed = world.kinematics(1).vel[0].lin.x;
        let after = world.state().momentum[0].force.x + world.state().momentum[1].force.x;
        println!("{integrator:?}: {speed} m/s");
        // Elastic, against an infinite mass: 2 v. A contact of 10 µs is resolved by 50 steps and more.
        assert!((speed / 0.2 - 1.0).abs() < 2e-3, "{integrator:?}: {speed} m/s");
        assert!((after - before).abs() < 1e-15 * before.abs(), "{integrator:?}: {:e}", after - before);
    }
}

/// Half the rod's length, m; its mass is 1 kg.
const HALF: f64 = 0.5;
/// Stiffness of its floor, N/m.
const FLOOR: f64 = 1e5;
/// Of the tip, m: far below the length.
const TIP: f64 = 1e-3;
/// tan θ = 2: the angle at which the least friction jams a slender rod, μ = 4/3.
const LEAN: f64 = 1.107_148_717_794_090_4;

/// A slender rod on a rough floor, its tip first: it stands on it at an angle and slides the way it points.
///
/// With λ the normal force, the tip's normal acceleration is  p λ − g + …,  p = 1 + 3 cos²θ − 3 μ sin θ cos θ  per kilogramme:
/// beyond μ = 4/3 it is negative at tan θ = 2, and the rigid problem has no solution (Painlevé 1895; Génot and
/// Brogliato 1999). On a floor that yields, force and depth grow together until the tip has stopped: it jams, and is thrown up.
fn rod(mu: f64, setup: &Setup) -> World {
    let inertia = HALF * HALF / 3.0;
    let tree = robot(vec![link("rod", 1.0, Vec3::zeros(), Vec3::new(1e-4, inertia, inertia))], Vec::new());
    let mut spec = spec(vec![(tree, Base::Free)], &setup.gravity(Vec3::new(0.0, 0.0, -9.81)));
    // The tip is at −x of the rod; its centre stands along θ from it.
    let tip = shape("tip", Some(0), Shape::Ball { radius: TIP });
    spec.shapes =
        vec![shape("floor", None, Shape::HalfSpace), ShapeSpec { pose_ls: Pose::translation(-HALF, 0.0, 0.0), ..tip }];
    spec.pairs = vec![([0, 1], PairLaw::new(linear(FLOOR, 30.0), Some(bristle(mu, FLOOR, 30.0))))];
    let mut world = world(spec);
    let turned = Rot::from_scaled_axis(Vec3::y() * -LEAN);
    let centre = Vec3::new(HALF * LEAN.cos(), 0.0, HALF * LEAN.sin() + TIP);
    world.state_mut().bases[0] = Pose::from_parts(centre.into(), turned);
    world.set_base_twists(&[twist([0.0; 3], [-1.0, 0.0, 0.0])]);
    world
}

/// Of motion, of weight and in the contact, J.
fn total(world: &World) -> f64 {
    let energy = Energy::of(world);
    energy.kinetic + energy.potential + energy.elastic
}

/// What becomes of a rod in 0.1 s.
#[derive(Debug)]
struct Slide {
    /// Place of the centre, m, lean, rad, and speed of the centre, m/s.
    end: [f64; 5],
    /// Largest normal force, N.
    hardest: f64,
    /// When the tip first stood still on the floor, s.
    stopped: Option<f64>,
}

fn slide(mu: f64, integrator: Integrator, step: f64) -> Slide {
    let mut world = rod(mu, &Setup::new(integrator).step(step));
    let (start, mut hardest, mut stopped) = (total(&world), 0.0_f64, None);
    for _ in 0..(0.1 / step).round() as usize {
        run(&mut world, 1);
        for touch in world.touches().filter(|t| t.normal_force > 0.0) {
            hardest = hardest.max(touch.normal_force);
            let tip = world.kinematics(0).vel[0].at(&(touch.point_w - world.kinematics(0).anchor));
            if tip.x >= 0.0 {
                stopped = stopped.or(Some(world.state().time));
            }
        }
        // 0.5 J of sliding and 4.4 J of height; a step of 1 ms may misplace 1 mJ of them in the contact.
        assert!(total(&world) < start + 1e-3, "{integrator:?}, μ = {mu}: {} J from {start} J", total(&world));
    }
    let (base, vel) = (world.state().bases[0], world.kinematics(0).vel[0]);
    let at = base.translation.vector;
    let lean = base.rotation * Vec3::x();
    Slide { end: [at.x, at.z, lean.z.atan2(lean.x), vel.lin.x, vel.lin.z], hardest, stopped }
}

/// When friction stops a tip of 1 m/s on a floor of stiffness k, the lean taken as constant, s.
///
/// Per unit of λ the tip is raised by p and slowed by q = μ (1 + 3 sin²θ) − 3 sin θ cos θ. Below μ = 4/3 the floor bears λ = g/p, and
/// t = p/(g q). Beyond, the depth grows by itself, δ̈ = g + κ² δ with κ² = −p k, and t is where q k ∫ δ dt is 1 m/s:
/// (g q/−p)(sinh κt/κ − t) = 1.
fn calc_stop(mu: f64) -> f64 {
    let (sin, cos) = LEAN.sin_cos();
    let (p, q) = (1.0 + 3.0 * cos * cos - 3.0 * mu * sin * cos, mu * (1.0 + 3.0 * sin * sin) - 3.0 * sin * cos);
    if p > 0.0 {
        return p / (9.81 * q);
    }
    let kappa = (-p * FLOOR).sqrt();
    let slowed = |t: f64| 9.81 * q / -p * ((kappa * t).sinh() / kappa - t);
    let (mut early, mut late) = (0.0, 0.1);
    for _ in 0..60 {
        let middle = 0.5 * (early + late);
        if slowed(middle) < 1.0 { early = middle } else { late = middle }
    }
    late
}

#[test]
fn painleves_rod_slides_below_its_friction_and_jams_beyond_and_never_diverges() {
    for mu in [0.5, 1.0, 1.5, 2.0, 3.0, 4.0] {
        let exact = slide(mu, Integrator::RungeKutta4, 2e-6);
        let is_sensitive = mu == 1.5;
        println!("μ = {mu}: {exact:.4?}");
        let expected = calc_stop(mu);
        match exact.stopped {
            // A fifth: the rod turns meanwhile by some degrees, and the contact damps.
            Some(at) => {
                assert!((at / expected - 1.0).abs() < 0.2, "μ = {mu}: stopped at {at} s, {expected} s expected")
            }
            None => assert!(expected > 0.1, "μ = {mu}: it should have stopped at {expected} s"),
        }
        // Steps of 1 ms do not resolve a blow of 10 ms: where it has been, and how hard, must not be far off. Finer ones
        // converge: first order, and second but for the corners of the law. At μ = 1.5, where most hangs on when the rod jams, Euler's steps of 40, 10 and 2.5 µs are
        // off by 0.15, 0.021 and 0.0040, midpoint's of 1e-4 and 1e-5 by 9.0e-3 and 1.1e-3; elsewhere by a tenth of that.
        for (integrator, step, tolerance, force_tolerance) in [
            (Integrator::ImplicitEuler, 1e-3, 0.5, 0.4),
            (Integrator::ImplicitEuler, 1e-5, if is_sensitive { 3e-2 } else { 5e-3 }, 0.01),
            (Integrator::ImplicitEuler, 2.5e-6, 6e-3, 0.002),
            (Integrator::ImplicitMidpoint, 1e-3, 0.1, 0.1),
            (Integrator::ImplicitMidpoint, 1e-4, if is_sensitive { 1.5e-2 } else { 5e-3 }, 0.01),
            (Integrator::ImplicitMidpoint, 1e-5, if is_sensitive { 2e-3 } else { 3e-4 }, 0.002),
        ] {
            let got = slide(mu, integrator, step);
            let off = got.end.iter().zip(exact.end).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            let force = (got.hardest / exact.hardest - 1.0).abs();
            println!(
                "  {integrator:?} {step:.0e}: off by {off:.2e}, force by {force:.1e}, stopped at {:?}",
                got.stopped
            );
            assert!(off < tolerance, "{integrator:?} at {step} s, μ = {mu}: off by {off}");
            assert!(force < force_tolerance, "{integrator:?} at {step} s, μ = {mu}: force off by {force}");
        }
    }
}

#[test]
fn giants_keep_their_energy_through_a_speck() {
    let mut world = squeezed(&Setup::new(Integrator::ImplicitMidpoint));
    run(&mut world, 3_000);
    let work: f64 = world.works().actuators.iter().sum();
    let held = Energy::of(&world);
    // k/2 against ±F: what the thrusters gave is in the two springs and in the motion.
    assert!(((held.kinetic + held.elastic) / work - 1.0).abs() < 1e-3, "{held:?} of {work} J");
}
