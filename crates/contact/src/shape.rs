//! Shapes as a file or a builder describes them, and their checks.

use crate::{Bed, ContactError, Docking};
use spatial::{Pose, Vec3};

/// A collision shape in its own frame S; lengths in m.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A ball about the origin.
    Ball {
        /// Radius, m.
        radius: f64,
    },
    /// A box about the origin.
    Cuboid {
        /// Half the edge lengths, m.
        half_extents: Vec3,
    },
    /// A cylinder about the origin, its axis along z.
    Cylinder {
        /// Radius, m.
        radius: f64,
        /// Half the length, m.
        half_length: f64,
    },
    /// A cylinder along z with hemispheres on its ends.
    Capsule {
        /// Radius, m.
        radius: f64,
        /// Half the length of the cylindrical part, m.
        half_length: f64,
    },
    /// Solid for z ≤ 0, outward normal +z.
    HalfSpace,
    /// The convex hull of points.
    ConvexHull {
        /// Points, m; those inside are dropped.
        vertices: Vec<Vec3>,
    },
    /// A triangle mesh: solid where it is closed, thin and two-sided where it is open.
    TriMesh {
        /// Vertices, m.
        vertices: Vec<Vec3>,
        /// Corners of each triangle, counter-clockwise seen from outside (turned if a closed mesh is inside out).
        triangles: Vec<[u32; 3]>,
    },
    /// Samples of a face, each a contact point of its own with a share of the pair's law.
    Bed(Bed),
    /// A drogue, bore, capture ring or guide petal.
    Docking(Docking),
    /// Several shapes, each with its pose in S.
    Compound(Vec<(Pose, Shape)>),
}

/// Thickness, relative to the size, below which points count as lying in a plane.
const FLAT: f64 = 1e-9;

/// A shape that is fixed in a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Collider {
    /// Name, for errors and for choosing pairs (`servicer/finger_left`).
    pub name: String,
    /// Index of the moving body that carries it, as the caller counts them.
    pub body: usize,
    /// Pose of the shape in the body, B←S.
    pub pose_bs: Pose,
    /// The shape.
    pub shape: Shape,
}

impl Shape {
    /// Displacements that leave it where it is: shifts along its axes x, y, z, and turns about them through its origin.
    pub fn unmoved_by(&self) -> [bool; 6] {
        use crate::docking::Docking::{InnerCone, InnerCylinder, Ring};
        let about_z = [false, false, false, false, false, true];
        match self {
            Self::HalfSpace => [true, true, false, false, false, true],
            Self::Ball { .. } => [false, false, false, true, true, true],
            Self::Cylinder { .. } | Self::Capsule { .. } => about_z,
            Self::Docking(InnerCone { .. } | InnerCylinder { .. } | Ring { .. }) => about_z,
            Self::Docking(_)
            | Self::Cuboid { .. }
            | Self::ConvexHull { .. }
            | Self::TriMesh { .. }
            | Self::Bed(_)
            | Self::Compound(_) => [false; 6],
        }
    }
}

impl Collider {
    /// Checks sizes, vertices and indices; whether points span a volume shows when the scene is built.
    pub(crate) fn check(&self) -> Result<(), ContactError> {
        self.check_pose(&self.pose_bs)?;
        self.check_shape(&self.shape)
    }

