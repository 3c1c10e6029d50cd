//! Short words for scenes of two shapes.

pub use contact::{Collider, ContactPoint, Detector, Scene, Shape};
pub use spatial::{Frame, Mat3, Pose, Vec3};

/// A few round-offs of lengths near one metre.
pub const ROUND_OFF: f64 = 1e-12;

pub fn ball(radius: f64) -> Shape {
    Shape::Ball { radius }
}

pub fn cuboid(x: f64, y: f64, z: f64) -> Shape {
    Shape::Cuboid { half_extents: Vec3::new(x, y, z) }
}

pub fn capsule(radius: f64, half_length: f64) -> Shape {
    Shape::Capsule { radius, half_length }
}

pub fn cylinder(radius: f64, half_length: f64) -> Shape {
    Shape::Cylinder { radius, half_length }
}

pub fn corners_of_cube(half: f64) -> Vec<Vec3> {
    (0..8).map(|i| half * Vec3::new(sign(i & 1), sign(i & 2), sign(i & 4))).collect()
}

fn sign(bit: i32) -> f64 {
    if bit == 0 { -1.0 } else { 1.0 }
}

pub fn hull(half: f64) -> Shape {
    Shape::ConvexHull { vertices: corners_of_cube(half) }
}

/// A square floor of 2 m in z = 0, of two triangles that look up.
pub fn floor() -> Shape {
    let vertices = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec();
    Shape::TriMesh { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]] }
}

pub fn at(x: f64, y: f64, z: f64) -> Frame {
    Frame { pos: Vec3::new(x, y, z), ..Frame::identity() }
}

/// Matrix of a rotation vector, rad.
pub fn rotation_matrix(rotation: &Vec3) -> Mat3 {
    *spatial::exp_rotation(rotation).to_rotation_matrix().matrix()
}

/// Turned by a rotation vector, rad, then moved.
pub fn turned(rotation: Vec3, x: f64, y: f64, z: f64) -> Frame {
    Frame { rot: rotation_matrix(&rotation), pos: Vec3::new(x, y, z) }
}

/// Two shapes, each a body of its own, and their pair.
pub struct Two {
    pub scene: Scene,
    pub detector: Detector,
    points: Vec<ContactPoint>,
}

impl Two {
    pub fn new(a: Shape, b: Shape) -> Self {
        let scene = Scene::new(vec![collider("a", 0, a), collider("b", 1, b)], vec![[0, 1]]).unwrap();
        let detector = Detector::new(&scene);
        Self { scene, detector, points: Vec::new() }
    }

    /// Points nearer than `reach` (and the skin that the detector adds).
    pub fn find(&mut self, a: &Frame, b: &Frame, reach: f64) -> &[ContactPoint] {
        self.detector.detect(&self.scene, &[*a, *b], &[reach, 0.0], &mut self.points);
        &self.points
    }

    /// Points that touch.
    pub fn find_touching(&mut self, a: &Frame, b: &Frame) -> Vec<ContactPoint> {
        self.find(a, b, 0.0).iter().filter(|p| p.gap < 0.0).copied().collect()
    }
}

pub fn collider(name: &str, body: usize, shape: Shape) -> Collider {
    Collider { name: name.to_string(), body, pose_bs: Pose::identity(), shape }
}

pub fn features(points: &[ContactPoint]) -> Vec<u64> {
    points.iter().map(|p| p.feature).collect()
}

/// Whether every point is where its normal and gap say.
pub fn assert_consistent(points: &[ContactPoint]) {
    for p in points {
        assert!((p.normal_w.norm() - 1.0).abs() < ROUND_OFF, "{p:?}");
        assert!((p.point_b_w - p.point_a_w - p.gap * p.normal_w).norm() < ROUND_OFF, "{p:?}");
    }
}
