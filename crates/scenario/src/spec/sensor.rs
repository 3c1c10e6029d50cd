//! Sensors: what is measured, where, how often, and with which errors.
//!
//! reading(t) = true value(t − delay) + bias + white noise of the given standard deviation, drawn at each sample.
//!
//! A run reads them so, and `softdock run --record` writes what they read as a rig would. What a rig has recorded has its own
//! instants and noise: a diagnosis takes place, frame, part and delay from here, and the rest from the recording.

use super::pose::PoseSpec;
use super::vehicle::world;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A sensor, read by its name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Sensor {
    /// Unique name; channels and places (`sensor:name`) use it.
    #[schemars(extend("x-name" = true))]
    pub name: String,
    /// Samples per second.
    #[serde(default = "default_rate")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub rate_hz: f64,
    /// Age of a reading when it arrives, s.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub delay_s: f64,
    /// Share of the readings that never arrive.
    #[serde(default)]
    #[schemars(range(min = 0.0), extend("exclusiveMaximum" = 1.0))]
    pub dropout: f64,
    /// What it measures, and its errors.
    #[serde(flatten)]
    pub kind: SensorKind,
}

/// Sampling rate of a sensor that says none, Hz.
fn default_rate() -> f64 {
    100.0
}

/// What a sensor measures, and its errors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum SensorKind {
    /// Position of a joint, or of several: `joint.<joint>.position`, on the motor's side of a gear that yields.
    JointEncoder {
        /// The joint as `vehicle/joint`, or a glob.
        #[schemars(extend("x-refers" = "pattern"))]
        joint: String,
        /// Noise of an angle, standard deviation, deg.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        noise_deg: f64,
        /// Noise of a displacement, standard deviation, m.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        noise_m: f64,
        /// Step of the encoder's scale, deg; zero for a continuous one.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        resolution_deg: f64,
        /// Step of a linear encoder's scale, m; zero for a continuous one.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        resolution_m: f64,
        /// Added to the angle, deg.
        #[serde(default)]
        bias_deg: f64,
        /// Added to the displacement, m.
        #[serde(default)]
        bias_m: f64,
    },
    /// Rate of a joint, or of several: `joint.<joint>.velocity`, on the same side.
    Tachometer {
        /// The joint as `vehicle/joint`, or a glob.
        #[schemars(extend("x-refers" = "pattern"))]
        joint: String,
        /// Noise of an angular rate, standard deviation, rad/s.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        noise_rad_per_s: f64,
        /// Noise of a speed, standard deviation, m/s.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        noise_m_per_s: f64,
    },
    /// Angular velocity and specific force of a link, in the sensor's axes: `sensor.<name>.angular_velocity` and `.specific_force`.
    ///
    /// Specific force is acceleration less that of free fall: what an accelerometer feels. A walk is a bias that drifts as the integral of white noise.
    Imu {
        /// Link it is fixed to, as `vehicle/link`.
        #[schemars(extend("x-refers" = "vehicle/part"))]
        link: String,
        /// Pose of the sensor in the link.
        #[serde(default)]
        pose: PoseSpec,
        /// Noise of the gyro, standard deviation, rad/s.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        gyro_noise_rad_per_s: f64,
        /// Added to the gyro's reading, rad/s.
        #[serde(default)]
        gyro_bias_rad_per_s: [f64; 3],
        /// Walk of the gyro's bias: standard deviation after one second, rad/s per √s.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        gyro_walk_rad_per_s_sqrt_s: f64,
        /// Largest rate that the gyro shows on an axis, rad/s; without it there is none.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        gyro_limit_rad_per_s: Option<f64>,
        /// Noise of the accelerometer, standard deviation, m/s².
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        accelerometer_noise_m_per_s2: f64,
        /// Added to the accelerometer's reading, m/s².
        #[serde(default)]
        accelerometer_bias_m_per_s2: [f64; 3],
        /// Walk of the accelerometer's bias: standard deviation after one second, m/s² per √s.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        accelerometer_walk_m_per_s2_sqrt_s: f64,
        /// Largest specific force that it shows on an axis, m/s²; without it there is none.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        accelerometer_limit_m_per_s2: Option<f64>,
    },
    /// Pose of a link, as a camera or a motion-capture system gives it.
    ///
    /// Seen from the world it is the body's own: `body.<link>.position`, `.orientation`. Seen from a link it is `sensor.<name>.position` and `.orientation`,
    /// in the axes of the camera, which looks along its z.
    Pose {
        /// Link that is observed, as `vehicle/link`.
        #[schemars(extend("x-refers" = "vehicle/part"))]
        link: String,
        /// What it is observed from: "world" or a `vehicle/link`.
        #[serde(default = "world")]
        #[schemars(extend("x-refers" = "vehicle/part"))]
        relative_to: String,
        /// Pose of the camera in the link that it is fixed to; none of its own in the world.
        #[serde(default)]
        pose: PoseSpec,
        /// Noise of the position, standard deviation on each axis, m.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        position_noise_m: f64,
        /// Added to the position, m.
        #[serde(default)]
        position_bias_m: [f64; 3],
        /// Noise of the attitude, standard deviation about each axis, deg.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        attitude_noise_deg: f64,
        /// Farthest that the camera sees, m; without it as far as it likes.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        range_m: Option<f64>,
        /// Full angle of the cone about the camera's z in which it sees, deg; without it all around.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        field_of_view_deg: Option<f64>,
    },
    /// Force and moment that pass through a joint (fixed ones too), on the child, in the child link's axes.
    ForceTorque {
        /// The joint, as `vehicle/joint`.
        #[schemars(extend("x-refers" = "vehicle/part"))]
        joint: String,
        /// Noise of the force, standard deviation on each axis, N.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        force_noise_n: f64,
        /// Added to the force, N.
        #[serde(default)]
        force_bias_n: [f64; 3],
        /// Noise of the moment, standard deviation about each axis, N·m.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        torque_noise_n_m: f64,
        /// Added to the moment, N·m.
        #[serde(default)]
        torque_bias_n_m: [f64; 3],
    },
    /// Contact force on a part and its moment about the sensor, in the sensor's axes; what is beyond it weighs nothing.
    ContactForce {
        /// The shape that is touched, or the link of which all shapes count, as `vehicle/name`.
        #[schemars(extend("x-refers" = "vehicle/part"))]
        part: String,
        /// Link that carries the sensor, as `vehicle/link`.
        #[schemars(extend("x-refers" = "vehicle/part"))]
        link: String,
        /// Pose of the sensor in the link.
        #[serde(default)]
        pose: PoseSpec,
        /// Noise of the force, standard deviation on each axis, N.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        force_noise_n: f64,
        /// Noise of the moment, standard deviation about each axis, N·m.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        torque_noise_n_m: f64,
    },
    /// What a mechanism does to one of its sides, W axes; the moment is about the point where it acts.
    MechanismForce {
        /// The mechanism.
        #[schemars(extend("x-refers" = "mechanism"))]
        mechanism: String,
        /// The side that feels the force.
        #[serde(default)]
        on: MechanismEnd,
        /// Noise of the force, standard deviation on each axis, N.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        force_noise_n: f64,
        /// Noise of the moment, standard deviation about each axis, N·m.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        torque_noise_n_m: f64,
    },
}

impl SensorKind {
    /// Its name in a file.
    pub fn text(&self) -> &'static str {
        match self {
            Self::JointEncoder { .. } => "joint-encoder",
            Self::Tachometer { .. } => "tachometer",
            Self::Imu { .. } => "imu",
            Self::Pose { .. } => "pose",
            Self::ForceTorque { .. } => "force-torque",
            Self::ContactForce { .. } => "contact-force",
            Self::MechanismForce { .. } => "mechanism-force",
        }
    }
}

/// A side of a mechanism.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MechanismEnd {
    /// Its side a.
    A,
    /// Its side b.
    #[default]
    B,
}
