//! Nominal numbers with tolerances: within them they are corrected and are no findings, beyond them they are.
//!
//! The bar of the other tests, its mass or its drive a little off, with and without friction that nobody put into the model.
#![allow(clippy::unwrap_used)]

mod planted;

use diagnose::diagnosis::{Diagnosis, Verdict};
use diagnose::start::Start;
use diagnose::synthesise;
use planted::{effect, number, root, swings};
use scenario::Scenario;
use scenario::spec::{Effect, Tolerance};

fn swing() -> Scenario {
    scenario::load(&root().join("crates/diagnose/tests/rigs/swing.toml"), &[]).unwrap()
}

/// What is said of a recording that `truth` made, by a model without it whose numbers have these tolerances.
fn diagnosed(truth: &[Effect], tolerance: Tolerance) -> (Diagnosis, String) {
    let with = Scenario { effects: truth.to_vec(), ..swing() };
    let at_rest = |built: &diagnose::plant::Built, _: &diagnose::tape::Tape| Start::nominal(built);
    let set = synthesise(with, &swings(), &at_rest, 3).unwrap();
    let nominal = Scenario { tolerance, ..swing() };
    let (diagnosis, evidence) = diagnose::diagnose(nominal.clone(), &set, &()).unwrap();
    // No headline says in one breath that nothing is missing and that the model is wrong.
    if diagnosis.verdict == Verdict::NoMismatch {
        let said = diagnose::words::paragraph(&diagnosis, &evidence);
        let after = diagnosis.judged().error.after;
        assert!(after < 1.1 && said.contains(&format!("is {after:.3}")[..5]), "{said}");
        assert_eq!(
            said.contains("corrected within their tolerances"),
            !diagnosis.within_tolerance.is_empty(),
            "{said}"
        );
    }
    let patched = diagnose::patched_toml(&nominal, &diagnosis, &std::env::temp_dir()).unwrap();
    (diagnosis, patched)
}

fn heavier(share: f64) -> Effect {
    effect("body-mass", "body:bar", &[("mass", number(4.0 * (1.0 + share)))])
}

fn titles(found: &[diagnose::diagnosis::Found]) -> Vec<String> {
    found.iter().map(|f| format!("{} at {}", f.name, f.place)).collect()
}

const FRICTION: &str = "joint-coulomb-friction at joint:hinge";
const MASS: Tolerance = Tolerance { mass: 0.03, ..Tolerance::EXACT };

#[test]
fn a_number_within_its_tolerance_is_no_finding() {
    let (diagnosis, patched) = diagnosed(&[heavier(0.02)], MASS);
    assert_eq!(diagnosis.verdict, Verdict::NoMismatch, "{:?}", diagnosis.effects);
    assert_eq!(titles(&diagnosis.within_tolerance), ["body-mass at body:bar"]);
    assert_eq!(diagnosis.error.within_tolerance, None, "there is no effect beside it");
    let mass = diagnosis.within_tolerance[0].params["mass"].number().unwrap();
    assert!((mass / 4.08 - 1.0).abs() < 2e-3, "{mass}");
    assert!(patched.contains("corrected within their tolerances"), "{patched}");
    // The same without a tolerance is a finding, as ever.
    let (exact, _) = diagnosed(&[heavier(0.02)], Tolerance::default());
    assert_eq!(exact.verdict, Verdict::Explained);
    assert_eq!(exact.effects.len(), 1, "{:?}", exact.effects);
    assert!(exact.within_tolerance.is_empty());
}

#[test]
fn what_is_left_out_is_found_beside_numbers_that_are_off() {
    let friction = effect("joint-coulomb-friction", "joint:hinge", &[("c", number(0.1))]);
    let (diagnosis, _) = diagnosed(&[heavier(-0.03), friction], Tolerance { gain: 0.01, ..MASS });
    assert_eq!(diagnosis.verdict, Verdict::Explained, "{:?}", diagnosis.error);
    assert_eq!(titles(&diagnosis.effects), [FRICTION]);
    // Mass and gain of the drive show together alone: the friction goes with the gain, by its tolerance.
    let c = diagnosis.effects[0].params["c"].number().unwrap();
    assert!((c / 0.1 - 1.0).abs() < 0.04, "{c}");
    assert!(titles(&diagnosis.within_tolerance).contains(&"actuator-gain at joint:hinge".to_owned()));
    // What the friction explains is a share of what the numbers leave that are off.
    let (left, error) = (diagnosis.error.within_tolerance.unwrap(), diagnosis.error.windowed);
    assert!(error.after < 1.1 && 2.0 < left && left < error.before, "{left} of {error:?}");
}

#[test]
fn a_number_that_leaves_its_tolerance_is_a_finding() {
    let (diagnosis, _) = diagnosed(&[heavier(0.3)], MASS);
    assert_eq!(diagnosis.verdict, Verdict::Explained, "{:?}", diagnosis.error);
    assert_eq!(diagnosis.effects.len(), 1, "{:?}", diagnosis.effects);
    let found = &diagnosis.effects[0];
    let rivals: Vec<&str> = found.rivals.iter().map(|r| r.name.as_str()).collect();
    let names: Vec<&str> = std::iter::once(found.name.as_str()).chain(rivals).collect();
    // About its axis a bar's mass, its centre and its inertia are one number.
    assert!(names.iter().any(|n| n.starts_with("body-") || *n == "payload" || *n == "joint-armature"), "{names:?}");
}
