//! A ball of 1 kg against a wall: Hertz' impact, Hunt and Crossley's restitution, and bounces on a floor.
//!
//! Without gravity, against the closed forms of [`crate::exact::impact`]; the step is the impact's duration over 1,000,
//! RK4. Then all four integrators see the same impact at 1 ms, where it lasts 2.3 steps: mean over eight phases of
//! touch-down within the step.

use crate::bench::{Bench, Rig};
use crate::exact::impact::{Impact, calc_leaving, calc_restitution};
use crate::scene::{GRAVITY, ball_robot};
use crate::{Chart, Experiment, Figure, LabError, Options, Outcome};
use contact::{Normal, NormalLaw, Shape};
use sim::{Base, Integrator, PairLaw};
use spatial::Twist;

/// The entry in the catalogue.
pub const EXPERIMENT: Experiment = Experiment {
    name: "bouncing-sphere",
    question: "How long, how hard and how deep is an impact, and what comes back?",
    run,
};

const MASS: f64 = 1.0;
const RADIUS: f64 = 0.1;
const HERTZ: Impact = Impact { mass: MASS, stiffness: 1e8, dissipation: 0.0, speed: 0.5 };
/// Steps in the contact of the reference.
const RESOLUTION: f64 = 1000.0;
/// The four integrators, as they are named in charts.
const INTEGRATORS: [(&str, Integrator); 4] = [
    ("implicit Euler", Integrator::ImplicitEuler),
    ("implicit midpoint", Integrator::ImplicitMidpoint),
    ("semi-implicit Euler", Integrator::SemiImplicitEuler),
    ("RK4", Integrator::RungeKutta4),
];

fn run(options: &Options) -> Result<Outcome, LabError> {
    let step = options.step.unwrap_or(HERTZ.calc_hertz_duration() / RESOLUTION);
    let mut outcome = Outcome::default();
    add_hertz(&mut outcome, step)?;
    add_restitution(&mut outcome, step)?;
    add_integrators(&mut outcome)?;
    add_bounces(&mut outcome, options)?;
    outcome.notes.push(
        "At 1 ms this impact lasts 2.3 steps: no fixed-step method resolves it. The implicit ones lose energy there and \
         never gain any; the explicit ones may gain."
            .to_owned(),
    );
    Ok(outcome)
}

/// What an impact showed.
#[derive(Clone, Debug, Default)]
struct Measured {
    duration: f64,
    approach: f64,
    peak_force: f64,
    restitution: f64,
    /// Largest change of kinetic energy less the work of the contact through the impact, J.
    account_error: f64,
    /// Largest change of kinetic plus stored energy through the impact, J.
    stored_error: f64,
    /// (time since touch-down, force).
    force: Vec<(f64, f64)>,
}

fn law_of(impact: &Impact) -> PairLaw {
    let Impact { stiffness, dissipation, .. } = *impact;
    let law = NormalLaw::HuntCrossley { stiffness, exponent: 1.5, dissipation };
    PairLaw::new(Normal::new(law), None)
}

/// The ball above the floor, `gap` from it, moving down.
fn build(impact: &Impact, gap: f64, bench: Bench) -> Result<Rig, LabError> {
    let mut bench = bench;
    bench.add_floor();
    let ball = bench.add_vehicle("ball", &ball_robot(MASS, RADIUS), Base::Free);
    bench.add_shape(Some(ball), 0, Shape::Ball { radius: RADIUS });
    bench.pair("floor", "ball", law_of(impact));
    let mut rig = bench.build()?;
    rig.place(ball, [0.0, 0.0, RADIUS + gap], [0.0; 3]);
    rig.throw(&[Twist::new([0.0; 3].into(), [0.0, 0.0, -impact.speed].into())]);
    Ok(rig)
}

