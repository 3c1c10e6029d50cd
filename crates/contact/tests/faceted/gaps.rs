//! Closed forms: number of points, gap and normal of every pair of kinds, and what exchanging A and B does.

use crate::support::*;
use spatial::{Frame, Vec3};
use std::f64::consts::FRAC_PI_2;

const DEPTH: f64 = 1e-5;

/// Shapes of half height 0.05 above their origin, with the points that resting on a face gives.
fn resting() -> Vec<(&'static str, contact::Shape, Frame, usize)> {
    let lying = posed(Vec3::zeros(), v(FRAC_PI_2, 0.0, 0.0));
    vec![
        ("ball", ball(0.05), Frame::identity(), 1),
        ("box", cuboid(0.03, 0.04, 0.05), Frame::identity(), 4),
        ("hull", hull(0.03, 0.04, 0.05), Frame::identity(), 4),
        ("mesh", box_mesh(0.03, 0.04, 0.05), Frame::identity(), 4),
        ("cylinder on its end", cylinder(0.03, 0.05), Frame::identity(), 8),
        ("cylinder on its side", cylinder(0.05, 0.04), lying, 2),
        ("capsule on its end", capsule(0.02, 0.03), Frame::identity(), 1),
        ("capsule on its side", capsule(0.05, 0.04), lying, 2),
    ]
}

fn grounds() -> Vec<(&'static str, contact::Shape, f64)> {
    vec![
        ("half-space", contact::Shape::HalfSpace, 0.0),
        ("box", cuboid(0.2, 0.3, 0.1), 0.1),
        ("hull", hull(0.2, 0.3, 0.1), 0.1),
        ("closed mesh", box_mesh(0.2, 0.3, 0.1), 0.1),
        ("plate", plate(0.3, 7), 0.0),
        ("cylinder", cylinder(0.2, 0.1), 0.1),
        (
            "compound",
            contact::Shape::Compound(vec![(spatial::Pose::translation(0.0, 0.0, 0.1), cuboid(0.2, 0.3, 0.1))]),
            0.2,
        ),
    ]
}

#[test]
fn everything_rests_on_everything_with_the_right_points() {
    for (name, shape, turn, count) in resting() {
        for (ground_name, ground, top) in grounds() {
            let pose = Frame { pos: v(0.011, 0.007, top + 0.05 - DEPTH), ..turn };
            let found = points(&ground, &shape, Frame::identity(), pose);
            let label = format!("{name} on {ground_name}: {found:#?}");
            // A capsule upright on a half-space also knows its far end, if it is within the margin: it is not.
            assert_eq!(found.len(), count, "{label}");
            for p in &found {
                assert!((p.gap + DEPTH).abs() < ROUND_OFF, "{label}");
                assert!((p.normal_w - Vec3::z()).norm() < 1e-9, "{label}");
                assert!((p.point_a_w.z - top).abs() < ROUND_OFF, "{label}");
            }
        }
    }
}

#[test]
fn exchanging_the_bodies_flips_the_normals_and_keeps_the_gaps() {
    for (name, shape, turn, _) in resting() {
        for (ground_name, ground, top) in grounds() {
            let turn = &posed(Vec3::zeros(), v(2e-4, -1e-4, 0.3)) * &turn;
            let pose = Frame { pos: v(0.011, 0.007, top + 0.05 - DEPTH), ..turn };
            let sort = |points: Vec<contact::ContactPoint>| {
                let mut gaps: Vec<(f64, Vec3)> = points.iter().map(|p| (p.gap, p.normal_w)).collect();
                gaps.sort_by(|p, q| p.0.total_cmp(&q.0));
                gaps
            };
            let one = sort(points(&ground, &shape, Frame::identity(), pose));
            let other = sort(points(&shape, &ground, pose, Frame::identity()));
            assert_eq!(one.len(), other.len(), "{name} on {ground_name}");
            for (p, q) in one.iter().zip(&other) {
                // Which face gives the normal may change: gaps differ by depth times the lean squared (2e-4).
                assert!((p.0 - q.0).abs() < 1e-11, "{name} on {ground_name}: {one:?} {other:?}");
                assert!((p.1 + q.1).norm() < 1e-3, "{name} on {ground_name}: {one:?} {other:?}");
            }
        }
    }
}

