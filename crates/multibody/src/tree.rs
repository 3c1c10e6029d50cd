//! The immutable tree of moving bodies that the algorithms run on.
//!
//! Links that fixed joints hold together become one *body*; body 0 is the base, joint `i` moves body `i + 1`, parents
//! stand before children. A joint's motion is a set of screws that are constant in its child's frame, so that one
//! formula serves all kinds:
//!   V_child = V_parent + S v,     d/dt(S v) = S v̇ + V_parent × S v.
//!
//! | kind | q | v |
//! | --- | --- | --- |
//! | revolute, prismatic | angle rad, or length m | its rate |
//! | floating | x, y, z, qx, qy, qz, qw of the child in the joint frame | linear, angular, both in the child's axes |
//! | planar | x, y, θ in the plane normal to the axis | vx, vy in the child's axes, θ̇ |
//!
//! A mimic joint has no coordinate of its own: it reads its leader's, and its screw is scaled by the multiplier, so
//! that velocities, forces and inertias fold into the leader's coordinate by themselves; its limits, damping and friction
//! are laid on the leader's ([`crate::followers`]).

use crate::{JointDescription, JointKind, RobotDescription};
use nalgebra::{Quaternion, UnitQuaternion};
use spatial::{Frame, Inertia, Twist, Vec3, exp_rotation, log_rotation, nalgebra, rotation_about};

/// A robot, ready to move; never changes after it is built.
#[derive(Clone, Debug)]
pub struct Tree {
    /// The robot's name.
    pub name: String,
    /// Moving bodies; the first is the base.
    pub bodies: Vec<Body>,
    /// Moving joints; joint `i` moves body `i + 1`.
    pub joints: Vec<Joint>,
    /// All links of the file, each fixed in a body.
    pub links: Vec<Link>,
    /// Length of the configuration vector, base excluded.
    pub nq: usize,
    /// Number of joint freedoms, base excluded, mimic joints not counted.
    pub nv: usize,
    /// Configuration where every joint is at zero.
    pub q_zero: Vec<f64>,
    /// Point masses that [`Tree::add_sliding_point`] has added.
    pub sliding_points: Vec<SlidingPoint>,
}

/// A point mass that slides along the axes of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SlidingPoint {
    /// The first of its three joints: along x; those along y and z follow.
    pub joint: usize,
    /// Its link.
    pub link: usize,
}

/// A moving body: a link and all that is fixed to it.
#[derive(Clone, Debug)]
pub struct Body {
    /// Index of the parent body; the base's is itself.
    pub parent: usize,
    /// About the body's origin, in its axes.
    pub inertia: Inertia,
}

/// A link, fixed in a body.
#[derive(Clone, Debug)]
pub struct Link {
    /// Its name in the file.
    pub name: String,
    /// The body it belongs to.
    pub body: usize,
    /// The link that it hangs on; none of the base.
    pub parent: Option<usize>,
    /// The joint between the two, a fixed one too; empty of the base.
    pub joint: String,
    /// Link frame in the body frame.
    pub frame_bl: Frame,
    /// The link's own inertia, about the link's origin, in its axes.
    pub inertia: Inertia,
}

/// A moving joint.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Its name in the file.
    pub name: String,
    /// Never `Fixed`.
    pub kind: JointKind,
    /// Joint frame in the parent body's frame.
    pub frame_pj: Frame,
    /// Unit vector in the joint frame.
    pub axis: Vec3,
    /// First screw in [`crate::Kinematics::screws`].
    pub column: usize,
    /// Number of screws.
    pub width: usize,
    /// First index into `q`; a mimic joint's is its leader's.
    pub q_index: usize,
    /// First index into `v`; a mimic joint's is its leader's.
    pub v_index: usize,
    /// Own rate over the coordinate's rate; 1 unless it mimics.
    pub multiplier: f64,
    /// Own position at the coordinate's zero; 0 unless it mimics.
    pub offset: f64,
    /// Whether it follows another joint.
    pub is_mimic: bool,
    /// Stops, rad or m; a leader's are narrowed to where its followers stay within theirs.
    pub position_limits: Option<[f64; 2]>,
    /// Largest effort, N·m or N.
    pub effort_limit: f64,
    /// Largest speed, rad/s or m/s; a leader's is the least that it or a follower allows.
    pub velocity_limit: f64,
    /// Viscous friction, N·m·s/rad or N·s/m; a leader's with that of its followers.
    pub damping: f64,
    /// Dry friction level, N·m or N; a leader's with that of its followers.
    pub friction: f64,
    /// Inertia that belongs to the coordinate and to no body, kg·m² or kg: a geared drive's rotor, reflected to the
    /// joint, its gyroscopic terms neglected. It adds to the diagonal of the mass matrix and is no part of the momentum.
    pub armature: f64,
}

