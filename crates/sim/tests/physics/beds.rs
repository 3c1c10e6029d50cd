//! Distributed contact: a disc that slides and spins on its elastic foundation.

use crate::support::{Setup, bristle, linear, link, robot, shape, spec, twist, world};
use contact::{Bed, Shape};
use sim::{Base, Integrator, PairLaw, ShapeSpec, World};
use spatial::{Pose, Vec3};
use std::f64::consts::{FRAC_PI_2, PI};

const MU: f64 = 0.3;
const RADIUS: f64 = 0.1;
const MASS: f64 = 2.0;
const GRAVITY: f64 = 9.81;
/// Stiffness of all bristles, N/m: they reach 60 nm, nothing beside the radius.
const SHORT: f64 = 1e8;
/// Stiffness of the whole face, N/m.
const STIFFNESS: f64 = 1e6;
const WEIGHT: f64 = MASS * GRAVITY;

/// A disc whose centre of mass lies in its contact face, so that friction does not tilt it.
fn disc_world(face: Bed, integrator: Integrator, step: f64, bristles: f64) -> World {
    let inertia = MASS * RADIUS * RADIUS * Vec3::new(0.25, 0.25, 0.5);
    let tree = robot(vec![link("disc", MASS, Vec3::zeros(), inertia)], Vec::new());
    let setup = Setup::new(integrator).step(step).gravity(-GRAVITY * Vec3::z());
    let mut spec = spec(vec![(tree, Base::Free)], &setup);
    let pose_ls = Pose::rotation(PI * Vec3::x());
    spec.shapes =
        vec![shape("floor", None, Shape::HalfSpace), ShapeSpec { pose_ls, ..shape("face", Some(0), Shape::Bed(face)) }];
    spec.pairs = vec![([0, 1], PairLaw::new(linear(STIFFNESS, 2e3), Some(bristle(MU, bristles, 0.0))))];
    let mut world = world(spec);
    world.state_mut().bases[0] = Pose::translation(0.0, 0.0, -WEIGHT / STIFFNESS);
    world
}

/// Friction force along the motion and torque about the centre, at the present step, N and N·m.
fn friction_of(world: &World) -> (f64, f64) {
    let centre = world.state().bases[0].translation.vector;
    let (mut force, mut torque) = (Vec3::zeros(), 0.0);
    for touch in world.touches() {
        let tangential = touch.force_w - touch.normal_w * touch.normal_w.dot(&touch.force_w);
        force += tangential;
        torque += (touch.point_w - centre).cross(&tangential).z;
    }
    (-force.x, -torque)
}

/// Complete elliptic integrals K(m) and E(m) by the arithmetic–geometric mean (Abramowitz and Stegun 17.6).
fn elliptic(m: f64) -> (f64, f64) {
    let (mut a, mut b, mut power, mut sum) = (1.0_f64, (1.0 - m).sqrt(), 0.5, 0.5 * m);
    // Quadratic convergence: six rounds reach round-off for every m in use.
    for _ in 0..8 {
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        power *= 2.0;
        sum += power * c * c;
    }
    (FRAC_PI_2 / a, FRAC_PI_2 / a * (1.0 - sum))
}

/// Friction of a uniformly pressed disc over ε = v/(ωR): F/(μN) and T/(⅔ μNR).
///
/// Z. Farkas, G. Bartels, T. Unger and D. E. Wolf, "Frictional coupling between sliding and spinning motion", Phys. Rev.
/// Lett. 90 (2003) 248302; checked below against the integral itself.
fn contensou(eps: f64) -> (f64, f64) {
    let square = eps * eps;
    if eps <= 1.0 {
        let (k, e) = elliptic(square);
        let force = 4.0 / 3.0 * ((square + 1.0) * e + (square - 1.0) * k) / (eps * PI);
        return (force, 2.0 / 3.0 * ((4.0 - 2.0 * square) * e + (square - 1.0) * k) / PI);
    }
    let (k, e) = elliptic(1.0 / square);
    let force = 4.0 / 3.0 * ((square + 1.0) * e - (square - 1.0) * k) / PI;
    (force, 2.0 / 3.0 * eps * ((4.0 - 2.0 * square) * e + (2.0 * square - 5.0 + 3.0 / square) * k) / PI)
}

