//! Curves (rims, edges, axes) and the local minima of their distance from a body.
//!
//! With g(u) the distance of the curve's point c(u) and n its gradient, g′ = n · c′ is exact. A distance is semiconcave, so
//! its minima along a curve are smooth points, where g′ passes from − to +. It also changes by no more than the length of
//! the curve between two samples, so stretches that cannot come near are passed over; the rest is halved, more so
//! where the slopes leave room for a hidden pair of extrema, and bracketed; the bracket is closed by the Illinois variant of regula falsi (Dowell and Jarratt 1971). A cold start every
//! time, no history, no allocation.

use super::body::Body;
use super::sheet::Near;
use spatial::Vec3;
use std::f64::consts::TAU;

/// Coarse intervals along a curve, and how many of them are first looked at as one.
const COARSE: usize = 24;
const WIDE: usize = 8;
/// Halvings of each that may come near, passed over where a half cannot.
const FINE: usize = 3;
/// Halvings of an interval of a curve whose slopes leave room for two extrema, and most of them in one scan.
const DEPTH: usize = 3;
const BUDGET: usize = 1000;
/// Most steps of the root finding; a dozen are usual.
const STEPS: usize = 60;
/// Most minima of one curve.
pub(crate) const MOST: usize = 8;

/// A segment or an arc in a common frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Curve {
    /// Start of a segment; centre of an arc.
    origin: Vec3,
    /// A segment's whole length along the first; an arc's two radii.
    arms: [Vec3; 2],
    /// First angle and span of an arc, rad; a segment has none.
    arc: Option<(f64, f64)>,
}

/// A local minimum of the distance from a body along a curve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Minimum {
    /// Place on the curve: an angle, or a fraction of a segment.
    pub(crate) u: f64,
    /// Direction and distance there.
    pub(crate) near: Near,
}

/// The minima found, and what else the scan saw.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scan {
    minima: [Minimum; MOST],
    count: usize,
    budget: usize,
    /// Largest distance of the coarse samples, m; infinite where stretches were passed over.
    pub(crate) far: f64,
    /// The nearest of the coarse samples that were taken.
    pub(crate) nearest: Minimum,
    /// Smaller distance of the two ends, m.
    pub(crate) ends: f64,
}

impl Scan {
    /// The minima along the curve.
    pub(crate) fn minima(&self) -> &[Minimum] {
        &self.minima[..self.count]
    }

    fn push(&mut self, minimum: Minimum) {
        if self.count < MOST {
            self.minima[self.count] = minimum;
            self.count += 1;
        }
    }
}

/// A sample: place, distance, slope.
type Sample = (f64, f64, f64);

/// Something along which a distance is sampled.
pub(crate) trait Path {
    /// First place, span, and how much the distance may change over a unit of it at most; whether it closes.
    fn extent(&self) -> (f64, f64, f64, bool);

