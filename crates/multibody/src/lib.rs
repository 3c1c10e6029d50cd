//! URDF to a checked, immutable tree, and the algorithms on it.
//!
//! **files → [`RobotDescription`] → tree → kinematics and dynamics.** This crate knows nothing of contact or time.

mod description;

pub use description::{
    Collision, Geometry, Inertial, JointDescription, JointKind, LinkDescription, Mesh, Mimic, RobotDescription, Visual,
};
