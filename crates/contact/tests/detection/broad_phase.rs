//! A broad phase keeps a hundred shapes from costing five thousand tests.

use crate::support::*;

fn grid() -> (Vec<Collider>, Vec<Frame>) {
    let colliders = (0..100).map(|i| collider(&format!("box {i}"), i, cuboid(0.1, 0.1, 0.1))).collect();
    // Neighbours overlap by a tenth of a millimetre, along x and y.
    let frames = (0..100).map(|i| at(0.1999 * f64::from(i % 10), 0.1999 * f64::from(i / 10), 0.0)).collect();
    (colliders, frames)
}

fn all_pairs() -> Vec<[usize; 2]> {
    (0..100).flat_map(|i| (i + 1..100).map(move |j| [i, j])).collect()
}

fn detect(pairs: Vec<[usize; 2]>) -> (Scene, Vec<ContactPoint>, u64) {
    let (colliders, frames) = grid();
    let scene = Scene::new(colliders, pairs).unwrap();
    let mut detector = Detector::new(&scene);
    let mut points = Vec::new();
    detector.detect(&scene, &frames, &[0.0; 100], &mut points);
    (scene, points, detector.narrow_count())
}

#[test]
fn hundred_boxes_in_a_grid_are_tested_with_their_neighbours_only() {
    let (_, points, narrow) = detect(all_pairs());
    // 180 neighbours by a side and 162 by an edge, of 4,950 pairs.
    assert_eq!(narrow, 342);
    assert!(points.len() >= 4 * 180);
}

#[test]
fn order_of_the_pairs_changes_nothing_but_their_numbers() {
    let mut shuffled = all_pairs();
    shuffled.reverse();
    shuffled.swap(7, 4000);
    let (scene, points, _) = detect(all_pairs());
    let (other_scene, other_points, _) = detect(shuffled);
    assert_eq!(points.len(), other_points.len());
    for p in &points {
        let pair = scene.pairs()[p.pair as usize];
        let same = |q: &&ContactPoint| other_scene.pairs()[q.pair as usize] == pair && q.feature == p.feature;
        let q = other_points.iter().find(same).unwrap();
        assert_eq!(ContactPoint { pair: p.pair, ..*q }, *p);
    }
}

#[test]
fn only_the_pairs_of_the_scene_are_looked_at() {
    let (scene, points, narrow) = detect(vec![[0, 1], [5, 99]]);
    assert_eq!(narrow, 1);
    assert!(points.iter().all(|p| scene.pairs()[p.pair as usize] == [0, 1]));
}

#[test]
fn reach_brings_in_pairs_that_may_meet_within_the_step() {
    let mut two = Two::new(ball(0.1), ball(0.1));
    assert_eq!(two.find(&at(0.0, 0.0, 0.0), &at(0.21, 0.0, 0.0), 0.0).len(), 0);
    assert_eq!(two.find(&at(0.0, 0.0, 0.0), &at(0.21, 0.0, 0.0), 0.02).len(), 1);
}
