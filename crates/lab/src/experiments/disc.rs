//! A disc that slides and spins on an area-weighted bed of points: force and torque against the closed form for uniform
//! pressure ([`crate::exact::contensou`]).
//!
//! A stiff drive leads the disc at v, another turns it at ω. Its face is a bed ([`contact::Bed`]), each of whose points carries
//! the share of its area; force and torque about the axis are taken at every instant of a turn. Sliding lowers the resistance
//! to spinning, and spinning that to sliding: the coupling comes out of the points alone.

use crate::bench::{Bench, Rig};
use crate::exact::contensou::calc_disc;
use crate::scene::{GRAVITY, contact_law, joint, link};
use crate::{Chart, Experiment, Figure, LabError, Options, Outcome};
use contact::{Bed, Shape};
use friction::Bristle;
use multibody::{Geometry, JointKind, RobotDescription};
use sim::{ActuatorKind, Base, ShapeSpec};
use spatial::{Pose, Vec3};
use std::f64::consts::PI;

/// The entry in the catalogue.
pub const EXPERIMENT: Experiment = Experiment {
    name: "spinning-disc",
    question: "Does a sliding, spinning disc of many points feel Contensou's force and torque?",
    run,
};

const MU: f64 = 0.4;
const RADIUS: f64 = 0.1;
/// Thickness of the plate that is seen, m.
const PLATE: f64 = 4e-3;
/// Rate of turning, rad/s; the disc slides at ε ω R.
const SPIN: f64 = 5.0;
/// Normal stiffness and reach of the bristles of the whole disc, N/m and m.
const NORMAL: f64 = 4e6;
const REACH: f64 = 1e-5;

fn run(options: &Options) -> Result<Outcome, LabError> {
    let step = options.step.unwrap_or(1e-3);
    let ratios: &[f64] =
        if options.quick { &[0.3, 1.0] } else { &[0.05, 0.2, 0.4, 0.6, 0.8, 1.0, 1.25, 1.6, 2.0, 3.0, 5.0] };
    let counts: &[usize] = if options.quick { &[128, 256] } else { &[8, 16, 32, 64, 128, 256] };
    let mut outcome = Outcome::default();
    let (mut forces, mut torques, mut errors) = (Vec::new(), Vec::new(), Vec::new());
    for &count in counts {
        let (mut mean, mut instant) = ((0.0_f64, 0.0_f64), (0.0_f64, 0.0_f64));
        for &ratio in ratios {
            let (found, exact) = (measure(count, ratio, step)?, calc_disc(ratio));
            mean.0 = mean.0.max((found.mean.0 - exact.0).abs());
            mean.1 = mean.1.max((found.mean.1 - 1.5 * exact.1).abs());
            instant = (instant.0.max(found.worst.0), instant.1.max(found.worst.1));
            if count == 128 {
                forces.push((ratio, found.mean.0));
                torques.push((ratio, found.mean.1));
            }
        }
        outcome.figures.extend(figures(count, mean, instant));
        errors.push((count as f64, mean, instant));
    }
    let fine = || (1..=250).map(|k| 0.02 * f64::from(k));
    outcome.charts = vec![
        Chart::new("A sliding, spinning disc of 128 points", "ε = v/(ω R)", "force over μN, torque over ⅔ μNR")
            .theory("force, closed form", fine().map(|e| (e, calc_disc(e).0)).collect())
            .theory("torque, closed form", fine().map(|e| (e, 1.5 * calc_disc(e).1)).collect())
            .marks("force", forces)
            .marks("torque", torques),
        Chart::new("Worst error of the two curves", "points", "error")
            .logarithmic(true, true)
            .marks("force at any instant, over μN", errors.iter().map(|e| (e.0, e.2.0)).collect())
            .marks("torque at any instant, over ⅔ μNR", errors.iter().map(|e| (e.0, e.2.1)).collect())
            .marks("force, mean over a turn", errors.iter().map(|e| (e.0, e.1.0)).collect())
            .marks("torque, mean over a turn", errors.iter().map(|e| (e.0, e.1.1)).collect()),
    ];
    outcome.run = record(step)?;
    Ok(outcome)
}

/// From 128 points on, the mean over a turn and every instant of it are within 1 %. At an instant a single point that passes
/// the centre of rotation turns its force about, which is one part in `count` that no arrangement avoids.
fn figures(count: usize, mean: (f64, f64), instant: (f64, f64)) -> Vec<Figure> {
    if count < 128 {
        return Vec::new();
    }
    let figure = |what: &str, error: f64| Figure::at_most(format!("{what}, {count} points"), error, 0.01, "1");
    vec![
        figure("force over μN off the curve, mean over a turn", mean.0),
        figure("torque over ⅔ μNR off the curve, mean over a turn", mean.1),
        figure("force over μN off the curve, worst instant", instant.0),
        figure("torque over ⅔ μNR off the curve, worst instant", instant.1),
    ]
}

