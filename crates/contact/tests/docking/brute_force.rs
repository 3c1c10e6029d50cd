//! Gaps and normals against a search of the surfaces that knows nothing of how the crate finds them.
//!
//! Each docking shape is a core surface p(s, θ) with a rounding radius; the plain shapes have their well-known distance
//! functions. 10⁵ samples of the core (of both cores, for two docking shapes), then a pattern search from the best of them.

use crate::support::*;
use std::f64::consts::{PI, TAU};

/// The pattern search halves its step until 1e-9 of the range; distances are then exact to its square over a radius, and
/// along kinks to the step itself: 1e-9 of half a metre.
const SEARCH: f64 = 3e-9;

/// A core surface: meridian ends (ρ, z), half sector, radius; written down here from the documentation's table.
struct Core {
    ends: [[f64; 2]; 2],
    half: f64,
    radius: f64,
}

impl Core {
    fn point(&self, s: f64, t: f64) -> Vec3 {
        let [p, q] = self.ends;
        let (rho, z) = (p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1]));
        let theta = self.half * (2.0 * t - 1.0);
        Vec3::new(rho * theta.cos(), rho * theta.sin(), z)
    }
}

fn cores(docking: &Docking) -> Vec<Core> {
    let full = |p, q, radius| Core { ends: [p, q], half: PI, radius };
    match *docking {
        Docking::InnerCone { half_angle: a, depth, throat_radius: r, wall } => {
            let w = 0.5 * wall;
            let out = [w * a.cos(), -w * a.sin()];
            vec![full([r + out[0], out[1] - depth], [r + depth * a.tan() + out[0], out[1]], w)]
        }
        Docking::InnerCylinder { radius, depth, wall, floor } => {
            let w = 0.5 * wall;
            let mut all = vec![full([radius + w, -depth], [radius + w, 0.0], w)];
            if floor {
                all.push(full([0.0, -depth - w], [radius + w, -depth - w], w));
            }
            all
        }
        Docking::Ring { major_radius, minor_radius } => {
            vec![full([major_radius, 0.0], [major_radius, 0.0], minor_radius)]
        }
        Docking::Petal { base_radius, tip_radius, height, half_sector, thickness } => {
            vec![Core { half: half_sector, ..full([base_radius, 0.0], [tip_radius, height], 0.5 * thickness) }]
        }
    }
}

/// Signed distance of `p` from a plain shape.
fn distance(shape: &Shape, p: &Vec3) -> f64 {
    match shape {
        Shape::Ball { radius } => p.norm() - radius,
        Shape::Capsule { radius, half_length } => {
            (p - Vec3::new(0.0, 0.0, p.z.clamp(-half_length, *half_length))).norm() - radius
        }
        Shape::Cylinder { radius, half_length } => {
            let (r, z) = (p.x.hypot(p.y) - radius, p.z.abs() - half_length);
            r.max(z).min(0.0) + r.max(0.0).hypot(z.max(0.0))
        }
        Shape::Cuboid { half_extents } => {
            let q = p.abs() - half_extents;
            q.max().min(0.0) + q.sup(&Vec3::zeros()).norm()
        }
        Shape::HalfSpace => p.z,
        _ => panic!("not a plain shape"),
    }
}

/// Smallest value of `f` over the unit cube of N dimensions (periodic ones wrap by the sine in f).
fn minimise<const N: usize>(f: &dyn Fn(&[f64; N]) -> f64) -> f64 {
    let per = (1e5_f64.powf(1.0 / N as f64)).round() as usize;
    let mut all: Vec<(f64, [f64; N])> = (0..per.pow(N as u32))
        .map(|i| {
            let x = std::array::from_fn(|k| (i / per.pow(k as u32) % per) as f64 / (per - 1) as f64);
            (f(&x), x)
        })
        .collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut dice = Dice(7);
    all.iter().take(12).map(|start| descend(f, *start, 1.0 / per as f64, &mut dice)).fold(f64::INFINITY, f64::min)
}

/// Steps along the axes and at random, halved where none helps.
fn descend<const N: usize>(f: &dyn Fn(&[f64; N]) -> f64, start: (f64, [f64; N]), step: f64, dice: &mut Dice) -> f64 {
    let ((mut best, mut x), mut step) = (start, step);
    while step > 1e-9 {
        let mut better = false;
        for i in 0..2 * N + 12 {
            let mut y = x;
            for k in 0..N {
                let along = if i < 2 * N {
                    f64::from(i / 2 == k) * (1.0 - 2.0 * (i % 2) as f64)
                } else {
                    dice.between(-1.0, 1.0)
                };
                y[k] = (x[k] + step * along).clamp(0.0, 1.0);
            }
            let value = f(&y);
            if value < best {
                (best, x, better) = (value, y, true);
            }
        }
        step *= if better { 1.0 } else { 0.5 };
    }
    best
}

