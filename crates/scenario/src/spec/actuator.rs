//! Actuators, which commands move, and drives, which move by themselves.

use super::pose::PoseSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use spatial::Vec3;
use std::collections::BTreeMap;

/// A motor, thruster or wheel, commanded by its name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Actuator {
    /// Unique name; commands and places (`actuator:name`) use it.
    #[schemars(extend("x-name" = true))]
    pub name: String,
    /// What it is and where it acts.
    #[serde(flatten)]
    pub kind: ActuatorKind,
}

/// What an actuator is and where it acts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum ActuatorKind {
    /// The command is the joint's torque, N·m, or force, N; at its speed limit it no longer pushes.
    #[schemars(extend("x-at-most-one" = [["limit_n_m", "limit_n"], ["speed_limit_rad_per_s", "speed_limit_m_per_s"],
        ["reflected_inertia_kg_m2", "reflected_mass_kg"]]))]
    JointTorque {
        /// The joint, as `vehicle/joint`.
        #[schemars(extend("x-refers" = "vehicle/part"))]
        joint: String,
        /// Largest torque, N·m; the URDF's effort limit where absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        limit_n_m: Option<f64>,
        /// Largest force of a prismatic joint, N; the URDF's effort limit where absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        limit_n: Option<f64>,
        /// Speed at which it stops pushing, in that direction, rad/s; the URDF's velocity limit where absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        speed_limit_rad_per_s: Option<f64>,
        /// The same of a prismatic joint, m/s.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        speed_limit_m_per_s: Option<f64>,
        /// Rotor inertia as the joint feels it, kg·m²; gyroscopic terms neglected, no part of the vehicle's momentum.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        reflected_inertia_kg_m2: Option<f64>,
        /// The same of a prismatic joint, kg.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        reflected_mass_kg: Option<f64>,
    },
    /// A position and rate loop: τ = k (q_cmd − q) + d (q̇_cmd − q̇), within the limit; at its speed limit it no longer
    /// pushes.
    JointDrive(JointDrive),
    /// The command is the thrust, N, between zero and `max_force_n`.
    Thruster {
        /// Link it is fixed to, as `vehicle/link`.
        #[schemars(extend("x-refers" = "vehicle/part"))]
        link: String,
        /// Where it acts, in link axes, m.
        position_m: [f64; 3],
        /// Direction of the force on the vehicle (against the plume), in link axes; need not be a unit vector.
        #[schemars(extend("x-nonzero" = true))]
        direction: [f64; 3],
        /// Largest thrust, N.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        max_force_n: f64,
    },
    /// The command is the motor's torque on the wheel, N·m; the vehicle feels its opposite.
    ReactionWheel {
        /// Link it is fixed to, as `vehicle/link`.
        #[schemars(extend("x-refers" = "vehicle/part"))]
        link: String,
        /// Spin axis in link axes; need not be a unit vector.
        #[schemars(extend("x-nonzero" = true))]
        axis: [f64; 3],
        /// Inertia of the rotor about its axis, kg·m².
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        inertia_kg_m2: f64,
        /// Largest torque of the motor, N·m.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        torque_limit_n_m: f64,
        /// Speed relative to the link at which the motor stops pushing, in that direction, rad/s; it still brakes.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        speed_limit_rad_per_s: f64,
        /// Speed of the rotor relative to the link at t = 0, rad/s.
        #[serde(default)]
        speed_rad_per_s: f64,
    },
    /// The command opens a latch while it is above one half, and makes it ready again below.
    LatchRelease {
        /// The latch, a `[[mechanism]]` by name.
        #[schemars(extend("x-refers" = "mechanism"))]
        latch: String,
    },
}

/// A position and rate loop on one joint or on several with the same gains.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend(
    "x-exactly-one" = [["joint", "joints"], ["stiffness_n_m_per_rad", "stiffness_n_per_m"]],
    "x-at-most-one" = [["damping_n_m_s_per_rad", "damping_n_s_per_m"], ["limit_n_m", "limit_n"],
        ["speed_limit_rad_per_s", "speed_limit_m_per_s"], ["reflected_inertia_kg_m2", "reflected_mass_kg"]],
))]
pub struct JointDrive {
    /// The joint, as `vehicle/joint`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-refers" = "vehicle/part"))]
    pub joint: Option<String>,
    /// Several joints, as `vehicle/joint` or globs; one drive each, named `name/joint`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(min = 1), extend("x-refers" = "pattern"))]
    pub joints: Vec<String>,
    /// Stiffness of revolute joints, N·m/rad; zero for a pure rate loop.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub stiffness_n_m_per_rad: Option<f64>,
    /// Stiffness of prismatic joints, N/m; zero for a pure rate loop.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub stiffness_n_per_m: Option<f64>,
    /// Damping of revolute joints, N·m·s/rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub damping_n_m_s_per_rad: Option<f64>,
    /// Damping of prismatic joints, N·s/m.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub damping_n_s_per_m: Option<f64>,
    /// Largest torque, N·m; the URDF's effort limit where absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub limit_n_m: Option<f64>,
    /// Largest force of prismatic joints, N; the URDF's effort limit where absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub limit_n: Option<f64>,
    /// Speed at which it stops pushing, in that direction, rad/s; the URDF's velocity limit where absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub speed_limit_rad_per_s: Option<f64>,
    /// The same of prismatic joints, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub speed_limit_m_per_s: Option<f64>,
    /// Rotor inertia as each joint feels it, kg·m²; gyroscopic terms neglected, no part of the vehicle's momentum.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub reflected_inertia_kg_m2: Option<f64>,
    /// The same of prismatic joints, kg.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub reflected_mass_kg: Option<f64>,
}

