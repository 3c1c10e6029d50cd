//! A square peg in a slot and a round one in a bore: when a push jams it, and when it stays wedged after the push is gone.
//!
//! Two-point contact as in [`crate::exact::peg`]: the peg leans, its tip's corner on one wall, the mouth's edge on its
//! flank. A push P along the walls acts at an offset e from the peg's axis (two thrusters whose shares move), far off at
//! first: the peg jams. Then e falls slowly, and the offset at which the peg starts to slide in is the measured e*.
//! For the inner force the peg is jammed at λ = 0.7 and at λ = 1.4, and the push is taken away: only where each contact point
//! sees the other within its friction cone (λ < 1) does the peg stay wedged.

use crate::bench::{Bench, Rig};
use crate::exact::peg::Peg;
use crate::scene::{box_robot, contact_law, cylinder_robot};
use crate::{Chart, Experiment, Figure, LabError, Options, Outcome};
use contact::{Docking, Shape};
use friction::Bristle;
use multibody::{Geometry, Visual};
use sim::{ActuatorKind, Base, ShapeSpec, World};
use spatial::{Pose, Vec3};

/// The entry in the catalogue.
pub const EXPERIMENT: Experiment =
    Experiment { name: "wedging-peg", question: "When does a peg jam in its bore, and when does it stay wedged?", run };

const HALF_WIDTH: f64 = 0.02;
const CLEARANCE: f64 = 1e-4;
const HALF_LENGTH: f64 = 0.06;
/// By which the bore's mouth is rounded, m: half its wall.
const LIP: f64 = 5e-3;
const PUSH: f64 = 20.0;
/// Half the distance between the thrusters, m: larger than every offset.
const SPAN: f64 = 1.0;
const STIFFNESS: f64 = 1e7;

fn run(options: &Options) -> Result<Outcome, LabError> {
    let step = options.step.unwrap_or(1e-3);
    let mut outcome = Outcome::default();
    let (slot, bore): (&[_], &[_]) = if options.quick {
        (&[(0.03, 0.2), (0.03, 0.5)], &[(0.03, 0.3)])
    } else {
        let slot =
            &[(0.02, 0.1), (0.03, 0.1), (0.04, 0.2), (0.03, 0.2), (0.02, 0.2), (0.03, 0.3), (0.03, 0.5), (0.05, 0.5)];
        (slot, &[(0.03, 0.2), (0.03, 0.3), (0.04, 0.5)])
    };
    let square = add_offsets(&mut outcome, ("square peg", slot, 0.0), step)?;
    let round = add_offsets(&mut outcome, ("round peg", bore, LIP), step)?;
    let line = (0..=55).map(|k| 0.1 * f64::from(k)).map(|x| (x, x)).collect();
    outcome.charts.push(
        Chart::new("Offset at which a pushed peg jams", "λ = l/(2 r μ)", "e*/r")
            .theory("e* = λ r", line)
            .marks("square peg, slot", square)
            .marks("round peg, bore with a rounded mouth", round),
    );
    add_lateral(&mut outcome, step, options)?;
    add_wedging(&mut outcome, step)?;
    outcome.run = record(step)?;
    Ok(outcome)
}

/// Offsets e*/r over λ for pegs of (depth, μ) in a mouth that is rounded by `lip`.
fn add_offsets(
    outcome: &mut Outcome,
    (name, cases, lip): (&str, &[(f64, f64)], f64),
    step: f64,
) -> Result<Vec<(f64, f64)>, LabError> {
    let mut found = Vec::new();
    for &(depth, mu) in cases {
        let peg = Peg { lip, ..peg(depth, mu) };
        let exact = peg.calc_jamming_offset(0.0, HALF_LENGTH);
        let measured = measure_offset(&peg, 0.0, exact, step)? / HALF_WIDTH;
        let name = format!("{name}: e*/r at l/2r = {}, μ = {mu}", depth / (2.0 * HALF_WIDTH));
        outcome.figures.push(Figure::relative(name, measured, exact / HALF_WIDTH, "1", 1e-2));
        found.push((peg.calc_lambda(), measured));
    }
    Ok(found)
}

fn peg(depth: f64, mu: f64) -> Peg {
    Peg { half_width: HALF_WIDTH, bore_half_width: HALF_WIDTH + 0.5 * CLEARANCE, lip: 0.0, depth, mu }
}

