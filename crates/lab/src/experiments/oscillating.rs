//! A tangential load that oscillates about a mean, always below breakaway: 10,000 cycles, every law.
//!
//! The load goes from 0.1 to 0.7 of μ m g and back, slowly beside the bristle's own 160 Hz. What remains after each cycle:
//!
//!   bristle, elasto-plastic    nothing: below breakaway both are springs
//!   LuGre, Dahl                z_m ln((1 − a²)/(1 − b²)) per cycle, z_m = μ m g/K, a and b the least and greatest load over μ m g:
//!                              going up dx = dz/(1 − z/z_m), coming down dx = dz/(1 + z/z_m)
//!   regularised Coulomb        the mean of v_d x/√(1 − x²) over the cycle, for as long as the load acts

use crate::bench::Rig;
use crate::scene::{GANTRY, GRAVITY, contact_law, gantry_block, settle_gantry};
use crate::{Chart, Experiment, Figure, LabError, Options, Outcome};
use friction::{Bristle, Friction, LuGre, RegularisedCoulomb, Trial};
use sim::ActuatorKind;
use spatial::Vec3;
use std::f64::consts::PI;

/// The entry in the catalogue.
pub const EXPERIMENT: Experiment = Experiment {
    name: "oscillating-load",
    question: "Under a load that oscillates below breakaway, which laws creep, and how far?",
    run,
};

const MU: f64 = 0.4;
const LIMIT: f64 = MU * GRAVITY;
/// Stiffness (N/m), damping (N·s/m) of the four points together, and of each in the normal.
const BRISTLE: (f64, f64) = (1e6, 200.0);
const POINT: f64 = 1e6;
/// Least and greatest load over μ m g, and its period, s.
const LOAD: (f64, f64) = (0.1, 0.7);
const PERIOD: f64 = 0.1;
const TRANSITION: f64 = 1e-4;
/// Where the elasto-plastic bristle begins to give, over its reach.
const BREAK_AWAY: f64 = 0.8;