/// One impact, touch-down `phase` of a step after the start.
fn measure(impact: &Impact, integrator: Integrator, step: f64, phase: f64) -> Result<Measured, LabError> {
    let gap = impact.speed * step * phase;
    let mut rig = build(impact, gap, Bench::new(EXPERIMENT.name, step).integrator(integrator))?;
    let law = law_of(impact).normal.law;
    let mut out = Measured::default();
    let mut last = (0.0, -gap);
    let touch_down = phase * step;
    // Damped impacts end later than Hertz' (soft rebounds), coarse steps at least four steps on.
    let end = touch_down + 3.0 * impact.calc_hertz_duration() + 4.0 * step;
    while rig.time() < end {
        rig.advance()?;
        let (time, depth) = (rig.time(), RADIUS - rig.position(0).z);
        if last.1 > 0.0 && depth <= 0.0 {
            out.duration = last.0 + (time - last.0) * last.1 / (last.1 - depth) - touch_down;
        }
        last = (time, depth);
        out.approach = out.approach.max(depth);
        let force: f64 = rig.world.touches().map(|t| t.force_w.z).sum();
        out.peak_force = out.peak_force.max(force);
        out.force.push((time - touch_down, force));
        let kinetic = 0.5 * MASS * rig.velocity(0).norm_squared();
        let account = kinetic - rig.world.state().account.contact_work - impact.calc_energy();
        let stored = kinetic + law.calc_stored_energy(-depth) - impact.calc_energy();
        out.account_error = out.account_error.max(account.abs());
        out.stored_error = out.stored_error.max(stored.abs());
    }
    out.restitution = rig.velocity(0).z / impact.speed;
    Ok(out)
}

/// Height (m) and speed (m/s) at every millisecond until `duration`, touch-down half a millisecond after the start.
pub(super) fn fly(
    impact: &Impact,
    integrator: Integrator,
    step: f64,
    duration: f64,
) -> Result<Vec<Vec<f64>>, LabError> {
    let bench = Bench::new("integrators", step).integrator(integrator);
    let mut rig = build(impact, 5e-4 * impact.speed, bench)?;
    let every = (1e-3 / step).round() as u64;
    let mut track = Vec::new();
    for _ in 0..(duration / 1e-3).round() as u64 {
        rig.run(every, |_| {})?;
        track.push(vec![rig.position(0).z, rig.velocity(0).z]);
    }
    Ok(track)
}

fn add_hertz(outcome: &mut Outcome, step: f64) -> Result<(), LabError> {
    let hertz = measure(&HERTZ, Integrator::RungeKutta4, step, 0.5)?;
    let energy = HERTZ.calc_energy();
    outcome.figures.extend([
        Figure::relative("Hertz: duration of the contact", hertz.duration, HERTZ.calc_hertz_duration(), "s", 1e-3),
        Figure::relative("Hertz: largest approach", hertz.approach, HERTZ.calc_hertz_approach(), "m", 1e-3),
        Figure::relative("Hertz: peak force", hertz.peak_force, HERTZ.calc_hertz_force(), "N", 1e-3),
        Figure::absolute("Hertz: restitution", hertz.restitution, 1.0, "1", 1e-6),
        Figure::at_most("Hertz: energy account through the impact", hertz.account_error / energy, 1e-6, "1"),
        Figure::at_most("Hertz: kinetic + stored energy through the impact", hertz.stored_error / energy, 1e-6, "1"),
    ]);
    let exact = HERTZ.integrate(400, 0.0).into_iter().map(|(t, depth, _)| (1e3 * t, HERTZ.calc_force(depth)));
    let every = (hertz.force.len() / 400).max(1);
    let measured = hertz.force.iter().step_by(every).filter(|p| p.0 < 1.5 * HERTZ.calc_hertz_duration());
    outcome.charts.push(
        Chart::new("Hertz' impact: 1 kg at 0.5 m/s, k = 1e8 N/m^1.5", "time since touch-down, ms", "force, N")
            .theory("closed form", exact.collect())
            .line("RK4, 1,000 steps in the contact", measured.map(|p| (1e3 * p.0, p.1)).collect()),
    );
    Ok(())
}

fn add_restitution(outcome: &mut Outcome, step: f64) -> Result<(), LabError> {
    let mut points = Vec::new();
    for dissipation in [0.02, 0.2, 0.6, 1.2, 2.4, 4.0] {
        let impact = Impact { dissipation, ..HERTZ };
        let x = dissipation * impact.speed;
        let found = measure(&impact, Integrator::RungeKutta4, step, 0.5)?;
        let name = format!("Hunt–Crossley: restitution at d v = {x}");
        outcome.figures.push(Figure::relative(name, found.restitution, impact.calc_restitution(), "1", 1e-6));
        if dissipation == 0.6 {
            let error = found.account_error / impact.calc_energy();
            outcome.figures.push(Figure::at_most("Hunt–Crossley: energy account, d v = 0.3", error, 1e-6, "1"));
        }
        points.push((x, found.restitution));
    }
    let grid: Vec<f64> = (0..=80).map(|k| 0.025 * f64::from(k)).collect();
    outcome.charts.push(
        Chart::new("Restitution of Hunt and Crossley's law", "d v", "restitution")
            .theory("from the integral", grid.iter().map(|x| (*x, calc_restitution(*x))).collect())
            .theory("1 − ⅔ d v", grid.iter().take(50).map(|x| (*x, 1.0 - 2.0 / 3.0 * x)).collect())
            .marks("measured", points),
    );
    Ok(())
}

