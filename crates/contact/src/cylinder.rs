//! The cylinder core: contact points on curved sides and rims.
//!
//! On its side a cylinder meets a direction d with a line: two points, one at each end. With an end it meets it with a
//! disc, of which eight points round the rim stand for the whole. They are fixed in the body while the end lies flat, so
//! that they do not wander with round-off; once it leans by more than [`LEAN`] one of them is the deepest point of the
//! rim, and the others follow at equal angles. In between they turn in proportion to the lean, so the gap is continuous
//! (within 2e-6 radii at the half-way angles) and rolling on the rim is smooth. Rolling past the half-way angle between
//! two points hands the deepest place from one number to its neighbour: there position tells who is who. Where the rim
//! crosses an edge of the other body the true circle counts, not the chord.

use crate::convex::ALONG;
use crate::patch::{Disc, Patch};
use spatial::Vec3;

/// Sine of the lean from which one point is the deepest of the rim.
const LEAN: f64 = 1e-4;
/// Points round a rim.
const ROUND: usize = 8;
/// Axial part of a direction from which an end meets it, not the side.
const END: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Sector angle, rad.
const SECTOR: f64 = std::f64::consts::TAU / ROUND as f64;

/// A cylinder about the origin along z.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cylinder {
    /// Radius, m.
    pub(crate) radius: f64,
    /// Half the length, m.
    pub(crate) half: f64,
}

// Numbers: 0..16 rim points (upper end first), 16 and 17 the ends of the side's line, 18..34 rim chords, 34 the side's
// line, 35 the rim as a curve, 36 the whole, 37..41 the rims where edges enter and leave.
const LINE_END: u32 = 16;
const CHORD: u32 = 18;
const LINE: u32 = 34;
const RIM: u32 = 35;
const RIM_CROSSED: u32 = 37;

impl Cylinder {
    /// Number of the whole.
    pub(crate) const WHOLE: u32 = 36;

    /// The point furthest along `d`; the end's centre where `d` is the axis.
    #[inline]
    pub(crate) fn support(&self, d: &Vec3) -> Vec3 {
        let radial = self.radial(d).unwrap_or_default();
        Vec3::new(self.radius * radial.x, self.radius * radial.y, self.half.copysign(d.z))
    }

    /// Unit radial part of `d`.
    #[inline]
    pub(crate) fn radial(&self, d: &Vec3) -> Option<Vec3> {
        let len = d.x.hypot(d.y);
        (len > 0.0).then(|| Vec3::new(d.x / len, d.y / len, 0.0))
    }

    /// An end (eight points) or a line of the side (two), whichever looks along the unit vector `d`.
    pub(crate) fn face_patch(&self, d: &Vec3, out: &mut Patch) {
        if d.z.abs() < END {
            return self.side(d, out);
        }
        let up = d.z > 0.0;
        out.begin(Vec3::new(0.0, 0.0, 1f64.copysign(d.z)), Self::WHOLE);
        let end = Vec3::new(0.0, 0.0, self.half.copysign(d.z));
        let rim = RIM_CROSSED + if up { 0 } else { 2 };
        out.disc = Some(Disc { centre: end, axes: [Vec3::x(), Vec3::y()], radius: self.radius, rim });
        let turn = rim_turn(d);
        for i in 0..ROUND {
            // Counter-clockwise about the outward normal: backwards on the lower end.
            let k = if up { i } else { ROUND - 1 - i };
            let (s, c) = (SECTOR * k as f64 + turn).sin_cos();
            let p = Vec3::new(self.radius * c, self.radius * s, self.half.copysign(d.z));
            let number = k as u32 + if up { 0 } else { ROUND as u32 };
            out.push(p, number, CHORD + number);
        }
    }

    /// The line of the side, or the rim's point, that supports the unit vector `d`.
    pub(crate) fn edge_patch(&self, d: &Vec3, out: &mut Patch) {
        if d.z.abs() <= ALONG {
            return self.side(d, out);
        }
        out.begin(*d, Self::WHOLE);
        out.push(self.support(d), RIM, RIM);
    }

    fn side(&self, d: &Vec3, out: &mut Patch) {
        let radial = self.radius * self.radial(d).unwrap_or(Vec3::new(1.0, 0.0, 0.0));
        out.begin(*d, Self::WHOLE);
        out.push(radial - Vec3::new(0.0, 0.0, self.half), LINE_END, LINE);
        out.push(radial + Vec3::new(0.0, 0.0, self.half), LINE_END + 1, LINE);
    }
}

/// Angle by which the rim's points are turned from where they are fixed, rad.
fn rim_turn(d: &Vec3) -> f64 {
    let lean = d.x.hypot(d.y);
    if lean == 0.0 {
        return 0.0;
    }
    let sectors = d.y.atan2(d.x) / SECTOR;
    let off = sectors - sectors.round();
    off * SECTOR * (lean / LEAN).min(1.0)
}
