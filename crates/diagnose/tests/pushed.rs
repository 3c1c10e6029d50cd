//! What a body that is pushed shows and a tumble does not: how heavy what sloshes in it is, what holds on to the link of an arm, and where a graded thruster
//! saturates; and commands in newtons are told from shares.
#![allow(clippy::unwrap_used)]

mod planted;

use diagnose::diagnosis::{Diagnosis, Verdict};
use diagnose::plant::Built;
use diagnose::start::Start;
use diagnose::synthesise;
use diagnose::tape::Tape;
use planted::{check, check_number, effect, number, root};
use record::{RecordedRun, RecordingSet, Role, Series};
use scenario::Scenario;
use scenario::spec::{Effect, ParamValue};

const THRUSTERS: [&str; 6] = ["left_ahead", "right_ahead", "left_back", "right_back", "to_left", "to_right"];
const READ: [(&str, f64); 6] = [
    ("body.hull.position.x", 2e-4),
    ("body.hull.position.y", 2e-4),
    ("body.hull.orientation.z", 2e-4),
    ("body.hull.angular_velocity.z", 5e-4),
    ("joint.hinge.position", 2e-4),
    ("joint.hinge.velocity", 1e-3),
];

fn puck() -> Scenario {
    scenario::load(&root().join("crates/diagnose/tests/rigs/puck.toml"), &[]).unwrap()
}

/// What drives the vehicle, as shares of what its thrusters can do, and what of it is read.
fn pushes() -> RecordingSet {
    let run = |k: u32| {
        let ticks: Vec<f64> = (0..120).map(|i| f64::from(i) * 0.1).collect();
        let share = |thruster: usize, t: f64| {
            let (w, p) = (0.9 + 0.37 * thruster as f64, 1.3 * thruster as f64 + 2.1 * f64::from(k));
            (1e4 * (0.9 * (w * t + p).sin()).max(0.0)).round() / 1e4
        };
        let command = |(i, name): (usize, &&str)| {
            let values = ticks.iter().map(|t| share(i, *t)).collect();
            Series::new(format!("actuator.{name}.command"), ticks.clone(), values)
        };
        let times: Vec<f64> = (0..=600).map(|i| f64::from(i) * 0.02).collect();
        let still = |channel: &str| {
            let values = vec![0.0; times.len()];
            Series::with_quantum(channel, times.clone(), values, 1e-6)
        };
        let mut series: Vec<Series> = THRUSTERS.iter().enumerate().map(command).collect();
        series.extend(READ.iter().filter(|c| !c.0.contains("orientation")).map(|c| still(c.0)));
        for part in ["w", "x", "y", "z"] {
            let values = vec![f64::from(u8::from(part == "w")); times.len()];
            let channel = format!("body.hull.orientation.{part}");
            series.push(Series::with_quantum(channel, times.clone(), values, 1e-6));
        }
        let role = if k < 2 { Role::Fit } else { Role::Holdout };
        RecordedRun { file: format!("run-{k}.csv"), role, note: String::new(), series }
    };
    let noise = |(channel, sigma): &(&str, f64)| (channel.rsplit_once('.').unwrap().0.to_owned(), *sigma);
    let joints = READ.iter().filter(|c| c.0.starts_with("joint")).map(|(c, sigma)| ((*c).to_owned(), *sigma));
    RecordingSet {
        rig: "puck".to_owned(),
        title: "planted".to_owned(),
        noise: READ.iter().filter(|c| c.0.starts_with("body")).map(noise).chain(joints).collect(),
        runs: (0..3).map(run).collect(),
        ..RecordingSet::default()
    }
}

/// The recording of a puck with some effects.
fn recorded(planted: &[Effect]) -> RecordingSet {
    let mut with = puck();
    with.effects.extend_from_slice(planted);
    let at_rest = |built: &Built, _: &Tape| Start::nominal(built);
    synthesise(with, &pushes(), &at_rest, 7).unwrap()
}

fn told(planted: &Effect) -> Diagnosis {
    let diagnosis = diagnose::diagnose(puck(), &recorded(std::slice::from_ref(planted)), &()).unwrap().0;
    check(&diagnosis, planted);
    diagnosis
}

#[test]
fn what_sloshes_in_a_pushed_body_shows_its_mass() {
    let slosh = [
        ("mass", number(2.0)),
        ("frequency", number(0.6)),
        ("damping", number(0.03)),
        ("position", ParamValue::Numbers(vec![0.08, 0.12, 0.0])),
    ];
    check_number(&told(&effect("slosh", "body:hull", &slosh)), "mass", 2.0);
}

#[test]
fn what_acts_on_a_link_alone_is_told_there() {
    check_number(&told(&effect("linear-drag", "body:boom", &[("c", number(0.4))])), "c", 0.4);
}

/// A load at the end of a link is one law, not a mass, a rotor and another mass; how high it hangs nothing tells, and nothing is made up.
#[test]
fn a_load_at_the_end_of_a_link_is_one() {
    let at = [-0.45, 0.05, 0.0];
    let diagnosis =
        told(&effect("payload", "link:boom", &[("mass", number(0.1)), ("com", ParamValue::Numbers(at.to_vec()))]));
    check_number(&diagnosis, "mass", 0.1);
    let ParamValue::Numbers(com) = &diagnosis.effects[0].params["com"] else { panic!("{:?}", diagnosis.effects) };
    assert!((com[0] - at[0]).abs() < 0.01 && (com[1] - at[1]).abs() < 0.01 && com[2].abs() < 0.05, "{com:?}");
}

#[test]
fn a_graded_thruster_saturates() {
    let limited = effect("actuator-saturation", "actuator:left_ahead", &[("limit", number(0.7))]);
    check_number(&told(&limited), "limit", 0.7);
}

/// A share is at most one: what is more is a force.
#[test]
fn commands_in_newtons_are_told_from_shares() {
    let mut set = recorded(&[]);
    let commands = set.runs.iter_mut().flat_map(|r| &mut r.series).filter(|s| s.channel.starts_with("actuator."));
    for series in commands {
        let newtons = series.values.iter().map(|share| MAX_FORCE * share).collect();
        *series = Series::new(&series.channel, series.times.to_vec(), newtons);
    }
    let diagnosis = diagnose::diagnose(puck(), &set, &()).unwrap().0;
    assert_eq!(diagnosis.verdict, Verdict::NoMismatch, "{:?}", diagnosis.effects);
}

/// What only runs left out of the fit show is no reason to call the scenario right.
#[test]
fn what_only_a_run_left_out_shows_is_no_agreement() {
    let (mut set, dragged) = (recorded(&[]), recorded(&[effect("linear-drag", "body:hull", &[("c", number(1.5))])]));
    for (run, other) in set.runs.iter_mut().zip(dragged.runs).filter(|(run, _)| run.role == Role::Holdout) {
        *run = other;
    }
    let diagnosis = diagnose::diagnose(puck(), &set, &()).unwrap().0;
    assert_eq!(diagnosis.verdict, Verdict::Unknown);
    let is_said = |remark: &String| remark.contains("left out of the fit alone");
    assert!(diagnosis.remarks.iter().any(is_said), "{:?}", diagnosis.remarks);
}

/// What each thruster of the rig can do, N.
const MAX_FORCE: f64 = 2.0;
