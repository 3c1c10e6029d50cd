//! The samples of beds against the surfaces of the other collider: each a point, asked as a ball of radius zero.
//!
//! Outside, solids with a closed form answer by it, hulls by the face over which the point stands, else by parry3d. Inside
//! boxes, cylinders and hulls the way out is through the nearest of the faces that the sample looks at: not sideways
//! through an edge, nor through the seam to the next part of a compound.
//!
//! Of a mesh the nearest triangle answers. An open one has no inside: there the sample's own normal m says on which side it
//! is, as ahead along m the surface is still to come and behind the sample is through. A closed one is a solid, and its
//! triangles look outward.

use crate::analytic::{Raw, plane_ball, swapped};
use crate::bed::Bed;
use crate::convex::{Convex, Core};
use crate::manifold::mix;
use crate::primitive::convex_ball;
use crate::scene::{Part, Solid, from_parry, to_parry};
use parry3d_f64::query::{PointQuery, PointQueryWithLocation};
use parry3d_f64::shape::{ConvexPolyhedron, TriMesh, TrianglePointLocation};
use spatial::{Frame, Vec3};

/// Least cosine between a sample's normal and that into the surface it meets.
const FACING: f64 = 0.1;
/// Distance (m) to an edge or vertex of a mesh below which its direction is lost in round-off.
const AT_EDGE: f64 = 1e-9;

/// Deepest penetration of a mesh that is looked for, in half diagonals of its box.
const DEEPEST: f64 = 0.25;

/// A part's surface as a sample asks it, in the part's frame: the sample's point and outward normal.
struct Asked {
    point: Vec3,
    normal: Vec3,
}

/// Points of beds, with their weights.
#[derive(Default)]
pub(crate) struct BedBuffer {
    pub(crate) found: Vec<(Raw, f64)>,
    frames: Vec<Frame>,
}

/// Whether a part is a bed.
pub(crate) fn is_bed(part: &Part) -> bool {
    matches!(part.solid, Solid::Bed(_))
}

impl BedBuffer {
    /// Finds the points of A's beds on B's solids and of B's beds on A's, nearer than `margin`.
    pub(crate) fn find(
        &mut self,
        (parts_a, pose_a): (&[Part], &Frame),
        (parts_b, pose_b): (&[Part], &Frame),
        margin: f64,
    ) {
        self.found.clear();
        self.find_side((parts_a, pose_a), (parts_b, pose_b), margin, 0);
        let start = self.found.len();
        let side = u32::from(parts_a.iter().any(is_bed));
        self.find_side((parts_b, pose_b), (parts_a, pose_a), margin, side);
        // Found with the solid as A and the sample as B: true for the second side.
        self.found[..start].iter_mut().for_each(|(p, _)| *p = swapped(p));
    }

    fn find_side(&mut self, (beds, pose): (&[Part], &Frame), other: (&[Part], &Frame), margin: f64, side: u32) {
        for (i, part) in beds.iter().enumerate() {
            let Solid::Bed(bed) = &part.solid else { continue };
            self.frames.clear();
            self.frames.extend(other.0.iter().map(|p| other.1 * &p.frame_bp));
            let start = self.found.len();
            self.add_samples((bed, &(pose * &part.frame_bp)), other.0, margin);
            self.found[start..].iter_mut().for_each(|(p, _)| p.feature = mix(p.feature, i as u32, side));
        }
    }

    fn add_samples(&mut self, (bed, frame): (&Bed, &Frame), solids: &[Part], margin: f64) {
        for (index, sample) in bed.samples.iter().enumerate() {
            let (point, normal) = (frame.point(&sample.point), frame.rot * sample.normal);
            let nearest = solids
                .iter()
                .zip(&self.frames)
                .filter_map(|(part, frame)| ask(part, frame, (&point, &normal), margin))
                .min_by(|a, b| a.gap.total_cmp(&b.gap));
            if let Some(raw) = nearest.filter(|raw| raw.gap < margin && -raw.normal.dot(&normal) > FACING) {
                self.found.push((Raw { feature: index as u64, ..raw }, sample.area / bed.reference_area));
            }
        }
    }
}

