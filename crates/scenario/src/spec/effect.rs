//! Effects: physics beyond the nominal model, each with a name, a place and parameters in SI.
//!
//! Which effects exist, where they act and what their parameters are stands in their definitions ([`crate::effects`]); an entry is held
//! against its definition when it is built, so the parameters are kept as they stand here.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// One effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Effect {
    /// Which effect, e.g. "joint-coulomb-friction".
    #[schemars(length(min = 1))]
    pub name: String,
    /// Where: `joint:vehicle/name`, `link:…`, `body:…`, `contact:a/b`, `actuator:name`, `sensor:name`, or `world`.
    #[schemars(extend("x-refers" = "place"))]
    pub place: String,
    /// Parameters by name, in SI without suffix; infinity is a neutral value of some.
    #[serde(flatten)]
    pub params: BTreeMap<String, ParamValue>,
}

/// The value of an effect's parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ParamValue {
    /// A switch.
    Flag(bool),
    /// A number, SI.
    Number(#[schemars(extend("x-may-be-infinite" = true))] f64),
    /// A name, e.g. of a frame.
    Text(String),
    /// A vector or a list, SI.
    Numbers(#[schemars(extend("items" = { "type": "number", "x-may-be-infinite": true }))] Vec<f64>),
}

impl ParamValue {
    /// The number, where it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(*value),
            _ => None,
        }
    }

    /// The numbers: of a list, or the one.
    pub fn numbers(&self) -> Option<&[f64]> {
        match self {
            Self::Number(value) => Some(std::slice::from_ref(value)),
            Self::Numbers(values) => Some(values),
            _ => None,
        }
    }
}
