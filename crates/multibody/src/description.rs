//! A robot as its file describes it: plain, checked data, before it becomes a [`crate::Tree`].
//!
//! Frames are those of URDF: a joint's origin places the child link's frame in the parent link's frame; the joint
//! moves about or along `axis`, in the joint (= child) frame. Units are SI.

use spatial::{Mat3, Pose, Vec3};
use std::path::PathBuf;
use std::sync::Arc;

/// A whole robot: one connected tree of links.
#[derive(Clone, Debug)]
pub struct RobotDescription {
    /// The robot's name.
    pub name: String,
    /// The file it was read from, for messages.
    pub file: PathBuf,
    /// Links; the first is the root, parents stand before children.
    pub links: Vec<LinkDescription>,
    /// Joints; joint `i` carries link `i + 1`.
    pub joints: Vec<JointDescription>,
}

impl RobotDescription {
    /// Whether the root, or anything fixed to it, has mass; a fixed base needs none.
    pub fn root_has_mass(&self) -> bool {
        let mut is_root_body = vec![true; self.links.len()];
        for (i, joint) in self.joints.iter().enumerate() {
            is_root_body[i + 1] = joint.kind == JointKind::Fixed && is_root_body[joint.parent];
        }
        self.links
            .iter()
            .zip(is_root_body)
            .any(|(link, is_root)| is_root && link.inertial.is_some_and(|i| i.mass > 0.0))
    }
}

/// One link.
#[derive(Clone, Debug)]
pub struct LinkDescription {
    /// Unique name.
    pub name: String,
    /// Mass properties; `None` for a massless frame.
    pub inertial: Option<Inertial>,
    /// What is seen.
    pub visuals: Vec<Visual>,
    /// What touches.
    pub collisions: Vec<Collision>,
}

/// Mass properties of a link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertial {
    /// kg, not negative; zero only with a tensor that is not.
    pub mass: f64,
    /// Centre of mass in the link frame, m.
    pub com: Vec3,
    /// Tensor about the centre of mass, in the *link's* axes (already turned from the inertial frame's), kg·m². As the file
    /// has it: by itself it need not be a rigid body's, together with what is fixed to the link it has no negative moment.
    pub tensor_com: Mat3,
}

/// A visible shape of a link.
#[derive(Clone, Debug)]
pub struct Visual {
    /// Its name, or a made-up one (`link_visual_0`).
    pub name: String,
    /// Shape frame in the link frame.
    pub pose_ls: Pose,
    /// The shape.
    pub geometry: Geometry,
    /// Colour, linear RGBA in 0–1, from the material.
    pub rgba: Option<[f64; 4]>,
}

/// A touching shape of a link.
#[derive(Clone, Debug)]
pub struct Collision {
    /// Its name, or the link's name where it is the only one (`link_1`, `link_2` otherwise).
    pub name: String,
    /// Shape frame in the link frame.
    pub pose_ls: Pose,
    /// The shape.
    pub geometry: Geometry,
}

/// A shape, in its own frame.
#[derive(Clone, Debug)]
pub enum Geometry {
    /// Full edge lengths, m.
    Box {
        /// Along x, y, z.
        size: Vec3,
    },
    /// About the origin.
    Sphere {
        /// m.
        radius: f64,
    },
    /// Along z, centred.
    Cylinder {
        /// m.
        radius: f64,
        /// Full length, m.
        length: f64,
    },
    /// Along z, centred.
    Capsule {
        /// m.
        radius: f64,
        /// Length of the cylindrical part, m.
        length: f64,
    },
    /// Triangles, scale applied.
    Mesh(Arc<Mesh>),
    /// A docking shape, named by softdock's own tag; only of collisions.
    Docking(DockingGeometry),
    /// A shape that could not be had, with the reason; only of collisions. A contact that needs it cannot be simulated.
    Missing(Arc<str>),
}

/// A docking shape, in its own frame; lengths in m, angles in rad. The contact crate says what each is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DockingGeometry {
    /// The inside of a cone frustum: mouth in z = 0, opens to +z.
    InnerCone {
        /// Angle between wall and axis.
        half_angle: f64,
        /// From mouth to throat along the axis.
        depth: f64,
        /// Inner radius at the throat.
        throat_radius: f64,
        /// Thickness of the wall.
        wall: f64,
    },
    /// The inside of a tube: mouth in z = 0, opens to +z.
    InnerCylinder {
        /// Inner radius.
        radius: f64,
        /// From the mouth to the other end.
        depth: f64,
        /// Thickness of the wall.
        wall: f64,
        /// Whether the other end is closed.
        floor: bool,
    },
    /// A torus about z.
    Ring {
        /// Of the circle in z = 0.
        major_radius: f64,
        /// Of the cross-section.
        minor_radius: f64,
    },
    /// The sector of a cone frustum, a rounded plate centred on +x with its base in z = 0.
    Petal {
        /// At z = 0.
        base_radius: f64,
        /// At the tip.
        tip_radius: f64,
        /// Of the tip.
        height: f64,
        /// Half the angle it spans about z.
        half_sector: f64,
        /// Of the plate.
        thickness: f64,
    },
}

/// A triangle mesh, in metres, in the shape's frame.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// The resolved file.
    pub file: PathBuf,
    /// Vertices, m, scale applied.
    pub vertices: Vec<[f64; 3]>,
    /// Counter-clockwise from outside; each index is inside `vertices`.
    pub triangles: Vec<[u32; 3]>,
    /// Colour per vertex, RGBA 0–1, where the file has materials (empty otherwise).
    pub vertex_rgba: Vec<[f32; 4]>,
}

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// Turns about the axis.
    Revolute,
    /// Slides along the axis.
    Prismatic,
    /// Does not move.
    Fixed,
    /// Six freedoms.
    Floating,
    /// Slides in the plane normal to the axis and turns about it.
    Planar,
}

/// One joint.
#[derive(Clone, Debug)]
pub struct JointDescription {
    /// Unique name.
    pub name: String,
    /// How it moves (URDF `continuous` is `Revolute` without position limits).
    pub kind: JointKind,
    /// Index of the parent link, smaller than the child's.
    pub parent: usize,
    /// Joint frame in the parent link frame.
    pub pose_pj: Pose,
    /// Unit vector in the joint frame.
    pub axis: Vec3,
    /// Limits, lower ≤ upper; `None` where the joint has none. One of them may be infinite, never both.
    pub position_limits: Option<[f64; 2]>,
    /// Largest effort, N·m or N; infinite if not given.
    pub effort_limit: f64,
    /// Largest speed, rad/s or m/s; infinite if not given.
    pub velocity_limit: f64,
    /// Viscous friction, N·m·s/rad or N·s/m.
    pub damping: f64,
    /// Dry friction level, N·m or N.
    pub friction: f64,
    /// Follows another joint: position = multiplier × its position + offset.
    pub mimic: Option<Mimic>,
}

/// A joint that follows another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mimic {
    /// Index of the leading joint; it follows nobody itself.
    pub joint: usize,
    /// Ratio of the rates.
    pub multiplier: f64,
    /// Position at the leader's zero, rad or m.
    pub offset: f64,
}