#[test]
fn round_shapes_meet_at_the_distance_of_their_axes() {
    let apart = |d: f64| at(0.6 * d, 0.8 * d, 0.0);
    let crossing = |d: f64| posed(v(0.0, 0.0, d), v(0.0, 0.0, 0.0));
    let along_x = posed(Vec3::zeros(), v(0.0, FRAC_PI_2, 0.0));
    let along_y = |d: f64| Frame { pos: v(0.0, 0.0, d), ..posed(Vec3::zeros(), v(FRAC_PI_2, 0.0, 0.0)) };
    let gap = 0.07 - 0.05 - 0.02;
    for (a, b, count) in [
        (ball(0.05), ball(0.02), 1),
        (ball(0.05), capsule(0.02, 0.1), 1),
        (ball(0.05), cylinder(0.02, 0.1), 1),
        (capsule(0.05, 0.2), capsule(0.02, 0.1), 2),
        (capsule(0.05, 0.2), cylinder(0.02, 0.1), 2),
        (cylinder(0.05, 0.2), cylinder(0.02, 0.1), 2),
    ] {
        for depth in [-5e-5, DEPTH, 1e-3] {
            let found = points(&a, &b, Frame::identity(), apart(0.07 - depth));
            assert_eq!(found.len(), count, "{a:?} {b:?} {found:?}");
            for p in &found {
                assert!((p.gap - (gap - depth)).abs() < ROUND_OFF, "{a:?} {b:?} {found:?}");
                assert!((p.normal_w - v(0.6, 0.8, 0.0)).norm() < 1e-12, "{a:?} {b:?} {found:?}");
            }
        }
    }
    for (a, b) in [
        (capsule(0.05, 0.2), capsule(0.02, 0.1)),
        (capsule(0.05, 0.2), cylinder(0.02, 0.1)),
        (cylinder(0.05, 0.2), cylinder(0.02, 0.1)),
    ] {
        let found = points(&a, &b, along_x, along_y(0.07 - DEPTH));
        assert_eq!(found.len(), 1, "{a:?} {b:?}");
        assert!(
            (found[0].gap + DEPTH).abs() < ROUND_OFF && (found[0].normal_w - Vec3::z()).norm() < 1e-12,
            "{found:?}"
        );
    }
    let _ = crossing;
}

#[test]
fn ball_on_edge_and_corner_of_a_box() {
    let s = 0.5_f64.sqrt();
    let found =
        points(&cuboid(0.1, 0.1, 0.1), &ball(0.02), Frame::identity(), at(0.1 + 0.019 * s, 0.1 + 0.019 * s, 0.03));
    assert!((found[0].gap + 1e-3).abs() < ROUND_OFF && (found[0].normal_w - v(s, s, 0.0)).norm() < ROUND_OFF);
    let t = 3_f64.sqrt().recip();
    let pos = v(0.1, 0.1, 0.1).add_scalar(0.019 * t);
    let found = points(&cuboid(0.1, 0.1, 0.1), &ball(0.02), Frame::identity(), at(pos.x, pos.y, pos.z));
    assert!((found[0].gap + 1e-3).abs() < ROUND_OFF);
}

#[test]
fn crossed_edges_of_boxes_touch_in_one_point() {
    // Two bars, each turned by 45° about its length so that an edge leads, crossing at right angles.
    let quarter = std::f64::consts::FRAC_PI_4;
    let lower = posed(Vec3::zeros(), v(quarter, 0.0, 0.0));
    let half_diagonal = 0.02 * 2_f64.sqrt();
    let upper = Frame { pos: v(0.0, 0.0, 2.0 * half_diagonal - DEPTH), ..posed(Vec3::zeros(), v(0.0, quarter, 0.0)) };
    for (a, b) in [
        (cuboid(0.2, 0.02, 0.02), cuboid(0.02, 0.2, 0.02)),
        (hull(0.2, 0.02, 0.02), cuboid(0.02, 0.2, 0.02)),
        (hull(0.2, 0.02, 0.02), hull(0.02, 0.2, 0.02)),
        (box_mesh(0.2, 0.02, 0.02), cuboid(0.02, 0.2, 0.02)),
        (cuboid(0.2, 0.02, 0.02), box_mesh(0.02, 0.2, 0.02)),
        (box_mesh(0.2, 0.02, 0.02), box_mesh(0.02, 0.2, 0.02)),
    ] {
        let found = points(&a, &b, lower, upper);
        assert_eq!(found.len(), 1, "{a:?} {b:?} {found:#?}");
        assert!(
            (found[0].gap + DEPTH).abs() < ROUND_OFF && (found[0].normal_w - Vec3::z()).norm() < 1e-9,
            "{found:#?}"
        );
    }
}

