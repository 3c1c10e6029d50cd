//! Recordings as laboratories make them: σ that is wrong or not stated, readings that stand alone, a sensor that stands still, a rig with
//! another name. The physics in them is the same, so are verdict, effect and place.
#![allow(clippy::unwrap_used)]

mod planted;

use diagnose::diagnosis::{Diagnosis, Verdict};
use planted::root;
use record::{RecordingSet, Series};
use scenario::spec::Effect;

fn recording() -> RecordingSet {
    RecordingSet::load(&root().join("tests/recordings/tumble-inertia")).unwrap()
}

fn diagnosed(effects: &[Effect], set: &RecordingSet) -> Diagnosis {
    let mut scenario = scenario::load(&root().join("scenarios/rigs/tumbler.toml"), &[]).unwrap();
    scenario.effects = effects.to_vec();
    diagnose::run::diagnose(scenario, set, &()).unwrap().0
}

/// The inertia that the recording conceals, for a model that is right.
fn truth() -> Vec<Effect> {
    diagnosed(&[], &recording())
        .effects
        .into_iter()
        .map(|found| Effect { name: found.name, place: found.place, params: found.params })
        .collect()
}

/// Changes the values of some channels of every run.
fn changed(mut set: RecordingSet, wanted: &str, change: impl Fn(usize, &mut f64)) -> RecordingSet {
    for run in &mut set.runs {
        for series in run.series.iter_mut().filter(|s| s.channel.starts_with(wanted)) {
            let mut values = series.values.clone();
            values.iter_mut().enumerate().for_each(|(i, v)| change(i, v));
            *series = Series::with_quantum(&series.channel, series.times.clone(), values, series.quantum());
        }
    }
    set
}

fn with_sigma(factor: f64) -> RecordingSet {
    let mut set = recording();
    set.noise.values_mut().for_each(|sigma| *sigma *= factor);
    set
}

const GYRO: &str = "body.target.angular_velocity";
/// Of the gyro, rad/s: the recording's own figure.
const SIGMA: f64 = 2e-4;

/// The faults, by name.
fn faults() -> Vec<(&'static str, RecordingSet)> {
    let alone = |i: usize, v: &mut f64| *v += if i % 97 == 40 { 20.0 * SIGMA } else { 0.0 };
    let still = changed(recording(), "body.target.angular_velocity.y", |i, v| *v = if i > 30 { 0.0125 } else { *v });
    let silent = RecordingSet { noise: Default::default(), ..recording() };
    vec![
        ("σ stated 0.7 times", with_sigma(0.7)),
        ("σ stated 0.95 times", with_sigma(0.95)),
        ("σ stated 1.5 times", with_sigma(1.5)),
        ("no σ stated", silent),
        ("lone readings 20 σ off", changed(recording(), GYRO, alone)),
        ("one rate stands still", still),
        ("another rig's name", RecordingSet { rig: "another".into(), ..recording() }),
    ]
}

#[test]
fn what_is_concealed_is_found_whatever_the_laboratory_did() {
    for (fault, set) in faults() {
        let diagnosis = diagnosed(&[], &set);
        let found: Vec<(&str, &str)> = diagnosis.effects.iter().map(|e| (e.name.as_str(), e.place.as_str())).collect();
        assert_eq!(diagnosis.verdict, Verdict::Explained, "{fault}: {:?}", diagnosis.error);
        assert_eq!(found, [("body-inertia", "body:target")], "{fault}");
        // In windows of 10 s the wrong inertia is half as large as the noise: 3 % of that, where it was estimated, are a tenth of the share.
        let explained = diagnosis.explained_share.unwrap();
        assert!(explained.left_out && explained.share > 0.85 && explained.interval[1] > 0.9, "{fault}: {explained:?}");
    }
}

#[test]
fn a_right_model_stays_right_whatever_the_laboratory_did() {
    let truth = truth();
    for (fault, set) in faults() {
        let diagnosis = diagnosed(&truth, &set);
        assert_eq!(diagnosis.verdict, Verdict::NoMismatch, "{fault}: {:?} {:?}", diagnosis.effects, diagnosis.error);
        assert_eq!(diagnosis.explained_share, None, "{fault}");
    }
}

#[test]
fn what_was_left_out_and_what_noise_was_taken_is_said() {
    let said = |fault: &str| {
        let (_, set) = faults().into_iter().find(|f| f.0 == fault).unwrap();
        diagnosed(&[], &set).remarks.join("\n")
    };
    assert!(said("lone readings 20 σ off").contains("that stand alone"), "{}", said("lone readings 20 σ off"));
    assert!(
        said("one rate stands still").contains("body.target.angular_velocity: left out"),
        "{}",
        said("one rate stands still")
    );
    assert!(said("σ stated 0.7 times").contains("their noise is 1.4"), "{}", said("σ stated 0.7 times"));
}