/// The peg in two-point contact, four thrusters on it: the push at +SPAN and −SPAN across its axis, and a lateral force to the
/// right and to the left, all at its middle.
fn build(peg: &Peg, step: f64) -> Result<Rig, LabError> {
    let mut bench = Bench::new(EXPERIMENT.name, step);
    let half = Vec3::new(HALF_WIDTH, 0.02, HALF_LENGTH);
    let is_round = peg.lip > 0.0;
    let robot = if is_round { cylinder_robot(1.0, HALF_WIDTH, 2.0 * HALF_LENGTH) } else { box_robot(1.0, half.into()) };
    let body = bench.add_vehicle("peg", &robot, Base::Free);
    if is_round {
        let (radius, depth, wall) = (peg.bore_half_width, 0.2, 2.0 * peg.lip);
        let shape = Shape::Docking(Docking::InnerCylinder { radius, depth, wall, floor: false });
        let (name, pose_ls) = ("world".to_owned(), Pose::identity());
        bench.spec.shapes.push(ShapeSpec { name, vehicle: None, link: 0, pose_ls, shape });
        bench.add_shape(Some(body), 0, Shape::Cylinder { radius: HALF_WIDTH, half_length: HALF_LENGTH });
    } else {
        add_wall(&mut bench, -peg.bore_half_width - 0.05);
        add_wall(&mut bench, peg.bore_half_width + 0.05);
        bench.add_shape(Some(body), 0, Shape::Cuboid { half_extents: half });
    }
    let bristle =
        Bristle { mu_static: peg.mu, mu_kinetic: peg.mu, stiffness: STIFFNESS, damping: 1e3, ..Bristle::default() };
    bench.pair("world", "peg", contact_law(STIFFNESS, 1e3, bristle));
    let (sin, cos) = peg.calc_tilt().sin_cos();
    let (down, right) = (Vec3::new(sin, 0.0, -cos), Vec3::new(cos, 0.0, sin));
    let places = [(SPAN, down), (-SPAN, down), (0.0, right), (0.0, -right)];
    for (k, (x, direction)) in places.into_iter().enumerate() {
        let position = Vec3::new(x, 0.0, 0.0);
        bench
            .add_actuator(&format!("push{k}"), ActuatorKind::Thruster { body: 0, position, direction, max_force: 1e6 });
    }
    let mut rig = bench.build()?;
    let [x, z] = peg.calc_tip();
    rig.place(body, [x + HALF_LENGTH * sin, 0.0, z + HALF_LENGTH * cos], [0.0, peg.calc_tilt(), 0.0]);
    Ok(rig)
}

fn add_wall(bench: &mut Bench, x: f64) {
    let half = Vec3::new(0.05, 0.05, 0.1);
    let pose_ls = Pose::translation(x, 0.0, -half.z);
    let name = "world".to_owned();
    bench.spec.shapes.push(ShapeSpec {
        name: name.clone(),
        vehicle: None,
        link: 0,
        pose_ls,
        shape: Shape::Cuboid { half_extents: half },
    });
    let geometry = Geometry::Box { size: 2.0 * half };
    bench.scene.fixtures.push(Visual { name, pose_ls, geometry, rgba: Some([0.75, 0.75, 0.78, 0.5]) });
}

/// Commands a push of `size` N at the offset `offset`, with `lateral` N across.
fn push(world: &mut World, size: f64, offset: f64, lateral: f64) {
    let share = 0.5 * (1.0 + offset / SPAN);
    let efforts = [size * share, size * (1.0 - share), lateral.max(0.0), (-lateral).max(0.0)];
    world.commands_mut().iter_mut().zip(efforts).for_each(|(c, e)| c.effort = e);
}

/// Jams the peg far beyond `exact`, then lets the offset fall until the peg slides in.
fn measure_offset(peg: &Peg, lateral: f64, exact: f64, step: f64) -> Result<f64, LabError> {
    const LOAD_S: f64 = 0.2;
    const SWEEP_S: f64 = 2.0;
    let mut rig = build(peg, step)?;
    let offset_at = |t: f64| exact * (1.3 - 0.6 * ((t - LOAD_S) / SWEEP_S).max(0.0));
    while rig.time() < LOAD_S + SWEEP_S {
        let t = rig.time();
        let size = PUSH * (t / LOAD_S).min(1.0);
        push(&mut rig.world, size, offset_at(t), lateral * size);
        rig.advance()?;
        // It has slid when it is faster than the sweep's own elastic motion, some 1e-6 m/s.
        if t > LOAD_S && rig.velocity(0).z < -1e-4 {
            return Ok(offset_at(t));
        }
    }
    Ok(f64::NAN)
}

