//! How well the nominal numbers are known.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Standard deviations of nominal numbers, for a diagnosis: within three of them it may correct a number without calling that a finding. What is not
/// named is exact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Tolerance {
    /// Of the mass of every link and base, as a share of it.
    #[schemars(range(min = 0.0))]
    #[serde(skip_serializing_if = "is_zero")]
    pub mass: f64,
    /// Of the centre of mass of every link and base, along each axis.
    #[schemars(range(min = 0.0))]
    #[serde(skip_serializing_if = "is_zero")]
    pub com_m: f64,
    /// Of each entry of the inertia of every link and base, as a share of the mean of its principal moments.
    #[schemars(range(min = 0.0))]
    #[serde(skip_serializing_if = "is_zero")]
    pub inertia: f64,
    /// Of what actuators deliver, as a share of what they are commanded.
    #[schemars(range(min = 0.0))]
    #[serde(skip_serializing_if = "is_zero")]
    pub gain: f64,
    /// Of the normal stiffness of contacts, as a share.
    #[schemars(range(min = 0.0))]
    #[serde(skip_serializing_if = "is_zero")]
    pub contact_stiffness: f64,
    /// Of the normal damping of contacts, as a share.
    #[schemars(range(min = 0.0))]
    #[serde(skip_serializing_if = "is_zero")]
    pub contact_damping: f64,
    /// Of the friction coefficients of contacts, as a share.
    #[schemars(range(min = 0.0))]
    #[serde(skip_serializing_if = "is_zero")]
    pub friction: f64,
    /// Of how sensors of vectors and orientations are mounted, about each axis.
    #[schemars(range(min = 0.0))]
    #[serde(skip_serializing_if = "is_zero")]
    pub mount_deg: f64,
    /// Of the clocks of sensors: readings that are so much older or younger.
    #[schemars(range(min = 0.0))]
    #[serde(skip_serializing_if = "is_zero")]
    pub clock_s: f64,
}

impl Tolerance {
    /// Every nominal number is exact.
    pub const EXACT: Self = Self {
        mass: 0.0,
        com_m: 0.0,
        inertia: 0.0,
        gain: 0.0,
        contact_stiffness: 0.0,
        contact_damping: 0.0,
        friction: 0.0,
        mount_deg: 0.0,
        clock_s: 0.0,
    };

    /// Whether every nominal number is exact.
    pub fn is_exact(&self) -> bool {
        *self == Self::EXACT
    }
}

impl Default for Tolerance {
    fn default() -> Self {
        Self::EXACT
    }
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde hands a reference")]
fn is_zero(x: &f64) -> bool {
    *x == 0.0
}
