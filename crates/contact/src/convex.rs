//! Convex primitives: a core (segment, box, cylinder) with a rounding radius.
//!
//! A capsule is a segment with a radius. All questions of the narrow phase are about cores:
//! half their width along a direction, the face that looks along it, the edge that supports it. Every core is its own
//! mirror image in its origin, so its extents along +u and −u are the same.

use crate::cylinder::Cylinder;
use crate::patch::Patch;
use spatial::Vec3;

/// |cos| of the angle between n and an edge below which the edge as a whole supports n, not one of its ends.
pub(crate) const ALONG: f64 = 0.02;

/// The sharp part of a convex primitive, in its own frame, about the origin.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Core {
    /// Along z, between ±half.
    Segment {
        /// Half the length, m.
        half: f64,
    },
    /// A box.
    Cuboid {
        /// Half the edge lengths, m.
        half: Vec3,
    },
    /// Along z.
    Cylinder(Cylinder),
}

/// A convex primitive.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Convex {
    /// The core.
    pub(crate) core: Core,
    /// Rounding radius, m.
    pub(crate) radius: f64,
}

// A box's features: vertices 0..8, edges 8..20 (four per axis), 20 the whole. A segment's: its ends 0 and 1, 2 the line.
const CUBOID: u32 = 20;
const LINE: u32 = 2;

impl Core {
    /// Axes along which the core ends in flat faces: the first so many of x, y, z, or z alone.
    #[inline]
    pub(crate) fn face_axes(&self) -> &'static [usize] {
        match self {
            Core::Segment { .. } => &[],
            Core::Cuboid { .. } => &[0, 1, 2],
            Core::Cylinder(_) => &[2],
        }
    }

    /// Axes along which straight edges (or lines of a curved side) run.
    #[inline]
    pub(crate) fn edge_axes(&self) -> &'static [usize] {
        match self {
            Core::Cuboid { .. } => &[0, 1, 2],
            Core::Segment { .. } | Core::Cylinder(_) => &[2],
        }
    }
}

impl Convex {
    /// Number of the core as a whole.
    pub(crate) fn whole(&self) -> u32 {
        match &self.core {
            Core::Segment { .. } => LINE,
            Core::Cuboid { .. } => CUBOID,
            Core::Cylinder(_) => Cylinder::WHOLE,
        }
    }

    /// Smallest extent, m: what tolerances are measured by.
    #[inline]
    pub(crate) fn scale(&self) -> f64 {
        match &self.core {
            Core::Segment { half } => half.max(self.radius),
            Core::Cuboid { half } => half.x.min(half.y).min(half.z),
            Core::Cylinder(c) => c.radius.min(c.half),
        }
    }

    /// Half extents of the bounding box, m.
    pub(crate) fn half_extents(&self) -> Vec3 {
        let width = |k: usize| self.half_width(&Vec3::ith(k, 1.0)) + self.radius;
        Vec3::new(width(0), width(1), width(2))
    }

    /// Half the core's width along the unit vector `u`, m.
    #[inline]
    pub(crate) fn half_width(&self, u: &Vec3) -> f64 {
        match &self.core {
            Core::Segment { half } => half * u.z.abs(),
            Core::Cuboid { half } => u.x.abs() * half.x + u.y.abs() * half.y + u.z.abs() * half.z,
            Core::Cylinder(c) => c.half * u.z.abs() + c.radius * (u.x * u.x + u.y * u.y).sqrt(),
        }
    }

    /// The core's point that lies furthest along `d` (any length).
    #[inline]
    pub(crate) fn support(&self, d: &Vec3) -> Vec3 {
        match &self.core {
            Core::Segment { half } => Vec3::new(0.0, 0.0, half.copysign(d.z)),
            Core::Cuboid { half } => Vec3::new(half.x.copysign(d.x), half.y.copysign(d.y), half.z.copysign(d.z)),
            Core::Cylinder(c) => c.support(d),
        }
    }

