//! 10,000 steps of smooth sliding: the force of a linear law must not jump, and points keep their identity.

use crate::support::*;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Steps of each motion.
const STEPS: usize = 10_000;
/// Largest second difference of the force, of its size (the bound).
const BEND: f64 = 1e-3;
/// Depth to which the bodies are pressed, m.
const DEPTH: f64 = 1e-5;

/// Σ δ n over the touching points: the force of a linear law of 1 N/m.
fn force(points: &[ContactPoint]) -> Vec3 {
    points.iter().map(|p| (-p.gap).max(0.0) * p.normal_w).sum()
}

/// A motion of B while A stands at the origin; `press`: the direction in which B is pushed until it touches, and then by
/// [`DEPTH`] along the normal (none: the motion is taken as it is).
struct Slide {
    name: &'static str,
    a: Shape,
    b: Shape,
    pose: Box<dyn Fn(f64) -> Frame>,
    press: Option<Vec3>,
    /// Most changes of the set of identities on the way.
    changes: usize,
}

/// B's frame, pushed home by Newton steps along the press direction.
///
/// `shift`: how far it was pushed the step before, m, to start from; the place it ends at is the same to round-off.
fn place(slide: &Slide, two: &mut Two, t: f64, shift: &mut f64) -> Frame {
    let mut frame = (slide.pose)(t);
    let Some(press) = slide.press else { return frame };
    frame.pos -= *shift * press;
    for attempt in 0..30 {
        let reach = if t == 0.0 && attempt < 20 { 0.1 } else { 1e-3 };
        let points = two.find(&at(0.0, 0.0, 0.0), &frame, reach);
        let Some(deepest) = points.iter().min_by(|p, q| p.gap.total_cmp(&q.gap)) else {
            panic!("{} at {t}: out of reach", slide.name)
        };
        // Touch exactly, where gaps are those of the surfaces, then press.
        let miss = deepest.gap - 1e-9;
        let slope = deepest.normal_w.dot(&press);
        frame.pos -= miss / slope * press;
        *shift += miss / slope;
        if miss.abs() < 1e-14 {
            frame.pos -= (DEPTH + 1e-9) / slope * press;
            return frame;
        }
    }
    panic!("{} at {t}: not pressed", slide.name);
}

/// Largest second difference over the largest force; how often identities changed; the most that touch at once.
fn run(slide: &Slide) -> (f64, usize, usize) {
    let mut two = Two::new(slide.a.clone(), slide.b.clone());
    let (mut forces, mut most, mut changes, mut shift) = (Vec::with_capacity(STEPS), 0, 0, 0.0);
    let mut before: Option<Vec<u64>> = None;
    for i in 0..STEPS {
        let frame = place(slide, &mut two, i as f64 / STEPS as f64, &mut shift);
        let touching = two.find_touching(&at(0.0, 0.0, 0.0), &frame);
        assert!(!touching.is_empty(), "{} at step {i}: nothing touches", slide.name);
        let names: Vec<u64> = touching.iter().map(|p| p.feature).collect();
        changes += usize::from(before.as_ref().is_some_and(|b| *b != names));
        (before, most) = (Some(names), most.max(touching.len()));
        forces.push(force(&touching));
    }
    let size = forces.iter().map(Vec3::norm).fold(0.0, f64::max);
    let bends: Vec<f64> = forces.windows(3).map(|f| (f[2] - 2.0 * f[1] + f[0]).norm()).collect();
    let worst = (0..bends.len()).max_by(|i, j| bends[*i].total_cmp(&bends[*j])).unwrap();
    println!("{:34} bend {:.1e} at step {worst}, {changes} changes, {most} points", slide.name, bends[worst] / size);
    (bends[worst] / size, changes, most)
}

fn slide(
    name: &'static str,
    a: Docking,
    b: Shape,
    press: Option<Vec3>,
    pose: impl Fn(f64) -> Frame + 'static,
) -> Slide {
    Slide { name, a: Shape::Docking(a), b, pose: Box::new(pose), press, changes: 0 }
}

fn ball(radius: f64) -> Shape {
    Shape::Ball { radius }
}

