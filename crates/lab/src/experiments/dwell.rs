//! Static friction that grows with the time at rest (Gonthier, McPhee, Lange and Piedbœuf 2004, in this law's form).
//!
//! The level returns as μ(t) = μ_k + (μ_s − μ_k)(1 − e^{−t/T}), t the time in stick. A contact whose bristle is loaded at the
//! rate K V since it began to stick, from the force f₀, breaks away when
//!
//!   f₀ + K V (t − t₀) = W μ(t)
//!
//! Held longer before it is pulled, it holds more; pulled faster, less. With a Stribeck speed the level follows the slip speed
//! late where it rises, so that friction is lower while the speed falls than while it rises: frictional lag.

use crate::bench::Rig;
use crate::exact::first_root;
use crate::scene::{GANTRY, GRAVITY, contact_law, gantry_block, settle_gantry};
use crate::{Chart, Experiment, Figure, LabError, Options, Outcome, Recording};
use friction::Bristle;
use sim::World;
use std::f64::consts::PI;

/// The entry in the catalogue.
pub const EXPERIMENT: Experiment = Experiment {
    name: "dwell",
    question: "How does the breakaway force grow with the time at rest, and fall with the rate of loading?",
    run,
};

const LEVELS: (f64, f64) = (0.5, 0.3);
const DWELL: f64 = 1.0;
const POINT: f64 = 1e6;
/// Stiffness of the four bristles together, N/m.
const STIFFNESS: f64 = 1e5;
/// Speed of the pull after the dwell, m/s.
const PULL: f64 = 2e-4;
/// How much the lead steps back when it stops, m: the bristle sticks beyond doubt.
const BACK: f64 = 5e-6;

fn run(options: &Options) -> Result<Outcome, LabError> {
    let dwells: &[f64] = if options.quick { &[0.1, 1.0] } else { &[0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0] };
    let speeds: &[f64] = if options.quick { &[1e-5, 1e-3] } else { &[1e-6, 3e-6, 1e-5, 3e-5, 1e-4, 1e-3, 1e-2, 1e-1] };
    let step = options.step.unwrap_or(1e-4);
    let mut outcome = Outcome::default();
    let (mut by_dwell, mut by_rate) = (Vec::new(), Vec::new());
    for &dwell in dwells {
        let (measured, exact) =
            (break_after_dwell(dwell, step)?, calc_breakaway(GRAVITY * LEVELS.1 - STIFFNESS * BACK, dwell, PULL));
        by_dwell.push((dwell, measured));
        let name = format!("breakaway force after {dwell} s at rest");
        outcome.figures.push(Figure::relative(name, measured, exact, "N", 5e-3));
    }
    for &speed in speeds {
        let (measured, exact) = (break_at_rate(speed, options.step)?, calc_breakaway(0.0, 0.0, speed));
        by_rate.push((STIFFNESS * speed, measured));
        let name =
            format!("breakaway force of a fresh contact loaded at {} N/s", crate::report::shown(STIFFNESS * speed));
        outcome.figures.push(Figure::relative(name, measured, exact, "N", 5e-3));
    }
    let (lag, loop_chart, run) = frictional_lag(step)?;
    outcome.run = run;
    let name = "friction while the speed rises less while it falls, at 5 mm/s";
    outcome.figures.push(Figure::relative(name, lag, calc_lag(), "N", 0.02));
    outcome.charts = vec![dwell_chart(by_dwell), rate_chart(by_rate), loop_chart];
    Ok(outcome)
}

fn calc_level(rested: f64) -> f64 {
    GRAVITY * (LEVELS.1 - (LEVELS.0 - LEVELS.1) * (-rested / DWELL).exp_m1())
}

/// Force at which a contact breaks away that carries `force` (N) for `dwell` s and is then loaded at `speed` (m/s).
fn calc_breakaway(force: f64, dwell: f64, speed: f64) -> f64 {
    let loaded = |t: f64| force + STIFFNESS * speed * t;
    let until = 1.1 * GRAVITY * LEVELS.0 / (STIFFNESS * speed);
    first_root(|t| calc_level(dwell + t) - loaded(t), 0.0, until, until / 1000.0).map_or(f64::NAN, loaded)
}

fn dwell_chart(measured: Vec<(f64, f64)>) -> Chart {
    let theory = (0..=120).map(|k| 10_f64.powf(-2.2 + 0.03 * f64::from(k)));
    let theory = theory.map(|t| (t, calc_breakaway(GRAVITY * LEVELS.1 - STIFFNESS * BACK, t, PULL))).collect();
    Chart::new("Breakaway after a time at rest", "time at rest, s", "force, N")
        .logarithmic(true, false)
        .theory("closed form", theory)
        .marks("measured", measured)
}

fn rate_chart(measured: Vec<(f64, f64)>) -> Chart {
    let theory = (0..=120).map(|k| 10_f64.powf(-6.2 + 0.045 * f64::from(k)));
    let theory = theory.map(|v| (STIFFNESS * v, calc_breakaway(0.0, 0.0, v))).collect();
    Chart::new("Breakaway of a fresh contact", "rate of loading, N/s", "force, N")
        .logarithmic(true, false)
        .theory("closed form", theory)
        .marks("measured", measured)
}