/// Widths of a kind in `q` and in `v`.
pub(crate) fn widths(kind: JointKind) -> (usize, usize) {
    match kind {
        JointKind::Revolute | JointKind::Prismatic => (1, 1),
        JointKind::Fixed => (0, 0),
        JointKind::Floating => (7, 6),
        JointKind::Planar => (3, 3),
    }
}

impl Tree {
    /// Merges fixed links, numbers the coordinates and sums the inertias of a checked description.
    pub fn from_description(robot: &RobotDescription) -> Self {
        let mut tree = Self {
            name: robot.name.clone(),
            bodies: vec![Body { parent: 0, inertia: Inertia::default() }],
            joints: Vec::new(),
            links: Vec::with_capacity(robot.links.len()),
            nq: 0,
            nv: 0,
            q_zero: Vec::new(),
            sliding_points: Vec::new(),
        };
        let mut joint_of_description = vec![usize::MAX; robot.joints.len()];
        for (i, link) in robot.links.iter().enumerate() {
            let (body, frame_bl) = match i.checked_sub(1).map(|j| (j, &robot.joints[j])) {
                None => (0, Frame::identity()),
                Some((_, joint)) if joint.kind == JointKind::Fixed => {
                    let parent = &tree.links[joint.parent];
                    (parent.body, &parent.frame_bl * &Frame::from(&joint.pose_pj))
                }
                Some((j, joint)) => {
                    joint_of_description[j] = tree.joints.len();
                    (tree.add_joint(joint), Frame::identity())
                }
            };
            let inertia =
                link.inertial.map_or(Inertia::default(), |m| Inertia::from_com(m.mass, &m.com, &m.tensor_com));
            tree.bodies[body].inertia += inertia.transformed(&frame_bl.rot, &frame_bl.pos);
            let own = i.checked_sub(1).map(|j| &robot.joints[j]);
            let (parent, joint) = (own.map(|j| j.parent), own.map_or(String::new(), |j| j.name.clone()));
            tree.links.push(Link { name: link.name.clone(), body, parent, joint, frame_bl, inertia });
        }
        tree.number_coordinates(robot, &joint_of_description);
        tree.load_leaders();
        tree
    }

    fn add_joint(&mut self, joint: &JointDescription) -> usize {
        let parent = &self.links[joint.parent];
        let (parent_body, frame_pj) = (parent.body, &parent.frame_bl * &Frame::from(&joint.pose_pj));
        let column = self.joints.last().map_or(0, |j| j.column + j.width);
        self.joints.push(Joint {
            name: joint.name.clone(),
            kind: joint.kind,
            frame_pj,
            axis: joint.axis,
            column,
            width: widths(joint.kind).1,
            q_index: 0,
            v_index: 0,
            multiplier: joint.mimic.map_or(1.0, |m| m.multiplier),
            offset: joint.mimic.map_or(0.0, |m| m.offset),
            is_mimic: joint.mimic.is_some(),
            position_limits: joint.position_limits,
            effort_limit: joint.effort_limit,
            velocity_limit: joint.velocity_limit,
            damping: joint.damping,
            friction: joint.friction,
            armature: 0.0,
        });
        self.bodies.push(Body { parent: parent_body, inertia: Inertia::default() });
        self.bodies.len() - 1
    }

