//! Gaps, normals and places that can be written down.

use crate::support::*;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

fn assert_near(found: Vec3, expected: Vec3) {
    assert!((found - expected).norm() < ROUND_OFF, "{found:?} is not {expected:?}");
}

/// The points sorted by position, for comparison with a list.
fn places(points: &[ContactPoint]) -> Vec<Vec3> {
    let mut places: Vec<Vec3> = points.iter().map(|p| p.point_b_w).collect();
    let key = |v: &Vec3| ((v.x * 1e6).round(), (v.y * 1e6).round(), (v.z * 1e6).round());
    places.sort_by(|p, q| key(p).partial_cmp(&key(q)).unwrap());
    places
}

fn assert_places(points: &[ContactPoint], expected: &[Vec3]) {
    let found = places(points);
    assert_eq!(found.len(), expected.len(), "{found:?}");
    found.iter().zip(expected).for_each(|(f, e)| assert_near(*f, *e));
}

#[test]
fn ball_and_ball_meet_on_the_line_of_centres() {
    let direction = Vec3::new(2.0, -1.0, 2.0) / 3.0;
    let b = 0.45 * direction;
    let mut two = Two::new(ball(0.2), ball(0.3));
    let points = two.find(&at(0.0, 0.0, 0.0), &at(b.x, b.y, b.z), 0.0);
    assert_eq!(points.len(), 1);
    assert_near(points[0].normal_w, direction);
    assert!((points[0].gap + 0.05).abs() < ROUND_OFF);
    assert_near(points[0].point_a_w, 0.2 * direction);
    assert_consistent(points);
}

#[test]
fn ball_on_a_slope_has_the_slopes_normal() {
    let slope = turned(Vec3::new(0.0, 0.3, 0.0), 0.0, 0.0, 0.0);
    let normal = slope.rot.column(2).into_owned();
    let centre = 0.19 * normal + 0.7 * slope.rot.column(0);
    let points = Two::new(Shape::HalfSpace, ball(0.2)).find_touching(&slope, &at(centre.x, centre.y, centre.z));
    assert_eq!(points.len(), 1);
    assert_near(points[0].normal_w, normal);
    assert!((points[0].gap + 0.01).abs() < ROUND_OFF);
}

#[test]
fn ball_on_a_box_meets_face_edge_and_vertex() {
    let mut two = Two::new(cuboid(1.0, 1.0, 1.0), ball(0.5));
    for outward in [Vec3::x(), Vec3::new(0.6, 0.8, 0.0), Vec3::new(2.0, 1.0, 2.0) / 3.0] {
        let corner = outward.map(|x| if x > 0.0 { 1.0 } else { 0.0 });
        let centre = corner + 0.49 * outward;
        let points = two.find(&at(0.0, 0.0, 0.0), &at(centre.x, centre.y, centre.z), 0.0);
        assert_eq!(points.len(), 1);
        assert_near(points[0].normal_w, outward);
        assert_near(points[0].point_a_w, corner);
        assert!((points[0].gap + 0.01).abs() < ROUND_OFF);
    }
}

#[test]
fn ball_inside_a_box_leaves_by_the_nearest_face() {
    let points = Two::new(cuboid(1.0, 2.0, 3.0), ball(0.1)).find_touching(&at(0.0, 0.0, 0.0), &at(0.0, -1.8, 0.0));
    assert_near(points[0].normal_w, -Vec3::y());
    assert!((points[0].gap + 0.3).abs() < ROUND_OFF);
}

#[test]
fn ball_on_a_capsule_and_on_a_cylinder() {
    for shape in [capsule(0.2, 0.5), cylinder(0.2, 0.5)] {
        let points = Two::new(shape, ball(0.1)).find_touching(&at(0.0, 0.0, 0.0), &at(0.0, 0.29, 0.3));
        assert_near(points[0].normal_w, Vec3::y());
        assert!((points[0].gap + 0.01).abs() < ROUND_OFF);
    }
    let points = Two::new(cylinder(0.2, 0.5), ball(0.1)).find_touching(&at(0.0, 0.0, 0.0), &at(0.05, 0.0, 0.59));
    assert_near(points[0].normal_w, Vec3::z());
    assert!((points[0].gap + 0.01).abs() < ROUND_OFF);
}

