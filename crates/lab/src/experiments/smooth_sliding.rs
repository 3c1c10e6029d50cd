//! A slider on every analytic shape: is the force as smooth as the surface, and do points stay themselves?
//!
//! A slider of 1e9 kg is led along a prescribed path over a fixed surface, at a constant penetration δ = 0.1 mm by
//! construction of the path, 10,000 steps with v h/R ≤ 1e-3 for the smallest radius R of path and slider. The force is
//! the law's, normal and bristle. It turns with the normal, so that its second difference is of order (v h/R)² where the
//! path's curvature is steady, and v h/R where the curvature jumps (on to an edge, on to a cap):
//!
//!   |f(k+1) − 2 f(k) + f(k−1)| ≤ 1e-3 |f|
//!
//! Counted from where the bristle slides. The number of points that appear or vanish on the way must be zero.

use super::sliding_docking;
use super::sliding_paths::{Path, Piece};
use crate::bench::{Bench, Rig};
use crate::scene::{ball_robot, contact_law};
use crate::{Chart, Experiment, Figure, LabError, Options, Outcome};
use contact::Shape;
use friction::Bristle;
use sim::{Base, ShapeSpec};
use spatial::{Pose, Rot, Twist, Vec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// The entry in the catalogue.
pub const EXPERIMENT: Experiment = Experiment {
    name: "smooth-sliding",
    question: "Is the force of a sliding contact as smooth as the surfaces?",
    run,
};

const STEP: f64 = 1e-3;
const MU: f64 = 0.3;
pub(super) const DEPTH: f64 = 1e-4;
/// Radius of the ball, the capsule and the cylinder that slide, m; half the length of the latter two.
pub(super) const SLIDER: f64 = 0.02;
const HALF: f64 = 0.03;
/// Radius of the surfaces, m, and half their length.
const RADIUS: f64 = 0.1;
const HALF_LENGTH: f64 = 0.06;
/// Largest second difference over the largest force.
const SMOOTH: f64 = 1e-3;

/// A surface, a slider with its turn, and the way that the slider's origin takes.
pub(super) struct Case {
    pub(super) name: &'static str,
    pub(super) surface: Shape,
    pub(super) slider: Shape,
    pub(super) turned: [f64; 3],
    pub(super) path: Path,
    pub(super) points: usize,
}

fn run(options: &Options) -> Result<Outcome, LabError> {
    let steps = if options.quick { 3_000 } else { 10_000 };
    let mut outcome = Outcome::default();
    let mut chart =
        Chart::new("Second difference of the force", "share of the path", "|Δ²f|/|f|").logarithmic(false, true);
    for case in cases().into_iter().chain(sliding_docking::cases()) {
        let found = slide(&case, steps)?;
        let name = case.name;
        // A coarser path has larger steps; the bound is for steps of at most 1e-3 of a radius.
        if !options.quick {
            outcome.figures.push(Figure::at_most(format!("{name}: Δ²f/f"), found.roughness, SMOOTH, "1"));
        }
        outcome.figures.extend([
            Figure::at_most(format!("{name}: points that came or went"), found.changes as f64, 0.0, "1"),
            Figure::absolute(format!("{name}: points"), found.points as f64, case.points as f64, "1", 0.0),
        ]);
        chart = chart.line(name, found.differences.iter().copied().step_by(20).collect());
    }
    outcome.charts.push(chart);
    outcome.run = record()?;
    Ok(outcome)
}

pub(super) fn ball() -> Shape {
    Shape::Ball { radius: SLIDER }
}

/// What slides over what. Paths lie in the plane y = 0, the slider above or outside the surface.
fn cases() -> Vec<Case> {
    let mut cases = balls_on_surfaces();
    let flat = |name, slider, turned, height: f64, points| Case {
        name,
        surface: Shape::HalfSpace,
        slider,
        turned,
        path: Path::new(vec![line([0.0, 0.0, height - DEPTH], [0.1, 0.0, height - DEPTH])]),
        points,
    };
    let capsule = Shape::Capsule { radius: SLIDER, half_length: HALF };
    let cylinder = Shape::Cylinder { radius: SLIDER, half_length: HALF };
    let lying = [0.0, FRAC_PI_2, 0.0];
    cases.extend([
        flat("ball on plane", ball(), [0.0; 3], SLIDER, 1),
        flat("capsule lying on plane", capsule.clone(), lying, SLIDER, 2),
        flat("capsule standing on plane", capsule.clone(), [0.0; 3], SLIDER + HALF, 1),
        flat("cylinder lying on plane", cylinder, lying, SLIDER, 2),
        flat("box on plane", Shape::Cuboid { half_extents: Vec3::new(0.03, 0.02, 0.01) }, [0.0, 0.0, 0.3], 0.01, 4),
    ]);
    let height = RADIUS + SLIDER - DEPTH;
    cases.push(Case {
        name: "capsule over ball",
        surface: Shape::Ball { radius: RADIUS },
        slider: capsule,
        turned: lying,
        path: Path::new(vec![line([-0.02, 0.0, height], [0.02, 0.0, height])]),
        points: 1,
    });
    cases
}

pub(super) fn line(from: [f64; 3], to: [f64; 3]) -> Piece {
    Piece::Line { from: from.into(), to: to.into() }
}

/// An arc in the plane y = 0 from `from`, about `centre`, by `angle` about +y (from +z towards +x).
pub(super) fn arc(centre: [f64; 3], from: [f64; 3], angle: f64) -> Piece {
    let centre = Vec3::from(centre);
    Piece::Arc { centre, arm: Vec3::from(from) - centre, axis: Vec3::y(), angle }
}

fn balls_on_surfaces() -> Vec<Case> {
    let (reach, edge) = (RADIUS + SLIDER - DEPTH, SLIDER - DEPTH);
    let case = |name, surface, pieces| Case {
        name,
        surface,
        slider: ball(),
        turned: [0.0; 3],
        path: Path::new(pieces),
        points: 1,
    };
    let half = Vec3::new(0.05, 0.05, 0.05);
    let cuboid = || Shape::Cuboid { half_extents: half };
    let cylinder = || Shape::Cylinder { radius: RADIUS, half_length: HALF_LENGTH };
    let top = half.z + edge;
    let around =
        Piece::Arc { centre: Vec3::zeros(), arm: Vec3::new(reach, 0.0, 0.0), axis: Vec3::z(), angle: 0.5 * PI };
    let (rim, cap) = (reach, HALF_LENGTH + edge);
    vec![
        case("ball on ball", Shape::Ball { radius: RADIUS }, vec![arc([0.0; 3], [0.0, 0.0, reach], FRAC_PI_2)]),
        case("ball on box face", cuboid(), vec![line([-0.04, 0.01, top], [0.04, 0.01, top])]),
        case(
            "ball over box edge",
            cuboid(),
            vec![
                line([0.0, 0.0, top], [half.x, 0.0, top]),
                arc([half.x, 0.0, half.z], [half.x, 0.0, top], FRAC_PI_2),
                line([half.x + edge, 0.0, half.z], [half.x + edge, 0.0, 0.0]),
            ],
        ),
        case("ball around cylinder", cylinder(), vec![around]),
        case("ball along cylinder", cylinder(), vec![line([reach, 0.0, -0.05], [reach, 0.0, 0.05])]),
        case(
            "ball over cylinder rim",
            cylinder(),
            vec![
                line([0.06, 0.0, cap], [RADIUS, 0.0, cap]),
                arc([RADIUS, 0.0, HALF_LENGTH], [RADIUS, 0.0, cap], FRAC_PI_2),
                line([rim, 0.0, HALF_LENGTH], [rim, 0.0, 0.02]),
            ],
        ),
        case(
            "ball over capsule end",
            Shape::Capsule { radius: RADIUS, half_length: HALF_LENGTH },
            vec![
                arc([0.0, 0.0, HALF_LENGTH], [0.0, 0.0, HALF_LENGTH + reach], FRAC_PI_2),
                line([reach, 0.0, HALF_LENGTH], [reach, 0.0, 0.0]),
            ],
        ),
    ]
}

fn build(case: &Case) -> Result<Rig, LabError> {
    let mut bench = Bench::new(EXPERIMENT.name, STEP);
    let name = "surface".to_owned();
    let (pose_ls, shape) = (Pose::identity(), case.surface.clone());
    bench.spec.shapes.push(ShapeSpec { name, vehicle: None, link: 0, pose_ls, shape });
    let slider = bench.add_vehicle("slider", &ball_robot(1e9, 1.0), Base::Free);
    bench.add_shape(Some(slider), 0, case.slider.clone());
    let bristle = Bristle { mu_static: MU, mu_kinetic: MU, stiffness: 1e6, ..Bristle::default() };
    bench.pair("surface", "slider", contact_law(1e6, 0.0, bristle));
    bench.build()
}

/// What a slide showed.
#[derive(Default)]
struct Slid {
    roughness: f64,
    changes: usize,
    points: usize,
    differences: Vec<(f64, f64)>,
}

/// Leads the slider along its path and looks at the force of every step.
fn slide(case: &Case, steps: usize) -> Result<Slid, LabError> {
    let mut rig = build(case)?;
    let mut forces: Vec<Vec3> = Vec::with_capacity(steps);
    let (mut slid, mut features) = (Slid::default(), Vec::new());
    for k in 0..steps {
        lead(&mut rig, case, k, steps);
        rig.advance()?;
        let touching = rig.world.touches().filter(|t| t.normal_force > 0.0);
        let now: Vec<u64> = touching.map(|t| t.feature).collect();
        slid.changes += usize::from(k > 0 && now != features);
        (slid.points, features) = (now.len(), now);
        forces.push(rig.world.touches().map(|t| t.force_w).sum());
    }
    let size = forces.iter().map(Vec3::norm).fold(0.0, f64::max);
    // The bristle takes a few steps to slide.
    for (k, w) in forces.windows(3).enumerate().skip(100) {
        let difference = (w[2] - 2.0 * w[1] + w[0]).norm() / size;
        slid.roughness = slid.roughness.max(difference);
        slid.differences.push((k as f64 / steps as f64, difference.max(1e-16)));
    }
    Ok(slid)
}

fn lead(rig: &mut Rig, case: &Case, k: usize, steps: usize) {
    let spacing = case.path.length() / steps as f64;
    let (place, along) = case.path.at(spacing * k as f64);
    let turn = Rot::from_scaled_axis(case.turned.into());
    rig.world.state_mut().bases[0] = Pose::from_parts(place.into(), turn);
    rig.throw(&[Twist::new(Vec3::zeros(), along * (spacing / STEP))]);
}

/// Over the box's edge, to look at.
fn record() -> Result<Option<(record::Log, record::Scene)>, LabError> {
    let Some(case) = cases().into_iter().find(|c| c.name == "ball over box edge") else { return Ok(None) };
    let mut rig = build(&case)?;
    let mut film = rig.film(1);
    for k in 0..400 {
        lead(&mut rig, &case, k, 400);
        rig.advance()?;
        film.shoot(&rig.world);
    }
    film.develop(&rig)
}
