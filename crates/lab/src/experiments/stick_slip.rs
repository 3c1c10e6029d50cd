//! Stick–slip of a spring-pulled block with a drop of level at breakaway (Rabinowicz 1951), against the event-exact
//! solution of the same model, bristle included ([`crate::exact::stick_slip`]).
//!
//! Over a grid of stiffness, speed and ratio of levels at ω h = 1e-3, ω² = k/m (1e-4 where the stick is short); the error at
//! 1 ms is shown beside. The
//! spring is part of the implicit step, which damps its swing by about π ω h/2 per slip.

use crate::bench::Rig;
use crate::exact::stick_slip::{Cycle, StickSlip};
use crate::scene::{GANTRY, GRAVITY, contact_law, gantry_block, settle_gantry};
use crate::{Chart, Experiment, Figure, LabError, Options, Outcome};
use friction::Bristle;
use sim::Integrator;
use std::fmt::Write;

/// The entry in the catalogue.
pub const EXPERIMENT: Experiment = Experiment {
    name: "stick-slip",
    question: "Period, amplitude and stick of Rabinowicz's stick–slip: how far from the event-exact solution?",
    run,
};

const MASS: f64 = 1.0;
const WEIGHT: f64 = MASS * GRAVITY;
const MU_KINETIC: f64 = 0.3;
/// One of four points: normal stiffness, bristle's stiffness and damping.
const POINT: f64 = 1e6;
const BRISTLE: (f64, f64) = (2.5e4, 50.0);
/// ω h; and where the pull's share V √(k m) of the swing exceeds a quarter of the drop of force, so that the stick is short.
const RESOLUTION: (f64, f64) = (1e-3, 1e-4);

/// Step for a case, s.
fn calc_step(case: &StickSlip) -> f64 {
    let omega = (case.pull_stiffness / MASS).sqrt();
    let is_fast = case.pull_speed * MASS * omega > 0.25 * (case.bound_static - case.bound_kinetic);
    (if is_fast { RESOLUTION.1 } else { RESOLUTION.0 }) / omega
}

fn run(options: &Options) -> Result<Outcome, LabError> {
    let grid = grid(options.quick);
    let step_of = |case: &StickSlip| options.step.unwrap_or(calc_step(case));
    let fine = measure_all(&grid, Integrator::ImplicitEuler, &step_of)?;
    let coarse = measure_all(&grid, Integrator::ImplicitEuler, &|_| 1e-3)?;
    let midpoint = measure_all(&grid, Integrator::ImplicitMidpoint, &|_| 1e-3)?;
    let mut outcome = Outcome { figures: judged(&grid, &fine), ..Outcome::default() };
    outcome.figures.extend(shown(&grid, &coarse, "1 ms"));
    outcome.figures.extend(shown(&grid, &midpoint, "1 ms, implicit midpoint"));
    let (case, run) = (grid[0], pull(&grid[0], Integrator::ImplicitEuler, step_of(&grid[0]), true)?);
    outcome.figures.extend(presliding(&case, step_of(&case))?);
    outcome.charts = vec![force_chart(&case, &run), error_chart(&grid, &fine, &coarse)];
    outcome.run = run.recorded;
    outcome.notes.push(table(&grid, &fine, &step_of));
    let cases = grid.len();
    outcome.notes.push(format!(
        "{cases} cases: spring {} N/m, pull {} m/s, static over kinetic level {}; kinetic level 0.3, 1 kg.",
        list(&grid, |c| c.pull_stiffness),
        list(&grid, |c| c.pull_speed),
        list(&grid, |c| c.bound_static / c.bound_kinetic)
    ));
    Ok(outcome)
}

/// The values of a quantity that occur in the grid.
fn list(grid: &[StickSlip], of: fn(&StickSlip) -> f64) -> String {
    let mut values: Vec<f64> = grid.iter().map(of).collect();
    values.sort_by(f64::total_cmp);
    values.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    values.iter().map(|v| format!("{}", (v * 1e4).round() / 1e4)).collect::<Vec<_>>().join(", ")
}

