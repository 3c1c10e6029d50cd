//! A capsule pinched between two pads under gravity: does it hold, or sink?
//!
//! The rig that users of MuJoCo complain of (google-deepmind/mujoco issue 3328): 45 g, radius 4 mm, lying across two flat
//! pads, friction 0.7, grip 12 to 60 N: twenty to a hundred and ninety times what its weight asks. With a regularised law
//! the capsule sinks at a speed proportional to its weight: 155 µm/s at the recommended settings, 1.4 µm/s with the
//! no-slip pass (the figures). One pad stands still here and the other is pushed by a constant force, so that
//! the grip is what it is called; `tests/peers/pinch_hold.py` runs the same rig in MuJoCo.
//!
//! With a bristle the weight is held by a deflection, W/(4 k) for the four points, and nothing moves.

use crate::bench::{Bench, Rig};
use crate::scene::{GRAVITY, box_moments, contact_law, joint, link, one_link};
use crate::{Chart, Experiment, Figure, LabError, Options, Outcome};
use contact::Shape;
use friction::Bristle;
use multibody::{Geometry, JointDescription, JointKind, RobotDescription};
use sim::{ActuatorKind, Base};
use spatial::{Pose, Vec3};
use std::f64::consts::FRAC_PI_2;

/// The entry in the catalogue.
pub const EXPERIMENT: Experiment =
    Experiment { name: "pinch-hold", question: "Does a pinched capsule sink through the grip?", run };

const MASS: f64 = 0.045;
const RADIUS: f64 = 4e-3;
const HALF_LENGTH: f64 = 15e-3;
const PAD: [f64; 3] = [0.01, 0.02, 0.02];
const MU: f64 = 0.7;
const STIFFNESS: f64 = 1e6;
/// Slip rates of the issue, m/s.
const PUBLISHED: [(&str, f64); 3] = [
    ("MuJoCo, elliptic, impratio 1 (published)", 1.5e-3),
    ("MuJoCo, elliptic, impratio 10 (published)", 155e-6),
    ("MuJoCo, noslip 10 (published)", 1.4e-6),
];

fn run(options: &Options) -> Result<Outcome, LabError> {
    let step = options.step.unwrap_or(1e-3);
    let hold: f64 = if options.quick { 6.0 } else { 60.0 };
    let mut outcome = Outcome::default();
    let mut chart = Chart::new("Sinking of a pinched capsule", "time, s", "sunk since 1 s, m").logarithmic(true, true);
    for (name, speed) in PUBLISHED {
        let line = (0..=40).map(|k| 0.01 * (hold / 0.01).powf(f64::from(k) / 40.0));
        chart = chart.theory(name, line.map(|t| (t, t * speed)).collect());
    }
    for grip in [12.0, 60.0] {
        let mut rig = build(grip, step)?;
        rig.run((1.0 / step) as u64, |_| {})?;
        let (sag, start) = (-rig.position(1).z, rig.position(1));
        let mut sunk = Vec::new();
        for _ in 0..(hold / 0.01) as u64 {
            rig.run((0.01 / step).round() as u64, |_| {})?;
            // What is below round-off of the position is drawn as 1e-18 m.
            sunk.push((rig.time() - 1.0, (start.z - rig.position(1).z).abs().max(1e-18)));
        }
        let moved = (rig.position(1) - start).norm();
        outcome.figures.extend([
            Figure::at_most(format!("motion in {hold} s at {grip} N"), moved, 1e-6, "m"),
            Figure::shown(format!("slip rate at {grip} N"), moved / hold, 0.0, "m/s"),
            Figure::shown(format!("sag of the closing grip at {grip} N (at least W/4k)"), sag, weight_sag(), "m"),
        ]);
        chart = chart.line(format!("softdock, {grip} N"), sunk);
    }
    outcome.charts.push(chart);
    outcome.notes.push("MuJoCo with the same rig and force: tests/peers/pinch_hold.txt.".to_owned());
    outcome.run = record(step)?;
    Ok(outcome)
}

/// Deflection that holds the weight on four points, m.
fn weight_sag() -> f64 {
    MASS * GRAVITY / (4.0 * STIFFNESS)
}

/// Two pads: one fixed, one on a damped slide towards it.
fn pads() -> RobotDescription {
    let visible = || Some(Geometry::Box { size: 2.0 * Vec3::from(PAD) });
    let slide = |name: &str, parent, x: f64, kind| JointDescription {
        pose_pj: Pose::translation(x, 0.0, 0.0),
        damping: 50.0,
        ..joint(name, parent, -Vec3::x(), kind)
    };
    let x = RADIUS + PAD[0];
    RobotDescription {
        name: "pads".to_owned(),
        file: "pads (built in)".into(),
        links: vec![
            link("frame", 0.0, Vec3::zeros(), None),
            link("left", 0.1, box_moments(0.1, PAD), visible()),
            link("right", 0.1, box_moments(0.1, PAD), visible()),
        ],
        joints: vec![slide("bolt", 0, -x, JointKind::Fixed), slide("close", 0, x, JointKind::Prismatic)],
    }
}

/// The moments of a capsule are nearly those of the cylinder of its whole length.
fn capsule() -> RobotDescription {
    let length = 2.0 * (HALF_LENGTH + RADIUS);
    let across = MASS * (3.0 * RADIUS * RADIUS + length * length) / 12.0;
    let moments = Vec3::new(across, across, 0.5 * MASS * RADIUS * RADIUS);
    one_link("capsule", MASS, moments, Geometry::Capsule { radius: RADIUS, length: 2.0 * HALF_LENGTH })
}

fn build(grip: f64, step: f64) -> Result<Rig, LabError> {
    let mut bench = Bench::new(EXPERIMENT.name, step).gravity([0.0, 0.0, -GRAVITY]);
    let pads = bench.add_vehicle("pads", &pads(), Base::Fixed);
    let body = bench.add_vehicle("capsule", &capsule(), Base::Free);
    for link in [1, 2] {
        bench.add_shape(Some(pads), link, Shape::Cuboid { half_extents: PAD.into() });
    }
    bench.add_shape(Some(body), 0, Shape::Capsule { radius: RADIUS, half_length: HALF_LENGTH });
    let bristle = Bristle { mu_static: MU, mu_kinetic: MU, stiffness: STIFFNESS, damping: 100.0, ..Bristle::default() };
    bench.pair("pads", "capsule", contact_law(STIFFNESS, 100.0, bristle));
    let close = bench.add_actuator("close", ActuatorKind::JointEffort { coordinate: 0, limit: 1e3 });
    let mut rig = bench.build()?;
    rig.world.commands_mut()[close].effort = grip;
    rig.place(body, [0.0; 3], [FRAC_PI_2, 0.0, 0.0]);
    Ok(rig)
}

/// The first second of the hold, to look at.
fn record(step: f64) -> Result<Option<(record::Log, record::Scene)>, LabError> {
    let mut rig = build(12.0, step)?;
    let mut film = rig.film((0.01 / step).ceil() as u64);
    film.shoot(&rig.world);
    for _ in 0..(1.0 / step) as u64 {
        rig.advance()?;
        film.shoot(&rig.world);
    }
    film.develop(&rig)
}
