//! Friction laws of a contact.
//!
//! | law | what it is for |
//! | --- | --- |
//! | `bristle` | the law to use: sticks without creep, slides at its level |
//! | `regularised-coulomb`, `dahl`, `lu-gre`, `elasto-plastic` | comparison: what each of them gets wrong |
//! | `none` | a smooth pair |
//!
//! Static and kinetic level: `mu_static` and the slip speed over which it falls to `mu` come together. A speed of zero
//! makes the level drop where the bristle breaks away; `dwell_time_s` lets the static level return with the time at rest.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Force in the tangent plane.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "law", rename_all = "kebab-case", deny_unknown_fields)]
pub enum FrictionLaw {
    /// One effective bristle per contact point: a spring that the slip deflects, bounded by μ f_n.
    Bristle(BristleFriction),
    /// A smooth function of the slip velocity, without memory: creeps under every load.
    RegularisedCoulomb(RegularisedCoulomb),
    /// Dahl (1968): a bristle that relaxes exponentially with the way.
    Dahl(Dahl),
    /// LuGre (Canudas de Wit et al. 1995): drifts under loads that oscillate below breakaway.
    LuGre(LuGre),
    /// Elasto-plastic (Dupont et al. 2002): LuGre that does not relax below a break-away deflection.
    ElastoPlastic(ElastoPlastic),
    /// Smooth: no tangential force.
    None,
}

/// Parameters of the bristle law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend(
    "x-ordered" = [["mu", "mu_static"]],
    "dependentRequired" = {
        "mu_static": ["stribeck_velocity_m_per_s"],
        "stribeck_velocity_m_per_s": ["mu_static"],
        "dwell_time_s": ["mu_static"]
    },
))]
pub struct BristleFriction {
    /// Kinetic friction level μ.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub mu: f64,
    /// Static friction level, at least `mu`; by default equal to it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub mu_static: Option<f64>,
    /// Slip speed over which the level falls from static to kinetic, m/s; 0: it drops where the bristle breaks away.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub stribeck_velocity_m_per_s: Option<f64>,
    /// Time constant with which the static level returns at rest, s; by default at once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub dwell_time_s: Option<f64>,
    /// Level across the contact's `grain` over the level along it.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub across_ratio: f64,
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

fn one() -> f64 {
    1.0
}

impl BristleFriction {
    /// One level, a stiffness of 10⁵ N/m, and everything else neutral.
    pub fn new(mu: f64) -> Self {
        Self {
            mu,
            mu_static: None,
            stribeck_velocity_m_per_s: None,
            dwell_time_s: None,
            across_ratio: 1.0,
            stiffness_n_per_m: 1.0e5,
            damping_n_s_per_m: 0.0,
            viscous_n_s_per_m: 0.0,
        }
    }
}

/// Parameters of regularised Coulomb friction: f = μ f_n u / √(u² + v²).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RegularisedCoulomb {
    /// Friction level μ.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub mu: f64,
    /// Slip speed v of the transition, m/s.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub transition_velocity_m_per_s: f64,
}

/// Parameters of Dahl's law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dahl {
    /// Friction level μ.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub mu: f64,
    /// Stiffness at rest, N/m.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub stiffness_n_per_m: f64,
}

/// Parameters of the LuGre law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend(
    "x-ordered" = [["mu", "mu_static"]],
    "dependentRequired" = { "mu_static": ["stribeck_velocity_m_per_s"], "stribeck_velocity_m_per_s": ["mu_static"] },
))]
pub struct LuGre {
    /// Kinetic friction level μ.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub mu: f64,
    /// Level in slow sliding, at least `mu`; by default equal to it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub mu_static: Option<f64>,
    /// Slip speed over which the level falls, m/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub stribeck_velocity_m_per_s: Option<f64>,
    /// σ₀, N/m.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub stiffness_n_per_m: f64,
    /// σ₁, N·s/m.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub damping_n_s_per_m: f64,
    /// σ₂, N·s/m.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub viscous_n_s_per_m: f64,
}

/// Parameters of the elasto-plastic law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ElastoPlastic {
    /// Friction level μ.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub mu: f64,
    /// Deflection below which nothing relaxes, as a share of the largest.
    #[schemars(range(min = 0.0), extend("exclusiveMaximum" = 1.0))]
    pub break_away_ratio: f64,
    /// σ₀, N/m.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub stiffness_n_per_m: f64,
    /// σ₁, N·s/m.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub damping_n_s_per_m: f64,
    /// σ₂, N·s/m.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub viscous_n_s_per_m: f64,
}
