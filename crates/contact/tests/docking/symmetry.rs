//! What holds for every pair: third law, rotation of the world, purity, order of the scene, no allocation.

use crate::support::*;

fn bits(points: &[ContactPoint]) -> Vec<u64> {
    let of = |v: &Vec3| [v.x.to_bits(), v.y.to_bits(), v.z.to_bits()];
    points
        .iter()
        .flat_map(|p| [vec![p.feature, p.gap.to_bits()], [of(&p.point_a_w), of(&p.normal_w)].concat()].concat())
        .collect()
}

fn pairs() -> impl Iterator<Item = (Shape, Shape)> {
    shapes().into_iter().take(5).flat_map(|a| shapes().into_iter().map(move |b| (a.clone(), b)))
}

/// Identities, gaps and normals to the bit; also of twins, whose names lead then.
#[test]
fn swapping_bodies_flips_the_normal_and_changes_no_bit_of_the_gap() {
    let (mut dice, mut told) = (Dice(3), 0);
    for (one, other) in pairs() {
        let is_compound = [&one, &other].iter().any(|s| **s == Shape::Docking(bore(true)));
        let mut straight = Two::named(("left", one.clone()), ("right", other.clone()));
        let mut swapped = Two::named(("right", other), ("left", one));
        for _ in 0..60 {
            let (a, b) = (dice.frame(0.2), dice.frame(0.1));
            let points = straight.find(&a, &b, 0.005).to_vec();
            if points.iter().any(|p| p.gap < -4e-3) {
                continue;
            }
            let turned = swapped.find(&b, &a, 0.005);
            assert_eq!(points.len(), turned.len());
            for p in &points {
                // Names of parts stand in the order of the bodies.
                let same = |q: &&ContactPoint| {
                    (p.gap, p.normal_w) == (q.gap, -q.normal_w) && (is_compound || p.feature == q.feature)
                };
                let Some(q) = turned.iter().find(same) else { panic!("{p:?} has no twin in {turned:?}") };
                assert!((p.point_a_w - q.point_b_w).norm() < 1e-15);
            }
            told += points.len();
        }
    }
    assert!(told > 100, "{told}");
}

#[test]
fn rotating_the_world_changes_nothing_beyond_round_off() {
    let (mut dice, mut told) = (Dice(5), 0);
    for (one, other) in pairs() {
        let mut two = Two::new(one, other);
        for _ in 0..20 {
            let (a, b, world) = (dice.frame(0.2), dice.frame(0.1), dice.frame(0.0));
            let points = two.find(&a, &b, 0.02).to_vec();
            // Cores that cross have no normal to speak of.
            if points.iter().any(|p| p.gap < -4e-3) {
                continue;
            }
            let moved = two.find(&(&world * &a), &(&world * &b), 0.02);
            assert_eq!(points.len(), moved.len());
            for (p, q) in points.iter().zip(moved) {
                assert_eq!(p.feature, q.feature);
                assert!(
                    (p.gap - q.gap).abs() < 1e-12 && (world.rot * p.normal_w - q.normal_w).norm() < 1e-12,
                    "{p:?} {q:?}"
                );
                assert!((world.point(&p.point_a_w) - q.point_a_w).norm() < 1e-12, "{p:?} {q:?}");
            }
            told += points.len();
        }
    }
    assert!(told > 150, "{told}");
}

#[test]
fn points_are_finite_consistent_and_without_history() {
    let mut dice = Dice(9);
    for (one, other) in pairs() {
        let mut used = Two::new(one.clone(), other.clone());
        for k in 0..20 {
            let (a, b) =
                if k == 0 { (at(0.0, 0.0, 0.0), at(0.0, 0.0, 0.0)) } else { (dice.frame(0.1), dice.frame(0.1)) };
            let points = used.find(&a, &b, 0.01).to_vec();
            let mut names: Vec<u64> = points.iter().map(|p| p.feature).collect();
            names.dedup();
            assert_eq!(names.len(), points.len(), "two points of one name: {points:?}");
            for p in &points {
                assert!(p.gap.is_finite() && (p.normal_w.norm() - 1.0).abs() < 1e-12, "{one:?} {other:?} {p:?}");
                assert!((p.point_b_w - p.point_a_w - p.gap * p.normal_w).norm() < 1e-15);
            }
            assert_eq!(bits(&points), bits(Two::new(one.clone(), other.clone()).find(&a, &b, 0.01)));
        }
    }
}

/// Six bodies in all orders of colliders and pairs: the same points to the bit, pair by pair.
#[test]
fn shuffling_the_scene_changes_no_bit() {
    let all: Vec<Shape> = shapes().into_iter().skip(1).step_by(2).chain([Shape::Docking(ring())]).collect();
    let (n, mut dice) = (all.len(), Dice(13));
    let frames: Vec<Frame> = (0..n).map(|_| dice.frame(0.1)).collect();
    let find = |order: &[usize]| {
        let colliders = order.iter().map(|&i| collider(&i.to_string(), i, all[i].clone())).collect();
        let place = |i: usize| order.iter().position(|k| *k == i).unwrap();
        let pairs: Vec<[usize; 2]> =
            order.iter().flat_map(|&i| (0..n).filter(move |j| i < *j).map(move |j| [i, j])).collect();
        let scene = Scene::new(colliders, pairs.iter().map(|p| p.map(place)).collect()).unwrap();
        let mut points = Vec::new();
        Detector::new(&scene).detect(&scene, &frames, &vec![0.01; n], &mut points);
        let mut told: Vec<([usize; 2], Vec<u64>)> =
            points.iter().map(|p| (pairs[p.pair as usize], bits(std::slice::from_ref(p)))).collect();
        told.sort();
        told
    };
    let straight = find(&(0..n).collect::<Vec<_>>());
    assert!(straight.len() > 20);
    for _ in 0..20 {
        let mut order: Vec<usize> = (0..n).collect();
        for i in (1..n).rev() {
            order.swap(i, (dice.roll() * (i + 1) as f64) as usize);
        }
        assert_eq!(find(&order), straight);
    }
}

#[test]
fn detecting_again_allocates_nothing() {
    let mut dice = Dice(17);
    let frames: Vec<(Frame, Frame)> = (0..20).map(|_| (dice.frame(0.1), dice.frame(0.1))).collect();
    let mut twos: Vec<Two> = pairs().map(|(a, b)| Two::new(a, b)).collect();
    let mut run = || {
        for two in &mut twos {
            frames.iter().for_each(|(a, b)| {
                two.find(a, b, 0.01);
            });
        }
    };
    run();
    assert_eq!(allocation_counter::measure(run).count_total, 0);
}

#[test]
fn sizes_out_of_range_are_named() {
    let message = |docking: Docking| {
        Scene::new(vec![collider("port", 0, Shape::Docking(docking))], vec![]).unwrap_err().to_string()
    };
    let wide = Docking::InnerCone { half_angle: 2.0, depth: 0.1, throat_radius: 0.0, wall: 0.01 };
    assert_eq!(
        message(wide),
        "collider \"port\": half angle is 114.59155902616465°; it must be greater than 0° and less than 90°"
    );
    let thin = Docking::Ring { major_radius: 0.1, minor_radius: 0.0 };
    assert_eq!(message(thin), "collider \"port\": minor radius is 0 m; it must be finite and greater than zero");
    let endless =
        Docking::Petal { base_radius: 0.1, tip_radius: 0.1, height: f64::NAN, half_sector: 0.3, thickness: 0.01 };
    assert!(message(endless).contains("height is NaN m"));
}
