//! Seats: how many points, in which balance, how stiff.

use crate::support::*;

/// A few round-offs of depths near 1e-5 m in positions near 0.1 m.
const ROUND_OFF: f64 = 1e-15;
const HALF_ANGLE: f64 = 0.7;

/// Height of a ball's centre that touches the cone all round.
fn seat_height(radius: f64) -> f64 {
    // Distance from the inner wall: ((ρ_throat + (z + depth) tan α) − ρ) cos α − radius = 0 on the axis.
    (radius / HALF_ANGLE.cos() - 0.02) / HALF_ANGLE.tan() - 0.14
}

#[test]
fn centred_ball_touches_a_cone_at_eight_points_in_balance() {
    let depth = 1e-5;
    let mut two = Two::new(Shape::Docking(cone()), Shape::Ball { radius: 0.04 });
    let z = seat_height(0.04) - depth / HALF_ANGLE.sin();
    let points = two.find_touching(&at(0.0, 0.0, 0.0), &at(0.0, 0.0, z));
    assert_eq!(points.len(), 8);
    let force: Vec3 = points.iter().map(|p| -p.gap * p.normal_w).sum();
    assert!(points.iter().all(|p| (p.gap + depth).abs() < 1e-16 + ROUND_OFF), "{points:?}");
    assert!(
        force.xy().norm() < ROUND_OFF && (force.z - 8.0 * depth * HALF_ANGLE.sin()).abs() < 8.0 * ROUND_OFF,
        "{force:?}"
    );
}

#[test]
fn ball_off_the_axis_touches_a_cone_at_one_point() {
    let mut two = Two::new(Shape::Docking(cone()), Shape::Ball { radius: 0.04 });
    // Across by e, up by e / tan α: along the wall on one side, away from it on the other.
    let z = seat_height(0.04) + 0.01 / HALF_ANGLE.tan() - 1e-5 / HALF_ANGLE.sin();
    let points = two.find_touching(&at(0.0, 0.0, 0.0), &at(0.006, 0.008, z));
    assert_eq!(points.len(), 1);
    let inward = Vec3::new(-0.6 * HALF_ANGLE.cos(), -0.8 * HALF_ANGLE.cos(), HALF_ANGLE.sin());
    assert!((points[0].normal_w - inward).norm() < 1e-13 && (points[0].gap + 1e-5).abs() < ROUND_OFF);
}

/// 8 k sin²α along the axis of a cone of half angle α, 4 k cos²α across it.
#[test]
fn seat_is_as_stiff_as_documented() {
    let (depth, step) = (1e-4, 1e-7);
    let mut two = Two::new(Shape::Docking(cone()), Shape::Ball { radius: 0.04 });
    let z = seat_height(0.04) - depth / HALF_ANGLE.sin();
    let mut force = |p: Vec3| -> Vec3 {
        let points = two.find_touching(&at(0.0, 0.0, 0.0), &at(p.x, p.y, z + p.z));
        points.iter().map(|p| -p.gap * p.normal_w).sum()
    };
    for (axis, stiffness) in [
        (Vec3::x(), 4.0 * HALF_ANGLE.cos().powi(2)),
        (Vec3::new(0.6, 0.8, 0.0), 4.0 * HALF_ANGLE.cos().powi(2)),
        (Vec3::z(), 8.0 * HALF_ANGLE.sin().powi(2)),
    ] {
        let slope = (force(step * axis) - force(-step * axis)) / (2.0 * step);
        // Relative to a radius of 40 mm the depth of 0.1 mm is what the eight normals turn by.
        assert!((slope + stiffness * axis).norm() < 1e-2, "{axis:?}: {slope:?} for {stiffness}");
    }
}

/// A ball on the bottom of a socket is on a plane: one point, also where the axis meets it.
#[test]
fn ball_on_the_floor_of_a_socket_has_one_point_on_it() {
    let mut two = Two::new(Shape::Docking(bore(true)), Shape::Ball { radius: 0.03 });
    for x in [0.0, 1e-12, 1e-6, 0.01] {
        let points = two.find_touching(&at(0.0, 0.0, 0.0), &at(x, 0.0, -0.12 + 0.03 - 1e-5));
        assert_eq!(points.len(), 1, "{points:?}");
        assert!((points[0].normal_w - Vec3::z()).norm() < 1e-15 && (points[0].gap + 1e-5).abs() < ROUND_OFF);
    }
}

/// Radius 49 mm in a bore of 50 mm, tilted until both touch: the lower end on one side, the rim on the other.
#[test]
fn tilted_peg_in_a_bore_touches_at_two_points() {
    for peg in [Shape::Capsule { radius: 0.049, half_length: 0.1 }, Shape::Cylinder { radius: 0.049, half_length: 0.1 }]
    {
        let mut two = Two::new(Shape::Docking(bore(false)), peg.clone());
        let gaps = |two: &mut Two, tilt: f64, x: f64| {
            let points = two.find(&at(0.0, 0.0, 0.0), &turned(tilt * Vec3::y(), x, 0.0, 0.03), 2e-3).to_vec();
            let side = |sign: f64| {
                points.iter().filter(|p| sign * p.normal_w.x > 0.5).map(|p| p.gap).fold(f64::INFINITY, f64::min)
            };
            (side(1.0), side(-1.0))
        };
        // Balanced sideways, then tilted to a depth of 1e-5 m on both sides.
        let (mut low, mut high) = (0.0, 0.1);
        let mut x = 0.0;
        for _ in 0..60 {
            let tilt = 0.5 * (low + high);
            for _ in 0..20 {
                let (left, right) = gaps(&mut two, tilt, x);
                x += 0.5 * (right - left);
            }
            if gaps(&mut two, tilt, x).0 > -1e-5 { low = tilt } else { high = tilt }
        }
        let points = two.find_touching(&at(0.0, 0.0, 0.0), &turned(low * Vec3::y(), x, 0.0, 0.03));
        assert_eq!(points.len(), 2, "{peg:?} at {low} rad: {points:?}");
        assert!(points.iter().all(|p| (p.gap + 1e-5).abs() < 1e-9), "{points:?}");
        assert!(points[0].normal_w.x * points[1].normal_w.x < -0.9, "{points:?}");
    }
}

#[test]
fn ring_that_lies_flat_touches_at_eight_fixed_points() {
    let mut two = Two::new(Shape::HalfSpace, Shape::Docking(ring()));
    let first = two.find_touching(&at(0.0, 0.0, 0.0), &at(0.0, 0.0, 0.015 - 1e-5));
    assert_eq!(first.len(), 8);
    for k in 0..100 {
        let tilt = 1e-9 * Vec3::new((k as f64).cos(), (k as f64).sin(), 0.0);
        let points = two.find_touching(&at(0.0, 0.0, 0.0), &turned(tilt, 0.0, 0.0, 0.015 - 1e-5));
        for (p, q) in points.iter().zip(&first) {
            assert!(p.feature == q.feature && (p.point_a_w - q.point_a_w).norm() < 1e-6, "{p:?} {q:?}");
        }
    }
}
