//! Short words for docking shapes and pairs of them.

pub use contact::{Collider, ContactPoint, Detector, Docking, Scene, Shape};
pub use spatial::{Frame, Pose, Vec3};

pub fn cone() -> Docking {
    Docking::InnerCone { half_angle: 0.7, depth: 0.14, throat_radius: 0.02, wall: 0.01 }
}

pub fn bore(floor: bool) -> Docking {
    Docking::InnerCylinder { radius: 0.05, depth: 0.12, wall: 0.012, floor }
}

pub fn ring() -> Docking {
    Docking::Ring { major_radius: 0.2, minor_radius: 0.015 }
}

pub fn petal() -> Docking {
    Docking::Petal { base_radius: 0.15, tip_radius: 0.07, height: 0.12, half_sector: 0.5, thickness: 0.012 }
}

/// Ball, capsule, cylinder, box, half-space.
pub fn plain() -> Vec<Shape> {
    vec![
        Shape::Ball { radius: 0.03 },
        Shape::Capsule { radius: 0.02, half_length: 0.07 },
        Shape::Cylinder { radius: 0.03, half_length: 0.06 },
        Shape::Cuboid { half_extents: Vec3::new(0.03, 0.05, 0.04) },
        Shape::HalfSpace,
    ]
}

pub fn dockings() -> [Docking; 5] {
    [cone(), bore(false), bore(true), ring(), petal()]
}

/// All docking shapes, then the plain ones.
pub fn shapes() -> Vec<Shape> {
    dockings().map(Shape::Docking).into_iter().chain(plain()).collect()
}

pub fn at(x: f64, y: f64, z: f64) -> Frame {
    Frame { pos: Vec3::new(x, y, z), ..Frame::identity() }
}

/// Turned by a rotation vector, rad, then moved.
pub fn turned(rotation: Vec3, x: f64, y: f64, z: f64) -> Frame {
    Frame { rot: *spatial::exp_rotation(&rotation).to_rotation_matrix().matrix(), pos: Vec3::new(x, y, z) }
}

/// Two shapes, each a body of its own, and their pair.
pub struct Two {
    pub scene: Scene,
    detector: Detector,
    points: Vec<ContactPoint>,
}

impl Two {
    pub fn new(a: Shape, b: Shape) -> Self {
        Self::named(("a", a), ("b", b))
    }

    pub fn named(a: (&str, Shape), b: (&str, Shape)) -> Self {
        let scene = Scene::new(vec![collider(a.0, 0, a.1), collider(b.0, 1, b.1)], vec![[0, 1]]).unwrap();
        let detector = Detector::new(&scene);
        Self { scene, detector, points: Vec::new() }
    }

    /// Points nearer than `reach` and the detector's skin.
    pub fn find(&mut self, a: &Frame, b: &Frame, reach: f64) -> &[ContactPoint] {
        self.detector.detect(&self.scene, &[*a, *b], &[reach, 0.0], &mut self.points);
        &self.points
    }

    pub fn find_touching(&mut self, a: &Frame, b: &Frame) -> Vec<ContactPoint> {
        self.find(a, b, 0.0).iter().filter(|p| p.gap < 0.0).copied().collect()
    }
}

pub fn collider(name: &str, body: usize, shape: Shape) -> Collider {
    Collider { name: name.to_string(), body, pose_bs: Pose::identity(), shape }
}

/// Numbers between 0 and 1 in a row that repeats (a multiplicative congruence).
pub struct Dice(pub u64);

impl Dice {
    pub fn roll(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.roll()
    }

    /// Any turn, and a place within a cube of half this edge.
    pub fn frame(&mut self, half: f64) -> Frame {
        let mut v = |h: f64| Vec3::new(self.between(-h, h), self.between(-h, h), self.between(-h, h));
        let turn = v(3.0);
        let p = v(half);
        turned(turn, p.x, p.y, p.z)
    }
}
