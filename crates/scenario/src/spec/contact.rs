//! Contact laws, and which pair of shapes has which.
//!
//! `f_n(δ, δ̇)` is the normal force, N, for a penetration δ ≥ 0, m; it is never attractive.

use super::friction::{BristleFriction, FrictionLaw};
use crate::glob::glob_matches;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The laws of the contact between named shapes or links.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactRule {
    /// The two sides, each a shape or link as `vehicle/name`, or a glob; the order does not matter. Links that one joint holds
    /// together touch only where both sides name them without a glob.
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
    /// The direction along which the friction levels are meant, for a law with `across_ratio` other than 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grain: Option<Grain>,
    /// Resistance of every single point to spinning and rolling, where no patch of points carries it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pivot: Option<Pivot>,
    /// Which of the pair's points bear.
    #[serde(default)]
    pub points: PointRule,
}

impl ContactRule {
    /// As the last rule of a scenario: nothing touches.
    pub fn apart() -> Self {
        let between = ["*", "*"].map(str::to_owned);
        Self { between, enabled: false, normal: None, friction: None, grain: None, pivot: None, points: PointRule::All }
    }
}

/// Which of a pair's points bear.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PointRule {
    /// All that touch: a ball that sinks deep into a cone is held by eight points round it.
    #[default]
    All,
    /// The deepest alone, as laws are meant that were measured or written for one point per pair.
    Deepest,
}

/// Lumped resistance to turning: moments up to a lever times the normal force.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pivot {
    /// Lever of spinning about the normal, m; (2/3) μ R for a disc of radius R that spins without sliding.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub spin_lever_m: f64,
    /// Lever of rolling, m.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub rolling_lever_m: f64,
    /// Stiffness of the angular bristles, N·m/rad.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub stiffness_n_m_per_rad: f64,
    /// Their damping, N·m·s/rad.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub damping_n_m_s_per_rad: f64,
}

/// A direction of a surface, as brushed or turned.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Grain {
    /// The side of the contact that it belongs to, as in `between`.
    #[schemars(extend("x-refers" = "pattern"))]
    pub on: String,
    /// The direction, axes of that side's link; its length does not matter.
    pub axis: [f64; 3],
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
            normal: NormalLaw::HuntCrossley {
                stiffness_n_per_m_exp: 1.0e6,
                exponent: 1.5,
                dissipation_s_per_m: 0.6,
                adhesion_n: 0.0,
            },
            friction: FrictionLaw::Bristle(BristleFriction {
                stiffness_n_per_m: 1.0e5,
                damping_n_s_per_m: 50.0,
                ..BristleFriction::new(0.3)
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
        /// Pull-off force while the surfaces overlap, N.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        adhesion_n: f64,
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
        /// Pull-off force while the surfaces overlap, N.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        adhesion_n: f64,
    },
    /// f_n = weight of a guided body on a half-space: nothing gives way, one contact point below the body's origin.
    DeadWeight {},
}

/// Exponent of a sphere on a plane.
fn hertz() -> f64 {
    1.5
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
        match self.contact_rule(names_a, names_b) {
            None => self.contact_default,
            Some(rule) => ContactLaw {
                enabled: rule.enabled,
                normal: rule.normal.unwrap_or(self.contact_default.normal),
                friction: rule.friction.unwrap_or(self.contact_default.friction),
            },
        }
    }
    /// The last rule that names a pair of shapes; each side by all the names it goes by.
    pub fn contact_rule(&self, names_a: &[&str], names_b: &[&str]) -> Option<&ContactRule> {
        let matches = |rule: &&ContactRule| names_a.iter().any(|a| names_b.iter().any(|b| rule.matches(a, b)));
        self.contacts.iter().rev().find(matches)
    }
}