impl JointDrive {
    /// The joints or patterns it names.
    pub fn joint_patterns(&self) -> impl Iterator<Item = &str> {
        self.joint.iter().chain(&self.joints).map(String::as_str)
    }

    /// Stiffness, N·m/rad or N/m.
    pub fn stiffness(&self) -> f64 {
        self.stiffness_n_m_per_rad.or(self.stiffness_n_per_m).unwrap_or(0.0)
    }

    /// Damping, N·m·s/rad or N·s/m.
    pub fn damping(&self) -> f64 {
        self.damping_n_m_s_per_rad.or(self.damping_n_s_per_m).unwrap_or(0.0)
    }

    /// Largest effort, N·m or N, where the file gives one.
    pub fn limit(&self) -> Option<f64> {
        self.limit_n_m.or(self.limit_n)
    }

    /// Whether its gains are those of prismatic joints.
    pub fn is_linear(&self) -> bool {
        self.stiffness_n_per_m.is_some()
    }
}

/// A unit vector along a direction that the file gives by any length; x̂ for zero, which the check refuses.
pub(super) fn unit(direction: &[f64; 3]) -> Vec3 {
    Vec3::from(*direction).try_normalize(0.0).unwrap_or_else(Vec3::x)
}

impl ActuatorKind {
    /// The joints or patterns that it drives.
    pub fn joint_patterns(&self) -> impl Iterator<Item = &str> {
        let (own, many) = match self {
            Self::JointTorque { joint, .. } => (Some(joint), None),
            Self::JointDrive(drive) => (None, Some(drive)),
            Self::Thruster { .. } | Self::ReactionWheel { .. } | Self::LatchRelease { .. } => (None, None),
        };
        own.map(String::as_str).into_iter().chain(many.into_iter().flat_map(JointDrive::joint_patterns))
    }

    /// Speed at which it stops pushing where the file gives one, rad/s or m/s, and whether it is that of a sliding joint.
    pub fn joint_speed_limit(&self) -> Option<(f64, bool)> {
        let (turning, sliding) = match self {
            Self::JointTorque { speed_limit_rad_per_s, speed_limit_m_per_s, .. } => {
                (*speed_limit_rad_per_s, *speed_limit_m_per_s)
            }
            Self::JointDrive(drive) => (drive.speed_limit_rad_per_s, drive.speed_limit_m_per_s),
            Self::Thruster { .. } | Self::ReactionWheel { .. } | Self::LatchRelease { .. } => (None, None),
        };
        turning.map(|l| (l, false)).or(sliding.map(|l| (l, true)))
    }

    /// The key of the same for turning or sliding joints; none of an actuator that drives no joint.
    pub(crate) fn joint_speed_limit_mut(&mut self, slides: bool) -> Option<&mut Option<f64>> {
        let [turning, sliding] = match self {
            Self::JointTorque { speed_limit_rad_per_s, speed_limit_m_per_s, .. } => {
                [speed_limit_rad_per_s, speed_limit_m_per_s]
            }
            Self::JointDrive(drive) => [&mut drive.speed_limit_rad_per_s, &mut drive.speed_limit_m_per_s],
            Self::Thruster { .. } | Self::ReactionWheel { .. } | Self::LatchRelease { .. } => return None,
        };
        Some(if slides { sliding } else { turning })
    }

    /// The key of what it delivers at most to turning or sliding joints; none of an actuator that drives no joint.
    pub(crate) fn joint_effort_limit_mut(&mut self, slides: bool) -> Option<&mut Option<f64>> {
        let [turning, sliding] = match self {
            Self::JointTorque { limit_n_m, limit_n, .. } => [limit_n_m, limit_n],
            Self::JointDrive(drive) => [&mut drive.limit_n_m, &mut drive.limit_n],
            Self::Thruster { .. } | Self::ReactionWheel { .. } | Self::LatchRelease { .. } => return None,
        };
        Some(if slides { sliding } else { turning })
    }

