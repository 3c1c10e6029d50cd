//! Bars between pads: what a grasp rests on, while the pads give.

use crate::support::*;
use std::f64::consts::FRAC_PI_2;

/// Half the length of a pad along the bar, m.
const PAD: f64 = 0.02;
/// How deep the bar sits in each pad, m.
const DEPTH: f64 = 1e-5;

/// A bar of 30 mm along x between two pads above and below, as one collider each.
fn grasp(bar: &Shape) -> [Two; 2] {
    [(); 2].map(|()| Two::new(cuboid(PAD, 0.01, 0.006), bar.clone()))
}

/// The two pads' points on a bar that is turned by `turn` (rad) about its middle.
fn points_of(pads: &mut [Two; 2], bar: &Shape, turn: &Vec3) -> Vec<ContactPoint> {
    let lying =
        if matches!(bar, Shape::Cuboid { .. }) { Mat3::identity() } else { rotation_matrix(&(FRAC_PI_2 * Vec3::y())) };
    let frame = Frame { rot: rotation_matrix(turn) * lying, pos: Vec3::zeros() };
    let height = 0.015 + 0.006 - DEPTH;
    let [below, above] = pads;
    [below.find(&at(0.0, 0.0, -height), &frame, 0.0), above.find(&at(0.0, 0.0, height), &frame, 0.0)].concat()
}

fn bars() -> [(Shape, usize); 3] {
    [(cuboid(0.1, 0.015, 0.015), 8), (cylinder(0.015, 0.1), 4), (capsule(0.015, 0.1), 4)]
}

#[test]
fn bar_between_two_pads_rests_on_four_and_four_points_and_a_round_one_on_two_and_two() {
    for (bar, count) in bars() {
        let points = points_of(&mut grasp(&bar), &bar, &Vec3::zeros());
        assert_eq!(points.len(), count, "{bar:?}: {points:?}");
        assert!(points.iter().all(|p| (p.gap + DEPTH).abs() < ROUND_OFF && p.normal_w.z.abs() == 1.0), "{points:?}");
    }
}

#[test]
fn bar_keeps_its_points_while_the_pads_turn_by_tenths_of_a_milliradian() {
    for (bar, count) in bars() {
        let mut pads = grasp(&bar);
        let level = features(&points_of(&mut pads, &bar, &Vec3::zeros()));
        for i in 0..2000 {
            let t = 0.01 * f64::from(i);
            let turn = 3e-4 * Vec3::new((1.3 * t).sin(), (1.7 * t).sin(), (2.1 * t).sin());
            let points = points_of(&mut pads, &bar, &turn);
            assert_eq!(features(&points), level, "{bar:?} at {turn:?}: {count} points");
        }
    }
}

#[test]
fn round_bar_on_a_face_has_the_gaps_of_its_lowest_line() {
    // Leaning by φ about y, over the pad's edge x: the line's height is −r (1 − cos φ) / cos φ ∓ x tan φ from level.
    let bar = cylinder(0.015, 0.1);
    let mut pads = grasp(&bar);
    for i in -1000..=1000_i32 {
        let lean = 4e-6 * f64::from(i);
        let points = points_of(&mut pads, &bar, &Vec3::new(0.0, lean, 0.0));
        for p in &points {
            let x = p.point_a_w.x;
            assert!((x.abs() - PAD).abs() < 1e-9, "at the pad's edges: {p:?}");
            let expected = -DEPTH - 0.015 * (1.0 / lean.cos() - 1.0) + p.normal_w.z * (-x * lean.tan());
            assert!((p.gap - expected).abs() < 1e-12, "lean {lean}: {} against {expected}", p.gap);
        }
        let near = |gap: f64| gap < SKIN_AT_REST;
        let ends = [-1.0, 1.0].map(|side| -DEPTH - 0.015 * (1.0 / lean.cos() - 1.0) + side * PAD * lean.tan());
        assert_eq!(points.len(), 2 * ends.into_iter().filter(|g| near(*g)).count(), "lean {lean}");
    }
}

/// Distance within which the detector reports points of bodies that do not move, m.
const SKIN_AT_REST: f64 = 1e-4;

#[test]
fn force_of_a_round_bar_is_continuous_through_turns_of_every_size() {
    // A spring of 1 N/m at each point that touches. Steps of 20 µrad about an oblique axis move points by at most 0.1 m × 20 µrad.
    for (bar, _) in bars() {
        for other in [cuboid(PAD, 0.01, 0.006), Shape::HalfSpace] {
            let mut two = Two::new(other.clone(), bar.clone());
            let mut last: Option<f64> = None;
            for i in -4000..4000_i32 {
                let turn = 2e-5 * f64::from(i) * Vec3::new(0.28, 0.96, 0.0);
                let lying = if matches!(bar, Shape::Cuboid { .. }) { Vec3::zeros() } else { FRAC_PI_2 * Vec3::y() };
                let top = if other == Shape::HalfSpace { 0.0 } else { 0.006 };
                let frame = Frame {
                    rot: rotation_matrix(&turn) * rotation_matrix(&lying),
                    pos: Vec3::new(0.0, 0.0, top + 0.015 - 2e-4),
                };
                let force: f64 = two.find(&at(0.0, 0.0, 0.0), &frame, 0.0).iter().map(|p| (-p.gap).max(0.0)).sum();
                if let Some(last) = last {
                    assert!((force - last).abs() < 8e-6, "{bar:?} on {other:?} at {turn:?}: from {last} to {force}");
                }
                last = Some(force);
            }
        }
    }
}