/// A ball's centre at this distance from the cone's core, round its axis.
fn ball_slides() -> Vec<Slide> {
    let r = 0.03;
    let round = |radius: f64, z: f64| move |t: f64| at(radius * (TAU * t).cos(), radius * (TAU * t).sin(), z);
    // Over the tube of the ring and over the rim of the bore: circles about the core's circle.
    let over = |rho: f64, z: f64, reach: f64| {
        move |t: f64| at(rho + (reach - DEPTH) * (TAU * t).cos(), 0.0, z + (reach - DEPTH) * (TAU * t).sin())
    };
    vec![
        slide("ball round a cone", cone(), ball(r), Some(Vec3::z()), round(0.04, 0.0)),
        slide("ball round a bore", bore(true), ball(r), None, round(0.05 - r + DEPTH, -0.05)),
        slide("ball round a ring", ring(), ball(r), Some(Vec3::z()), round(0.21, 0.04)),
        slide("ball over the tube of a ring", ring(), ball(r), None, over(0.2, 0.0, 0.045)),
        slide("ball over the rim of a bore", bore(false), ball(r), None, move |t| over(0.056, 0.0, 0.036)(0.5 * t)),
        slide("ball up a cone and over its rim", cone(), ball(r), Some(Vec3::z()), |t| at(0.08 + 0.08 * t, 0.01, 0.0)),
        slide("ball over a petal", petal(), ball(r), Some(-Vec3::x()), |t| at(0.18, -0.05 + 0.1 * t, 0.06 + 0.02 * t)),
        slide("ball round the edge of a petal", petal(), ball(r), Some(-Vec3::x()), |t| at(0.2, 0.02 + 0.06 * t, 0.05)),
        slide("ball round a corner of a petal", petal(), ball(r), Some(-Vec3::x()), |t| {
            at(0.1, 0.0 + 0.05 * t, 0.11 + 0.02 * t)
        }),
    ]
}

fn long_slides() -> Vec<Slide> {
    let capsule = Shape::Capsule { radius: 0.02, half_length: 0.07 };
    let cylinder = Shape::Cylinder { radius: 0.03, half_length: 0.06 };
    let plate = Shape::Cylinder { radius: 0.04, half_length: 0.01 };
    let wall = |r: f64| 0.05 - r + DEPTH;
    let along_y = Vec3::new(FRAC_PI_2, 0.0, 0.0);
    vec![
        Slide {
            changes: 1,
            ..slide("capsule along a bore", bore(false), capsule.clone(), None, move |t| {
                at(wall(0.02), 0.0, -0.045 + 0.1 * t)
            })
        },
        slide("capsule round a bore", bore(false), capsule.clone(), None, move |t| {
            at(wall(0.02) * (TAU * t).cos(), wall(0.02) * (TAU * t).sin(), 0.02)
        }),
        slide("tilted capsule in a cone", cone(), capsule.clone(), Some(Vec3::z()), |t| {
            turned(
                Vec3::new(0.1 * (TAU * t).cos(), 0.1 * (TAU * t).sin(), 0.0),
                0.03 * (TAU * t).cos(),
                0.03 * (TAU * t).sin(),
                0.0,
            )
        }),
        // Its two points meet where it leaves the chord and are one from there.
        Slide {
            changes: 1,
            ..slide("capsule across a ring", ring(), capsule.clone(), Some(Vec3::z()), move |t| Frame {
                pos: Vec3::new(0.15 + 0.05 * t, 0.0, 0.03),
                ..turned(along_y, 0.0, 0.0, 0.0)
            })
        },
        slide("capsule along a petal", petal(), capsule, Some(-Vec3::x()), move |t| Frame {
            pos: Vec3::new(0.16, 0.01, 0.03 + 0.05 * t),
            ..turned(along_y, 0.0, 0.0, 0.0)
        }),
        slide("cylinder round a bore", bore(true), cylinder.clone(), None, move |t| {
            at(wall(0.03) * (TAU * t).cos(), wall(0.03) * (TAU * t).sin(), -0.04)
        }),
        slide("tilted cylinder in a cone", cone(), plate, Some(Vec3::z()), |t| {
            turned(Vec3::new(0.1 * (TAU * t).cos(), 0.1 * (TAU * t).sin(), 0.0), 0.01 * (TAU * t).cos(), 0.0, -0.03)
        }),
        slide("cylinder across a ring", ring(), cylinder, Some(Vec3::z()), move |t| Frame {
            pos: Vec3::new(0.15 + 0.05 * t, 0.0, 0.04),
            ..turned(along_y, 0.0, 0.0, 0.0)
        }),
    ]
}

