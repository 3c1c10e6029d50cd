//! Contact experiments: what must hold beyond their figures, and the shuffled detector.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod shuffled;

use lab::{Options, Outcome};

fn look(name: &str) -> Outcome {
    (lab::find(name).unwrap().run)(&Options { quick: true, ..Options::default() }).unwrap()
}

fn figure(outcome: &Outcome, name: &str) -> f64 {
    outcome.figures.iter().find(|f| f.name == name).unwrap_or_else(|| panic!("no figure \"{name}\"")).measured
}

#[test]
fn implicit_integrators_lose_energy_in_an_impact_that_they_do_not_resolve() {
    let outcome = look("bouncing-sphere");
    for name in ["implicit Euler", "implicit midpoint"] {
        let restitution = figure(&outcome, &format!("{name} at 1 ms, 2.3 steps in the contact: restitution"));
        println!("{name}: {restitution:.3}");
        assert!(restitution < 1.0);
    }
}

#[test]
fn implicit_euler_meets_fine_rk4_in_the_first_order() {
    let outcome = look("integrators");
    for scene in ["impact, implicit Euler, {}: place", "grasp, implicit Euler, {}: place of the bar"] {
        let error = |step: &str| figure(&outcome, &scene.replace("{}", step));
        println!("{scene}: {:.1e} m, {:.1e} m", error("1 ms"), error("0.1 ms"));
        // A tenth of the step leaves about a tenth of the error.
        assert!(error("0.1 ms") < 0.3 * error("1 ms"), "{scene}");
    }
}