    /// See [`Core::face_axes`].
    #[inline]
    pub(crate) fn face_axes(&self) -> &'static [usize] {
        self.core.face_axes()
    }

    /// See [`Core::edge_axes`].
    #[inline]
    pub(crate) fn edge_axes(&self) -> &'static [usize] {
        self.core.edge_axes()
    }

    /// Whether the core touches others with single points or curves, whose normals are no axis of either.
    #[inline]
    pub(crate) fn is_round(&self) -> bool {
        !matches!(self.core, Core::Cuboid { .. })
    }

    /// Sharp points of the core, m; how many of the array count.
    pub(crate) fn corners(&self) -> ([Vec3; 8], usize) {
        let mut out = [Vec3::zeros(); 8];
        match &self.core {
            Core::Segment { half } => {
                (out[0].z, out[1].z) = (-half, *half);
                (out, 2)
            }
            Core::Cuboid { half } => {
                for (i, corner) in out.iter_mut().enumerate() {
                    let side = |bit: usize, x: f64| if i & bit == 0 { -x } else { x };
                    *corner = Vec3::new(side(1, half.x), side(2, half.y), side(4, half.z));
                }
                (out, 8)
            }
            Core::Cylinder(_) => (out, 0),
        }
    }

    /// The core's point nearest to `p`; `p` itself inside.
    pub(crate) fn nearest(&self, p: &Vec3) -> Vec3 {
        match &self.core {
            Core::Segment { half } => Vec3::new(0.0, 0.0, p.z.clamp(-half, *half)),
            Core::Cuboid { half } => {
                Vec3::new(p.x.clamp(-half.x, half.x), p.y.clamp(-half.y, half.y), p.z.clamp(-half.z, half.z))
            }
            Core::Cylinder(c) => {
                let across = p.xy().norm();
                let within = if across > c.radius { c.radius / across } else { 1.0 };
                Vec3::new(within * p.x, within * p.y, p.z.clamp(-c.half, c.half))
            }
        }
    }

    /// Direction from the core to `p`; beside a cylinder's side the radial one, inside as outside.
    pub(crate) fn direction_to(&self, p: &Vec3) -> Option<Vec3> {
        let nearest = match &self.core {
            Core::Cylinder(c) if p.z.abs() <= c.half => Vec3::new(0.0, 0.0, p.z),
            _ => self.nearest(p),
        };
        (p - nearest).try_normalize(0.0)
    }

    /// The face that looks most along the unit vector `d`; for a segment itself.
    pub(crate) fn face_patch(&self, d: &Vec3, out: &mut Patch) {
        match &self.core {
            Core::Segment { .. } => self.edge_patch(d, out),
            Core::Cuboid { half } => cuboid_face(half, d, out),
            Core::Cylinder(c) => c.face_patch(d, out),
        }
    }

    /// The edge or the vertex that supports the unit vector `d`.
    pub(crate) fn edge_patch(&self, d: &Vec3, out: &mut Patch) {
        match &self.core {
            Core::Segment { half } => {
                out.begin(*d, LINE);
                out.push(Vec3::new(0.0, 0.0, -half), 0, LINE);
                out.push(Vec3::new(0.0, 0.0, *half), 1, LINE);
            }
            Core::Cuboid { half } => cuboid_edge(half, d, out),
            Core::Cylinder(c) => c.edge_patch(d, out),
        }
    }
}

/// Number of a box's vertex: bit k is set where the coordinate k is positive.
#[inline]
fn vertex_number(p: &Vec3) -> u32 {
    u32::from(p.x > 0.0) | u32::from(p.y > 0.0) << 1 | u32::from(p.z > 0.0) << 2
}

/// Number of a box's edge along axis `k` through `p`.
#[inline]
fn edge_number(k: usize, p: &Vec3) -> u32 {
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    8 + 4 * k as u32 + (u32::from(p[i] > 0.0) | u32::from(p[j] > 0.0) << 1)
}

/// The face of a box that looks along `d`; of equals the first.
fn cuboid_face(half: &Vec3, d: &Vec3, out: &mut Patch) {
    let a = d.abs();
    let k = if a.x >= a.y && a.x >= a.z { 0 } else { 1 + usize::from(a.z > a.y) };
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    let sign = 1f64.copysign(d[k]);
    let mut normal = Vec3::zeros();
    normal[k] = sign;
    out.begin(normal, CUBOID);
    // Counter-clockwise about +k is i, j; about −k the other way round.
    let ring = if sign > 0.0 {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
    } else {
        [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)]
    };
    for c in 0..4 {
        let ((u, v), (u_next, _)) = (ring[c], ring[(c + 1) % 4]);
        let mut p = Vec3::zeros();
        (p[k], p[i], p[j]) = (sign * half[k], u * half[i], v * half[j]);
        out.push(p, vertex_number(&p), edge_number(if u == u_next { j } else { i }, &p));
    }
}

/// The edge of a box that lies most across `d` and supports it, or the vertex where `d` leans along that edge.
fn cuboid_edge(half: &Vec3, d: &Vec3, out: &mut Patch) {
    out.begin(*d, CUBOID);
    let k = d.iamin();
    let mut p = Vec3::new(half.x.copysign(d.x), half.y.copysign(d.y), half.z.copysign(d.z));
    let edge = edge_number(k, &p);
    if d[k].abs() > ALONG {
        return out.push(p, vertex_number(&p), edge);
    }
    for side in [-1.0, 1.0] {
        p[k] = side * half[k];
        out.push(p, vertex_number(&p), edge);
    }
}