#[test]
fn box_on_a_plane_stands_on_four_corners() {
    let mut two = Two::new(Shape::HalfSpace, cuboid(0.1, 0.2, 0.3));
    let points = two.find_touching(&at(0.0, 0.0, 0.0), &at(1.0, 1.0, 0.299));
    assert_places(
        &points,
        &[
            Vec3::new(0.9, 0.8, -0.001),
            Vec3::new(0.9, 1.2, -0.001),
            Vec3::new(1.1, 0.8, -0.001),
            Vec3::new(1.1, 1.2, -0.001),
        ],
    );
    assert!(points.iter().all(|p| (p.gap + 0.001).abs() < ROUND_OFF && p.normal_w == Vec3::z()));
}

#[test]
fn box_on_a_box_stands_on_the_corners_of_the_overlap() {
    let mut two = Two::new(cuboid(0.5, 0.5, 0.5), cuboid(0.1, 0.2, 0.3));
    // Half over the edge: two of its own corners, and two where its edges cross the lower box's edge.
    let points = two.find_touching(&at(0.0, 0.0, 0.0), &at(0.5, 0.0, 0.799));
    assert_places(
        &points,
        &[
            Vec3::new(0.4, -0.2, 0.499),
            Vec3::new(0.4, 0.2, 0.499),
            Vec3::new(0.5, -0.2, 0.499),
            Vec3::new(0.5, 0.2, 0.499),
        ],
    );
    for p in &points {
        assert!((p.gap + 0.001).abs() < ROUND_OFF && p.normal_w == Vec3::z(), "{p:?}");
    }
    assert_consistent(&points);
}

#[test]
fn equal_boxes_flush_on_each_other_have_four_points() {
    let mut two = Two::new(cuboid(0.1, 0.1, 0.1), cuboid(0.1, 0.1, 0.1));
    for twist in [0.0, 1e-15, -1e-12, 1e-9] {
        let b = turned(Vec3::new(0.0, 0.0, twist), 1e-14, -1e-13, 0.1999);
        let points = two.find_touching(&at(0.0, 0.0, 0.0), &b);
        assert_eq!(points.len(), 4, "{points:?}");
        assert!(points.iter().all(|p| (p.gap + 1e-4).abs() < ROUND_OFF));
    }
}

#[test]
fn box_on_its_vertex_and_on_its_edge_on_a_box() {
    let mut two = Two::new(cuboid(1.0, 1.0, 0.5), cuboid(0.1, 0.1, 0.1));
    let on_edge = turned(Vec3::new(FRAC_PI_4, 0.0, 0.0), 0.0, 0.0, 0.5 + 0.1 * 2f64.sqrt() - 1e-4);
    let points = two.find_touching(&at(0.0, 0.0, 0.0), &on_edge);
    assert_places(&points, &[Vec3::new(-0.1, 0.0, 0.4999), Vec3::new(0.1, 0.0, 0.4999)]);
    // The space diagonal upright: a turn about (1, −1, 0) by the angle between (1, 1, 1) and z.
    let axis = Vec3::new(1.0, -1.0, 0.0).normalize() * -(1.0 / 3f64.sqrt()).acos();
    let on_vertex = turned(axis, 0.0, 0.0, 0.5 + 0.1 * 3f64.sqrt() - 1e-4);
    let points = two.find_touching(&at(0.0, 0.0, 0.0), &on_vertex);
    assert_places(&points, &[Vec3::new(0.0, 0.0, 0.4999)]);
    assert_near(points[0].normal_w, Vec3::z());
}

#[test]
fn crossed_edges_meet_in_one_point_along_their_common_perpendicular() {
    let mut two = Two::new(cuboid(1.0, 0.1, 0.1), cuboid(0.1, 1.0, 0.1));
    let a = turned(Vec3::new(FRAC_PI_4, 0.0, 0.0), 0.0, 0.0, 0.0);
    let b = turned(Vec3::new(0.0, FRAC_PI_4, 0.0), 0.0, 0.0, 0.2 * 2f64.sqrt() - 1e-4);
    let points = two.find_touching(&a, &b);
    assert_places(&points, &[Vec3::new(0.0, 0.0, 0.1 * 2f64.sqrt() - 1e-4)]);
    assert_near(points[0].normal_w, Vec3::z());
    assert!((points[0].gap + 1e-4).abs() < ROUND_OFF);
}

#[test]
fn capsule_lies_on_box_and_plane_on_two_points_and_stands_on_one() {
    let lying = turned(Vec3::new(0.0, FRAC_PI_2, 0.0), 0.0, 0.0, 0.049);
    let top = at(0.0, 0.0, -0.5);
    for (shape, frame) in [(cuboid(0.5, 0.5, 0.5), top), (Shape::HalfSpace, at(0.0, 0.0, 0.0))] {
        let mut two = Two::new(shape, capsule(0.05, 0.2));
        let points = two.find_touching(&frame, &lying);
        assert_places(&points, &[Vec3::new(-0.2, 0.0, -0.001), Vec3::new(0.2, 0.0, -0.001)]);
        assert_consistent(&points);
        let points = two.find_touching(&frame, &at(0.1, 0.0, 0.249));
        assert_places(&points, &[Vec3::new(0.1, 0.0, -0.001)]);
    }
}

