//! A vehicle: a URDF, how its base is held, and where everything starts.

use super::docking::Approach;
use super::mechanism::MechanismSide;
use super::pose::{PoseSpec, TwistSpec, attitude};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use spatial::nalgebra::Translation3;
use spatial::{Pose, Vec3};
use std::collections::BTreeMap;

/// A robot, spacecraft or test article, from a URDF.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Vehicle {
    /// Unique name; the first part of `vehicle/link` and of every channel.
    #[schemars(extend("x-name" = true))]
    pub name: String,
    /// Path of the URDF, relative to the scenario file.
    #[schemars(length(min = 1))]
    pub urdf: String,
    /// Folders in which `package://` paths of the URDF are looked up, relative to the scenario file.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub package_paths: Vec<String>,
    /// Joints whose range in the URDF is no stop: what plans motions has one where nothing stops the joint.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unstopped_joints: Vec<String>,
    /// How the base is held: "free", "fixed", or { free = ["x", "y", "yaw"] }.
    #[serde(default)]
    pub base: Base,
    /// Pose of the base link in W at t = 0.
    #[serde(default)]
    pub pose: PoseSpec,
    /// Motion of the base origin at t = 0: linear in W axes, angular in body axes.
    #[serde(default)]
    pub twist: TwistSpec,
    /// Joint positions and rates at t = 0, by joint name; joints without an entry start at rest at zero, or at the
    /// nearest end of their range.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub joints: BTreeMap<String, JointStart>,
    /// Start in front of a port, instead of `pose` and `twist`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub approach: Option<Approach>,
    /// Start at rest on a link of a vehicle above, wherever that is and however it moves: a ring on its struts. Instead of `pose`
    /// and `twist`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rides_on: Option<MechanismSide>,
    /// Initial arm pose by inverse kinematics, starting from `joints`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end_effector_pose: Option<EndEffectorPose>,
}

/// How the base of a vehicle is held.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Base {
    /// All of it: "free" or "fixed".
    Whole(BaseKind),
    /// Some directions free, the others held.
    Partial(PartialBase),
}

/// A base that is free or fixed as a whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BaseKind {
    /// Floats: six degrees of freedom.
    Free,
    /// Stands still in W.
    Fixed,
}

/// A base that moves in some directions only.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PartialBase {
    /// The free directions, in the axes of the base's initial pose.
    #[schemars(length(min = 1, max = 6))]
    pub free: Vec<BaseAxis>,
}

/// A direction in which a base may be free.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BaseAxis {
    /// Along x.
    X,
    /// Along y.
    Y,
    /// Along z.
    Z,
    /// About x.
    Roll,
    /// About y.
    Pitch,
    /// About z.
    Yaw,
}

impl Default for Base {
    fn default() -> Self {
        Self::Whole(BaseKind::Free)
    }
}

impl Base {
    /// Whether the base moves in every direction.
    pub fn is_free(&self) -> bool {
        self.free_axes().len() == 6
    }

    /// Whether the base stands still.
    pub fn is_fixed(&self) -> bool {
        self.free_axes().is_empty()
    }

    /// The free directions, each once, translations first.
    pub fn free_axes(&self) -> Vec<BaseAxis> {
        use BaseAxis::{Pitch, Roll, X, Y, Yaw, Z};
        let mut axes = match self {
            Self::Whole(BaseKind::Free) => vec![X, Y, Z, Roll, Pitch, Yaw],
            Self::Whole(BaseKind::Fixed) => vec![],
            Self::Partial(partial) => partial.free.clone(),
        };
        axes.sort_unstable();
        axes.dedup();
        axes
    }
}

/// Where a joint starts: an angle or, for prismatic joints, a displacement, and a rate.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("x-at-most-one" = [
    ["position_deg", "position_rad", "position_m"],
    ["velocity_deg_per_s", "velocity_rad_per_s", "velocity_m_per_s"],
    ["position_m", "velocity_deg_per_s", "velocity_rad_per_s"],
    ["velocity_m_per_s", "position_deg", "position_rad"],
]))]
pub struct JointStart {
    /// Angle, deg.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position_deg: Option<f64>,
    /// Angle, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position_rad: Option<f64>,
    /// Displacement of a prismatic joint, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position_m: Option<f64>,
    /// Rate, deg/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub velocity_deg_per_s: Option<f64>,
    /// Rate, rad/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub velocity_rad_per_s: Option<f64>,
    /// Rate of a prismatic joint, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub velocity_m_per_s: Option<f64>,
}

impl JointStart {
    /// Position, rad or m; zero where the file says nothing.
    pub fn position(&self) -> f64 {
        let rad = self.position_rad.or(self.position_deg.map(f64::to_radians));
        rad.or(self.position_m).unwrap_or(0.0)
    }

    /// Rate, rad/s or m/s; zero where the file says nothing.
    pub fn velocity(&self) -> f64 {
        let rad_per_s = self.velocity_rad_per_s.or(self.velocity_deg_per_s.map(f64::to_radians));
        rad_per_s.or(self.velocity_m_per_s).unwrap_or(0.0)
    }

    /// Whether metres are given: then the joint must be prismatic. `None` when nothing is given.
    pub fn is_linear(&self) -> Option<bool> {
        let linear = self.position_m.is_some() || self.velocity_m_per_s.is_some();
        (linear || *self != Self::default()).then_some(linear)
    }
}

/// Pose that a frame of the vehicle shall have at t = 0, reached by inverse kinematics.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-at-most-one" = [["rpy_deg", "quaternion_wxyz"]]))]
pub struct EndEffectorPose {
    /// Link of this vehicle that shall take the pose.
    #[schemars(length(min = 1))]
    pub frame: String,
    /// What the pose is measured in: "world" or a `vehicle/link`.
    #[serde(default = "world")]
    #[schemars(extend("x-refers" = "vehicle/part"))]
    pub relative_to: String,
    /// Position of the frame's origin, m.
    pub position_m: [f64; 3],
    /// Roll, pitch and yaw about the fixed x, y and z axes, in that order, deg.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rpy_deg: Option<[f64; 3]>,
    /// Unit quaternion, scalar first; instead of `rpy_deg`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit-quaternion" = true))]
    pub quaternion_wxyz: Option<[f64; 4]>,
    /// Joints that may move; by default all between the base and the frame.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub joints: Vec<String>,
}

/// The place of things that belong to no vehicle.
pub(super) fn world() -> String {
    "world".to_owned()
}

impl EndEffectorPose {
    /// The pose of `frame` in `relative_to`, in metres.
    pub fn pose(&self) -> Pose {
        Pose::from_parts(
            Translation3::from(Vec3::from(self.position_m)),
            attitude(self.rpy_deg.as_ref(), self.quaternion_wxyz.as_ref()),
        )
    }
}
