//! The curved side of a sheet as a path round the axis: at each azimuth the place of its meridian that is nearest.
//!
//! Two sides that bulge towards each other touch away from all rims and edges. With d(s, θ) the distance of the side's
//! point, m(θ) = min d over the straight meridian has the slope ∂d/∂θ at the minimiser (envelope theorem), so this is a
//! path like any curve.

use super::arc::{Path, find_root};
use super::body::{Body, Kind};
use super::sheet::{Meridian, Near};
use spatial::{Frame, Vec3};
use std::f64::consts::{PI, TAU};

/// Slope, in radii, above which a place is a jump of the meridian's minimiser and not a minimum.
const STEEP: f64 = 1e-6;

/// The side of a sheet in a common frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face {
    frame: Frame,
    ends: [Meridian; 2],
    half_sector: Option<f64>,
}

/// Where a meridian is nearest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spot {
    /// The place.
    pub(crate) point: Vec3,
    /// Direction and distance there.
    pub(crate) near: Near,
    /// How much deeper it is than the meridian's ends, m.
    pub(crate) prominence: f64,
    /// ∂d/∂θ.
    slope: f64,
}

impl Face {
    /// The side of a body that is a sheet with a meridian of some length.
    pub(crate) fn of(body: &Body<'_>) -> Option<Self> {
        match body.kind {
            Kind::Sheet(sheet) if sheet.ends[0] != sheet.ends[1] => {
                Some(Self { frame: body.frame, ends: sheet.ends, half_sector: sheet.half_sector })
            }
            _ => None,
        }
    }

    /// The nearest place of the meridian at an azimuth.
    pub(crate) fn spot(&self, target: &Body<'_>, azimuth: f64) -> Spot {
        let (sin, cos) = azimuth.sin_cos();
        let at = |end: Meridian| self.frame.point(&Vec3::new(end.rho * cos, end.rho * sin, end.z));
        let (from, to) = (at(self.ends[0]), at(self.ends[1]));
        let along = to - from;
        let nearest = |s: f64| target.nearest(&(from + s * along));
        let slope = |near: &Near| near.normal.dot(&along);
        let (first, last) = (nearest(0.0), nearest(1.0));
        let (f0, f1) = (slope(&first), slope(&last));
        let s = if f0 < 0.0 && f1 > 0.0 {
            find_root(&|s| slope(&nearest(s)), (0.0, f0), (1.0, f1))
        } else {
            f64::from(last.distance < first.distance)
        };
        let near = nearest(s);
        let rho = self.ends[0].rho + s * (self.ends[1].rho - self.ends[0].rho);
        let round = self.frame.rot * Vec3::new(-rho * sin, rho * cos, 0.0);
        let prominence = first.distance.min(last.distance) - near.distance;
        Spot { point: from + s * along, near, prominence, slope: near.normal.dot(&round) }
    }

    /// Whether a place that the scan found is a minimum.
    pub(crate) fn is_flat_at(&self, spot: &Spot) -> bool {
        spot.slope.abs() < STEEP * self.widest()
    }

    fn widest(&self) -> f64 {
        self.ends[0].rho.max(self.ends[1].rho)
    }
}

impl Path for Face {
    fn extent(&self) -> (f64, f64, f64, bool) {
        let (from, span) = self.half_sector.map_or((-PI, TAU), |half| (-half, 2.0 * half));
        (from, span, self.widest(), self.half_sector.is_none())
    }

    /// None: each sample is a search of its own.
    fn halvings(&self, _: &Body<'_>) -> usize {
        0
    }

    fn sample(&self, target: &Body<'_>, u: f64) -> (Near, f64) {
        let spot = self.spot(target, u);
        (spot.near, spot.slope)
    }
}
