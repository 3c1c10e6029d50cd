//! Pairs with a closed form: balls against balls and planes, boxes against planes.
//!
//! Points are written as (feature, point on A, normal from A to B, gap); the point on B is a + gap n.

use crate::ContactPoint;
use spatial::{Frame, Vec3};

/// A point before it belongs to a pair.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Raw {
    pub(crate) feature: u64,
    pub(crate) point_a: Vec3,
    pub(crate) normal: Vec3,
    pub(crate) gap: f64,
}

impl Raw {
    /// The point as one of a pair, with its share of the pair's law.
    pub(crate) fn in_pair(&self, pair: u32, weight: f64) -> ContactPoint {
        ContactPoint {
            pair,
            feature: self.feature,
            point_a_w: self.point_a,
            point_b_w: self.point_a + self.gap * self.normal,
            normal_w: self.normal,
            gap: self.gap,
            weight,
        }
    }
}

/// Two balls; concentric ones part along z.
pub(crate) fn ball_ball(centre_a: &Vec3, radius_a: f64, centre_b: &Vec3, radius_b: f64) -> Raw {
    let apart = centre_b - centre_a;
    let distance = apart.norm();
    let normal = if distance > 0.0 { apart / distance } else { Vec3::z() };
    Raw { feature: 0, point_a: centre_a + radius_a * normal, normal, gap: distance - radius_a - radius_b }
}

/// A plane (the frame's z = 0, solid below) as A, a ball as B.
pub(crate) fn plane_ball(plane: &Frame, centre: &Vec3, radius: f64) -> Raw {
    let normal = plane.rot.column(2).into_owned();
    let height = normal.dot(&(centre - plane.pos));
    Raw { feature: 0, point_a: centre - height * normal, normal, gap: height - radius }
}

/// A plane as A, a box as B: its corners nearer than `margin`.
pub(crate) fn plane_cuboid(plane: &Frame, cuboid: &Frame, half: &Vec3, margin: f64, out: &mut Vec<Raw>) {
    let normal = plane.rot.column(2).into_owned();
    let centre = normal.dot(&(cuboid.pos - plane.pos));
    for corner in 0..8_u64 {
        let sign = |bit: u64| if corner & bit == 0 { 1.0 } else { -1.0 };
        let arm = cuboid.rot * Vec3::new(sign(1) * half.x, sign(2) * half.y, sign(4) * half.z);
        let gap = centre + normal.dot(&arm);
        if gap < margin {
            out.push(Raw { feature: corner, point_a: cuboid.pos + arm - gap * normal, normal, gap });
        }
    }
}

/// The same point seen with A and B exchanged.
pub(crate) fn swapped(raw: &Raw) -> Raw {
    Raw { feature: raw.feature, point_a: raw.point_a + raw.gap * raw.normal, normal: -raw.normal, gap: raw.gap }
}
