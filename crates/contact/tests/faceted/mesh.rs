//! Meshes: turned inside out, finely tessellated, open and thin.

use crate::support::*;
use contact::Shape;
use spatial::{Frame, Vec3};

fn reversed(mesh: &Shape) -> Shape {
    let Shape::TriMesh { vertices, triangles } = mesh else { panic!("a mesh") };
    let triangles = triangles.iter().map(|t| [t[0], t[2], t[1]]).collect();
    Shape::TriMesh { vertices: vertices.clone(), triangles }
}

/// A ball of `n` rings of 2n quads, closed.
fn globe(radius: f64, n: u32) -> Shape {
    let ring = 2 * n;
    let mut vertices = vec![radius * Vec3::z(), -radius * Vec3::z()];
    for i in 1..n {
        for j in 0..ring {
            let (t, p) = (
                std::f64::consts::PI * f64::from(i) / f64::from(n),
                std::f64::consts::PI * f64::from(j) / f64::from(n),
            );
            vertices.push(radius * v(t.sin() * p.cos(), t.sin() * p.sin(), t.cos()));
        }
    }
    let at = |i: u32, j: u32| {
        if i == 0 {
            0
        } else if i == n {
            1
        } else {
            2 + (i - 1) * ring + j % ring
        }
    };
    let mut triangles = Vec::new();
    for i in 0..n {
        for j in 0..ring {
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    Shape::TriMesh { vertices, triangles }
}

#[test]
fn a_closed_mesh_inside_out_is_the_same_solid() {
    let mesh = box_mesh(0.1, 0.1, 0.1);
    let pose = posed(v(0.02, 0.01, 0.15 - 1e-5), v(1e-4, 0.0, 0.4));
    for shape in [cuboid(0.03, 0.04, 0.05), ball(0.05), cylinder(0.03, 0.05), box_mesh(0.03, 0.04, 0.05)] {
        let one = points(&mesh, &shape, Frame::identity(), pose);
        let other = points(&reversed(&mesh), &shape, Frame::identity(), pose);
        let gaps = |points: &[contact::ContactPoint]| {
            let mut gaps: Vec<f64> = points.iter().map(|p| p.gap).collect();
            gaps.sort_by(f64::total_cmp);
            gaps
        };
        assert!(!one.is_empty());
        assert_eq!(gaps(&one), gaps(&other), "{shape:?}");
    }
}

#[test]
fn a_ball_rolls_over_a_tessellated_plate_without_feeling_its_seams() {
    let mut bench = Bench::new(plate(0.5, 31), ball(0.05));
    for i in 0..2000 {
        let x = -0.4 + 4e-4 * f64::from(i);
        let found = bench.ask(Frame::identity(), at(x, 0.37 * x + 0.01, 0.05 - 1e-4));
        assert_eq!(found.len(), 1, "{i} {found:?}");
        assert!((found[0].gap + 1e-4).abs() < ROUND_OFF && (found[0].normal_w - Vec3::z()).norm() < 1e-12, "{i}");
    }
}

#[test]
fn a_plate_is_touched_from_both_sides() {
    for side in [1.0, -1.0] {
        let found =
            points(&plate(0.3, 4), &cuboid(0.05, 0.04, 0.03), Frame::identity(), at(0.01, 0.02, side * (0.03 - 1e-5)));
        assert_eq!(found.len(), 4);
        assert!(
            found.iter().all(|p| (p.gap + 1e-5).abs() < ROUND_OFF && (p.normal_w - side * Vec3::z()).norm() < 1e-12)
        );
    }
}

#[test]
fn meshes_give_a_bounded_number_of_points_the_deepest_among_them() {
    let globe = globe(0.1, 24);
    for (shape, top) in [(globe.clone(), 0.1), (cuboid(0.05, 0.05, 0.05), 0.05), (cylinder(0.1, 0.05), 0.05)] {
        let mut bench = Bench::new(shape, globe.clone());
        bench.reach = 0.002;
        let found = bench.ask(Frame::identity(), at(1e-4, 2e-4, top + 0.1 - 2e-3));
        assert!((1..=16).contains(&found.len()), "{}", found.len());
        // Its pole leads: the depth is that of the pole, but for the slope of its polygons over 0.2 mm.
        assert!((deepest(&found).gap + 2e-3).abs() < 5e-5, "{found:#?}");
    }
}
