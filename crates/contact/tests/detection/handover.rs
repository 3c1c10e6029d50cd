//! From a face to crossed edges: what carries the force changes, the force does not jump.

use crate::support::*;

/// Springs of 1 N/m at the points that touch: the force on B.
fn force_of(two: &mut Two, b: &Frame) -> Vec3 {
    two.find(&at(0.0, 0.0, 0.0), b, 0.0).iter().map(|p| (-p.gap).max(0.0) * p.normal_w).sum()
}

/// A bar along x on one along y, leaning from flat to 30° about y and to 9° about x; over the lower bar's edge x = 0.02 the
/// lower of its long lower edges stays 0.2 mm deep.
fn lean(i: i32, yaw: f64) -> Frame {
    let angle = 5e-5 * f64::from(i);
    let turn = |axis: Vec3, angle: f64| rotation_matrix(&(angle * axis));
    let rot = turn(Vec3::z(), yaw) * turn(Vec3::y(), angle) * turn(Vec3::x(), 0.3 * angle);
    let height = |y: f64| {
        let along = (0.02 - rot[(0, 1)] * y + rot[(0, 2)] * 0.02) / rot[(0, 0)];
        rot[(2, 0)] * along + rot[(2, 1)] * y - rot[(2, 2)] * 0.02
    };
    Frame { rot, pos: Vec3::new(0.0, 0.0, 0.02 - 2e-4 - height(0.02).min(height(-0.02))) }
}

#[test]
fn force_turns_continuously_from_a_face_to_crossed_edges() {
    let mut two = Two::new(cuboid(0.02, 0.2, 0.02), cuboid(0.2, 0.02, 0.02));
    let mut worst: (f64, f64, f64) = (0.0, 0.0, 0.0);
    for yaw in [0.0, 0.3, 0.7] {
        let mut last: Option<Vec3> = None;
        for i in 0..10_000 {
            let force = force_of(&mut two, &lean(i, yaw));
            if let Some(before) = last.filter(|f| f.norm() > 0.0) {
                let jump = (force - before).norm() / before.norm();
                if jump > worst.0 {
                    worst = (jump, yaw, 5e-5 * f64::from(i));
                }
            }
            last = Some(force);
        }
    }
    // Measured 1.8 %, at 2.7 mrad, where the far corners leave. Without mixing normals: 17 %, the sine of the 10° at which
    // edges take over.
    assert!(worst.0 < 0.02, "the force jumps by {} of itself at yaw {} and lean {}", worst.0, worst.1, worst.2);
}
