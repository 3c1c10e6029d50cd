//! A block of 1 kg that a spring of 100 N/m pulls at 0.01 m/s for 30 s: μ = 0.4, one level, 1 ms.
//!
//! Exact Coulomb friction: break-away at t_b = μ m g/(k V) = 3.924 s; then, undamped, ẋ = V (1 − cos ω(t − t_b)), so that
//!
//!   the speed passes V/2 at t_b + π/3ω,   the spring's peak is μ m g + V √(k m),   zero speed is touched every 2π/ω
//!
//! The bristle adds its stretch: below breakaway x = k V t/(k + K). The spring's force is that of the start of each step, as
//! in the other simulators that ran the same job.

use super::peers::{PEERS, Peer};
use crate::bench::{Film, Rig};
use crate::scene::{GANTRY, GRAVITY, gantry_block, settle_gantry, stiff_contact};
use crate::{Chart, Experiment, Figure, LabError, Options, Outcome};
use sim::ActuatorKind;
use std::f64::consts::PI;
use std::fmt::Write;

/// The entry in the catalogue.
pub const EXPERIMENT: Experiment = Experiment {
    name: "slider-line",
    question: "When does a spring-pulled block break away, and what does it do before and after, beside other simulators?",
    run,
};

const MU: f64 = 0.4;
const MASS: f64 = 1.0;
const SPRING: f64 = 100.0;
const SPEED: f64 = 0.01;
/// Stiffness of one of the four points, N/m.
const POINT: f64 = 1e6;
const LIMIT: f64 = MU * MASS * GRAVITY;

fn run(options: &Options) -> Result<Outcome, LabError> {
    let step = options.step.unwrap_or(1e-3);
    let mut outcome = Outcome::default();
    let creep = measure_creep(step)?;
    outcome.figures.push(Figure::at_most("creep at 50 % of the limit, 8 s", creep, 1e-12, "m/s"));
    let pull = pull(step)?;
    let (breakaway, omega) = (LIMIT / (SPRING * SPEED), (SPRING / MASS).sqrt());
    let (onset, peak) = (breakaway + PI / (3.0 * omega), LIMIT + SPEED * (SPRING * MASS).sqrt());
    let departures = 1.0 + ((30.0 - breakaway) * omega / (2.0 * PI)).floor();
    let stretch = SPRING * SPEED * pull.early.0 / (SPRING + 4.0 * POINT);
    outcome.figures.extend([
        Figure::relative("displacement at 90 % of the break-away time", pull.early.1, stretch, "m", 2e-3),
        // Two steps: one of the pull, one of the count.
        Figure::absolute("break-away", pull.breakaway, breakaway, "s", 2.0 * step),
        Figure::absolute("speed passes 5 mm/s", pull.onset, onset, "s", 2.0 * step),
        Figure::relative("greatest spring force", pull.peak, peak, "N", 1e-3),
        Figure::absolute("departures from below 1 mm/s in 30 s", f64::from(pull.departures), departures, "1", 1.0),
    ]);
    outcome.charts = charts(&pull, creep, step);
    outcome.notes.push(peer_table(&pull, creep));
    outcome.notes.push("Other simulators: measured beforehand on the same job, see the source.".to_owned());
    outcome.run = pull.recorded;
    Ok(outcome)
}

fn rig(step: f64) -> Result<Rig, LabError> {
    let mut bench = gantry_block(EXPERIMENT.name, MASS, stiff_contact(MU), step);
    bench.add_actuator("spring", ActuatorKind::JointEffort { coordinate: GANTRY[0], limit: f64::INFINITY });
    let mut rig = bench.build()?;
    settle_gantry(&mut rig, MASS, POINT);
    rig.run((2.0 / step) as u64, |_| {})?;
    Ok(rig)
}

fn place(rig: &Rig) -> f64 {
    rig.world.state().q[GANTRY[0]]
}

/// Mean speed from 2 to 10 s under half the limit, m/s.
fn measure_creep(step: f64) -> Result<f64, LabError> {
    let mut rig = rig(step)?;
    rig.world.commands_mut()[0].effort = 0.5 * LIMIT;
    rig.run((2.0 / step) as u64, |_| {})?;
    let (start, from) = (place(&rig), rig.time());
    rig.run((8.0 / step) as u64, |_| {})?;
    Ok((place(&rig) - start) / (rig.time() - from))
}

