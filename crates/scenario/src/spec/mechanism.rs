//! Mechanisms: struts, bushings, latches and welds between two links, or a link and the world.

use super::pose::attitude;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use spatial::{Pose, Vec3};

/// Something that joins two bodies beside joints and contact.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Mechanism {
    /// Unique name, also of its channels (`mechanism.name.…`).
    #[schemars(extend("x-name" = true))]
    pub name: String,
    /// One side: where a latch catches, and whose z axis points out to what comes.
    pub a: MechanismSide,
    /// The other side: what is caught.
    pub b: MechanismSide,
    /// What it is.
    #[serde(flatten)]
    pub kind: MechanismKind,
}

/// A frame that a mechanism holds on to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-at-most-one" = [["rpy_deg", "quaternion_wxyz"]]))]
pub struct MechanismSide {
    /// What it is fixed to: a `vehicle/link`, or "world".
    #[schemars(extend("x-refers" = "vehicle/part"))]
    pub on: String,
    /// Origin of the frame in the link (in W for "world"), m.
    #[serde(default)]
    pub position_m: [f64; 3],
    /// Roll, pitch and yaw of the frame about the link's x, y and z axes, in that order, deg.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rpy_deg: Option<[f64; 3]>,
    /// Unit quaternion, scalar first; instead of `rpy_deg`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit-quaternion" = true))]
    pub quaternion_wxyz: Option<[f64; 4]>,
}

impl MechanismSide {
    /// The frame in the link.
    pub fn pose(&self) -> Pose {
        let attitude = attitude(self.rpy_deg.as_ref(), self.quaternion_wxyz.as_ref());
        Pose::from_parts(Vec3::from(self.position_m).into(), attitude)
    }
}

/// What a mechanism is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum MechanismKind {
    /// A spring and damper along the line of the two origins, with end stops.
    Strut(Strut),
    /// A spring and damper in all six directions, at rest where both frames coincide.
    Bushing(Hold),
    /// A hold that engages where its conditions are met, lets go by load or command.
    Latch(Latch),
    /// A hold from the start, at rest as the bodies stand at t = 0.
    Weld(Weld),
}

/// T = k (l − l₀) + T₀ + c l̇, positive pulling; beyond the stroke a stop pushes k_s δ (1 + d δ̇) ≥ 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("dependentRequired" = {
    "stroke_m": ["stop_stiffness_n_per_m"],
    "stop_stiffness_n_per_m": ["stroke_m"],
    "stop_dissipation_s_per_m": ["stroke_m"],
}))]
pub struct Strut {
    /// Length at rest l₀, m; the length at t = 0 where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub rest_length_m: Option<f64>,
    /// Stiffness k, N/m.
    #[schemars(range(min = 0.0))]
    pub stiffness_n_per_m: f64,
    /// Damping c, N·s/m.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub damping_n_s_per_m: f64,
    /// Tension T₀ at rest length, N; negative pushes.
    #[serde(default)]
    pub preload_n: f64,
    /// Directions in which spring and damper act; stops always do.
    #[serde(default)]
    pub acts: StrutSides,
    /// Lengths at which the stops begin, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-ascending" = true, "items" = { "type": "number", "minimum": 0.0 }))]
    pub stroke_m: Option<[f64; 2]>,
    /// Stiffness of the stops k_s, N/m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub stop_stiffness_n_per_m: Option<f64>,
    /// Dissipation of the stops d, s/m; zero where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub stop_dissipation_s_per_m: Option<f64>,
}

/// In which directions a strut acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum StrutSides {
    /// Pulls and pushes.
    #[default]
    Both,
    /// A cable.
    PullOnly,
    /// A bumper.
    PushOnly,
}