/// A solid as A, a sample (W axes) as B; `None` where it is out of reach or a bed.
fn ask(part: &Part, frame: &Frame, (point, normal): (&Vec3, &Vec3), margin: f64) -> Option<Raw> {
    let local = frame.inverse_point(point);
    let off = (local - part.centre).abs() - part.half;
    let reach = match part.solid {
        Solid::Other(..) => margin.max(DEEPEST * part.half.norm()),
        _ => margin,
    };
    if off.max() > reach {
        return None;
    }
    let asked = Asked { point: local, normal: frame.rot.tr_mul(normal) };
    let (away, gap) = match &part.solid {
        Solid::Ball(radius) => asked.on_ball(*radius),
        Solid::Primitive(convex, _) => match asked.inside(convex) {
            Some(way_out) => way_out,
            None => return Some(convex_ball(convex, frame, point, 0.0)),
        },
        Solid::HalfSpace(_) => return Some(plane_ball(frame, point, 0.0)),
        Solid::Docking(sheet, ..) => {
            let near = sheet.nearest(&local);
            (near.normal, near.distance - sheet.radius)
        }
        Solid::Bed(_) => return None,
        Solid::Other(twin, _) => match (twin.shape.as_convex_polyhedron(), twin.shape.as_trimesh()) {
            (Some(hull), _) => asked.on_hull(hull)?,
            (_, Some(mesh)) => asked.on_mesh(mesh, part.closed, reach)?,
            _ => return None,
        },
    };
    Some(Raw { feature: 0, point_a: frame.point(&(local - gap * away)), normal: frame.rot * away, gap })
}

impl Asked {
    /// Whether a surface with this outward normal faces the sample.
    fn faces(&self, normal: &Vec3) -> bool {
        -normal.dot(&self.normal) > FACING
    }

    /// Outward normal and (negative) gap of the nearest facing face of a core with faces, for a point inside of it.
    fn inside(&self, convex: &Convex) -> Option<(Vec3, f64)> {
        let p = &self.point;
        let face = |k: usize, half: f64| {
            let side = 1f64.copysign(-self.normal[k]);
            (Vec3::ith(k, side), side * p[k] - half)
        };
        let nearest = |ways: &[(Vec3, f64)]| {
            let facing = ways.iter().filter(|(n, gap)| *gap <= 0.0 && self.faces(n));
            facing.max_by(|a, b| a.1.total_cmp(&b.1)).copied()
        };
        match &convex.core {
            Core::Cuboid { half } if (p.abs() - half).max() <= 0.0 => {
                nearest(&[face(0, half.x), face(1, half.y), face(2, half.z)])
            }
            Core::Cylinder(c) if p.xy().norm() <= c.radius && p.z.abs() <= c.half => {
                let side = Vec3::new(p.x, p.y, 0.0).try_normalize(0.0).map(|n| (n, p.xy().norm() - c.radius));
                nearest(&[face(2, c.half), side.unwrap_or((Vec3::z(), f64::NEG_INFINITY))])
            }
            _ => None,
        }
    }

    fn on_ball(&self, radius: f64) -> (Vec3, f64) {
        let distance = self.point.norm();
        let away = if distance > 0.0 { self.point / distance } else { -self.normal };
        (away, distance - radius)
    }

    fn on_hull(&self, hull: &ConvexPolyhedron) -> Option<(Vec3, f64)> {
        let height = |of: usize| {
            let face = &hull.faces()[of];
            let corner = hull.vertices_adj_to_face()[face.first_vertex_or_edge as usize];
            let normal = from_parry(face.normal);
            (normal, normal.dot(&(self.point - from_parry(hull.points()[corner as usize]))))
        };
        let faces = || (0..hull.faces().len()).map(height);
        let (normal, gap) = faces().max_by(|a, b| a.1.total_cmp(&b.1))?;
        if gap <= 0.0 {
            return faces().filter(|(n, _)| self.faces(n)).max_by(|a, b| a.1.total_cmp(&b.1));
        }
        let near = from_parry(hull.project_local_point(to_parry(&self.point), true).point);
        let away = self.point - near;
        // Over the face: its normal is exact where the projection is to parry's tolerance.
        let distance = away.norm();
        if distance <= gap * (1.0 + OVER_FACE) { Some((normal, gap)) } else { Some((away / distance, distance)) }
    }

    fn on_mesh(&self, mesh: &TriMesh, closed: bool, reach: f64) -> Option<(Vec3, f64)> {
        let (near, (triangle, location)) =
            mesh.project_local_point_and_get_location_with_max_dist(to_parry(&self.point), false, reach)?;
        let away = self.point - from_parry(near.point);
        let distance = away.norm();
        let outward = from_parry(mesh.triangle(triangle).normal()?);
        let on_face = matches!(location, TrianglePointLocation::OnFace(..)) || distance < AT_EDGE;
        if closed && on_face {
            return Some((outward, outward.dot(&away)));
        }
        if closed {
            // Near an edge: inside where the triangle and the sample's normal both say so.
            let inside = outward.dot(&away) < 0.0 && away.dot(&self.normal) > 0.0;
            let side = if inside { -1.0 } else { 1.0 };
            return Some((away * (side / distance), side * distance));
        }
        let normal = if on_face { outward } else { away / distance };
        // The surface's normal looks against the sample's.
        let normal = if normal.dot(&self.normal) > 0.0 { -normal } else { normal };
        Some((normal, normal.dot(&away)))
    }
}

/// Relative excess of parry's distance over a face's height up to which a point counts as over the face.
const OVER_FACE: f64 = 1e-7;
