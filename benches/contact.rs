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

mod fixtures;

use divan::Bencher;
use fixtures::missions::mission;
use fixtures::pairs::{self, PAIRS, Query, collider};
use softdock::contact::{Scene, Shape};
use softdock::spatial::{Pose, Vec3};

fn main() {
    divan::main();
}

#[divan::bench(args = PAIRS)]
fn pair(bencher: Bencher<'_, '_>, name: &str) {
    let (mut query, mut call) = (pairs::pair(name), 0);
    bencher.bench_local(move || {
        call += 1;
        query.detect_drifting(call)
    });
}

#[divan::bench(args = ["peer-grasp", "tumbling-capture"])]
fn scenario(bencher: Bencher<'_, '_>, name: &str) {
    let mut mission = mission(name, &[]);
    mission.world.run(mission.steps, &*mission.controller, &mut []).expect("the catalogue's scenarios hold");
    let mut query = pairs::grasp(&mission.world);
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
