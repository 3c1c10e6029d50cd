//! What is left to parry3d's own queries, asked from a cold start, and the mixing of features with parts.

use crate::analytic::Raw;
use crate::scene::{from_parry, pose_to_parry};
use parry3d_f64::shape::Shape;
use spatial::{Frame, Vec3};

/// Adds the nearest or deepest point of two primitives, if nearer than `margin`.
pub(crate) fn add_nearest(
    (a, frame_a): (&dyn Shape, &Frame),
    (b, frame_b): (&dyn Shape, &Frame),
    margin: f64,
    out: &mut Vec<Raw>,
) {
    let (pose_a, pose_b) = (pose_to_parry(frame_a), pose_to_parry(frame_b));
    if let Ok(Some(nearest)) = parry3d_f64::query::contact(&pose_a, a, &pose_b, b, margin) {
        // Concentric shapes have no direction to part in; any will do.
        let normal = from_parry(nearest.normal1).try_normalize(0.0).unwrap_or_else(Vec3::z);
        out.push(Raw { feature: u64::MAX, point_a: from_parry(nearest.point1), normal, gap: nearest.dist });
    }
}

/// A feature within a part; the feature itself where there is but one part (SplitMix64's finaliser elsewhere).
pub(crate) fn mix(feature: u64, a: u32, b: u32) -> u64 {
    if a == 0 && b == 0 {
        return feature;
    }
    let mut z = feature ^ ((u64::from(a) << 32) | u64::from(b)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