/// Whitney's parallelogram: the edge towards jamming over the lateral force.
fn add_lateral(outcome: &mut Outcome, step: f64, options: &Options) -> Result<(), LabError> {
    let peg = peg(0.04, 0.25);
    let laterals: &[f64] = if options.quick { &[0.5] } else { &[-1.0, -0.5, 0.5, 1.0] };
    let (mut measured, mut exact_edge) = (Vec::new(), Vec::new());
    for &lateral in laterals {
        let exact = peg.calc_jamming_offset(lateral, HALF_LENGTH);
        let found = measure_offset(&peg, lateral, exact, step)?;
        // Moments about the tip, as in Whitney's diagram: the lateral force acts at half the peg's length above it.
        let about_tip = |e: f64| (e + lateral * HALF_LENGTH) / HALF_WIDTH;
        let name = format!("M/(r P) at Fₓ/P = {lateral}, l/2r = 1, μ = 0.25");
        outcome.figures.push(Figure::relative(name, about_tip(found), about_tip(exact), "1", 1e-2));
        measured.push((lateral, about_tip(found)));
    }
    for k in -24..=24 {
        let lateral = 0.05 * f64::from(k);
        let lambda = peg.calc_lambda();
        exact_edge.push((lateral, lambda + peg.mu * (1.0 + lambda) * lateral));
    }
    outcome.charts.push(
        Chart::new("Jamming diagram, l/2r = 1, μ = 0.25", "Fₓ/P", "M/(r P)")
            .theory("edge of Whitney's parallelogram", exact_edge)
            .marks("measured", measured),
    );
    Ok(())
}

/// What presses on the left wall, N.
fn wall_force(world: &World) -> f64 {
    world.touches().filter(|t| t.normal_w.x > 0.0).map(|t| t.normal_force).sum()
}

/// Jams the peg hard, takes the push away and looks at what is left.
fn add_wedging(outcome: &mut Outcome, step: f64) -> Result<(), LabError> {
    let mut chart = Chart::new("Force on a wall while the push goes", "time, s", "normal force, N");
    for (depth, mu) in [(0.014, 0.5), (0.028, 0.5)] {
        let peg = peg(depth, mu);
        let mut rig = build(&peg, step)?;
        let (mut jammed, mut force) = (0.0, Vec::new());
        while rig.time() < 2.0 {
            let t = rig.time();
            let size = 50.0 * PUSH * (t / 0.2).min(1.0).min((1.5 - t).max(0.0));
            push(&mut rig.world, size, 3.0 * HALF_WIDTH, 0.0);
            rig.advance()?;
            force.push((t, wall_force(&rig.world)));
            jammed = if t < 0.5 { wall_force(&rig.world) } else { jammed };
        }
        let left = wall_force(&rig.world) / jammed;
        let name = format!("λ = {:.1}: force kept without a push, of that when jammed", peg.calc_lambda());
        outcome.figures.push(if peg.calc_lambda() < 1.0 {
            Figure::at_least(name, left, 0.05, "1")
        } else {
            Figure::at_most(name, left, 1e-6, "1")
        });
        chart = chart.line(format!("λ = {:.1}", peg.calc_lambda()), force);
    }
    outcome.charts.push(chart);
    Ok(())
}

/// A peg that jams, and slides in as the offset falls.
fn record(step: f64) -> Result<Option<(record::Log, record::Scene)>, LabError> {
    let peg = peg(0.03, 0.2);
    let exact = peg.calc_jamming_offset(0.0, HALF_LENGTH);
    let mut rig = build(&peg, step)?;
    let mut film = rig.film((0.002 / step).ceil() as u64);
    film.shoot(&rig.world);
    while rig.time() < 0.7 && rig.position(0).z > 0.0 {
        let t = rig.time();
        push(&mut rig.world, PUSH * (t / 0.2).min(1.0), exact * (1.3 - (t - 0.2).max(0.0)), 0.0);
        rig.advance()?;
        film.shoot(&rig.world);
    }
    film.develop(&rig)
}
