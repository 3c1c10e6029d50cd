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

use crate::patch::{Corner, Disc, Patch, tangents};
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

/// A disc seen along n: its body-fixed coordinates are affine in x and y.
#[derive(Clone, Copy, Debug)]
struct FlatDisc {
    at_origin: [f64; 2],
    per_x: [f64; 2],
    per_y: [f64; 2],
    radius: f64,
    rim: u32,
}

/// A projected patch.
#[derive(Debug, Default)]
struct Side {
    flats: Vec<Flat>,
    whole: u32,
    /// Rise of the plane's height per metre of x and y; `None` where it is seen edge-on.
    slope: Option<(f64, f64)>,
    disc: Option<FlatDisc>,
}

/// Where a lying cylinder is nearest to an edge that its line crosses, seen along n.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bulging {
    /// Cosine between n and the common perpendicular of edge and line.
    pub(crate) upright: f64,
    /// How far towards the nearest place the edge goes on, 0 to 1.
    pub(crate) along_edge: f64,
    /// How far towards the nearest place the line goes on, 0 to 1.
    pub(crate) along_line: f64,
}

/// A corner of the overlap, with the heights of both patches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting {
    x: f64,
    y: f64,
    height_a: f64,
    height_b: f64,
    /// Feature of A.
    pub(crate) fa: u32,
    /// Feature of B.
    pub(crate) fb: u32,
    /// Where an edge crosses the line of a lying cylinder or capsule.
    pub(crate) bulge: Option<Bulging>,
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
    /// Radius of the lying cylinder or capsule, m; zero if there is none.
    pub(crate) round: f64,
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
                self.push(Meeting { x: f.x, y: f.y, height_a, height_b: f.h, fa, fb, bulge: None });
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
                self.push(Meeting { x: f.x, y: f.y, height_a: f.h, height_b, fa, fb, bulge: None });
            }
        }
    }

    fn find_crossings(&mut self) {
        match (self.a.disc, self.b.disc) {
            (Some(disc), None) => return self.find_rim_crossings(&disc, true),
            (None, Some(disc)) => return self.find_rim_crossings(&disc, false),
            _ => {}
        }
        let lone = self.round > 0.0 && (self.a.flats.len() == 2) != (self.b.flats.len() == 2);
        for i in 0..self.a.edges() {
            for j in 0..self.b.edges() {
                let (e, f) = (&self.a.flats[i], &self.b.flats[j]);
                if let Some(m) = cross(e, f, self.tol) {
                    let bulge = if lone { self.bulge_at(&m, (e, f)) } else { None };
                    self.push(Meeting { bulge, ..m });
                }
            }
        }
    }

    /// Where the edges of one side cross the rim of the other, which is A's if `on_a`.
    fn find_rim_crossings(&mut self, disc: &FlatDisc, on_a: bool) {
        let edges = if on_a { self.b.edges() } else { self.a.edges() };
        let lone = edges == 1 && self.round > 0.0;
        for i in 0..edges {
            let (edge, side) = if on_a { (self.b.flats[i], &self.a) } else { (self.a.flats[i], &self.b) };
            let at = |s: f64| (edge.x + s * edge.dx, edge.y + s * edge.dy, edge.h + edge.rise * s);
            let hits = disc.crossings(&edge, self.tol);
            // An edge enters the disc once and leaves it once: that, not the place on the rim, is the feature.
            let found = [(hits[0], disc.rim), (hits[1], disc.rim + 1)].map(|(hit, rim)| {
                let (x, y, on_edge) = at(hit?);
                let on_disc = side.height(x, y)?;
                let bulge = side.slope.filter(|_| lone).map(|slope| {
                    let rim = (disc.along(x, y, slope), [f64::INFINITY; 2]);
                    let (along, ends) = edge.seen_from(x, y);
                    calc_bulge((&rim.0, rim.1), (&along, ends), if on_a { self.round } else { -self.round })
                });
                Some(if on_a {
                    Meeting { x, y, height_a: on_disc, height_b: on_edge, fa: rim, fb: edge.edge, bulge }
                } else {
                    Meeting { x, y, height_a: on_edge, height_b: on_disc, fa: edge.edge, fb: rim, bulge }
                })
            });
            found.into_iter().flatten().for_each(|m| self.push(m));
        }
    }

    /// The bulge of the lying cylinder where its line crosses an edge.
    fn bulge_at(&self, m: &Meeting, (e, f): (&Flat, &Flat)) -> Option<Bulging> {
        let line_is_a = self.a.flats.len() == 2;
        let (edge, line) = if line_is_a { (f, e) } else { (e, f) };
        let ((e, ends_e), (f, ends_f)) = (edge.seen_from(m.x, m.y), line.seen_from(m.x, m.y));
        Some(calc_bulge((&e, ends_e), (&f, ends_f), if line_is_a { -self.round } else { self.round }))
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
                self.push(Meeting { x: end.x, y: end.y, height_a, height_b, fa: e.edge, fb: end.vertex, bulge: None });
            }
        }
        for end in [self.a.flats[0], self.a.flats[1]] {
            let s = (end.x - f.x) * f.dx + (end.y - f.y) * f.dy;
            if s >= -self.tol && s <= f.len + self.tol {
                let (height_a, height_b) = (end.h, f.h + f.rise * s);
                self.push(Meeting { x: end.x, y: end.y, height_a, height_b, fa: end.vertex, fb: f.edge, bulge: None });
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
        self.disc = None;
        self.slope = plane.then(|| (-patch.normal.dot(&axes.0) / facing, -patch.normal.dot(&axes.1) / facing));
        if let (Some(disc), Some(slope), Some(f)) = (&patch.disc, self.slope, self.flats.first()) {
            self.disc = Some(flatten_disc(disc, n, axes, (f, slope)));
        }
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
        if let Some(disc) = &self.disc {
            let [u, v] = disc.coordinates(x, y);
            return u * u + v * v <= (disc.radius + tol) * (disc.radius + tol);
        }
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

/// A disc's coordinates over the plane across n: of the point of its own plane over (x, y).
fn flatten_disc(disc: &Disc, n: &Vec3, axes: &(Vec3, Vec3), (f, (sx, sy)): (&Flat, (f64, f64))) -> FlatDisc {
    let origin = n * (f.h - sx * f.x - sy * f.y) - disc.centre;
    let [at_origin, per_x, per_y] =
        [origin, axes.0 + n * sx, axes.1 + n * sy].map(|p| [disc.axes[0].dot(&p), disc.axes[1].dot(&p)]);
    FlatDisc { at_origin, per_x, per_y, radius: disc.radius, rim: disc.rim }
}

impl Flat {
    /// Direction along the edge, per length across n (x, y, rise), and how far its ends are from (x, y), back and on.
    fn seen_from(&self, x: f64, y: f64) -> (Vec3, [f64; 2]) {
        let along = (x - self.x) * self.dx + (y - self.y) * self.dy;
        (Vec3::new(self.dx, self.dy, self.rise), [along, self.len - along])
    }
}

impl FlatDisc {
    /// Along the rim at (x, y), as [`Flat::seen_from`].
    fn along(&self, x: f64, y: f64, slope: (f64, f64)) -> Vec3 {
        let [u, v] = self.coordinates(x, y);
        let out = |per: &[f64; 2]| u * per[0] + v * per[1];
        let (dx, dy) = (-out(&self.per_y), out(&self.per_x));
        let len = dx.hypot(dy);
        Vec3::new(dx, dy, slope.0 * dx + slope.1 * dy) / len
    }

    #[inline]
    fn coordinates(&self, x: f64, y: f64) -> [f64; 2] {
        [0, 1].map(|k| self.at_origin[k] + self.per_x[k] * x + self.per_y[k] * y)
    }

    /// How far along an edge it crosses the rim.
    fn crossings(&self, edge: &Flat, tol: f64) -> [Option<f64>; 2] {
        let [u, v] = self.coordinates(edge.x, edge.y);
        let [du, dv] = [0, 1].map(|k| self.per_x[k] * edge.dx + self.per_y[k] * edge.dy);
        let (square, along) = (du * du + dv * dv, u * du + v * dv);
        let root = along * along - square * (u * u + v * v - self.radius * self.radius);
        if root <= 0.0 {
            return [None; 2];
        }
        [-1.0, 1.0].map(|side| {
            let s = (-along + side * root.sqrt()) / square;
            (s >= -tol && s <= edge.len + tol).then_some(s)
        })
    }
}

/// How a lying cylinder of radius |`round`| bulges over an edge beside its line (`round` < 0: the line is A's).
///
/// Directions are per length across n (x, y, rise), u: common perpendicular, from A to B. Seen along n the nearest places
/// are r u apart, at X along the edge e and Y along the line f from the crossing: Y f − X e = r u (edge of A; of B: − r u).
/// Where an end comes before them (`ends`: from the crossing back and on, m) the surface falls short as a parabola does;
/// where X is more than one radius the crossing stops to stand for the place, up to two.
fn calc_bulge((edge, ends_e): (&Vec3, [f64; 2]), (line, ends_f): (&Vec3, [f64; 2]), round: f64) -> Bulging {
    let across = edge.cross(line);
    let sine = across.z;
    let u = across / (across.norm() * sine.signum());
    let flat_cross = |p: &Vec3, q: &Vec3| p.x * q.y - p.y * q.x;
    let (x, y) = (round * flat_cross(line, &u) / sine, round * flat_cross(edge, &u) / sine);
    let reached = |d: f64, ends: [f64; 2]| {
        let room = if d > 0.0 { ends[1] } else { ends[0] };
        let short = 1.0 - if d == 0.0 { 1.0 } else { (room.max(0.0) / d.abs()).min(1.0) };
        1.0 - short * short
    };
    let near = (2.0 - (x / round).abs()).clamp(0.0, 1.0);
    let along_edge = reached(x, ends_e) * near * near * (3.0 - 2.0 * near);
    Bulging { upright: u.z, along_edge, along_line: reached(y, ends_f) }
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
    let (side, size) = (1f64.copysign(sine), sine.abs());
    let within = |u: f64, len: f64| u >= -tol * size && u <= (len + tol) * size;
    let s = (wx * f.dy - wy * f.dx) * side;
    if !within(s, e.len) {
        return None;
    }
    let t = (wx * e.dy - wy * e.dx) * side;
    if !within(t, f.len) {
        return None;
    }
    let (s, t) = (s / size, t / size);
    let (x, y) = (e.x + s * e.dx, e.y + s * e.dy);
    Some(Meeting { x, y, height_a: e.h + e.rise * s, height_b: f.h + f.rise * t, fa: e.edge, fb: f.edge, bulge: None })
}