#[test]
fn contensou_curves_are_the_integral_of_coulomb_friction_over_the_disc() {
    for eps in [0.2_f64, 0.7, 1.6, 4.0] {
        let (rings, round) = (2000, 2000);
        let (mut force, mut torque) = (0.0, 0.0);
        for i in 0..rings {
            let r = (f64::from(i) + 0.5) / f64::from(rings);
            for j in 0..round {
                let (sin, cos) = (2.0 * PI * (f64::from(j) + 0.5) / f64::from(round)).sin_cos();
                let (ux, uy) = (eps - r * sin, r * cos);
                let speed = ux.hypot(uy);
                force += r * ux / speed;
                torque += r * (r * cos * uy - r * sin * ux) / speed;
            }
        }
        let scale = 2.0 / (f64::from(rings) * f64::from(round));
        let (f, t) = contensou(eps);
        // Midpoint sums round the kink at the instantaneous centre: error ∝ cell² log.
        assert!((force * scale - f).abs() < 1e-6 && (1.5 * torque * scale - t).abs() < 1e-6, "ε = {eps}");
    }
}

#[test]
fn spinning_and_sliding_disc_follows_the_contensou_curves() {
    let grid = [0.05, 0.2, 0.4, 0.6, 0.8, 0.95, 1.1, 1.5, 2.0, 4.0];
    println!("samples   largest error of F/(μN)   of T/(⅔ μNR)");
    for n in [8, 32, 64, 128, 256, 512] {
        let (mut worst_f, mut worst_t) = (0.0_f64, 0.0_f64);
        for eps in grid {
            let mut world = disc_world(Bed::disc(RADIUS, n), Integrator::ImplicitEuler, 1e-4, SHORT);
            let spin = 5.0 / (1.0_f64 + eps);
            world.set_base_twists(&[twist([0.0, 0.0, spin], [eps * spin * RADIUS, 0.0, 0.0])]);
            for _ in 0..4 {
                world.advance().unwrap();
            }
            let now = world.kinematics(0).vel[0];
            let (force, torque) = friction_of(&world);
            let (f, t) = contensou(now.lin.norm() / (now.ang.z * RADIUS));
            let normal: f64 = world.touches().map(|t| t.normal_force).sum();
            assert_eq!(world.touches().count(), n);
            assert!((normal / WEIGHT - 1.0).abs() < 1e-6);
            worst_f = worst_f.max((force / (MU * normal) - f).abs());
            worst_t = worst_t.max((1.5 * torque / (MU * normal * RADIUS) - t).abs());
        }
        println!("{n:7}   {worst_f:.1e}   {worst_t:.1e}");
        // The promise of 1 % is for 128 samples and more; below that only the order falls with the number.
        assert!(n < 128 || (worst_f < 1e-2 && worst_t < 1e-2));
    }
}

#[test]
fn sliding_disc_is_held_back_by_mu_n_and_spinning_one_by_two_thirds_mu_n_r() {
    for n in [8, 128, 2000] {
        let mut world = disc_world(Bed::disc(RADIUS, n), Integrator::ImplicitEuler, 1e-3, SHORT);
        world.set_base_twists(&[twist([0.0; 3], [0.5, 0.0, 0.0])]);
        (0..5).for_each(|_| world.advance().unwrap());
        let level = friction_of(&world).0 / (MU * WEIGHT);
        println!("{n} samples: friction {level:.9} of μN");
        assert!((level - 1.0).abs() < 1e-6);
        let mut world = disc_world(Bed::disc(RADIUS, n), Integrator::ImplicitEuler, 1e-3, SHORT);
        world.set_base_twists(&[twist([0.0, 0.0, 5.0], [0.0; 3])]);
        (0..5).for_each(|_| world.advance().unwrap());
        let torque = friction_of(&world).1 / (2.0 / 3.0 * MU * WEIGHT * RADIUS);
        println!("{n} samples: spin torque {torque:.9} of ⅔ μNR");
        // Bristles point along the last step's chord: off the tangent by ω h/2, the cosine of 2.5 mrad.
        assert!((torque - 1.0).abs() < 1e-5);
    }
}