/// The laws with their parameters for a share of the stiffness.
fn laws(points: f64) -> [(&'static str, Friction); 5] {
    let (stiffness, damping) = (BRISTLE.0 / points, BRISTLE.1 / points);
    let bristle = Bristle { mu_static: MU, mu_kinetic: MU, stiffness, damping, ..Bristle::default() };
    let coulomb = RegularisedCoulomb {
        mu_static: MU,
        mu_kinetic: MU,
        stribeck_speed: 1e-3,
        transition_speed: TRANSITION,
        viscous: 0.0,
    };
    let dahl = LuGre::dahl(MU, stiffness);
    let lugre = LuGre { damping, ..dahl };
    [
        ("bristle", bristle.into()),
        ("elasto-plastic", LuGre { break_away: BREAK_AWAY, ..lugre }.into()),
        ("LuGre", lugre.into()),
        ("Dahl", dahl.into()),
        ("regularised Coulomb", coulomb.into()),
    ]
}

fn run(options: &Options) -> Result<Outcome, LabError> {
    let step = options.step.unwrap_or(1e-3);
    let cycles = if options.quick { 500 } else { 10_000 };
    let all = laws(4.0);
    let drifts = std::thread::scope(|scope| {
        let runs: Vec<_> = all.iter().map(|(_, law)| scope.spawn(move || drift(*law, cycles, step))).collect();
        let join =
            |run: std::thread::ScopedJoinHandle<'_, _>| run.join().unwrap_or_else(|p| std::panic::resume_unwind(p));
        runs.into_iter().map(join).collect::<Result<Vec<_>, LabError>>()
    })?;
    let reach = LIMIT / BRISTLE.0;
    let dahl = f64::from(cycles) * reach * ((1.0 - LOAD.0.powi(2)) / (1.0 - LOAD.1.powi(2))).ln();
    let coulomb = f64::from(cycles) * PERIOD * mean_coulomb_speed();
    let net = |k: usize| drifts[k].last().map_or(f64::NAN, |p| p.1);
    let name = |k: usize| format!("{}: net displacement after {cycles} cycles", all[k].0);
    let figures = vec![
        Figure::at_most(name(0), net(0), 1e-9, "m"),
        Figure::at_most(name(1), net(1), 1e-9, "m"),
        // Implicit in a hundred steps per cycle.
        Figure::relative(name(2), net(2), dahl, "m", 0.05),
        Figure::relative(name(3), net(3), dahl, "m", 0.05),
        Figure::relative(name(4), net(4), coulomb, "m", 0.05),
    ];
    let mut chart = Chart::new("Net displacement (below 10⁻¹⁸ m drawn there)", "cycles", "m").logarithmic(true, true);
    for ((name, _), drift) in all.iter().zip(drifts) {
        chart = chart.line(*name, drift.into_iter().map(|(n, x)| (n, x.abs().max(1e-18))).collect());
    }
    let run = record(all[0].1, step)?;
    Ok(Outcome { figures, charts: vec![chart, hysteresis()], run, notes: Vec::new() })
}

/// Mean speed of a body under the load on regularised Coulomb friction, m/s.
fn mean_coulomb_speed() -> f64 {
    let n = 1000;
    let speed = |k: i32| {
        let x = load(PERIOD * (f64::from(k) + 0.5) / f64::from(n)) / LIMIT;
        TRANSITION * x / (1.0 - x * x).sqrt()
    };
    (0..n).map(speed).sum::<f64>() / f64::from(n)
}

/// Load at `t`, N: it starts at its least.
fn load(t: f64) -> f64 {
    let (low, high) = LOAD;
    LIMIT * (0.5 * (low + high) - 0.5 * (high - low) * (2.0 * PI * t / PERIOD).cos())
}

/// Displacement since the end of the settling, after 1, 2, 4, … and all cycles.
fn drift(law: Friction, cycles: u32, step: f64) -> Result<Vec<(f64, f64)>, LabError> {
    let mut rig = rig(law, step)?;
    let place = |rig: &Rig| rig.world.state().q[GANTRY[0]];
    let steps = (PERIOD / step).round() as u64;
    let cycle = |rig: &mut Rig| -> Result<(), LabError> {
        for k in 1..=steps {
            rig.world.commands_mut()[0].effort = load(k as f64 * step);
            rig.advance()?;
        }
        Ok(())
    };
    for _ in 0..10 {
        cycle(&mut rig)?;
    }
    let start = place(&rig);
    let mut points = Vec::new();
    for n in 1..=cycles {
        cycle(&mut rig)?;
        if n.is_power_of_two() || n == cycles {
            points.push((f64::from(n), place(&rig) - start));
        }
    }
    Ok(points)
}

/// Ten cycles on the bristle, to look at.
fn record(law: Friction, step: f64) -> Result<Option<(record::Log, record::Scene)>, LabError> {
    let mut rig = rig(law, step)?;
    let mut film = rig.film((PERIOD / 50.0 / step).ceil() as u64);
    for k in 1..=(10.0 * PERIOD / step) as u64 {
        rig.world.commands_mut()[0].effort = load(k as f64 * step);
        rig.advance()?;
        film.shoot(&rig.world);
    }
    film.develop(&rig)
}

fn rig(law: Friction, step: f64) -> Result<Rig, LabError> {
    let mut bench = gantry_block(EXPERIMENT.name, 1.0, contact_law(POINT, 1e3, law), step);
    bench.add_actuator("load", ActuatorKind::JointEffort { coordinate: GANTRY[0], limit: f64::INFINITY });
    let mut rig = bench.build()?;
    settle_gantry(&mut rig, 1.0, POINT);
    Ok(rig)
}

/// Friction over displacement while a body is moved slowly to and fro by nine tenths of the reach: the laws alone.
fn hysteresis() -> Chart {
    let (reach, n) = (LIMIT / BRISTLE.0, 400);
    let title = "Friction while a body is moved to and fro by 0.9 reaches in 40 ms";
    let mut chart = Chart::new(title, "displacement, reaches", "force against it, μ m g");
    for (name, law) in laws(1.0) {
        let (mut s, mut x0, mut points) = (Vec3::zeros(), 0.0, Vec::new());
        let elapsed = 0.04 / f64::from(n);
        for k in 0..=2 * n {
            let x = 0.9 * reach * (2.0 * PI * f64::from(k) / f64::from(n)).sin();
            let moved = Vec3::x() * (x - x0);
            let brush = law.eval(&Trial {
                s,
                s_trial: s + moved,
                slip: moved / elapsed,
                elapsed,
                normal_force: GRAVITY,
                ..Trial::default()
            });
            (s, x0) = (brush.s, x);
            if k >= n {
                points.push((x / reach, -brush.force.x / LIMIT));
            }
        }
        chart = chart.line(name, points);
    }
    chart
}
