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

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use softdock::record::{Meta, Recorder, RecorderPlan};
use softdock::scenario::outcome::Judge;
use softdock::scenario::{self, Mission};
use softdock::sim::{Observer, State, World};
use std::path::Path;

/// As scenario files name them.
const INTEGRATORS: [&str; 4] = ["implicit-euler", "implicit-midpoint", "semi-implicit-euler", "rk4"];

/// Steps of one iteration.
const BLOCK: usize = 1_000;

/// Time at which the fingers are closed and the first vibrations gone, s.
const SETTLED: f64 = 2.0;

fn main() {
    divan::main();
}

#[divan::bench(args = INTEGRATORS, sample_count = 20, sample_size = 1)]
fn grasp(bencher: Bencher<'_, '_>, integrator: &str) {
    let step_s = if integrator.starts_with("implicit") { "1e-3" } else { "1e-4" };
    bench_block(
        bencher,
        mission("peer-grasp", &[("integrator.kind", integrator), ("integrator.step_s", step_s)]),
        SETTLED,
    );
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
    let steps = (start / mission.scenario.integrator.step_s).round() as u64;
    mission.world.run(steps, &*mission.controller, &mut []).expect("the world holds until the blocks begin");
    let snapshot = mission.world.state().clone();
    bencher.counter(ItemsCount::new(BLOCK)).with_inputs(|| fork(&mission, &snapshot)).bench_local_refs(|world| {
        for _ in 0..BLOCK {
            world.control(&*mission.controller);
            world.advance().expect("the world holds through the block");
        }
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
    bencher.counter(ItemsCount::new(steps)).with_inputs(|| mission(name, &[])).bench_local_values(|mut mission| {
        let mut judge = Judge::new(&mission);
        let mut recorder = Recorder::new(&mission.world, plan(&mission), None);
        let observers: &mut [&mut dyn Observer] = &mut [&mut judge, &mut recorder];
        let ended = mission.world.run(mission.steps, &*mission.controller, observers);
        let samples = recorder.log.len();
        (judge.conclude(&mission.world, &ended), samples)
    });
}

/// Everything, at the scenario's logging rate.
fn plan(mission: &Mission) -> RecorderPlan {
    RecorderPlan {
        meta: Meta::default(),
        every: mission.steps_per_sample,
        probes: Vec::new(),
        keep: Box::new(|_| true),
        links: mission.robots.iter().map(|r| r.links.len()).collect(),
    }
}

/// A scenario of the catalogue with overrides.
fn mission(name: &str, overrides: &[(&str, &str)]) -> Mission {
    let overrides: Vec<String> = overrides.iter().map(|(path, value)| format!("{path}={value}")).collect();
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios").join(format!("{name}.toml"));
    let spec = scenario::load(&file, &overrides).unwrap_or_else(|e| panic!("{e}"));
    scenario::build(&spec).unwrap_or_else(|e| panic!("{e}"))
}
