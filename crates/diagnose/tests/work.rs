//! How much a diagnosis computes, counted: seconds that it simulates for each second that was recorded. The count does not depend on the machine.
#![allow(clippy::unwrap_used)]

mod planted;

use planted::root;
use record::RecordingSet;

/// Of tests/recordings/tumble-inertia, and how much more is noticed.
const SIMULATED: f64 = 528.0;
const MORE: f64 = 1.05;

#[test]
fn a_diagnosis_simulates_no_more_than_it_did() {
    let set = RecordingSet::load(&root().join("tests/recordings/tumble-inertia")).unwrap();
    let scenario = scenario::load(&root().join("scenarios/rigs/tumbler.toml"), &[]).unwrap();
    let (_, evidence) = diagnose::diagnose(scenario, &set, &()).unwrap();
    let ends = set.runs.iter().filter_map(|r| r.series.iter().filter_map(|s| s.times.last().copied()).reduce(f64::max));
    let simulated = evidence.timings.iter().map(|stage| stage.simulated_s).sum::<f64>() / ends.sum::<f64>();
    assert!(
        simulated < MORE * SIMULATED,
        "{simulated:.1} seconds simulated for each that was recorded, {SIMULATED} before"
    );
}
