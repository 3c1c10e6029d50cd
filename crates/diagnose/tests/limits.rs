//! Limits of a scenario that its recording passes, and efforts that were measured instead of commanded.
#![allow(clippy::unwrap_used)]

mod planted;

use diagnose::diagnosis::Verdict;
use diagnose::run::diagnose_with;
use diagnose::synthetic::as_recorded;
use diagnose::{Diagnosis, synthesise};
use planted::{effect, number, root, swings};
use record::{RecordingSet, Series};
use scenario::Scenario;
use std::path::Path;

const FRICTION: &str = "joint-viscous-friction";

fn swing(set: &[&str]) -> Scenario {
    let set: Vec<String> = set.iter().map(|s| (*s).to_owned()).collect();
    scenario::load(&root().join("crates/diagnose/tests/rigs/swing.toml"), &set).unwrap()
}

/// The rig with a friction that its scenario lacks.
fn recording() -> RecordingSet {
    let mut rig = swing(&[]);
    rig.effects.push(effect(FRICTION, "joint:hinge", &[("b", number(0.3))]));
    synthesise(rig, &swings(), &as_recorded, 3).unwrap()
}

fn diagnosed(scenario: Scenario, set: &RecordingSet) -> Diagnosis {
    diagnose::diagnose(scenario, set, &()).unwrap().0
}

fn found(diagnosis: &Diagnosis) -> Vec<&str> {
    diagnosis.effects.iter().map(|e| e.name.as_str()).collect()
}

#[test]
fn a_speed_limit_that_the_rig_passes_is_raised_said_and_written() {
    let set = recording();
    let slow = "actuator.hinge.speed_limit_rad_per_s=0.2";
    let diagnosis = diagnosed(swing(&[slow]), &set);
    assert_eq!((diagnosis.verdict, found(&diagnosis)), (Verdict::Explained, vec![FRICTION]));
    assert!(
        diagnosis.remarks.iter().any(|r| r.contains("actuator[0].speed_limit_rad_per_s=")),
        "{:?}",
        diagnosis.remarks
    );
    let own = diagnosed(swing(&[]), &set);
    assert!(!own.remarks.iter().any(|r| r.contains("speed_limit")), "{:?}", own.remarks);
    let [raised, free] = [&diagnosis, &own].map(|d| d.effects[0].params["b"].numbers().unwrap()[0]);
    assert!((raised - free).abs() < 1e-6, "{raised} {free}");
}

/// The rig with a hinge that its URDF lets swing by so much to either side.
fn narrow(folder: &Path, range: f64) -> Scenario {
    let rigs = root().join("crates/diagnose/tests/rigs");
    let urdf = std::fs::read_to_string(rigs.join("swing.urdf")).unwrap();
    let narrow = urdf.replace(r#"lower="-100" upper="100""#, &format!(r#"lower="-{range}" upper="{range}""#));
    assert_ne!(narrow, urdf);
    std::fs::write(folder.join("swing.urdf"), narrow).unwrap();
    std::fs::copy(rigs.join("swing.toml"), folder.join("swing.toml")).unwrap();
    scenario::load(&folder.join("swing.toml"), &[]).unwrap()
}

#[test]
fn stops_that_a_recorded_joint_passes_are_taken_away_and_those_that_hold_it_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let is_lifted = |d: &Diagnosis| d.remarks.iter().any(|r| r.contains("vehicle[0].unstopped_joints="));
    let free = diagnosed(narrow(folder.path(), 0.2), &recording());
    assert_eq!((free.verdict, found(&free)), (Verdict::Explained, vec![FRICTION]));
    assert!(is_lifted(&free), "{:?}", free.remarks);
    let place = |s: &&Series| s.channel.ends_with(".position");
    let set = recording();
    let places = set.runs.iter().flat_map(|r| r.series.iter().filter(place)).flat_map(|s| s.values.iter().copied());
    let range = 0.95 * places.fold(0.0, |far: f64, q| far.max(q.abs()));
    let mut rig = narrow(folder.path(), range);
    rig.effects.push(effect(FRICTION, "joint:hinge", &[("b", number(0.3))]));
    let held = synthesise(rig, &swings(), &as_recorded, 3).unwrap();
    // What is passed is seen before anything is sought.
    let held = diagnose_with(narrow(folder.path(), range), &held, (1e-3, &())).unwrap().0;
    assert!(!is_lifted(&held), "{:?}", held.remarks);
}

#[test]
fn commands_beyond_a_drive_are_delivered_where_the_recording_says_so_and_cut_where_it_does_not() {
    let weak = "actuator.hinge.limit_n_m=1.0";
    let is_raised = |d: &Diagnosis| d.remarks.iter().any(|r| r.contains("actuator[0].limit_n_m="));
    let strong = diagnosed(swing(&[weak]), &recording());
    assert_eq!((strong.verdict, found(&strong)), (Verdict::Explained, vec![FRICTION]));
    assert!(is_raised(&strong), "{:?}", strong.remarks);
    let mut rig = swing(&[weak]);
    rig.effects.push(effect(FRICTION, "joint:hinge", &[("b", number(0.3))]));
    let cut = diagnosed(swing(&[weak]), &synthesise(rig, &swings(), &as_recorded, 3).unwrap());
    assert_eq!((cut.verdict, found(&cut)), (Verdict::Explained, vec![FRICTION]));
    assert!(!is_raised(&cut), "{:?}", cut.remarks);
}

/// The same with every series of a channel renamed, or added by another name.
fn with_efforts(set: &RecordingSet, name: &str, keeps: bool, gain: f64) -> RecordingSet {
    let mut set = set.clone();
    for run in &mut set.runs {
        let at = run.series.iter().position(|s| s.channel.ends_with(".effort_command")).unwrap();
        let command = run.series[at].clone();
        let values = command.values.iter().map(|v| gain * v).collect();
        let measured = Series::new(name, command.times.clone(), values);
        if keeps { run.series.push(measured) } else { run.series[at] = measured }
    }
    set
}

#[test]
fn a_measured_effort_drives_a_joint_whose_command_was_not_recorded() {
    let set = recording();
    let commanded = diagnosed(swing(&[]), &set);
    let measured = diagnosed(swing(&[]), &with_efforts(&set, "joint.hinge.effort", false, 1.0));
    // Beside a command it is not looked at, whatever it says.
    let both = diagnosed(swing(&[]), &with_efforts(&set, "joint.hinge.effort", true, 7.0));
    for diagnosis in [&measured, &both] {
        assert_eq!(diagnosis.effects, commanded.effects);
        assert!(diagnosis.remarks.iter().any(|r| r.contains("joint.hinge.effort")), "{:?}", diagnosis.remarks);
    }
}
