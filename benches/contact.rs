//! What does detection cost?
//!
//! ```text
//! cargo bench --no-default-features --bench contact
//! ```
//!
//! One iteration is one call of the detector: broad phase, manifolds, identities, from nothing (no call remembers the
//! last one). The pairs drift by 10 µm from call to call, up to 70 µm and back.
//!
//! | bench | scene |
//! | --- | --- |
//! | `pair` | one pair of shapes that touch over a face |
//! | `scenario` | what one step asks: peer-grasp and tumbling-capture at their ends, fingers closed |
//! | `grid` | 100 boxes on a 10 × 10 grid, all 4,950 pairs looked at, neighbours in touch (180 pairs) or 10 mm apart |
//!
//! Other libraries, the same pairs, ns on two virtual cores of a Xeon (family 6, model 207); only the first column starts
//! from nothing and gives all points:
//!
//! | | parry3d-f64 0.31.1 from scratch | parry, last manifold reused | MuJoCo 4.0.0 | coal 3.0.3 with patch |
//! | --- | --- | --- | --- | --- |
//! | box, box | 410 | 51 | 340 | 1750 |
//! | capsule, box | 485 | 41 | 345 | 554 |
//! | hull, hull of 64 vertices | 6738 | 58 | 2530 | 2570 |
//! | mesh of 2,048 triangles, box of 0.1 m | 14006 | 1714 | – | 40382 |
//! | mesh of 2,048 triangles, box of 0.02 m | 3246 | 659 | – | – |

use divan::{Bencher, black_box};
use softdock::contact::{Collider, ContactPoint, Detector, Scene, Shape};
use softdock::scenario::{self, Mission};
use softdock::sim::World;
use softdock::spatial::{Frame, Pose, Vec3};
use std::path::Path;

/// How far a body may move within the step, m: 10 mm/s at 1 ms, twice.
const REACH: f64 = 2e-5;

fn main() {
    divan::main();
}

#[divan::bench(args = ["box-box", "box-plane", "capsule-box", "hull-hull", "mesh-box", "mesh-small box"])]
fn pair(bencher: Bencher<'_, '_>, name: &str) {
    let cuboid = |x, y, z| Shape::Cuboid { half_extents: Vec3::new(x, y, z) };
    let capsule = Shape::Capsule { radius: 0.03, half_length: 0.05 };
    // B's height over A: 0.1 mm deep in the flat shapes, some millimetres in the knobbly hulls.
    let (a, b, height, pose_b) = match name {
        "box-box" => (cuboid(0.1, 0.1, 0.1), cuboid(0.05, 0.04, 0.03), 0.1299, Pose::identity()),
        "box-plane" => (Shape::HalfSpace, cuboid(0.05, 0.04, 0.03), 0.0299, Pose::identity()),
        "capsule-box" => (cuboid(0.1, 0.1, 0.1), capsule, 0.1299, lying()),
        "hull-hull" => (hull(), hull(), 0.19, Pose::identity()),
        "mesh-box" => (waved_mesh(), cuboid(0.05, 0.04, 0.03), 0.0299, Pose::identity()),
        _ => (waved_mesh(), cuboid(0.01, 0.01, 0.03), 0.0299, Pose::identity()),
    };
    let colliders = vec![collider(0, Pose::identity(), a), collider(1, pose_b, b)];
    let mut query = Query::new(Scene::new(colliders, vec![[0, 1]]).unwrap_or_else(|e| panic!("{e}")));
    query.frames[1].pos.z = height;
    query.detect();
    assert!(query.points.iter().any(|p| p.gap < 0.0), "{name}: the pair touches");
    let mut call = 0;
    bencher.bench_local(move || {
        call += 1;
        query.frames[1].pos.x = 1e-5 * f64::from(call & 7);
        query.detect()
    });
}

#[divan::bench(args = ["peer-grasp", "tumbling-capture"])]
fn scenario(bencher: Bencher<'_, '_>, name: &str) {
    let mut mission = mission(name);
    mission.world.run(mission.steps, &*mission.controller, &mut []).expect("the catalogue's scenarios hold");
    let mut query = Query::of_world(&mission.world);
    query.detect();
    assert!(query.points.iter().any(|p| p.gap < 0.0), "{name}: the fingers hold the bar");
    bencher.bench_local(move || query.detect());
}