/// A number for all three axes, or one for each.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum PerAxis {
    /// The same along (or about) all three.
    Same(#[schemars(range(min = 0.0))] f64),
    /// Along (or about) x, y and z.
    Each(#[schemars(inner(range(min = 0.0)))] [f64; 3]),
}

impl Default for PerAxis {
    fn default() -> Self {
        Self::Same(0.0)
    }
}

impl PerAxis {
    /// As a vector.
    pub fn vector(&self) -> Vec3 {
        match *self {
            Self::Same(x) => Vec3::repeat(x),
            Self::Each(each) => Vec3::from(each),
        }
    }
}

/// Six springs and dampers, in the mean of both frames' axes.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hold {
    /// Stiffness along x, y, z, N/m: one number, or three.
    pub stiffness_n_per_m: PerAxis,
    /// Damping along x, y, z, N·s/m.
    #[serde(default)]
    pub damping_n_s_per_m: PerAxis,
    /// Stiffness about x, y, z, N·m/rad.
    #[serde(default)]
    pub torsional_stiffness_n_m_per_rad: PerAxis,
    /// Damping about x, y, z, N·m·s/rad.
    #[serde(default)]
    pub torsional_damping_n_m_s_per_rad: PerAxis,
}

/// Conditions of capture, hold, load and pull-in of a latch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("dependentRequired" = {
    "pull_in_m_per_s": ["pull_in_deg_per_s"],
    "pull_in_deg_per_s": ["pull_in_m_per_s"],
}))]
pub struct Latch {
    /// When it engages.
    pub capture: Capture,
    /// How it holds.
    pub hold: Hold,
    /// Largest force that it holds, N; any where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub hold_force_n: Option<f64>,
    /// Largest moment that it holds, N·m; any where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub hold_moment_n_m: Option<f64>,
    /// What it does beyond its load.
    #[serde(default)]
    pub overload: Overload,
    /// Speed at which b is drawn onto a after engagement, m/s; held as caught where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub pull_in_m_per_s: Option<f64>,
    /// Rate at which b is turned onto a after engagement, deg/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub pull_in_deg_per_s: Option<f64>,
    /// Whether it holds at t = 0 already, at rest as the bodies stand.
    #[serde(default)]
    pub engaged: bool,
}

/// What an overloaded latch does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Overload {
    /// It opens and can be used again.
    #[default]
    LetsGo,
    /// It is gone.
    Breaks,
}

/// Where and how b must stand against a for a latch to engage.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Capture {
    /// Bounds of b's origin along a's z axis, m.
    #[schemars(extend("x-ascending" = true))]
    pub axial_m: [f64; 2],
    /// Largest distance of b's origin from a's z axis, m.
    #[schemars(range(min = 0.0))]
    pub lateral_m: f64,
    /// Largest angle between the two z axes, deg.
    #[schemars(range(min = 0.0, max = 180.0))]
    pub tilt_deg: f64,
    /// Largest rotation about them, deg; any where absent.
    #[serde(default = "any_roll")]
    #[schemars(range(min = 0.0, max = 180.0))]
    pub roll_deg: f64,
    /// Bounds of the closing speed along a's z axis, m/s; any where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-ascending" = true))]
    pub closing_speed_m_per_s: Option<[f64; 2]>,
    /// Time for which all this must last, s.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub dwell_s: f64,
}

/// Half a turn either way.
fn any_roll() -> f64 {
    180.0
}

/// A compliant weld, by its springs or by the frequency on which its bodies would swing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend(
    "x-exactly-one" = [["hold", "frequency_hz"]],
    "dependentRequired" = { "damping_ratio": ["frequency_hz"] },
))]
pub struct Weld {
    /// How it holds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hold: Option<Hold>,
    /// Frequency of the two vehicles on it, were they balls about its point, Hz; gives all stiffnesses.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub frequency_hz: Option<f64>,
    /// Damping ratio of that motion; 0.05 where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub damping_ratio: Option<f64>,
    /// Force at which it breaks, N; never where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub break_force_n: Option<f64>,
    /// Moment at which it breaks, N·m; never where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub break_moment_n_m: Option<f64>,
}
