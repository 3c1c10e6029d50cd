//! Where two patches overlap, seen along the contact normal.
//!
//! Both patches are projected along n. The corners of their overlap are the contact points, and each is one of
//!   a vertex of B inside A's patch · a vertex of A inside B's patch · an edge of A that crosses an edge of B.
//! The height of a point over each patch's plane, along n, gives its two witness points.
//!
//! Faces that lie flush have corners that are all three at once, and round-off would choose among them. So "inside"
//! has a tolerance, and a point that coincides with an earlier one is dropped: vertices of B win over those of A, and
//! those over crossings. Edges that part by less than the tolerance over their whole length do not cross: their ends say
//! the same.

use crate::patch::{Corner, Patch, tangents};
use spatial::Vec3;

/// Sine of the angle below which two lone edges touch along a line (two points) instead of crossing (one).
const LINE: f64 = 5e-3;
/// Cosine between n and a face's normal below which the face is seen edge-on and its plane has no height.
const EDGE_ON: f64 = 0.05;

/// A corner in the plane across n.
#[derive(Clone, Copy, Debug)]
struct Flat {
    x: f64,
    y: f64,
    /// Height along n, m.
    h: f64,
    vertex: u32,
    edge: u32,
    /// Unit direction and length of the edge to the next corner, and the rise of h per length.
    dx: f64,
    dy: f64,
    len: f64,
    rise: f64,
}

/// A projected patch.
#[derive(Debug, Default)]
struct Side {
    flats: Vec<Flat>,
    whole: u32,
    /// Rise of the plane's height per metre of x and y; `None` where it is seen edge-on.
    slope: Option<(f64, f64)>,
}

/// A corner of the overlap, with the heights of both patches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting {
    x: f64,
    y: f64,
    height_a: f64,
    height_b: f64,
    /// Feature of A.
    fa: u32,
    /// Feature of B.
    fb: u32,
}

impl Meeting {
    /// Height of B over A, m.
    #[inline]
    pub(crate) fn gap(&self) -> f64 {
        self.height_b - self.height_a
    }

    /// What met what.
    #[inline]
    pub(crate) fn feature(&self) -> u64 {
        (u64::from(self.fa) << 32) | u64::from(self.fb)
    }
}

/// Scratch for one overlap.
#[derive(Debug, Default)]
pub(crate) struct Overlap {
    a: Side,
    b: Side,
    axes: (Vec3, Vec3),
    n: Vec3,
    tol: f64,
    /// What was found.
    pub(crate) found: Vec<Meeting>,
}

impl Overlap {
    /// Finds the corners of the overlap of `a` and `b` along `n` (from A to B); `tol`: length below which points coincide.
    pub(crate) fn find(&mut self, a: &Patch, b: &Patch, n: &Vec3, tol: f64) {
        self.found.clear();
        self.axes = tangents(n);
        (self.n, self.tol) = (*n, tol);
        self.a.project(a, n, &self.axes, 1.0, tol);
        self.b.project(b, n, &self.axes, -1.0, tol);
        if self.a.flats.len() == 2 && self.b.flats.len() == 2 && self.is_line() {
            return self.find_line();
        }
        self.find_vertices_of_b();
        self.find_vertices_of_a();
        self.find_crossings();
    }

    /// Witness points of a meeting on the two patches.
    #[inline]
    pub(crate) fn witnesses(&self, m: &Meeting) -> (Vec3, Vec3) {
        let p = m.x * self.axes.0 + m.y * self.axes.1;
        (p + m.height_a * self.n, p + m.height_b * self.n)
    }

    fn find_vertices_of_b(&mut self) {
        for i in 0..self.b.flats.len() {
            let f = self.b.flats[i];
            if self.a.has_inside(f.x, f.y, self.tol)
                && let Some(height_a) = self.a.height(f.x, f.y)
            {
                let (fa, fb) = (self.a.whole, f.vertex);
                self.push(Meeting { x: f.x, y: f.y, height_a, height_b: f.h, fa, fb });
            }
        }
    }

    fn find_vertices_of_a(&mut self) {
        for i in 0..self.a.flats.len() {
            let f = self.a.flats[i];
            if self.b.has_inside(f.x, f.y, self.tol)
                && let Some(height_b) = self.b.height(f.x, f.y)
            {
                let (fa, fb) = (f.vertex, self.b.whole);
                self.push(Meeting { x: f.x, y: f.y, height_a: f.h, height_b, fa, fb });
            }
        }
    }

    fn find_crossings(&mut self) {
        for i in 0..self.a.edges() {
            for j in 0..self.b.edges() {
                if let Some(m) = cross(&self.a.flats[i], &self.b.flats[j], self.tol) {
                    self.push(m);
                }
            }
        }
    }

    fn is_line(&self) -> bool {
        let (e, f) = (&self.a.flats[0], &self.b.flats[0]);
        (e.dx * f.dy - e.dy * f.dx).abs() < LINE
    }

    /// Two lone edges side by side: the ends of each that lie within the other.
    fn find_line(&mut self) {
        let (e, f) = (self.a.flats[0], self.b.flats[0]);
        for end in [self.b.flats[0], self.b.flats[1]] {
            let s = (end.x - e.x) * e.dx + (end.y - e.y) * e.dy;
            if s >= -self.tol && s <= e.len + self.tol {
                let (height_a, height_b) = (e.h + e.rise * s, end.h);
                self.push(Meeting { x: end.x, y: end.y, height_a, height_b, fa: e.edge, fb: end.vertex });
            }
        }
        for end in [self.a.flats[0], self.a.flats[1]] {
            let s = (end.x - f.x) * f.dx + (end.y - f.y) * f.dy;
            if s >= -self.tol && s <= f.len + self.tol {
                let (height_a, height_b) = (end.h, f.h + f.rise * s);
                self.push(Meeting { x: end.x, y: end.y, height_a, height_b, fa: end.vertex, fb: f.edge });
            }
        }
    }

