//! 0.5 s around the closing of a grasp: a free gripper of 20 kg closes two fingers on a bar of 2 kg that tumbles with it.
//!
//! The reference, RK4 at 1 µs, takes half a minute; it is kept in `tests/baselines/lab-grasp.csv` and written anew by
//! `cargo test -p softdock-lab grasp_reference -- --ignored`.

use super::{CANDIDATES, Track, calc_error};
use crate::bench::{Bench, Rig};
use crate::scene::{box_moments, box_robot, contact_law, joint, link};
use crate::{Chart, Figure, LabError, Options, Outcome};
use contact::Shape;
use friction::Bristle;
use multibody::{Geometry, JointDescription, JointKind, RobotDescription};
use sim::{ActuatorKind, Base, Command, Integrator};
use spatial::{Pose, Twist, Vec3, log_rotation};

const REFERENCE: &str = include_str!("../../../../../tests/baselines/lab-grasp.csv");
/// Seconds between two samples, and their number.
const SAMPLE: f64 = 5e-3;
const SAMPLES: usize = 100;
const PAD: [f64; 3] = [0.01, 0.03, 0.025];
const BAR: [f64; 3] = [0.05, 0.04, 0.06];

fn gripper() -> RobotDescription {
    let finger = |name| link(name, 0.5, box_moments(0.5, PAD), Some(Geometry::Box { size: 2.0 * Vec3::from(PAD) }));
    let slide = |name, x: f64| JointDescription {
        pose_pj: Pose::translation(x, 0.0, 0.3),
        ..joint(name, 0, Vec3::x() * -x.signum(), JointKind::Prismatic)
    };
    let palm = link("palm", 20.0, Vec3::new(0.8, 0.7, 0.6), Some(Geometry::Box { size: Vec3::new(0.2, 0.2, 0.2) }));
    RobotDescription {
        name: "gripper".to_owned(),
        file: "gripper (built in)".into(),
        links: vec![palm, finger("left"), finger("right")],
        joints: vec![slide("close_left", -0.09), slide("close_right", 0.09)],
    }
}

/// Fingers a millimetre off the bar and closing with 20 N, the bar a little faster than the gripper.
fn build(integrator: Integrator, step: f64) -> Result<Rig, LabError> {
    let mut bench = Bench::new("integrators", step).integrator(integrator);
    let hand = bench.add_vehicle("gripper", &gripper(), Base::Free);
    let bar = bench.add_vehicle("bar", &box_robot(2.0, BAR), Base::Free);
    for finger in [1, 2] {
        bench.add_shape(Some(hand), finger, Shape::Cuboid { half_extents: PAD.into() });
    }
    bench.add_shape(Some(bar), 0, Shape::Cuboid { half_extents: BAR.into() });
    let bristle = Bristle { mu_static: 0.5, mu_kinetic: 0.5, stiffness: 5e4, damping: 30.0, ..Bristle::default() };
    bench.pair("gripper", "bar", contact_law(5e4, 50.0, bristle));
    for coordinate in [0, 1] {
        let kind = ActuatorKind::JointDrive { coordinate, stiffness: 2e3, damping: 100.0, limit: 50.0 };
        bench.add_actuator(&format!("close{coordinate}"), kind);
    }
    let mut rig = bench.build()?;
    rig.place(bar, [0.0, 0.0, 0.3], [0.0; 3]);
    let state = rig.world.state_mut();
    state.q[..2].fill(0.029);
    state.commands.fill(Command { position: 0.04, ..Command::default() });
    let twist = |ang: [f64; 3], lin: [f64; 3]| Twist::new(ang.into(), lin.into());
    rig.throw(&[twist([0.05, 0.1, -0.03], [0.0; 3]), twist([0.06, 0.1, -0.02], [0.03, 0.01, 0.005])]);
    Ok(rig)
}

fn sample(rig: &Rig) -> Vec<f64> {
    let (pose, q) = (rig.world.state().bases[1], &rig.world.state().q);
    let (place, turn) = (pose.translation.vector, log_rotation(&pose.rotation));
    place.iter().chain(turn.iter()).chain(&q[..2]).copied().collect()
}

fn close(integrator: Integrator, step: f64) -> Result<Track, LabError> {
    let mut rig = build(integrator, step)?;
    let every = (SAMPLE / step).round() as u64;
    let mut track = Vec::with_capacity(SAMPLES);
    for _ in 0..SAMPLES {
        rig.run(every, |_| {})?;
        track.push(sample(&rig));
    }
    Ok(track)
}

/// The committed reference; empty if the file does not read.
fn reference() -> Track {
    let row = |line: &str| line.split(',').skip(1).map(str::parse).collect::<Result<Vec<f64>, _>>();
    REFERENCE.lines().skip(1).map(row).collect::<Result<Track, _>>().unwrap_or_default()
}

pub(super) fn add_grasp(outcome: &mut Outcome, options: &Options) -> Result<(), LabError> {
    let reference = reference();
    let mut chart = Chart::new("Bar in the closing grasp: distance from RK4 at 1 µs", "time, s", "distance, m")
        .logarithmic(false, true);
    for (name, integrator, step) in CANDIDATES {
        if options.quick && step < 1e-4 {
            continue;
        }
        let track = close(integrator, step)?;
        outcome.figures.extend([
            Figure::shown(format!("grasp, {name}: place of the bar"), calc_error(&track, &reference, 0..3), 0.0, "m"),
            Figure::shown(format!("grasp, {name}: attitude"), calc_error(&track, &reference, 3..6), 0.0, "rad"),
            Figure::shown(format!("grasp, {name}: fingers"), calc_error(&track, &reference, 6..8), 0.0, "m"),
        ]);
        let off = |(k, (a, b)): (usize, (&Vec<f64>, &Vec<f64>))| {
            let distance = (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
            (SAMPLE * (k + 1) as f64, distance.max(1e-12))
        };
        chart = chart.line(name, track.iter().zip(&reference).enumerate().map(off).collect());
    }
    outcome.charts.push(chart);
    Ok(())
}

/// The grasp at 1 ms, to look at.
pub(super) fn record() -> Result<Option<(record::Log, record::Scene)>, LabError> {
    let mut rig = build(Integrator::ImplicitEuler, 1e-3)?;
    let mut film = rig.film(5);
    film.shoot(&rig.world);
    for _ in 0..500 {
        rig.advance()?;
        film.shoot(&rig.world);
    }
    film.develop(&rig)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fmt::Write as _;

    /// Place of the bar, its rotation vector, both fingers.
    const COLUMNS: &str = "time_s,x_m,y_m,z_m,turn_x_rad,turn_y_rad,turn_z_rad,left_m,right_m";

    #[test]
    #[ignore = "writes the committed reference: half a minute"]
    #[allow(clippy::unwrap_used)]
    fn grasp_reference() {
        let mut text = format!("{COLUMNS}\n");
        for (k, row) in close(Integrator::RungeKutta4, super::super::FINE).unwrap().iter().enumerate() {
            let cells: Vec<String> = row.iter().map(|x| format!("{x:.12e}")).collect();
            writeln!(text, "{:.3},{}", SAMPLE * (k + 1) as f64, cells.join(",")).unwrap();
        }
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/baselines/lab-grasp.csv");
        std::fs::write(file, text).unwrap();
    }

    #[test]
    fn reference_is_whole() {
        assert!(REFERENCE.starts_with(COLUMNS));
        let reference = reference();
        assert_eq!((reference.len(), reference[0].len()), (SAMPLES, 8));
    }
}
