//! Contact laws, and which pair of shapes has which.
//!
//! `f_n(δ, δ̇)` is the normal force, N, for a penetration δ ≥ 0, m; it is never attractive.

use crate::glob::glob_matches;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The laws of the contact between named shapes or links.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactRule {
    /// The two sides, each a shape or link as `vehicle/name`, or a glob; the order does not matter.
    #[schemars(extend("x-refers" = "pattern"))]
    pub between: [String; 2],
    /// Whether the pair touches at all; `false` also saves the time of looking.
    #[serde(default = "yes")]
    pub enabled: bool,
    /// Normal law; that of `[contact_default]` where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal: Option<NormalLaw>,
    /// Friction law; that of `[contact_default]` where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<FrictionLaw>,
}

/// The laws of one pair: of those that no rule names, or as resolved by [`super::Scenario::contact_law`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ContactLaw {
    /// Whether the pair touches at all.
    pub enabled: bool,
    /// Normal law.
    pub normal: NormalLaw,
    /// Friction law.
    pub friction: FrictionLaw,
}

/// `true`, for keys that switch something off.
pub(super) fn yes() -> bool {
    true
}

impl Default for ContactLaw {
    /// Metal on metal at the forces of a capture: soft enough for 1 ms, hard enough to be no cushion.
    fn default() -> Self {
        Self {
            enabled: true,
            normal: NormalLaw::HuntCrossley { stiffness_n_per_m_exp: 1.0e6, exponent: 1.5, dissipation_s_per_m: 0.6 },
            friction: FrictionLaw::Bristle(BristleFriction {
                mu: 0.3,
                mu_static: None,
                stribeck_velocity_m_per_s: None,
                stiffness_n_per_m: 1.0e5,
                damping_n_s_per_m: 50.0,
                viscous_n_s_per_m: 0.0,
            }),
        }
    }
}

/// Force along the normal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "law", rename_all = "kebab-case", deny_unknown_fields)]
pub enum NormalLaw {
    /// f_n = k δⁿ (1 + d δ̇), bounded below by zero.
    HuntCrossley {
        /// Stiffness k, N/mⁿ.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        stiffness_n_per_m_exp: f64,
        /// Exponent n: 1 flat, 1.5 sphere on plane (Hertz).
        #[serde(default = "hertz")]
        #[schemars(range(min = 1.0, max = 4.0))]
        exponent: f64,
        /// Dissipation d, s/m.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        dissipation_s_per_m: f64,
    },
    /// f_n = k δ + d δ̇, bounded below by zero.
    Linear {
        /// Stiffness k, N/m.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        stiffness_n_per_m: f64,
        /// Damping d, N·s/m.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        damping_n_s_per_m: f64,
    },
}

/// Exponent of a sphere on a plane.
fn hertz() -> f64 {
    1.5
}

/// Force in the tangent plane.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "law", rename_all = "kebab-case", deny_unknown_fields)]
pub enum FrictionLaw {
    /// One effective bristle per contact point: a spring that the slip deflects, bounded by μ f_n.
    Bristle(BristleFriction),
    /// Smooth: no tangential force.
    None,
}

/// Parameters of the bristle law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend(
    "x-ordered" = [["mu", "mu_static"]],
    "dependentRequired" = { "mu_static": ["stribeck_velocity_m_per_s"], "stribeck_velocity_m_per_s": ["mu_static"] },
))]
pub struct BristleFriction {
    /// Kinetic friction level μ.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub mu: f64,
    /// Static friction level, at least `mu`; by default equal to it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub mu_static: Option<f64>,
    /// Slip speed over which the level falls from static to kinetic, m/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub stribeck_velocity_m_per_s: Option<f64>,
    /// Stiffness of the bristle, N/m.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub stiffness_n_per_m: f64,
    /// Damping of the bristle, N·s/m.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub damping_n_s_per_m: f64,
    /// Viscous coefficient beside the bound, N·s/m.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub viscous_n_s_per_m: f64,
}

impl ContactRule {
    /// Whether the rule names the pair of shapes or links `a`, `b` (`vehicle/name`), in either order.
    pub fn matches(&self, a: &str, b: &str) -> bool {
        let [first, second] = &self.between;
        (glob_matches(first, a) && glob_matches(second, b)) || (glob_matches(first, b) && glob_matches(second, a))
    }
}

impl super::Scenario {
    /// The laws of a pair of shapes.
    ///
    /// Each side is given by all the names it goes by (its shape, its link, as `vehicle/name`). The last matching rule
    /// decides, and what it leaves open comes from `[contact_default]`.
    pub fn contact_law(&self, names_a: &[&str], names_b: &[&str]) -> ContactLaw {
        let matches = |rule: &&ContactRule| names_a.iter().any(|a| names_b.iter().any(|b| rule.matches(a, b)));
        match self.contacts.iter().rev().find(matches) {
            None => self.contact_default,
            Some(rule) => ContactLaw {
                enabled: rule.enabled,
                normal: rule.normal.unwrap_or(self.contact_default.normal),
                friction: rule.friction.unwrap_or(self.contact_default.friction),
            },
        }
    }
}
