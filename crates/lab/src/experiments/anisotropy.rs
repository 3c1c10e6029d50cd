//! A block that is led along straight lines over a brushed floor: level μ along the grain, μ/2 across it.
//!
//! The deflections that hold form an ellipse with the semi-axes a, b = μ_a fₙ/k, μ_b fₙ/k. The slip is along the force (a slip
//! potential that is a circle, so not the associated rule: Michałowski and Mróz 1978), so that sliding along u at the angle φ to
//! the grain ends with
//!
//!   f = −W μ(φ) u/|u|,    1/μ(φ)² = cos² φ/μ_a² + sin² φ/μ_b².
//!
//! Under maximum dissipation the force would lean towards the grain by up to 37°, at tan φ = 2: the chart shows both.

use crate::bench::Rig;
use crate::scene::{GANTRY, GRAVITY, contact_law, gantry_block, settle_gantry};
use crate::{Chart, Experiment, Figure, LabError, Options, Outcome};
use friction::Bristle;
use sim::Grain;
use spatial::Vec3;

/// The entry in the catalogue.
pub const EXPERIMENT: Experiment =
    Experiment { name: "anisotropy", question: "Which way does the friction force of a brushed surface point?", run };

const MU: f64 = 0.4;
const ACROSS: f64 = 0.5;
/// Angle of the grain to x, rad.
const GRAIN: f64 = 0.5;
const POINT: f64 = 1e6;
const SPEED: f64 = 0.01;

fn run(options: &Options) -> Result<Outcome, LabError> {
    let step = options.step.unwrap_or(1e-3);
    let count = if options.quick { 8 } else { 36 };
    let (mut sizes, mut directions, mut worst) = (Vec::new(), Vec::new(), (0.0_f64, 0.0_f64));
    for k in 0..count {
        let phi = 2.0 * std::f64::consts::PI * (f64::from(k) + 0.25) / f64::from(count);
        let (measured, exact) = (lead(phi, step)?.0, calc_force(phi));
        worst.0 = worst.0.max(measured.angle(&exact));
        worst.1 = worst.1.max((measured.norm() / exact.norm() - 1.0).abs());
        sizes.push((phi.to_degrees(), measured.norm()));
        directions.push((phi.to_degrees(), lag(&measured, phi)));
    }
    let fine = || (0..=360).map(f64::from);
    let figures = vec![
        Figure::at_most("force's direction off that of −velocity, worst", worst.0.to_degrees(), 1e-3, "°"),
        Figure::at_most("force's size off the level of its direction, worst relative", worst.1, 1e-5, "1"),
    ];
    let charts = vec![
        Chart::new("Angle from −velocity to the friction force", "angle of the motion to the grain, °", "angle, °")
            .theory("against the velocity", fine().map(|d| (d, 0.0)).collect())
            .theory(
                "maximum dissipation",
                fine().map(|d| (d, lag(&calc_associated(d.to_radians()), d.to_radians()))).collect(),
            )
            .marks("measured", directions),
        Chart::new("Size of the friction force", "angle of the motion to the grain, °", "force, N")
            .theory("level of the direction", fine().map(|d| (d, calc_force(d.to_radians()).norm())).collect())
            .marks("measured", sizes),
    ];
    let run = lead(0.7, step)?.1;
    Ok(Outcome { figures, charts, run, notes: Vec::new() })
}

/// From −velocity to the force, °; both along and across the grain.
fn lag(force: &Vec3, phi: f64) -> f64 {
    let (sin, cos) = phi.sin_cos();
    let (x, y) = (-force.x * cos - force.y * sin, -force.y * cos + force.x * sin);
    y.atan2(x).to_degrees()
}

/// Friction along and across the grain, N.
fn calc_force(phi: f64) -> Vec3 {
    let (sin, cos) = phi.sin_cos();
    -GRAVITY * Vec3::new(cos, sin, 0.0) / (cos / MU).hypot(sin / (MU * ACROSS))
}

/// The same, were the slip normal to the ellipse, N.
fn calc_associated(phi: f64) -> Vec3 {
    let (a, b) = (MU, MU * ACROSS);
    let (sin, cos) = phi.sin_cos();
    let size = (a * cos).hypot(b * sin);
    -GRAVITY * Vec3::new(a * a * cos, b * b * sin, 0.0) / size
}

/// Friction along and across the grain after half a second of motion at `phi` to it, N; and the recording.
fn lead(phi: f64, step: f64) -> Result<(Vec3, Option<(record::Log, record::Scene)>), LabError> {
    let bristle = Bristle { mu_static: MU, mu_kinetic: MU, across: ACROSS, stiffness: 2e4, ..Bristle::default() };
    let mut law = contact_law(POINT, 1e3, bristle);
    law.grain = Some(Grain { on_b: false, axis: Vec3::new(GRAIN.cos(), GRAIN.sin(), 0.0), angle: 0.0 });
    let mut bench = gantry_block(EXPERIMENT.name, 1.0, law, step);
    bench.add_spring("lead_x", GANTRY[0], 1e7, 1e3);
    bench.add_spring("lead_y", GANTRY[1], 1e7, 1e3);
    let mut rig: Rig = bench.build()?;
    settle_gantry(&mut rig, 1.0, POINT);
    let mut film = rig.film((0.01 / step).ceil() as u64);
    let (sin, cos) = (phi + GRAIN).sin_cos();
    for k in 1..=(0.5 / step) as u64 {
        let way = SPEED * step * k as f64;
        let commands = rig.world.commands_mut();
        (commands[0].position, commands[1].position) = (way * cos, way * sin);
        rig.advance()?;
        film.shoot(&rig.world);
    }
    let (force, sin, cos) = (rig.friction_force(), GRAIN.sin(), GRAIN.cos());
    let force = Vec3::new(cos * force.x + sin * force.y, cos * force.y - sin * force.x, 0.0);
    Ok((force, film.develop(&rig)?))
}