fn grid(quick: bool) -> Vec<StickSlip> {
    let (stiffnesses, speeds, ratios): (&[f64], &[f64], &[f64]) = if quick {
        (&[100.0, 400.0], &[0.02], &[1.25, 2.0])
    } else {
        (&[100.0, 400.0, 1600.0], &[0.01, 0.03, 0.1], &[1.25, 1.6, 2.0])
    };
    let mut cases = Vec::new();
    for &pull_stiffness in stiffnesses {
        for &pull_speed in speeds {
            for &ratio in ratios {
                cases.push(StickSlip {
                    mass: MASS,
                    pull_stiffness,
                    pull_speed,
                    bound_static: ratio * MU_KINETIC * WEIGHT,
                    bound_kinetic: MU_KINETIC * WEIGHT,
                    bristle_stiffness: 4.0 * BRISTLE.0,
                    bristle_damping: 4.0 * BRISTLE.1,
                });
            }
        }
    }
    cases
}

/// A time that holds four breakaways.
fn duration(case: &StickSlip) -> f64 {
    let pull_rate = case.pull_stiffness * case.pull_speed;
    let slide = 6.3 / (case.pull_stiffness / MASS).sqrt();
    (case.bound_static + 6.6 * (case.bound_static - case.bound_kinetic)) / pull_rate + 3.5 * slide
}

/// All cases on two threads, in the order of the grid.
fn measure_all(
    grid: &[StickSlip],
    integrator: Integrator,
    step_of: &(dyn Fn(&StickSlip) -> f64 + Sync),
) -> Result<Vec<Cycle>, LabError> {
    let half = grid.len().div_ceil(2);
    let measure = |cases: &[StickSlip]| -> Result<Vec<Cycle>, LabError> {
        cases.iter().map(|c| Ok(pull(c, integrator, step_of(c), false)?.cycle())).collect()
    };
    std::thread::scope(|scope| {
        let other = scope.spawn(|| measure(&grid[half..]));
        let mut cycles = measure(&grid[..half])?;
        cycles.extend(other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))?);
        Ok(cycles)
    })
}

#[derive(Default)]
struct Pull {
    /// Instant and spring force of every breakaway; instant of every stop.
    breaks: Vec<(f64, f64)>,
    stops: Vec<f64>,
    /// Greatest and least spring force since the breakaway before last, and in the whole cycle before.
    extremes: (f64, f64),
    whole: (f64, f64),
    force: Vec<(f64, f64)>,
    recorded: Option<(record::Log, record::Scene)>,
}

impl Pull {
    /// The last whole cycle; NaN where there is none.
    fn cycle(&self) -> Cycle {
        let nan = Cycle { period: f64::NAN, amplitude: f64::NAN, stick: f64::NAN, breakaway: f64::NAN };
        let ([.., first, second], [.., last]) = (self.breaks.as_slice(), self.stops.as_slice()) else { return nan };
        let stop = if *last > second.0 { self.stops[self.stops.len().saturating_sub(2)] } else { *last };
        Cycle {
            period: second.0 - first.0,
            amplitude: 0.5 * (self.whole.0 - self.whole.1),
            stick: second.0 - stop,
            breakaway: second.1,
        }
    }
}

fn rig(case: &StickSlip, integrator: Integrator, step: f64) -> Result<Rig, LabError> {
    let bristle = Bristle {
        mu_static: case.bound_static / WEIGHT,
        mu_kinetic: case.bound_kinetic / WEIGHT,
        stribeck_speed: 0.0,
        stiffness: BRISTLE.0,
        damping: BRISTLE.1,
        ..Bristle::default()
    };
    let mut bench = gantry_block(EXPERIMENT.name, MASS, contact_law(POINT, 1e3, bristle), step).integrator(integrator);
    bench.add_spring("spring", GANTRY[0], case.pull_stiffness, 0.0);
    let mut rig = bench.build()?;
    settle_gantry(&mut rig, MASS, POINT);
    Ok(rig)
}