    /// Rotor inertia (kg·m²) or mass (kg) as its joints feel it, and whether it is a mass.
    pub fn reflected_inertia(&self) -> Option<(f64, bool)> {
        let (inertia, mass) = match self {
            Self::JointTorque { reflected_inertia_kg_m2, reflected_mass_kg, .. } => {
                (*reflected_inertia_kg_m2, *reflected_mass_kg)
            }
            Self::JointDrive(drive) => (drive.reflected_inertia_kg_m2, drive.reflected_mass_kg),
            Self::Thruster { .. } | Self::ReactionWheel { .. } | Self::LatchRelease { .. } => (None, None),
        };
        inertia.map(|i| (i, false)).or(mass.map(|m| (m, true)))
    }

    /// Unit vector of a thruster's force or a wheel's axis, in link axes.
    pub fn axis(&self) -> Option<Vec3> {
        match self {
            Self::Thruster { direction: along, .. } | Self::ReactionWheel { axis: along, .. } => Some(unit(along)),
            Self::JointTorque { .. } | Self::JointDrive(_) | Self::LatchRelease { .. } => None,
        }
    }
}

/// A prescribed motion: the joint, or the base, is where the formula says, whatever the forces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("x-exactly-one" = [["joint", "vehicle"]]))]
pub struct Drive {
    /// Unique name.
    #[schemars(extend("x-name" = true))]
    pub name: String,
    /// The driven joint, as `vehicle/joint`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-refers" = "vehicle/part"))]
    pub joint: Option<String>,
    /// The vehicle whose base is driven: along the z axis of `pose` by a displacement, about it by an angle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-refers" = "vehicle"))]
    pub vehicle: Option<String>,
    /// Frame of a driven base's motion, in W; identity where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pose: Option<PoseSpec>,
    /// The motion.
    #[serde(flatten)]
    pub motion: DriveMotion,
}

/// A motion as a function of time; keys in deg are angles, in m displacements.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum DriveMotion {
    /// A · sin(2π f t + φ).
    #[schemars(extend("x-exactly-one" = [["amplitude_deg", "amplitude_m"]]))]
    Sine {
        /// Amplitude of an angle, deg.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        amplitude_deg: Option<f64>,
        /// Amplitude of a displacement, m.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        amplitude_m: Option<f64>,
        /// Frequency f, Hz.
        #[schemars(range(min = 0.0))]
        frequency_hz: f64,
        /// Phase φ, deg.
        #[serde(default)]
        phase_deg: f64,
    },
    /// Constant rate from t = 0.
    #[schemars(extend("x-exactly-one" = [["velocity_deg_per_s", "velocity_m_per_s"]]))]
    Ramp {
        /// Rate of an angle, deg/s.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        velocity_deg_per_s: Option<f64>,
        /// Rate of a displacement, m/s.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        velocity_m_per_s: Option<f64>,
    },
    /// The cubic spline through points, [t in s, value], at rest at both ends.
    #[schemars(extend("x-exactly-one" = [["points_s_deg", "points_s_m", "points_s_xyz_m"]]))]
    Points {
        /// Points of an angle, [s, deg].
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        #[schemars(length(min = 1), extend("x-ascending" = true))]
        points_s_deg: Vec<[f64; 2]>,
        /// Points of a displacement, [s, m].
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        #[schemars(length(min = 1), extend("x-ascending" = true))]
        points_s_m: Vec<[f64; 2]>,
        /// Points of a displacement along x, y and z of `pose`, [s, m, m, m].
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        #[schemars(length(min = 1), extend("x-ascending" = true))]
        points_s_xyz_m: Vec<[f64; 4]>,
    },
    /// As channels of a recording moved, smoothed by what their noise allows.
    #[schemars(extend("x-exactly-one" = [["channel", "channels"]]))]
    Recording {
        /// The recording, relative to the scenario file; where absent, that of the strategy `replay` or of a diagnosis.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(length(min = 1))]
        file: Option<String>,
        /// The channel that holds a displacement along z of `pose`, m.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(length(min = 1))]
        channel: Option<String>,
        /// The channels that hold displacements along axes of `pose` ("x", "y", "z", m) and about its z ("yaw", rad).
        #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
        #[schemars(schema_with = "describe_axes")]
        channels: BTreeMap<DriveAxis, String>,
        /// Standard deviation of a sample, m or rad; estimated where absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        noise: Option<f64>,
    },
}

/// A coordinate of a driven base, in the axes of the drive's `pose`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DriveAxis {
    /// Along x.
    X,
    /// Along y.
    Y,
    /// Along z.
    Z,
    /// About z.
    Yaw,
}

/// A map from axes as a closed table: schemars takes an enum with described variants for any string.
fn describe_axes(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
    let channel = |what: &str| serde_json::json!({ "type": "string", "description": format!("The channel {what}.") });
    schemars::json_schema!({
        "type": "object",
        "additionalProperties": false,
        "properties": {
            "x": channel("along x, m"),
            "y": channel("along y, m"),
            "z": channel("along z, m"),
            "yaw": channel("about z, rad"),
        },
    })
}
