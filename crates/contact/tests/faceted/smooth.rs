//! What a seam, a concave mesh and a plate on a plate must not and must do.

use crate::support::*;
use contact::{ContactPoint, Shape};
use spatial::{Frame, Vec3};
use std::f64::consts::FRAC_PI_2;

/// A U that opens upwards, one closed concave mesh: prongs from x = ±0.03 to ±0.05, bottom from z = −0.02 to 0, depth ±0.04 in y.
fn fork() -> Shape {
    let outline = [
        (-0.05, -0.02),
        (0.05, -0.02),
        (0.05, 0.1),
        (0.03, 0.1),
        (0.03, 0.0),
        (-0.03, 0.0),
        (-0.03, 0.1),
        (-0.05, 0.1),
    ];
    let vertices = [-0.04, 0.04].iter().flat_map(|&y| outline.map(|(x, z)| v(x, y, z))).collect();
    let n = outline.len() as u32;
    let mut triangles: Vec<[u32; 3]> = (0..n)
        .flat_map(|i| {
            let (j, far) = ((i + 1) % n, n);
            [[i, j, j + far], [i, j + far, i + far]]
        })
        .collect();
    // The U itself as three convex quads on each side; wound so that the far side (y > 0) looks along +y.
    for q in [[0, 1, 4, 5], [1, 2, 3, 4], [0, 5, 6, 7]] {
        for t in [[q[0], q[1], q[2]], [q[0], q[2], q[3]]] {
            triangles.push([t[0], t[2], t[1]]);
            triangles.push(t.map(|i| i + n));
        }
    }
    Shape::TriMesh { vertices, triangles: triangles.iter().map(|t| [t[0], t[2], t[1]]).collect() }
}

fn rods() -> [Shape; 2] {
    [capsule(0.02, 0.3), cylinder(0.02, 0.3)]
}

/// A rod along y at (x, z).
fn along_y(x: f64, z: f64) -> Frame {
    Frame { pos: v(x, 0.0, z), ..posed(Vec3::zeros(), v(FRAC_PI_2, 0.0, 0.0)) }
}

#[test]
fn rod_passes_through_the_gap_of_a_concave_mesh_and_its_prongs_stop_it() {
    for rod in rods() {
        let mut bench = Bench::new(fork(), rod.clone());
        for i in 0..=1000 {
            // From above the prongs down to 1 mm over the bottom, and through the gap along its length, leaning a little.
            let z = 0.2 - 0.179 * f64::from(i) / 1000.0;
            assert!(bench.ask(Frame::identity(), along_y(0.005, z)).is_empty(), "{rod:?} at {z}");
        }
        for (x, z, normal) in
            [(0.01 + 1e-5, 0.05, -Vec3::x()), (-0.01 - 1e-5, 0.05, Vec3::x()), (0.0, 0.02 - 1e-5, Vec3::z())]
        {
            let found = bench.ask(Frame::identity(), along_y(x, z));
            assert_eq!(found.len(), 2, "{rod:?} at ({x}, {z}): {found:?}");
            for p in &found {
                assert!((p.gap + 1e-5).abs() < ROUND_OFF && (p.normal_w - normal).norm() < 1e-12, "{p:?}");
                assert!((p.point_a_w.y.abs() - 0.04).abs() < 1e-12, "at the ends of the prong: {p:?}");
            }
        }
        // Down onto the end of a prong.
        let found = bench.ask(Frame::identity(), along_y(0.04, 0.12 - 1e-5));
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found.iter().all(|p| (p.gap + 1e-5).abs() < ROUND_OFF && (p.normal_w - Vec3::z()).norm() < 1e-12));
    }
}

#[test]
fn mesh_plate_on_mesh_plate_rests_on_well_spread_points() {
    // A tessellated slab of 0.2 × 0.16 m turned about z on a tessellated plate.
    let slab = box_mesh(0.1, 0.08, 0.005);
    for ground in [plate(0.5, 17), box_mesh(0.5, 0.5, 0.005)] {
        let top = if matches!(&ground, Shape::TriMesh { triangles, .. } if triangles.len() > 12) { 0.0 } else { 0.005 };
        let mut bench = Bench::new(ground, slab.clone());
        for i in 0..200 {
            let turn = 0.03 * f64::from(i);
            let found = bench
                .ask(Frame::identity(), posed(v(1e-3 * f64::from(i), 0.02, top + 0.005 - 1e-5), v(0.0, 0.0, turn)));
            assert!((4..=16).contains(&found.len()), "{found:?}");
            assert!(found.iter().all(|p| (p.gap + 1e-5).abs() < ROUND_OFF && (p.normal_w - Vec3::z()).norm() < 1e-12));
            for corner in [v(0.1, 0.08, 0.0), v(-0.1, 0.08, 0.0), v(0.1, -0.08, 0.0), v(-0.1, -0.08, 0.0)] {
                let place = posed(v(1e-3 * f64::from(i), 0.02, 0.0), v(0.0, 0.0, turn)).point(&corner);
                assert!(
                    found.iter().any(|p| (p.point_b_w - place).xy().norm() < 1e-9),
                    "no point at {place:?}: {found:?}"
                );
            }
        }
    }
}

