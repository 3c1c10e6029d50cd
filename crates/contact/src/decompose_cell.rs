//! A convex cell of a partition, with the pieces of the mesh's triangles that lie in it.

use crate::decompose_measure::Surface;
use spatial::Vec3;

/// n · x = d, n a unit vector.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    pub(crate) n: Vec3,
    pub(crate) d: f64,
}

impl Plane {
    pub(crate) fn through([p, q, r]: [Vec3; 3]) -> Option<Self> {
        let n = (q - p).cross(&(r - p)).try_normalize(f64::MIN_POSITIVE)?;
        Some(Self { n, d: n.dot(&p) })
    }

    #[inline]
    pub(crate) fn height(&self, p: &Vec3) -> f64 {
        self.n.dot(p) - self.d
    }
}

/// A convex polygon in a plane, counter-clockwise about its normal.
#[derive(Clone, Debug)]
pub(crate) struct Polygon {
    pub(crate) plane: Plane,
    pub(crate) points: Vec<Vec3>,
}

/// Width of the empty rim about the mesh, relative to its size.
const MARGIN: f64 = 0.01;
/// Least volume of the parallelepiped of three normals that make a corner.
const SHARP: f64 = 1e-7;
/// Most planes that are tried for a cut.
const CANDIDATES: usize = 48;
/// Cosine beyond which a polygon looks against a face: it is the back of a thin wall there, not a pocket's floor or side.
const AGAINST: f64 = 0.5;

/// A convex cell.
#[derive(Clone, Debug)]
pub(crate) struct Cell {
    /// Its faces, outward.
    pub(crate) faces: Vec<Polygon>,
    /// What of the mesh runs through it.
    inner: Vec<Polygon>,
    /// Depth of the deepest of these below the cell's surface, m; 0 where none is deeper than allowed.
    pub(crate) defect: f64,
}

impl Cell {
    /// A box somewhat larger than a mesh, with all of it inside.
    pub(crate) fn around(surface: &Surface) -> Self {
        let low = surface.vertices.iter().fold(Vec3::repeat(f64::INFINITY), |low, p| low.inf(p));
        let high = surface.vertices.iter().fold(Vec3::repeat(f64::NEG_INFINITY), |high, p| high.sup(p));
        let (centre, half) = (0.5 * (low + high), 0.5 * (high - low) + Vec3::repeat(MARGIN * surface.size));
        let mut faces = Vec::with_capacity(6);
        for k in 0..3 {
            for side in [-1.0, 1.0] {
                // Counter-clockwise about the outward normal.
                let ring = [(-1.0, -1.0), (side, -side), (1.0, 1.0), (-side, side)];
                let at = |(u, v): (f64, f64)| {
                    let mut p = centre;
                    p[k] += side * half[k];
                    p[(k + 1) % 3] += u * half[(k + 1) % 3];
                    p[(k + 2) % 3] += v * half[(k + 2) % 3];
                    p
                };
                let n = Vec3::ith(k, side);
                faces.push(Polygon { plane: Plane { n, d: n.dot(&centre) + half[k] }, points: ring.map(at).to_vec() });
            }
        }
        let triangles = surface.triangles.iter().filter_map(|t| {
            let points = t.map(|i| surface.vertices[i as usize]);
            Plane::through(points).map(|plane| Polygon { plane, points: points.to_vec() })
        });
        Self { faces, inner: triangles.collect(), defect: 0.0 }
    }

    /// Without what lies above triangles that have the whole mesh below them: as tight as the mesh is convex.
    pub(crate) fn trimmed(mut self, surface: &Surface, eps: f64) -> Self {
        for plane in self.inner.iter().map(|p| p.plane).collect::<Vec<_>>() {
            let known =
                self.faces.iter().any(|f| (f.plane.n - plane.n).amax() < SHARP && (f.plane.d - plane.d).abs() < eps);
            if known || surface.vertices.iter().any(|v| plane.height(v) > LYING * eps) {
                continue;
            }
            if let Some(below) = self.clone().split(&plane, eps).into_iter().next() {
                self = below;
            }
        }
        self
    }

    /// Its corners, each once: the points where three faces meet, without those where cuts of neighbours end.
    pub(crate) fn corners(&self, eps: f64) -> Vec<Vec3> {
        let mut out: Vec<Vec3> = Vec::new();
        for p in self.faces.iter().flat_map(|f| &f.points) {
            if out.iter().all(|q| (p - q).amax() > LYING * eps) && self.is_corner(p, eps) {
                out.push(*p);
            }
        }
        out
    }

