//! Static equilibrium: do the contact forces that are reported balance the weight, to round-off?
//!
//! | scene | points | closed form |
//! | --- | --- | --- |
//! | a bar between two pads, one fixed and one pressed with F | 8 | Σ f = −W, Σ r × f = 0; every pad presses with F |
//! | a ball in a corner of three planes, frictionless | 3 | each presses with W/(3 cos β), β between normal and vertical |
//! | the same with friction | 3 | Σ f = −W |
//! | a ball in a groove of two planes | 2 | each presses with W/(2 cos β) |
//! | a ball in a drogue, from 2 mm off its axis | 8 | Σ f = −W |
//! | a capsule probe that leans in a socket: floor, wall and rim | 3 | Σ f = −W, Σ r × f = 0 |
//!
//! The residual is the largest over ten steps after the scene has come to rest.

use crate::bench::{Bench, Rig};
use crate::scene::{GRAVITY, ball_robot, box_moments, box_robot, contact_law, cylinder_robot, joint, link};
use crate::{Chart, Experiment, Figure, LabError, Options, Outcome};
use contact::{Docking, Normal, NormalLaw, Shape};
use friction::Bristle;
use multibody::{Geometry, JointDescription, JointKind, RobotDescription};
use sim::{ActuatorKind, Base, PairLaw, ShapeSpec};
use spatial::{Pose, Rot, Vec3, Wrench};

/// The entry in the catalogue.
pub const EXPERIMENT: Experiment =
    Experiment { name: "force-balance", question: "Do the forces on a body at rest add up to nothing?", run };

const MASS: f64 = 1.0;
const WEIGHT: f64 = MASS * GRAVITY;
const RADIUS: f64 = 0.05;
const PAD: [f64; 3] = [0.01, 0.02, 0.02];
const BAR: [f64; 3] = [0.02, 0.1, 0.015];
const GRIP: f64 = 60.0;
/// Newtons, and newton-metres of bodies of some centimetres.
const BALANCE: f64 = 1e-9;

fn run(options: &Options) -> Result<Outcome, LabError> {
    let step = options.step.unwrap_or(1e-3);
    let mut outcome = Outcome::default();
    let mut curves = vec![add_bar(&mut outcome, step)?];
    curves.extend(add_hollows(&mut outcome, step)?);
    curves.extend(add_docked(&mut outcome, step)?);
    let chart = Chart::new("Residual force on the way to rest", "time, s", "|Σ f + W|, N").logarithmic(false, true);
    outcome.charts.push(curves.into_iter().fold(chart, |chart, (name, points)| chart.line(name, points)));
    outcome.run = record(step)?;
    Ok(outcome)
}

/// Name and residual force over time.
type Residual = (String, Vec<(f64, f64)>);

fn add_bar(outcome: &mut Outcome, step: f64) -> Result<Residual, LabError> {
    let bar = follow(build_bar(step)?, 1, 3.0)?;
    add_balance(outcome, "bar between two pads", &bar);
    outcome.figures.extend([
        Figure::absolute("bar between two pads: points", bar.points as f64, 8.0, "1", 0.0),
        Figure::absolute("bar between two pads: force of the fixed pad", bar.forces[0], GRIP, "N", BALANCE),
    ]);
    Ok(("bar between two pads".to_owned(), bar.residual))
}

fn add_hollows(outcome: &mut Outcome, step: f64) -> Result<Vec<Residual>, LabError> {
    let slope = 40.0_f64.to_radians();
    let mut curves = Vec::new();
    for (name, planes, mu) in [("corner", 3, 0.0), ("corner with friction", 3, 0.4), ("groove", 2, 0.0)] {
        let rest = follow(build_planes(planes, slope, mu, step)?, 0, 3.0)?;
        add_balance(outcome, &format!("ball in a {name}"), &rest);
        let expected = WEIGHT / (planes as f64 * slope.cos());
        for (k, force) in rest.forces.iter().enumerate().filter(|_| mu == 0.0) {
            let name = format!("ball in a {name}: force of plane {}", k + 1);
            outcome.figures.push(Figure::absolute(name, *force, expected, "N", BALANCE));
        }
        curves.push((format!("ball in a {name}"), rest.residual));
    }
    Ok(curves)
}

fn add_docked(outcome: &mut Outcome, step: f64) -> Result<Vec<Residual>, LabError> {
    let mut curves = Vec::new();
    for (name, rig, points) in
        [("ball in a drogue", build_drogue(step)?, 8.0), ("leaning probe", build_probe(step)?, 3.0)]
    {
        let rest = follow(rig, 0, 20.0)?;
        add_balance(outcome, name, &rest);
        outcome.figures.push(Figure::absolute(format!("{name}: points"), rest.points as f64, points, "1", 0.0));
        curves.push((name.to_owned(), rest.residual));
    }
    Ok(curves)
}

