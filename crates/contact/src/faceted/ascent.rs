//! The contact axis where parry's searches give up (cores that just touch, flat Minkowski sums): slow and sure.
//!
//! Every separating axis that flat pieces can have is tried (faces of either, perpendiculars of two edges; Gottschalk, Lin
//! and Manocha 1996); then the best direction climbs sep(n) over the sphere, its steps halved where none leads up: that
//! finds the axes of curved pieces, too.

use super::narrow::{Axis, Couple, Kind};
use super::piece::{Core, Piece};
use crate::patch::tangents;
use spatial::Vec3;

/// Most pairs of edges that are tried.
const MOST_EDGES: usize = 20_000;
/// First step of the climb, rad.
const FIRST_STEP: f64 = 0.3;
/// Last step of the climb, rad.
const LAST_STEP: f64 = 1e-8;

/// Scratch of the search.
#[derive(Default)]
pub(crate) struct Ascent {
    faces: Vec<Vec3>,
    edges_a: Vec<Vec3>,
    edges_b: Vec<Vec3>,
}

impl Ascent {
    /// The best axis; `start`: a unit vector to try first.
    pub(crate) fn find(&mut self, couple: &Couple, start: Vec3) -> Axis {
        self.collect(couple);
        let mut best = (start, couple.separation(&start));
        for &n in &self.faces {
            improve(couple, n, &mut best);
        }
        if self.edges_a.len() * self.edges_b.len() <= MOST_EDGES {
            for e in &self.edges_a {
                for f in &self.edges_b {
                    if let Some(n) = e.cross(f).try_normalize(1e-3 * e.norm() * f.norm()) {
                        improve(couple, n, &mut best);
                    }
                }
            }
        }
        climb(couple, &mut best);
        let n = best.0;
        couple.axis_at(n, Kind::Points(couple.a.support(&n), couple.low_of_b(&n)))
    }

    fn collect(&mut self, couple: &Couple) {
        self.faces.clear();
        self.edges_a.clear();
        self.edges_b.clear();
        couple.a.collect_directions(&mut self.faces, &mut self.edges_a);
        let of_a = self.faces.len();
        couple.b.collect_directions(&mut self.faces, &mut self.edges_b);
        let rot = &couple.ab.rot;
        self.faces[of_a..].iter_mut().chain(&mut self.edges_b).for_each(|d| *d = rot * *d);
    }
}

/// Tries a direction and its opposite.
fn improve(couple: &Couple, n: Vec3, best: &mut (Vec3, f64)) {
    for n in [n, -n] {
        let gap = couple.separation(&n);
        if gap > best.1 {
            *best = (n, gap);
        }
    }
}

fn climb(couple: &Couple, best: &mut (Vec3, f64)) {
    let mut step = FIRST_STEP;
    while step > LAST_STEP {
        let (t1, t2) = tangents(&best.0);
        let from = best.0;
        let ways = [t1, -t1, t2, -t2, t1 + t2, t1 - t2, t2 - t1, -t1 - t2];
        let before = best.1;
        for way in ways {
            improve(couple, (from + step * way).normalize(), best);
        }
        if best.1 <= before {
            step *= 0.5;
        }
    }
}

impl Piece {
    /// Normals of the faces, and directions of the edges and of the axis.
    fn collect_directions(&self, faces: &mut Vec<Vec3>, edges: &mut Vec<Vec3>) {
        match &self.core {
            Core::Point => {}
            Core::Primitive(core) => {
                faces.extend(core.face_axes().iter().map(|&k| Vec3::ith(k, 1.0)));
                edges.extend(core.edge_axes().iter().map(|&k| Vec3::ith(k, 1.0)));
            }
            Core::Polytope(p) => p.collect_directions(faces, edges),
            Core::Triangle(t) => {
                faces.push(t.normal);
                edges.extend((0..3).map(|k| t.p[(k + 1) % 3] - t.p[k]));
            }
        }
    }
}
