//! Curves (rims, edges, axes) and the local minima of their distance from a body.
//!
//! With g(u) the distance of the curve's point c(u) and n its gradient, g′ = n · c′ is exact. A distance is semiconcave, so
//! its minima along a curve are smooth points, where g′ passes from − to +. It also changes by no more than the length of
//! the curve between two samples, so stretches that cannot come near are passed over, and the rest is sampled finely and
//! bracketed; the bracket is closed by the Illinois variant of regula falsi (Dowell and Jarratt 1971). A cold start every
//! time, no history, no allocation.

use super::body::Body;
use super::sheet::Near;
use spatial::Vec3;
use std::f64::consts::TAU;

/// Coarse intervals along a curve.
const COARSE: usize = 24;
/// Fine intervals in each that may come near.
const FINE: usize = 6;
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
    /// Largest distance of the coarse samples, m.
    pub(crate) far: f64,
    /// The nearest of the coarse samples.
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

    #[inline]
    fn tangent(&self, u: f64) -> Vec3 {
        if self.arc.is_none() {
            return self.arms[0];
        }
        let (s, c) = u.sin_cos();
        c * self.arms[1] - s * self.arms[0]
    }

    #[inline]
    fn sample(&self, target: &Body<'_>, u: f64) -> Sample {
        let near = target.nearest(&self.point(u));
        (u, near.distance, near.normal.dot(&self.tangent(u)))
    }

    /// Minima of the distance from `target` that are below `reach`, in the order of `u`.
    pub(crate) fn scan(&self, target: &Body<'_>, reach: f64) -> Scan {
        let (from, span) = self.arc.unwrap_or((0.0, 1.0));
        let step = span / COARSE as f64;
        let first = self.sample(target, from);
        let start = Minimum { u: from, near: Near { normal: Vec3::z(), distance: f64::INFINITY } };
        let mut scan =
            Scan { minima: [start; MOST], count: 0, far: first.1, nearest: Minimum { u: from, ..start }, ends: first.1 };
        let (mut best, mut before) = (first, first);
        for i in 1..=COARSE {
            let closes = self.is_closed() && i == COARSE;
            let sample = self.sample(target, if closes { from } else { from + step * i as f64 });
            let after = if closes { (from + span, sample.1, sample.2) } else { sample };
            // No point between two samples is nearer than the mean of both less half the way between them.
            if 0.5 * (before.1 + after.1 - step * self.speed()) < reach {
                self.scan_finely(target, (before, after), &mut scan);
            }
            scan.far = scan.far.max(after.1);
            if after.1 < best.1 {
                best = after;
            }
            before = after;
        }
        scan.ends = scan.ends.min(before.1);
        scan.nearest = Minimum { u: best.0, near: target.nearest(&self.point(best.0)) };
        scan
    }

    fn speed(&self) -> f64 {
        self.arms[0].norm()
    }

    fn scan_finely(&self, target: &Body<'_>, (from, to): (Sample, Sample), scan: &mut Scan) {
        let mut before = from;
        for i in 1..=FINE {
            let after = if i == FINE {
                to
            } else {
                self.sample(target, from.0 + (to.0 - from.0) * i as f64 / FINE as f64)
            };
            if before.2 < 0.0 && after.2 >= 0.0 {
                let u = self.find_root(target, before, after);
                scan.push(Minimum { u, near: target.nearest(&self.point(u)) });
            }
            before = after;
        }
    }

    /// Where the slope passes from − to +.
    fn find_root(&self, target: &Body<'_>, a: Sample, b: Sample) -> f64 {
        let (mut a, mut fa, mut b, mut fb) = (a.0, a.2, b.0, b.2);
        let mut last = 0;
        for _ in 0..STEPS {
            let c = (a * fb - b * fa) / (fb - fa);
            if !(c > a && c < b) {
                break;
            }
            let fc = self.sample(target, c).2;
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
}