#[derive(Default)]
struct Pull {
    /// Time of the pull and displacement at 90 % of the break-away time.
    early: (f64, f64),
    breakaway: f64,
    onset: f64,
    peak: f64,
    departures: u32,
    /// Spring force, and speed, over time.
    force: Vec<(f64, f64)>,
    speed: Vec<(f64, f64)>,
    recorded: Option<(record::Log, record::Scene)>,
}

fn pull(step: f64) -> Result<Pull, LabError> {
    let mut rig = rig(step)?;
    let start = place(&rig);
    let mut film = rig.film((0.02 / step).ceil() as u64);
    let mut pull = Pull { breakaway: f64::NAN, onset: f64::NAN, ..Pull::default() };
    let mut is_slow = true;
    for k in 0..(30.0 / step) as u64 {
        let force = SPRING * (SPEED * k as f64 * step - (place(&rig) - start));
        rig.world.commands_mut()[0].effort = force;
        rig.advance()?;
        pull.look(&rig, k as f64 * step, force, start);
        let speed = rig.world.state().v[GANTRY[0]].abs();
        pull.departures += u32::from(is_slow && speed >= 0.1 * SPEED);
        is_slow = speed < 0.1 * SPEED;
        Film::shoot(&mut film, &rig.world);
    }
    pull.recorded = film.develop(&rig)?;
    Ok(pull)
}

impl Pull {
    fn look(&mut self, rig: &Rig, t: f64, force: f64, start: f64) {
        let speed = rig.world.state().v[GANTRY[0]];
        if t <= 0.9 * LIMIT / (SPRING * SPEED) {
            self.early = (t, place(rig) - start);
        }
        if self.breakaway.is_nan() && rig.world.touches().all(|t| !t.sticks) {
            self.breakaway = t;
        }
        if self.onset.is_nan() && speed > 0.5 * SPEED {
            self.onset = t;
        }
        self.peak = self.peak.max(force);
        self.force.push((t, force));
        self.speed.push((t, speed));
    }
}

fn charts(pull: &Pull, creep: f64, step: f64) -> Vec<Chart> {
    let omega = (SPRING / MASS).sqrt();
    let breakaway = LIMIT / (SPRING * SPEED);
    let exact = |t: f64| {
        let since = t - breakaway;
        if since < 0.0 { SPRING * SPEED * t } else { LIMIT + SPRING * SPEED / omega * (omega * since).sin() }
    };
    let early = |points: &[(f64, f64)]| points.iter().copied().filter(|p| p.0 <= 8.0).collect::<Vec<_>>();
    let theory = (0..=800).map(|k| 0.01 * f64::from(k)).map(|t| (t, exact(t))).collect();
    let family = |prefix: &str| {
        let mine = PEERS.iter().filter(|p| p.name.starts_with(prefix));
        mine.map(|p| (p.creep.abs().max(CREEP_FLOOR), p.presliding.abs())).collect::<Vec<_>>()
    };
    let mut comparison = Chart::new(
        "Creep at half the limit and pre-sliding of the simulators (below 10⁻²⁰ m/s drawn there)",
        "creep, m/s",
        "displacement at 90 % of break-away, m",
    )
    .logarithmic(true, true)
    .marks("softdock", vec![(creep.abs().max(CREEP_FLOOR), pull.early.1.abs())]);
    for name in ["Drake", "MuJoCo", "PyBullet", "rapier"] {
        comparison = comparison.marks(name, family(name));
    }
    vec![
        Chart::new(format!("Spring force, step {} ms", 1e3 * step), "time, s", "force, N")
            .line("measured", early(&pull.force))
            .theory("exact Coulomb", theory),
        comparison,
    ]
}

/// Where a creep of round-off is drawn on a logarithmic axis, m/s.
const CREEP_FLOOR: f64 = 1e-20;

/// This run and the other simulators' as a Markdown table.
fn peer_table(pull: &Pull, creep: f64) -> String {
    let own = Peer {
        name: "softdock (this run)",
        creep,
        presliding: pull.early.1,
        peak: pull.peak,
        onset: pull.onset,
        departures: pull.departures,
    };
    let mut text = String::from(
        "| simulator | creep at 50 %, m/s | displacement at 90 %, m | peak, N | 5 mm/s at, s | departures |\n\
         | --- | --- | --- | --- | --- | --- |\n",
    );
    for p in std::iter::once(&own).chain(&PEERS) {
        let _ = writeln!(
            text,
            "| {} | {:.2e} | {:.2e} | {:.3} | {:.3} | {} |",
            p.name, p.creep, p.presliding, p.peak, p.onset, p.departures
        );
    }
    text
}
