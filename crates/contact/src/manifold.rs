//! parry3d's manifold generators, asked from a cold start.

use crate::analytic::Raw;
use crate::scene::{from_parry, pose_to_parry};
use parry3d_f64::query::{ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher};
use parry3d_f64::shape::Shape;
use spatial::{Frame, Vec3};

/// Buffers of the generators.
#[derive(Default)]
pub(crate) struct ManifoldBuffer {
    manifolds: Vec<ContactManifold<(), ()>>,
    keys: Vec<(u64, [u64; 3])>,
}

impl ManifoldBuffer {
    /// Adds the points of two shapes nearer than `margin`.
    pub(crate) fn add_points(
        &mut self,
        (a, frame_a): (&dyn Shape, &Frame),
        (b, frame_b): (&dyn Shape, &Frame),
        margin: f64,
        out: &mut Vec<Raw>,
    ) {
        let relative =
            Frame { rot: frame_a.rot.tr_mul(&frame_b.rot), pos: frame_a.rot.tr_mul(&(frame_b.pos - frame_a.pos)) };
        self.forget(a.is_convex() && b.is_convex());
        let asked = DefaultQueryDispatcher.contact_manifolds(
            &pose_to_parry(&relative),
            a,
            b,
            margin,
            &mut self.manifolds,
            &mut None,
        );
        if asked.is_err() {
            return; // Two half-spaces: nothing touches.
        }
        let start = out.len();
        self.keys.clear();
        for manifold in &self.manifolds {
            let (sub_a, sub_b) = (manifold.subshape1, manifold.subshape2);
            let normal_a = manifold.subshape_pos1().map_or(manifold.local_n1, |p| p.rotation * manifold.local_n1);
            // Concentric shapes have no direction to part in; any will do.
            let normal = (frame_a.rot * from_parry(normal_a)).try_normalize(0.0).unwrap_or_else(Vec3::z);
            for point in manifold.points.iter().filter(|p| p.dist < margin) {
                let local = manifold.subshape_pos1().map_or(point.local_p1, |p| p * point.local_p1);
                let point_a = frame_a.point(&from_parry(local));
                let feature = mix((u64::from(point.fid1.0) << 32) | u64::from(point.fid2.0), sub_a, sub_b);
                self.keys.push((feature, order_key(&from_parry(local))));
                out.push(Raw { feature, point_a, normal, gap: point.dist });
            }
        }
        self.tell_apart(&mut out[start..]);
    }

    /// Adds the nearest or deepest point of two primitives, if nearer than `margin`.
    pub(crate) fn add_nearest(
        &mut self,
        (a, frame_a): (&dyn Shape, &Frame),
        (b, frame_b): (&dyn Shape, &Frame),
        margin: f64,
        out: &mut Vec<Raw>,
    ) {
        let (pose_a, pose_b) = (pose_to_parry(frame_a), pose_to_parry(frame_b));
        if let Ok(Some(nearest)) = parry3d_f64::query::contact(&pose_a, a, &pose_b, b, margin) {
            let normal = from_parry(nearest.normal1).try_normalize(0.0).unwrap_or_else(Vec3::z);
            out.push(Raw { feature: u64::MAX, point_a: from_parry(nearest.point1), normal, gap: nearest.dist });
        }
    }

    /// Empties the buffers; convex pairs keep theirs, so that nothing is allocated.
    fn forget(&mut self, convex: bool) {
        if !convex || self.manifolds.len() > 1 {
            self.manifolds.clear();
        }
        for manifold in &mut self.manifolds {
            manifold.points.clear();
            manifold.local_n1 = parry3d_f64::math::Vector::ZERO;
            manifold.local_n2 = parry3d_f64::math::Vector::ZERO;
        }
    }

    /// Points that share their features are told apart by their order along A.
    fn tell_apart(&self, points: &mut [Raw]) {
        for (i, point) in points.iter_mut().enumerate() {
            let own = self.keys[i];
            let twins_before =
                |(j, key): (usize, &(u64, [u64; 3]))| key.0 == own.0 && (key.1 < own.1 || (key.1 == own.1 && j < i));
            let ordinal = self.keys.iter().enumerate().filter(|(j, key)| twins_before((*j, key))).count();
            if ordinal > 0 {
                point.feature = mix(point.feature, ordinal as u32, 0);
            }
        }
    }
}

/// Lexicographic order of positions, as integers.
fn order_key(p: &Vec3) -> [u64; 3] {
    let ordered = |x: f64| {
        let bits = x.to_bits();
        if bits >> 63 == 0 { bits | (1 << 63) } else { !bits }
    };
    [ordered(p.x), ordered(p.y), ordered(p.z)]
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
