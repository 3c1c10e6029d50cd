//! Docking geometry at work: what rests in a drogue, a bore or on a ring is in balance, and guide petals mate.

use super::support::{Setup, bristle, hunt_crossley, linear, link, robot, run, shape, spec, twist, world};
use contact::{Docking, Normal, Shape};
use sim::{Base, Integrator, PairLaw, ShapeSpec, World};
use spatial::{Pose, Rot, Vec3};
use std::f64::consts::{PI, TAU};

const GRAVITY: f64 = 9.81;
/// Of the weight (the bound).
const BALANCE: f64 = 1e-9;

fn drogue() -> Docking {
    Docking::InnerCone { half_angle: 0.7, depth: 0.14, throat_radius: 0.02, wall: 0.01 }
}

/// A body of 1 kg with this shape about its centre of mass, in gravity, above a docking shape that is fixed in W.
fn body_in(fixed: Docking, moving: Shape, law: PairLaw, gravity: Vec3) -> World {
    let tree = robot(vec![link("body", 1.0, Vec3::zeros(), Vec3::new(3e-3, 3e-3, 1e-3))], Vec::new());
    let setup = Setup::new(Integrator::ImplicitEuler).gravity(gravity);
    let mut spec = spec(vec![(tree, Base::Free)], &setup);
    spec.shapes = vec![shape("port", None, Shape::Docking(fixed)), shape("probe", Some(0), moving)];
    spec.pairs = vec![([0, 1], law)];
    world(spec)
}

fn smooth() -> PairLaw {
    PairLaw::new(linear(1e5, 300.0), None)
}

fn rough(mu: f64, stiffness: f64) -> PairLaw {
    PairLaw::new(linear(stiffness, 3e-3 * stiffness), Some(bristle(mu, stiffness, 1e-3 * stiffness)))
}

/// Resultant and moment about the body's origin of the touching points, N and N·m; how many they are.
fn resultant(world: &World) -> (Vec3, Vec3, usize) {
    let origin = world.frame(0).pos;
    world.touches().fold((Vec3::zeros(), Vec3::zeros(), 0), |(f, m, n), touch| {
        let arm = touch.point_w - origin;
        (f + touch.force_w, m + arm.cross(&touch.force_w), n + usize::from(touch.normal_force > 0.0))
    })
}

fn assert_balanced(world: &World, gravity: &Vec3, arm: f64) -> usize {
    let (force, moment, points) = resultant(world);
    let weight = gravity.norm();
    assert!((force + gravity).norm() < BALANCE * weight, "{force:?} against {gravity:?}");
    assert!(moment.norm() < BALANCE * weight * arm, "{moment:?}");
    points
}

#[test]
fn ball_in_a_drogue_comes_to_rest_in_balance_on_eight_points() {
    let down = Vec3::new(0.0, 0.0, -GRAVITY);
    let mut world = body_in(drogue(), Shape::Ball { radius: 0.04 }, smooth(), down);
    // On the seat but for 2 mm to the side, where one point bears it: it slides home.
    let seat = (0.04 / 0.7_f64.cos() - 0.02) / 0.7_f64.tan() - 0.14;
    world.state_mut().bases[0] = Pose::translation(2e-3, 1e-3, seat + 3e-3);
    run(&mut world, 10_000);
    assert_eq!(assert_balanced(&world, &down, 0.04), 8);
    // Depth on the seat: m g = 8 k δ sin α.
    let z = world.state().bases[0].translation.vector.z;
    let depth = (seat - z) * 0.7_f64.sin();
    assert!((depth / (GRAVITY / (8.0 * 1e5 * 0.7_f64.sin())) - 1.0).abs() < 1e-6, "{depth}");
}

