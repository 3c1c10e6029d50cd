//! A block of 1 kg on a slope: below the friction angle it rests, above it slides.
//!
//!   tan α < μ   rests; creep is the mean speed over an hour once 5 s have let it settle
//!   tan α > μ   a = g (sin α − μ cos α)

use crate::scene::{GRAVITY, block_on_slope, stiff_contact};
use crate::{Chart, Experiment, Figure, LabError, Options, Outcome};

/// The entry in the catalogue.
pub const EXPERIMENT: Experiment = Experiment {
    name: "incline",
    question: "Does a block below the friction angle creep, and how does it slide above?",
    run,
};

const MU: f64 = 0.4;

fn run(options: &Options) -> Result<Outcome, LabError> {
    let step = options.step.unwrap_or(1e-3);
    let mut outcome = Outcome::default();
    let hold = if options.quick { 60.0 } else { 3600.0 };
    let resting = [10.0, 18.0];
    let creeps = std::thread::scope(|scope| {
        let runs = resting.map(|angle_deg| scope.spawn(move || measure_creep(angle_deg, hold, step)));
        runs.map(|run| run.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    });
    for (angle_deg, creep) in resting.into_iter().zip(creeps) {
        outcome.figures.push(Figure::at_most(format!("creep at {angle_deg}° over {hold} s"), creep?, 1e-12, "m/s"));
    }
    let angles = [24.0_f64, 30.0, 37.0, 45.0];
    let mut points = Vec::new();
    for angle_deg in angles {
        let (measured, expected) = (measure_acceleration(angle_deg, step)?, calc_acceleration(angle_deg));
        points.push((angle_deg, measured));
        let name = format!("acceleration at {angle_deg}°");
        outcome.figures.push(Figure::relative(name, measured, expected, "m/s²", 1e-6));
    }
    let theory = (0..=60).map(|k| 15.0 + 0.5 * f64::from(k)).map(|a| (a, calc_acceleration(a).max(0.0))).collect();
    outcome.charts.push(
        Chart::new("Acceleration along the slope, μ = 0.4", "angle, °", "acceleration, m/s²")
            .theory("g (sin α − μ cos α)", theory)
            .marks("measured", points),
    );
    outcome.run = record(step)?;
    Ok(outcome)
}

fn calc_acceleration(angle_deg: f64) -> f64 {
    let (sin, cos) = angle_deg.to_radians().sin_cos();
    GRAVITY * (sin - MU * cos)
}

/// Mean speed over `hold` seconds, m/s.
fn measure_creep(angle_deg: f64, hold: f64, step: f64) -> Result<f64, LabError> {
    let mut rig = block_on_slope(EXPERIMENT.name, angle_deg.to_radians(), stiff_contact(MU), step)?;
    rig.run((5.0 / step) as u64, |_| {})?;
    let (start, from) = (rig.position(0), rig.time());
    rig.run((hold / step) as u64, |_| {})?;
    Ok((rig.position(0) - start).norm() / (rig.time() - from))
}

/// Gain of speed over the second second, m/s².
fn measure_acceleration(angle_deg: f64, step: f64) -> Result<f64, LabError> {
    let mut rig = block_on_slope(EXPERIMENT.name, angle_deg.to_radians(), stiff_contact(MU), step)?;
    rig.run((1.0 / step) as u64, |_| {})?;
    let (start, from) = (rig.velocity(0).x, rig.time());
    rig.run((1.0 / step) as u64, |_| {})?;
    Ok((rig.velocity(0).x - start) / (rig.time() - from))
}

/// One second of sliding at 24°, to look at.
fn record(step: f64) -> Result<Option<(record::Log, record::Scene)>, LabError> {
    let mut rig = block_on_slope(EXPERIMENT.name, 24.0_f64.to_radians(), stiff_contact(MU), step)?;
    let mut film = rig.film((0.01 / step).ceil() as u64);
    film.shoot(&rig.world);
    for _ in 0..(1.5 / step) as u64 {
        rig.advance()?;
        film.shoot(&rig.world);
    }
    film.develop(&rig)
}