#[divan::bench(args = ["in touch", "10 mm apart"])]
fn grid(bencher: Bencher<'_, '_>, name: &str) {
    let distance = if name == "in touch" { 0.1999 } else { 0.21 };
    let shape = Shape::Cuboid { half_extents: Vec3::repeat(0.1) };
    let colliders = (0..100).map(|i| collider(i, Pose::identity(), shape.clone())).collect();
    let pairs = (0..100).flat_map(|i| (i + 1..100).map(move |j| [i, j])).collect();
    let mut query = Query::new(Scene::new(colliders, pairs).unwrap_or_else(|e| panic!("{e}")));
    for (i, frame) in query.frames.iter_mut().enumerate() {
        frame.pos = distance * Vec3::new((i % 10) as f64, (i / 10) as f64, 0.0);
    }
    bencher.bench_local(move || query.detect());
}

/// A scene, its bodies' places, and room for the answer.
struct Query {
    scene: Scene,
    detector: Detector,
    frames: Vec<Frame>,
    reach: Vec<f64>,
    points: Vec<ContactPoint>,
}

impl Query {
    /// One body per collider, all at the origin.
    fn new(scene: Scene) -> Self {
        let n = scene.colliders().len();
        let detector = Detector::new(&scene);
        Self { scene, detector, frames: vec![Frame::identity(); n], reach: vec![REACH; n], points: Vec::new() }
    }

    /// What the next step of the world asks.
    fn of_world(world: &World) -> Self {
        let n = world.model().world_body() + 1;
        let frames = (0..n).map(|body| world.frame(body)).collect();
        Self { frames, reach: vec![REACH; n], ..Self::new(world.model().scene.clone()) }
    }

    /// The number of points found.
    fn detect(&mut self) -> usize {
        self.detector.detect(&self.scene, black_box(&self.frames), &self.reach, &mut self.points);
        black_box(&self.points).len()
    }
}

fn collider(body: usize, pose_bs: Pose, shape: Shape) -> Collider {
    Collider { name: format!("shape {body}"), body, pose_bs, shape }
}

/// A turn that lays z along x.
fn lying() -> Pose {
    Pose::rotation(Vec3::y() * std::f64::consts::FRAC_PI_2)
}

/// 64 vertices on a ball of 0.1 m, in a golden spiral.
fn hull() -> Shape {
    let vertex = |i: usize| {
        let z = 1.0 - 2.0 * (i as f64 + 0.5) / 64.0;
        let (r, angle) = ((1.0 - z * z).sqrt(), 2.399_963_229_728_653 * i as f64);
        0.1 * Vec3::new(r * angle.cos(), r * angle.sin(), z)
    };
    Shape::ConvexHull { vertices: (0..64).map(vertex).collect() }
}

/// A patch of 1 m, 32 × 32 cells, gently waved by 2 mm.
fn waved_mesh() -> Shape {
    const N: u32 = 32;
    let at = |i: u32, j: u32| {
        let (x, y) = (f64::from(i) / f64::from(N) - 0.5, f64::from(j) / f64::from(N) - 0.5);
        Vec3::new(x, y, 0.002 * (9.0 * x).sin() * (7.0 * y).cos())
    };
    let vertices = (0..=N).flat_map(|i| (0..=N).map(move |j| at(i, j))).collect();
    let cell = |i: u32, j: u32| {
        let (a, b) = (i * (N + 1) + j, (i + 1) * (N + 1) + j);
        [[a, b, b + 1], [a, b + 1, a + 1]]
    };
    let triangles = (0..N).flat_map(|i| (0..N).flat_map(move |j| cell(i, j))).collect();
    Shape::TriMesh { vertices, triangles }
}

/// A scenario of the catalogue.
fn mission(name: &str) -> Mission {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios").join(format!("{name}.toml"));
    let spec = scenario::load(&file, &[]).unwrap_or_else(|e| panic!("{e}"));
    scenario::build(&spec).unwrap_or_else(|e| panic!("{e}"))
}
