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

/// An octahedron of 0.12 m.
fn octahedron() -> Vec<Vec3> {
    (0..6).map(|i| Vec3::ith(i / 2, if i % 2 == 0 { 0.12 } else { -0.12 })).collect()
}

#[test]
fn detecting_hulls_and_meshes_again_allocates_nothing() {
    let faces = vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    let shapes = [
        Shape::ConvexHull { vertices: octahedron() },
        Shape::TriMesh { vertices: octahedron(), triangles: faces },
        Shape::Cuboid { half_extents: Vec3::new(0.1, 0.2, 0.1) },
        Shape::Cylinder { radius: 0.1, half_length: 0.1 },
        Shape::HalfSpace,
    ];
    for (a, b) in [(0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (0, 3), (1, 3), (0, 4), (1, 4)] {
        let collider = |body: usize, shape: &Shape| Collider {
            name: body.to_string(),
            body,
            pose_bs: Pose::identity(),
            shape: shape.clone(),
        };
        let scene = Scene::new(vec![collider(0, &shapes[a]), collider(1, &shapes[b])], vec![[0, 1]]).unwrap();
        let (mut detector, mut points) = (Detector::new(&scene), Vec::new());
        let frame = |t: f64| Frame {
            rot: spatial::rotation_about(&Vec3::new(0.6, 0.0, 0.8), t),
            pos: Vec3::new(0.15 * t.cos(), 0.15 * t.sin(), 0.05),
        };
        let mut run = || {
            (0..400).for_each(|k| {
                detector.detect(&scene, &[Frame::identity(), frame(0.02 * f64::from(k))], &[0.01; 2], &mut points);
            })
        };
        run();
        assert_eq!(allocation_counter::measure(run).count_total, 0, "shapes {a} and {b}");
    }
}