fn pull(case: &StickSlip, integrator: Integrator, step: f64, keep: bool) -> Result<Pull, LabError> {
    let mut rig = rig(case, integrator, step)?;
    let mut film = rig.film((0.01 / step).ceil() as u64);
    let mut pull = Pull { extremes: (f64::MIN, f64::MAX), ..Pull::default() };
    let mut slid = false;
    for k in 1..=(duration(case) / step) as u64 {
        let t = k as f64 * step;
        rig.world.commands_mut()[0].position = case.pull_speed * t;
        rig.advance()?;
        let force = case.spring_force(t, rig.world.state().q[GANTRY[0]]);
        let slides = rig.world.touches().all(|t| !t.sticks);
        pull.look(t, force, (slid, slides));
        slid = slides;
        if keep {
            pull.force.push((t, force));
            film.shoot(&rig.world);
        }
    }
    if keep {
        pull.recorded = film.develop(&rig)?;
    }
    Ok(pull)
}

impl Pull {
    fn look(&mut self, t: f64, force: f64, (slid, slides): (bool, bool)) {
        if slides && !slid {
            self.breaks.push((t, force));
            self.whole = std::mem::replace(&mut self.extremes, (f64::MIN, f64::MAX));
        }
        if slid && !slides {
            self.stops.push(t);
        }
        self.extremes = (self.extremes.0.max(force), self.extremes.1.min(force));
    }
}

/// Relative error of a cycle's period, amplitude and stick.
fn errors(case: &StickSlip, measured: &Cycle) -> [f64; 3] {
    let nan = Cycle { period: f64::NAN, amplitude: f64::NAN, stick: f64::NAN, breakaway: f64::NAN };
    let exact = case.cycle(duration(case)).unwrap_or(nan);
    [measured.period / exact.period, measured.amplitude / exact.amplitude, measured.stick / exact.stick]
        .map(|r| (r - 1.0).abs())
}

/// Every case of the grid.
fn table(grid: &[StickSlip], measured: &[Cycle], step_of: &dyn Fn(&StickSlip) -> f64) -> String {
    let mut text = String::from(
        "| spring, N/m | pull, m/s | levels | step, µs | period, s | amplitude, N | stick, s | errors, % |\n\
         | --- | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    for (case, cycle) in grid.iter().zip(measured) {
        let [period, amplitude, stick] = errors(case, cycle).map(|e| 100.0 * e);
        let _ = writeln!(
            text,
            "| {} | {} | {:.2} | {:.1} | {:.4} | {:.4} | {:.4} | {period:.2}, {amplitude:.2}, {stick:.2} |",
            case.pull_stiffness,
            case.pull_speed,
            case.bound_static / case.bound_kinetic,
            1e6 * step_of(case),
            cycle.period,
            cycle.amplitude,
            cycle.stick
        );
    }
    text
}

const QUANTITIES: [&str; 3] = ["period", "amplitude", "stick duration"];

/// The worst relative error of all cases must hold; NaN, which never does, if a case has no cycle.
fn judged(grid: &[StickSlip], measured: &[Cycle]) -> Vec<Figure> {
    let worst = |which: usize| {
        let all = grid.iter().zip(measured).map(|(c, m)| errors(c, m)[which]);
        all.fold(0.0, |worst: f64, e| if e > worst || e.is_nan() { e } else { worst })
    };
    let figure = |(which, name): (usize, &str)| {
        Figure::at_most(format!("{name}, worst relative error at ω h ≤ 1e-3"), worst(which), 5e-3, "1")
    };
    QUANTITIES.into_iter().enumerate().map(figure).collect()
}

