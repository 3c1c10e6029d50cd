//! Docking shapes: drogue, bore, capture ring, guide petal; analytic and smooth.
//!
//! Each is one or two [`Sheet`]s: a straight meridian turned about z, all round or through a sector, and rounded by a
//! radius, so walls have a thickness and every rim is round. Frames and sizes:
//!
//! | shape | frame | solid |
//! | --- | --- | --- |
//! | inner cone | mouth in z = 0, opens to +z | ρ_inner(z) = ρ_throat + (z + depth) tan α, −depth ≤ z ≤ 0, and the wall behind it |
//! | inner cylinder | mouth in z = 0, opens to +z | ρ_inner = radius, −depth ≤ z ≤ 0, the wall behind it, and a floor if asked for |
//! | ring | circle in z = 0 | within the minor radius of the circle |
//! | petal | base in z = 0, centred on +x, rises to +z | within half the thickness of a sector of a cone frustum |
//!
//! Rims add half the wall to the depth at either end. Walls are solid and touch from both sides; a body may sink in by its
//! own radius and half the wall before it would come out behind.
//!
//! A petal tapers as its cone does: with the tip's radius below the base's, it leans inward and narrows in proportion.
//! The nearer the cone's axis stands to the petal, the stronger the taper for the same lean; the cone need not be coaxial
//! with the docking ring that carries it.
//!
//! A [`Docking`] shape meets balls, capsules, cylinders, boxes, half-spaces and docking shapes through the closed forms
//! and one-dimensional minimisations of [`pair`]; hulls and meshes through parry3d and a tessellation, with facets.
//! [`DockingShape`] is the same as a custom shape for parry3d, and [`DockingDispatcher`] answers its queries.
//!
//! Limits: where an arc fits another curve exactly over part of its length, the place of the deepest point is left to
//! round-off. Two places of one curve less than a few hundredths of its radius apart may be seen as one. A body whose core
//! has crossed a sheet's middle surface is pushed out on the far side.

mod arc;
mod body;
mod face;
mod pair;
mod parry;
mod seat;
mod sheet;
mod tessellate;

pub(crate) use body::Body;
pub(crate) use pair::DockingBuffer;
pub use parry::{DockingDispatcher, DockingShape};
pub(crate) use sheet::Sheet;
pub use tessellate::Tessellation;

use crate::ContactError;
use sheet::Meridian;
use std::f64::consts::{FRAC_PI_2, PI};

/// A docking shape in its own frame; lengths in m, angles in rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Docking {
    /// A drogue: the inside of a cone frustum. Mouth in z = 0, opening to +z.
    InnerCone {
        /// Angle between wall and axis, between 0 and π/2.
        half_angle: f64,
        /// From mouth to throat along the axis, m.
        depth: f64,
        /// Inner radius at the throat, m; zero for a cone that closes.
        throat_radius: f64,
        /// Thickness of the wall behind the inner surface, m.
        wall: f64,
    },
    /// A socket or bore: the inside of a tube. Mouth in z = 0, opening to +z.
    InnerCylinder {
        /// Inner radius, m.
        radius: f64,
        /// From the mouth to the other end or the floor, m.
        depth: f64,
        /// Thickness of wall and floor, m.
        wall: f64,
        /// Whether z = −depth is closed.
        floor: bool,
    },
    /// A torus about z.
    Ring {
        /// Of the circle in z = 0, m.
        major_radius: f64,
        /// Of the cross-section, m.
        minor_radius: f64,
    },
    /// A guide petal: a rounded plate, a sector of a cone frustum about z, centred on +x.
    Petal {
        /// Distance of the middle surface from the axis in z = 0, m.
        base_radius: f64,
        /// The same at the tip, m.
        tip_radius: f64,
        /// Height of the tip, m.
        height: f64,
        /// Half the angle it spans about z, between 0 and π.
        half_sector: f64,
        /// Thickness, m; edges are rounded by half of it.
        thickness: f64,
    },
}

