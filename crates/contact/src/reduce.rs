//! Bounds the number of points of a pair: the deepest, then always the one farthest from those kept.

use crate::analytic::Raw;

/// Most points of one pair.
pub(crate) const MOST: usize = 16;

/// Keeps at most [`MOST`] points; ties go to the smaller feature, so that the order of finding does not matter.
pub(crate) fn reduce(points: &mut Vec<Raw>) {
    if points.len() <= MOST {
        return;
    }
    points.sort_unstable_by_key(|p| p.feature);
    let deepest = (0..points.len()).min_by(|i, j| points[*i].gap.total_cmp(&points[*j].gap)).unwrap_or(0);
    points.swap(0, deepest);
    for kept in 1..MOST {
        let spread = |i: usize| {
            let nearest = |k: usize| (points[i].point_a - points[k].point_a).norm_squared();
            (0..kept).map(nearest).fold(f64::INFINITY, f64::min)
        };
        let farthest = (kept..points.len()).max_by(|i, j| spread(*i).total_cmp(&spread(*j)).then(j.cmp(i)));
        if let Some(farthest) = farthest {
            points.swap(kept, farthest);
        }
    }
    points.truncate(MOST);
}