    /// Whether the normals of the faces through a point span space.
    fn is_corner(&self, p: &Vec3, eps: f64) -> bool {
        let near = || self.faces.iter().filter(|f| f.plane.height(p).abs() <= 2.0 * LYING * eps).map(|f| f.plane.n);
        let Some(first) = near().next() else { return false };
        let across = near().map(|n| first.cross(&n)).max_by(|a, b| a.norm().total_cmp(&b.norm()));
        let across = across.unwrap_or_default();
        near().any(|n| across.dot(&n).abs() > SHARP)
    }

    /// Mean of the corners.
    pub(crate) fn centre(&self, eps: f64) -> Vec3 {
        let corners = self.corners(eps);
        corners.iter().sum::<Vec3>() / corners.len().max(1) as f64
    }

    /// The two cells as one, if they share a face and are convex together: if each lies below all other faces of the
    /// other. What lies below all of these and below the shared plane is in the first, and above it in the second.
    pub(crate) fn joined(&self, other: &Self, eps: f64) -> Option<Self> {
        let opposite = |a: &Plane, b: &Plane| {
            a.n.dot(&b.n) < 0.0 && (a.n + b.n).amax() < SHARP && (a.d + b.d).abs() <= LYING * eps
        };
        let shared = self.faces.iter().find(|a| other.faces.iter().any(|b| opposite(&a.plane, &b.plane)))?.plane;
        let against = Plane { n: -shared.n, d: -shared.d };
        let rest = |cell: &Self, plane: &Plane| -> Vec<Polygon> {
            cell.faces.iter().filter(|f| !opposite(&f.plane, plane)).cloned().collect()
        };
        let (own, others) = (rest(self, &against), rest(other, &shared));
        let below = |faces: &[Polygon], cell: &Self| {
            let points = || cell.faces.iter().flat_map(|f| &f.points);
            faces.iter().all(|face| points().all(|p| face.plane.height(p) <= LYING * eps))
        };
        let fits = below(&own, other) && below(&others, self);
        fits.then(|| Self { faces: [own, others].concat(), inner: Vec::new(), defect: 0.0 })
    }

    /// Forgets polygons that lie in the cell's faces.
    fn drop_faces(&mut self, eps: f64) {
        let faces = &self.faces;
        let lies_in = |polygon: &Polygon, face: &Polygon| {
            polygon.points.iter().all(|p| face.plane.height(p).abs() <= LYING * eps)
        };
        self.inner.retain(|polygon| !faces.iter().any(|face| lies_in(polygon, face)));
    }

    /// Depth of a polygon below the face that it is nearest to; zero where it counts as part of one.
    fn calc_depth(&self, polygon: &Polygon, tolerance: f64) -> f64 {
        let mut depth = f64::INFINITY;
        for face in &self.faces {
            let deepest = polygon.points.iter().map(|p| -face.plane.height(p)).fold(0.0, f64::max);
            if deepest <= tolerance && face.plane.n.dot(&polygon.plane.n) > -AGAINST {
                return 0.0;
            }
            depth = depth.min(deepest);
        }
        depth
    }

    /// Looks again for the deepest polygon.
    pub(crate) fn update_defect(&mut self, tolerance: f64, eps: f64) {
        self.drop_faces(eps);
        self.defect = self.inner.iter().map(|p| self.calc_depth(p, tolerance)).fold(0.0, f64::max);
    }

    /// The plane of a polygon that leaves the fewest polygons inside the two halves; the largest of equals.
    pub(crate) fn choose_cut(&self, eps: f64) -> Plane {
        let mut order: Vec<(f64, usize)> =
            self.inner.iter().enumerate().map(|(i, p)| (self.calc_depth(p, 0.0), i)).collect();
        order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        order.truncate(CANDIDATES);
        let cost =
            |plane: &Plane| self.inner.iter().map(|p| u32::from(side_of(p, plane, eps) == Side::Both)).sum::<u32>();
        let in_plane = |plane: &Plane| self.inner.iter().filter(|p| side_of(p, plane, eps) == Side::In).count();
        let best = order
            .iter()
            .map(|&(_, i)| self.inner[i].plane)
            .min_by_key(|plane| (i64::from(cost(plane)) - in_plane(plane) as i64, std::cmp::Reverse(in_plane(plane))));
        // There is always one: a cell without polygons has no defect.
        best.unwrap_or(Plane { n: Vec3::z(), d: self.centre(eps).z })
    }

