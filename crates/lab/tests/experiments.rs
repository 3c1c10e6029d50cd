//! Every experiment's figures hold, in the quick form; `softdock lab --report` judges the whole.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use lab::{Options, chart_svg};

/// Runs an experiment quickly; says every figure, and which do not hold.
fn figures_of(name: &str) {
    let experiment = lab::find(name).unwrap();
    let outcome = (experiment.run)(&Options { quick: true, ..Options::default() }).unwrap();
    assert!(outcome.figures.len() > 1, "{name} measures something");
    for row in lab::report::rows(&outcome) {
        println!("{}", row.join(" | "));
    }
    let missed: Vec<_> = outcome.figures.iter().filter(|f| !f.holds()).collect();
    assert!(missed.is_empty(), "{missed:#?}");
    for chart in &outcome.charts {
        assert!(!chart_svg(chart).contains("NaN"), "{}", chart.title);
    }
}

macro_rules! experiments {
    ($($test:ident: $name:literal),* $(,)?) => {
        const TESTED: &[&str] = &[$($name),*];
        $(#[test]
        fn $test() {
            figures_of($name);
        })*
    };
}

experiments! {
    incline: "incline",
    slider_line: "slider-line",
    slider_l: "slider-l",
    slider_circle: "slider-circle",
    stick_slip: "stick-slip",
    dwell: "dwell",
    spinning_disc: "spinning-disc",
    oscillating_load: "oscillating-load",
    anisotropy: "anisotropy",
    bouncing_sphere: "bouncing-sphere",
    rolling_ball: "rolling-ball",
    wedging_peg: "wedging-peg",
    pinch_hold: "pinch-hold",
    force_balance: "force-balance",
    smooth_sliding: "smooth-sliding",
    integrators: "integrators",
}

#[test]
fn every_experiment_is_tested_and_has_its_own_name() {
    // Those that need recordings are tested in `real.rs`, which says SKIPPED where they are missing.
    let here = lab::catalogue().into_iter().filter(|e| !e.question.ends_with(lab::real::NEEDS_RECORDINGS));
    let mut names: Vec<&str> = here.map(|e| e.name).collect();
    names.sort_unstable();
    let mut tested = TESTED.to_vec();
    tested.sort_unstable();
    assert_eq!(names, tested);
    let mut all: Vec<&str> = lab::catalogue().iter().map(|e| e.name).collect();
    all.sort_unstable();
    all.dedup();
    assert_eq!(all.len(), lab::catalogue().len());
}

/// The numerical loss at the end of an experiment's recorded run, J, and the most that it handled, J; `None` where nothing is
/// recorded.
fn numerical_loss_of(name: &str, step: f64) -> Option<(f64, f64)> {
    let experiment = lab::find(name).unwrap();
    let options = Options { quick: true, step: Some(step), ..Options::default() };
    let (log, _) = (experiment.run)(&options).unwrap().run?;
    let channel = |quantity: &str| log.signals.values(&format!("energy.{quantity}")).unwrap();
    let works = ["kinetic", "actuator_work", "contact_work", "contact_loss", "joint_loss"];
    let size = works.iter().flat_map(|q| channel(q)).fold(0.0_f64, |size, x| size.max(x.abs()));
    channel("numerical_loss").last().map(|loss| (*loss, size))
}

/// Their recorded runs do not follow the option: one leads bodies along paths by hand, so that nothing is conserved; one compares
/// integrators at steps of its own.
const OWN_STEPS: [&str; 2] = ["smooth-sliding", "integrators"];

#[test]
fn numerical_loss_of_every_recorded_experiment_falls_with_its_step() {
    let (mut recorded, mut faults) = (0, Vec::new());
    for name in TESTED.iter().filter(|name| !OWN_STEPS.contains(name)) {
        let [Some((coarse, _)), Some((fine, size))] = [1e-3, 2.5e-4].map(|step| numerical_loss_of(name, step)) else {
            continue;
        };
        recorded += 1;
        let [before, after] = [coarse, fine].map(|loss| loss.abs() / size);
        println!("{name}: {before:.1e} {after:.1e} of {size:.1e} J");
        // First order gives 4. Below a hundred-thousandth corners and parts of either sign decide.
        if !(after < 1e-5 || after < before / 2.0) {
            faults.push(format!("{name}: {coarse:e} J, {fine:e} J of {size:e} J"));
        }
    }
    assert!(recorded >= 12, "{recorded} experiments have a recording");
    assert!(faults.is_empty(), "{faults:#?}");
}