#[test]
fn smooth_bodies_slide_over_a_tessellated_plate_without_feeling_its_seams() {
    let lying = posed(Vec3::zeros(), v(0.0, 0.0, 0.3)).rot * posed(Vec3::zeros(), v(0.0, FRAC_PI_2, 0.0)).rot;
    for (shape, rot, count) in [(ball(0.05), lying, 1), (capsule(0.05, 0.1), lying, 2), (cylinder(0.05, 0.1), lying, 2)]
    {
        let mut bench = Bench::new(plate(1.0, 41), shape.clone());
        let mut first: Option<Vec<u64>> = None;
        for i in 0..4000 {
            let x = -0.8 + 4e-4 * f64::from(i);
            let found = bench.ask(Frame::identity(), Frame { rot, pos: v(x, 0.37 * x + 0.01, 0.05 - 1e-4) });
            assert_eq!(found.len(), count, "{shape:?} at step {i}: {found:?}");
            // A spring at each point: the force of a body that slides level is the same to 1e-9 of it.
            let force: f64 = found.iter().map(|p| -p.gap).sum();
            assert!((force / (1e-4 * count as f64) - 1.0).abs() < 1e-9, "{shape:?} at step {i}: {force}");
            assert!(found.iter().all(|p| p.normal_w == Vec3::z()), "{shape:?} at step {i}: {found:?}");
            let names: Vec<u64> = found.iter().map(|p: &ContactPoint| p.feature).collect();
            assert_eq!(&names, first.get_or_insert(names.clone()), "{shape:?} at step {i}");
        }
    }
}

#[test]
fn turning_the_whole_world_changes_no_gap() {
    let pairs = [
        (box_mesh(0.1, 0.1, 0.1), cuboid(0.03, 0.04, 0.05)),
        (hull(0.1, 0.1, 0.1), hull(0.03, 0.04, 0.05)),
        (cuboid(0.1, 0.1, 0.1), cylinder(0.03, 0.05)),
        (plate(0.3, 5), ball(0.05)),
    ];
    for (a, b) in pairs {
        let top = if matches!(b, Shape::Ball { .. }) { 0.05 } else { 0.15 };
        let pose = posed(v(0.02, 0.01, top - 1e-4), v(1e-3, 2e-3, 0.4));
        let gaps = |world: &Frame| {
            let found = points(&a, &b, *world, world * &pose);
            found.iter().map(|p| p.gap).collect::<Vec<_>>()
        };
        let level = gaps(&Frame::identity());
        assert!(!level.is_empty());
        for i in 0..50 {
            let turn = f64::from(i) * v(0.11, 0.07, -0.13);
            let turned = gaps(&posed(v(0.3, -0.2, 0.5), turn));
            assert_eq!(turned.len(), level.len());
            for (p, q) in turned.iter().zip(&level) {
                assert!((p - q).abs() < 1e-12, "{a:?} on {b:?} at {turn:?}: {p} {q}");
            }
        }
    }
}

#[test]
fn many_sided_plate_keeps_its_force_at_sixteen_points_and_their_names() {
    // A closed prism of 40 sides, radius 0.1 m, on a plate: 40 corners, of which 16 stay and stand for all.
    let sides = 40_u32;
    let rim = |z: f64| {
        (0..sides).map(move |i| {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(sides);
            v(0.1 * angle.cos(), 0.07 * angle.sin(), z)
        })
    };
    let vertices: Vec<Vec3> = rim(-0.01).chain(rim(0.01)).collect();
    for shape in [
        Shape::ConvexHull { vertices: vertices.clone() },
        Shape::TriMesh {
            vertices,
            triangles: (0..sides)
                .flat_map(|i| {
                    let (j, n) = ((i + 1) % sides, sides);
                    let ends = [[0, j, i], [n, n + i, n + j]].into_iter().filter(|t| t[0] != t[1] && t[0] != t[2]);
                    [[i, j, n + j], [i, n + j, n + i]].into_iter().chain(ends).collect::<Vec<_>>()
                })
                .collect(),
        },
    ] {
        for ground in [plate(1.0, 9), cuboid(1.0, 1.0, 0.1), Shape::HalfSpace] {
            let top = if matches!(ground, Shape::Cuboid { .. }) { 0.1 } else { 0.0 };
            let mut bench = Bench::new(ground.clone(), shape.clone());
            let mut first: Option<Vec<u64>> = None;
            for i in 0..300 {
                let t = f64::from(i);
                let lean = v(2e-6 * (0.3 * t).sin(), 2e-6 * (0.5 * t).cos(), 0.0);
                let pose = &posed(v(-0.5 + 3e-3 * t, 1e-3 * t, top + 0.01 - 1e-5), lean)
                    * &posed(Vec3::zeros(), v(0.0, 0.0, 2e-3 * t));
                let found = bench.ask(Frame::identity(), pose);
                assert_eq!(found.len(), 16, "{ground:?}");
                let share: f64 = found.iter().map(|p| p.weight).sum();
                let force: f64 = found.iter().map(|p| p.weight * -p.gap).sum();
                let centre: Vec3 = found.iter().map(|p| p.weight * -p.gap * p.point_b_w).sum::<Vec3>() / force;
                assert!((share - 40.0).abs() < 1e-9, "{share}");
                // All 40 have the mean gap of the level plate, but for its half height × lean² / 2 each; the lean moves the centre by lean × (0.1 m)² / 2 / 1e-5 m.
                assert!((force - 40.0 * 1e-5).abs() < 4e-12, "step {i}: {force}");
                assert!((centre - pose.pos).xy().norm() < 2.0 * 2e-6 * 0.005 / 1e-5, "step {i}: {centre:?}");
                let names: Vec<u64> = found.iter().map(|p| p.feature).collect();
                assert_eq!(&names, first.get_or_insert(names.clone()), "{ground:?}, step {i}");
            }
        }
    }
}