/// The worst relative error of the cases that have a cycle at all, and how many have none.
fn shown(grid: &[StickSlip], measured: &[Cycle], how: &str) -> Vec<Figure> {
    let errors: Vec<[f64; 3]> = grid.iter().zip(measured).map(|(c, m)| errors(c, m)).collect();
    let worst = |which: usize| errors.iter().map(|e| e[which]).fold(0.0, f64::max);
    let lost = errors.iter().filter(|e| e.iter().any(|x| x.is_nan())).count();
    let mut figures = Vec::new();
    for (which, name) in QUANTITIES.into_iter().enumerate() {
        figures.push(Figure::shown(format!("{name}, worst relative error at {how}"), worst(which), f64::NAN, "1"));
    }
    if lost > 0 {
        let name = format!("cases of {} that slide without stick at {how}", grid.len());
        figures.push(Figure::shown(name, lost as f64, 0.0, "1"));
    }
    figures
}

/// Slope of the spring force over the block's place between 20 % and 80 % of the bound, and the force at breakaway.
fn presliding(case: &StickSlip, step: f64) -> Result<Vec<Figure>, LabError> {
    let mut rig = rig(case, Integrator::ImplicitEuler, step)?;
    let (mut low, mut high, mut at_break) = (None, (0.0, 0.0), f64::NAN);
    for k in 1..=(1.2 * case.bound_static / (case.pull_stiffness * case.pull_speed) / step) as u64 {
        let t = k as f64 * step;
        rig.world.commands_mut()[0].position = case.pull_speed * t;
        rig.advance()?;
        let x = rig.world.state().q[GANTRY[0]];
        let force = case.spring_force(t, x);
        if force > 0.2 * case.bound_static && low.is_none() {
            low = Some((x, force));
        }
        if force < 0.8 * case.bound_static {
            high = (x, force);
        }
        if rig.world.touches().all(|t| !t.sticks) {
            at_break = force;
            break;
        }
    }
    let low = low.unwrap_or((f64::NAN, f64::NAN));
    let stiffness = (high.1 - low.1) / (high.0 - low.0);
    let phases = case.phases(1.2 * case.bound_static / (case.pull_stiffness * case.pull_speed));
    let exact = phases.iter().find(|p| matches!(p.mode, crate::exact::stick_slip::Mode::Sliding(_)));
    let exact = exact.map_or(f64::NAN, |p| case.spring_force(p.start, p.place));
    Ok(vec![
        Figure::relative("pre-sliding stiffness", stiffness, case.bristle_stiffness, "N/m", 1e-3),
        Figure::relative("force at the first breakaway", at_break, exact, "N", 1e-3),
    ])
}

fn force_chart(case: &StickSlip, run: &Pull) -> Chart {
    let phases = case.phases(duration(case));
    let mut exact = Vec::new();
    for phase in &phases {
        for k in 0..40 {
            let t = phase.start + (phase.end - phase.start) * f64::from(k) / 39.0;
            exact.push((t, case.spring_force(t, phase.at(t).0)));
        }
    }
    Chart::new(format!("Spring force: {} N/m, {} m/s", case.pull_stiffness, case.pull_speed), "time, s", "force, N")
        .line("measured", run.force.clone())
        .theory("event-exact", exact)
}

fn error_chart(grid: &[StickSlip], fine: &[Cycle], coarse: &[Cycle]) -> Chart {
    let of = |measured: &[Cycle], which: usize, step: fn(&StickSlip) -> f64| {
        let point = |(c, m): (&StickSlip, &Cycle)| (step(c) * (c.pull_stiffness / MASS).sqrt(), errors(c, m)[which]);
        grid.iter().zip(measured).map(point).collect::<Vec<_>>()
    };
    let mut chart =
        Chart::new("Error against the event-exact solution", "ω h", "relative error").logarithmic(true, true);
    for (which, name) in QUANTITIES.into_iter().enumerate() {
        let mut points = of(fine, which, calc_step);
        points.extend(of(coarse, which, |_| 1e-3));
        chart = chart.marks(name, points);
    }
    chart
}
