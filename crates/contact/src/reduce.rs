//! Bounds the number of points of a pair, and keeps what they do together.
//!
//! Faces that meet in many corners (a round plate of many sides) give more points than a step can afford. At most
//! [`MOST`] stay, with weights w by which the pair's law is multiplied there. With x, y: place across the normal from the
//! mean of all N points,
//!
//!   Σ w φ = Σ φ  over all N,   φ = 1, x, y, x², x y, y², |x|
//!
//! so that for every pressure that is linear over the face (a rigid body on springs) force, centre of pressure and tilting
//! stiffness are those of all points, and for a uniform pressure the moment of friction of a spin, μ p Σ w |x|, too. Of all
//! such weights they are the nearest to N/16: w = N/16 + Φᵀ λ; where one would be negative it is zero and the rest answer.
//!
//! # Which points stay
//!
//! The farthest from the mean, then always the one farthest from those kept; of points as far within a millionth, the one of
//! the smaller feature. Gaps have no say, so a body that slides or rocks keeps its points for as long as it has the same
//! ones in the same places on it. Weights depend on the places smoothly.
//!
//! # Where this holds
//!
//! For points of one normal whose gaps lie in a plane: a face on a face. Others (a knobbly mesh, of which few points bear)
//! keep the deepest point and the most spread, of weight 1: force and centre of pressure are then not those of all points.

use crate::analytic::Raw;
use crate::patch::tangents;
use spatial::Vec3;
use spatial::nalgebra::{SMatrix, SVector};

/// Most points of one pair.
pub(crate) const MOST: usize = 16;
/// Sums that are kept.
const SUMS: usize = 7;
/// Part by which a distance must be greater to count as greater: above round-off.
const FARTHER: f64 = 1e-6;
/// How far gaps may be from a plane, in extents of the face, and normals from each other, rad.
const FLAT: f64 = 1e-6;
/// Regularisation of dependent sums (all points on one circle), relative to the largest.
const RIDGE: f64 = 1e-12;
/// Rounds of taking out negative weights.
const ROUNDS: usize = 8;

type Sums = SVector<f64, SUMS>;

/// Scratch of the reduction, and the weights of the points that it left.
#[derive(Default)]
pub(crate) struct Reduction {
    nearest: Vec<f64>,
    /// (x, y) across the normal from the mean, in radii of the farthest.
    places: Vec<[f64; 2]>,
    weights: Vec<f64>,
}

impl Reduction {
    /// Keeps at most [`MOST`] of points that are sorted by feature; sorted they stay.
    pub(crate) fn reduce(&mut self, points: &mut Vec<Raw>) {
        self.weights.clear();
        if points.len() <= MOST {
            return;
        }
        let mean = points.iter().map(|p| p.point_a).sum::<Vec3>() / points.len() as f64;
        let size = points.iter().map(|p| (p.point_a - mean).norm()).fold(0.0, f64::max);
        let flat = self.lies_flat(points, &mean, size);
        let total = self.places.iter().map(calc_sums).sum::<Sums>();
        let count = points.len() as f64;
        self.choose(points, |p| if flat { (p.point_a - mean).norm_squared() } else { -p.gap });
        points.sort_unstable_by_key(|p| p.feature);
        if flat {
            self.place(points, &mean, size);
            self.weigh(&total, count / MOST as f64);
        }
    }

    /// Weight of the point at this place in the list that [`Self::reduce`] left.
    pub(crate) fn weight_of(&self, index: usize) -> f64 {
        self.weights.get(index).copied().unwrap_or(1.0)
    }

