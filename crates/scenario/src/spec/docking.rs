//! Docking: how the visitor starts in front of a port, what counts as captured, and what must not touch.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Start of a vehicle in front of a port, in the terms of a docking standard's contact conditions. Takes the place of `pose` and
/// `twist`.
///
/// Both interface frames have z pointing out of their own side; nominal is z against z, x along x. Misalignments and rates are
/// those of this vehicle's frame as seen from the port's, in the port's axes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Approach {
    /// Interface frame of this vehicle: one of its links.
    #[schemars(length(min = 1))]
    pub frame: String,
    /// Interface frame that it comes to, as `vehicle/link`; that vehicle stands above this one in the file.
    #[schemars(extend("x-refers" = "vehicle/part"))]
    pub port: String,
    /// Distance of the two origins along the port's z, m.
    pub distance_m: f64,
    /// Whether it starts nearer: moved in along the port's z to where the first shapes are about to touch, so that what stands
    /// here are the conditions at contact. A vehicle that would touch nothing stays at `distance_m`.
    #[serde(default)]
    pub at_contact: bool,
    /// Lateral misalignment along the port's x and y, m.
    #[serde(default)]
    pub lateral_m: [f64; 2],
    /// Pitch and yaw misalignment: rotation vector about the port's x and y, deg.
    #[serde(default)]
    #[schemars(inner(range(min = -180.0, max = 180.0)))]
    pub tilt_deg: [f64; 2],
    /// Roll misalignment about the port's z, deg.
    #[serde(default)]
    #[schemars(range(min = -180.0, max = 180.0))]
    pub roll_deg: f64,
    /// Closing speed against the port's z, m/s.
    #[serde(default)]
    pub closing_m_per_s: f64,
    /// Lateral rate along the port's x and y, m/s.
    #[serde(default)]
    pub lateral_m_per_s: [f64; 2],
    /// Pitch and yaw rate about the port's x and y, deg/s.
    #[serde(default)]
    pub tilt_deg_per_s: [f64; 2],
    /// Roll rate about the port's z, deg/s.
    #[serde(default)]
    pub roll_deg_per_s: f64,
}

/// What counts as docked, and what as lost.
///
/// Outcomes: `captured`; `missed` (never touched), `bounced` (touched and left), `jammed` (touches and moves no more), `overload`,
/// `released` (captured, and lost again), `time-out`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Docking {
    /// Interface frame of what comes, as `vehicle/link`; z out of it.
    #[schemars(extend("x-refers" = "vehicle/part"))]
    pub visitor: String,
    /// Interface frame of the port, as `vehicle/link`; z out of it.
    #[schemars(extend("x-refers" = "vehicle/part"))]
    pub port: String,
    /// Latches that must all hold for a capture, by name.
    #[schemars(length(min = 1), extend("x-refers" = "mechanism"))]
    pub capture: Vec<String>,
    /// Latches that hold at the end of a hard dock, by name; none where capture is all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("x-refers" = "mechanism"))]
    pub hard_dock: Vec<String>,
    /// Resultant force between the two sides, latches included, above which the interface is damaged, N; any where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub overload_n: Option<f64>,
    /// Distance of the two frames beyond which one that moves away is lost, m.
    #[serde(default = "default_lost_distance")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub lost_distance_m: f64,
    /// Speed between the two frames below which the motion counts as at rest, m/s.
    #[serde(default = "default_rest_speed")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub rest_m_per_s: f64,
    /// Angular rate between the two frames below which the motion counts as at rest, deg/s.
    #[serde(default = "default_rest_rate")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub rest_deg_per_s: f64,
    /// How long it must be at rest for the run to end before its time, s; also how long contact at rest without a capture is a jam.
    #[serde(default = "default_rest_time")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub rest_s: f64,
}

/// Distance at which one that moves away is lost, m.
fn default_lost_distance() -> f64 {
    0.5
}

/// Speed at rest, m/s.
fn default_rest_speed() -> f64 {
    1e-3
}

/// Rate at rest, deg/s.
fn default_rest_rate() -> f64 {
    0.02
}

/// Time at rest, s.
fn default_rest_time() -> f64 {
    2.0
}

/// Shapes that must not come near each other; contact between them is a finding.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KeepOut {
    /// The two sides: shapes or links as `vehicle/name`, globs allowed.
    #[schemars(extend("x-refers" = "pattern"))]
    pub between: [String; 2],
}
