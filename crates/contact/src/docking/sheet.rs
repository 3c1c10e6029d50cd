//! The sheet: what all docking shapes are made of.
//!
//! A straight meridian from (ρ₀, z₀) to (ρ₁, z₁), turned about z through a sector ±φ about +x (or all round), and rounded
//! by a radius w: all points within w of it. A cone or a tube has a slanting or upright meridian, a floor one that starts
//! on the axis, a ring a single point; a petal is a sector.
//!
//! Nearest point, in closed form. In the half-plane of a point's own azimuth it is that of a segment. Outside of the
//! sector, for fixed ρ_s the squared distance ρ² + ρ_s² − 2 ρ ρ_s cos(φ − θ) + … falls towards the sector's nearer edge,
//! which is a straight segment in space, so it is that segment's.

use super::arc::Curve;
use spatial::{Frame, Vec3};
use std::f64::consts::{PI, TAU};

/// A point of a meridian half-plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Meridian {
    /// Distance from the axis, m.
    pub(crate) rho: f64,
    /// Height, m.
    pub(crate) z: f64,
}

/// A rounded piece of a surface of revolution with a straight meridian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sheet {
    /// Ends of the meridian.
    pub(crate) ends: [Meridian; 2],
    /// Half the sector about +x, rad; `None`: all round.
    pub(crate) half_sector: Option<f64>,
    /// Cosine and sine of half the sector; of all round, those of π.
    pub(crate) edge: (f64, f64),
    /// Rounding radius w, m.
    pub(crate) radius: f64,
    /// Tells twins apart, so that which of two sheets leads does not depend on which is named first.
    pub(crate) rank: u64,
}

/// The nearest point's direction and distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Near {
    /// Unit, from the core to the point.
    pub(crate) normal: Vec3,
    /// From the core, m; negative inside a solid one.
    pub(crate) distance: f64,
}

impl Near {
    /// From a foot to a point; `otherwise` where they coincide.
    #[inline]
    pub(crate) fn from_away(away: Vec3, otherwise: impl Fn() -> Vec3) -> Self {
        let distance = away.norm();
        if distance > 0.0 {
            Self { normal: away / distance, distance }
        } else {
            Self { normal: otherwise(), distance: 0.0 }
        }
    }
}

impl Sheet {
    /// Nearest point of the core to `p`.
    #[inline]
    pub(crate) fn nearest(&self, p: &Vec3) -> Near {
        let rho = (p.x * p.x + p.y * p.y).sqrt();
        match self.half_sector {
            // Outside of the sector: the cosine of the azimuth is below that of the edge.
            Some(_) if p.x < self.edge.0 * rho => self.nearest_on_meridian(p, self.edge.0, self.edge.1.copysign(p.y)),
            _ => {
                let (cos, sin) = if rho > 0.0 { (p.x / rho, p.y / rho) } else { (1.0, 0.0) };
                let [from, _] = self.ends;
                let (dr, dz) = self.along();
                let t = self.foot(rho - from.rho, p.z - from.z);
                let (r, z) = (rho - (from.rho + t * dr), p.z - (from.z + t * dz));
                let distance = (r * r + z * z).sqrt();
                if distance > 0.0 {
                    let radial = r / distance;
                    return Near { normal: Vec3::new(radial * cos, radial * sin, z / distance), distance };
                }
                let across = self.across();
                Near { normal: Vec3::new(across.rho * cos, across.rho * sin, across.z), distance: 0.0 }
            }
        }
    }

    /// Nearest point, to `p`, of the meridian at the azimuth of this cosine and sine.
    #[inline]
    pub(crate) fn nearest_on_meridian(&self, p: &Vec3, cos: f64, sin: f64) -> Near {
        let [from, _] = self.ends;
        let (dr, dz) = self.along();
        let t = self.foot(cos * p.x + sin * p.y - from.rho, p.z - from.z);
        let (rho, z) = (from.rho + t * dr, from.z + t * dz);
        let across = self.across();
        let away = p - Vec3::new(rho * cos, rho * sin, z);
        Near::from_away(away, || Vec3::new(across.rho * cos, across.rho * sin, across.z))
    }