    /// Whether the points have one normal and gaps in one plane; their places are `places` then.
    fn lies_flat(&mut self, points: &[Raw], mean: &Vec3, size: f64) -> bool {
        let normal = points[0].normal;
        if size <= 0.0 || points.iter().any(|p| (p.normal - normal).norm_squared() > FLAT * FLAT) {
            return false;
        }
        self.place(points, mean, size);
        let row = |p: &[f64; 2]| SVector::<f64, 3>::new(1.0, p[0], p[1]);
        let square: SMatrix<f64, 3, 3> = self.places.iter().map(|p| row(p) * row(p).transpose()).sum();
        let right: SVector<f64, 3> = self.places.iter().zip(points).map(|(p, q)| row(p) * q.gap).sum();
        let Some(plane) = square.cholesky().map(|c| c.solve(&right)) else { return false };
        self.places.iter().zip(points).all(|(p, q)| (row(p).dot(&plane) - q.gap).abs() <= FLAT * size)
    }

    fn place(&mut self, points: &[Raw], mean: &Vec3, size: f64) {
        let (x, y) = tangents(&points[0].normal);
        self.places.clear();
        self.places.extend(points.iter().map(|p| {
            let arm = (p.point_a - mean) / size;
            [arm.dot(&x), arm.dot(&y)]
        }));
    }

    /// Keeps the first by `rank`, then always the point farthest from those kept; of equals the first in the list.
    fn choose(&mut self, points: &mut Vec<Raw>, rank: impl Fn(&Raw) -> f64) {
        let nearest = &mut self.nearest;
        nearest.clear();
        nearest.extend(points.iter().map(rank));
        for kept in 0..MOST {
            let mut best = kept;
            for i in kept + 1..points.len() {
                let ahead = nearest[i] - nearest[best];
                let even = ahead.abs() <= FARTHER * nearest[best].abs();
                if (!even && ahead > 0.0) || (even && points[i].feature < points[best].feature) {
                    best = i;
                }
            }
            points.swap(kept, best);
            nearest.swap(kept, best);
            let last = points[kept].point_a;
            for i in kept + 1..points.len() {
                let distance = (points[i].point_a - last).norm_squared();
                nearest[i] = if kept == 0 { distance } else { nearest[i].min(distance) };
            }
        }
        points.truncate(MOST);
    }

    /// Weights nearest to `even` whose sums are `total`; none negative.
    fn weigh(&mut self, total: &Sums, even: f64) {
        let Self { places, weights, .. } = self;
        weights.resize(places.len(), even);
        for _ in 0..ROUNDS {
            let free = |w: f64| w > 0.0;
            let (mut square, mut missing) = (SMatrix::<f64, SUMS, SUMS>::zeros(), *total);
            for (p, &w) in places.iter().zip(weights.iter()).filter(|(_, w)| free(**w)) {
                let row = calc_sums(p);
                square += row * row.transpose();
                missing -= row * w;
            }
            let ridge = RIDGE * square.diagonal().max();
            let Some(solved) = (square + SMatrix::identity() * ridge).cholesky() else { return };
            let mut factor = solved.solve(&missing);
            factor += solved.solve(&(missing - square * factor));
            let steps = places.iter().zip(weights.iter_mut()).filter(|(_, w)| free(**w));
            steps.for_each(|(p, w)| *w = (*w + calc_sums(p).dot(&factor)).max(0.0));
            if weights.iter().all(|&w| free(w)) || missing.norm() <= 1e-12 * total.norm() {
                return;
            }
        }
    }
}

