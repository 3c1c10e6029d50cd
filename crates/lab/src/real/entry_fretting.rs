//! `softdock lab fretting`: the measured loop beside laws that were fitted to it.

use super::fretting::Loop;
use super::fretting_fit::{FAMILIES, Family};
use super::{RealError, Search, committed, find_folder};
use crate::{Chart, Curve, Experiment, Figure, LabError, Options, Outcome};

/// The entry in the catalogue.
pub const EXPERIMENT: Experiment = Experiment {
    name: "fretting",
    question: "Does a fitted bristle reproduce a measured fretting loop, and how do its relatives? (needs recordings)",
    run: |options| Ok(run(options)?),
};

/// The search of `--refit`.
const SEARCH: Search = Search { seed: 1, spread: 0.3, population: 12, generations: 60 };
/// What a bristle's error on the judged cycles may be, %: two thirds of LuGre's 12.4; the fit reaches 7.1.
const BRISTLE_AT_MOST: f64 = 8.0;

fn run(options: &Options) -> Result<Outcome, RealError> {
    let data = Loop::load(&find_folder(options.data.as_deref())?)?;
    let mut outcome = Outcome::default();
    let first = data.cycles[data.cycles.len() - 2];
    let cycle = first..data.cycles[data.cycles.len() - 1];
    let place = |force: &[f64]| cycle.clone().map(|i| (1e6 * data.x[i], force[i])).collect::<Vec<_>>();
    let chart = |title| Chart::new(title, "displacement, µm", "friction force, N").line("measured", place(&data.force));
    let mut bristles = chart("The last cycle under 5 N, and bristles that were fitted to earlier ones");
    let mut relatives = chart("The same, and their relatives");
    for family in FAMILIES {
        let x = if options.refit { family.fit(&data, &SEARCH) } else { committed::fretting(family) };
        let force = data.drive(&family.build(&x), data.x.len());
        add_figures(&mut outcome, &data, family, &force);
        outcome.notes.push(describe(&data, family, &x));
        let chart = if family.is_bristle() { &mut bristles } else { &mut relatives };
        chart.curves.push(Curve { name: family.name(), points: place(&force), ..Curve::default() });
    }
    outcome.charts.extend([bristles, relatives]);
    add_data_figures(&mut outcome, &data);
    outcome.notes.push(
        "Fitted to cycles 1 to 25, judged on 26 to 49, by the same search (60 generations of 12) for every law. \
         ± is one standard error with cycles as clusters; a parameter whose error exceeds it is not told by these data, \
         which know one speed only. "
            .to_owned()
            + MISSING,
    );
    Ok(outcome)
}

/// What no law of the list can do.
const MISSING: &str = "What is left is not a rounder bristle: bristles that break away one after the other gain little over \
    one. It is that the stiffness differs with the sign of the force, that the level rises over the last 25 µm of the upward \
    stroke, and drift; the first two are properties of the rig and of the worn track rather than of a friction law.";

fn add_figures(outcome: &mut Outcome, data: &Loop, family: Family, force: &[f64]) {
    let error = |range| 100.0 * data.calc_error(force, range);
    let name = |what: &str| format!("{}: rms error of the force, {what}", family.name());
    let judged = error(data.judged());
    outcome.figures.push(if family.is_bristle() {
        Figure::at_most(name("cycles 26–49"), judged, BRISTLE_AT_MOST, "%")
    } else {
        Figure::shown(name("cycles 26–49"), judged, f64::NAN, "%")
    });
    outcome.figures.push(Figure::shown(name("fitted cycles"), error(data.fitted()), f64::NAN, "%"));
    let moving = 100.0 * data.calc_error_where(force, data.judged(), |i| data.is_moving(i));
    outcome.figures.push(Figure::shown(name("cycles 26–49, without the dwells"), moving, f64::NAN, "%"));
}

fn add_data_figures(outcome: &mut Outcome, data: &Loop) {
    let scatter = 100.0 * data.calc_scatter();
    outcome.figures.push(Figure::shown("the loop's own scatter about its mean cycle", scatter, f64::NAN, "%"));
    for (name, range) in [("+0.5 to +1.5 N", 0.5..1.5), ("−1.5 to −0.5 N", -1.5..-0.5)] {
        let stiffness = data.calc_stiffness(range) * 1e-6;
        outcome.figures.push(Figure::shown(format!("measured stiffness at {name}"), stiffness, f64::NAN, "N/µm"));
    }
}

/// Parameters with their standard errors, one line.
fn describe(data: &Loop, family: Family, x: &[f64]) -> String {
    let errors = family.calc_standard_errors(data, x);
    let all = family.parameters().iter().zip(x).zip(errors);
    let all: Vec<String> = all.map(|((name, x), e)| format!("{name} = {x:.4e} ± {e:.1e}")).collect();
    format!("{}: {}", family.name(), all.join("; "))
}

impl From<RealError> for LabError {
    fn from(error: RealError) -> Self {
        Self::Real(Box::new(error))
    }
}