#[test]
fn capsule_bar_between_the_ends_of_a_pad_touches_it_at_both_edges() {
    // A bar along x that overhangs a pad 40 mm long: the points are at the pad's edges, not at the bar's ends.
    let mut two = Two::new(cuboid(0.02, 0.006, 0.03), capsule(0.015, 0.1));
    let bar = turned(Vec3::new(0.0, FRAC_PI_2, 0.0), 0.0, 0.0209, 0.0);
    let points = two.find_touching(&at(0.0, 0.0, 0.0), &bar);
    assert_places(&points, &[Vec3::new(-0.02, 0.0059, 0.0), Vec3::new(0.02, 0.0059, 0.0)]);
}

#[test]
fn capsule_beside_a_box_meets_its_edge_and_its_vertex() {
    let mut two = Two::new(cuboid(0.5, 0.5, 0.5), capsule(0.05, 0.2));
    let outward = Vec3::new(0.6, 0.8, 0.0);
    let beside = Vec3::new(0.5, 0.5, 0.0) + 0.049 * outward;
    let points = two.find_touching(&at(0.0, 0.0, 0.0), &at(beside.x, beside.y, beside.z));
    assert_eq!(points.len(), 2, "{points:?}");
    points.iter().for_each(|p| assert_near(p.normal_w, outward));
    let outward = Vec3::new(2.0, 2.0, 1.0) / 3.0;
    let above = Vec3::new(0.5, 0.5, 0.5) + 0.049 * outward + Vec3::new(0.0, 0.0, 0.2);
    let points = two.find_touching(&at(0.0, 0.0, 0.0), &at(above.x, above.y, above.z));
    assert_eq!(points.len(), 1, "{points:?}");
    assert_near(points[0].normal_w, outward);
    assert!((points[0].gap + 0.001).abs() < ROUND_OFF);
}

#[test]
fn crossed_capsules_meet_in_one_point_and_parallel_ones_in_two() {
    let mut two = Two::new(capsule(0.05, 0.2), capsule(0.05, 0.2));
    let crossed = turned(Vec3::new(FRAC_PI_2, 0.0, 0.0), 0.099, 0.0, 0.0);
    let points = two.find_touching(&at(0.0, 0.0, 0.0), &crossed);
    assert_places(&points, &[Vec3::new(0.049, 0.0, 0.0)]);
    let points = two.find_touching(&at(0.0, 0.0, 0.0), &at(0.099, 0.0, 0.1));
    assert_places(&points, &[Vec3::new(0.049, 0.0, -0.1), Vec3::new(0.049, 0.0, 0.2)]);
}

#[test]
fn cylinder_stands_on_its_rim_and_lies_on_its_line() {
    let (on_box, on_plane) = (at(0.0, 0.0, -0.5), at(0.0, 0.0, 0.0));
    for (shape, frame) in [(cuboid(0.5, 0.5, 0.5), on_box), (Shape::HalfSpace, on_plane)] {
        let mut two = Two::new(shape, cylinder(0.1, 0.2));
        let points = two.find_touching(&frame, &at(0.0, 0.0, 0.199));
        assert_eq!(points.len(), 8);
        for p in &points {
            assert!((p.point_b_w.xy().norm() - 0.1).abs() < ROUND_OFF && (p.gap + 0.001).abs() < ROUND_OFF);
        }
        let lying = turned(Vec3::new(FRAC_PI_2, 0.0, 0.0), 0.0, 0.0, 0.099);
        let points = two.find_touching(&frame, &lying);
        assert_places(&points, &[Vec3::new(0.0, -0.2, -0.001), Vec3::new(0.0, 0.2, -0.001)]);
    }
}

#[test]
fn cylinder_bar_in_a_pad_touches_it_at_both_edges() {
    let mut two = Two::new(cuboid(0.02, 0.006, 0.03), cylinder(0.015, 0.1));
    let bar = turned(Vec3::new(0.0, FRAC_PI_2, 0.0), 0.0, 0.0209, 0.0);
    let points = two.find_touching(&at(0.0, 0.0, 0.0), &bar);
    assert_places(&points, &[Vec3::new(-0.02, 0.0059, 0.0), Vec3::new(0.02, 0.0059, 0.0)]);
}

