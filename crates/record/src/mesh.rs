//! Triangles of a shape, with normals, for viewers that shade by vertex normal.
//!
//! Vertices are doubled along sharp edges, so that boxes look like boxes and cylinders round: a corner's normal is
//! the area-weighted mean over those faces around the vertex that lie within 35° of the corner's own face.

use contact::Docking;
use multibody::{DockingGeometry, Geometry, Mesh};
use spatial::{Pose, Vec3};
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

/// Cosine of 35°: faces that meet at less than that look smooth.
const CREASE_COS: f64 = 0.819_152;
/// Sides of a round shape.
const SIDES: usize = 32;
/// Rings from pole to equator of a hemisphere.
const RINGS: usize = 8;

/// Triangles with per-vertex normals and, where the file has them, colours; single precision, as viewers take it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Vertices, m.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals, one per vertex.
    pub normals: Vec<[f32; 3]>,
    /// Colours RGBA, one per vertex or none at all.
    pub colours: Vec<[f32; 4]>,
    /// Counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Triangles of a shape that is placed at `pose_ls` in its link's frame.
pub fn triangulate(geometry: &Geometry, pose_ls: &Pose) -> TriangleMesh {
    match geometry {
        Geometry::Box { size } => shade(&cuboid(*size), &[], pose_ls),
        Geometry::Sphere { radius } => shade(&capsule(*radius, 0.0), &[], pose_ls),
        Geometry::Capsule { radius, length } => shade(&capsule(*radius, *length), &[], pose_ls),
        Geometry::Cylinder { radius, length } => shade(&cylinder(*radius, *length), &[], pose_ls),
        Geometry::Docking(docking) => shade(&of_docking(docking), &[], pose_ls),
        Geometry::Mesh(mesh) => shade(&of_file(mesh), &mesh.vertex_rgba, pose_ls),
        Geometry::Missing(_) => TriangleMesh::default(),
    }
}

/// Bare triangles over shared vertices.
#[derive(Default)]
struct Faces {
    vertices: Vec<Vec3>,
    triangles: Vec<[usize; 3]>,
}

impl Faces {
    /// Two triangles over four corners, counter-clockwise from outside.
    fn add_quad(&mut self, [a, b, c, d]: [usize; 4]) {
        self.triangles.extend([[a, b, c], [a, c, d]]);
    }

    /// Normal of a triangle; its length is twice the area.
    fn normal(&self, [a, b, c]: [usize; 3]) -> Vec3 {
        let (a, b, c) = (self.vertices[a], self.vertices[b], self.vertices[c]);
        (b - a).cross(&(c - a))
    }
}

fn of_docking(geometry: &DockingGeometry) -> Faces {
    let mesh = docking_of_geometry(geometry).tessellate();
    Faces { vertices: mesh.vertices, triangles: mesh.triangles.iter().map(|t| t.map(|i| i as usize)).collect() }
}

/// The contact crate's docking shape of a URDF's.
pub fn docking_of_geometry(geometry: &DockingGeometry) -> Docking {
    match *geometry {
        DockingGeometry::InnerCone { half_angle, depth, throat_radius, wall } => {
            Docking::InnerCone { half_angle, depth, throat_radius, wall }
        }
        DockingGeometry::InnerCylinder { radius, depth, wall, floor } => {
            Docking::InnerCylinder { radius, depth, wall, floor }
        }
        DockingGeometry::Ring { major_radius, minor_radius } => Docking::Ring { major_radius, minor_radius },
        DockingGeometry::Petal { base_radius, tip_radius, height, half_sector, thickness } => {
            Docking::Petal { base_radius, tip_radius, height, half_sector, thickness }
        }
    }
}

fn of_file(mesh: &Mesh) -> Faces {
    Faces {
        vertices: mesh.vertices.iter().map(|v| Vec3::from(*v)).collect(),
        triangles: mesh.triangles.iter().map(|t| t.map(|i| i as usize)).collect(),
    }
}

/// Corner `i` has the bits of `i` as signs: bit 0 x, bit 1 y, bit 2 z.
fn cuboid(size: Vec3) -> Faces {
    let sign = |i: usize, bit: usize| if i >> bit & 1 == 1 { 0.5 } else { -0.5 };
    let corner = |i| Vec3::new(sign(i, 0) * size.x, sign(i, 1) * size.y, sign(i, 2) * size.z);
    let mut faces = Faces { vertices: (0..8).map(corner).collect(), triangles: Vec::new() };
    for quad in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
        faces.add_quad(quad);
    }
    faces
}

fn cylinder(radius: f64, length: f64) -> Faces {
    let half = 0.5 * length;
    lathe(&[(0.0, -half), (radius, -half), (radius, half), (0.0, half)])
}

/// Two hemispheres, each from pole to equator or back; the radius at a pole is exactly zero.
fn capsule(radius: f64, length: f64) -> Faces {
    let arc = |ring: usize| 0.5 * PI * ring as f64 / RINGS as f64;
    let lower = (0..=RINGS).map(|ring| (radius * arc(ring).sin(), -0.5 * length - radius * arc(ring).cos()));
    let upper: Vec<(f64, f64)> = lower.clone().rev().map(|(r, z)| (r, -z)).collect();
    let profile: Vec<(f64, f64)> = lower.chain(upper).collect();
    lathe(&profile)
}

/// A profile of (radius, z), bottom to top, turned about z. Faces without area (at poles) are dropped when shaded.
fn lathe(profile: &[(f64, f64)]) -> Faces {
    let mut faces = Faces::default();
    for (radius, z) in profile {
        let at = |i: usize| TAU * i as f64 / SIDES as f64;
        faces.vertices.extend((0..SIDES).map(|i| Vec3::new(radius * at(i).cos(), radius * at(i).sin(), *z)));
    }
    for ring in 0..profile.len() - 1 {
        for side in 0..SIDES {
            let next = (side + 1) % SIDES;
            let (low, high) = (ring * SIDES, (ring + 1) * SIDES);
            faces.add_quad([low + side, low + next, high + next, high + side]);
        }
    }
    faces
}

