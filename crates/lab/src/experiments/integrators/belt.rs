//! A block on a belt, held by a spring: the belt pulls it along until it breaks away, again and again.
//!
//! The belt is a body of 1e6 kg that moves freely along x, so that no step has to be told where it is. The levels drop at
//! breakaway; the closed form for a rigid bristle is [`crate::exact::slider`].

use super::{CANDIDATES, FINE, Track, calc_error};
use crate::bench::{Bench, Rig};
use crate::exact::slider::Slider;
use crate::scene::{BLOCK, GANTRY, GANTRY_BLOCK, GRAVITY, box_robot, contact_law, gantry_robot, settle_gantry};
use crate::{Chart, Figure, LabError, Options, Outcome};
use contact::Shape;
use friction::Bristle;
use sim::{Base, Integrator};
use spatial::Twist;

const SPRING: f64 = 1e4;
const LEVELS: [f64; 2] = [0.4, 0.3];
const SLIDER: Slider =
    Slider { mass: 1.0, spring: SPRING, belt: 0.01, levels: [LEVELS[0] * GRAVITY, LEVELS[1] * GRAVITY] };

/// The block at rest on the moving belt, the spring unloaded; stiffness (N/m) of each of four points and of its bristle.
fn build(integrator: Integrator, step: f64, stiffness: f64, damping: f64) -> Result<Rig, LabError> {
    let mut bench = Bench::new("integrators", step).gravity([0.0, 0.0, -GRAVITY]).integrator(integrator);
    let block = bench.add_vehicle("block", &gantry_robot(SLIDER.mass, BLOCK), Base::Fixed);
    let along = Base::Only([false, false, false, true, false, false]);
    let belt = bench.add_vehicle("belt", &box_robot(1e6, [0.5, 0.2, 1e-3]), along);
    bench.add_shape(Some(block), GANTRY_BLOCK, Shape::Cuboid { half_extents: BLOCK.into() });
    bench.add_shape(Some(belt), 0, Shape::HalfSpace);
    let [mu_static, mu_kinetic] = LEVELS;
    let bristle = Bristle { mu_static, mu_kinetic, stribeck_speed: 0.0, stiffness, damping, ..Bristle::default() };
    bench.pair("belt", "block", contact_law(stiffness, damping, bristle));
    bench.add_spring("spring", GANTRY[0], SPRING, 0.0);
    let mut rig = bench.build()?;
    settle_gantry(&mut rig, SLIDER.mass, stiffness);
    rig.throw(&[Twist::default(), Twist::new([0.0; 3].into(), [SLIDER.belt, 0.0, 0.0].into())]);
    Ok(rig)
}

/// Place of the block at every millisecond, and what the cycles were like.
struct Ride {
    track: Track,
    /// Lowest and highest spring force after the first cycle, N.
    extremes: [f64; 2],
    /// Mean time between two highest places, s.
    period: f64,
}

fn ride(mut rig: Rig, duration: f64) -> Result<Ride, LabError> {
    let step = rig.world.model().step;
    let every = (1e-3 / step).round() as u64;
    let (mut track, mut tops, mut last) = (Vec::new(), Vec::new(), [0.0; 3]);
    let mut extremes = [f64::INFINITY, f64::NEG_INFINITY];
    while rig.time() < duration - 0.5 * step {
        rig.advance()?;
        let (x, v) = (rig.world.state().q[GANTRY[0]], rig.world.state().v[GANTRY[0]]);
        if last[1] > 0.0 && v <= 0.0 {
            tops.push(last[2] + step * last[1] / (last[1] - v));
        }
        if !tops.is_empty() {
            extremes = [extremes[0].min(SPRING * x), extremes[1].max(SPRING * x)];
        }
        last = [x, v, rig.time()];
        if rig.world.state().steps.is_multiple_of(every) {
            track.push(vec![x]);
        }
    }
    let period = match tops.as_slice() {
        [first, .., end] => (end - first) / (tops.len() - 1) as f64,
        _ => f64::NAN,
    };
    Ok(Ride { track, extremes, period })
}

/// Six cycles against RK4 at 1 µs.
pub(super) fn add_stick_slip(outcome: &mut Outcome, options: &Options) -> Result<(), LabError> {
    const STIFFNESS: f64 = 1e6;
    let (fine, duration) = if options.quick { (5.0 * FINE, 0.25) } else { (FINE, 0.4) };
    let reference = ride(build(Integrator::RungeKutta4, fine, STIFFNESS, 100.0)?, duration)?;
    let seen = |track: &Track| track.iter().enumerate().map(|(k, y)| (1e-3 * (k + 1) as f64, 1e3 * y[0])).collect();
    let mut chart = Chart::new("Stick–slip on a belt", "time, s", "place, mm").theory("RK4", seen(&reference.track));
    for (name, integrator, step) in CANDIDATES {
        let found = ride(build(integrator, step, STIFFNESS, 100.0)?, duration)?;
        let place = calc_error(&found.track, &reference.track, 0..1);
        outcome.figures.extend([
            Figure::shown(format!("stick–slip, {name}: place"), place, 0.0, "m"),
            Figure::shown(format!("stick–slip, {name}: highest force"), found.extremes[1], reference.extremes[1], "N"),
            Figure::shown(format!("stick–slip, {name}: period"), found.period, reference.period, "s"),
        ]);
        if step == 1e-3 {
            chart = chart.line(name, seen(&found.track));
        }
    }
    outcome.charts.push(chart);
    Ok(())
}

/// 1e7 N/m in each of four points and its bristle, under 1 kg at 1 ms: h ω = 6.3.
pub(super) fn add_stiff(outcome: &mut Outcome, options: &Options) -> Result<(), LabError> {
    let duration = if options.quick { 2.0 } else { 10.0 };
    let [lowest, highest] = SLIDER.calc_extremes();
    for (name, integrator) in
        [("implicit Euler", Integrator::ImplicitEuler), ("implicit midpoint", Integrator::ImplicitMidpoint)]
    {
        let rig = build(integrator, 1e-3, 1e7, 0.0)?;
        let found = ride(rig, duration)?;
        let name = format!("1e7 N/m on 1 kg, {name}, 1 ms, {duration} s of stick–slip");
        outcome.figures.extend([
            Figure::at_most(format!("{name}: highest spring force"), found.extremes[1], 1.1 * highest, "N"),
            Figure::shown(format!("{name}: highest spring force, rigid"), found.extremes[1], highest, "N"),
            Figure::shown(format!("{name}: lowest spring force, rigid"), found.extremes[0], lowest, "N"),
            Figure::shown(format!("{name}: period, rigid"), found.period, SLIDER.calc_period(), "s"),
        ]);
    }
    Ok(())
}