#[test]
fn crossed_bars_lie_on_four_points() {
    let kinds = |x, y, z| [cuboid(x, y, z), hull(x, y, z), box_mesh(x, y, z)];
    for a in kinds(0.2, 0.02, 0.02) {
        for b in kinds(0.02, 0.2, 0.02) {
            let found = points(&a, &b, Frame::identity(), at(0.0, 0.0, 0.04 - DEPTH));
            assert_eq!(found.len(), 4, "{a:?} {b:?} {found:#?}");
            assert!(found.iter().all(|p| (p.gap + DEPTH).abs() < ROUND_OFF && (p.normal_w - Vec3::z()).norm() < 1e-9));
        }
    }
}

#[test]
fn equal_boxes_stacked_flush_give_their_four_corners() {
    let kinds = [cuboid(0.05, 0.05, 0.05), hull(0.05, 0.05, 0.05), box_mesh(0.05, 0.05, 0.05)];
    for a in &kinds {
        for b in &kinds {
            for jitter in [0.0, 1e-16, -3e-16, 1e-12] {
                let pose = posed(v(jitter, -jitter, 0.1 - DEPTH), v(0.0, 0.0, jitter));
                let found = points(a, b, Frame::identity(), pose);
                assert_eq!(found.len(), 4, "{a:?} {b:?} {jitter} {found:#?}");
            }
        }
    }
}

#[test]
fn a_corner_pokes_into_a_face() {
    let t = (1.0_f64 / 3.0).sqrt();
    // The diagonal of the cube points down.
    let turn = spatial::rotation_about(&v(1.0, -1.0, 0.0).normalize(), -(t.acos() + std::f64::consts::PI));
    let kinds = [cuboid(0.05, 0.05, 0.05), hull(0.05, 0.05, 0.05), box_mesh(0.05, 0.05, 0.05)];
    let low = |rot: &spatial::Mat3| {
        (0..8)
            .map(|i| {
                (rot * v(
                    0.05 * f64::from(1 - 2 * (i & 1)),
                    0.05 * f64::from(1 - (i & 2)),
                    0.05 * f64::from(1 - (i & 4) / 2),
                ))
                .z
            })
            .fold(0.0, f64::min)
    };
    for shape in &kinds {
        for (name, ground, top) in grounds() {
            let pose = Frame { rot: turn, pos: v(0.02, 0.01, top - low(&turn) - DEPTH) };
            for (found, sign) in [
                (points(&ground, shape, Frame::identity(), pose), 1.0),
                (points(shape, &ground, pose, Frame::identity()), -1.0),
            ] {
                assert_eq!(found.len(), 1, "{shape:?} {name} {found:#?}");
                assert!(
                    (found[0].gap + DEPTH).abs() < ROUND_OFF && (found[0].normal_w - sign * Vec3::z()).norm() < 1e-9,
                    "{name} {found:#?}"
                );
            }
        }
    }
}

#[test]
fn deep_and_concentric_shapes_have_finite_unit_normals() {
    let all = [
        ball(0.05),
        cuboid(0.03, 0.04, 0.05),
        hull(0.03, 0.04, 0.05),
        cylinder(0.03, 0.05),
        capsule(0.02, 0.03),
        box_mesh(0.03, 0.04, 0.05),
        contact::Shape::HalfSpace,
    ];
    for a in &all {
        for b in &all {
            for pose in [
                Frame::identity(),
                at(1e-9, 0.0, 0.0),
                posed(v(0.0, 0.01, 0.0), v(0.3, 0.2, 0.1)),
                posed(Vec3::zeros(), v(FRAC_PI_2, 0.0, 0.0)),
            ] {
                let found = points(a, b, Frame::identity(), pose);
                assert!(
                    found.iter().all(|p| p.gap.is_finite() && p.normal_w.iter().all(|x| x.is_finite())),
                    "{found:?}"
                );
            }
        }
    }
}

#[test]
fn poses_that_are_not_numbers_give_no_points_and_no_panic() {
    let all = [
        ball(0.05),
        cuboid(0.03, 0.04, 0.05),
        hull(0.03, 0.04, 0.05),
        cylinder(0.03, 0.05),
        box_mesh(0.03, 0.04, 0.05),
        contact::Shape::HalfSpace,
    ];
    for a in &all {
        for b in &all {
            for bad in [f64::NAN, f64::INFINITY] {
                assert!(points(a, b, at(bad, 0.0, 0.0), Frame::identity()).is_empty(), "{a:?} {b:?}");
            }
        }
    }
}