/// The functions whose sums are kept, at a place.
fn calc_sums([x, y]: &[f64; 2]) -> Sums {
    Sums::from_column_slice(&[1.0, *x, *y, x * x, x * y, y * y, x.hypot(*y)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Reads off force, first moments, and spin moment of springs under a plane pressure, at weights.
    fn effects(points: &[(Raw, f64)], slope: [f64; 2], about: &Vec3) -> [f64; 4] {
        let mut out = [0.0; 4];
        for (p, w) in points {
            let arm = p.point_a - about;
            let force = w * (1.0 + slope[0] * arm.x + slope[1] * arm.y);
            let spin = w * arm.norm();
            [force, force * arm.x, force * arm.y, spin].iter().zip(&mut out).for_each(|(part, sum)| *sum += part);
        }
        out
    }

    fn outline(count: u64, place: impl Fn(f64) -> (f64, f64)) -> Vec<Raw> {
        let point = |i: u64| {
            let (x, y) = place(i as f64);
            Raw { feature: i * 7 % count, point_a: Vec3::new(x, y, 0.0), normal: Vec3::z(), gap: -1e-5 }
        };
        let mut points: Vec<Raw> = (0..count).map(point).collect();
        points.sort_unstable_by_key(|p| p.feature);
        points
    }

    /// Outlines with many corners: a regular one, an ellipse, a rack of teeth, a filled grid.
    fn faces() -> Vec<Vec<Raw>> {
        vec![
            outline(48, |i| (0.1 * (i / 48.0 * TAU).cos(), 0.1 * (i / 48.0 * TAU).sin())),
            outline(37, |i| (0.2 * (i / 37.0 * TAU).cos() + 0.5, 0.07 * (i / 37.0 * TAU).sin())),
            outline(40, |i| (0.01 * i, if (i as u32) % 4 < 2 { 0.02 } else { -0.03 })),
            outline(81, |i| (0.02 * (i % 9.0), 0.03 * (i / 9.0).floor())),
        ]
    }

    fn reduced(points: &[Raw]) -> Vec<(Raw, f64)> {
        let (mut kept, mut reduction) = (points.to_vec(), Reduction::default());
        reduction.reduce(&mut kept);
        assert_eq!(kept.len(), MOST);
        kept.into_iter().enumerate().map(|(i, p)| (p, reduction.weight_of(i))).collect()
    }

    #[test]
    fn force_centre_of_pressure_tilt_and_spin_are_those_of_all_points() {
        for (face, points) in faces().into_iter().enumerate() {
            let about = points.iter().map(|p| p.point_a).sum::<Vec3>() / points.len() as f64;
            let all: Vec<(Raw, f64)> = points.iter().map(|p| (*p, 1.0)).collect();
            let few = reduced(&points);
            assert!(few.iter().all(|(_, w)| *w >= 0.0), "{few:?}");
            for slope in [[0.0, 0.0], [3.0, 0.0], [-1.0, 2.0]] {
                let (full, kept) = (effects(&all, slope, &about), effects(&few, slope, &about));
                for (f, k) in full.iter().zip(&kept) {
                    assert!((f - k).abs() < 1e-9 * full[0], "face {face}: {full:?} {kept:?}");
                }
            }
        }
    }

    #[test]
    fn the_same_points_stay_while_a_face_slides_turns_and_rocks() {
        for points in faces() {
            let names = |points: &[(Raw, f64)]| points.iter().map(|(p, _)| p.feature).collect::<Vec<_>>();
            let first = reduced(&points);
            for i in 0..500 {
                let t = f64::from(i);
                let turn = spatial::rotation_about(&Vec3::z(), 0.013 * t);
                let lean = 1e-4 * (0.7 * t).sin();
                let moved: Vec<Raw> = points
                    .iter()
                    .map(|p| Raw {
                        point_a: turn * p.point_a + Vec3::new(1e-3 * t, -2e-3 * t, 0.0),
                        gap: p.gap + lean * p.point_a.x,
                        ..*p
                    })
                    .collect();
                let now = reduced(&moved);
                assert_eq!(names(&now), names(&first), "step {i}");
                let same = now.iter().zip(&first).all(|((_, w), (_, v))| (w - v).abs() < 1e-8);
                assert!(same, "step {i}: {now:?} {first:?}");
            }
        }
    }

    #[test]
    fn a_knobbly_surface_keeps_its_deepest_point() {
        let mut points = outline(60, |i| (0.01 * i, 0.03 * (3.0 * i).sin()));
        points.iter_mut().for_each(|p| p.gap = -1e-3 * (40.0 * p.point_a.x).sin().abs());
        let deepest = points.iter().map(|p| p.gap).fold(0.0, f64::min);
        assert!(reduced(&points).iter().any(|(p, w)| p.gap == deepest && *w == 1.0));
    }
}
