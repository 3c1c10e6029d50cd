//! Strategies: who decides the commands of the actuators.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Guidance and control.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Strategy {
    /// No commands; joint drives hold their initial positions.
    #[default]
    None,
    /// Predicts the grapple point, approaches, matches its motion, closes the gripper, damps the rest.
    TrackAndGrasp(TrackAndGrasp),
    /// Commands as functions of time.
    Schedule(Schedule),
    /// Recorded commands.
    Replay(Replay),
    /// Waits for a soft capture to come to rest, then lets a further latch draw the vehicles together.
    SoftDock(SoftDock),
}

/// Capture of a tumbling target by an arm on a free-flying base.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrackAndGrasp {
    /// Vehicle that captures.
    #[schemars(extend("x-refers" = "vehicle"))]
    pub servicer: String,
    /// Vehicle that is captured.
    #[schemars(extend("x-refers" = "vehicle"))]
    pub target: String,
    /// Frame between the fingers, as `vehicle/link`: z towards the target, y along the closing direction.
    #[schemars(extend("x-refers" = "vehicle/part"))]
    pub tool_frame: String,
    /// Frame that `tool_frame` shall coincide with in the grasp, as `vehicle/link`.
    #[schemars(extend("x-refers" = "vehicle/part"))]
    pub grapple_frame: String,
    /// Joints that close the gripper: their names in the servicer, or one.
    pub gripper: OneOrMany,
    /// Error of the assumed grapple point, in its own frame, m.
    #[serde(default)]
    pub grapple_offset_m: [f64; 3],
    /// Distance, back along the tool's z axis, at which the motion is matched before the final approach, m.
    #[serde(default = "default_standoff")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub standoff_m: f64,
    /// Speed of the final approach, relative to the grapple point, m/s.
    #[serde(default = "default_approach_speed")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub approach_speed_m_per_s: f64,
    /// Whether the target's tumble is predicted over the approach; without it, the tool goes where the point is now.
    #[serde(default = "super::contact::yes")]
    pub prediction: bool,
    /// Whether the tool follows the velocity of the grapple point; without it, it only follows the position.
    #[serde(default = "super::contact::yes")]
    pub rate_matching: bool,
    /// Squeeze of each finger, N.
    #[serde(default = "default_closing_force")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub closing_force_n: f64,
    /// Speed at which each finger closes before it touches, m/s.
    #[serde(default = "default_closing_speed")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub closing_speed_m_per_s: f64,
    /// Distance between tool and grapple frame below which the gripper closes, m.
    #[serde(default = "default_close_distance")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub close_distance_m: f64,
    /// Angle between tool and grapple frame below which the gripper closes, deg.
    #[serde(default = "default_close_angle")]
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 180.0))]
    pub close_angle_deg: f64,
    /// Planned time from the start to the standoff, s.
    #[serde(default = "default_reach_time")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub reach_time_s: f64,
    /// Largest rate of the arm's joints, deg/s; the URDF's limits hold besides.
    #[serde(default = "default_joint_rate")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub max_joint_rate_deg_per_s: f64,
    /// Bandwidth of the tracking loop, 1/s.
    #[serde(default = "default_bandwidth")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub tracking_bandwidth_per_s: f64,
    /// Damping of the generalised Jacobian's inverse near singular poses, dimensionless.
    #[serde(default = "default_jacobian_damping")]
    #[schemars(range(min = 0.0))]
    pub jacobian_damping: f64,
    /// Time constant with which the arm takes the relative motion out after the grasp, s.
    #[serde(default = "default_damping_time")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub damping_time_s: f64,
}

/// Distance of the standoff point, m.
fn default_standoff() -> f64 {
    0.25
}

/// Speed of the last approach, m/s.
fn default_approach_speed() -> f64 {
    0.03
}

/// Squeeze of a finger, N.
fn default_closing_force() -> f64 {
    40.0
}

/// Closing speed of a finger, m/s.
fn default_closing_speed() -> f64 {
    0.02
}

/// Distance at which the gripper closes, m.
fn default_close_distance() -> f64 {
    0.01
}

/// Angle at which the gripper closes, deg.
fn default_close_angle() -> f64 {
    5.0
}

/// Time of the way to the standoff point, s.
fn default_reach_time() -> f64 {
    12.0
}

