//! Triangles of a docking shape: for viewers, and for hulls and meshes that meet it.
//!
//! The outline of the rounded meridian, a stadium, is swept round; a sector ends in half a stadium turned about its edge.

use super::Docking;
use super::sheet::{Meridian, Sheet};
use spatial::Vec3;
use std::f64::consts::PI;

/// Steps of half a turn of the rounding.
const ROUNDING: usize = 6;
/// Steps of a whole turn about the axis.
const TURN: usize = 64;

/// A closed triangle mesh for each piece, in one list.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tessellation {
    /// Vertices, m.
    pub vertices: Vec<Vec3>,
    /// Counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Docking {
    /// The shape's surface in triangles; its vertices lie on the surface.
    pub fn tessellate(&self) -> Tessellation {
        let mut mesh = Tessellation::default();
        self.sheets(0).for_each(|sheet| mesh.add(&sheet));
        mesh
    }
}

impl Tessellation {
    /// Adds a sheet.
    pub(crate) fn add(&mut self, sheet: &Sheet) {
        let half = sheet.half_sector.unwrap_or(PI);
        let steps = ((TURN as f64 * half / PI).ceil() as usize).max(4);
        let outline = outline(sheet);
        let closed = sheet.half_sector.is_none();
        let stations = if closed { steps } else { steps + 1 };
        let mut rings: Vec<Vec<Vec3>> = Vec::new();
        if !closed {
            rings.extend(
                (1..=ROUNDING).map(|i| end_ring(sheet, -half, -0.5 * PI * (1.0 - (i - 1) as f64 / ROUNDING as f64))),
            );
        }
        rings.extend((0..stations).map(|i| {
            let azimuth = -half + 2.0 * half * i as f64 / steps as f64;
            outline.iter().map(|p| turned(azimuth, p[0], p[1])).collect()
        }));
        if !closed {
            rings.extend((1..=ROUNDING).map(|i| end_ring(sheet, half, 0.5 * PI * i as f64 / ROUNDING as f64)));
        }
        self.add_rings(&rings, closed);
    }

    fn add_rings(&mut self, rings: &[Vec<Vec3>], closed: bool) {
        let (first, n, count) = (self.vertices.len(), rings[0].len(), rings.len());
        self.vertices.extend(rings.iter().flatten());
        let last = if closed { count } else { count - 1 };
        for i in 0..last {
            for j in 0..n {
                let at = |i: usize, j: usize| (first + (i % count) * n + j % n) as u32;
                let quad = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
                self.add_triangle([quad[0], quad[1], quad[2]]);
                self.add_triangle([quad[0], quad[2], quad[3]]);
            }
        }
    }

    /// A triangle, unless it has no area.
    fn add_triangle(&mut self, triangle: [u32; 3]) {
        let [a, b, c] = triangle.map(|i| self.vertices[i as usize]);
        if (b - a).cross(&(c - a)).norm() > 1e-15 * ((b - a).norm_squared() + (c - a).norm_squared()) {
            self.triangles.push(triangle);
        }
    }
}

/// The stadium about the meridian as (ρ, z), clockwise with ρ to the right. What would lie beyond the axis is laid on it.
fn outline(sheet: &Sheet) -> Vec<[f64; 2]> {
    let [p, q] = sheet.ends;
    let at = |end: Meridian, angle: f64| {
        [(end.rho + sheet.radius * angle.cos()).max(0.0), end.z + sheet.radius * angle.sin()]
    };
    let angle = |i: usize| -PI * i as f64 / ROUNDING as f64;
    if p == q {
        return (0..2 * ROUNDING).map(|i| at(p, angle(i))).collect();
    }
    let along = (q.z - p.z).atan2(q.rho - p.rho);
    let half = |end, start: f64| (0..=ROUNDING).map(move |i| at(end, start + angle(i)));
    half(q, along + 0.5 * PI).chain(half(p, along - 0.5 * PI)).collect()
}

/// The stadium at a sector's edge, narrowed and moved out along the azimuth by the sine of `tilt`.
fn end_ring(sheet: &Sheet, azimuth: f64, tilt: f64) -> Vec<Vec3> {
    let thin = Sheet { radius: sheet.radius * tilt.cos().max(0.0), ..*sheet };
    let beyond = sheet.radius * tilt.sin() * Vec3::new(-azimuth.sin(), azimuth.cos(), 0.0);
    outline(&thin).iter().map(|o| turned(azimuth, o[0], o[1]) + beyond).collect()
}

fn turned(azimuth: f64, rho: f64, z: f64) -> Vec3 {
    let (s, c) = azimuth.sin_cos();
    Vec3::new(rho * c, rho * s, z)
}
