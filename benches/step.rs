//! How fast is a step of the grasp?
//!
//! ```text
//! cargo bench --no-default-features --bench step
//! ```
//!
//! Each bench runs whole simulations of the catalogue's scenarios, one thread:
//!
//! | bench | one iteration | what it holds |
//! | --- | --- | --- |
//! | `grasp` | 1,000 steps of peer-grasp, fingers closed, 8 points sticking | control and step, nothing else |
//! | `grasp_run` | the 10 s of peer-grasp | judge and recorder attached (all channels, 100 Hz, in memory) |
//! | `free_arm` | 1,000 steps of peer-free-arm, 13 freedoms, no contact | control and step |
//! | `capture_run` | all of tumbling-capture | judge and recorder attached |
//!
//! Where an iteration is 1,000 steps, its milliseconds are the microseconds of one step. Items are steps: at the step of
//! 1 ms, `Kitem/s` is the real-time factor. The explicit integrators do not hold the pads' stiffness at 1 ms (h ω ≈ 3.6
//! for a finger of 0.3 kg); they run at 0.1 ms, where a step costs the same.
//!
//! Other simulators, same models, `grasp` (their detection included, no recorder), µs per step of 1 ms on two virtual
//! cores of a Xeon (family 6, model 207): MuJoCo 4.0.0 12.7 to 14.1 (noslip 17.6 to 20.7), Drake 1.51.1 53 (TAMSI) to 590
//! (SAP, hydroelastic), PyBullet 3.2.7 91, rapier3d-f64 0.36.1 100 (4 iterations) to 455 (20). `free_arm`: MuJoCo 1.6 for
//! Euler; PyBullet 5.1, Drake 10.1 per evaluation, rapier 56. The clock of a virtual machine: compare ratios.

mod fixtures;

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use fixtures::missions::{SETTLED, advance, mission, run_observed, run_to};
use softdock::scenario::Mission;
use softdock::sim::{State, World};

/// As scenario files name them.
const INTEGRATORS: [&str; 4] = ["implicit-euler", "implicit-midpoint", "semi-implicit-euler", "rk4"];

/// Steps of one iteration.
const BLOCK: usize = 1_000;

fn main() {
    divan::main();
}

#[divan::bench(args = INTEGRATORS, sample_count = 20, sample_size = 1)]
fn grasp(bencher: Bencher<'_, '_>, integrator: &str) {
    let step_s = if integrator.starts_with("implicit") { "1e-3" } else { "1e-4" };
    let overrides = [("integrator.kind", integrator), ("integrator.step_s", step_s)];
    bench_block(bencher, mission("peer-grasp", &overrides), SETTLED);
}

#[divan::bench(args = INTEGRATORS, sample_count = 20, sample_size = 1)]
fn free_arm(bencher: Bencher<'_, '_>, integrator: &str) {
    bench_block(bencher, mission("peer-free-arm", &[("integrator.kind", integrator)]), 0.0);
}

#[divan::bench(sample_count = 5, sample_size = 1)]
fn grasp_run(bencher: Bencher<'_, '_>) {
    bench_run(bencher, "peer-grasp");
}

#[divan::bench(sample_count = 3, sample_size = 1)]
fn capture_run(bencher: Bencher<'_, '_>) {
    bench_run(bencher, "tumbling-capture");
}

/// Blocks of steps, each from the same state at `start` (s).
fn bench_block(bencher: Bencher<'_, '_>, mut mission: Mission, start: f64) {
    run_to(&mut mission, start);
    let snapshot = mission.world.state().clone();
    bencher.counter(ItemsCount::new(BLOCK)).with_inputs(|| fork(&mission, &snapshot)).bench_local_refs(|world| {
        advance(world, &*mission.controller, BLOCK);
        black_box(world.state().time)
    });
}

/// Another world of the mission, at a snapshot.
fn fork(mission: &Mission, snapshot: &State) -> World {
    World::new(mission.world.model().clone(), snapshot.clone())
}

/// A scenario from its start to its end, as `softdock run` runs it, less its files.
fn bench_run(bencher: Bencher<'_, '_>, name: &str) {
    let steps = mission(name, &[]).steps as usize;
    bencher.counter(ItemsCount::new(steps)).with_inputs(|| mission(name, &[])).bench_local_values(run_observed);
}
