//! Points keep their identity while what touches does not change, and nothing jumps.

use crate::support::*;

/// Most that a quantity of a smooth motion may bend from step to step by round-off: a few ulps of a metre.
const BEND: f64 = 1e-13;

fn pad_on_bar() -> (Two, Vec3) {
    let overlap = Vec3::new(0.0, 0.021 - 2e-5, 0.0);
    (Two::new(cuboid(0.02, 0.006, 0.03), cuboid(0.1, 0.015, 0.015)), overlap)
}

#[test]
fn block_that_slides_over_a_block_keeps_its_four_features() {
    let mut two = Two::new(cuboid(1.0, 1.0, 0.1), cuboid(0.1, 0.05, 0.02));
    let frame = |i: usize| turned(Vec3::new(0.0, 0.0, 0.3 + 1e-4 * i as f64), 1e-4 * i as f64, 0.0, 0.12 - 1e-5);
    let first = features(two.find(&at(0.0, 0.0, 0.0), &frame(0), 0.0));
    assert_eq!(first.len(), 4);
    for i in 0..1000 {
        let points = two.find(&at(0.0, 0.0, 0.0), &frame(i), 0.0);
        assert_eq!(features(points), first, "at step {i}");
        assert!(points.iter().all(|p| (p.gap + 1e-5).abs() < ROUND_OFF));
    }
}

#[test]
fn pad_on_a_bar_keeps_features_and_points_under_tiny_tilts() {
    let (mut two, pos) = pad_on_bar();
    let level = two.find_touching(&at(0.0, 0.0, 0.0), &at(pos.x, pos.y, pos.z));
    assert_eq!(level.len(), 4, "{level:?}");
    for i in 0..27 {
        let tilt = 1e-9 * Vec3::new((i % 3) as f64 - 1.0, (i / 3 % 3) as f64 - 1.0, (i / 9) as f64 - 1.0);
        let points = two.find_touching(&at(0.0, 0.0, 0.0), &turned(tilt, pos.x, pos.y, pos.z));
        assert_eq!(features(&points), features(&level), "tilt {tilt:?}");
        for (p, q) in points.iter().zip(&level) {
            // 1e-9 rad at arms up to 0.1 m, and normals that tilt by as much.
            assert!((p.point_a_w - q.point_a_w).norm() < 5e-10, "{p:?} {q:?}");
            assert!((p.gap - q.gap).abs() < 5e-10 && (p.normal_w - q.normal_w).norm() < 2e-9);
        }
    }
}

#[test]
fn normals_turn_smoothly_while_the_leading_face_changes() {
    let (mut two, pos) = pad_on_bar();
    let mut last: Option<Vec<ContactPoint>> = None;
    for i in 0..4000 {
        let tilt = 1e-6 * (i as f64 - 2000.0);
        let frame = turned(Vec3::new(tilt, 0.0, 0.6 * tilt), pos.x, pos.y, pos.z);
        let points = two.find(&at(0.0, 0.0, 0.0), &frame, 1e-3).to_vec();
        for q in last.iter().flatten() {
            let Some(p) = points.iter().find(|p| p.feature == q.feature) else { panic!("feature lost at {tilt} rad") };
            // The weights pass from one face to the other within 1e-3 rad, so the normal turns a few times faster.
            assert!((p.normal_w - q.normal_w).norm() < 2e-5 && (p.gap - q.gap).abs() < 2e-6, "at {tilt} rad");
        }
        last = Some(points);
    }
}

#[test]
fn gaps_of_a_smooth_motion_are_smooth_to_round_off() {
    let shapes = [cuboid(0.1, 0.05, 0.02), capsule(0.02, 0.1), ball(0.02), cylinder(0.1, 0.02)];
    for shape in shapes {
        for ground in [cuboid(1.0, 1.0, 0.1), Shape::HalfSpace] {
            let top = if ground == Shape::HalfSpace { 0.0 } else { 0.1 };
            let lying = if matches!(shape, Shape::Capsule { .. }) {
                std::f64::consts::FRAC_PI_2 * Vec3::y()
            } else {
                Vec3::zeros()
            };
            let mut two = Two::new(ground, shape.clone());
            let mut gap = |i: usize| {
                let x = 1e-5 * i as f64;
                let frame = turned(lying, x, 0.3 * x, top + 0.0201 - 1e-7 * i as f64);
                two.find(&at(0.0, 0.0, 0.0), &frame, 1e-3)[0].gap
            };
            for i in 1..1000 {
                let bend = gap(i + 1) - 2.0 * gap(i) + gap(i - 1);
                assert!(bend.abs() < BEND, "{shape:?} at step {i}: {bend}");
            }
        }
    }
}

#[test]
fn rolling_cylinder_keeps_its_two_points() {
    let mut two = Two::new(cuboid(2.0, 1.0, 0.1), cylinder(0.1, 0.2));
    let upright = rotation_matrix(&Vec3::new(std::f64::consts::FRAC_PI_2, 0.0, 0.0));
    for i in 0..1000 {
        let angle = 1e-2 * i as f64;
        let rot = rotation_matrix(&Vec3::new(0.0, angle, 0.0)) * upright;
        let frame = Frame { rot, pos: Vec3::new(-0.5 + 0.1 * angle, 0.0, 0.2 - 1e-5) };
        let points = two.find_touching(&at(0.0, 0.0, 0.0), &frame);
        assert_eq!(features(&points).len(), 2, "at {angle} rad: {points:?}");
        assert!(points.iter().all(|p| (p.gap + 1e-5).abs() < ROUND_OFF));
    }
}

#[test]
fn block_that_slides_over_a_mesh_keeps_a_point_at_each_corner() {
    let mut two = Two::new(floor(), cuboid(0.1, 0.05, 0.02));
    for i in 0..1000 {
        let x = 2e-4 * i as f64;
        let points = two.find_touching(&at(0.0, 0.0, 0.0), &at(x, -0.3, 0.02 - 1e-5));
        for (dx, dy) in [(-0.1, -0.05), (0.1, -0.05), (-0.1, 0.05), (0.1, 0.05)] {
            let near = |p: &&ContactPoint| (p.point_b_w - Vec3::new(x + dx, dy - 0.3, -1e-5)).norm() < 1e-6;
            assert_eq!(points.iter().filter(near).count(), 1, "corner ({dx}, {dy}) at step {i}: {points:?}");
        }
    }
}