#[test]
fn capsule_probe_leans_on_three_points_in_balance() {
    // Leaning in a wide bore: its lower end on the floor and on the wall, its side on the rim.
    let down = Vec3::new(0.0, 0.0, -GRAVITY);
    let socket = Docking::InnerCylinder { radius: 0.06, depth: 0.1, wall: 0.012, floor: true };
    let mut world = body_in(socket, Shape::Capsule { radius: 0.02, half_length: 0.1 }, rough(0.05, 1e5), down);
    // The axis through the lower end's centre, on the floor at the wall, and past the rim on the other side.
    let (low, tilt) = (Vec3::new(0.04, 0.0, -0.08), -0.7);
    let axis = Vec3::new(f64::sin(tilt), 0.0, f64::cos(tilt));
    let centre = low + 0.1 * axis + Vec3::new(0.0, 0.0, 2e-4);
    world.state_mut().bases[0] = Pose::from_parts(centre.into(), Rot::from_scaled_axis(tilt * Vec3::y()));
    run(&mut world, 20_000);
    assert_eq!(assert_balanced(&world, &down, 0.1), 3);
}

#[test]
fn peg_in_a_bore_tilts_until_it_bears_on_two_points() {
    // Radius 19.8 in a bore of 20 mm, so stiff that a point does not reach its neighbours round the bore; hung by gravity across the bore: tilted by its weight outside of the mouth.
    let across = Vec3::new(-GRAVITY, 0.0, 0.0);
    let bore = Docking::InnerCylinder { radius: 0.02, depth: 0.06, wall: 0.01, floor: false };
    for peg in
        [Shape::Capsule { radius: 0.0198, half_length: 0.06 }, Shape::Cylinder { radius: 0.0198, half_length: 0.06 }]
    {
        let mut world = body_in(bore, peg.clone(), rough(0.8, 1e6), across);
        world.state_mut().bases[0] = Pose::translation(0.0, 0.0, 0.02);
        run(&mut world, 10_000);
        let points = assert_balanced(&world, &across, 0.06);
        assert_eq!(points, 2, "{peg:?}");
        // The lower end bears upward on one side of the bore, the rim carries on the other.
        let normals: Vec<f64> = world.touches().filter(|t| t.normal_force > 0.0).map(|t| t.normal_w.x).collect();
        assert!(normals[0] * normals[1] < -0.9, "{normals:?}");
    }
}

#[test]
fn ring_lies_flat_on_a_plane_in_balance_and_keeps_still() {
    let down = Vec3::new(0.0, 0.0, -GRAVITY);
    let tree = robot(vec![link("ring", 1.0, Vec3::zeros(), Vec3::new(0.02, 0.02, 0.04))], Vec::new());
    let setup = Setup::new(Integrator::ImplicitEuler).gravity(down);
    let mut spec = spec(vec![(tree, Base::Free)], &setup);
    let ring = Docking::Ring { major_radius: 0.2, minor_radius: 0.015 };
    spec.shapes = vec![shape("floor", None, Shape::HalfSpace), shape("ring", Some(0), Shape::Docking(ring))];
    spec.pairs = vec![([0, 1], rough(0.5, 1e5))];
    let mut world = world(spec);
    world.state_mut().bases[0] = Pose::translation(0.0, 0.0, 0.015);
    run(&mut world, 5_000);
    assert_eq!(assert_balanced(&world, &down, 0.2), 8);
    let before = world.state().bases[0];
    run(&mut world, 5_000);
    let moved = (world.state().bases[0].translation.vector - before.translation.vector).norm();
    assert!(moved < 1e-12, "it moved by {moved} m in 5 s");
}