    fn number_coordinates(&mut self, robot: &RobotDescription, joint_of_description: &[usize]) {
        for joint in self.joints.iter_mut().filter(|j| !j.is_mimic) {
            let (wq, wv) = widths(joint.kind);
            (joint.q_index, joint.v_index) = (self.nq, self.nv);
            self.nq += wq;
            self.nv += wv;
            self.q_zero.extend(std::iter::repeat_n(0.0, wq));
            if joint.kind == JointKind::Floating {
                self.q_zero[joint.q_index + 6] = 1.0;
            }
        }
        for (d, j) in joint_of_description.iter().enumerate().filter(|(_, j)| **j != usize::MAX) {
            if let Some(mimic) = robot.joints[d].mimic {
                let leader = &self.joints[joint_of_description[mimic.joint]];
                let (q_index, v_index) = (leader.q_index, leader.v_index);
                self.joints[*j].q_index = q_index;
                self.joints[*j].v_index = v_index;
            }
        }
    }

    /// Adds a rotor to a body: an axial inertia (kg·m²) that spins about `axis` (body axes) relative to it, in addition
    /// to the body's own inertia, which holds the rotor's mass. Returns the new joint's index.
    pub fn add_rotor(&mut self, body: usize, axis: &Vec3, inertia: f64, name: &str) -> usize {
        let axis = axis.normalize();
        let joint = self.bare_joint(name.to_owned(), JointKind::Revolute, Frame::identity(), axis);
        self.joints.push(joint);
        self.nq += 1;
        self.nv += 1;
        self.q_zero.push(0.0);
        // Axial part only: the transverse inertia belongs to the body. The rank-one tensor turns with the rotor but
        // does not change, since it spins about its own axis.
        let rotor = Inertia { mass: 0.0, mc: Vec3::zeros(), rot: inertia * axis * axis.transpose() };
        self.bodies.push(Body { parent: body, inertia: rotor });
        let (on, body) = (body, self.bodies.len() - 1);
        self.push_link(name, body, on, rotor);
        self.joints.len() - 1
    }

    /// A link of a body that no file names, on the first link of another body.
    fn push_link(&mut self, name: &str, body: usize, on: usize, inertia: Inertia) {
        let parent = self.links.iter().position(|link| link.body == on);
        let (name, joint) = (name.to_owned(), name.to_owned());
        self.links.push(Link { name, body, parent, joint, frame_bl: Frame::identity(), inertia });
    }

    /// A joint of one coordinate, behind all others, that nothing limits, damps or drives.
    fn bare_joint(&self, name: String, kind: JointKind, frame_pj: Frame, axis: Vec3) -> Joint {
        Joint {
            name,
            kind,
            frame_pj,
            axis,
            column: self.n_columns(),
            width: 1,
            q_index: self.nq,
            v_index: self.nv,
            multiplier: 1.0,
            offset: 0.0,
            is_mimic: false,
            position_limits: None,
            effort_limit: f64::INFINITY,
            velocity_limit: f64::INFINITY,
            damping: 0.0,
            friction: 0.0,
            armature: 0.0,
        }
    }

    /// Adds a point mass (kg) that slides along the axes of a body near `place` (body axes, m): three joints without limits,
    /// `name`_x to `name`_z, and a link `name` at the place, with the body's axes. The body keeps its inertia. Returns the
    /// index of the first joint.
    pub fn add_sliding_point(&mut self, body: usize, place: &Vec3, mass: f64, name: &str) -> usize {
        let first = self.joints.len();
        let mut parent = body;
        for (k, letter) in ["x", "y", "z"].into_iter().enumerate() {
            let pos = if k == 0 { *place } else { Vec3::zeros() };
            let frame_pj = Frame { pos, ..Frame::identity() };
            let joint = self.bare_joint(format!("{name}_{letter}"), JointKind::Prismatic, frame_pj, Vec3::ith(k, 1.0));
            self.joints.push(joint);
            self.nq += 1;
            self.nv += 1;
            self.q_zero.push(0.0);
            let own = if k == 2 { mass } else { 0.0 };
            let inertia = Inertia { mass: own, ..Inertia::default() };
            self.bodies.push(Body { parent, inertia });
            parent = self.bodies.len() - 1;
        }
        let inertia = self.bodies[parent].inertia;
        self.push_link(name, parent, body, inertia);
        self.sliding_points.push(SlidingPoint { joint: first, link: self.links.len() - 1 });
        first
    }

