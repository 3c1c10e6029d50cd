//! URDF to a checked, immutable tree, and the algorithms on it.
//!
//! **files → [`RobotDescription`] → tree → kinematics and dynamics.** This crate knows nothing of contact or time.

mod aba;
mod description;
mod dynamics;
mod followers;
mod inertial;
mod kinematics;
mod mesh;
mod singular;
mod tree;
mod urdf;

pub use aba::Drive;
pub use description::{
    Collision, DockingGeometry, Geometry, Inertial, JointDescription, JointKind, LinkDescription, Mesh, Mimic,
    RobotDescription, Visual,
};
pub use dynamics::{
    Accelerations, Dynamics, Moves, add_gravity, calc_armature_energy, calc_centroidal_momentum, calc_kinetic_energy,
    calc_locked_inertia, calc_momentum, calc_potential_energy,
};
pub use followers::EmptyRange;
pub use kinematics::Kinematics;
pub use mesh::{MeshError, SearchPaths, TextPlace, load_mesh};
pub use singular::{Freedom, find_singular_freedoms, find_singular_freedoms_at};
pub use tree::{Body, Joint, Link, SlidingPoint, Tree};
pub use urdf::{
    LoadedUrdf, Loss, UrdfDoubt, UrdfError, UrdfErrors, UrdfFinding, UrdfFindings, UrdfProblem, UrdfWarning,
    UrdfWarnings, load_urdf, parse_urdf,
};