/// A ball that runs round a drogue without friction keeps its energy: the contact has no facets to lose it on.
#[test]
fn ball_that_circles_in_a_drogue_keeps_its_energy() {
    let down = Vec3::new(0.0, 0.0, -GRAVITY);
    let law = PairLaw::new(linear(1e5, 0.0), None);
    let tree = robot(vec![link("body", 1.0, Vec3::zeros(), Vec3::repeat(1e-3))], Vec::new());
    let setup = Setup::new(Integrator::RungeKutta4).step(1e-4).gravity(down);
    let mut spec = spec(vec![(tree, Base::Free)], &setup);
    let wide = Docking::InnerCone { half_angle: 0.7, depth: 0.5, throat_radius: 0.02, wall: 0.01 };
    spec.shapes = vec![shape("port", None, Shape::Docking(wide)), shape("ball", Some(0), Shape::Ball { radius: 0.04 })];
    spec.pairs = vec![([0, 1], law)];
    let mut world = world(spec);
    // A circle of radius ρ on the wall: v² = g ρ / tan α … here at ρ = 0.2 m: v² / ρ = g cot α.
    let rho = 0.2;
    let a = 0.7_f64;
    let z = (rho + 0.04 / a.cos() - 0.02) / a.tan() - 0.5;
    let force = GRAVITY / a.sin();
    let pressed = force / 1e5;
    let speed = (GRAVITY * (rho + pressed * a.cos()) / a.tan()).sqrt();
    world.state_mut().bases[0] = Pose::translation(rho + pressed * a.cos(), 0.0, z - pressed * a.sin());
    world.set_base_twists(&[twist([0.0; 3], [0.0, speed, 0.0])]);
    let height = |w: &World| w.state().bases[0].translation.vector;
    let start = height(&world);
    let mut worst = 0.0_f64;
    for _ in 0..10_000 {
        run(&mut world, 1);
        let p = height(&world);
        worst = worst.max((p.z - start.z).abs()).max((p.xy().norm() - start.xy().norm()).abs());
    }
    // RK4 at 1e-4 s follows the contact's 316 rad/s with (ω h)⁵ / 120 per step; the circle is its equilibrium.
    assert!(worst < 1e-9, "the circle strayed by {worst} m");
}

/// Two rings with three petals each, the second turned over and round by 60°, pushed together slowly from a lateral
/// offset and a clocking error: the petals guide it until the rings lie on each other, centred and clocked.
#[test]
fn three_petals_guide_their_twin_home() {
    let petal =
        Docking::Petal { base_radius: 0.2, tip_radius: 0.08, height: 0.12, half_sector: 0.68, thickness: 0.012 };
    let ring = Docking::Ring { major_radius: 0.3, minor_radius: 0.02 };
    let half = |vehicle: Option<usize>| -> Vec<ShapeSpec> {
        let mut shapes = vec![shape("ring", vehicle, Shape::Docking(ring))];
        for k in 0..3 {
            let turn = Rot::from_scaled_axis(TAU / 3.0 * f64::from(k) * Vec3::z());
            let pose_ls = Pose::from_parts((turn * Vec3::new(0.1, 0.0, 0.0)).into(), turn);
            shapes.push(ShapeSpec { pose_ls, ..shape(&format!("petal{k}"), vehicle, Shape::Docking(petal)) });
        }
        shapes
    };
    let push = Vec3::new(0.0, 0.0, -0.5);
    let tree = robot(vec![link("half", 10.0, Vec3::zeros(), Vec3::new(0.4, 0.4, 0.7))], Vec::new());
    let setup = Setup::new(Integrator::ImplicitEuler).gravity(push);
    let mut spec = spec(vec![(tree, Base::Free)], &setup);
    spec.shapes = half(None).into_iter().chain(half(Some(0))).collect();
    let law = PairLaw::new(Normal { ..hunt_crossley(1e5, 1.0, 20.0) }, Some(bristle(0.05, 1e5, 100.0)));
    spec.pairs = (0..4).flat_map(|i| (4..8).map(move |j| ([i, j], law))).collect();
    let mut world = world(spec);
    let clocked = Rot::from_scaled_axis((PI / 3.0 + 0.12) * Vec3::z()) * Rot::from_scaled_axis(PI * Vec3::x());
    world.state_mut().bases[0] = Pose::from_parts(Vec3::new(0.01, 0.005, 0.2).into(), clocked);
    run(&mut world, 20_000);
    let pose = world.state().bases[0];
    let p = pose.translation.vector;
    let axis = pose.rotation * Vec3::z();
    let x = pose.rotation * Vec3::x();
    let clocking = (x.y.atan2(x.x) - PI / 3.0).rem_euclid(TAU / 3.0);
    let clocking = clocking.min(TAU / 3.0 - clocking);
    println!("at {p:?}, axis {axis:?}, clocking {clocking} rad, points {}", resultant(&world).2);
    assert!((p.z - 0.04).abs() < 1e-3, "rings do not lie on each other: {p:?}");
    assert!(p.xy().norm() < 0.01 && axis.z < -0.999 && clocking < 0.05, "{p:?} {axis:?} {clocking}");
}