fn rig(bristle: Bristle, step: f64) -> Result<Rig, LabError> {
    let mut bench = gantry_block(EXPERIMENT.name, 1.0, contact_law(POINT, 1e3, bristle), step);
    bench.add_spring("lead", GANTRY[0], 1e9, 1e5);
    let mut rig = bench.build()?;
    settle_gantry(&mut rig, 1.0, POINT);
    Ok(rig)
}

/// Moves the lead on for one step.
fn lead_on(world: &mut World, speed: f64, step: f64) {
    let command = &mut world.commands_mut()[0];
    (command.position, command.velocity) = (command.position + speed * step, speed);
}

fn bristle(stribeck_speed: f64) -> Bristle {
    Bristle {
        mu_static: LEVELS.0,
        mu_kinetic: LEVELS.1,
        stribeck_speed,
        dwell_time: DWELL,
        stiffness: 0.25 * STIFFNESS,
        ..Bristle::default()
    }
}

/// Leads the block on by `speed` until its points slide; the greatest friction force, N.
fn lead_to_breakaway(rig: &mut Rig, speed: f64, step: f64) -> Result<f64, LabError> {
    let mut greatest = 0.0_f64;
    for _ in 0..(1.2 * GRAVITY * LEVELS.0 / (STIFFNESS * speed) / step) as u64 {
        lead_on(&mut rig.world, speed, step);
        rig.advance()?;
        greatest = greatest.max(rig.friction_force().norm());
        if rig.world.touches().all(|t| !t.sticks) {
            break;
        }
    }
    Ok(greatest)
}

/// Slides for 0.1 s, rests for `dwell`, is pulled.
fn break_after_dwell(dwell: f64, step: f64) -> Result<f64, LabError> {
    let mut rig = rig(bristle(0.0), step)?;
    rig.run((0.1 / step) as u64, |world| lead_on(world, 0.01, step))?;
    lead_on(&mut rig.world, 0.0, step);
    rig.world.commands_mut()[0].position -= BACK;
    rig.run((dwell / step).round() as u64, |_| {})?;
    lead_to_breakaway(&mut rig, PULL, step)
}

/// A fresh contact is pulled at once, in at least 2,000 steps.
fn break_at_rate(speed: f64, step: Option<f64>) -> Result<f64, LabError> {
    let step = step.unwrap_or((GRAVITY * LEVELS.1 / (STIFFNESS * speed) / 2000.0).min(1e-3));
    lead_to_breakaway(&mut rig(bristle(0.0), step)?, speed, step)
}

const STRIBECK: f64 = 3e-3;
const SWING: f64 = 2.0;
/// Speed at which the two branches of the swing are compared, m/s: the mean.
const MIDDLE: f64 = 5e-3;

/// Speed of the swing: between 0.5 and 9.5 mm/s.
fn calc_speed(t: f64) -> f64 {
    MIDDLE - 4.5e-3 * (2.0 * PI * t / SWING).cos()
}

/// Friction while the speed rises less while it falls, at the mean speed: by the law's own equation, in small steps. The mean
/// is passed a quarter (rising) and three quarters (falling) through the swing.
fn calc_lag() -> f64 {
    let n = 200_000;
    let h = SWING / f64::from(n);
    let (mut rest, mut rising) = (0.0_f64, 0.0);
    for k in 0..2 * n {
        let target = (-(calc_speed(f64::from(k + 1) * h) / STRIBECK).powi(2)).exp();
        rest = if target < rest { target } else { rest - (target - rest) * (-h / DWELL).exp_m1() };
        if k + 1 == n + n / 4 {
            rising = rest;
        } else if k + 1 == n + 3 * n / 4 {
            return GRAVITY * (LEVELS.0 - LEVELS.1) * (rising - rest);
        }
    }
    f64::NAN
}

/// Friction over speed through the second swing; how much more it is while the speed rises, at the mean.
fn frictional_lag(step: f64) -> Result<(f64, Chart, Recording), LabError> {
    let mut rig = rig(bristle(STRIBECK), step)?;
    let mut film = rig.film((0.02 / step).ceil() as u64);
    let (mut rising, mut falling, mut points) = (f64::NAN, f64::NAN, Vec::new());
    for k in 1..=(2.0 * SWING / step) as u64 {
        let t = k as f64 * step;
        lead_on(&mut rig.world, calc_speed(t), step);
        rig.advance()?;
        film.shoot(&rig.world);
        let force = rig.friction_force().norm();
        if t <= SWING {
            continue;
        }
        points.push((1e3 * calc_speed(t), force));
        if t <= 1.25 * SWING {
            rising = force;
        } else if t <= 1.75 * SWING {
            falling = force;
        }
    }
    let chart =
        Chart::new("Friction over a swing of the speed in 2 s", "speed, mm/s", "force, N").line("measured", points);
    Ok((rising - falling, chart, film.develop(&rig)?))
}
