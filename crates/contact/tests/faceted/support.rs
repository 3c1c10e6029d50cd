//! Two shapes, two poses, and the points between them.

use contact::{Collider, ContactPoint, Detector, Scene, Shape};
use spatial::{Frame, Pose, Vec3, exp_rotation};

/// Round-off of positions of the order of 1 m.
pub const ROUND_OFF: f64 = 1e-14;

pub fn v(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

pub fn at(x: f64, y: f64, z: f64) -> Frame {
    Frame { pos: v(x, y, z), ..Frame::identity() }
}

pub fn posed(pos: Vec3, turn: Vec3) -> Frame {
    Frame { rot: *exp_rotation(&turn).to_rotation_matrix().matrix(), pos }
}

pub fn collider(name: &str, body: usize, shape: Shape) -> Collider {
    Collider { name: name.to_string(), body, pose_bs: Pose::identity(), shape }
}

pub fn scene_of(a: Shape, b: Shape) -> Scene {
    Scene::new(vec![collider("a", 0, a), collider("b", 1, b)], vec![[0, 1]]).unwrap()
}

pub struct Bench {
    pub scene: Scene,
    pub detector: Detector,
    pub reach: f64,
}

impl Bench {
    pub fn new(a: Shape, b: Shape) -> Self {
        let scene = scene_of(a, b);
        let detector = Detector::new(&scene);
        Self { scene, detector, reach: 0.0 }
    }

    pub fn ask(&mut self, a: Frame, b: Frame) -> Vec<ContactPoint> {
        let mut out = Vec::new();
        self.detector.detect(&self.scene, &[a, b], &[self.reach, self.reach], &mut out);
        for p in &out {
            assert!((p.normal_w.norm() - 1.0).abs() < 1e-12, "{p:?}");
            assert!(((p.point_b_w - p.point_a_w).dot(&p.normal_w) - p.gap).abs() < 1e-12, "{p:?}");
        }
        assert!(out.windows(2).all(|w| w[0].feature < w[1].feature), "sorted, and no identity twice: {out:?}");
        out
    }
}

pub fn points(a: &Shape, b: &Shape, pose_a: Frame, pose_b: Frame) -> Vec<ContactPoint> {
    Bench::new(a.clone(), b.clone()).ask(pose_a, pose_b)
}

pub fn deepest(points: &[ContactPoint]) -> &ContactPoint {
    points.iter().min_by(|p, q| p.gap.total_cmp(&q.gap)).expect("a contact")
}

pub fn ball(radius: f64) -> Shape {
    Shape::Ball { radius }
}
pub fn cuboid(x: f64, y: f64, z: f64) -> Shape {
    Shape::Cuboid { half_extents: v(x, y, z) }
}
pub fn cylinder(radius: f64, half_length: f64) -> Shape {
    Shape::Cylinder { radius, half_length }
}
pub fn capsule(radius: f64, half_length: f64) -> Shape {
    Shape::Capsule { radius, half_length }
}

fn corners(x: f64, y: f64, z: f64) -> Vec<Vec3> {
    let sign = |i: usize, bit: usize| if i & bit == 0 { -1.0 } else { 1.0 };
    (0..8).map(|i| v(x * sign(i, 1), y * sign(i, 2), z * sign(i, 4))).collect()
}

pub fn hull(x: f64, y: f64, z: f64) -> Shape {
    Shape::ConvexHull { vertices: corners(x, y, z) }
}

/// A box as a closed mesh of twelve triangles, outward.
pub fn box_mesh(x: f64, y: f64, z: f64) -> Shape {
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
    Shape::TriMesh { vertices: corners(x, y, z), triangles }
}

/// A horizontal plate of n × n squares of two triangles each, open, centred, each triangle with its own vertices.
pub fn plate(half: f64, n: usize) -> Shape {
    let at = |i: usize| -half + 2.0 * half * i as f64 / n as f64;
    let mut vertices = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let c = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| v(at(i), at(j), 0.0));
            vertices.extend([c[0], c[1], c[2], c[0], c[2], c[3]]);
        }
    }
    let triangles = (0..vertices.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    Shape::TriMesh { vertices, triangles }
}
