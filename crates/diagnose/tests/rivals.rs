//! What data cannot tell apart is told as rivals, and what they can is not.
//!
//! A cart on a level rail carries a wheel that turns about the rail's own direction. What is heavy in one is heavy in the other; where nothing but a known
//! force pushes, a weaker one is a heavier cart; a tilt is an offset of the rail's drive; and where only a place is read, its
//! delay is the command's.
#![allow(clippy::unwrap_used)]

mod planted;

use diagnose::diagnosis::{Diagnosis, Found, Verdict};
use diagnose::plant::Built;
use diagnose::start::Start;
use diagnose::synthesise;
use diagnose::tape::Tape;
use planted::{effect, number, root};
use record::{RecordedRun, RecordingSet, Role, Series};
use scenario::spec::Effect;

/// What drives the cart and its wheel, and which of their channels are read every 5 ms.
fn drives(read: &[&str]) -> RecordingSet {
    let run = |k: u32| {
        let phase = f64::from(k);
        let ticks: Vec<f64> = (0..600).map(|i| f64::from(i) * 0.01).collect();
        let sum = |parts: [(f64, f64, f64); 3]| -> Vec<f64> {
            let at = |t: &f64| parts.iter().map(|(a, w, p)| a * (w * t + p).sin()).sum::<f64>();
            ticks.iter().map(|t| (1e4 * at(t)).round() / 1e4).collect()
        };
        let push = sum([(8.0, 2.3, 0.0), (6.0, 5.9, 1.7 * phase), (4.0, 13.0, 3.4 * phase)]);
        let turn = sum([(0.5, 1.9, phase), (0.4, 6.7, 0.0), (0.3, 11.0, 2.0 * phase)]);
        let times: Vec<f64> = (0..=1200).map(|i| f64::from(i) * 0.005).collect();
        let mut series = vec![
            Series::new("joint.slide.effort_command", ticks.clone(), push),
            Series::new("joint.spin.effort_command", ticks.clone(), turn),
        ];
        let quantum = |channel: &str| if channel.ends_with("position") { 1e-6 } else { 1e-5 };
        let still = vec![0.0; times.len()];
        series.extend(read.iter().map(|c| Series::with_quantum(*c, times.clone(), still.clone(), quantum(c))));
        let role = if k < 2 { Role::Fit } else { Role::Holdout };
        RecordedRun { file: format!("run-{k}.csv"), role, note: String::new(), series }
    };
    let noise = |c: &&str| ((*c).to_owned(), if c.ends_with("position") { 2e-5 } else { 1e-3 });
    RecordingSet {
        rig: "cart".to_owned(),
        title: "planted".to_owned(),
        noise: read.iter().map(noise).collect(),
        runs: (0..3).map(run).collect(),
        ..RecordingSet::default()
    }
}

const ALL: [&str; 4] = ["joint.slide.position", "joint.slide.velocity", "joint.spin.position", "joint.spin.velocity"];

/// What is told of the cart with one effect planted.
fn told(planted: &Effect, read: &[&str]) -> Diagnosis {
    let scenario = scenario::load(&root().join("crates/diagnose/tests/rigs/cart.toml"), &[]).unwrap();
    let mut with = scenario.clone();
    with.effects.push(planted.clone());
    let at_rest = |built: &Built, _: &Tape| Start::nominal(built);
    let set = synthesise(with, &drives(read), &at_rest, 3).unwrap();
    diagnose::diagnose(scenario, &set, &()).unwrap().0
}

/// The one effect that is told.
fn only(diagnosis: &Diagnosis) -> &Found {
    assert_eq!(diagnosis.verdict, Verdict::Explained, "{:?}", diagnosis.effects);
    assert_eq!(diagnosis.effects.len(), 1, "{:?}", diagnosis.effects);
    &diagnosis.effects[0]
}

/// Both of a pair are told, one as what was found and the other as its rival, whichever was planted.
fn check_rivals(planted: &Effect, other: (&str, &str), read: &[&str]) {
    let diagnosis = told(planted, read);
    let found = only(&diagnosis);
    let own = [(found.name.as_str(), found.place.as_str())];
    let rivals = found.rivals.iter().map(|r| (r.name.as_str(), r.place.as_str()));
    let all: Vec<(&str, &str)> = own.into_iter().chain(rivals).collect();
    for one in [(planted.name.as_str(), planted.place.as_str()), other] {
        assert!(all.contains(&one), "{one:?} is not among {all:?}");
    }
}

#[test]
fn one_effect_at_two_places_that_move_as_one() {
    check_rivals(&effect("body-mass", "body:cart", &[("mass", number(6.9))]), ("body-mass", "body:wheel"), &ALL);
}

#[test]
fn synonyms_of_a_driven_joint() {
    let [slide, spin] = ["joint:slide", "joint:spin"];
    let places = ["joint.slide.position", "joint.spin.position"];
    let weak = effect("actuator-gain", slide, &[("gain", number(0.9))]);
    check_rivals(&weak, ("body-mass", "body:cart"), &ALL);
    check_rivals(&effect("joint-armature", spin, &[("i_rotor", number(0.006))]), ("actuator-gain", spin), &ALL);
    check_rivals(&effect("joint-offset", slide, &[("effort", number(0.4))]), ("tilt", "world"), &ALL);
    check_rivals(&effect("body-mass", "body:cart", &[("mass", number(6.5))]), ("joint-armature", slide), &ALL);
    let late = effect("actuator-delay", slide, &[("delay", number(0.008))]);
    check_rivals(&late, ("sensor-delay", "sensor:joint.slide.position"), &places);
}

/// A command that is held for longer than it is late, where a lag does nearly the same.
#[test]
fn what_the_data_tell_apart_has_no_rival() {
    let [slide, spin] = ["joint:slide", "joint:spin"];
    let cases = [
        effect("joint-viscous-friction", slide, &[("b", number(1.5))]),
        effect("joint-coulomb-friction", slide, &[("c", number(1.0))]),
        effect("actuator-delay", spin, &[("delay", number(0.008))]),
        effect("actuator-lag", slide, &[("time_constant", number(0.03))]),
    ];
    for planted in cases {
        let diagnosis = told(&planted, &ALL);
        let found = only(&diagnosis);
        assert_eq!((&found.name, &found.place), (&planted.name, &planted.place));
        assert!(found.rivals.is_empty(), "{:?}", found.rivals);
    }
}