/// What a scene at rest showed.
#[derive(Debug, Default)]
struct Rest {
    force: f64,
    moment: f64,
    points: usize,
    /// Normal force by pair, N.
    forces: Vec<f64>,
    residual: Vec<(f64, f64)>,
}

fn add_balance(outcome: &mut Outcome, name: &str, rest: &Rest) {
    outcome.figures.extend([
        Figure::at_most(format!("{name}: residual force"), rest.force, BALANCE, "N"),
        Figure::at_most(format!("{name}: residual moment"), rest.moment, BALANCE, "N·m"),
    ]);
}

/// Lets a scene come to rest and adds up what acts on a vehicle's only body.
fn follow(mut rig: Rig, vehicle: usize, duration: f64) -> Result<Rest, LabError> {
    let mut rest = Rest::default();
    let body = rig.world.model().vehicles[vehicle].body0;
    let step = rig.world.model().step;
    let steps = (duration / step) as u64;
    for k in 0..steps {
        let centre = rig.position(vehicle);
        rig.advance()?;
        let total = sum_wrench(&rig, body, &centre);
        if k % 10 == 0 {
            rest.residual.push((rig.time(), total.force.norm().max(1e-16)));
        }
        if k + 10 >= steps {
            rest.force = rest.force.max(total.force.norm());
            rest.moment = rest.moment.max(total.moment.norm());
        }
    }
    rest.points = rig.world.touches().filter(|t| t.normal_force > 0.0).count();
    rest.forces = vec![0.0; rig.world.model().scene.pairs().len()];
    rig.world.touches().for_each(|t| rest.forces[t.pair] += t.normal_force);
    Ok(rest)
}

/// Weight and contact forces on a body, about the centre of mass that it had when they were found.
fn sum_wrench(rig: &Rig, body: usize, centre: &Vec3) -> Wrench {
    let mut total = Wrench::new(Vec3::zeros(), Vec3::new(0.0, 0.0, -WEIGHT));
    for touch in rig.world.touches() {
        let (a, b) = rig.world.model().pair_bodies(touch.pair);
        let sign = f64::from(i8::from(b == body) - i8::from(a == body));
        total += Wrench::from_force_at(sign * touch.force_w, &(touch.point_w - centre));
    }
    total
}

fn law(mu: f64) -> PairLaw {
    if mu == 0.0 {
        let law = NormalLaw::SpringDamper { stiffness: 1e6, damping: 1e3 };
        return PairLaw::new(Normal::new(law), None);
    }
    contact_law(1e6, 1e3, Bristle { mu_static: mu, mu_kinetic: mu, stiffness: 1e6, damping: 1e3, ..Bristle::default() })
}

/// Two pads: one fixed, one on a damped slide towards it.
fn pads() -> RobotDescription {
    let visible = || Some(Geometry::Box { size: 2.0 * Vec3::from(PAD) });
    let slide = |name: &str, x: f64, kind| JointDescription {
        pose_pj: Pose::translation(x, 0.0, 0.0),
        damping: 50.0,
        ..joint(name, 0, -Vec3::x(), kind)
    };
    let x = BAR[0] + PAD[0];
    RobotDescription {
        name: "pads".to_owned(),
        file: "pads (built in)".into(),
        links: vec![
            link("frame", 0.0, Vec3::zeros(), None),
            link("left", 0.1, box_moments(0.1, PAD), visible()),
            link("right", 0.1, box_moments(0.1, PAD), visible()),
        ],
        joints: vec![slide("bolt", -x, JointKind::Fixed), slide("close", x, JointKind::Prismatic)],
    }
}

/// The bar a millimetre off the pads' middle, so that nothing balances by symmetry.
fn build_bar(step: f64) -> Result<Rig, LabError> {
    let mut bench = Bench::new(EXPERIMENT.name, step).gravity([0.0, 0.0, -GRAVITY]);
    let pads = bench.add_vehicle("pads", &pads(), Base::Fixed);
    let bar = bench.add_vehicle("bar", &box_robot(MASS, BAR), Base::Free);
    for link in [1, 2] {
        bench.add_shape(Some(pads), link, Shape::Cuboid { half_extents: PAD.into() });
    }
    bench.add_shape(Some(bar), 0, Shape::Cuboid { half_extents: BAR.into() });
    bench.pair("pads", "bar", law(0.7));
    let close = bench.add_actuator("close", ActuatorKind::JointEffort { coordinate: 0, limit: 1e3 });
    let mut rig = bench.build()?;
    rig.world.commands_mut()[close].effort = GRIP;
    rig.place(bar, [0.0, 1e-3, 0.0], [0.0; 3]);
    Ok(rig)
}