#[test]
fn tilted_cylinder_touches_a_plane_with_the_deepest_point_of_its_rim() {
    let tilt: f64 = 0.2;
    let height = 0.2 * tilt.cos() + 0.1 * tilt.sin();
    let points = Two::new(Shape::HalfSpace, cylinder(0.1, 0.2))
        .find_touching(&at(0.0, 0.0, 0.0), &turned(Vec3::new(0.0, tilt, 0.0), 0.0, 0.0, height - 1e-5));
    assert_eq!(points.len(), 1, "{points:?}");
    assert!((points[0].gap + 1e-5).abs() < ROUND_OFF);
}

#[test]
fn rim_of_a_cylinder_meets_an_edge_in_one_point() {
    // The lowest point of a leaning cylinder's rim, where it runs along x, on an edge that runs along y.
    let bar = turned(Vec3::new(0.0, FRAC_PI_4, 0.0), 0.0, 0.0, -0.1 * 2f64.sqrt());
    let tilt = Vec3::new(0.5, 0.0, 0.0);
    let rim = rotation_matrix(&tilt) * Vec3::new(0.0, -0.1, -0.2);
    let frame = turned(tilt, 0.0, -rim.y, -rim.z - 1e-4);
    let points = Two::new(cuboid(0.1, 1.0, 0.1), cylinder(0.1, 0.2)).find_touching(&bar, &frame);
    assert_eq!(points.len(), 1, "{points:?}");
    assert!((points[0].normal_w - Vec3::z()).norm() < ROUND_OFF && (points[0].gap + 1e-4).abs() < ROUND_OFF);
}

#[test]
fn hull_stands_like_the_box_it_is() {
    for ground in [Shape::HalfSpace, floor()] {
        let points = Two::new(ground, hull(0.1)).find_touching(&at(0.0, 0.0, 0.0), &at(0.2, 0.1, 0.099));
        assert!(points.len() >= 4, "{points:?}");
        for p in &points {
            // Iterations of the closest points end at about 1e-9 of the size.
            assert!((p.gap + 0.001).abs() < 1e-9 && (p.normal_w - Vec3::z()).norm() < 1e-6, "{p:?}");
        }
        for corner in [(0.1, 0.0), (0.3, 0.0), (0.1, 0.2), (0.3, 0.2)] {
            let near = |p: &ContactPoint| (p.point_b_w.xy() - Vec3::new(corner.0, corner.1, 0.0).xy()).norm() < 1e-6;
            assert!(points.iter().any(near), "no point at {corner:?}");
        }
    }
}

#[test]
fn box_on_a_mesh_floor_is_carried_at_its_corners() {
    let points = Two::new(floor(), cuboid(0.1, 0.1, 0.1)).find_touching(&at(0.0, 0.0, 0.0), &at(0.0, 0.05, 0.0999));
    for p in &points {
        assert!((p.gap + 1e-4).abs() < 1e-9 && (p.normal_w - Vec3::z()).norm() < 1e-6, "{p:?}");
    }
    for corner in [(-0.1, -0.05), (0.1, -0.05), (-0.1, 0.15), (0.1, 0.15)] {
        let near = |p: &&ContactPoint| (p.point_b_w.xy() - Vec3::new(corner.0, corner.1, 0.0).xy()).norm() < 1e-6;
        assert_eq!(points.iter().filter(near).count(), 1, "one point at {corner:?}: {points:?}");
    }
}

fn fork() -> Shape {
    let wall = |x: f64| (Pose::translation(x, 0.0, 0.05), cuboid(0.01, 0.05, 0.05));
    Shape::Compound(vec![wall(-0.05), wall(0.05), (Pose::translation(0.0, 0.0, -0.01), cuboid(0.06, 0.05, 0.01))])
}

#[test]
fn rod_through_the_gap_of_a_fork_touches_nothing_and_in_its_bottom_the_bottom() {
    let mut two = Two::new(fork(), capsule(0.02, 0.3));
    let rod = |z: f64| turned(Vec3::new(FRAC_PI_2, 0.0, 0.0), 0.0, 0.0, z);
    assert_eq!(two.find(&at(0.0, 0.0, 0.0), &rod(0.05), 0.01).len(), 0);
    let points = two.find_touching(&at(0.0, 0.0, 0.0), &rod(0.0199));
    assert_eq!(points.len(), 2, "{points:?}");
    points.iter().for_each(|p| assert_near(p.normal_w, Vec3::z()));
}
