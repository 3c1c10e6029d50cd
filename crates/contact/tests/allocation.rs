//! Detection allocates nothing once its buffers have grown.

#![allow(clippy::unwrap_used)]

use contact::{Collider, Detector, Scene, Shape};
use spatial::{Frame, Pose, Vec3};

#[test]
fn detecting_primitives_again_allocates_nothing() {
    let shapes = [
        Shape::Ball { radius: 0.1 },
        Shape::Cuboid { half_extents: Vec3::new(0.1, 0.2, 0.1) },
        Shape::Capsule { radius: 0.1, half_length: 0.1 },
        Shape::Cylinder { radius: 0.1, half_length: 0.1 },
        Shape::HalfSpace,
    ];
    let colliders: Vec<Collider> = (0..10)
        .map(|i| Collider {
            name: i.to_string(),
            body: i,
            pose_bs: Pose::identity(),
            shape: shapes[i % shapes.len()].clone(),
        })
        .collect();
    let pairs = (0..10).flat_map(|i| (i + 1..10).map(move |j| [i, j])).collect();
    let scene = Scene::new(colliders, pairs).unwrap();
    let (mut detector, mut points) = (Detector::new(&scene), Vec::new());
    let frames = |t: f64| -> Vec<Frame> {
        let place = |i: usize| 0.15 * Vec3::new((i as f64 + t).sin(), (2.0 * i as f64).cos(), 0.2 * i as f64);
        (0..10).map(|i| Frame { rot: spatial::rotation_about(&Vec3::ith(i % 3, 1.0), t), pos: place(i) }).collect()
    };
    let motion: Vec<Vec<Frame>> = (0..200).map(|k| frames(0.01 * f64::from(k))).collect();
    let mut run = || {
        for poses in &motion {
            detector.detect(&scene, poses, &[0.01; 10], &mut points);
        }
    };
    run();
    assert_eq!(allocation_counter::measure(run).count_total, 0);
    assert!(!points.is_empty());
}
