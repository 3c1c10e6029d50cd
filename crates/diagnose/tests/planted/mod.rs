//! What tests that plant effects share.

#![allow(dead_code)] // Each test takes what it needs.

use diagnose::diagnosis::{Diagnosis, Verdict};
use record::{RecordedRun, RecordingSet, Role, Series};
use scenario::spec::{Effect, ParamValue};
use std::path::{Path, PathBuf};

/// The repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// An `[[effect]]` entry.
pub fn effect(name: &str, place: &str, params: &[(&str, ParamValue)]) -> Effect {
    let params = params.iter().map(|(k, v)| ((*k).to_owned(), v.clone())).collect();
    Effect { name: name.to_owned(), place: place.to_owned(), params }
}

/// A number.
pub fn number(x: f64) -> ParamValue {
    ParamValue::Number(x)
}

/// Right name and place, and predictions of the unseen run that noise alone limits.
pub fn check(diagnosis: &Diagnosis, planted: &Effect) {
    let found: Vec<(&str, &str)> = diagnosis.effects.iter().map(|e| (e.name.as_str(), e.place.as_str())).collect();
    assert_eq!(diagnosis.verdict, Verdict::Explained, "{planted:?}: {found:?} {:?}", diagnosis.error);
    assert_eq!(found, [(planted.name.as_str(), planted.place.as_str())], "{:?}", diagnosis.effects);
    // What is told stands for nothing else that is told.
    let is_told = |name: &str, place: &str| found.contains(&(name, place));
    assert!(
        !diagnosis.effects.iter().flat_map(|e| &e.rivals).any(|r| is_told(&r.name, &r.place)),
        "{:?}",
        diagnosis.effects
    );
    let holdout = diagnosis.error.holdout.unwrap();
    // Nothing restores a hinge: where it sticks and slips, free runs go apart under the true model too, and windows judge.
    let after = holdout.after.min(diagnosis.error.windowed.after);
    assert!(after < 1.06 && holdout.before > 1.15 * holdout.after, "{planted:?}: {:?}", diagnosis.error);
}

/// The number that was planted comes back within a tenth.
pub fn check_number(diagnosis: &Diagnosis, key: &str, planted: f64) {
    let found = diagnosis.effects[0].params[key].numbers().unwrap()[0];
    assert!((found / planted - 1.0).abs() < 0.1, "{key}: {found}, planted {planted}");
}

/// What drives the bar and when it is read; nothing measured yet.
pub fn swings() -> RecordingSet {
    let run = |k: u32| {
        let phase = 1.7 * f64::from(k);
        let ticks: Vec<f64> = (0..600).map(|i| f64::from(i) * 0.01).collect();
        let torque = |t: &f64| {
            let parts = [(1.1, 2.3, 0.0), (0.8, 5.9, phase), (0.5, 13.0, 2.0 * phase)];
            let sum: f64 = parts.iter().map(|(a, w, p)| a * (w * t + p).sin()).sum();
            (1e4 * sum).round() / 1e4
        };
        let efforts = ticks.iter().map(torque).collect();
        let times: Vec<f64> = (0..=1200).map(|i| f64::from(i) * 0.005).collect();
        let still = vec![0.0; times.len()];
        let series = vec![
            Series::new("joint.hinge.effort_command", ticks, efforts),
            Series::with_quantum("joint.hinge.position", times.clone(), still.clone(), 1e-6),
            Series::with_quantum("joint.hinge.velocity", times, still, 1e-5),
        ];
        let role = if k < 2 { Role::Fit } else { Role::Holdout };
        RecordedRun { file: format!("run-{k}.csv"), role, note: String::new(), series }
    };
    let noise = [("joint.hinge.position".to_owned(), 2e-5), ("joint.hinge.velocity".to_owned(), 1e-3)];
    RecordingSet {
        rig: "swing".to_owned(),
        title: "planted".to_owned(),
        noise: noise.into(),
        runs: (0..3).map(run).collect(),
        ..RecordingSet::default()
    }
}
