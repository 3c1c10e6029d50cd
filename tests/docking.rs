//! Docking from the standard's box of contact conditions: its corners, draws inside it, and what lies outside.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod support;

use softdock::campaign::{Keep, Plan, Row, make};
use softdock::scenario;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use support::{files, load, run};

/// Makes runs of a campaign on all cores, in the order of their index.
fn rows(plan: &Plan, runs: &[u64]) -> Vec<Row> {
    let (next, rows) = (AtomicU64::new(0), Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some(run) = runs.get(next.fetch_add(1, Ordering::Relaxed) as usize) {
                    let row = make(plan, *run, Keep::Nothing).row;
                    rows.lock().unwrap().push(row);
                }
            });
        }
    });
    let mut rows = rows.into_inner().unwrap();
    rows.sort_by_key(|row| row.run);
    rows
}

fn number(row: &Row, metric: &str) -> Option<f64> {
    row.metrics.get(metric).and_then(serde_json::Value::as_f64)
}

/// Prints verdict, peak force, impulse and settling time, and gives the share that captured.
fn tell(name: &str, rows: &[Row]) -> f64 {
    let range = |metric: &str| {
        let values: Vec<f64> = rows.iter().filter_map(|row| number(row, metric)).collect();
        let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
        format!("{metric} {low:.3} … {high:.3}")
    };
    let captured = rows.iter().filter(|row| row.outcome == "captured").count();
    let figures = ["peak_contact_force_n", "contact_impulse_n_s", "capture_time_s", "rest_time_s"].map(range);
    println!("{name}: captured {captured} of {}; {}", rows.len(), figures.join("; "));
    for row in rows.iter().filter(|row| row.outcome != "captured").take(5) {
        println!("  run {}: {}: {}", row.run, row.outcome, row.reason);
    }
    captured as f64 / rows.len() as f64
}

fn plan(name: &str, variant: Option<&str>) -> Plan {
    Plan::new(load(name, &[]), variant, None).unwrap()
}

/// Momentum is kept and nothing diverges, wherever in the box and however it ends.
fn check_physics(rows: &[Row]) {
    for row in rows {
        assert!(!row.has_failed(), "run {}: {}", row.run, row.reason);
        for metric in ["momentum_drift_linear", "momentum_drift_angular"] {
            assert!(number(row, metric).unwrap() < 1e-9, "run {}: {metric}", row.run);
        }
    }
}

#[test]
fn probe_and_drogue_capture_in_the_corners_of_the_box_and_inside() {
    // Every fifth: 5 and 2048 have no common factor, so that every sign and direction comes with every other. All of them:
    // `softdock campaign scenarios/probe-drogue.toml --variant corners`.
    let corners: Vec<u64> = (0..2048).step_by(5).collect();
    let corners = rows(&plan("probe-drogue", Some("corners")), &corners);
    let inside = rows(&plan("probe-drogue", None), &(0..50).collect::<Vec<_>>());
    check_physics(&corners);
    check_physics(&inside);
    assert!(tell("probe-drogue, corners", &corners) > 0.8);
    assert!(tell("probe-drogue, inside", &inside) >= 0.9);
}

#[test]
fn the_ring_captures_in_the_corners_of_the_box_and_inside() {
    let corners: Vec<u64> = (0..2048).step_by(83).collect();
    let corners = rows(&plan("soft-capture-ring", Some("corners")), &corners);
    let inside = rows(&plan("soft-capture-ring", None), &(0..50).collect::<Vec<_>>());
    check_physics(&corners);
    check_physics(&inside);
    assert!(tell("soft-capture-ring, corners", &corners) > 0.95);
    assert!(tell("soft-capture-ring, inside", &inside) >= 0.98);
}

#[test]
fn peak_force_rises_with_the_closing_speed() {
    for (name, vehicle) in [("probe-drogue", "servicer"), ("soft-capture-ring", "chaser")] {
        let peaks: Vec<f64> = ["0.05", "0.1", "0.4"]
            .iter()
            .map(|closing| {
                let set = format!("vehicle.{vehicle}.approach.closing_m_per_s={closing}");
                let (_, outcome) = run(&load(name, &[&set, "duration_s=4.0"]));
                outcome.metric("peak_contact_force_n").unwrap().as_f64().unwrap()
            })
            .collect();
        assert!(peaks.windows(2).all(|pair| pair[0] < pair[1]), "{name}: {peaks:?} N");
    }
}

#[test]
fn every_mutation_ends_otherwise() {
    let mut count = 0;
    for file in files("scenarios", "toml") {
        let spec = scenario::load(&file, &[]).unwrap_or_else(|e| panic!("{e}"));
        for mutation in &spec.mutations {
            let changed = scenario::load(&file, &mutation.set).unwrap_or_else(|e| panic!("{e}"));
            let (_, outcome) = run(&changed);
            assert_eq!(outcome.outcome, mutation.outcome, "{}, {}: {}", spec.name, mutation.name, outcome.reason);
            assert_ne!(outcome.outcome, "captured", "{}, {}", spec.name, mutation.name);
            count += 1;
        }
    }
    assert!(count >= 9, "the walk found only {count} mutations");
}

#[test]
fn a_start_at_contact_has_the_conditions_that_its_file_states() {
    let spec = load("probe-drogue", &["duration_s=0.2"]);
    let approach = spec.vehicles[1].approach.clone().unwrap();
    let (_, outcome) = run(&spec);
    let metric = |name: &str| outcome.metric(name).unwrap().as_f64().unwrap();
    assert!(metric("first_contact_s") <= 2e-3, "not at contact");
    // One step of motion at 0.1 m/s and 0.2 deg/s, and the first touch of it.
    assert!((metric("contact_closing_m_per_s") - approach.closing_m_per_s).abs() < 2e-3);
    let lateral = approach.lateral_m[0].hypot(approach.lateral_m[1]);
    assert!((metric("contact_lateral_m") - lateral).abs() < 1e-4);
    let tilt = approach.tilt_deg[0].hypot(approach.tilt_deg[1]);
    assert!((metric("contact_tilt_deg") - tilt).abs() < 1e-2, "{} {tilt}", metric("contact_tilt_deg"));
    assert!((metric("contact_roll_deg") - approach.roll_deg).abs() < 1e-2);
}