/// Places the faces in the link's frame, gives each corner its normal and merges equal corners.
fn shade(faces: &Faces, colours: &[[f32; 4]], pose_ls: &Pose) -> TriangleMesh {
    let normals: Vec<Vec3> = faces.triangles.iter().map(|t| faces.normal(*t)).collect();
    let around = faces_around(faces, &normals);
    let mut mesh = TriangleMesh::default();
    let mut seen = HashMap::new();
    for (triangle, own) in faces.triangles.iter().zip(&normals).filter(|(_, normal)| normal.norm_squared() > 0.0) {
        let corner = |vertex: usize| {
            let point = faces.vertices[vertex];
            let normal = corner_normal(own, &around[&bits(&point)], &normals);
            let position = single((pose_ls * nalgebra_point(point)).coords);
            let colour = colours.get(vertex).copied();
            (position, single(pose_ls.rotation * normal), colour)
        };
        let indices = triangle.map(|vertex| index_of(corner(vertex), &mut mesh, &mut seen));
        mesh.triangles.push(indices);
    }
    mesh
}

type Corner = ([f32; 3], [f32; 3], Option<[f32; 4]>);

/// Index of a corner, new or seen before.
fn index_of(corner: Corner, mesh: &mut TriangleMesh, seen: &mut HashMap<[u32; 10], u32>) -> u32 {
    let (position, normal, colour) = corner;
    let mut key = [0; 10];
    let numbers = position.iter().chain(&normal).chain(colour.iter().flatten());
    key.iter_mut().zip(numbers).for_each(|(bits, number)| *bits = number.to_bits());
    *seen.entry(key).or_insert_with(|| {
        mesh.positions.push(position);
        mesh.normals.push(normal);
        mesh.colours.extend(colour);
        (mesh.positions.len() - 1) as u32
    })
}

/// Faces around each place: files often repeat a vertex per face, so the place counts and not the index.
fn faces_around(faces: &Faces, normals: &[Vec3]) -> HashMap<[u64; 3], Vec<usize>> {
    let mut around: HashMap<[u64; 3], Vec<usize>> = HashMap::new();
    for (face, triangle) in faces.triangles.iter().enumerate().filter(|(i, _)| normals[*i].norm_squared() > 0.0) {
        for vertex in triangle {
            let faces_here = around.entry(bits(&faces.vertices[*vertex])).or_default();
            if faces_here.last() != Some(&face) {
                faces_here.push(face);
            }
        }
    }
    around
}

fn corner_normal(own: &Vec3, around: &[usize], normals: &[Vec3]) -> Vec3 {
    let smooth = |n: &Vec3| own.dot(n) >= CREASE_COS * own.norm() * n.norm();
    let sum: Vec3 = around.iter().map(|face| normals[*face]).filter(smooth).sum();
    sum.try_normalize(0.0).unwrap_or(Vec3::z())
}

/// Adding zero makes −0 and +0 the same place.
fn bits(point: &Vec3) -> [u64; 3] {
    [point.x, point.y, point.z].map(|x| (x + 0.0).to_bits())
}

fn single(v: Vec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

fn nalgebra_point(v: Vec3) -> spatial::nalgebra::Point3<f64> {
    v.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn volume(mesh: &TriangleMesh) -> f64 {
        let at = |i: u32| Vec3::from(mesh.positions[i as usize].map(f64::from));
        mesh.triangles.iter().map(|t| at(t[0]).dot(&at(t[1]).cross(&at(t[2]))) / 6.0).sum()
    }

    /// Faces wound outwards enclose a positive volume; 32 sides miss about 1 % of a round one.
    #[test]
    fn triangles_enclose_the_volume_of_the_shape() {
        let close = |geometry: Geometry, truth: f64| {
            let mesh = triangulate(&geometry, &Pose::translation(0.3, -0.2, 0.1));
            let got = volume(&mesh);
            assert!((got / truth - 1.0).abs() < 0.02, "{geometry:?}: {got} for {truth}");
        };
        close(Geometry::Box { size: Vec3::new(1.0, 2.0, 3.0) }, 6.0);
        close(Geometry::Sphere { radius: 0.5 }, PI / 6.0);
        close(Geometry::Cylinder { radius: 0.5, length: 2.0 }, PI * 0.5);
        close(Geometry::Capsule { radius: 0.5, length: 2.0 }, PI * 0.5 + PI / 6.0);
        let torus = DockingGeometry::Ring { major_radius: 2.0, minor_radius: 0.5 };
        // Twelve sides of the cross-section miss 4.5 % of it.
        close(Geometry::Docking(torus), 2.0 * PI * PI * 2.0 * 0.25 * (6.0 / PI) * (PI / 6.0).sin());
    }

    #[test]
    fn box_has_flat_faces_and_a_sphere_is_round() {
        let cube = triangulate(&Geometry::Box { size: Vec3::repeat(1.0) }, &Pose::identity());
        assert_eq!(cube.positions.len(), 24); // three normals per corner
        assert!(cube.normals.iter().all(|n| n.iter().filter(|x| x.abs() > 0.999).count() == 1));

        let ball = triangulate(&Geometry::Sphere { radius: 2.0 }, &Pose::identity());
        let radial = |(p, n): (&[f32; 3], &[f32; 3])| (0..3).map(|i| p[i] * n[i]).sum::<f32>() / 2.0;
        assert!(ball.positions.iter().zip(&ball.normals).all(|pair| radial(pair) > 0.99));
    }
}