/// A disc on a slide along x, a lift and a spindle.
fn rig(count: usize, step: f64) -> Result<Rig, LabError> {
    let bare = |name| link(name, 0.0, Vec3::zeros(), None);
    let disc =
        link("disc", 1.0, Vec3::new(3e-3, 3e-3, 5e-3), Some(Geometry::Cylinder { radius: RADIUS, length: PLATE }));
    let robot = RobotDescription {
        name: "disc".to_owned(),
        file: "disc (built in)".into(),
        links: vec![bare("frame"), bare("carriage"), bare("lift"), disc],
        joints: vec![
            joint("along", 0, Vec3::x(), JointKind::Prismatic),
            joint("lift", 1, Vec3::z(), JointKind::Prismatic),
            joint("spin", 2, Vec3::z(), JointKind::Revolute),
        ],
    };
    let bristle = Bristle { mu_static: MU, mu_kinetic: MU, stiffness: MU * GRAVITY / REACH, ..Bristle::default() };
    let mut bench = Bench::new(EXPERIMENT.name, step).gravity([0.0, 0.0, -GRAVITY]);
    bench.add_floor();
    let vehicle = bench.add_vehicle("disc", &robot, Base::Fixed);
    // Its face looks down.
    let (pose_ls, shape) = (Pose::rotation(PI * Vec3::x()), Shape::Bed(Bed::disc(RADIUS, count)));
    bench.spec.shapes.push(ShapeSpec { name: "face".to_owned(), vehicle: Some(vehicle), link: 3, pose_ls, shape });
    bench.pair("floor", "face", contact_law(NORMAL, 4e3, bristle));
    for coordinate in [0, 2] {
        let kind = ActuatorKind::JointDrive { coordinate, stiffness: 0.0, damping: 1e6, limit: f64::INFINITY };
        bench.add_actuator(if coordinate == 0 { "slide" } else { "spin" }, kind);
    }
    let mut rig = bench.build()?;
    rig.world.state_mut().q[1] = -GRAVITY / NORMAL;
    rig.world.refresh();
    Ok(rig)
}

/// Friction force over μN and torque over ⅔ μNR.
#[derive(Clone, Copy, Debug, Default)]
struct Resistance {
    /// Means over a turn.
    mean: (f64, f64),
    /// Largest differences from the closed form over a turn.
    worst: (f64, f64),
}

/// A turn of the disc that slides as fast as its rim turns, to look at.
fn record(step: f64) -> Result<Option<(record::Log, record::Scene)>, LabError> {
    let mut rig = rig(32, step)?;
    let commands = rig.world.commands_mut();
    (commands[0].velocity, commands[1].velocity) = (SPIN * RADIUS, SPIN);
    // In motion from the start: a jump that no step resolves would be the largest entry of the energy account.
    let rates = &mut rig.world.state_mut().v;
    (rates[0], rates[2]) = (SPIN * RADIUS, SPIN);
    rig.world.refresh();
    let mut film = rig.film((0.01 / step).ceil() as u64);
    for _ in 0..(2.0 * PI / SPIN / step) as u64 {
        rig.advance()?;
        film.shoot(&rig.world);
    }
    film.develop(&rig)
}

/// Turns the disc once while it slides.
fn measure(count: usize, ratio: f64, step: f64) -> Result<Resistance, LabError> {
    let mut rig = rig(count, step)?;
    let commands = rig.world.commands_mut();
    (commands[0].velocity, commands[1].velocity) = (ratio * SPIN * RADIUS, SPIN);
    rig.run((0.05 / step) as u64, |_| {})?;
    let steps = (2.0 * PI / SPIN / step).round() as u64;
    let (exact, mut found) = (calc_disc(ratio), Resistance::default());
    for _ in 0..steps {
        rig.advance()?;
        let (force, torque) = resistance(&rig);
        found.mean = (found.mean.0 + force / steps as f64, found.mean.1 + torque / steps as f64);
        let off = ((force - exact.0).abs(), (torque - 1.5 * exact.1).abs());
        found.worst = (found.worst.0.max(off.0), found.worst.1.max(off.1));
    }
    Ok(found)
}

/// At this instant: along the motion over μN, about the axis over ⅔ μNR.
fn resistance(rig: &Rig) -> (f64, f64) {
    let axis = rig.world.link_frame(0, 3).pos;
    let (mut force, mut torque) = (0.0, 0.0);
    for touch in rig.world.touches() {
        let (f, arm) = (touch.force_w, touch.point_w - axis);
        force -= f.x;
        torque -= arm.x * f.y - arm.y * f.x;
    }
    (force / (MU * GRAVITY), 1.5 * torque / (MU * GRAVITY * RADIUS))
}
