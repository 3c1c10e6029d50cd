//! Elastic-foundation beds: contact that is spread over a face, so that its stiffness does not depend on a meshing.
//!
//! A bed is a set of samples fixed to a collider, each with an area and an outward normal. Every sample is held as a point
//! against the surface of the other collider and is a contact point of its own, whose law is that of the pair times
//!
//!   wᵢ = Aᵢ / A_ref,      Aᵢ: the sample's area, m²;  A_ref: the bed's reference area, m²
//!
//! (stiffness, damping and adhesion of the normal law, stiffness, damping and viscous term of the bristle; the level of
//! friction is scaled by nothing, since μ multiplies a normal force that is scaled already). This is the Winkler
//! foundation of K. L. Johnson, Contact Mechanics (Cambridge 1985, § 4.3), p = K δ at every place, without shear between
//! neighbours. With A_ref the bed's own area, which is the default, Σ wᵢ = 1 and the pair's law is that of the *whole
//! face*; with A_ref = 1 m² it is that of a square metre (K = E/h of a layer of height h, in Pa/m).
//!
//! # What the samples keep
//!
//! Areas add up to that of the face, and the samples are placed so that the second moments of area are exact too:
//! rectangles and triangles by Gauss points, rings by two circles that have the ring's mean radius and mean square radius.
//! So the stiffness of a face in full contact against lift *and* tilt is that of the continuum for every number of
//! samples, and the spin torque of a uniformly pressed ring, μ N times its mean radius, is too. What converges with the
//! number: partial contact, and friction where sliding and spinning add up.
//!
//! # Limits
//!
//! A sample meets only surfaces that face it: the angle between its normal and that into the surface is below 84°. Samples
//! that see several parts of a compound take the one they are deepest in. Two beds do not meet each other: one of two
//! conforming faces carries the bed. wᵢ is constant, so a spring law stays conservative while faces roll and tilt.

use spatial::{Pose, Vec3};

/// A place on a bed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BedSample {
    /// Position, m.
    pub point: Vec3,
    /// Outward unit normal.
    pub normal: Vec3,
    /// Area that it stands for, m².
    pub area: f64,
}

/// Samples of a face; see the module's text.
#[derive(Clone, Debug, PartialEq)]
pub struct Bed {
    /// The samples; their order is their identity.
    pub samples: Vec<BedSample>,
    /// Area to which the pair's law belongs, m².
    pub reference_area: f64,
}

impl Bed {
    /// A bed whose law is that of its whole area.
    pub fn new(samples: Vec<BedSample>) -> Self {
        let reference_area = samples.iter().map(|s| s.area).sum();
        Self { samples, reference_area }
    }

    /// The same samples, with the pair's law belonging to `area`, m².
    pub fn with_reference_area(self, area: f64) -> Self {
        Self { reference_area: area, ..self }
    }

    /// Area of all samples, m².
    pub fn calc_area(&self) -> f64 {
        self.samples.iter().map(|s| s.area).sum()
    }

    /// Several beds as one, each with its pose in the new one; the law is that of the whole area.
    pub fn joined(beds: &[(Pose, Bed)]) -> Self {
        let place = |pose: &Pose, s: &BedSample| BedSample {
            point: pose.transform_point(&s.point.into()).coords,
            normal: pose.rotation * s.normal,
            area: s.area,
        };
        Self::new(beds.iter().flat_map(|(pose, bed)| bed.samples.iter().map(move |s| place(pose, s))).collect())
    }

    /// Centre and half extents of a box about the samples and some of the body behind them, m.
    ///
    /// A flat bed that has sunk into a flat sheet has to be seen to overlap it.
    pub(crate) fn bounds(&self) -> (Vec3, Vec3) {
        let around = |depth: f64| {
            let ends = || self.samples.iter().flat_map(move |s| [s.point, s.point - depth * s.normal]);
            let low = ends().fold(Vec3::repeat(f64::INFINITY), |low, p| low.inf(&p));
            let high = ends().fold(Vec3::repeat(f64::NEG_INFINITY), |high, p| high.sup(&p));
            (0.5 * (low + high), 0.5 * (high - low))
        };
        around(BEHIND * around(0.0).1.norm())
    }

    /// What is wrong with it, if anything.
    pub(crate) fn find_fault(&self) -> Option<String> {
        if self.samples.is_empty() {
            return Some("no sample".to_owned());
        }
        if !(self.reference_area > 0.0 && self.reference_area.is_finite()) {
            return Some(format!("a reference area of {} m²", self.reference_area));
        }
        let sound = |s: &BedSample| {
            s.point.iter().all(|x| x.is_finite())
                && (s.normal.norm() - 1.0).abs() < UNIT
                && s.area > 0.0
                && s.area.is_finite()
        };
        let at = self.samples.iter().position(|s| !sound(s))?;
        let s = &self.samples[at];
        let (p, n) = (s.point, s.normal);
        Some(format!("sample {at} at {:?} m with the normal {:?} and {} m²", p.as_slice(), n.as_slice(), s.area))
    }
}

/// Depth of the body behind a bed that counts as its own, in half diagonals of the samples' box.
const BEHIND: f64 = 0.25;
/// How far a normal's length may be from one.
const UNIT: f64 = 1e-6;