/// The same impact at 1 ms by all four, and by a softer contact that they resolve.
fn add_integrators(outcome: &mut Outcome) -> Result<(), LabError> {
    const STEP: f64 = 1e-3;
    const PHASES: u32 = 8;
    let soft = Impact { stiffness: 3e5, ..HERTZ };
    let peak = soft.calc_hertz_force();
    let exact = soft.integrate(200, 0.0).into_iter().map(|(t, depth, _)| (1e3 * t, soft.calc_force(depth)));
    let title = "The softer impact (k = 3e5 N/m^1.5) at 1 ms";
    let mut chart = Chart::new(title, "time since touch-down, ms", "force, N").theory("closed form", exact.collect());
    for (impact, which) in [(HERTZ, "2.3 steps in the contact"), (soft, "24 steps in the contact")] {
        for (name, integrator) in INTEGRATORS {
            let (mut restitution, mut force) = (0.0, 0.0);
            for phase in 0..PHASES {
                let phase = (f64::from(phase) + 0.5) / f64::from(PHASES);
                let found = measure(&impact, integrator, STEP, phase)?;
                restitution += found.restitution / f64::from(PHASES);
                force += found.peak_force / impact.calc_hertz_force() / f64::from(PHASES);
            }
            outcome.figures.extend([
                Figure::shown(format!("{name} at 1 ms, {which}: restitution"), restitution, 1.0, "1"),
                Figure::shown(format!("{name} at 1 ms, {which}: peak force over Hertz'"), force, 1.0, "1"),
            ]);
        }
    }
    for (name, integrator) in INTEGRATORS {
        let found = measure(&soft, integrator, STEP, 0.5)?;
        let within = found.force.iter().filter(|p| p.0 < 1.5 * soft.calc_hertz_duration());
        chart = chart.line(name, within.map(|p| (1e3 * p.0, p.1.min(1.5 * peak))).collect());
    }
    outcome.charts.push(chart);
    Ok(())
}

/// Dropped from 0.2 m: every apex follows from the last by the impact at its speed, integrated with the weight.
fn add_bounces(outcome: &mut Outcome, options: &Options) -> Result<(), LabError> {
    const HEIGHT: f64 = 0.2;
    let impact = Impact { stiffness: 1e8, dissipation: 0.1, speed: 0.0, mass: MASS };
    let step = options.step.unwrap_or(1e-5);
    let bench = Bench::new(EXPERIMENT.name, step).gravity([0.0, 0.0, -GRAVITY]).integrator(Integrator::RungeKutta4);
    let mut rig = build(&impact, HEIGHT, bench)?;
    let mut film = rig.film((0.005 / step).ceil() as u64);
    film.shoot(&rig.world);
    let (mut apexes, mut last, mut path) = (Vec::new(), rig.velocity(0).z, vec![(0.0, HEIGHT)]);
    let every = (0.005 / step).ceil() as u64;
    while rig.time() < if options.quick { 1.0 } else { 2.0 } {
        rig.advance()?;
        film.shoot(&rig.world);
        let (height, speed) = (rig.position(0).z - RADIUS, rig.velocity(0).z);
        if last > 0.0 && speed <= 0.0 {
            apexes.push((rig.time(), height));
        }
        if rig.world.state().steps.is_multiple_of(every) {
            path.push((rig.time(), height));
        }
        last = speed;
    }
    let (mut height, mut theory) = (HEIGHT, Vec::new());
    for (time, _) in &apexes {
        let speed = (2.0 * GRAVITY * height).sqrt();
        let (_, back) = calc_leaving(&Impact { speed, ..impact }.integrate(2000, GRAVITY));
        height = back * back / (2.0 * GRAVITY);
        theory.push((*time, height));
    }
    for (k, (found, exact)) in apexes.iter().zip(&theory).take(3).enumerate() {
        let name = format!("bounces: height of apex {}", k + 1);
        outcome.figures.push(Figure::relative(name, found.1, exact.1, "m", 1e-5));
    }
    outcome.charts.push(
        Chart::new("Bounces from 0.2 m, d = 0.1 s/m", "time, s", "height, m")
            .line("RK4", path)
            .marks("apexes by an integration of each impact", theory),
    );
    outcome.run = film.develop(&rig)?;
    Ok(())
}