#[test]
fn disc_stops_after_the_time_of_its_coulomb_friction_with_every_integrator() {
    // Pure sliding: v/(μ g), whatever the number of samples.
    for integrator in crate::support::ALL {
        // Bristles that the explicit ones resolve; stretching them by 6 µm takes 60 µs of the slide.
        let mut world = disc_world(Bed::disc(RADIUS, 32), integrator, 1e-4, 1e6);
        world.set_base_twists(&[twist([0.0; 3], [0.1, 0.0, 0.0])]);
        let steps = 200;
        (0..steps).for_each(|_| world.advance().unwrap());
        let speed = world.kinematics(0).vel[0].lin.x;
        let expected = 0.1 - MU * GRAVITY * 1e-4 * f64::from(steps);
        println!("{integrator:?}: {speed:.6} m/s after {steps} steps, Coulomb {expected:.6}");
        assert!((speed - expected).abs() < 2e-4);
    }
}

#[test]
fn weights_scale_every_part_of_the_law_exactly() {
    // Powers of two change no bit of a product: a quarter of the weight and four times the law are the same run.
    let half = Vec3::new(0.1, 0.1, 0.05);
    let corner = |i: usize| contact::BedSample {
        point: Vec3::new(if i & 1 == 0 { -0.1 } else { 0.1 }, if i & 2 == 0 { -0.1 } else { 0.1 }, -0.05),
        normal: -Vec3::z(),
        area: 1.0,
    };
    let bed = |area| Shape::Bed(Bed::new((0..4).map(corner).collect()).with_reference_area(area));
    let run = |face: Shape, k: f64, integrator| {
        let setup = Setup::new(integrator).step(2e-4).gravity(Vec3::new(1.0, 0.3, -9.81));
        let mut spec = spec(vec![(crate::support::block(1.0, half), Base::Free)], &setup);
        spec.shapes = vec![shape("floor", None, Shape::HalfSpace), shape("block", Some(0), face)];
        let normal = contact::Normal { adhesion: k * 0.1, ..linear(k * 1e5, k * 50.0) };
        let viscous = friction::Bristle {
            viscous: k * 0.5,
            stiffness: k * 1e5,
            damping: k * 20.0,
            ..friction::Bristle::default()
        };
        let friction = friction::Bristle { mu_static: MU, mu_kinetic: MU, ..viscous };
        spec.pairs = vec![([0, 1], PairLaw::new(normal, Some(friction.into())))];
        let mut world = world(spec);
        world.state_mut().bases[0] = Pose::translation(0.0, 0.0, half.z - 1e-6);
        world.set_base_twists(&[twist([0.1, 0.2, 1.0], [0.3, 0.1, 0.0])]);
        (0..500).for_each(|_| world.advance().unwrap());
        (world.state().bases[0], world.touches().count(), sim::Energy::of(&world))
    };
    for integrator in crate::support::ALL {
        let one = run(bed(1.0), 1.0, integrator);
        assert!(one.1 > 0 && one.2.elastic > 0.0);
        assert_eq!(one, run(bed(4.0), 4.0, integrator), "{integrator:?}");
        if integrator == Integrator::RungeKutta4 {
            continue; // Sliding bristles turn faster than 1/h here: it multiplies round-off.
        }
        // A box finds its corners by another sum: round-off.
        let boxed = run(Shape::Cuboid { half_extents: half }, 1.0, integrator);
        assert!((boxed.0.translation.vector - one.0.translation.vector).norm() < 1e-14, "{integrator:?}");
    }
}
