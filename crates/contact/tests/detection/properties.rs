//! What holds for every pair: symmetry, purity, finite answers.

use crate::support::*;
use proptest::prelude::*;

/// Two cylinders whose rims cross are left to an iteration that ends, on curved surfaces, with the normal some 1e-5 rad off
/// (7e-6 at most in 20,000 cases, where all other pairs were within 1e-9).
const RIM_ON_RIM: f64 = 1e-4;

fn shapes() -> Vec<Shape> {
    vec![
        ball(0.1),
        cuboid(0.1, 0.2, 0.15),
        capsule(0.08, 0.15),
        cylinder(0.12, 0.1),
        hull(0.12),
        Shape::HalfSpace,
        floor(),
        Shape::Compound(vec![(Pose::translation(0.1, 0.0, 0.0), ball(0.1)), (Pose::identity(), cuboid(0.1, 0.1, 0.1))]),
    ]
}

fn poses() -> impl Strategy<Value = Frame> {
    (prop::array::uniform3(-3.0..3.0f64), prop::array::uniform3(-0.3..0.3f64))
        .prop_map(|(turn, pos)| turned(Vec3::from(turn), pos[0], pos[1], pos[2]))
}

fn bits(points: &[ContactPoint]) -> Vec<u64> {
    let of = |v: &Vec3| [v.x.to_bits(), v.y.to_bits(), v.z.to_bits()];
    points
        .iter()
        .flat_map(|p| [vec![p.feature, p.gap.to_bits()], [of(&p.point_a_w), of(&p.normal_w)].concat()].concat())
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn points_are_finite_and_consistent(a in poses(), b in poses(), i in 0..8usize, j in 0..8usize) {
        let mut two = Two::new(shapes()[i].clone(), shapes()[j].clone());
        let points = two.find(&a, &b, 0.01);
        for p in points {
            prop_assert!(p.gap.is_finite() && p.point_a_w.iter().chain(p.normal_w.iter()).all(|x| x.is_finite()));
        }
        assert_consistent(points);
    }

    #[test]
    fn an_answer_does_not_depend_on_what_was_asked_before(
        history in prop::collection::vec((poses(), poses()), 1..5), a in poses(), b in poses(),
        i in 0..8usize, j in 0..8usize,
    ) {
        let fresh = bits(Two::new(shapes()[i].clone(), shapes()[j].clone()).find(&a, &b, 0.01));
        let mut two = Two::new(shapes()[i].clone(), shapes()[j].clone());
        for (before_a, before_b) in &history {
            two.find(before_a, before_b, 0.02);
        }
        prop_assert_eq!(bits(two.find(&a, &b, 0.01)), fresh);
    }

    #[test]
    fn swapping_bodies_flips_the_normal_and_keeps_the_gaps(a in poses(), b in poses(), i in 0..4usize, j in 0..4usize) {
        let (one, other) = (shapes()[i].clone(), shapes()[j].clone());
        let straight = Two::new(one.clone(), other.clone()).find(&a, &b, 0.0).to_vec();
        let turned_round = Two::new(other, one).find(&b, &a, 0.0).to_vec();
        prop_assert_eq!(straight.len(), turned_round.len());
        for p in &straight {
            let same = |q: &&ContactPoint| (q.point_b_w - p.point_a_w).norm() < 1e-6;
            let Some(q) = turned_round.iter().find(same) else { panic!("{p:?} has no twin in {turned_round:?}") };
            let tolerance = if (i, j) == (3, 3) { RIM_ON_RIM } else { 1e-9 };
            prop_assert!((p.normal_w + q.normal_w).norm() < tolerance && (p.gap - q.gap).abs() < 1e-9);
        }
    }

    /// A box whose corner is sunk into a plane by δ, anywhere: the plane's answer and that of a large box agree.
    #[test]
    fn a_large_box_is_a_plane(b in poses(), j in 1..4usize) {
        let shape = shapes()[j].clone();
        let mut lift = b;
        lift.pos.z = 0.0;
        let low = Two::new(Shape::HalfSpace, shape.clone())
            .find(&at(0.0, 0.0, 0.0), &lift, 1.0)
            .iter().map(|p| p.gap).fold(f64::INFINITY, f64::min);
        lift.pos.z = -low - 1e-5;
        let on_plane = Two::new(Shape::HalfSpace, shape.clone()).find_touching(&at(0.0, 0.0, 0.0), &lift);
        let on_box = Two::new(cuboid(5.0, 5.0, 5.0), shape).find_touching(&at(0.0, 0.0, -5.0), &lift);
        prop_assert_eq!(on_plane.len(), on_box.len());
        for p in &on_plane {
            prop_assert!(on_box.iter().any(|q| (p.point_b_w - q.point_b_w).norm() < 1e-9 && (p.gap - q.gap).abs() < 1e-9));
        }
    }
}

#[test]
fn concentric_and_deep_pairs_give_numbers() {
    for (i, a) in shapes().iter().enumerate() {
        for (j, b) in shapes().iter().enumerate() {
            for frame in [at(0.0, 0.0, 0.0), at(1e-12, 0.0, 0.0), at(0.01, 0.01, 0.01)] {
                for p in Two::new(a.clone(), b.clone()).find(&at(0.0, 0.0, 0.0), &frame, 0.0) {
                    let all = [p.gap, p.normal_w.sum(), p.point_a_w.sum(), p.point_b_w.sum()];
                    assert!(all.iter().all(|x| x.is_finite()), "shapes {i} and {j}: {p:?}");
                    assert!((p.normal_w.norm() - 1.0).abs() < 1e-9, "shapes {i} and {j}: {p:?}");
                }
            }
        }
    }
}