/// A ball in a hollow of planes that lean by `slope` from the level, evenly about the vertical.
fn build_planes(planes: usize, slope: f64, mu: f64, step: f64) -> Result<Rig, LabError> {
    let mut bench = Bench::new(EXPERIMENT.name, step).gravity([0.0, 0.0, -GRAVITY]);
    for k in 0..planes {
        let heading = std::f64::consts::TAU * k as f64 / planes as f64;
        let turn = Rot::from_scaled_axis(Vec3::z() * heading) * Rot::from_scaled_axis(Vec3::y() * slope);
        let pose_ls = Pose::from_parts(Vec3::zeros().into(), turn);
        let name = "plane".to_owned();
        bench.spec.shapes.push(ShapeSpec { name, vehicle: None, link: 0, pose_ls, shape: Shape::HalfSpace });
    }
    let ball = bench.add_vehicle("ball", &ball_robot(MASS, RADIUS), Base::Free);
    bench.add_shape(Some(ball), 0, Shape::Ball { radius: RADIUS });
    bench.pair("plane", "ball", law(mu));
    let mut rig = bench.build()?;
    rig.place(ball, [0.0, 0.0, RADIUS / slope.cos() + 1e-4], [0.0; 3]);
    Ok(rig)
}

/// A body with this shape in a docking shape that stands in the world.
fn build_docked(
    (fixed, moving): (Docking, Shape),
    robot: &RobotDescription,
    mu: f64,
    step: f64,
) -> Result<Rig, LabError> {
    let mut bench = Bench::new(EXPERIMENT.name, step).gravity([0.0, 0.0, -GRAVITY]);
    let (name, pose_ls, shape) = ("port".to_owned(), Pose::identity(), Shape::Docking(fixed));
    bench.spec.shapes.push(ShapeSpec { name, vehicle: None, link: 0, pose_ls, shape });
    let body = bench.add_vehicle("probe", robot, Base::Free);
    bench.add_shape(Some(body), 0, moving);
    let bristle = Bristle { mu_static: mu, mu_kinetic: mu, stiffness: 1e5, damping: 100.0, ..Bristle::default() };
    bench.pair("port", "probe", contact_law(1e5, 300.0, bristle));
    bench.build()
}

/// Beside the axis, where one point bears it: it slides and rolls home.
fn build_drogue(step: f64) -> Result<Rig, LabError> {
    const HALF_ANGLE: f64 = 0.7;
    let drogue = Docking::InnerCone { half_angle: HALF_ANGLE, depth: 0.14, throat_radius: 0.02, wall: 0.01 };
    let seat = (RADIUS / HALF_ANGLE.cos() - 0.02) / HALF_ANGLE.tan() - 0.14;
    let mut rig = build_docked((drogue, Shape::Ball { radius: RADIUS }), &ball_robot(MASS, RADIUS), 0.5, step)?;
    rig.place(0, [2e-3, 1e-3, seat + 3e-3], [0.0; 3]);
    Ok(rig)
}

/// Its lower end on the floor and at the wall, its side on the rim.
fn build_probe(step: f64) -> Result<Rig, LabError> {
    const TILT: f64 = -0.62;
    let socket = Docking::InnerCylinder { radius: 0.06, depth: 0.1, wall: 0.012, floor: true };
    let probe = Shape::Capsule { radius: 0.02, half_length: 0.1 };
    let mut rig = build_docked((socket, probe), &cylinder_robot(MASS, 0.02, 0.24), 0.2, step)?;
    let (sin, cos) = TILT.sin_cos();
    rig.place(0, [0.04 + 0.1 * sin, 0.0, -0.08 + 0.1 * cos + 2e-4], [0.0, TILT, 0.0]);
    Ok(rig)
}

fn record(step: f64) -> Result<Option<(record::Log, record::Scene)>, LabError> {
    let mut rig = build_bar(step)?;
    let mut film = rig.film((0.005 / step).ceil() as u64);
    film.shoot(&rig.world);
    for _ in 0..(0.5 / step) as u64 {
        rig.advance()?;
        film.shoot(&rig.world);
    }
    film.develop(&rig)
}
