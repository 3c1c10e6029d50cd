//! Poses, twists, wrenches and rigid-body inertias, on nalgebra.
//!
//! # Notation, used by every crate of softdock
//!
//! | written | read | is |
//! | --- | --- | --- |
//! | `pose_wb` | W←B | maps coordinates in B to coordinates in W: p_w = pose_wb · p_b |
//! | `rot_wb` | W←B | its rotation; the columns are B's axes in W |
//! | `p_bc_w` | B to C, in W axes | position vector, m |
//! | `vel_bc_w` | of C relative to B, in W axes | linear velocity, m/s |
//! | `omega_wb_w` | of B relative to W, in W axes | angular velocity, rad/s |
//! | `wrench_bo_w` | on B, about point Bo, in W axes | moment N·m and force N |
//!
//! W is inertial; A and B are the two bodies of a pair (a force is *on B*), C a contact (z from A to B), E an end
//! effector, T a target. Inner letters cancel: `pose_wc = pose_wb * pose_bc`.
//!
//! Spatial vectors put the angular part first. They are taken about a *point*, which each function names; unless it
//! says otherwise both the point and the axes are those of the vehicle's anchor: W axes, about its base origin.

mod inertia;
mod motion;
mod rotation;

pub use inertia::{Inertia, InertiaError, SpatialMatrix};
pub use motion::{Frame, Twist, Wrench};
pub use rotation::{exp_rotation, log_rotation, rotation_about, rotation_rate_of_vector, skew};

/// A vector of three components.
pub type Vec3 = nalgebra::Vector3<f64>;
/// A 3×3 matrix.
pub type Mat3 = nalgebra::Matrix3<f64>;
/// A rotation as a unit quaternion.
pub type Rot = nalgebra::UnitQuaternion<f64>;
/// A pose as a unit quaternion and a translation: what states and files hold.
pub type Pose = nalgebra::Isometry3<f64>;

pub use nalgebra;