    #[inline]
    fn push(&mut self, m: Meeting) {
        let near = 4.0 * self.tol;
        if !self.found.iter().any(|o| (o.x - m.x).abs() <= near && (o.y - m.y).abs() <= near) {
            self.found.push(m);
        }
    }
}

impl Side {
    /// Projects a patch; `toward` is +1 for A, whose surface looks along n, and −1 for B.
    fn project(&mut self, patch: &Patch, n: &Vec3, axes: &(Vec3, Vec3), toward: f64, tol: f64) {
        self.whole = patch.whole;
        self.flats.clear();
        let facing = patch.normal.dot(n);
        let corners = &patch.corners;
        if corners.len() >= 3 && facing < 0.0 {
            // Clockwise seen along n: turned about, each edge kept with the corner that it now leaves.
            for i in (0..corners.len()).rev() {
                let before = if i == 0 { corners.len() - 1 } else { i - 1 };
                self.flats.push(flatten(&Corner { edge: corners[before].edge, ..corners[i] }, n, axes));
            }
        } else {
            self.flats.extend(corners.iter().map(|c| flatten(c, n, axes)));
        }
        self.measure_edges();
        if self.flats.len() == 2 && self.flats[0].len <= 8.0 * tol {
            // Seen end-on: the end that looks at the other body.
            let keep = usize::from(toward * self.flats[1].h > toward * self.flats[0].h);
            self.flats.swap(0, keep);
            self.flats.truncate(1);
        }
        let plane = corners.len() >= 3 && facing.abs() > EDGE_ON;
        self.slope = plane.then(|| (-patch.normal.dot(&axes.0) / facing, -patch.normal.dot(&axes.1) / facing));
    }

    fn measure_edges(&mut self) {
        let n = self.flats.len();
        for i in 0..n {
            let (p, q) = (self.flats[i], self.flats[if i + 1 == n { 0 } else { i + 1 }]);
            let (dx, dy) = (q.x - p.x, q.y - p.y);
            let len = (dx * dx + dy * dy).sqrt();
            let inv = if len > 0.0 { 1.0 / len } else { 0.0 };
            let f = &mut self.flats[i];
            (f.dx, f.dy, f.len, f.rise) = (dx * inv, dy * inv, len, (q.h - p.h) * inv);
        }
    }

    #[inline]
    fn edges(&self) -> usize {
        if self.flats.len() >= 3 { self.flats.len() } else { self.flats.len() - 1 }
    }

    /// Whether (x, y) lies within the patch or `tol` beside it.
    #[inline]
    fn has_inside(&self, x: f64, y: f64, tol: f64) -> bool {
        let across = |f: &Flat| f.dx * (y - f.y) - f.dy * (x - f.x);
        match self.flats.as_slice() {
            [f] => (x - f.x).hypot(y - f.y) <= tol,
            [f, _] => {
                let along = f.dx * (x - f.x) + f.dy * (y - f.y);
                across(f).abs() <= tol && along >= -tol && along <= f.len + tol
            }
            flats => flats.iter().all(|f| across(f) >= -tol),
        }
    }

    /// Height of the patch over (x, y), m.
    #[inline]
    fn height(&self, x: f64, y: f64) -> Option<f64> {
        let f = &self.flats[0];
        match (self.flats.len(), self.slope) {
            (1, _) => Some(f.h),
            (2, _) => Some(f.h + f.rise * (f.dx * (x - f.x) + f.dy * (y - f.y))),
            (_, Some((sx, sy))) => Some(f.h + sx * (x - f.x) + sy * (y - f.y)),
            _ => None,
        }
    }
}

#[inline]
fn flatten(c: &Corner, n: &Vec3, axes: &(Vec3, Vec3)) -> Flat {
    let (x, y, h) = (c.p.dot(&axes.0), c.p.dot(&axes.1), c.p.dot(n));
    Flat { x, y, h, vertex: c.vertex, edge: c.edge, dx: 0.0, dy: 0.0, len: 0.0, rise: 0.0 }
}

/// The crossing of two edges, if they cross within their lengths.
#[inline]
fn cross(e: &Flat, f: &Flat, tol: f64) -> Option<Meeting> {
    let sine = e.dx * f.dy - e.dy * f.dx;
    if sine.abs() * e.len.max(f.len) < tol {
        return None;
    }
    let (wx, wy) = (f.x - e.x, f.y - e.y);
    // Along e and along f, times the sine: the range is checked before anything is divided.
    let (s, t) = ((wx * f.dy - wy * f.dx) * sine.signum(), (wx * e.dy - wy * e.dx) * sine.signum());
    let size = sine.abs();
    let within = |u: f64, len: f64| u >= -tol * size && u <= (len + tol) * size;
    if !within(s, e.len) || !within(t, f.len) {
        return None;
    }
    let (s, t) = (s / size, t / size);
    let (x, y) = (e.x + s * e.dx, e.y + s * e.dy);
    Some(Meeting { x, y, height_a: e.h + e.rise * s, height_b: f.h + f.rise * t, fa: e.edge, fb: f.edge })
}