fn docking_slides() -> Vec<Slide> {
    let lean = |angle: f64| move |t: f64| angle * Vec3::new((TAU * t).cos(), (TAU * t).sin(), 0.0);
    let plane = Shape::HalfSpace;
    let face_down = Vec3::new(std::f64::consts::PI, 0.0, 0.0);
    vec![
        slide("plane rolls round a ring", ring(), plane.clone(), Some(Vec3::z()), move |t| {
            let turn = turned(lean(0.05)(t), 0.0, 0.0, 0.0).rot * turned(face_down, 0.0, 0.0, 0.0).rot;
            Frame { rot: turn, pos: Vec3::new(0.0, 0.0, 0.03) }
        }),
        // From one corner along the tip's arc to the other: the arc's point comes and goes at the corners.
        Slide {
            changes: 4,
            ..slide("plane rolls over a petal's tip", petal(), plane, Some(Vec3::z()), move |t| {
                let turn = turned(Vec3::new(0.4 - 0.8 * t, 0.3, 0.0), 0.0, 0.0, 0.0).rot
                    * turned(face_down, 0.0, 0.0, 0.0).rot;
                Frame { rot: turn, pos: Vec3::new(0.07, 0.0, 0.14) }
            })
        },
        slide("ring rolls round a ring", ring(), Shape::Docking(ring()), Some(Vec3::z()), move |t| Frame {
            pos: Vec3::new(0.0, 0.0, 0.04),
            ..turned(lean(0.05)(t), 0.0, 0.0, 0.0)
        }),
        slide(
            "small ring round a cone",
            cone(),
            Shape::Docking(Docking::Ring { major_radius: 0.05, minor_radius: 0.01 }),
            Some(Vec3::z()),
            move |t| Frame {
                pos: Vec3::new(0.01 * (TAU * t).cos(), 0.01 * (TAU * t).sin(), -0.03),
                ..turned(lean(0.1)(t), 0.0, 0.0, 0.0)
            },
        ),
        slide("ring along a petal", petal(), Shape::Docking(ring()), Some(-Vec3::x()), |t| {
            turned(Vec3::new(0.02, 0.05, 0.0), -0.03, 0.0, 0.04 + 0.05 * t)
        }),
        Slide {
            changes: 4,
            ..slide("petal edge along a petal", petal(), Shape::Docking(petal()), Some(Vec3::y()), |t| {
                turned(Vec3::new(0.0, 0.1, 0.6), 0.0, 0.16, 0.02 - 0.04 * t)
            })
        },
        Slide {
            changes: 2,
            ..slide("petal bulging against a petal", petal(), Shape::Docking(petal()), Some(Vec3::x()), |t| {
                let flipped = turned(std::f64::consts::PI * Vec3::y(), 0.0, 0.0, 0.0);
                let crossed = turned(0.3 * Vec3::x(), 0.0, 0.0, 0.0);
                Frame { rot: crossed.rot * flipped.rot, pos: Vec3::new(0.33, 0.01 - 0.02 * t, 0.12) }
            })
        },
    ]
}

fn check(slides: Vec<Slide>) {
    let mut faults = Vec::new();
    for slide in slides {
        let (bend, changes, _) = run(&slide);
        if bend > BEND || changes > slide.changes {
            faults.push(format!("{}: bend {bend:.1e}, {changes} changes", slide.name));
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

#[test]
fn balls_slide_smoothly() {
    check(ball_slides());
}

#[test]
fn capsules_and_cylinders_slide_smoothly() {
    check(long_slides());
}

#[test]
fn docking_shapes_slide_smoothly_on_each_other_and_on_planes() {
    check(docking_slides());
}

/// The deepest place runs round the ball within a micrometre of the axis; the force passes through straight.
#[test]
fn seated_ball_crosses_the_axis_smoothly() {
    let r = 0.03;
    for (miss, depth) in [(0.0, 1e-4), (1e-9, 1e-4), (1e-6, 1e-4), (1e-5, 1e-4), (1e-6, 1e-6), (1e-7, 1e-6)] {
        // Where the ball would just touch all round: core at 0.02 + 0.14 tan α … along the wall.
        let a: f64 = 0.7;
        let height = (r + (0.0 - 0.02 * a.cos())) / a.sin() - 0.14;
        let side = 3.0 * depth;
        let cross = slide("ball across the axis of a cone", cone(), ball(r), None, move |t| {
            at(side * (2.0 * t - 1.0), miss, height - depth / a.sin())
        });
        let (bend, _, points) = run(&cross);
        assert!(bend < BEND && points == 8, "{miss} m beside the axis at {depth} m: {bend}, {points} points");
    }
}