fn brute_gap(a: &Docking, frame_a: &Frame, b: &Shape, frame_b: &Frame) -> f64 {
    let in_b = |p: &Vec3| frame_b.inverse_point(&frame_a.point(p));
    let one = |core: &Core| -> f64 {
        if let Shape::Docking(docking) = b {
            let other = |o: &Core| {
                let d = |x: &[f64; 4]| (in_b(&core.point(x[0], x[1])) - o.point(x[2], x[3])).norm();
                minimise(&d) - core.radius - o.radius
            };
            return cores(docking).iter().map(other).fold(f64::INFINITY, f64::min);
        }
        minimise(&|x: &[f64; 2]| distance(b, &in_b(&core.point(x[0], x[1])))) - core.radius
    };
    cores(a).iter().map(one).fold(f64::INFINITY, f64::min)
}

fn check_pair(i: usize, j: usize, cases: u64) -> (f64, usize) {
    let (a, all) = (dockings()[i], shapes());
    let (mut worst, mut told) = (0.0_f64, 0);
    let mut dice = Dice(1 + 100 * i as u64 + j as u64);
    let mut two = Two::new(Shape::Docking(a), all[j].clone());
    while told < cases as usize {
        let mut frame_b = dice.frame(0.2);
        if all[j] == Shape::HalfSpace {
            frame_b.pos -= 0.3 * frame_b.rot.column(2);
        }
        let truth = brute_gap(&a, &at(0.0, 0.0, 0.0), &all[j], &frame_b);
        if truth < 1e-3 {
            continue;
        }
        told += 1;
        let points = two.find(&at(0.0, 0.0, 0.0), &frame_b, 1.0);
        let gap = points.iter().map(|p| p.gap).fold(f64::INFINITY, f64::min);
        // The search may end beside the minimum, so it may be above, but it can never be below by more than its steps.
        assert!((gap - truth).abs() < 1e3 * SEARCH, "{a:?} and {:?} at {frame_b:?}: {gap} for {truth}", all[j]);
        worst = worst.max(gap - truth);
    }
    (worst, told)
}

#[test]
fn gaps_are_those_of_a_search_of_both_surfaces() {
    let mut worst = 0.0_f64;
    for i in 0..dockings().len() {
        for j in 0..shapes().len() {
            let (w, n) = check_pair(i, j, if j < 5 { 4 } else { 8 });
            println!("pair {i} {j}: {n} cases, largest excess over the search {w:.1e} m");
            worst = worst.max(w);
        }
    }
    assert!(worst < SEARCH, "a gap is {worst} m larger than what the search found");
}

/// d gap / d position of B = normal, and d gap / d rotation = its moment about B's origin.
#[test]
fn normals_are_the_gradients_of_the_gaps() {
    // Central differences: round-off 1e-16 over the step, and the step's square over a radius of a centimetre, cubed.
    const TOLERANCE: f64 = 2e-6;
    let step = 1e-6;
    let mut dice = Dice(11);
    let mut told = 0;
    for docking in dockings() {
        for other in shapes() {
            let mut two = Two::new(Shape::Docking(docking), other.clone());
            for _ in 0..20 {
                let (a, b) = (at(0.0, 0.0, 0.0), dice.frame(0.15));
                let nearest = |two: &mut Two, b: &Frame| {
                    two.find(&a, b, 0.3).iter().copied().min_by(|p, q| p.gap.total_cmp(&q.gap))
                };
                let Some(p) = nearest(&mut two, &b).filter(|p| p.gap > 1e-3) else { continue };
                for k in 0..3 {
                    let axis = Vec3::ith(k, 1.0);
                    let moved = |h: f64| Frame { pos: b.pos + h * axis, ..b };
                    let spun = |h: f64| Frame { rot: turned(h * axis, 0.0, 0.0, 0.0).rot * b.rot, ..b };
                    let gap = |two: &mut Two, f: Frame| nearest(two, &f).unwrap();
                    let (m, n) = (gap(&mut two, moved(-step)), gap(&mut two, moved(step)));
                    let (r, s) = (gap(&mut two, spun(-step)), gap(&mut two, spun(step)));
                    // Where the nearest place changes from one side to the other there is no gradient.
                    if [m, n, r, s].iter().any(|q| (q.normal_w - p.normal_w).norm() > 1e-3) {
                        continue;
                    }
                    told += 1;
                    let slope = (n.gap - m.gap) / (2.0 * step);
                    assert!((slope - p.normal_w[k]).abs() < TOLERANCE, "{docking:?} {other:?}: {slope} {p:?}");
                    let (turn, moment) = ((s.gap - r.gap) / (2.0 * step), (p.point_b_w - b.pos).cross(&p.normal_w)[k]);
                    assert!((turn - moment).abs() < TOLERANCE, "{docking:?} {other:?}: {turn} {moment} {p:?}");
                }
            }
        }
    }
    println!("{told} gradients");
    assert!(told > 1000);
    assert_eq!(TAU, 2.0 * PI);
}
