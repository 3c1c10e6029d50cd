//! What the integrators make of the same scenes, against RK4 at 1 µs: errors in a table.
//!
//! | scene | compared |
//! | --- | --- |
//! | impact: 1 kg at 0.5 m/s on k = 3e5 N/m^1.5, d = 0.3 s/m, 24 ms in contact | place, speed after it |
//! | stick–slip: 1 kg on a belt, a spring of 1e4 N/m ([`belt`]) | place over six cycles, highest spring force, period |
//! | grasp: a free gripper closes on a tumbling bar, 0.5 s ([`grasp`]) | place and attitude of the bar, fingers |
//!
//! RK4 takes the bristle as an ordinary differential equation, which wants h < 2 s_max/|u|: in the stick–slip scene that is
//! 2 · 0.7 µm/0.03 m/s = 50 µs. At touch-down s_max starts at zero, and no step is small enough; the force there is too small
//! for it to show.

mod belt;
mod grasp;

use super::bouncing_sphere::fly;
use crate::exact::impact::Impact;
use crate::{Experiment, Figure, LabError, Options, Outcome};
use sim::Integrator;

/// The entry in the catalogue.
pub const EXPERIMENT: Experiment = Experiment {
    name: "integrators",
    question: "What do the integrators make of an impact, of stick–slip and of a closing grasp?",
    run,
};

/// Who is compared: name, integrator, step in s.
const CANDIDATES: [(&str, Integrator, f64); 6] = [
    ("implicit Euler, 1 ms", Integrator::ImplicitEuler, 1e-3),
    ("implicit Euler, 0.1 ms", Integrator::ImplicitEuler, 1e-4),
    ("implicit midpoint, 1 ms", Integrator::ImplicitMidpoint, 1e-3),
    ("implicit midpoint, 0.1 ms", Integrator::ImplicitMidpoint, 1e-4),
    ("semi-implicit Euler, 0.1 ms", Integrator::SemiImplicitEuler, 1e-4),
    ("semi-implicit Euler, 10 µs", Integrator::SemiImplicitEuler, 1e-5),
];
/// Step of the reference, s.
const FINE: f64 = 1e-6;

/// Coordinates of a scene at every sample.
type Track = Vec<Vec<f64>>;

fn run(options: &Options) -> Result<Outcome, LabError> {
    let mut outcome = Outcome::default();
    add_impact(&mut outcome)?;
    belt::add_stick_slip(&mut outcome, options)?;
    belt::add_stiff(&mut outcome, options)?;
    grasp::add_grasp(&mut outcome, options)?;
    outcome.run = grasp::record()?;
    Ok(outcome)
}

/// Largest distance between two tracks in the coordinates of a range.
fn calc_error(track: &Track, reference: &Track, range: std::ops::Range<usize>) -> f64 {
    if track.len() != reference.len() {
        return f64::NAN;
    }
    let distance = |(a, b): (&Vec<f64>, &Vec<f64>)| {
        a[range.clone()].iter().zip(&b[range.clone()]).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
    };
    track.iter().zip(reference).map(distance).fold(0.0, f64::max)
}

fn add_impact(outcome: &mut Outcome) -> Result<(), LabError> {
    let impact = Impact { mass: 1.0, stiffness: 3e5, dissipation: 0.3, speed: 0.5 };
    let reference = fly(&impact, Integrator::RungeKutta4, FINE, 0.05)?;
    let after = |track: &Track| track.last().map_or(f64::NAN, |y| y[1]);
    let back = after(&reference) / impact.speed;
    outcome.figures.push(Figure::relative(
        "impact, RK4 at 1 µs: restitution against the integral",
        back,
        impact.calc_restitution(),
        "1",
        1e-9,
    ));
    for (name, integrator, step) in CANDIDATES {
        let track = fly(&impact, integrator, step, 0.05)?;
        outcome.figures.extend([
            Figure::shown(format!("impact, {name}: place"), calc_error(&track, &reference, 0..1), 0.0, "m"),
            Figure::shown(format!("impact, {name}: restitution"), after(&track) / impact.speed, back, "1"),
        ]);
    }
    Ok(())
}
