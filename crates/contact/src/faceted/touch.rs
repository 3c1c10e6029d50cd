//! A contact point on its way to the caller: in the frame of shape A, features still apart.

use spatial::Vec3;
use std::cmp::Ordering;

/// One contact point of two shapes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    /// Feature of A.
    pub(crate) fa: u32,
    /// Feature of B.
    pub(crate) fb: u32,
    /// Witness point on A's surface, m.
    pub(crate) a: Vec3,
    /// Witness point on B's surface, m.
    pub(crate) b: Vec3,
    /// Unit, from A to B.
    pub(crate) n: Vec3,
    /// n · (b − a), m.
    pub(crate) gap: f64,
}

impl Touch {
    /// The same point with A and B exchanged.
    pub(crate) fn swapped(&self) -> Self {
        Self { fa: self.fb, fb: self.fa, a: self.b, b: self.a, n: -self.n, gap: self.gap }
    }

    /// Whether two points are one: same place within `tol`, m, and same normal within 2°.
    pub(crate) fn coincides(&self, o: &Self, tol: f64) -> bool {
        (self.a - o.a).norm_squared() <= tol * tol && self.n.dot(&o.n) > 0.9994
    }
}

/// Length below which points of one pair are one, m.
const SAME: f64 = 1e-9;

/// Orders points by features and place, and drops those found twice (by two triangles).
pub(crate) fn settle(points: &mut Vec<Touch>) {
    points.sort_unstable_by(by_feature_and_place);
    let mut kept = 0;
    for i in 0..points.len() {
        let p = points[i];
        if !points[..kept].iter().any(|o| o.coincides(&p, SAME)) {
            points[kept] = p;
            kept += 1;
        }
    }
    points.truncate(kept);
}

fn by_feature_and_place(p: &Touch, q: &Touch) -> Ordering {
    let place = |p: &Touch, q: &Touch| {
        let by = |k: usize| p.a[k].total_cmp(&q.a[k]);
        by(0).then(by(1)).then(by(2)).then(p.gap.total_cmp(&q.gap))
    };
    (p.fa, p.fb).cmp(&(q.fa, q.fb)).then_with(|| place(p, q))
}