/// Largest joint rate, deg/s.
fn default_joint_rate() -> f64 {
    20.0
}

/// Bandwidth of the tracking loop, 1/s.
fn default_bandwidth() -> f64 {
    2.0
}

/// Damping of the Jacobian's inverse.
fn default_jacobian_damping() -> f64 {
    0.02
}

/// Time constant of the damping after the grasp, s.
fn default_damping_time() -> f64 {
    3.0
}

/// One name, or a list of them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum OneOrMany {
    /// One name.
    One(#[schemars(length(min = 1))] String),
    /// Several names.
    Many(#[schemars(length(min = 1), inner(length(min = 1)))] Vec<String>),
}

impl OneOrMany {
    /// The names, in the order of the file.
    pub fn names(&self) -> &[String] {
        match self {
            Self::One(name) => std::slice::from_ref(name),
            Self::Many(names) => names,
        }
    }
}

/// Soft capture, attenuation, then retraction to the hard dock.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SoftDock {
    /// Vehicle that comes.
    #[schemars(extend("x-refers" = "vehicle"))]
    pub visitor: String,
    /// Vehicle that it comes to.
    #[schemars(extend("x-refers" = "vehicle"))]
    pub host: String,
    /// Latches that must all hold before the retraction, by name.
    #[schemars(length(min = 1), extend("x-refers" = "mechanism"))]
    pub capture: Vec<String>,
    /// Actuator that keeps the retracting latch open until then (kind latch-release).
    #[schemars(extend("x-refers" = "actuator"))]
    pub retraction: String,
    /// Speed of the visitor's base seen from the host below which it counts as at rest, m/s.
    #[serde(default = "default_settled_speed")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub rest_m_per_s: f64,
    /// Angular rate between the two below which it counts as at rest, deg/s.
    #[serde(default = "default_settled_rate")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub rest_deg_per_s: f64,
    /// How long it must be at rest, s.
    #[serde(default = "default_settle_time")]
    #[schemars(range(min = 0.0))]
    pub settle_s: f64,
}

/// Speed at rest before a retraction, m/s.
fn default_settled_speed() -> f64 {
    5e-3
}

/// Rate at rest before a retraction, deg/s.
fn default_settled_rate() -> f64 {
    0.1
}

/// Time at rest before a retraction, s.
fn default_settle_time() -> f64 {
    2.0
}

/// Commands as functions of time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Schedule {
    /// One course for each commanded actuator.
    pub commands: Vec<Command>,
}

/// The course of one actuator's command.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Command {
    /// The actuator, by name.
    #[schemars(extend("x-refers" = "actuator"))]
    pub actuator: String,
    /// Corners [t in s, value in the command's SI unit] of a piecewise linear course, constant before and after: the position of a
    /// joint-drive, its rate where it has no stiffness, else the effort.
    #[schemars(length(min = 1), extend("x-ascending" = true))]
    pub points: Vec<[f64; 2]>,
}

impl Command {
    /// The command at time `t`, s.
    pub fn value_at(&self, t: f64) -> f64 {
        let after = self.points.partition_point(|[time, _]| *time <= t);
        let (before, next) = (after.checked_sub(1).and_then(|i| self.points.get(i)), self.points.get(after));
        match (before, next) {
            (Some([t0, v0]), Some([t1, v1])) => v0 + (v1 - v0) * (t - t0) / (t1 - t0),
            (Some([_, v]), None) | (None, Some([_, v])) => *v,
            (None, None) => 0.0,
        }
    }
}

/// Recorded commands.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Replay {
    /// The recording, relative to the scenario file.
    #[schemars(length(min = 1))]
    pub file: String,
    /// Which channel commands which actuator: actuator name → channel. Without an entry the channel is
    /// `command.<actuator>`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub mapping: BTreeMap<String, String>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn command_is_linear_between_corners_and_constant_outside() {
        let command = Command { actuator: "a".into(), points: vec![[1.0, 2.0], [3.0, 6.0], [3.0, 0.0]] };
        for (t, value) in [(0.0, 2.0), (1.0, 2.0), (2.0, 4.0), (3.0, 0.0), (9.0, 0.0)] {
            assert_eq!(command.value_at(t), value, "at {t} s");
        }
    }
}