    /// The two halves below and above a plane; one where the other would be flat.
    pub(crate) fn split(self, plane: &Plane, eps: f64) -> Vec<Cell> {
        let mut halves = [Vec::new(), Vec::new()];
        for face in &self.faces {
            halve(face, plane, eps, &mut halves);
        }
        let mut inner = [Vec::new(), Vec::new()];
        for polygon in self.inner.iter().filter(|p| side_of(p, plane, eps) != Side::In) {
            halve(polygon, plane, eps, &mut inner);
        }
        let mut out = Vec::with_capacity(2);
        for (up, (mut faces, inner)) in halves.into_iter().zip(inner).enumerate() {
            let sign = if up == 0 { 1.0 } else { -1.0 };
            let lid = Plane { n: sign * plane.n, d: sign * plane.d };
            let thick = faces.iter().flat_map(|f: &Polygon| &f.points).any(|p| -lid.height(p) > LYING * eps);
            if let Some(points) = cap(&faces, &lid, eps).filter(|_| thick) {
                faces.push(Polygon { plane: lid, points });
                out.push(Cell { faces, inner, defect: 0.0 });
            } else if thick {
                // The plane does not pass through the inside: this half is the whole.
                out.push(Cell { faces, inner, defect: 0.0 });
            }
        }
        out
    }
}

/// Multiple of round-off within which a point counts as in a plane that it was not cut by.
const LYING: f64 = 10.0;

/// Where a polygon is, seen from a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Side {
    Below,
    Above,
    Both,
    In,
}

fn side_of(polygon: &Polygon, plane: &Plane, eps: f64) -> Side {
    let (mut low, mut high) = (0.0_f64, 0.0_f64);
    for p in &polygon.points {
        let h = plane.height(p);
        (low, high) = (low.min(h), high.max(h));
    }
    match (low < -LYING * eps, high > LYING * eps) {
        (true, true) => Side::Both,
        (true, false) => Side::Below,
        (false, true) => Side::Above,
        (false, false) => Side::In,
    }
}

/// Adds the parts of a polygon below and above a plane to the two lists.
fn halve(polygon: &Polygon, plane: &Plane, eps: f64, halves: &mut [Vec<Polygon>; 2]) {
    let side = side_of(polygon, plane, eps);
    let mut keep = |half: usize, points| halves[half].push(Polygon { plane: polygon.plane, points });
    match side {
        Side::Below => keep(0, polygon.points.clone()),
        Side::Above => keep(1, polygon.points.clone()),
        // A face in the cutting plane belongs to the half that it bounds.
        Side::In => keep(usize::from(polygon.plane.n.dot(&plane.n) < 0.0), polygon.points.clone()),
        Side::Both => {
            for (half, sign) in [1.0, -1.0].into_iter().enumerate() {
                let points = clip(&polygon.points, plane, sign, eps);
                if points.len() > 2 {
                    keep(half, points);
                }
            }
        }
    }
}

/// The part of a polygon where sign · height ≤ 0.
fn clip(points: &[Vec3], plane: &Plane, sign: f64, eps: f64) -> Vec<Vec3> {
    let mut out = Vec::with_capacity(points.len() + 1);
    for (i, p) in points.iter().enumerate() {
        let q = &points[(i + 1) % points.len()];
        let (hp, hq) = (sign * plane.height(p), sign * plane.height(q));
        if hp <= LYING * eps {
            out.push(*p);
        }
        if (hp < -LYING * eps && hq > LYING * eps) || (hp > LYING * eps && hq < -LYING * eps) {
            // From the end below, so that both halves and both neighbours find the same point.
            let ((a, ha), (b, hb)) = if plane.height(p) < 0.0 { ((p, hp), (q, hq)) } else { ((q, hq), (p, hp)) };
            out.push(a + (b - a) * (ha / (ha - hb)));
        }
    }
    out
}

/// The polygon that closes a half along its lid, from the points of its faces that lie in it.
fn cap(faces: &[Polygon], lid: &Plane, eps: f64) -> Option<Vec<Vec3>> {
    let mut points: Vec<Vec3> = Vec::new();
    for p in faces.iter().flat_map(|f| &f.points).filter(|p| lid.height(p).abs() <= LYING * eps) {
        if points.iter().all(|q| (p - q).amax() > LYING * eps) {
            points.push(*p);
        }
    }
    if points.len() < 3 {
        return None;
    }
    let centre = points.iter().sum::<Vec3>() / points.len() as f64;
    let u = (points[0] - centre).try_normalize(0.0)?;
    let v = lid.n.cross(&u);
    let angle = |p: &Vec3| (p - centre).dot(&v).atan2((p - centre).dot(&u));
    points.sort_by(|p, q| angle(p).total_cmp(&angle(q)));
    let area: f64 =
        (1..points.len() - 1).map(|i| (points[i] - points[0]).cross(&(points[i + 1] - points[0])).dot(&lid.n)).sum();
    (area > eps * eps).then_some(points)
}