    /// The sliding point whose mass is a body.
    pub fn sliding_point(&self, body: usize) -> Option<SlidingPoint> {
        self.sliding_points.iter().copied().find(|point| self.links[point.link].body == body)
    }

    /// Number of screws: joint freedoms, mimic joints counted.
    pub fn n_columns(&self) -> usize {
        self.joints.last().map_or(0, |j| j.column + j.width)
    }

    /// Index of the link of that name.
    pub fn link(&self, name: &str) -> Option<usize> {
        self.links.iter().position(|l| l.name == name)
    }

    /// Index of the moving joint of that name.
    pub fn joint(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|j| j.name == name)
    }

    /// Total mass, kg.
    pub fn mass(&self) -> f64 {
        self.bodies.iter().map(|b| b.inertia.mass).sum()
    }

    /// Whether a mimic joint folds two screws into one coordinate.
    pub fn has_mimic(&self) -> bool {
        self.joints.iter().any(|j| j.is_mimic)
    }

    /// Moves `q` by the displacement `xi`: per joint the change of its coordinates, where a floating joint's is the
    /// change of position (joint-frame axes, m) and the rotation vector (child's axes, rad).
    pub fn retract(&self, q: &mut [f64], xi: &[f64]) {
        for joint in self.joints.iter().filter(|j| !j.is_mimic) {
            let (q, xi) = (&mut q[joint.q_index..], &xi[joint.v_index..]);
            if joint.kind == JointKind::Floating {
                for k in 0..3 {
                    q[k] += xi[k];
                }
                let turned = rotation_of_floating(q) * exp_rotation(&Vec3::new(xi[3], xi[4], xi[5]));
                q[3..7].copy_from_slice(turned.coords.as_slice());
            } else {
                for k in 0..joint.width {
                    q[k] += xi[k];
                }
            }
        }
    }

    /// Displacement from `q0` to `q1`: the inverse of [`Tree::retract`].
    pub fn calc_difference(&self, q0: &[f64], q1: &[f64], xi: &mut [f64]) {
        for joint in self.joints.iter().filter(|j| !j.is_mimic) {
            let (q0, q1, xi) = (&q0[joint.q_index..], &q1[joint.q_index..], &mut xi[joint.v_index..]);
            for k in 0..joint.width.min(3) {
                xi[k] = q1[k] - q0[k];
            }
            if joint.kind == JointKind::Floating {
                let turned = log_rotation(&(rotation_of_floating(q0).inverse() * rotation_of_floating(q1)));
                xi[3..6].copy_from_slice(turned.as_slice());
            }
        }
    }

    /// Displacement of a step at constant `v` over `h`, to second order; what [`Tree::retract`] takes.
    pub fn calc_displacement(&self, q: &[f64], v: &[f64], h: f64, xi: &mut [f64]) {
        for joint in self.joints.iter().filter(|j| !j.is_mimic) {
            let (q, v, xi) = (&q[joint.q_index..], &v[joint.v_index..], &mut xi[joint.v_index..]);
            match joint.kind {
                JointKind::Floating => {
                    let omega = Vec3::new(v[3], v[4], v[5]);
                    let mid = rotation_of_floating(q) * exp_rotation(&(0.5 * h * omega));
                    let moved = mid * (h * Vec3::new(v[0], v[1], v[2]));
                    xi[..3].copy_from_slice(moved.as_slice());
                    xi[3..6].copy_from_slice((h * omega).as_slice());
                }
                JointKind::Planar => {
                    let (s, c) = (q[2] + 0.5 * h * v[2]).sin_cos();
                    (xi[0], xi[1], xi[2]) = (h * (c * v[0] - s * v[1]), h * (s * v[0] + c * v[1]), h * v[2]);
                }
                _ => xi[0] = h * v[0],
            }
        }
    }

    /// Rate of the displacement `xi` from `q` at the rates `v`, for Runge–Kutta stages (rotation vectors to fourth order).
    pub fn calc_displacement_rate(&self, q: &[f64], xi: &[f64], v: &[f64], rate: &mut [f64]) {
        for joint in self.joints.iter().filter(|j| !j.is_mimic) {
            let (q, at) = (&q[joint.q_index..], joint.v_index);
            let (xi, v, rate) = (&xi[at..], &v[at..], &mut rate[at..]);
            match joint.kind {
                JointKind::Floating => {
                    let (theta, omega) = (Vec3::new(xi[3], xi[4], xi[5]), Vec3::new(v[3], v[4], v[5]));
                    let moved = rotation_of_floating(q) * exp_rotation(&theta) * Vec3::new(v[0], v[1], v[2]);
                    // Right composition: the sign of the odd term flips against Bortz's left form.
                    let cross = theta.cross(&omega);
                    let turned = omega + 0.5 * cross + theta.cross(&cross) / 12.0;
                    rate[..3].copy_from_slice(moved.as_slice());
                    rate[3..6].copy_from_slice(turned.as_slice());
                }
                JointKind::Planar => {
                    let (s, c) = (q[2] + xi[2]).sin_cos();
                    (rate[0], rate[1], rate[2]) = (c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]);
                }
                _ => rate[0] = v[0],
            }
        }
    }
}

