//! The place of a triangle or a polytope that is nearest to a point: balls on hulls and meshes, in closed form.

use super::polytope::Polytope;
use super::triangle::Triangle;
use spatial::Vec3;

/// A place on a surface, the unit direction from there to the point, and the signed distance (negative inside), m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    pub(crate) q: Vec3,
    pub(crate) n: Vec3,
    pub(crate) gap: f64,
}

/// From `q` to `p`; where they coincide the direction is `otherwise`.
fn outside(q: Vec3, p: &Vec3, otherwise: Vec3) -> Nearest {
    let d = p - q;
    let gap = d.norm();
    Nearest { q, n: if gap > 0.0 { d / gap } else { otherwise }, gap }
}

/// The nearest point of the segment from `a` to `b`.
fn on_edge(a: &Vec3, b: &Vec3, p: &Vec3) -> Vec3 {
    let d = b - a;
    a + d * (d.dot(&(p - a)) / d.norm_squared()).clamp(0.0, 1.0)
}

/// Whether `p`, projected along the normal `n`, lies on the inner side of the edge from `a` to `b`.
fn is_inside(n: &Vec3, a: &Vec3, b: &Vec3, p: &Vec3) -> bool {
    n.cross(&(b - a)).dot(&(p - a)) >= 0.0
}

/// The nearest place of a triangle.
pub(crate) fn on_triangle(t: &Triangle, p: &Vec3) -> Nearest {
    let corners = t.p;
    let over = (0..3).all(|k| is_inside(&t.normal, &corners[k], &corners[(k + 1) % 3], p));
    if over {
        return outside(p - t.normal * t.normal.dot(&(p - corners[0])), p, t.normal);
    }
    let edges = (0..3).map(|k| outside(on_edge(&corners[k], &corners[(k + 1) % 3], p), p, t.normal));
    edges.reduce(nearer).unwrap_or_else(|| outside(corners[0], p, t.normal))
}

fn nearer(a: Nearest, b: Nearest) -> Nearest {
    if b.gap < a.gap { b } else { a }
}

/// The nearest place of a polytope's surface; inside, the place of the face that is least deep.
pub(crate) fn on_polytope(polytope: &Polytope, p: &Vec3) -> Nearest {
    let mut inside: Option<Nearest> = None;
    let mut out: Option<Nearest> = None;
    for face in 0..polytope.face_count() {
        let n = polytope.normal(face);
        let height = n.dot(&(p - polytope.corner(face, 0)));
        if height <= 0.0 {
            if inside.is_none_or(|best| height > best.gap) {
                inside = Some(Nearest { q: p - n * height, n, gap: height });
            }
        } else {
            let own = on_face(polytope, face, p, height);
            out = Some(out.map_or(own, |best| nearer(best, own)));
        }
    }
    out.or(inside).unwrap_or_else(|| outside(Vec3::zeros(), p, Vec3::z()))
}

/// The nearest place of a face that `p` is `height` above.
fn on_face(polytope: &Polytope, face: usize, p: &Vec3, height: f64) -> Nearest {
    let (n, count) = (polytope.normal(face), polytope.corner_count(face));
    let ends = |k: usize| (polytope.corner(face, k), polytope.corner(face, (k + 1) % count));
    let beside = (0..count).filter(|&k| !is_inside(&n, &ends(k).0, &ends(k).1, p));
    let edges = beside.map(|k| outside(on_edge(&ends(k).0, &ends(k).1, p), p, n));
    edges.reduce(nearer).unwrap_or(Nearest { q: p - n * height, n, gap: height })
}