    /// Place of the foot along the meridian, from 0 to 1, of a point given from the meridian's start.
    #[inline]
    fn foot(&self, r: f64, z: f64) -> f64 {
        let (dr, dz) = self.along();
        let squared = dr * dr + dz * dz;
        if squared > 0.0 { ((r * dr + z * dz) / squared).clamp(0.0, 1.0) } else { 0.0 }
    }

    #[inline]
    fn along(&self) -> (f64, f64) {
        let [from, to] = self.ends;
        (to.rho - from.rho, to.z - from.z)
    }

    /// Unit normal of the meridian, on the side of the axis or, for a floor, above.
    fn across(&self) -> Meridian {
        let (dr, dz) = self.along();
        let length = dr.hypot(dz);
        if length > 0.0 {
            Meridian { rho: -dz.abs() / length, z: dr.copysign(dr * dz) / length }
        } else {
            Meridian { rho: -1.0, z: 0.0 }
        }
    }

    /// Whether it is a circle.
    pub(crate) fn is_ring(&self) -> bool {
        self.half_sector.is_none() && self.ends[0] == self.ends[1]
    }

    /// Whether a ball can touch it all round: it is closed about the axis and keeps away from it.
    pub(crate) fn has_seat(&self) -> bool {
        self.half_sector.is_none() && self.ends.iter().all(|end| end.rho > 0.0)
    }

    /// Corners of a sector in the parent frame; how many of the array count.
    pub(crate) fn corners(&self, frame: &Frame) -> ([Vec3; 4], usize) {
        let mut out = [Vec3::zeros(); 4];
        let Some(half) = self.half_sector else { return (out, 0) };
        for (i, corner) in out.iter_mut().enumerate() {
            let (s, c) = if i & 1 == 0 { -half } else { half }.sin_cos();
            let end = self.ends[i >> 1];
            *corner = frame.point(&Vec3::new(end.rho * c, end.rho * s, end.z));
        }
        (out, if self.ends[0] == self.ends[1] { 2 } else { 4 })
    }

    /// Rims, and the straight edges of a sector, in the parent frame.
    pub(crate) fn curves(&self, frame: &Frame) -> [Option<Curve>; 4] {
        let rim = |end: Meridian| {
            let (from, span) = self.half_sector.map_or((0.0, TAU), |half| (-half, 2.0 * half));
            let axis = |k: usize| end.rho * frame.rot.column(k).into_owned();
            (end.rho > 0.0)
                .then(|| Curve::arc(frame.point(&Vec3::new(0.0, 0.0, end.z)), [axis(0), axis(1)], from, span))
        };
        let point = self.ends[0] == self.ends[1];
        let (corners, count) = self.corners(frame);
        let edge = |i: usize| (count == 4).then(|| Curve::segment(corners[i], corners[i + 2]));
        [rim(self.ends[0]), if point { None } else { rim(self.ends[1]) }, edge(0), edge(1)]
    }

    /// Half extents and centre of the bounding box, m.
    pub(crate) fn bounds(&self) -> (Vec3, Vec3) {
        let half = self.half_sector.unwrap_or(PI);
        let (mut low, mut high) = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
        for end in self.ends {
            let widest = if half >= 0.5 * PI { 1.0 } else { half.sin() };
            let points = [(1.0, widest), (half.cos(), -widest)];
            for (x, y) in points {
                let p = Vec3::new(end.rho * x, end.rho * y, end.z);
                (low, high) = (low.inf(&p), high.sup(&p));
            }
        }
        (0.5 * (high - low) + Vec3::repeat(self.radius), 0.5 * (high + low))
    }

    /// Order that does not depend on who is asked first.
    pub(crate) fn leads(&self, other: &Self) -> bool {
        let key = |s: &Self| {
            let [p, q] = s.ends;
            ([p.rho, p.z, q.rho, q.z, s.half_sector.unwrap_or(PI), s.radius].map(f64::to_bits), s.rank)
        };
        key(self) <= key(other)
    }

    /// Length by which places on it are told apart, m.
    pub(crate) fn scale(&self) -> f64 {
        self.radius
    }
}

/// Cosine and sine of the azimuth of (x, y); (1, 0) on the axis.
#[inline]
pub(crate) fn unit(x: f64, y: f64) -> (f64, f64) {
    let r = (x * x + y * y).sqrt();
    if r > 0.0 { (x / r, y / r) } else { (1.0, 0.0) }
}
