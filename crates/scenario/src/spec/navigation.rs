//! Navigation: what a strategy knows of where things are.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What strategies that steer by where things are know of them: the truth, or what sensors say.
///
/// Through sensors they know the joints of the own vehicle (the one that carries the camera) by encoders, its base by gyro and conservation of momentum from
/// the start on, the target by the camera, forces by sensors of contact, and of mechanisms whether they hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Navigation {
    /// The truth: poses, rates and contacts as they are, whatever sensors there are.
    pub perfect: bool,
    /// The camera: a sensor of kind pose on a link of the own vehicle; what it sees is the target.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-refers" = "sensor"))]
    pub camera: Option<String>,
    /// The gyro: a sensor of kind imu on the own vehicle's base. Without one the base turns as conservation of momentum has it.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-refers" = "sensor"))]
    pub gyro: Option<String>,
    /// Whether a filter makes pose and rates of the target out of what the camera says, brought up to the present. Without it the last pose counts as the
    /// present one, and rates are differences of the last two.
    pub filter: bool,
    /// How far the target's velocity may have wandered after one second, standard deviation, m/s per √s.
    #[schemars(range(min = 0.0))]
    pub velocity_walk_m_per_s_sqrt_s: f64,
    /// How far the target's angular velocity may have wandered, likewise, deg/s per √s.
    #[schemars(range(min = 0.0))]
    pub rate_walk_deg_per_s_sqrt_s: f64,
    /// Standard deviation of the target's angular velocity from which on it counts as made out, deg/s.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub ready_deg_per_s: f64,
}

impl Default for Navigation {
    fn default() -> Self {
        Self {
            perfect: false,
            camera: None,
            gyro: None,
            filter: true,
            velocity_walk_m_per_s_sqrt_s: 1e-4,
            rate_walk_deg_per_s_sqrt_s: 0.002,
            ready_deg_per_s: 0.15,
        }
    }
}

impl Navigation {
    /// Whether a file would say nothing of it.
    pub fn is_absent(&self) -> bool {
        *self == Self::default()
    }
}
