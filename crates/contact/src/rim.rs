//! The rim of a cylinder against a straight edge: the one axis of primitives that has no closed form.
//!
//! The common normal is perpendicular to the edge, so it is one angle: the separation
//!   σ(u) = u · p − w_A(u) − w_B(u),   dσ/du = p + s_B(−u) − s_A(u)      s: support points
//! is scanned round the edge and its largest value bisected to round-off by the sign of its slope. No trigonometry, no
//! history, no allocation.

use crate::axes::{Axis, Couple};
use crate::convex::Core;
use crate::patch::tangents;
use spatial::Vec3;

/// Directions of the scan: eight in each quadrant of the two across the edge.
const SCAN: usize = 8;
/// Halvings of a sector; 2⁻⁵⁰ is round-off.
const HALVINGS: usize = 50;

impl Couple<'_> {
    /// The best axis across one of the edges, where just one of the two is a cylinder.
    pub(crate) fn find_rim_axis(&self) -> Option<Axis> {
        let is_cylinder = |core: &Core| matches!(core, Core::Cylinder(_));
        let edges: &[usize] = match (is_cylinder(&self.a.core), is_cylinder(&self.b.core)) {
            (true, false) => self.b.edge_axes(),
            (false, true) => self.a.edge_axes(),
            _ => return None,
        };
        let rot = if is_cylinder(&self.a.core) { self.frame_ab.rot } else { spatial::Mat3::identity() };
        edges.iter().map(|&k| self.best_across(&rot.column(k).into_owned())).max_by(|a, b| a.gap.total_cmp(&b.gap))
    }

    fn best_across(&self, edge: &Vec3) -> Axis {
        let (x, y) = tangents(edge);
        // A square about the edge, not a circle: any set of directions that goes round will do.
        let around = |i: usize| {
            let (quadrant, s) = (i / SCAN % 4, (i % SCAN) as f64 / SCAN as f64);
            let (from, to) = [(x, y), (y, -x), (-x, -y), (-y, x)][quadrant];
            ((1.0 - s) * from + s * to).normalize()
        };
        let best = (0..4 * SCAN).max_by(|&i, &j| self.separation(&around(i)).total_cmp(&self.separation(&around(j))));
        let best = best.unwrap_or(0);
        let (mut before, mut after) = (around(best + 4 * SCAN - 1), around(best + 1));
        for _ in 0..HALVINGS {
            let middle = (before + after).normalize();
            if self.slope(&middle).dot(&edge.cross(&middle)) > 0.0 {
                before = middle;
            } else {
                after = middle;
            }
        }
        let normal = (before + after).normalize();
        Axis { normal, gap: self.separation(&normal), face: false }
    }

    fn separation(&self, u: &Vec3) -> f64 {
        u.dot(&self.frame_ab.pos) - self.a.half_width(u) - self.b.half_width(&self.frame_ab.rot.tr_mul(u))
    }

    fn slope(&self, u: &Vec3) -> Vec3 {
        let on_b = self.frame_ab.point(&self.b.support(&-self.frame_ab.rot.tr_mul(u)));
        on_b - self.a.support(u)
    }
}
