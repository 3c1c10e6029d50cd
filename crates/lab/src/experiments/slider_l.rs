//! A block that is led round a corner: the friction force must turn with the motion, over the bristle's length.
//!
//! The block is led (1e7 N/m) 10 mm along x, then 10 mm along y. Past the corner the deflection follows the
//! tractrix, tan(θ/2) = e^{−y/s_max}, θ from the motion to the bristle, whatever the speed; its length stays s_max.

use crate::bench::Rig;
use crate::exact::pursuit::calc_turning;
use crate::scene::{GANTRY, GRAVITY, contact_law, gantry_block, settle_gantry};
use crate::{Chart, Experiment, Figure, LabError, Options, Outcome};
use friction::Bristle;
use std::f64::consts::FRAC_PI_2;

/// The entry in the catalogue.
pub const EXPERIMENT: Experiment =
    Experiment { name: "slider-l", question: "How does the friction force turn when the motion turns a corner?", run };

const MU: f64 = 0.4;
const SPEED: f64 = 0.01;
const LEG: f64 = 0.01;
const POINT: f64 = 1e6;
/// Stiffness and damping of the lead: overdamped, so that the block does not swing back at the corner and unload its bristle.
const LEAD: (f64, f64) = (1e7, 1e4);
/// Rest at the corner, s: fifty times the lead's damping over its stiffness.
const PAUSE: f64 = 0.05;
/// Deflection at the bound, m.
const REACH: f64 = 1e-3;

fn run(options: &Options) -> Result<Outcome, LabError> {
    let step = options.step.unwrap_or(1e-4);
    let mut rig = rig(step)?;
    let mut film = rig.film((0.01 / step).ceil() as u64);
    let (mut angle, mut theory, mut path) = (Vec::new(), Vec::new(), Vec::new());
    let (mut worst_angle, mut worst_size) = (0.0_f64, 0.0_f64);
    for k in 1..=((2.0 * LEG / SPEED + PAUSE) / step) as u64 {
        lead(&mut rig, step * k as f64);
        rig.advance()?;
        film.shoot(&rig.world);
        let q = &rig.world.state().q;
        path.push((1e3 * q[0], 1e3 * q[1]));
        if q[1] < 1e-9 {
            continue;
        }
        let force = rig.friction_force();
        let (measured, exact) = ((-force.x).atan2(-force.y), calc_turning(FRAC_PI_2, q[1], REACH));
        worst_angle = worst_angle.max((measured - exact).abs());
        worst_size = worst_size.max((force.norm() / (MU * GRAVITY) - 1.0).abs());
        angle.push((1e3 * q[1], measured.to_degrees()));
        theory.push((1e3 * q[1], exact.to_degrees()));
    }
    // First order in the way per step over the reach, of which it turns by at most half: 1e-6 m of 1e-3 m here.
    let allowed = (0.5 * SPEED * step / REACH).to_degrees();
    let figures = vec![
        Figure::at_most("force's direction off the tractrix, worst", worst_angle.to_degrees(), allowed, "°"),
        Figure::at_most("force's size off μ m g, worst relative", worst_size, 1e-6, "1"),
    ];
    let charts = vec![
        Chart::new("Angle between motion and bristle past the corner", "way past the corner, mm", "angle, °")
            .line("measured", angle)
            .theory("tractrix", theory),
    ];
    let run = film.develop(&rig)?;
    Ok(Outcome { figures, charts, run, notes: Vec::new() })
}

fn rig(step: f64) -> Result<Rig, LabError> {
    let stiffness = MU * GRAVITY / REACH / 4.0;
    let bristle = Bristle { mu_static: MU, mu_kinetic: MU, stiffness, ..Bristle::default() };
    let mut bench = gantry_block(EXPERIMENT.name, 1.0, contact_law(POINT, 1e3, bristle), step);
    bench.add_spring("lead_x", GANTRY[0], LEAD.0, LEAD.1);
    bench.add_spring("lead_y", GANTRY[1], LEAD.0, LEAD.1);
    let mut rig = bench.build()?;
    settle_gantry(&mut rig, 1.0, POINT);
    Ok(rig)
}

/// Commands the place on the L at `t`.
fn lead(rig: &mut Rig, t: f64) {
    let commands = rig.world.commands_mut();
    commands[0].position = (SPEED * t).min(LEG);
    commands[1].position = (SPEED * (t - PAUSE) - LEG).max(0.0);
}
