//! Experiments on contact, at the size of a first look: every figure is what it should be, and the shuffled detector.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod shuffled;

use lab::{Options, Outcome};

/// Runs an experiment quickly, prints its figures and holds them.
fn hold(name: &str) -> Outcome {
    let outcome = (lab::find(name).unwrap().run)(&Options { quick: true, ..Options::default() }).unwrap();
    for figure in &outcome.figures {
        println!("{}: {:.6e} {} (should be {:.6e})", figure.name, figure.measured, figure.unit, figure.expected);
    }
    for figure in &outcome.figures {
        assert!(figure.holds(), "{name}: {} is {} {}", figure.name, figure.measured, figure.unit);
    }
    assert!(!outcome.charts.is_empty() && outcome.run.is_some());
    outcome
}

fn figure(outcome: &Outcome, name: &str) -> f64 {
    outcome.figures.iter().find(|f| f.name == name).unwrap_or_else(|| panic!("no figure \"{name}\"")).measured
}

#[test]
fn impacts_meet_hertz_and_hunt_crossley() {
    let outcome = hold("bouncing-sphere");
    // Implicit steps lose energy in an impact that they do not resolve; they never gain any.
    for name in ["implicit Euler", "implicit midpoint"] {
        assert!(figure(&outcome, &format!("{name} at 1 ms, 2.3 steps in the contact: restitution")) < 1.0);
    }
}

#[test]
fn a_sliding_ball_rolls_at_five_sevenths_and_goes_on() {
    hold("rolling-ball");
}

#[test]
fn a_peg_jams_and_wedges_where_geometry_and_friction_say_so() {
    hold("wedging-peg");
}

#[test]
fn a_pinched_capsule_does_not_sink() {
    hold("pinch-hold");
}

#[test]
fn forces_on_a_body_at_rest_add_up_to_nothing() {
    hold("force-balance");
}

#[test]
fn force_is_as_smooth_as_the_surfaces_and_points_stay_themselves() {
    hold("smooth-sliding");
}

#[test]
fn implicit_integrators_agree_with_fine_rk4() {
    let outcome = hold("integrators");
    // First order: a tenth of the step leaves about a tenth of the error, and three tenths at most.
    for scene in ["impact, implicit Euler, {}: place", "grasp, implicit Euler, {}: place of the bar"] {
        let error = |step: &str| figure(&outcome, &scene.replace("{}", step));
        assert!(error("0.1 ms") < 0.3 * error("1 ms"), "{scene}");
    }
}