/// Rotation part of a floating joint's coordinates.
pub(crate) fn rotation_of_floating(q: &[f64]) -> UnitQuaternion<f64> {
    UnitQuaternion::new_normalize(Quaternion::new(q[6], q[3], q[4], q[5]))
}

impl Joint {
    /// The child's frame, where the joint frame is at `frame_wj`, at the coordinates `q` of the whole tree.
    #[inline]
    pub(crate) fn place_child(&self, frame_wj: &Frame, q: &[f64]) -> Frame {
        let q = &q[self.q_index..];
        match self.kind {
            JointKind::Revolute => {
                let turned = rotation_about(&self.axis, self.multiplier * q[0] + self.offset);
                Frame { rot: frame_wj.rot * turned, pos: frame_wj.pos }
            }
            JointKind::Prismatic => {
                let moved = (self.multiplier * q[0] + self.offset) * self.axis;
                Frame { rot: frame_wj.rot, pos: frame_wj.point(&moved) }
            }
            JointKind::Fixed => *frame_wj,
            JointKind::Floating => {
                let rot = *rotation_of_floating(q).to_rotation_matrix().matrix();
                frame_wj * &Frame { rot, pos: Vec3::new(q[0], q[1], q[2]) }
            }
            JointKind::Planar => {
                let [ex, ey] = plane_axes(&self.axis);
                frame_wj * &Frame { rot: rotation_about(&self.axis, q[2]), pos: q[0] * ex + q[1] * ey }
            }
        }
    }

    /// Screws in W axes about the anchor, for a child at `rot`, `pos` (from the anchor).
    #[inline]
    pub(crate) fn write_screws(&self, rot: &spatial::Mat3, pos: &Vec3, screws: &mut [Twist]) {
        let turn = |axis: Vec3| Twist::new(axis, pos.cross(&axis));
        match self.kind {
            JointKind::Revolute => screws[0] = turn(rot * (self.multiplier * self.axis)),
            JointKind::Prismatic => screws[0] = Twist::new(Vec3::zeros(), rot * (self.multiplier * self.axis)),
            JointKind::Fixed => {}
            JointKind::Floating => {
                for k in 0..3 {
                    let axis = rot.column(k).into_owned();
                    screws[k] = Twist::new(Vec3::zeros(), axis);
                    screws[3 + k] = turn(axis);
                }
            }
            JointKind::Planar => {
                for (k, e) in plane_axes(&self.axis).iter().enumerate() {
                    screws[k] = Twist::new(Vec3::zeros(), rot * e);
                }
                screws[2] = turn(rot * self.axis);
            }
        }
    }
}

/// Two unit vectors that complete `axis` to a right-handed triad; x and y where the axis is z.
fn plane_axes(axis: &Vec3) -> [Vec3; 2] {
    let turn = nalgebra::Rotation3::rotation_between(&Vec3::z(), axis);
    let turn = turn.unwrap_or_else(|| nalgebra::Rotation3::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI));
    [turn * Vec3::x(), turn * Vec3::y()]
}
