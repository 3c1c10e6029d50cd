//! Bounds the number of points of a pair: the deepest, then always the one farthest from those kept.

use crate::analytic::Raw;

/// Most points of one pair.
pub(crate) const MOST: usize = 16;

/// Keeps at most [`MOST`] points; ties go to the smaller feature, so that the order of finding does not matter.
///
/// `nearest` is scratch: of every point, the squared distance to the nearest one kept so far.
pub(crate) fn reduce(points: &mut Vec<Raw>, nearest: &mut Vec<f64>) {
    if points.len() <= MOST {
        return;
    }
    points.sort_unstable_by_key(|p| p.feature);
    let deepest = (0..points.len()).min_by(|i, j| points[*i].gap.total_cmp(&points[*j].gap)).unwrap_or(0);
    points.swap(0, deepest);
    nearest.clear();
    nearest.resize(points.len(), f64::INFINITY);
    for kept in 1..MOST {
        let last = points[kept - 1].point_a;
        for i in kept..points.len() {
            nearest[i] = nearest[i].min((points[i].point_a - last).norm_squared());
        }
        let farthest = (kept..points.len()).max_by(|i, j| nearest[*i].total_cmp(&nearest[*j]).then(j.cmp(i)));
        if let Some(farthest) = farthest {
            points.swap(kept, farthest);
            nearest.swap(kept, farthest);
        }
    }
    points.truncate(MOST);
}