    fn check_shape(&self, shape: &Shape) -> Result<(), ContactError> {
        match shape {
            Shape::Ball { radius } => self.check_size("radius", *radius),
            Shape::Cuboid { half_extents: h } => {
                [h.x, h.y, h.z].iter().try_for_each(|&x| self.check_size("half extent", x))
            }
            Shape::Cylinder { radius, half_length } | Shape::Capsule { radius, half_length } => {
                self.check_size("radius", *radius)?;
                self.check_size("half length", *half_length)
            }
            Shape::HalfSpace => Ok(()),
            Shape::Docking(docking) => docking.check(&self.name),
            Shape::ConvexHull { vertices } => {
                self.check_vertices(vertices)?;
                self.check_span(vertices)
            }
            Shape::TriMesh { vertices, triangles } => {
                self.check_vertices(vertices)?;
                self.check_triangles(vertices, triangles)
            }
            Shape::Bed(bed) => match bed.find_fault() {
                Some(fault) => Err(ContactError::Bed { collider: self.name.clone(), fault }),
                None => Ok(()),
            },
            Shape::Compound(parts) if parts.is_empty() => {
                Err(ContactError::EmptyCompound { collider: self.name.clone() })
            }
            Shape::Compound(parts) => parts.iter().try_for_each(|(pose, part)| {
                self.check_pose(pose)?;
                self.check_shape(part)
            }),
        }
    }

    fn check_size(&self, quantity: &'static str, value: f64) -> Result<(), ContactError> {
        if value > 0.0 && value.is_finite() {
            return Ok(());
        }
        Err(ContactError::Size { collider: self.name.clone(), quantity, value })
    }

    fn check_pose(&self, pose: &Pose) -> Result<(), ContactError> {
        let finite = pose.translation.vector.iter().chain(pose.rotation.coords.iter()).all(|x| x.is_finite());
        if finite { Ok(()) } else { Err(self.not_finite("its pose".to_string())) }
    }

    fn check_vertices(&self, vertices: &[Vec3]) -> Result<(), ContactError> {
        match vertices.iter().position(|v| v.iter().any(|x| !x.is_finite())) {
            Some(i) => Err(self.not_finite(format!("vertex {i}"))),
            None => Ok(()),
        }
    }

    fn check_triangles(&self, vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), ContactError> {
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&v) = corners.iter().find(|&&v| v as usize >= vertices.len()) {
                let (collider, vertex, vertices) = (self.name.clone(), v as usize, vertices.len());
                return Err(ContactError::MeshIndex { collider, triangle, vertex, vertices });
            }
        }
        let area = |t: &[u32; 3]| {
            let [p, q, r] = t.map(|i| vertices[i as usize]);
            (q - p).cross(&(r - p)).norm()
        };
        if triangles.iter().any(|t| area(t) > 0.0) {
            return Ok(());
        }
        Err(ContactError::DegenerateMesh { collider: self.name.clone(), triangles: triangles.len() })
    }

    /// Whether points span a volume: their spread along the third of three directions, each across those before.
    fn check_span(&self, points: &[Vec3]) -> Result<(), ContactError> {
        let mut arms: Vec<Vec3> = points.iter().map(|p| p - points[0]).collect();
        let size = arms.iter().map(Vec3::norm).fold(0.0, f64::max);
        for _ in 0..3 {
            let longest = arms.iter().copied().max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()));
            let Some(direction) = longest.and_then(|v| v.try_normalize(FLAT * size)) else {
                return Err(ContactError::DegenerateHull { collider: self.name.clone(), points: points.len() });
            };
            arms.iter_mut().for_each(|arm| *arm -= direction * direction.dot(arm));
        }
        Ok(())
    }

    fn not_finite(&self, what: String) -> ContactError {
        ContactError::NotFinite { collider: self.name.clone(), what }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_leaves_a_shape_where_it_is() {
        let moved_by = |shape: Shape| {
            let unmoved = shape.unmoved_by();
            (0..6).filter(|k| !unmoved[*k]).collect::<Vec<_>>()
        };
        assert_eq!(moved_by(Shape::HalfSpace), [2, 3, 4]);
        assert_eq!(moved_by(Shape::Ball { radius: 0.1 }), [0, 1, 2]);
        assert_eq!(moved_by(Shape::Cylinder { radius: 0.1, half_length: 1.0 }), [0, 1, 2, 3, 4]);
        assert_eq!(moved_by(Shape::Cuboid { half_extents: Vec3::new(1.0, 1.0, 1.0) }).len(), 6);
    }
}