impl Docking {
    /// Inner radius of a drogue's mouth, m, from that of its throat.
    pub fn mouth_radius(half_angle: f64, depth: f64, throat_radius: f64) -> f64 {
        throat_radius + depth * half_angle.tan()
    }

    /// Its pieces. `rank` tells twins apart (see [`Sheet`]).
    pub(crate) fn sheets(&self, rank: u64) -> impl Iterator<Item = Sheet> + use<> {
        let all_round = |p: [f64; 2], q: [f64; 2], radius| Sheet {
            ends: [at(p), at(q)],
            half_sector: None,
            edge: (-1.0, 0.0),
            radius,
            rank,
        };
        let [first, second] = match *self {
            Self::InnerCone { half_angle, depth, throat_radius, wall } => {
                let (w, (s, c)) = (0.5 * wall, half_angle.sin_cos());
                let mouth = Self::mouth_radius(half_angle, depth, throat_radius);
                [Some(all_round([throat_radius + w * c, -depth - w * s], [mouth + w * c, -w * s], w)), None]
            }
            Self::InnerCylinder { radius, depth, wall, floor } => {
                let w = 0.5 * wall;
                let tube = all_round([radius + w, -depth], [radius + w, 0.0], w);
                [Some(tube), floor.then(|| all_round([0.0, -depth - w], [radius + w, -depth - w], w))]
            }
            Self::Ring { major_radius, minor_radius } => {
                [Some(all_round([major_radius, 0.0], [major_radius, 0.0], minor_radius)), None]
            }
            Self::Petal { base_radius, tip_radius, height, half_sector, thickness } => {
                let plate = all_round([base_radius, 0.0], [tip_radius, height], 0.5 * thickness);
                let edge = (half_sector.cos(), half_sector.sin());
                [Some(Sheet { half_sector: Some(half_sector), edge, ..plate }), None]
            }
        };
        [first, second].into_iter().flatten()
    }

    /// Radius of a ball about the shape's origin that holds it, m.
    pub fn calc_bounding_radius(&self) -> f64 {
        self.sheets(0).flat_map(|s| s.ends.map(|end| end.rho.hypot(end.z) + s.radius)).fold(0.0, f64::max)
    }

    /// Checks all sizes.
    pub(crate) fn check(&self, collider: &str) -> Result<(), ContactError> {
        let size = |quantity, value: f64, may_be_zero: bool| {
            if value.is_finite() && (value > 0.0 || (may_be_zero && value == 0.0)) {
                return Ok(());
            }
            Err(ContactError::Size { collider: collider.to_owned(), quantity, value })
        };
        let angle = |quantity, value: f64, below: f64| {
            if value > 0.0 && value < below {
                return Ok(());
            }
            let (collider, below_deg) = (collider.to_owned(), below.to_degrees());
            Err(ContactError::Angle { collider, quantity, value_deg: value.to_degrees(), below_deg })
        };
        match *self {
            Self::InnerCone { half_angle, depth, throat_radius, wall } => {
                angle("half angle", half_angle, FRAC_PI_2)?;
                size("depth", depth, false)?;
                size("throat radius", throat_radius, true)?;
                size("wall", wall, false)
            }
            Self::InnerCylinder { radius, depth, wall, .. } => {
                size("radius", radius, false)?;
                size("depth", depth, false)?;
                size("wall", wall, false)
            }
            Self::Ring { major_radius, minor_radius } => {
                size("major radius", major_radius, false)?;
                size("minor radius", minor_radius, false)
            }
            Self::Petal { base_radius, tip_radius, height, half_sector, thickness } => {
                size("base radius", base_radius, false)?;
                size("tip radius", tip_radius, true)?;
                size("height", height, false)?;
                angle("half sector", half_sector, PI)?;
                size("thickness", thickness, false)
            }
        }
    }
}

fn at([rho, z]: [f64; 2]) -> Meridian {
    Meridian { rho, z }
}

/// A number that follows from a name alone (FNV-1a).
pub(crate) fn rank_of(name: &str) -> u64 {
    name.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}