    /// Direction and distance at `u`, and the distance's slope.
    fn sample(&self, target: &Body<'_>, u: f64) -> (Near, f64);

    /// How often an interval may be halved where its slopes leave room for two extrema.
    fn halvings(&self, target: &Body<'_>) -> usize;

    /// Minima of the distance from `target` that are below `reach`, in the order of `u`.
    fn scan(&self, target: &Body<'_>, reach: f64) -> Scan
    where
        Self: Sized,
    {
        scan(self, target, reach)
    }
}

impl Curve {
    /// From one point to another.
    pub(crate) fn segment(from: Vec3, to: Vec3) -> Self {
        Self { origin: from, arms: [to - from, Vec3::zeros()], arc: None }
    }

    /// About a centre, from an angle on; `radii`: two perpendicular radii.
    pub(crate) fn arc(centre: Vec3, radii: [Vec3; 2], from: f64, span: f64) -> Self {
        Self { origin: centre, arms: radii, arc: Some((from, span)) }
    }

    /// Whether it is a full circle.
    pub(crate) fn is_closed(&self) -> bool {
        self.arc.is_some_and(|(_, span)| span == TAU)
    }

    /// The point at `u`.
    #[inline]
    pub(crate) fn point(&self, u: f64) -> Vec3 {
        if self.arc.is_none() {
            return self.origin + u * self.arms[0];
        }
        let (s, c) = u.sin_cos();
        self.origin + c * self.arms[0] + s * self.arms[1]
    }
}

impl Path for Curve {
    fn extent(&self) -> (f64, f64, f64, bool) {
        let (from, span) = self.arc.unwrap_or((0.0, 1.0));
        (from, span, self.arms[0].norm(), self.is_closed())
    }

    /// None between two circles: their distance has eight extrema at most, which the fine intervals tell apart.
    fn halvings(&self, target: &Body<'_>) -> usize {
        if self.is_closed() && target.is_ring() { 0 } else { DEPTH }
    }

    #[inline]
    fn sample(&self, target: &Body<'_>, u: f64) -> (Near, f64) {
        let [x, y] = self.arms;
        let (point, tangent) = match self.arc {
            None => (self.origin + u * x, x),
            Some(_) => {
                let (s, c) = u.sin_cos();
                (self.origin + c * x + s * y, c * y - s * x)
            }
        };
        let near = target.nearest(&point);
        (near, near.normal.dot(&tangent))
    }
}

fn sample(path: &impl Path, target: &Body<'_>, u: f64) -> Sample {
    let (near, slope) = path.sample(target, u);
    (u, near.distance, slope)
}

fn minimum(path: &impl Path, target: &Body<'_>, u: f64) -> Minimum {
    Minimum { u, near: path.sample(target, u).0 }
}

fn scan(path: &impl Path, target: &Body<'_>, reach: f64) -> Scan {
    let (from, span, speed, is_closed) = path.extent();
    let step = span / COARSE as f64;
    let first = sample(path, target, from);
    let start = Minimum { u: from, near: Near { normal: Vec3::z(), distance: f64::INFINITY } };
    let mut scan =
        Scan { minima: [start; MOST], count: 0, budget: BUDGET, far: first.1, nearest: start, ends: first.1 };
    let mut search = Search { path, target, reach, speed, best: first, scan: &mut scan };
    let mut before = first;
    for i in (WIDE..=COARSE).step_by(WIDE) {
        let u = from + step * i as f64;
        let after = if is_closed && i == COARSE { (u, first.1, first.2) } else { sample(path, target, u) };
        search.note(after);
        search.coarsely((before, i - WIDE), (after, i), (from, step));
        before = after;
    }
    let best = search.best;
    scan.ends = scan.ends.min(before.1);
    scan.nearest = minimum(path, target, best.0);
    scan
}

/// A scan under way.
struct Search<'a, P> {
    path: &'a P,
    target: &'a Body<'a>,
    reach: f64,
    speed: f64,
    /// The nearest of the coarse samples.
    best: Sample,
    scan: &'a mut Scan,
}

impl<P: Path> Search<'_, P> {
    /// No place between two samples is nearer than the mean of both less half the way between them.
    fn stays_away(&self, a: &Sample, b: &Sample) -> bool {
        0.5 * (a.1 + b.1 - (b.0 - a.0) * self.speed) >= self.reach
    }

    fn note(&mut self, sample: Sample) {
        self.scan.far = self.scan.far.max(sample.1);
        if sample.1 < self.best.1 {
            self.best = sample;
        }
    }

    /// Between the coarse samples of these numbers.
    fn coarsely(&mut self, (a, i): (Sample, usize), (b, j): (Sample, usize), (from, step): (f64, f64)) {
        if self.stays_away(&a, &b) {
            // What is passed over does not touch.
            self.scan.far = f64::INFINITY;
        } else if j - i == 1 {
            self.finely(a, b, FINE);
        } else {
            let k = (i + j) / 2;
            let middle = sample(self.path, self.target, from + step * k as f64);
            self.note(middle);
            self.coarsely((a, i), (middle, k), (from, step));
            self.coarsely((middle, k), (b, j), (from, step));
        }
    }

    fn finely(&mut self, a: Sample, b: Sample, halvings: usize) {
        if halvings == 0 {
            return self.split(a, b, self.path.halvings(self.target));
        }
        if self.stays_away(&a, &b) {
            return;
        }
        let middle = sample(self.path, self.target, 0.5 * (a.0 + b.0));
        self.finely(a, middle, halvings - 1);
        self.finely(middle, b, halvings - 1);
    }

    /// Notes the minimum between two samples; halves the stretch where there may be more extrema than its ends tell.
    fn split(&mut self, a: Sample, b: Sample, depth: usize) {
        if self.stays_away(&a, &b) {
            return;
        }
        if depth > 0 && self.scan.budget > 0 && may_hide(self.speed, &a, &b) {
            self.scan.budget -= 1;
            let middle = sample(self.path, self.target, 0.5 * (a.0 + b.0));
            self.split(a, middle, depth - 1);
            return self.split(middle, b, depth - 1);
        }
        if a.2 < 0.0 && b.2 >= 0.0 {
            let u = find_root(&|u| self.path.sample(self.target, u).1, (a.0, a.2), (b.0, b.2));
            let found = minimum(self.path, self.target, u);
            if found.near.distance < self.reach {
                self.scan.push(found);
            }
        }
    }
}

/// Whether a minimum may lie between two samples that their slopes do not tell of. A distance d bends upwards by at most
/// the speed squared over d (an arc's own bend adds as much again at most where it is not much smaller than d), so a
/// slope does not rise through zero to more than that times the stretch.
fn may_hide(speed: f64, a: &Sample, b: &Sample) -> bool {
    let rise = 2.0 * speed * speed / a.1.min(b.1).max(f64::MIN_POSITIVE) * (b.0 - a.0);
    let (falls, rises) = (-a.2 < rise, b.2 < rise);
    match (a.2 < 0.0, b.2 < 0.0) {
        (true, true) => falls,
        (false, false) => rises,
        (true, false) => falls && rises,
        (false, true) => false,
    }
}

/// Where a slope passes from − at `a` to + at `b`.
pub(crate) fn find_root(slope: &dyn Fn(f64) -> f64, a: (f64, f64), b: (f64, f64)) -> f64 {
    let ((mut a, mut fa), (mut b, mut fb)) = (a, b);
    let mut last = 0;
    for _ in 0..STEPS {
        let c = (a * fb - b * fa) / (fb - fa);
        if !(c > a && c < b) {
            break;
        }
        let fc = slope(c);
        if fc < 0.0 {
            (a, fa) = (c, fc);
            fb *= if last < 0 { 0.5 } else { 1.0 };
            last = -1;
        } else {
            (b, fb) = (c, fc);
            fa *= if last > 0 { 0.5 } else { 1.0 };
            last = 1;
        }
        if fc == 0.0 {
            return c;
        }
    }
    if -fa < fb { a } else { b }
}
