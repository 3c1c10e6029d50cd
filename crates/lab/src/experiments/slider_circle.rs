//! A block that springs pull round a circle: the friction force is opposite to the velocity but for the lag of the bristle.
//!
//! Steady state: the bristle's tip runs on a smaller circle to which the bristle is tangent, so that the force lags behind
//! −velocity by asin(s_max/ρ), ρ the radius of the block's path. With A and B the spring's elongation outward and ahead,
//!
//!   k A − d Ω B = μ m g sin θ − m ρ Ω²,    k B + d Ω A = μ m g cos θ,    R² = (ρ + A)² + B²
//!
//! give ρ for the radius R on which the springs' ends run.

use crate::bench::Rig;
use crate::exact::pursuit::calc_lag;
use crate::scene::{GANTRY, GRAVITY, contact_law, gantry_block, settle_gantry};
use crate::{Chart, Experiment, Figure, LabError, Options, Outcome};
use friction::Bristle;
use sim::World;
use std::f64::consts::PI;

/// The entry in the catalogue.
pub const EXPERIMENT: Experiment = Experiment {
    name: "slider-circle",
    question: "Is friction opposite to the velocity on a circle, within the lag that the bristle's length predicts?",
    run,
};

const MU: f64 = 0.4;
const MASS: f64 = 1.0;
const RADIUS: f64 = 0.03;
const RATE: f64 = 0.5;
const SPRING: (f64, f64) = (500.0, 40.0);
const POINT: f64 = 1e6;
/// Deflection at the bound, m.
const REACH: f64 = 1e-3;
const LIMIT: f64 = MU * MASS * GRAVITY;

fn run(options: &Options) -> Result<Outcome, LabError> {
    let step = options.step.unwrap_or(2e-4);
    let mut rig = rig(step)?;
    let mut film = rig.film((0.02 / step).ceil() as u64);
    let turn = 2.0 * PI / RATE;
    let mut seen = Seen::default();
    for k in 1..=(2.0 * turn / step) as u64 {
        lead(&mut rig.world, k as f64 * step);
        rig.advance()?;
        film.shoot(&rig.world);
        seen.look(&rig, rig.time() > turn);
    }
    let radius = calc_radius();
    let lag = calc_lag(REACH, radius);
    let n = seen.count.max(1.0);
    let figures = vec![
        Figure::relative("radius of the path", seen.radius / n, radius, "m", 1e-3),
        Figure::relative("lag of the force behind −velocity", (seen.lag / n).to_degrees(), lag.to_degrees(), "°", 5e-3),
        Figure::at_most("lag, worst deviation over a turn", (seen.worst(lag)).to_degrees(), 0.02, "°"),
        Figure::at_most("force's size off μ m g, worst relative", seen.worst_size, 1e-6, "1"),
    ];
    let ring = |radius: f64| {
        (0..=360).map(|k| f64::from(k).to_radians()).map(|a| (1e3 * radius * a.cos(), 1e3 * radius * a.sin())).collect()
    };
    let mut path = Chart::new("Path of the block", "x, mm", "y, mm")
        .line("block", seen.path)
        .theory("springs' ends", ring(RADIUS))
        .theory("steady state", ring(radius));
    path.equal_scales = true;
    let mut lags =
        Chart::new("Lag of the friction force behind −velocity", "time, s", "lag, °").line("measured", seen.lags);
    let steady = vec![(0.0, lag.to_degrees()), (2.0 * turn, lag.to_degrees())];
    lags = lags.theory("asin(s_max/ρ)", steady);
    let run = film.develop(&rig)?;
    Ok(Outcome { figures, charts: vec![lags, path], run, notes: Vec::new() })
}

fn rig(step: f64) -> Result<Rig, LabError> {
    let bristle = Bristle { mu_static: MU, mu_kinetic: MU, stiffness: LIMIT / REACH / 4.0, ..Bristle::default() };
    let mut bench = gantry_block(EXPERIMENT.name, MASS, contact_law(POINT, 1e3, bristle), step);
    bench.add_spring("pull_x", GANTRY[0], SPRING.0, SPRING.1);
    bench.add_spring("pull_y", GANTRY[1], SPRING.0, SPRING.1);
    let mut rig = bench.build()?;
    settle_gantry(&mut rig, MASS, POINT);
    rig.world.state_mut().q[GANTRY[0]] = RADIUS;
    Ok(rig)
}

/// The springs' ends at `t`.
fn lead(world: &mut World, t: f64) {
    let (sin, cos) = (RATE * t).sin_cos();
    let commands = world.commands_mut();
    (commands[0].position, commands[1].position) = (RADIUS * cos, RADIUS * sin);
    (commands[0].velocity, commands[1].velocity) = (-RADIUS * RATE * sin, RADIUS * RATE * cos);
}

/// Radius of the block's path in the steady state, by bisection, m.
fn calc_radius() -> f64 {
    let (k, d) = (SPRING.0, SPRING.1 * RATE);
    let excess = |rho: f64| {
        let (sin, cos) = (REACH / rho, (1.0 - (REACH / rho).powi(2)).sqrt());
        let (p, q) = (LIMIT * sin - MASS * rho * RATE * RATE, LIMIT * cos);
        let (a, b) = ((k * p + d * q) / (k * k + d * d), (k * q - d * p) / (k * k + d * d));
        (rho + a).hypot(b) - RADIUS
    };
    let (mut low, mut high) = (2.0 * REACH, RADIUS);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if excess(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[derive(Default)]
struct Seen {
    count: f64,
    radius: f64,
    lag: f64,
    range: Option<(f64, f64)>,
    worst_size: f64,
    lags: Vec<(f64, f64)>,
    path: Vec<(f64, f64)>,
}

impl Seen {
    fn look(&mut self, rig: &Rig, is_steady: bool) {
        let state = rig.world.state();
        let (x, y, u, w) = (state.q[0], state.q[1], state.v[0], state.v[1]);
        let force = -rig.friction_force();
        // From the velocity to the bristle, outward positive on a circle that turns to the left.
        let lag = (force.x * w - force.y * u).atan2(force.x * u + force.y * w);
        self.path.push((1e3 * x, 1e3 * y));
        if u.hypot(w) > 1e-3 {
            self.lags.push((state.time, lag.to_degrees()));
        }
        if !is_steady {
            return;
        }
        self.count += 1.0;
        self.radius += x.hypot(y);
        self.lag += lag;
        let (low, high) = self.range.unwrap_or((lag, lag));
        self.range = Some((low.min(lag), high.max(lag)));
        self.worst_size = self.worst_size.max((force.norm() / LIMIT - 1.0).abs());
    }

    fn worst(&self, lag: f64) -> f64 {
        self.range.map_or(f64::NAN, |(low, high)| (low - lag).abs().max((high - lag).abs()))
    }
}
